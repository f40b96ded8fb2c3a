//! Geometry and materials in the Materials and Geometry Format, as LBNL's BSDF files carry the detail of a product.
//!
//! The words are those of the format's definition (Ward, "The Materials and Geometry Format", LBNL 1995). It knows diffuse and
//! specular reflectance and transmittance with a roughness, and a chromaticity; patterns, textures and the direction of anisotropic
//! highlights have no words and are left out. Lights are black, as for a virtual goniophotometer.

use crate::{Material, Modifier, ModifierId, ModifierKind, Scene, Shape, Surface, Ward};
use std::collections::HashSet;
use std::fmt::Write;
use sunpeak_core::{Error, Result, Rgb, Vec3, gray, luminance, rgb_to_xyz};

/// Most vertices of a face: readers of the format take lines of 4096 bytes and 512 words.
const MOST_VERTICES: usize = 400;

impl Scene {
    /// The scene as MGF in the same units, moved by `offset`.
    ///
    /// # Errors
    /// With file and line of a material that the format has no words for, or of a surface that it cannot hold.
    pub fn to_mgf(&self, offset: Vec3) -> Result<String> {
        let mut out = Writer { offset, text: String::new(), defined: HashSet::new(), vertices: 0 };
        let mut current = None;
        for surface in &self.surfaces {
            let Some((id, material)) = self.material(surface.modifier) else { continue };
            if current != Some(id) {
                out.material(id, material)?;
                current = Some(id);
            }
            out.surface(surface)?;
        }
        Ok(out.text)
    }

    /// The material of a surface; none where it is invisible.
    fn material(&self, modifier: Option<ModifierId>) -> Option<(ModifierId, &Modifier)> {
        let chain = std::iter::successors(modifier, |id| self.modifiers[id.0].parent);
        let is_material =
            |kind: &ModifierKind| matches!(kind, ModifierKind::Material(_) | ModifierKind::Mixture { .. });
        chain.map(|id| (id, &self.modifiers[id.0])).find(|(_, modifier)| is_material(&modifier.kind))
    }
}

/// Shares of the light that meets a surface.
struct Optics {
    diffuse: Rgb,
    diffuse_transmission: Rgb,
    specular: Rgb,
    specular_transmission: Rgb,
    roughness: f64,
    /// Of a solid.
    index: Option<f64>,
}

impl Optics {
    fn black() -> Self {
        let [diffuse, diffuse_transmission, specular, specular_transmission] = [Rgb::ZERO; 4];
        Self { diffuse, diffuse_transmission, specular, specular_transmission, roughness: 0.0, index: None }
    }

    /// None where the format has no words for a material.
    fn of(material: &Material) -> Option<Self> {
        let diffuse = |ward: &Ward| ward.color * (1.0 - ward.specularity);
        let shiny = |ward: &Ward, color: Rgb| Self {
            diffuse: diffuse(ward),
            specular: color * ward.specularity,
            roughness: ward.roughness,
            ..Self::black()
        };
        Some(match material {
            Material::Plastic(ward) => shiny(ward, Rgb::ONE),
            Material::Metal(ward) => shiny(ward, ward.color),
            Material::Trans { ward, transmissivity, specular_transmission } => Self {
                diffuse: diffuse(ward) * (1.0 - transmissivity),
                diffuse_transmission: diffuse(ward) * transmissivity * (1.0 - specular_transmission),
                specular_transmission: diffuse(ward) * transmissivity * *specular_transmission,
                ..shiny(ward, Rgb::ONE)
            },
            Material::Glass { transmissivity, index } => {
                let [specular, specular_transmission] = pane(*transmissivity, *index);
                Self { specular, specular_transmission, ..Self::black() }
            }
            Material::Dielectric { index, .. } => {
                let face = gray(face(*index));
                Self {
                    specular: face,
                    specular_transmission: Rgb::ONE - face,
                    index: Some(*index),
                    ..Self::black()
                }
            }
            Material::Mirror { reflectance, alternate: None } => {
                Self { specular: *reflectance, ..Self::black() }
            }
            Material::Light(_) | Material::Glow { .. } | Material::Spotlight { .. } => Self::black(),
            _ => return None,
        })
    }
}

