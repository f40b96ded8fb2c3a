//! The shape of `peak.json`.

use serde::{Deserialize, Serialize};

/// What the file says it is.
pub const FORMAT: &str = "sunpeak-split";

/// Version of the format that this program writes and reads.
pub const VERSION: u32 = 1;

/// The whole file.
#[derive(Debug, Serialize, Deserialize)]
pub struct PeakFile {
    pub format: String,
    pub version: u32,
    /// Name and manufacturer of the product, as in the XML file.
    pub name: String,
    pub manufacturer: String,
    /// What the numbers mean, for people.
    #[serde(default)]
    pub notes: Vec<String>,
    /// The residual: a file beside this one.
    pub residual: String,
    /// Checksum of its text (FNV-1a, 64 bits, hexadecimal): without it, it is not compared.
    #[serde(default)]
    pub residual_fnv1a: Option<String>,
    pub sides: Vec<SideFile>,
}

/// One transmission of the file.
#[derive(Debug, Serialize, Deserialize)]
pub struct SideFile {
    /// `Transmission Front` or `Transmission Back`, as in the XML file.
    pub direction: String,
    /// Which side of the frame the rays meet whose light this is: `front` or `back`.
    pub met_by_rays_at: String,
    pub basis: String,
    /// Full width at half maximum [deg] of the instrument's blur that was taken for the peak.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instrument_fwhm_deg: Option<f64>,
    pub division: Division,
    /// CIE channels of the excess: `Y`, or `Y`, `X`, `Z`.
    pub channels: Vec<String>,
    pub columns: Vec<ColumnFile>,
}

/// The incident division.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Division {
    /// The patches of the basis.
    Patches { count: usize },
    /// `side * side` cells of the square (Shirley and Chiu 1997).
    Square { side: usize },
    /// `side / 2` rings of equal width in sin(theta), from grazing to normal.
    Radial { side: usize },
}

/// One column: where it is, what was found, and in which cells.
#[derive(Debug, Serialize, Deserialize)]
pub struct ColumnFile {
    pub column: usize,
    pub theta_deg: f64,
    pub phi_deg: f64,
    pub theta_bounds_deg: [f64; 2],
    pub phi_bounds_deg: [f64; 2],
    pub projected_solid_angle_sr: f64,
    /// Luminous through transmittance [-].
    pub through: f64,
    /// The same in Radiance's primaries.
    pub through_rgb: [f64; 3],
    pub interval: [f64; 2],
    /// Without a limit where nothing is scattered beside the peak.
    pub contrast: Option<f64>,
    pub detection_limit: f64,
    pub lobe_sigma: f64,
    pub ledger: Ledger,
    /// Cells that were lowered.
    pub cells: Vec<CellFile>,
}

/// Hemispherical transmittances of a column [-], luminous: table = residual + through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    pub table: f64,
    pub residual: f64,
    pub through: f64,
    /// table - residual - through.
    pub error: f64,
}

/// An exiting cell and what was taken from it [1/sr].
#[derive(Debug, Serialize, Deserialize)]
pub struct CellFile {
    /// Number of the exiting patch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub patch: Option<usize>,
    /// Corner x, y and edge on the unit square.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub square: Option<[f64; 3]>,
    /// Table less residual, in the side's channels.
    pub excess: Vec<f64>,
}
