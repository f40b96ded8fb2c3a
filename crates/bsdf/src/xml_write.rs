//! Writing a BSDF as LBNL XML (schema 1.4, the form that Radiance and WINDOW read).
//!
//! Numbers are written in the fewest digits that give the same 32-bit value back.

use crate::{
    basis::AngleBasis,
    bsdf::{Bsdf, Mode},
    table::{Matrix, Table},
    tree::Tree,
};
use std::fmt::Write;
use sunpeak_core::Vec3;

impl Bsdf {
    /// The text of an LBNL XML file with the luminous tables of this BSDF.
    pub fn to_xml(&self) -> String {
        let mut out = String::new();
        // Writing to a string cannot fail.
        let _ = self.write(&mut out);
        out
    }

    fn write(&self, out: &mut String) -> std::fmt::Result {
        writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
        writeln!(
            out,
            r#"<WindowElement xmlns="http://windows.lbl.gov" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="http://windows.lbl.gov/BSDF-v1.4.xsd">"#
        )?;
        writeln!(out, "<WindowElementType>System</WindowElementType>\n<FileType>BSDF</FileType>")?;
        writeln!(out, "<Optical>\n<Layer>\n\t<Material>")?;
        writeln!(out, "\t\t<Name>{}</Name>", escaped(&self.name))?;
        writeln!(out, "\t\t<Manufacturer>{}</Manufacturer>", escaped(&self.manufacturer))?;
        writeln!(out, "\t\t<DeviceType>Other</DeviceType>\n\t</Material>")?;
        writeln!(
            out,
            "\t<DataDefinition>\n\t\t<IncidentDataStructure>{}</IncidentDataStructure>",
            self.structure
        )?;
        let tables = self.tables();
        let mut bases: Vec<&AngleBasis> = Vec::new();
        for (_, table) in &tables {
            if let Table::Matrix(m) = table {
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
        for (direction, table) in tables {
            write_block(out, direction, table)?;
        }
        writeln!(out, "</Layer>\n</Optical>\n</WindowElement>")
    }

    /// Tables by the file's names: what the frame's back meets is the file's front.
    fn tables(&self) -> Vec<(&'static str, &Table)> {
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
                own.then(|| (name, oriented.distribution.luminous()))
            })
            .collect()
    }
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

fn write_block(out: &mut String, direction: &str, table: &Table) -> std::fmt::Result {
    writeln!(out, "\t<WavelengthData>\n\t\t<LayerNumber>System</LayerNumber>")?;
    writeln!(out, "\t\t<Wavelength unit=\"Integral\">Visible</Wavelength>")?;
    writeln!(out, "\t\t<SourceSpectrum>CIE Illuminant D65 1nm.ssp</SourceSpectrum>")?;
    writeln!(
        out,
        "\t\t<DetectorSpectrum>ASTM E308 1931 Y.dsp</DetectorSpectrum>\n\t\t<WavelengthDataBlock>"
    )?;
    writeln!(out, "\t\t\t<WavelengthDataDirection>{direction}</WavelengthDataDirection>")?;
    match table {
        Table::Matrix(m) => {
            writeln!(out, "\t\t\t<ColumnAngleBasis>{}</ColumnAngleBasis>", escaped(m.incident.name()))?;
            writeln!(out, "\t\t\t<RowAngleBasis>{}</RowAngleBasis>", escaped(m.exiting.name()))?;
        }
        Table::Tree(_) => writeln!(out, "\t\t\t<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>")?,
    }
    writeln!(out, "\t\t\t<ScatteringDataType>BTDF</ScatteringDataType>\n\t\t\t<ScatteringData>")?;
    match table {
        Table::Matrix(m) => write_matrix(out, m)?,
        Table::Tree(t) => write_node(out, t, [0.0; 4], 1.0)?,
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

/// A region of the tree: one value if it is uniform, a grid if it is small and regular, else its halves.
fn write_node(out: &mut String, tree: &Tree, corner: [f64; 4], size: f64) -> std::fmt::Result {
    let region = tree.region(corner, size);
    if let Some(value) = region.uniform {
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
        write_node(out, tree, at, size / 2.0)?;
    }
    writeln!(out, "}}")
}
