//! Path tracing of daylight through shades: pictures, radiance along rays, irradiance at sensors.
//!
//! [`World::compile`] turns a scene into one hierarchy of surfaces with their materials and emitters. Paths go backwards from the
//! eye or the sensor; at every vertex shadow rays look for suns, sky and lamps, and multiple importance sampling weighs them
//! against the paths that find them by themselves. All is computed in three channels and double precision.
//!
//! ```
//! use sunpeak_core::{Control, Vec3};
//! use sunpeak_render::{RenderOptions, World, trace_irradiance};
//! use sunpeak_scene::{LoadOptions, Scene};
//! let text = "void light white 0 0 3 1 1 1\nwhite source sky 0 0 4 0 0 1 180";
//! let scene = Scene::parse(text, "sky.rad", &LoadOptions::default())?;
//! let world = World::compile(&scene, &Default::default())?;
//! let up = [(Vec3::ZERO, Vec3::Z)];
//! let irradiance = trace_irradiance(&world, &up, &RenderOptions::default(), &Control::new())?;
//! assert!((irradiance.values[0].x - std::f64::consts::PI).abs() < 1e-2);
//! # Ok::<(), sunpeak_core::Error>(())
//! ```
//!
//! # Straight passes are null events
//! Clear glass, the straight part of `trans`, and the peak of an `aBSDF` do not end a path segment. Shadow rays go straight on
//! through any number of layers, times what each lets through; sampled paths go on in proportion. A source that is met behind
//! such layers counts in full only on a chain that is straight or mirrored all the way from the camera.
//!
//! # Behind shades
//! Where a scene has shades (surfaces of a BSDF table or of `trans`), diffuse surfaces draw part of their directions towards them
//! and against those into which their tables send the suns: light that a shade scatters is found by paths alone. Of a shade
//! before a far field the light is known beforehand, and paths add only what differs from it. Light that passes a table's peak
//! from an emitter is left to shadow rays, which find it better than the few sampled paths that go straight.
//!
//! # What is left out
//! A sun (a `source` narrower than [`SMALL_SOURCE_DEG`]) that a scattered path meets by way of a mirror or a solid of glass does
//! not count: it would be a firefly. Instead, planar `mirror`s make virtual suns, and shadow rays to suns are refracted by
//! solids of glass whose faces bend them back, both as in Radiance. Sunlight that reaches a diffuse surface by the reflection
//! of glass panes or polished surfaces, or through curved solids, is missing, as it is in Radiance. Wider emitters, and lamps
//! in the room, count by all ways.
//!
//! # Suns in pictures
//! Suns that the eye sees along straight chains, or in flat mirrors and panes, are not left to pixel samples but computed over
//! their whole disc and added to the pixels that they cover; the picture carries them as [`sunpeak_scene::ExactSource`]s. With
//! [`PeakRule::Off`](sunpeak_bsdf::PeakRule::Off) a BSDF table shows the smooth blob that it holds.
//!
//! # Where Radiance is followed, and where not
//! Materials follow the reference manual and the published models; see their modules. Differences, all on purpose:
//! - rough highlights are sampled by the model itself (Radiance's own sampling departs from it at grazing incidence), and rough
//!   `trans` never gives out more than it gets;
//! - emitters of every kind are sampled by shadow rays; a `glow`'s radius matters only where bounces are limited;
//! - `dielectric`s do not disperse.

mod accel;
mod backlight;
mod exact_sun;
mod film;
mod goniophotometer;
mod guide;
mod integrator;
mod light;
mod material;
mod options;
mod passes;
mod probe;
mod recorder;
mod sensor;
mod shapes;
mod stopping;
mod sunlit;
#[cfg(test)]
mod testing;
mod transmit;
mod world;

pub use film::{PictureJudge, render_picture, render_until};
pub use goniophotometer::{
    DEFAULT_COLUMN_SAMPLES, Edges, Generated, GeneratedColumn, GeneratedSide, GonioOptions, Side,
    generate_bsdf, straight_transmittance,
};
pub use options::{DEFAULT_MAX_DEPTH, DEFAULT_SAMPLES, RenderOptions, WorldOptions};
pub use probe::{FirstDeltas, FirstSurface, first_deltas, first_surfaces};
pub use recorder::RecordedRay;
pub use sensor::{Traced, trace_irradiance, trace_radiance};
pub use world::World;

/// A `source` narrower than this [deg] is a sun: it gets a shadow ray of its own, and is not found by chance behind
/// mirrors. At 5 degrees (0.006 sr) a diffuse surface would find it in one of 500 paths.
pub const SMALL_SOURCE_DEG: f64 = 5.0;
