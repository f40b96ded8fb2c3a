//! `genbox`: a box, with sharp, bevelled or rounded edges.
//!
//! A corner of the box is a number of three bits, one an axis: 0 is the low side, 1 the high side. The three bits above say
//! on which axes it is moved inwards by the bevel. The order of faces and vertices, and their names, are genbox's.

use super::genbox_round::rounded_faces;
use crate::raw::{Primitive, PrimitiveType, parse_integer, parse_real};
use std::{path::Path, sync::Arc};
use sunpeak_core::{Location, Vec3};

/// Faces of a sharp box.
const SIDES: [[u8; 4]; 6] =
    [[1, 5, 4, 0], [4, 6, 2, 0], [2, 3, 1, 0], [3, 2, 6, 7], [5, 1, 3, 7], [6, 4, 5, 7]];
/// The faces of the sides when the edges are cut.
pub(super) const INNER_SIDES: [[u8; 4]; 6] = [
    [0o51, 0o55, 0o54, 0o50],
    [0o64, 0o66, 0o62, 0o60],
    [0o32, 0o33, 0o31, 0o30],
    [0o53, 0o52, 0o56, 0o57],
    [0o65, 0o61, 0o63, 0o67],
    [0o36, 0o34, 0o35, 0o37],
];
/// The faces along cut edges.
const BEVELS: [[u8; 4]; 12] = [
    [0o31, 0o51, 0o50, 0o30],
    [0o60, 0o62, 0o32, 0o30],
    [0o50, 0o54, 0o64, 0o60],
    [0o34, 0o36, 0o66, 0o64],
    [0o37, 0o57, 0o56, 0o36],
    [0o52, 0o62, 0o66, 0o56],
    [0o52, 0o53, 0o33, 0o32],
    [0o57, 0o67, 0o63, 0o53],
    [0o61, 0o31, 0o33, 0o63],
    [0o65, 0o67, 0o37, 0o35],
    [0o55, 0o51, 0o61, 0o65],
    [0o34, 0o54, 0o55, 0o35],
];
/// The triangles at cut corners.
const CORNERS: [[u8; 3]; 8] = [
    [0o30, 0o50, 0o60],
    [0o51, 0o31, 0o61],
    [0o32, 0o62, 0o52],
    [0o64, 0o54, 0o34],
    [0o36, 0o56, 0o66],
    [0o65, 0o35, 0o55],
    [0o53, 0o63, 0o33],
    [0o37, 0o67, 0o57],
];
/// The ends of the axes of rounded edges.
pub(super) const EDGES: [[u8; 2]; 12] = [
    [0o70, 0o71],
    [0o70, 0o74],
    [0o70, 0o72],
    [0o73, 0o71],
    [0o73, 0o72],
    [0o73, 0o77],
    [0o75, 0o71],
    [0o75, 0o74],
    [0o75, 0o77],
    [0o76, 0o72],
    [0o76, 0o74],
    [0o76, 0o77],
];
/// The characters that name the corners.
const LETTERS: &[u8; 64] = b"0123456789._ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
/// Segments of a rounded edge where polygons are asked for without a number.
const DEFAULT_SEGMENTS: u32 = 32;
/// Each doubling of the segments makes four times the corner triangles; this is a million a corner.
const MAX_SEGMENTS: u32 = 1024;

const USAGE: &str =
    "expected genbox material name xsize ysize zsize [-i] [-b bevel | -r radius [-n segments]]";

/// A box as the arguments say.
#[derive(Debug)]
pub(super) struct Box {
    material: Arc<str>,
    name: String,
    pub size: Vec3,
    /// How far edges are cut, or their radius.
    pub bevel: f64,
    rounded: bool,
    /// Do the normals point inwards?
    pub inward: bool,
    segments: u32,
}

/// The primitives that `genbox` with these arguments would write.
pub fn run(args: &[String], location: &Location, directory: &Arc<Path>) -> Result<Vec<Primitive>, String> {
    let shape = Box::parse(args)?;
    let make = |kind: &str, suffix: String, reals: Vec<f64>| {
        let kind = PrimitiveType::find(kind)?;
        Some(Primitive {
            modifier: shape.material.clone(),
            kind,
            name: format!("{}.{suffix}", shape.name),
            strings: Vec::new(),
            reals,
            location: location.clone(),
            directory: directory.clone(),
        })
    };
    Ok(shape.surfaces().into_iter().filter_map(|(kind, suffix, reals)| make(kind, suffix, reals)).collect())
}

