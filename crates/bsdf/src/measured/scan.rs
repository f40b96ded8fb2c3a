//! What a goniophotometer has measured, in the coordinates of a table.

use crate::table::turned;
use glam::DVec2;
use std::sync::Arc;
use sunpeak_core::{Error, Location, Result, Vec3};

/// One exiting direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Unit vector away from the surface.
    pub exit: Vec3,
    /// BSDF [1/sr].
    pub value: f64,
}

/// The readings of one incidence, in a BSDF's frame: z is the front normal, y up.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// Name of the sample, if the file has it.
    pub name: String,
    /// The file, and where it says the incidence.
    pub place: Location,
    /// Unit vector to the light.
    pub to_light: Vec3,
    /// What was measured.
    pub readings: Vec<Reading>,
}

impl Scan {
    /// Without readings.
    pub fn new(file: Arc<str>, line: usize, to_light: Vec3) -> Self {
        Self { name: String::new(), place: Location::new(file, line, 0), to_light, readings: Vec::new() }
    }
}

/// Light that meets one side, and leaves on the same one or on the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Light meets the front of the frame (z > 0).
    pub front: bool,
    /// It leaves on the same side.
    pub reflection: bool,
}

impl Kind {
    /// All four.
    pub const ALL: [Self; 4] = [
        Self { front: true, reflection: false },
        Self { front: false, reflection: false },
        Self { front: true, reflection: true },
        Self { front: false, reflection: true },
    ];

    /// In words, for messages.
    pub fn name(self) -> &'static str {
        match (self.front, self.reflection) {
            (true, false) => "front transmission",
            (false, false) => "back transmission",
            (true, true) => "front reflection",
            (false, true) => "back reflection",
        }
    }
}

/// Points of the table's disk, and BSDF values [1/sr] there.
pub type Points = Vec<(DVec2, f64)>;

/// One incidence of one kind, in a table's points: `p` is minus the (x, y) of the direction to the light.
#[derive(Clone, Debug)]
pub struct Incidence {
    /// Incident point.
    pub p: DVec2,
    /// Exiting points and BSDF values [1/sr].
    pub points: Points,
}

impl Incidence {
    /// With the incident point on the positive x axis.
    pub fn turned(&self) -> Self {
        let points = self.points.iter().map(|&(q, f)| (turned(self.p, q), f)).collect();
        Self { p: DVec2::new(self.p.length(), 0.0), points }
    }

    /// Mirrored along the axes.
    pub fn mirrored(&self, signs: DVec2) -> Self {
        Self { p: self.p * signs, points: self.points.iter().map(|&(q, f)| (q * signs, f)).collect() }
    }

    /// Angle of incidence [deg].
    pub fn theta_deg(&self) -> f64 {
        self.p.length().min(1.0).asin().to_degrees()
    }
}

/// Incidences closer than this on the disk are one.
pub const SAME: f64 = 1e-3;

/// Put the readings of the same incidence together.
pub fn merged(incidences: impl IntoIterator<Item = Incidence>) -> Vec<Incidence> {
    let mut all: Vec<Incidence> = Vec::new();
    for incidence in incidences {
        match all.iter_mut().find(|known| known.p.distance(incidence.p) < SAME) {
            Some(known) => known.points.extend(incidence.points),
            None => all.push(incidence),
        }
    }
    all
}

/// Least readings of an incidence: fewer say nothing of a hemisphere.
const LEAST_READINGS: usize = 12;

/// The incidences of a kind. Readings on the other side of the surface are of the other kind.
pub fn incidences(scans: &[Scan], kind: Kind) -> Result<Vec<Incidence>> {
    let mut found = Vec::new();
    for scan in scans.iter().filter(|scan| (scan.to_light.z > 0.0) == kind.front) {
        let same_side = |reading: &&Reading| (reading.exit.z > 0.0) == (kind.front == kind.reflection);
        let own = scan.readings.iter().filter(same_side);
        // Noise around zero may be negative.
        let points: Points = own.map(|r| (r.exit.truncate(), r.value.max(0.0))).collect();
        if points.is_empty() {
            continue;
        }
        if points.len() < LEAST_READINGS {
            return Err(Error::input(
                scan.place.clone(),
                format!("{} readings of {}; expected {LEAST_READINGS} or more", points.len(), kind.name()),
            ));
        }
        let p = -scan.to_light.truncate();
        found.push(Incidence { p: if p.length() < SAME { DVec2::ZERO } else { p }, points });
    }
    Ok(merged(found))
}
