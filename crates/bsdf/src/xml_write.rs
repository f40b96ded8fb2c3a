//! Writing a BSDF as LBNL XML (schema 1.4, the form that Radiance and WINDOW read).
//!
//! Numbers are written in the fewest digits that give the same 32-bit value back. Colour goes beside the luminous values as
//! Radiance reads it: CIE X and Z of matrices, u' and v' of trees.

use crate::{
    basis::AngleBasis,
    bsdf::{Bsdf, Mode},
    distribution::Distribution,
    table::{Matrix, Table},
    tree::Tree,
};
use std::fmt::Write;
use sunpeak_core::Vec3;

/// u' and v' of equal-energy white, for cells without light (CIE 15).
const WHITE_UV: [f64; 2] = [4.0 / 19.0, 9.0 / 19.0];

/// One side and mode as it is written.
pub(crate) struct Component<'a> {
    /// `Transmission Front` …
    pub direction: &'static str,
    pub luminous: &'a Table,
    /// CIE X and Z in the same cells.
    pub color: Option<&'a [Vec<f32>; 2]>,
}

/// What a file says about how its tables were made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Production {
    /// A comment at the head of the file.
    pub comment: String,
    /// Thickness of the product [m].
    pub thickness: Option<f64>,
}

/// Which cells a tree is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Leaves {
    /// Neighbours of the same value together: the shortest text.
    Merged,
    /// As they are: whoever reads it finds the same cells.
    Kept,
}

impl Bsdf {
    /// The text of an LBNL XML file with the tables of this BSDF.
    pub fn to_xml(&self) -> String {
        self.to_xml_with(&Production::default())
    }

    /// The same, and how the tables were made.
    pub fn to_xml_with(&self, production: &Production) -> String {
        let own = self.own_distributions();
        let components: Vec<Component> = own
            .into_iter()
            .map(|(direction, d)| Component { direction, luminous: d.luminous(), color: d.color() })
            .collect();
        self.text(&components, Leaves::Merged, production)
    }

    /// The text of an LBNL XML file with other tables under this BSDF's name.
    pub(crate) fn xml_of(&self, components: &[Component], leaves: Leaves) -> String {
        self.text(components, leaves, &Production::default())
    }

    fn text(&self, components: &[Component], leaves: Leaves, production: &Production) -> String {
        let mut out = String::new();
        // Writing to a string cannot fail.
        let _ = self.write(&mut out, components, leaves, production);
        out
    }

    fn write(
        &self,
        out: &mut String,
        components: &[Component],
        leaves: Leaves,
        production: &Production,
    ) -> std::fmt::Result {
        writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
        if !production.comment.is_empty() {
            writeln!(out, "<!-- {} -->", in_comment(&production.comment))?;
        }
        writeln!(
            out,
            r#"<WindowElement xmlns="http://windows.lbl.gov" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="http://windows.lbl.gov/BSDF-v1.4.xsd">"#
        )?;
        writeln!(out, "<WindowElementType>System</WindowElementType>\n<FileType>BSDF</FileType>")?;
        writeln!(out, "<Optical>\n<Layer>\n\t<Material>")?;
        writeln!(out, "\t\t<Name>{}</Name>", escaped(&self.name))?;
        writeln!(out, "\t\t<Manufacturer>{}</Manufacturer>", escaped(&self.manufacturer))?;
        if let Some(thickness) = production.thickness {
            writeln!(out, "\t\t<Thickness unit=\"Meter\">{thickness}</Thickness>")?;
        }
        writeln!(out, "\t\t<DeviceType>Other</DeviceType>")?;
        writeln!(out, "\t</Material>")?;
        writeln!(
            out,
            "\t<DataDefinition>\n\t\t<IncidentDataStructure>{}</IncidentDataStructure>",
            self.structure_of(components)
        )?;
        let mut bases: Vec<&AngleBasis> = Vec::new();
        for component in components {
            if let Table::Matrix(m) = component.luminous {
                for basis in [&*m.incident, &*m.exiting] {
                    if !bases.iter().any(|b| b.name() == basis.name()) {
                        bases.push(basis);
                    }
                }
            }
        }
        for basis in bases {
            write_basis(out, basis)?;
        }
        writeln!(out, "\t</DataDefinition>")?;
        for component in components {
            write_component(out, component, leaves)?;
        }
        writeln!(out, "</Layer>\n</Optical>\n</WindowElement>")
    }

