//! One product: front and back, reflection and transmission, with the Radiance library's meaning of sides.

use crate::{
    backlit::Backlit,
    distribution::Distribution,
    peak::{PeakRule, reference},
    proposal::{Oriented, Proposal},
    table::{Columns, Table},
    xml::Document,
};
use glam::DVec2;
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};
use sunpeak_core::{Rgb, Vec3, luminance};

/// Components that scatter less than this [-] count as missing (as in Radiance's library).
const INSIGNIFICANT: f64 = 0.001;

/// Which half of the scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Both directions on one side.
    Reflection,
    /// On opposite sides.
    Transmission,
}

/// A sampled direction of the smooth lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Unit vector.
    pub w_out: Vec3,
    /// f |cos| / pdf.
    pub weight: Rgb,
    /// Density [1/sr].
    pub pdf: f64,
}

/// One product: front and back, reflection and transmission.
#[derive(Debug)]
pub struct Bsdf {
    /// Name of the material in the file.
    pub name: String,
    /// Manufacturer in the file.
    pub manufacturer: String,
    /// Thickness in the file [m].
    pub thickness_m: Option<f64>,
    /// How it was made, and its statistical error.
    pub comments: String,
    /// Names of all bands of the file.
    pub bands: Vec<String>,
    /// `IncidentDataStructure` of the file: `Columns`, `TensorTree3` …
    pub structure: String,
    /// What was tolerated in the file.
    pub warnings: Vec<String>,
    /// Transmission for the traced ray at the front, at the back; the same for reflection.
    transmission: [Option<Lobe>; 2],
    reflection: [Option<Lobe>; 2],
}

/// A side and mode, with its proposals made on first use.
#[derive(Debug)]
struct Lobe {
    oriented: Oriented,
    has_peak: bool,
    whole: OnceLock<Proposal>,
    residual: OnceLock<Proposal>,
}

impl Lobe {
    fn new(distribution: &Arc<Distribution>, reversed: bool) -> Self {
        let oriented = Oriented { distribution: distribution.clone(), reversed };
        let has_peak = distribution.split().has_peak();
        Self { oriented, has_peak, whole: OnceLock::new(), residual: OnceLock::new() }
    }

    fn proposal(&self, rule: PeakRule) -> &Proposal {
        // A table without a peak is its own residual.
        if rule == PeakRule::Split && self.has_peak {
            self.residual.get_or_init(|| Proposal::new(&self.oriented, true))
        } else {
            self.whole.get_or_init(|| Proposal::new(&self.oriented, false))
        }
    }
}

/// A lobe as rays from one direction meet it.
struct Met<'a> {
    oriented: &'a Oriented,
    proposal: &'a Proposal,
    column: usize,
}

impl Met<'_> {
    fn hemispherical(&self) -> Rgb {
        self.proposal.hemispherical(self.column)
    }

    fn luminous(&self) -> f64 {
        self.proposal.luminous(self.column)
    }
}

/// Tables of one product by the names of the file, before they get sides.
#[derive(Debug, Default)]
pub struct Sides {
    /// XML `Transmission Front`.
    pub transmission_front: Option<Arc<Distribution>>,
    /// XML `Transmission Back`.
    pub transmission_back: Option<Arc<Distribution>>,
    /// XML `Reflection Front`.
    pub reflection_front: Option<Arc<Distribution>>,
    /// XML `Reflection Back`.
    pub reflection_back: Option<Arc<Distribution>>,
}

impl Bsdf {
    /// From distributions named as in a file.
    ///
    /// The file's `Front` is where WINDOW has the outside; a BSDF's frame has its front towards the viewer. So light that
    /// meets the front of the frame is what the file calls `Back`, as in Radiance's library.
    pub fn from_sides(document: Document, sides: Sides) -> Self {
        let significant = |d: Option<Arc<Distribution>>| d.filter(|d| is_significant(d));
        let front = significant(sides.transmission_back);
        let back = significant(sides.transmission_front);
        let lobe = |own: &Option<Arc<Distribution>>, other: &Option<Arc<Distribution>>| match (own, other) {
            (Some(own), _) => Some(Lobe::new(own, false)),
            (None, Some(other)) => Some(Lobe::new(other, true)),
            (None, None) => None,
        };
        let transmission = [lobe(&front, &back), lobe(&back, &front)];
        let reflection =
            [sides.reflection_back, sides.reflection_front].map(|d| Some(Lobe::new(&significant(d)?, false)));
        Self {
            name: document.name,
            manufacturer: document.manufacturer,
            thickness_m: document.thickness_m,
            comments: document.comments,
            bands: document.bands,
            structure: document.structure,
            warnings: document.warnings,
            transmission,
            reflection,
        }
    }

    /// What the file says beside its tables.
    pub(crate) fn document(&self) -> Document {
        Document {
            name: self.name.clone(),
            manufacturer: self.manufacturer.clone(),
            thickness_m: self.thickness_m,
            comments: self.comments.clone(),
            structure: self.structure.clone(),
            ..Document::default()
        }
    }

