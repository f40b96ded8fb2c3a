//! `BSDF` and `aBSDF`: a measured or simulated table, its through peak, and diffuse lobes beside it.
//!
//! With the split the table is a residual and a delta, and both shadow rays and sampled paths go straight on by the delta.
//! The rules of Radiance and of the paper are not a decomposition: the delta is for shadow rays to light sources and for
//! view rays only; towards light sources the table is muted around the straight direction; samples of view rays there are
//! dropped; everybody else sees the whole table. Here they do what the reference does, its double counting included.
//!
//! A `BSDF` with thickness stands for geometry that is there too (manual, "BSDF"): view and shadow rays pass and meet that
//! geometry, and so do rays from its side; a scattered ray that comes from outside meets the table, and what it sends through
//! starts beyond the geometry. What the table lets through straight is what shadow rays find between the parts of the geometry:
//! with the split it goes straight, and emitters behind it are left to shadow rays; so nothing counts twice. (With the other
//! rules such a table is whole, and the straight light of an emitter does count twice, as in Radiance.)

use super::{Arrival, Scattering, Smooth, SmoothValue, fault_of_orientation, smooth::SmoothSample};
use crate::backlight::Backlight;
use std::{f64::consts::FRAC_1_PI, sync::Arc};
use sunpeak_bsdf::{Backlit, Bsdf, Mode, PeakRule};
use sunpeak_core::{Error, Frame, Rgb, Vec3, luminance, warp};
use sunpeak_scene::{Orientation, Thickness};

/// Thickness up to this is none [m] (Radiance, `FTINY`).
const NO_THICKNESS: f64 = 1e-6;

/// Is there geometry that a surface of this thickness stands for, anywhere?
pub(crate) fn stands_for_geometry(thickness: &Thickness) -> bool {
    match thickness {
        Thickness::Fixed(thickness) => thickness.abs() > NO_THICKNESS,
        Thickness::Varying { .. } => true,
    }
}

/// The material.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub bsdf: Arc<Bsdf>,
    /// Is it an `aBSDF`?
    pub is_aperture: bool,
    /// How far what it stands for reaches behind its front, or, negative, before it.
    pub thickness: Thickness,
    pub rule: PeakRule,
    pub up: Orientation,
    /// Is the frame left-handed?
    pub mirrored: bool,
    pub front_diffuse: Rgb,
    pub back_diffuse: Rgb,
    pub diffuse_transmission: Rgb,
}

impl Table {
    /// z the front normal, y up, x = y cross z, or its opposite in a mirrored instance. Where a curved surface's normal runs
    /// along the up vector, any frame serves.
    fn frame(&self, arrival: &Arrival) -> Frame {
        self.frame_by(arrival.normal, arrival.orientation(&self.up))
    }

    fn frame_by(&self, normal: Vec3, up: Vec3) -> Frame {
        let frame = Frame::from_normal_up(normal, up).unwrap_or_else(|| Frame::from_normal(normal));
        if self.mirrored { Frame { x: -frame.x, ..frame } } else { frame }
    }

    /// The frame all over a flat surface; `None` if it varies.
    pub fn level_frame(&self, normal: Vec3) -> Option<Frame> {
        match &self.up {
            Orientation::Fixed(up) => Some(self.frame_by(normal, *up)),
            Orientation::Varying(_) => None,
        }
    }

    /// Does it stand for geometry that is there too, anywhere?
    pub fn is_proxy(&self) -> bool {
        stands_for_geometry(&self.thickness)
    }

    /// How far what it stands for reaches where a ray arrives [m]; 0: there is none.
    pub fn thickness(&self, arrival: &Arrival) -> f64 {
        match &self.thickness {
            Thickness::Fixed(_) if !self.is_proxy() => 0.0,
            Thickness::Fixed(thickness) => *thickness,
            Thickness::Varying { field, scale } => {
                let thickness =
                    field.values(&arrival.ray_state()).map_or(0.0, |[value]: [f64; 1]| value * scale);
                if thickness.abs() > NO_THICKNESS { thickness } else { 0.0 }
            }
        }
    }

    /// Is it invisible to a ray that is no shadow ray? `view`: the ray comes from the camera and met only mirrors and clear panes.
    pub fn is_passed(&self, arrival: &Arrival, view: bool) -> bool {
        let thickness = self.thickness(arrival);
        thickness != 0.0 && (view || (thickness > 0.0) != arrival.at_front())
    }

