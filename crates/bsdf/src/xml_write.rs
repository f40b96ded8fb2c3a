//! Writing a BSDF as LBNL XML, the form that Radiance and WINDOW read.
//!
//! Matrices are valid by LBNL's schema 1.7.5, but for the namespace, which the schema has not and all files have. Tensor trees follow
//! Radiance's addition to it: the schema knows matrices alone. The same tables give the same bytes.
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
use sunpeak_core::{Error, Result, Vec3};

/// Bands by their names in the file: what is visible, and all of the sun.
const BANDS: [&str; 2] = ["Visible", "Solar"];

/// u' and v' of equal-energy white, for cells without light (CIE 15).
const WHITE_UV: [f64; 2] = [4.0 / 19.0, 9.0 / 19.0];

/// One side and mode as it is written.
pub(crate) struct Component<'a> {
    /// `Visible` or `Solar`.
    pub band: &'static str,
    /// `Transmission Front` …
    pub direction: &'static str,
    pub luminous: &'a Table,
    /// CIE X and Z in the same cells.
    pub color: Option<&'a [Vec<f32>; 2]>,
}

/// What a file says of its product beside the tables, where it is not to say what the BSDF says of itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Label {
    /// Name of the product.
    pub name: Option<String>,
    /// Who makes it.
    pub manufacturer: Option<String>,
    /// Thickness [m].
    pub thickness_m: Option<f64>,
    /// How the tables were made, and their statistical error.
    pub comments: Option<String>,
    /// The detail that the tables stand for.
    pub geometry: Option<Geometry>,
}

/// Geometry of a product.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// In MGF, in metres; x and y from the middle of the product, z from its front.
    pub mgf: String,
    /// Width and height of the product [m].
    pub size_m: [f64; 2],
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
        self.xml_of(&self.components(BANDS[0]), Leaves::Merged)
    }

    /// [`Self::to_xml`] under another label, and with the luminous tables of another BSDF as the solar band beside it.
    pub fn to_xml_as(&self, label: &Label, solar: Option<&Self>) -> Result<String> {
        let mut components = self.components(BANDS[0]);
        if let Some(solar) = solar {
            if self.is_matrix() != solar.is_matrix() || !self.is_matrix() && self.structure != solar.structure
            {
                return Err(Error::value(format!(
                    "visible tables are {}, solar ones {}; a file has one kind: expected both in the same basis",
                    self.structure, solar.structure
                )));
            }
            let solar = solar.components(BANDS[1]);
            components.extend(solar.into_iter().map(|c| Component { color: None, ..c }));
        }
        Ok(self.text(&components, Leaves::Merged, label))
    }

    fn components(&self, band: &'static str) -> Vec<Component<'_>> {
        let own = self.own_distributions().into_iter();
        own.map(|(direction, d)| Component { band, direction, luminous: d.luminous(), color: d.color() })
            .collect()
    }

    fn is_matrix(&self) -> bool {
        self.own_distributions().iter().any(|(_, d)| matches!(d.luminous(), Table::Matrix(_)))
    }

    /// The text of an LBNL XML file with other tables under this BSDF's name.
    pub(crate) fn xml_of(&self, components: &[Component], leaves: Leaves) -> String {
        self.text(components, leaves, &Label::default())
    }

    fn text(&self, components: &[Component], leaves: Leaves, label: &Label) -> String {
        let mut out = String::new();
        // Writing to a string cannot fail.
        let _ = self.write(&mut out, components, leaves, label);
        out
    }

    fn write(
        &self,
        out: &mut String,
        components: &[Component],
        leaves: Leaves,
        label: &Label,
    ) -> std::fmt::Result {
        let own = |other: &'_ Option<String>, own: &str| escaped(other.as_deref().unwrap_or(own));
        writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
        writeln!(
            out,
            r#"<WindowElement xmlns="http://windows.lbl.gov" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="http://windows.lbl.gov/BSDF-v1.4.xsd">"#
        )?;
        writeln!(
            out,
            "<WindowElementType>System</WindowElementType>\n<FileType>BSDF</FileType>\n<Checksum></Checksum>"
        )?;
        writeln!(out, "<Optical>\n<Layer>\n\t<Material>")?;
        writeln!(out, "\t\t<Name>{}</Name>", own(&label.name, &self.name))?;
        writeln!(out, "\t\t<Manufacturer>{}</Manufacturer>", own(&label.manufacturer, &self.manufacturer))?;
        if let Some(thickness) = label.thickness_m.or(self.thickness_m) {
            write_length(out, "Thickness", thickness)?;
        }
        if let Some(geometry) = &label.geometry {
            write_length(out, "Width", geometry.size_m[0])?;
            write_length(out, "Height", geometry.size_m[1])?;
        }
        writeln!(out, "\t\t<DeviceType>Other</DeviceType>")?;
        let comments = own(&label.comments, &self.comments);
        if !comments.is_empty() {
            writeln!(out, "\t\t<Comments>{comments}</Comments>")?;
        }
        writeln!(out, "\t</Material>")?;
        if let Some(geometry) = &label.geometry {
            writeln!(out, "\t<Geometry format=\"MGF\">\n\t\t<MGFblock unit=\"meter\">")?;
            write!(out, "{}", escaped(&geometry.mgf))?;
            writeln!(out, "\t\t</MGFblock>\n\t</Geometry>")?;
        }
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

fn escaped(text: &str) -> String {
    // XML has no control characters but these.
    let text: String = text.chars().filter(|c| !c.is_control() || matches!(c, '\n' | '\t')).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// A length in millimetres, as in WINDOW's own files: its readers take the number without looking at the unit. To the nanometre.
fn write_length(out: &mut String, name: &str, metres: f64) -> std::fmt::Result {
    let millimetres = (metres * 1e9).round() / 1e6;
    writeln!(out, "\t\t<{name} unit=\"Millimeter\">{millimetres}</{name}>")
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
    let Component { band, direction, luminous, color } = component;
    // Equal luminous values may have different colours: then no cells are put together.
    let leaves = if color.is_some() { Leaves::Kept } else { leaves };
    write_block(out, band, direction, luminous, leaves)?;
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
        "Solar" => "None",
        _ => "ASTM E308 1931 Y.dsp",
    };
    // What WINDOW names where nothing else is known.
    let source =
        if band == "Solar" { "ASTM E891 Table 1 Direct AM1_5.ssp" } else { "CIE Illuminant D65 1nm.ssp" };
    writeln!(out, "\t<WavelengthData>\n\t\t<LayerNumber>System</LayerNumber>")?;
    writeln!(out, "\t\t<Wavelength unit=\"Integral\">{band}</Wavelength>")?;
    writeln!(out, "\t\t<SourceSpectrum>{source}</SourceSpectrum>")?;
    writeln!(out, "\t\t<DetectorSpectrum>{detector}</DetectorSpectrum>\n\t\t<WavelengthDataBlock>")?;
    writeln!(out, "\t\t\t<WavelengthDataDirection>{direction}</WavelengthDataDirection>")?;
    match table {
        Table::Matrix(m) => {
            writeln!(out, "\t\t\t<ColumnAngleBasis>{}</ColumnAngleBasis>", escaped(m.incident.name()))?;
            writeln!(out, "\t\t\t<RowAngleBasis>{}</RowAngleBasis>", escaped(m.exiting.name()))?;
        }
        Table::Tree(_) => writeln!(out, "\t\t\t<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>")?,
    }
    // The schema calls all of them BTDF, reflection too.
    writeln!(out, "\t\t\t<ScatteringDataType>BTDF</ScatteringDataType>\n\t\t\t<ScatteringData>")?;
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