    /// Matrices are written by columns, whatever the file had that they came from.
    fn structure_of(&self, components: &[Component]) -> &str {
        let is_matrix = |c: &Component| matches!(c.luminous, Table::Matrix(_));
        if components.iter().any(is_matrix) { "Columns" } else { &self.structure }
    }

    /// Distributions by the file's names: what the frame's back meets is the file's front.
    pub(crate) fn own_distributions(&self) -> Vec<(&'static str, &Distribution)> {
        let named = [
            ("Transmission Front", -Vec3::Z, Mode::Transmission),
            ("Transmission Back", Vec3::Z, Mode::Transmission),
            ("Reflection Front", -Vec3::Z, Mode::Reflection),
            ("Reflection Back", Vec3::Z, Mode::Reflection),
        ];
        named
            .into_iter()
            .filter_map(|(name, w_in, mode)| {
                let oriented = self.distribution(w_in, mode)?;
                // A transmission that only serves this side by reciprocity stands under its own name.
                let own = mode == Mode::Reflection || !oriented.reversed;
                own.then(|| (name, &*oriented.distribution))
            })
            .collect()
    }
}

/// A comment has no two hyphens in a row, and none at its end.
fn in_comment(text: &str) -> String {
    let printable = |c: char| if c.is_control() && c != '\n' { ' ' } else { c };
    let mut inside: String = text.chars().map(printable).collect();
    inside = inside.replace("--", "- -");
    if inside.ends_with('-') {
        inside.push(' ');
    }
    // Three in a row leave two.
    inside.replace("--", "- -")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn write_basis(out: &mut String, basis: &AngleBasis) -> std::fmt::Result {
    writeln!(out, "\t\t<AngleBasis>\n\t\t\t<AngleBasisName>{}</AngleBasisName>", escaped(basis.name()))?;
    for ring in basis.rings() {
        let (lower, upper) = (ring.lower_theta_deg, ring.upper_theta_deg);
        let middle = if lower == 0.0 { 0.0 } else { 0.5 * (lower + upper) };
        writeln!(
            out,
            "\t\t\t<AngleBasisBlock><Theta>{middle}</Theta><nPhis>{}</nPhis><ThetaBounds><LowerTheta>{lower}</LowerTheta>\
             <UpperTheta>{upper}</UpperTheta></ThetaBounds></AngleBasisBlock>",
            ring.phi_count
        )?;
    }
    writeln!(out, "\t\t</AngleBasis>")
}

fn write_component(out: &mut String, component: &Component, leaves: Leaves) -> std::fmt::Result {
    let Component { direction, luminous, color } = component;
    // Equal luminous values may have different colours: then no cells are put together.
    let leaves = if color.is_some() { Leaves::Kept } else { leaves };
    write_block(out, "Visible", direction, luminous, leaves)?;
    let Some([x, z]) = color else { return Ok(()) };
    let with = |values: Vec<f32>| luminous.with_values(values);
    let bands = match luminous {
        Table::Matrix(_) => [("CIE-X", with(x.clone())), ("CIE-Z", with(z.clone()))],
        Table::Tree(_) => {
            let [u, v] = chromaticity(luminous.values(), x, z);
            [("CIE-u", with(u)), ("CIE-v", with(v))]
        }
    };
    for (band, table) in bands {
        if let Some(table) = table {
            write_block(out, band, direction, &table, leaves)?;
        }
    }
    Ok(())
}

/// u' = 4X / (X + 15Y + 3Z) and v' = 9Y / (same) of each cell (CIE 15).
fn chromaticity(y: &[f32], x: &[f32], z: &[f32]) -> [Vec<f32>; 2] {
    let each = y.iter().zip(x).zip(z).map(|((&y, &x), &z)| {
        let [x, y, z] = [x, y, z].map(f64::from);
        let sum = x + 15.0 * y + 3.0 * z;
        if y > 0.0 { [4.0 * x / sum, 9.0 * y / sum] } else { WHITE_UV }.map(|v| v as f32)
    });
    let (u, v) = each.map(|[u, v]| (u, v)).unzip();
    [u, v]
}

fn write_block(
    out: &mut String,
    band: &str,
    direction: &str,
    table: &Table,
    leaves: Leaves,
) -> std::fmt::Result {
    let detector = match band {
        "CIE-X" => "ASTM E308 1931 X.dsp",
        "CIE-Z" => "ASTM E308 1931 Z.dsp",
        _ => "ASTM E308 1931 Y.dsp",
    };
    let kind = if direction.starts_with("Reflection") { "BRDF" } else { "BTDF" };
    writeln!(out, "\t<WavelengthData>\n\t\t<LayerNumber>System</LayerNumber>")?;
    writeln!(out, "\t\t<Wavelength unit=\"Integral\">{band}</Wavelength>")?;
    writeln!(out, "\t\t<SourceSpectrum>CIE Illuminant D65 1nm.ssp</SourceSpectrum>")?;
    writeln!(out, "\t\t<DetectorSpectrum>{detector}</DetectorSpectrum>\n\t\t<WavelengthDataBlock>")?;
    writeln!(out, "\t\t\t<WavelengthDataDirection>{direction}</WavelengthDataDirection>")?;
    match table {
        Table::Matrix(m) => {
            writeln!(out, "\t\t\t<ColumnAngleBasis>{}</ColumnAngleBasis>", escaped(m.incident.name()))?;
            writeln!(out, "\t\t\t<RowAngleBasis>{}</RowAngleBasis>", escaped(m.exiting.name()))?;
        }
        Table::Tree(_) => writeln!(out, "\t\t\t<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>")?,
    }
    writeln!(out, "\t\t\t<ScatteringDataType>{kind}</ScatteringDataType>\n\t\t\t<ScatteringData>")?;
    match table {
        Table::Matrix(m) => write_matrix(out, m)?,
        Table::Tree(t) => write_node(out, t, leaves, [0.0; 4], 1.0)?,
    }
    writeln!(out, "\t\t\t</ScatteringData>\n\t\t</WavelengthDataBlock>\n\t</WavelengthData>")
}

/// One line for each exiting patch, its columns the incident patches.
fn write_matrix(out: &mut String, m: &Matrix) -> std::fmt::Result {
    for o in 0..m.exiting.len() {
        for i in 0..m.incident.len() {
            write!(out, "{:e}, ", m.values[i * m.exiting.len() + o])?;
        }
        out.push('\n');
    }
    Ok(())
}

/// A region of the tree: one value if it is uniform (or a cell), a grid if it is small and regular, else its halves.
fn write_node(
    out: &mut String,
    tree: &Tree,
    leaves: Leaves,
    corner: [f64; 4],
    size: f64,
) -> std::fmt::Result {
    let region = tree.region(corner, size);
    if let Some(value) = region.uniform.filter(|_| leaves == Leaves::Merged || region.smallest >= size) {
        return writeln!(out, "{{{value:e}}}");
    }
    let side = (size / region.smallest).round() as usize;
    if side <= 2 {
        out.push('{');
        for n in 0..side.pow(tree.rank() as u32) {
            let mut at = corner;
            for (d, x) in at.iter_mut().enumerate().take(tree.rank()) {
                let cell = n / side.pow((tree.rank() - 1 - d) as u32) % side;
                *x += (cell as f64 + 0.5) * region.smallest;
            }
            write!(out, " {:e}", tree.value(at))?;
        }
        return writeln!(out, " }}");
    }
    writeln!(out, "{{")?;
    for child in 0..1usize << tree.rank() {
        let mut at = corner;
        for (d, x) in at.iter_mut().enumerate().take(tree.rank()) {
            *x += size / 2.0 * (child >> d & 1) as f64;
        }
        write_node(out, tree, leaves, at, size / 2.0)?;
    }
    writeln!(out, "}}")
}