    /// How far from the surface light that goes on straight starts.
    pub fn offset(&self, arrival: &Arrival) -> Vec3 {
        arrival.normal * -self.thickness(arrival)
    }

    /// What an evaluation of its expressions has found to be wrong.
    pub fn fault(&self) -> Option<Error> {
        let of_thickness = match &self.thickness {
            Thickness::Fixed(_) => None,
            Thickness::Varying { field, .. } => field.fault(),
        };
        fault_of_orientation(&self.up).or(of_thickness)
    }

    pub fn is_reference_rule(&self) -> bool {
        matches!(self.rule, PeakRule::Radiance | PeakRule::Paper)
    }

    /// Share of a shadow ray that goes straight on. By the rules of the reference only rays to light sources do: the sky
    /// is found by sampling the table.
    pub fn straight(&self, arrival: &Arrival, direct: bool) -> Rgb {
        if self.rule == PeakRule::Off || (self.is_reference_rule() && !direct) {
            return Rgb::ZERO;
        }
        self.bsdf.through(self.frame(arrival).to_local(-arrival.direction), self.rule) * arrival.tint
    }

    /// What the surface gives off, as rays meet it at its front or not, in the light of a far field behind it (world axes).
    pub fn backlit(&self, normal: Vec3, at_front: bool, field: impl Fn(Vec3) -> Rgb) -> Option<Backlit> {
        let frame = self.level_frame(normal)?;
        self.bsdf.backlit(at_front, self.rule, |w_out| field(frame.to_world(w_out)))
    }

    pub fn scatter(&self, arrival: &Arrival, view: bool) -> Scattering<'_> {
        let frame = self.frame(arrival);
        let w_in = frame.to_local(-arrival.direction);
        let goes_straight = self.rule == PeakRule::Split || (self.is_reference_rule() && view);
        let straight =
            if goes_straight { self.bsdf.through(w_in, self.rule) * arrival.tint } else { Rgb::ZERO };
        let hemispherical = |mode| luminance(self.bsdf.hemispherical_smooth(w_in, mode, self.rule));
        let lobes = TableLobes {
            table: self,
            frame,
            w_in,
            thickness: self.thickness(arrival),
            view,
            tint: arrival.tint,
            diffuse_reflection: if arrival.at_front() { self.front_diffuse } else { self.back_diffuse },
            sides: Sides {
                reflected: hemispherical(Mode::Reflection),
                transmitted: hemispherical(Mode::Transmission),
            },
        };
        let smooth = if lobes.albedo() > 0.0 { Smooth::Table(lobes) } else { Smooth::None };
        Scattering { straight, mirrored: Rgb::ZERO, refracted: [None; 2], smooth }
    }
}

/// The smooth lobes at one point, z along the front normal.
#[derive(Clone, Debug)]
pub(crate) struct TableLobes<'w> {
    table: &'w Table,
    frame: Frame,
    w_in: Vec3,
    /// How far behind the front transmitted light starts [m].
    thickness: f64,
    view: bool,
    /// What patterns multiply everything with.
    tint: Rgb,
    diffuse_reflection: Rgb,
    sides: Sides,
}

/// Luminous shares that the table scatters.
#[derive(Clone, Copy, Debug)]
struct Sides {
    reflected: f64,
    transmitted: f64,
}

/// At least this share of a table's samples is transmitted, if it transmits anything: a shade reflects much more than it lets
/// through, but the light is on its other side.
const LEAST_TRANSMITTED: f64 = 0.4;

/// Transmittance below this is none.
const NO_TRANSMISSION: f64 = 1e-5;

impl Sides {
    fn sum(&self) -> f64 {
        self.reflected + self.transmitted
    }

    /// Chance that a sample is a reflection in proportion to the flux, and as we draw it.
    fn reflected_chances(&self) -> (f64, f64) {
        let by_flux = self.reflected / self.sum();
        if self.transmitted < NO_TRANSMISSION {
            return (by_flux, by_flux);
        }
        (by_flux, by_flux.min(1.0 - LEAST_TRANSMITTED))
    }

    /// The first of the numbers that [`Bsdf::sample_smooth`] takes: below the chance by flux it draws a reflection.
    fn first_number(&self, u: f64) -> f64 {
        let (by_flux, ours) = self.reflected_chances();
        if u < ours { u / ours * by_flux } else { by_flux + (u - ours) / (1.0 - ours) * (1.0 - by_flux) }
    }

