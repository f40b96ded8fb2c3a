//! Wavefront `.obj` files, as far as `obj2mesh` reads them: `v`, `vt`, `vn`, `f` and `usemtl`; all else is passed over.
//!
//! Faces of more than three corners are cut into a fan from the first, which suits convex ones. `usemtl` names a modifier of
//! the scene, not of a material library.

use super::mesh::{MeshFile, Part};
use crate::files::read as read_file;
use std::{collections::HashMap, path::Path};
use sunpeak_core::{Error, Location, Result, Vec3};

/// Places, local coordinates and normals of a corner, each by its index.
type Corner = (usize, Option<usize>, Option<usize>);

/// Read a Wavefront file.
pub fn read(path: &Path) -> Result<MeshFile> {
    parse(&String::from_utf8_lossy(&read_file(path)?), &path.to_string_lossy())
}

fn parse(text: &str, name: &str) -> Result<MeshFile> {
    let mut parser = Parser::default();
    for (number, line) in joined_lines(text) {
        let location = Location::new(name, number, 0);
        parser.line(&line).map_err(|message| Error::input(location, message))?;
    }
    Ok(parser.mesh)
}

/// Lines with their numbers; one that ends in a backslash goes on in the next.
fn joined_lines(text: &str) -> Vec<(usize, String)> {
    let mut lines: Vec<(usize, String)> = Vec::new();
    let mut is_open = false;
    for (i, line) in text.lines().enumerate() {
        let (line, goes_on) = match line.trim_end().strip_suffix('\\') {
            Some(line) => (line, true),
            None => (line, false),
        };
        match lines.last_mut().filter(|_| is_open) {
            Some((_, before)) => before.extend([" ", line]),
            None => lines.push((i + 1, line.to_string())),
        }
        is_open = goes_on;
    }
    lines
}

#[derive(Default)]
struct Parser {
    places: Vec<Vec3>,
    local: Vec<[f64; 2]>,
    normals: Vec<Vec3>,
    vertices: HashMap<Corner, u32>,
    material: Option<String>,
    mesh: MeshFile,
}

impl Parser {
    fn line(&mut self, line: &str) -> std::result::Result<(), String> {
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        let words: Vec<&str> = words.collect();
        match keyword {
            "v" => self.places.push(Vec3::from_array(numbers(&words, "3 coordinates after v")?)),
            "vn" => self.normals.push(Vec3::from_array(numbers(&words, "3 components after vn")?)),
            "vt" => self.local.push(numbers(&words, "2 coordinates after vt")?),
            "usemtl" => self.material = words.first().map(ToString::to_string),
            "f" => self.face(&words)?,
            _ => {}
        }
        Ok(())
    }

    fn face(&mut self, words: &[&str]) -> std::result::Result<(), String> {
        if words.len() < 3 {
            return Err(format!("expected 3 corners or more after f, found {}", words.len()));
        }
        let corners =
            words.iter().map(|word| self.corner(word)).collect::<std::result::Result<Vec<_>, _>>()?;
        let corners: Vec<u32> = corners.into_iter().map(|corner| self.vertex(corner)).collect();
        let material = &self.material;
        let parts = &mut self.mesh.parts;
        let at = parts.iter().rposition(|part| part.material == *material).unwrap_or_else(|| {
            parts.push(Part { material: material.clone(), triangles: Vec::new() });
            parts.len() - 1
        });
        let fan = corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]);
        parts[at].triangles.extend(fan);
        Ok(())
    }

    /// `place`, `place/local`, `place//normal` or `place/local/normal`.
    fn corner(&self, word: &str) -> std::result::Result<Corner, String> {
        let mut parts = word.split('/');
        let mut next = |count: usize| match parts.next() {
            None | Some("") => Ok(None),
            Some(part) => index(part, count).map(Some),
        };
        let (place, local, normal) =
            (next(self.places.len())?, next(self.local.len())?, next(self.normals.len())?);
        let place = place.ok_or_else(|| format!("expected the number of a vertex, found \"{word}\""))?;
        Ok((place, local, normal))
    }

    fn vertex(&mut self, corner: Corner) -> u32 {
        let mesh = &mut self.mesh;
        let (place, local, normal) = corner;
        *self.vertices.entry(corner).or_insert_with(|| {
            mesh.vertices.push(self.places[place]);
            mesh.local.push(local.map_or([0.0; 2], |i| self.local[i]));
            mesh.normals.push(normal.map_or(Vec3::ZERO, |i| self.normals[i].normalize_or_zero()));
            mesh.vertices.len() as u32 - 1
        })
    }
}

/// Finite numbers at the beginning of the words.
fn numbers<const N: usize>(words: &[&str], expected: &str) -> std::result::Result<[f64; N], String> {
    let mut values = [0.0; N];
    for (i, value) in values.iter_mut().enumerate() {
        let word = words.get(i).copied().unwrap_or("nothing");
        let number = word.parse::<f64>().ok().filter(|v| v.is_finite());
        *value = number.ok_or_else(|| format!("expected {expected}, found \"{word}\""))?;
    }
    Ok(values)
}

/// From 1, or backwards from the last one given so far.
fn index(word: &str, count: usize) -> std::result::Result<usize, String> {
    let number: i64 = word.parse().map_err(|_| format!("expected a number in a face, found \"{word}\""))?;
    let from_zero = if number < 0 { count as i64 + number } else { number - 1 };
    usize::try_from(from_zero)
        .ok()
        .filter(|&i| i < count)
        .ok_or_else(|| format!("a face names number {number}, but {count} are given above"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_share_vertices_and_parts_have_materials() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 # the last\nvt .5 .25\nvn 0 0 2\n\
                    f 1//1 2//1 3//1 4//1\nusemtl red\nf -4/1 \\\n -3/1 -1/1\n";
        let mesh = parse(text, "t.obj").expect("a mesh");
        assert_eq!(mesh.parts[0].triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(
            (mesh.parts[1].material.as_deref(), &mesh.parts[1].triangles[..]),
            (Some("red"), &[[4, 5, 6]][..])
        );
        assert_eq!((mesh.vertices.len(), mesh.normals[0], mesh.local[4]), (7, Vec3::Z, [0.5, 0.25]));
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        for (text, expected) in [
            ("v 0 0", "t.obj:1: expected 3 coordinates after v, found \"nothing\""),
            ("v 0 0 nan", "expected 3 coordinates after v, found \"nan\""),
            ("v 0 0 0\nf 1 1 2", "t.obj:2: a face names number 2, but 1 are given above"),
            ("f 1 2", "expected 3 corners or more after f, found 2"),
            ("v 0 0 0\nf 1 / 1", "expected the number of a vertex, found \"/\""),
        ] {
            let message = parse(text, "t.obj").expect_err(text).to_string();
            assert!(message.contains(expected), "{message}");
        }
    }
}