    fn lobe(&self, w_in: Vec3, mode: Mode) -> Option<&Lobe> {
        let side = usize::from(w_in.z <= 0.0);
        match mode {
            Mode::Transmission => self.transmission[side].as_ref(),
            Mode::Reflection => self.reflection[side].as_ref(),
        }
    }

    /// The table that light meets which is traced from `w_in`'s side, and whether it is traced against the table.
    pub fn distribution(&self, w_in: Vec3, mode: Mode) -> Option<&Oriented> {
        self.lobe(w_in, mode).map(|l| &l.oriented)
    }

    /// Are all of its tables matrices whose incident and exiting patches are those of a division?
    pub(crate) fn is_tabulated_in(&self, division: &Columns) -> bool {
        let Columns::Patches(basis) = division else { return false };
        self.own_distributions().iter().all(
            |(_, d)| matches!(d.luminous(), Table::Matrix(m) if m.incident == *basis && m.exiting == *basis),
        )
    }

    fn value(&self, w_in: Vec3, w_out: Vec3, residual: bool) -> Rgb {
        match self.distribution(w_in, mode(w_in, w_out)) {
            Some(oriented) => oriented.value(incident_point(w_in), exiting_point(w_out), residual),
            None => Rgb::ZERO,
        }
    }

    /// The table as it is in the file [1/sr].
    pub fn evaluate(&self, w_in: Vec3, w_out: Vec3) -> Rgb {
        self.value(w_in, w_out, false)
    }

    /// What stays after `rule` took its peak [1/sr]: the residual for `Split`, the table itself for the others.
    pub fn evaluate_smooth(&self, w_in: Vec3, w_out: Vec3, rule: PeakRule) -> Rgb {
        self.value(w_in, w_out, rule == PeakRule::Split)
    }

    /// `Radiance` and `Paper`: BSDF [1/sr] towards a light source of `solid_angle` [sr] around `w_out`, with the
    /// exclusion zone around the straight direction. Other rules: [`Self::evaluate_smooth`].
    pub fn evaluate_to_source(&self, w_in: Vec3, w_out: Vec3, solid_angle: f64, rule: PeakRule) -> Rgb {
        match rule {
            PeakRule::Radiance | PeakRule::Paper => {
                reference::evaluate_to_source(self, w_in, w_out, solid_angle, rule)
            }
            PeakRule::Off | PeakRule::Split => self.evaluate_smooth(w_in, w_out, rule),
        }
    }

    /// `Radiance` and `Paper`: is `w_out` so close to the straight direction that a view ray drops the sample?
    pub fn is_muted_for_view(&self, w_in: Vec3, w_out: Vec3, rule: PeakRule) -> bool {
        match rule {
            PeakRule::Radiance | PeakRule::Paper => reference::is_muted_for_view(self, w_in, w_out, rule),
            PeakRule::Off | PeakRule::Split => false,
        }
    }

    /// Through transmittance [-] along `w_out = -w_in`; zero for `Off`.
    pub fn through(&self, w_in: Vec3, rule: PeakRule) -> Rgb {
        match rule {
            PeakRule::Off => Rgb::ZERO,
            PeakRule::Split => self
                .distribution(w_in, Mode::Transmission)
                .map_or(Rgb::ZERO, |o| o.through(incident_point(w_in))),
            PeakRule::Radiance | PeakRule::Paper => {
                reference::peak(self, w_in, rule).map_or(Rgb::ZERO, |p| p.through)
            }
        }
    }

    /// Hemispherical reflectance or transmittance [-] of what [`Self::evaluate_smooth`] gives.
    pub fn hemispherical_smooth(&self, w_in: Vec3, mode: Mode, rule: PeakRule) -> Rgb {
        self.met(w_in, mode, rule).map_or(Rgb::ZERO, |lobe| lobe.hemispherical())
    }

    /// What a side of the product gives off that a far field lights from the other side: the front for `at_front`. `light` is
    /// the field's radiance in a direction of the BSDF's frame. What `rule` splits off is left out. `None` where nothing comes
    /// through.
    pub fn backlit(&self, at_front: bool, rule: PeakRule, light: impl Fn(Vec3) -> Rgb) -> Option<Backlit> {
        let side = if at_front { 1.0 } else { -1.0 };
        let oriented = self.distribution(Vec3::new(0.0, 0.0, side), Mode::Transmission)?;
        let light_at = |p_out: DVec2| {
            let height = (1.0 - p_out.length_squared()).max(0.0).sqrt();
            light(p_out.extend(-side * height))
        };
        Some(Backlit::new(oriented, rule == PeakRule::Split, light_at))
    }