    /// Our density over that in proportion to the flux.
    fn boost(&self, is_reflection: bool) -> f64 {
        let (by_flux, ours) = self.reflected_chances();
        match (is_reflection, ours == by_flux) {
            (_, true) => 1.0,
            (true, false) => ours / by_flux,
            (false, false) => (1.0 - ours) / (1.0 - by_flux),
        }
    }
}

impl TableLobes<'_> {
    /// Luminous weights: diffuse reflection, diffuse transmission, table.
    fn weights(&self) -> [f64; 3] {
        [luminance(self.diffuse_reflection), luminance(self.table.diffuse_transmission), self.sides.sum()]
    }

    pub fn albedo(&self) -> f64 {
        self.weights().iter().sum()
    }

    pub fn offset(&self, direction: Vec3) -> Vec3 {
        let is_transmission = direction.dot(self.frame.z) * self.w_in.z < 0.0;
        if is_transmission { self.frame.z * -self.thickness } else { Vec3::ZERO }
    }

    /// Radiance that the surface gives off in the light of a far field.
    pub fn backlit(&self, backlight: &Backlight) -> Rgb {
        backlight.radiance(self.w_in) * self.tint
    }

    pub fn has_source_rule(&self) -> bool {
        self.table.is_reference_rule()
    }

    fn diffuse(&self, w_out: Vec3) -> Rgb {
        let is_reflection = w_out.z * self.w_in.z > 0.0;
        let share = if is_reflection { self.diffuse_reflection } else { self.table.diffuse_transmission };
        share * self.tint * FRAC_1_PI
    }

    pub fn evaluate(&self, direction: Vec3) -> SmoothValue {
        let w_out = self.frame.to_local(direction);
        let glossy = if self.is_muted(w_out) {
            Rgb::ZERO
        } else {
            self.table.bsdf.evaluate_smooth(self.w_in, w_out, self.table.rule) * self.tint
        };
        SmoothValue { diffuse: self.diffuse(w_out), glossy }
    }

    /// By the rules of the reference, view rays that go straight on do not see the table around there as well.
    fn is_muted(&self, w_out: Vec3) -> bool {
        self.view
            && self.has_source_rule()
            && self.table.bsdf.is_muted_for_view(self.w_in, w_out, self.table.rule)
    }

    pub fn toward_source(&self, direction: Vec3, solid_angle: f64) -> SmoothValue {
        if !self.has_source_rule() {
            return self.evaluate(direction);
        }
        let w_out = self.frame.to_local(direction);
        let glossy = self.table.bsdf.evaluate_to_source(self.w_in, w_out, solid_angle, self.table.rule);
        SmoothValue { diffuse: self.diffuse(w_out), glossy: glossy * self.tint }
    }

    pub fn pdf(&self, direction: Vec3) -> f64 {
        let w_out = self.frame.to_local(direction);
        let [reflect, transmit, table] = self.weights();
        let is_reflection = w_out.z * self.w_in.z > 0.0;
        let diffuse = if is_reflection { reflect } else { transmit } * w_out.z.abs() * FRAC_1_PI;
        if table <= 0.0 {
            return diffuse / self.albedo();
        }
        let by_flux = self.table.bsdf.pdf_smooth(self.w_in, w_out, self.table.rule);
        (diffuse + table * by_flux * self.sides.boost(is_reflection)) / self.albedo()
    }

    pub fn sample(&self, choice: f64, u: [f64; 2], v: f64) -> Option<SmoothSample> {
        let [reflect, transmit, _] = self.weights();
        let choice = choice * self.albedo();
        let towards = |sign: f64| warp::cosine_hemisphere(u) * Vec3::new(1.0, 1.0, sign);
        let side = self.w_in.z.signum();
        let w_out = if choice < reflect {
            towards(side)
        } else if choice < reflect + transmit {
            towards(-side)
        } else {
            self.sample_table([v, u[0], u[1]])?
        };
        let direction = self.frame.to_world(w_out);
        let pdf = self.pdf(direction);
        let weight = self.evaluate(direction).scaled(w_out.z.abs() / pdf);
        let source_factor = if self.has_source_rule() { 0.0 } else { 1.0 };
        (pdf > 0.0).then_some(SmoothSample { direction, weight, pdf, source_factor })
    }

    fn sample_table(&self, u: [f64; 3]) -> Option<Vec3> {
        let u = [self.sides.first_number(u[0]), u[1], u[2]];
        self.table.bsdf.sample_smooth(self.w_in, u, self.table.rule).map(|sample| sample.w_out)
    }
}

#[cfg(test)]
mod tests;