/// Reflectance of one face at normal incidence (Fresnel).
fn face(index: f64) -> f64 {
    ((index - 1.0) / (index + 1.0)).powi(2)
}

/// Reflectance and transmittance of a pane at normal incidence, all orders of reflection.
fn pane(pass: Rgb, index: f64) -> [Rgb; 2] {
    let r = face(index);
    let of = |t: f64| {
        let rest = 1.0 - (r * t).powi(2);
        [r * (1.0 + (1.0 - 2.0 * r) * t * t) / rest, t * (1.0 - r).powi(2) / rest]
    };
    [0, 1].map(|k| pass.map(|t| of(t)[k]))
}

struct Writer {
    offset: Vec3,
    text: String,
    defined: HashSet<ModifierId>,
    vertices: usize,
}

impl Writer {
    /// Name a material, or define it where it comes first.
    fn material(&mut self, id: ModifierId, modifier: &Modifier) -> Result<()> {
        let name = format!("{}.{}", word(&modifier.name), id.0);
        // Writing to a string cannot fail.
        if !self.defined.insert(id) {
            let _ = writeln!(self.text, "m {name}");
            return Ok(());
        }
        let optics = match &modifier.kind {
            ModifierKind::Material(material) => Optics::of(material),
            _ => None,
        };
        let optics = optics.ok_or_else(|| {
            Error::input(
                modifier.location.clone(),
                format!(
                    "{}: MGF has no words for such a material; expected plastic, metal, trans, glass, dielectric or mirror, or a file \
                     without geometry",
                    modifier.name
                ),
            )
        })?;
        let _ = writeln!(self.text, "m {name} =");
        let _ = match optics.index {
            Some(index) => writeln!(self.text, "\tsides 1\n\tir {index} 0"),
            None => writeln!(self.text, "\tsides 2"),
        };
        self.share("rd", optics.diffuse, None);
        self.share("td", optics.diffuse_transmission, None);
        self.share("rs", optics.specular, Some(optics.roughness));
        self.share("ts", optics.specular_transmission, Some(optics.roughness));
        Ok(())
    }

    /// A share of the light in its colour.
    fn share(&mut self, name: &str, share: Rgb, roughness: Option<f64>) {
        if share == Rgb::ZERO && name != "rd" {
            return;
        }
        let xyz = rgb_to_xyz(if share == Rgb::ZERO { Rgb::ONE } else { share });
        let sum = xyz.element_sum();
        let _ = write!(
            self.text,
            "\tc\n\t\tcxy {:.9} {:.9}\n\t{name} {:.6}",
            xyz.x / sum,
            xyz.y / sum,
            luminance(share)
        );
        if let Some(roughness) = roughness {
            let _ = write!(self.text, " {roughness}");
        }
        self.text.push('\n');
    }

    fn surface(&mut self, surface: &Surface) -> Result<()> {
        let _ = writeln!(self.text, "o {}", word(&surface.name));
        let signed = |radius: f64, inward: bool| if inward { -radius } else { radius };
        match &surface.shape {
            Shape::Polygon(corners) => self.face(surface, corners)?,
            Shape::Mesh(mesh) => {
                for triangle in &mesh.triangles {
                    self.face(surface, &triangle.map(|corner| mesh.vertices[corner as usize]))?;
                }
            }
            Shape::Sphere { center, radius, inward } => {
                let center = self.vertex(*center, None);
                let _ = writeln!(self.text, "sph {center} {}", signed(*radius, *inward));
            }
            Shape::Cone { start, end, start_radius, end_radius, inward } => {
                let [a, b] = [*start, *end].map(|end| self.vertex(end, None));
                let [start, end] = [*start_radius, *end_radius].map(|radius| signed(radius, *inward));
                let _ = if start_radius == end_radius {
                    writeln!(self.text, "cyl {a} {start} {b}")
                } else {
                    writeln!(self.text, "cone {a} {start} {b} {end}")
                };
            }
            Shape::Ring { center, normal, inner_radius, outer_radius } => {
                let center = self.vertex(*center, Some(*normal));
                let _ = writeln!(self.text, "ring {center} {inner_radius} {outer_radius}");
            }
            Shape::Source { .. } => {}
        }
        self.text.push_str("o\n");
        Ok(())
    }