/// Type, end of the name, arguments.
type Face = (&'static str, String, Vec<f64>);

impl Box {
    fn parse(args: &[String]) -> Result<Self, String> {
        let [material, name, x, y, z, options @ ..] = args else { return Err(USAGE.into()) };
        let size = Vec3::new(positive(Some(x))?, positive(Some(y))?, positive(Some(z))?);
        let mut shape = Self {
            material: material.as_str().into(),
            name: name.clone(),
            size,
            bevel: 0.0,
            rounded: false,
            inward: false,
            segments: 1,
        };
        let mut words = options.iter();
        while let Some(option) = words.next() {
            match option.as_str() {
                "-i" => shape.inward = true,
                "-r" | "-b" => {
                    shape.rounded |= option == "-r";
                    shape.bevel = positive(words.next())?;
                }
                "-n" => shape.segments = segments(words.next())?,
                "-s" => {
                    return Err(
                        "genbox -s makes smoothing textures (texfunc), which are not supported yet".into()
                    );
                }
                "-o" => return Err("genbox -o writes Wavefront OBJ, which is no scene text".into()),
                _ => return Err(format!("unknown option {option} of genbox: {USAGE}")),
            }
        }
        if shape.inward && shape.segments == 1 {
            shape.segments = DEFAULT_SEGMENTS;
        }
        Ok(shape)
    }

    fn surfaces(&self) -> Vec<Face> {
        if self.bevel == 0.0 {
            return self.polygons(&SIDES);
        }
        // As genbox, which keeps cylinders and spheres for two segments too.
        if self.rounded && self.segments > 2 {
            let faces = rounded_faces(self, subdivisions(self.segments));
            let name = |(i, points): (usize, Vec<Vec3>)| ("polygon", (i + 1).to_string(), flat(&points));
            return faces.into_iter().enumerate().map(name).collect();
        }
        let mut faces = self.polygons(&INNER_SIDES);
        if self.rounded {
            faces.extend(EDGES.iter().map(|edge| self.edge(edge)));
            faces.extend((0o70..0o100).map(|corner| self.corner(corner)));
        } else {
            faces.extend(self.polygons(&BEVELS));
            faces.extend(self.polygons(&CORNERS));
        }
        faces
    }

    fn polygons<const N: usize>(&self, faces: &[[u8; N]]) -> Vec<Face> {
        faces.iter().map(|face| ("polygon", letters(face), flat(&face.map(|v| self.vertex(v))))).collect()
    }

    fn edge(&self, ends: &[u8; 2]) -> Face {
        let mut reals = flat(&ends.map(|v| self.vertex(v)));
        reals.push(self.bevel);
        ("cylinder", letters(ends), reals)
    }

    fn corner(&self, corner: u8) -> Face {
        let mut reals = flat(&[self.vertex(corner)]);
        reals.push(self.bevel);
        ("sphere", letters(&[corner]), reals)
    }

    /// Where a corner is. An inward box is the same one with its sides exchanged.
    pub(super) fn vertex(&self, corner: u8) -> Vec3 {
        let coordinate = |axis: usize| {
            let high = (corner >> axis & 1 == 1) != self.inward;
            let cut = if corner >> axis & 0o10 != 0 { self.bevel } else { 0.0 };
            if high { self.size[axis] - cut } else { cut }
        };
        Vec3::new(coordinate(0), coordinate(1), coordinate(2))
    }
}

fn letters(corners: &[u8]) -> String {
    corners.iter().map(|&corner| char::from(LETTERS[usize::from(corner)])).collect()
}

fn flat(points: &[Vec3]) -> Vec<f64> {
    points.iter().flat_map(|p| p.to_array()).collect()
}

/// How often a rounded edge is halved, for 3 segments or more: 3 and 4 make 4, 5 to 8 make 8, …
fn subdivisions(segments: u32) -> u32 {
    1 + (segments - 1).ilog2()
}

fn positive(word: Option<&String>) -> Result<f64, String> {
    let value = word.and_then(|word| parse_real(word)).filter(|&value| value > 0.0);
    value.ok_or_else(|| format!("genbox: expected a positive number, found {}: {USAGE}", quoted(word)))
}

fn segments(word: Option<&String>) -> Result<u32, String> {
    let count = word.and_then(|word| parse_integer(word)).and_then(|n| u32::try_from(n).ok());
    count.filter(|n| (1..=MAX_SEGMENTS).contains(n)).ok_or_else(|| {
        format!(
            "genbox: expected a number of segments from 1 to {MAX_SEGMENTS} after -n, found {}",
            quoted(word)
        )
    })
}

fn quoted(word: Option<&String>) -> String {
    word.map_or("the end".into(), |word| format!("\"{word}\""))
}