    /// Sample the smooth part, reflection and transmission together, in proportion to luminous f |cos|; `None` if there is
    /// nothing to sample. `u` is uniform in the unit cube.
    pub fn sample_smooth(&self, w_in: Vec3, u: [f64; 3], rule: PeakRule) -> Option<Sample> {
        let share = reflected_share(&self.lobes_met(w_in, rule))?;
        let (mode, chosen, first) = if u[0] < share {
            (Mode::Reflection, share, u[0] / share)
        } else {
            (Mode::Transmission, 1.0 - share, (u[0] - share) / (1.0 - share))
        };
        let sample = self.sample_mode(w_in, mode, [first, u[1], u[2]], rule)?;
        Some(Sample { w_out: sample.w_out, weight: sample.weight / chosen, pdf: sample.pdf * chosen })
    }

    /// Density [1/sr] of [`Self::sample_smooth`].
    pub fn pdf_smooth(&self, w_in: Vec3, w_out: Vec3, rule: PeakRule) -> f64 {
        let lobes = self.lobes_met(w_in, rule);
        let Some(share) = reflected_share(&lobes) else { return 0.0 };
        let (lobe, chosen) = match mode(w_in, w_out) {
            Mode::Reflection => (&lobes[0], share),
            Mode::Transmission => (&lobes[1], 1.0 - share),
        };
        let Some(lobe) = lobe else { return 0.0 };
        let (p_in, p_out) = (incident_point(w_in), exiting_point(w_out));
        let value = luminance(lobe.oriented.value(p_in, p_out, rule == PeakRule::Split));
        chosen * lobe.proposal.density(p_in, lobe.column, p_out, value) * w_out.z.abs()
    }

    /// Sample the smooth part of one mode, in proportion to luminous f |cos|; `None` if there is nothing to sample.
    pub fn sample_mode(&self, w_in: Vec3, mode: Mode, u: [f64; 3], rule: PeakRule) -> Option<Sample> {
        let lobe = self.met(w_in, mode, rule)?;
        let sampled = lobe.proposal.sample(incident_point(w_in), lobe.column, u)?;
        let height = (1.0 - sampled.p_out.length_squared()).max(0.0).sqrt();
        let above = (w_in.z > 0.0) == (mode == Mode::Reflection);
        let w_out = sampled.p_out.extend(if above { height } else { -height });
        let pdf = sampled.density * height;
        (pdf > 0.0).then(|| Sample { w_out, weight: sampled.value / sampled.density, pdf })
    }

    /// Density [1/sr] of [`Self::sample_mode`].
    pub fn pdf_mode(&self, w_in: Vec3, w_out: Vec3, rule: PeakRule) -> f64 {
        let Some(lobe) = self.met(w_in, mode(w_in, w_out), rule) else { return 0.0 };
        if lobe.luminous() <= 0.0 {
            return 0.0;
        }
        let (p_in, p_out) = (incident_point(w_in), exiting_point(w_out));
        let value = luminance(lobe.oriented.value(p_in, p_out, rule == PeakRule::Split));
        lobe.proposal.density(p_in, lobe.column, p_out, value) * w_out.z.abs()
    }

    #[inline]
    fn met(&self, w_in: Vec3, mode: Mode, rule: PeakRule) -> Option<Met<'_>> {
        let lobe = self.lobe(w_in, mode)?;
        let proposal = lobe.proposal(rule);
        Some(Met { oriented: &lobe.oriented, proposal, column: proposal.column(incident_point(w_in)) })
    }

    /// Reflection and transmission.
    fn lobes_met(&self, w_in: Vec3, rule: PeakRule) -> [Option<Met<'_>>; 2] {
        [self.met(w_in, Mode::Reflection, rule), self.met(w_in, Mode::Transmission, rule)]
    }
}

/// Probability that a sample is a reflection; `None` if nothing is scattered.
fn reflected_share(lobes: &[Option<Met>; 2]) -> Option<f64> {
    let luminous = |lobe: &Option<Met>| lobe.as_ref().map_or(0.0, Met::luminous);
    let (r, t) = (luminous(&lobes[0]), luminous(&lobes[1]));
    (r + t > 0.0).then(|| r / (r + t))
}

fn mode(w_in: Vec3, w_out: Vec3) -> Mode {
    if (w_in.z > 0.0) == (w_out.z > 0.0) { Mode::Reflection } else { Mode::Transmission }
}

/// Minus (x, y) of the traced ray's side.
fn incident_point(w_in: Vec3) -> DVec2 {
    -w_in.truncate()
}

fn exiting_point(w_out: Vec3) -> DVec2 {
    w_out.truncate()
}

fn is_significant(d: &Distribution) -> bool {
    let (table, columns) = (d.luminous(), d.columns());
    let hemispherical = |column| -> f64 {
        let cells = table.cells(columns, column);
        cells.iter().map(|c| f64::from(table.values()[c.index]) * c.projected_solid_angle).sum()
    };
    (0..columns.len()).into_par_iter().any(|column| hemispherical(column) > INSIGNIFICANT)
}
