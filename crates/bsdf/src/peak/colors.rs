//! Colours of many columns or cells, in 32 bits as the tables themselves have them; one number each where all are grey.

use glam::{DVec3, Vec3};
use sunpeak_core::{Rgb, gray};

/// A list of colours.
#[derive(Debug)]
pub enum Colors {
    /// The same in all channels.
    Gray(Vec<f32>),
    /// Radiance's three channels.
    Rgb(Vec<Vec3>),
}

impl Colors {
    /// Absurd values stay finite.
    pub fn new(colors: &[Rgb]) -> Self {
        let stored = |color: &Rgb| color.min(Rgb::splat(f32::MAX.into())).as_vec3();
        if colors.iter().all(|c| c.x == c.y && c.y == c.z) {
            Self::Gray(colors.iter().map(|c| stored(c).x).collect())
        } else {
            Self::Rgb(colors.iter().map(stored).collect())
        }
    }

    /// The color at an index that exists.
    #[inline]
    pub fn at(&self, index: usize) -> Rgb {
        match self {
            Self::Gray(list) => gray(list[index].into()),
            Self::Rgb(list) => DVec3::from(list[index]),
        }
    }

    /// Memory that the list takes [bytes].
    pub fn bytes(&self) -> usize {
        match self {
            Self::Gray(list) => size_of_val(list.as_slice()),
            Self::Rgb(list) => size_of_val(list.as_slice()),
        }
    }

    /// How many.
    pub fn len(&self) -> usize {
        match self {
            Self::Gray(list) => list.len(),
            Self::Rgb(list) => list.len(),
        }
    }
}
