//! What varies over a surface: patterns multiply a material's colour, textures bend its normal, mixtures choose between modifiers.
//!
//! They are evaluated where a ray meets the surface. Patterns and textures count whether they stand before or behind the material.
//! Of a mixture of materials, a path takes one with its share as chance; a shadow ray takes the mean of what they let through. A
//! mixture of a material with `void` is transparent for the rest. What fails to be evaluated is left out, as in Radiance.

use super::{Arrival, MaterialId};
use std::sync::Arc;
use sunpeak_core::{Error, Rgb, Vec3};
use sunpeak_scene::{Field, Pattern, RayState, Weight};

/// A chain of modifiers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Varying {
    pub steps: Vec<Step>,
    /// The material in the chain; `None` if a mixture has it, or if there is none.
    pub material: Option<MaterialId>,
    /// Does a mixture in the chain have materials?
    pub mixes_materials: bool,
}

/// A modifier that is no material.
#[derive(Clone, Debug)]
pub(crate) enum Step {
    Pattern(Pattern),
    Texture(Arc<Field>),
    Mixture(Box<Mixture>),
}

/// Two chains and the share of the first.
#[derive(Clone, Debug)]
pub(crate) struct Mixture {
    pub fore: Varying,
    pub back: Varying,
    pub weight: Weight,
}

/// What patterns and textures do at one point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Modulation {
    /// Multiplies the material's colour.
    pub tint: Rgb,
    /// Is added to the unit normal.
    pub bend: Vec3,
}

impl Modulation {
    const NONE: Self = Self { tint: Rgb::ONE, bend: Vec3::ZERO };

    fn mixed(self, other: Self, share: f64) -> Self {
        Self {
            tint: self.tint * share + other.tint * (1.0 - share),
            bend: self.bend * share + other.bend * (1.0 - share),
        }
    }
}

/// What a pattern multiplies with.
fn tint(pattern: &Pattern, ray: &RayState) -> Rgb {
    match pattern {
        Pattern::Sky(sky) => Rgb::splat(sky.brightness(ray.direction)),
        Pattern::Uniform(color) => *color,
        Pattern::Text { text, fore, back } => {
            if text.contains(ray.point) {
                *fore
            } else {
                *back
            }
        }
        Pattern::Bright(field) => field.values(ray).map_or(Rgb::ONE, |[value]: [f64; 1]| Rgb::splat(value)),
        Pattern::Color(field) => {
            field.values(ray).map_or(Rgb::ONE, |values: [f64; 3]| Rgb::from_array(values))
        }
        Pattern::Spectral { field, spectrum } => {
            field.spectrum(ray, spectrum.wavelengths_nm()).map_or(Rgb::ONE, |samples| spectrum.color(samples))
        }
    }
}

/// The field of a pattern.
fn field_of(pattern: &Pattern) -> Option<&Arc<Field>> {
    match pattern {
        Pattern::Bright(field) | Pattern::Color(field) | Pattern::Spectral { field, .. } => Some(field),
        Pattern::Sky(_) | Pattern::Uniform(_) | Pattern::Text { .. } => None,
    }
}

/// What steps without materials multiply a colour with.
pub(crate) fn tint_of(steps: &[Step], ray: &RayState) -> Rgb {
    modulation_of(steps, ray).tint
}

/// What steps without materials do together.
pub(crate) fn modulation_of(steps: &[Step], ray: &RayState) -> Modulation {
    let mut sum = Modulation::NONE;
    steps.iter().for_each(|step| step.add_to(&mut sum, ray));
    sum
}

/// What an evaluation has found to be wrong with one of these.
pub(crate) fn fault_of(steps: &[Step]) -> Option<Error> {
    steps.iter().find_map(|step| match step {
        Step::Pattern(pattern) => field_of(pattern).and_then(|field| field.fault()),
        Step::Texture(field) => field.fault(),
        Step::Mixture(m) => m.fault().or_else(|| m.fore.fault()).or_else(|| m.back.fault()),
    })
}

impl Varying {
    /// The material at a point, `None` if there is none; `choose` gives random numbers in [0, 1).
    pub fn at(&self, ray: &RayState, choose: &mut dyn FnMut() -> f64) -> (Option<MaterialId>, Modulation) {
        let mut sum = Modulation::NONE;
        let material = self.walk(ray, &mut sum, choose);
        (material, sum)
    }