    fn face(&mut self, surface: &Surface, corners: &[Vec3]) -> Result<()> {
        if corners.len() > MOST_VERTICES {
            return Err(Error::input(
                surface.location.clone(),
                format!(
                    "{}: a polygon of {} vertices; MGF's readers take {MOST_VERTICES}: expected it in parts, or a file without \
                     geometry",
                    surface.name,
                    corners.len()
                ),
            ));
        }
        let names: Vec<String> = corners.iter().map(|&corner| self.vertex(corner, None)).collect();
        let _ = writeln!(self.text, "f {}", names.join(" "));
        Ok(())
    }

    /// Define a vertex; its name.
    fn vertex(&mut self, point: Vec3, normal: Option<Vec3>) -> String {
        let name = format!("v{}", self.vertices);
        self.vertices += 1;
        let Vec3 { x, y, z } = point + self.offset;
        let _ = writeln!(self.text, "v {name} =\n\tp {x} {y} {z}");
        if let Some(Vec3 { x, y, z }) = normal {
            let _ = writeln!(self.text, "\tn {x} {y} {z}");
        }
        name
    }
}

/// A name as the format has it: a letter, then letters, digits and some signs.
fn word(name: &str) -> String {
    let is_fine = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    let mut word: String = name.chars().map(|c| if is_fine(c) { c } else { '_' }).collect();
    if !word.starts_with(|c: char| c.is_ascii_alphabetic()) {
        word.insert(0, 'n');
    }
    word
}

#[cfg(test)]
mod tests {
    use crate::{LoadOptions, Scene};
    use sunpeak_core::Vec3;

    fn mgf(text: &str) -> sunpeak_core::Result<String> {
        Scene::parse(text, "t.rad", &LoadOptions::default())?.to_mgf(Vec3::new(-1.0, 0.0, 0.0))
    }

    #[test]
    fn surfaces_are_moved_and_materials_defined_once() {
        let text = mgf(
            "void plastic gray.slat 0 0 5 .5 .5 .5 .1 .05\ngray.slat polygon 'a b' 0 0 9 1 0 0 3 0 0 2 1 0\n\
             gray.slat bubble s 0 0 4 1 0 -1 .25\ngray.slat cylinder c 0 0 7 1 0 0 1 0 -1 .5",
        )
        .expect("MGF");
        assert_eq!(text.matches("m gray.slat.0").count(), 1);
        assert!(text.contains("\trd 0.450000\n") && text.contains("\trs 0.100000 0.05\n"), "{text}");
        assert!(
            text.contains("o a_b\nv v0 =\n\tp 0 0 0\nv v1 =\n\tp 2 0 0\nv v2 =\n\tp 1 1 0\nf v0 v1 v2\no\n"),
            "{text}"
        );
        assert!(text.contains("sph v3 -0.25\n") && text.contains("cyl v4 0.5 v5\n"), "{text}");
    }

    /// Shares of `trans` add up; a pane by Fresnel's equations at normal incidence (index 1.52, 0.9 in one pass).
    #[test]
    fn what_passes_a_surface_is_said() {
        let text = mgf("void trans t 0 0 7 .6 .6 .6 0 0 .5 .3\nt ring r 0 0 8 0 0 0 0 0 1 0 1\n\
             void glass g 0 0 3 .9 .9 .9\ng ring r 0 0 8 0 0 0 0 0 1 0 1")
        .expect("MGF");
        for line in ["\trd 0.300000\n", "\ttd 0.210000\n", "\tts 0.090000 0\n", "\tts 0.826201 0\n"] {
            assert!(text.contains(line), "{line}: {text}");
        }
    }

    #[test]
    fn what_the_format_has_no_words_for_is_refused_with_its_place() {
        let said = mgf(
            "void plastic p 0 0 5 .5 .5 .5 0 0\nvoid ashik2 m 4 0 1 0 . 0 8 .3 .3 .3 .1 .1 .1 50 50\nm ring r 0 0 8 0 0 0 0 0 1 0 1",
        );
        let message = said.expect_err("no words").to_string();
        assert!(message.contains("t.rad:2") && message.contains("no words"), "{message}");
    }
}
