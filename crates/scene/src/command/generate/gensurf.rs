//! `gensurf`: a surface over two parameters, as quadrangles where they are flat and otherwise as pairs of triangles.

use super::{
    MAX_SURFACES, Maker, count,
    functions::{Functions, Options},
};
use crate::raw::{CommandLine, Primitive};
use sunpeak_core::Vec3;

const USAGE: &str = "gensurf material name 'x(s,t)' 'y(s,t)' 'z(s,t)' m n [-e expr] [-f file]";

/// A definition of this name says where the surface is: where it is above 0.
const CONDITION: &str = "valid";

/// Unit normals of the halves of a quadrangle that differ by more are not one plane (Radiance, `FTINY`).
const FLAT: f64 = 1e-6;

/// A corner, if the surface is there.
type Corner = Option<Vec3>;

pub fn run(
    args: &[String],
    command: &CommandLine,
    read: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Vec<Primitive>, String> {
    let (maker, rest) = Maker::new(command, args, USAGE)?;
    let [x, y, z, columns, rows, rest @ ..] = rest else { return Err(format!("expected {USAGE}")) };
    let columns = count(Some(columns), "m, the steps of s")?;
    let rows = count(Some(rows), "n, the steps of t")?;
    if columns.saturating_mul(rows) > MAX_SURFACES {
        return Err(format!("{columns} times {rows} pieces: more than {MAX_SURFACES}"));
    }
    let options = Options::parse(rest, read)?;
    super::no_flags(&options, USAGE)?;
    let functions = Functions::compile(&[x, y, z], &options, Some(CONDITION), command)?;
    let mut mesh = Mesh { maker, number: 0 };
    let line = |i: usize| -> Result<Vec<Corner>, String> {
        (0..=rows).map(|j| corner(&functions, i as f64 / columns as f64, j as f64 / rows as f64)).collect()
    };
    let mut before = line(0)?;
    for i in 1..=columns {
        let now = line(i)?;
        for j in 0..rows {
            mesh.add([before[j], now[j], now[j + 1], before[j + 1]], j % 2 == 0)?;
        }
        before = now;
    }
    Ok(mesh.maker.made)
}

fn corner(functions: &Functions, s: f64, t: f64) -> Result<Corner, String> {
    let values = functions.at(s, t)?;
    let is_there = functions.len() == 3 || values[3] > 0.0;
    Ok(is_there.then(|| Vec3::from_slice(&values)))
}

struct Mesh<'c> {
    maker: Maker<'c>,
    number: usize,
}

impl Mesh<'_> {
    /// The piece between corners (s, t) = (0, 0), (1, 0), (1, 1), (0, 1). Neighbouring rows are cut along other diagonals.
    fn add(&mut self, corners: [Corner; 4], is_even: bool) -> Result<(), String> {
        let halves = match corners {
            [Some(a), Some(b), Some(c), Some(d)] => return self.add_whole([a, b, c, d], is_even),
            [None, Some(b), Some(c), Some(d)] => [d, b, c],
            [Some(a), None, Some(c), Some(d)] => [a, c, d],
            [Some(a), Some(b), None, Some(d)] => [a, b, d],
            [Some(a), Some(b), Some(c), None] => [b, c, a],
            _ => return Ok(()),
        };
        self.add_polygon(&halves)
    }

    fn add_whole(&mut self, [a, b, c, d]: [Vec3; 4], is_even: bool) -> Result<(), String> {
        let (halves, whole) = match is_even {
            true => ([[b, c, a], [a, c, d]], [b, c, d, a]),
            false => ([[a, b, d], [d, b, c]], [a, b, c, d]),
        };
        let normals = halves.map(|half| normal(half).try_normalize());
        if let [Some(first), Some(second)] = normals
            && first.distance(second) < FLAT
        {
            return self.add_polygon(&whole);
        }
        for (half, normal) in halves.iter().zip(normals) {
            if normal.is_some() {
                self.add_polygon(half)?;
            }
        }
        Ok(())
    }

    fn add_polygon(&mut self, corners: &[Vec3]) -> Result<(), String> {
        self.number += 1;
        let reals = corners.iter().flat_map(|p| p.to_array()).collect();
        self.maker.add("polygon", &self.number.to_string(), reals)
    }
}

fn normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a)
}