    fn walk(
        &self,
        ray: &RayState,
        sum: &mut Modulation,
        choose: &mut dyn FnMut() -> f64,
    ) -> Option<MaterialId> {
        let mut chosen = None;
        for step in &self.steps {
            match step {
                Step::Mixture(mixture) if mixture.mixes_materials() => {
                    let Some(share) = mixture.share(ray) else { continue };
                    let takes_fore = share > 0.0 && (share >= 1.0 || choose() < share);
                    let part = if takes_fore { &mixture.fore } else { &mixture.back };
                    chosen = part.walk(ray, sum, choose);
                }
                step => step.add_to(sum, ray),
            }
        }
        self.material.or(chosen)
    }

    /// All materials at a point with their shares.
    pub fn each(&self, ray: &RayState, visit: &mut dyn FnMut(f64, Option<MaterialId>, &Modulation)) {
        self.each_of(0, ray, 1.0, Modulation::NONE, visit);
    }

    fn each_of(
        &self,
        start: usize,
        ray: &RayState,
        weight: f64,
        mut sum: Modulation,
        visit: &mut dyn FnMut(f64, Option<MaterialId>, &Modulation),
    ) {
        for step in &self.steps[start..] {
            match step {
                Step::Mixture(mixture) if mixture.mixes_materials() => {
                    let Some(share) = mixture.share(ray) else { continue };
                    for (part, share) in [(&mixture.fore, share), (&mixture.back, 1.0 - share)] {
                        if share > 0.0 {
                            part.each_of(0, ray, weight * share, sum, visit);
                        }
                    }
                    return;
                }
                step => step.add_to(&mut sum, ray),
            }
        }
        visit(weight, self.material, &sum);
    }

    /// Materials that may be seen.
    pub fn materials(&self) -> Vec<MaterialId> {
        let mut all: Vec<MaterialId> = self.material.into_iter().collect();
        for step in &self.steps {
            if let Step::Mixture(mixture) = step {
                all.extend(mixture.fore.materials());
                all.extend(mixture.back.materials());
            }
        }
        all
    }

    /// May rays pass where a mixture has `void`?
    pub fn has_gaps(&self) -> bool {
        let gaps = |part: &Varying| part.has_gaps() || (part.material.is_none() && !part.mixes_materials);
        self.steps.iter().any(|step| match step {
            Step::Mixture(m) => m.mixes_materials() && (gaps(&m.fore) || gaps(&m.back)),
            _ => false,
        })
    }

    /// What an evaluation has found to be wrong.
    pub fn fault(&self) -> Option<Error> {
        fault_of(&self.steps)
    }
}

impl Step {
    fn add_to(&self, sum: &mut Modulation, ray: &RayState) {
        match self {
            Self::Pattern(pattern) => sum.tint *= tint(pattern, ray),
            Self::Texture(field) => {
                if let Some(values) = field.values(ray) {
                    sum.bend += field.world_direction(Vec3::from_array(values));
                }
            }
            Self::Mixture(mixture) => {
                let Some(share) = mixture.share(ray) else { return };
                let part = |varying: &Varying| modulation_of(&varying.steps, ray);
                let mixed = part(&mixture.fore).mixed(part(&mixture.back), share);
                sum.tint *= mixed.tint;
                sum.bend += mixed.bend;
            }
        }
    }
}

impl Mixture {
    pub fn mixes_materials(&self) -> bool {
        let has = |part: &Varying| part.material.is_some() || part.mixes_materials;
        has(&self.fore) || has(&self.back)
    }

    fn share(&self, ray: &RayState) -> Option<f64> {
        match &self.weight {
            Weight::Field(field) => field.values(ray).map(|[share]: [f64; 1]| share.clamp(0.0, 1.0)),
            Weight::Text(text) => Some(f64::from(u8::from(text.contains(ray.point)))),
        }
    }

    /// What an evaluation of the weight has found to be wrong.
    fn fault(&self) -> Option<Error> {
        match &self.weight {
            Weight::Field(field) => field.fault(),
            Weight::Text(_) => None,
        }
    }
}

impl Arrival {
    /// What expressions see of it.
    pub fn ray_state(&self) -> RayState {
        RayState {
            travelled: self.travelled,
            local: self.local,
            perturbed: self.normal,
            color: self.tint,
            ..RayState::new(self.point, self.flat_normal, self.direction, self.distance)
        }
    }

    /// The same after patterns and textures.
    pub fn modulated(self, modulation: &Modulation) -> Self {
        let bent =
            if modulation.bend == Vec3::ZERO { self } else { self.smoothed(self.normal + modulation.bend) };
        Self { tint: self.tint * modulation.tint, ..bent }
    }
}
