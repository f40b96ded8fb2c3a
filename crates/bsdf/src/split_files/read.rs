//! A split from its files: the table is the residual plus what was taken from it.

use super::{
    PEAK_FILE,
    format::{CellFile, ColumnFile, FORMAT, PeakFile, SideFile, VERSION},
    tables::{Channels, ColorTable, Cube, channels_at, cube, point_over, rgb_of, with_changes, with_cubes},
    write::{checksum, division},
};
use crate::{
    bsdf::Bsdf,
    distribution::Distribution,
    load::sides_of,
    peak::{ColumnPeak, Part, Split},
    table::{Columns, Matrix, Table},
    tree::Tree,
    xml,
};
use std::{
    collections::HashMap,
    fs::File,
    io::BufReader,
    path::{Path, PathBuf},
};
use sunpeak_core::{Error, Location, Result, Rgb};

/// How far the parts of one cell of the table may come out apart, relative to it: rounding of three channels.
const SAME_CELL: f64 = 1e-4;

/// Largest peak file that is read [bytes]: the finest trees have 2^16 columns a side, at a kilobyte each an eighth of this.
const LARGEST_PEAK_FILE: u64 = 1 << 30;

impl Bsdf {
    /// Read a split that was written before: the folder, or the JSON file in it.
    pub fn load_split(path: &Path) -> Result<Self> {
        let file = if path.is_dir() { path.join(PEAK_FILE) } else { path.to_path_buf() };
        let reader = Reader { file: file.clone() };
        let peak = reader.peak_file()?;
        let residual = file.with_file_name(&peak.residual);
        reader.check_residual(&peak, &residual)?;
        let name = residual.to_string_lossy().into_owned();
        let mut document = xml::read(&name, buffered(&residual)?)?;
        let blocks = std::mem::take(&mut document.blocks);
        for side in &peak.sides {
            if !blocks.iter().any(|b| b.direction.eq_ignore_ascii_case(&side.direction)) {
                let direction = &side.direction;
                return Err(reader.error(format!("'{direction}' is not in {name}; expected it there")));
            }
        }
        let sides = sides_of(&name, blocks, &|direction, table, color| {
            let side = peak.sides.iter().find(|s| s.direction.eq_ignore_ascii_case(direction));
            match side {
                Some(side) => reader.whole(side, table, color),
                None if direction.starts_with("Transmission") => {
                    Err(reader.error(format!("no side '{direction}', which {name} has")))
                }
                None => Ok(Distribution::new(table, color)),
            }
        })?;
        Ok(Self::from_sides(document, sides))
    }
}

fn buffered(path: &Path) -> Result<BufReader<File>> {
    File::open(path).map(BufReader::new).map_err(|e| Error::io(path, e))
}

struct Reader {
    file: PathBuf,
}

impl Reader {
    fn error(&self, message: impl Into<String>) -> Error {
        Error::input(Location::new(&*self.file.to_string_lossy(), 0, 0), message)
    }

    fn peak_file(&self) -> Result<PeakFile> {
        let size = std::fs::metadata(&self.file).map_err(|e| Error::io(&self.file, e))?.len();
        if size > LARGEST_PEAK_FILE {
            return Err(self.error(format!("{size} bytes; a peak file has at most {LARGEST_PEAK_FILE}")));
        }
        let text = std::fs::read(&self.file).map_err(|e| Error::io(&self.file, e))?;
        let peak: PeakFile = serde_json::from_slice(&text).map_err(|e| {
            let place = Location::new(&*self.file.to_string_lossy(), e.line(), e.column());
            let message = e.to_string();
            let said = message.split(" at line ").next().unwrap_or(&message);
            Error::input(place, format!("not a split of Sunpeak: {said}"))
        })?;
        if peak.format != FORMAT || peak.version != VERSION {
            let (format, version) = (&peak.format, peak.version);
            return Err(self.error(format!(
                "format '{format}' version {version}; expected '{FORMAT}' version {VERSION}"
            )));
        }
        // Nothing but a file beside this one.
        if Path::new(&peak.residual).file_name().is_none_or(|n| n != peak.residual.as_str()) {
            let residual = &peak.residual;
            return Err(self.error(format!("residual '{residual}'; expected the name of a file beside")));
        }
        Ok(peak)
    }

    fn check_residual(&self, peak: &PeakFile, residual: &Path) -> Result<()> {
        let Some(expected) = &peak.residual_fnv1a else { return Ok(()) };
        let found = checksum(buffered(residual)?).map_err(|e| Error::io(residual, e))?;
        if found == *expected {
            return Ok(());
        }
        Err(self.error(format!(
            "{} is not the residual that was written with it (its checksum differs); split the product again, or take \
             'residual_fnv1a' out if the residual was changed on purpose",
            residual.display()
        )))
    }

    /// The distribution that was split.
    fn whole(&self, side: &SideFile, table: Table, color: Option<[Vec<f32>; 2]>) -> Result<Distribution> {
        let residual = Distribution::new(table, color);
        self.check_side(side, &residual)?;
        let ((table, color), parts) = match residual.luminous() {
            Table::Matrix(m) => self.whole_matrix(side, m, &residual)?,
            Table::Tree(t) => self.whole_tree(side, t, &residual)?,
        };
        Ok(Distribution::with_known_split(table, color, |columns| {
            Split::from_parts(columns, parts, side.instrument_fwhm_deg)
        }))
    }

    fn check_side(&self, side: &SideFile, residual: &Distribution) -> Result<()> {
        let direction = &side.direction;
        let found = division(residual.columns());
        if found != side.division {
            let expected = &side.division;
            return Err(self
                .error(format!("{direction}: the residual is divided as {found:?}; expected {expected:?}")));
        }
        let channels = if residual.color().is_some() { 3 } else { 1 };
        if side.channels.len() != channels {
            let n = side.channels.len();
            return Err(self.error(format!("{direction}: {n} channels; expected {channels}")));
        }
        if side.columns.len() != residual.columns().len() {
            let (n, expected) = (side.columns.len(), residual.columns().len());
            return Err(self.error(format!("{direction}: {n} columns; expected {expected}")));
        }
        side.columns.iter().enumerate().try_for_each(|(i, c)| self.check_column(side, i, c))
    }

    fn check_column(&self, side: &SideFile, place: usize, c: &ColumnFile) -> Result<()> {
        let wrong = |what: String| Err(self.error(format!("{}, column {place}: {what}", side.direction)));
        if c.column != place {
            return wrong(format!("its number is {}; expected columns in order", c.column));
        }
        let transmittance = |v: &f64| (0.0..f64::INFINITY).contains(v);
        let numbers = c.through_rgb.iter().chain(&c.interval).chain([&c.detection_limit, &c.lobe_sigma]);
        if let Some(bad) = numbers.copied().find(|v| !transmittance(v)) {
            return wrong(format!("{bad}; expected a transmittance, not negative"));
        }
        match c.cells.iter().find(|cell| cell.excess.len() != side.channels.len()) {
            Some(cell) => {
                let (n, expected) = (cell.excess.len(), side.channels.len());
                wrong(format!("a cell has {n} numbers of excess; expected {expected}, as channels"))
            }
            None => Ok(()),
        }
    }

    /// Residual plus excess; negative by no more than rounding.
    fn sum(&self, side: &SideFile, column: usize, rest: Channels, cell: &CellFile) -> Result<Channels> {
        let mut whole = rest;
        for (value, excess) in whole.iter_mut().zip(&cell.excess) {
            *value = (f64::from(*value) + excess) as f32;
            if !(value.is_finite() && *value >= 0.0) {
                return Err(self.error(format!(
                    "{}, column {column}: residual and excess add up to {value}; a BSDF is finite and not negative",
                    side.direction
                )));
            }
        }
        if cell.excess.len() == 1 {
            whole = [whole[0]; 3];
        }
        Ok(whole)
    }

    fn whole_matrix(
        &self,
        side: &SideFile,
        m: &Matrix,
        residual: &Distribution,
    ) -> Result<(ColorTable, Vec<Part>)> {
        let (mut changes, mut parts) = (Vec::new(), Vec::new());
        let width = m.exiting.len();
        let colored = residual.color().is_some();
        for c in &side.columns {
            let mut lowered = Vec::new();
            for cell in &c.cells {
                let Some(patch) = cell.patch.filter(|&p| p < width) else {
                    let (direction, column) = (&side.direction, c.column);
                    return Err(self.error(format!(
                        "{direction}, column {column}: a cell without a patch from 0 to {}",
                        width - 1
                    )));
                };
                let index = c.column * width + patch;
                let rest = channels_at((residual.luminous(), residual.color()), index);
                changes.push((index, self.sum(side, c.column, rest, cell)?));
                lowered.push((index, rgb_of(rest, colored)));
            }
            parts.push((peak_of(c), lowered));
        }
        Ok((with_changes(m, residual, &changes), parts))
    }

    fn whole_tree(
        &self,
        side: &SideFile,
        tree: &Tree,
        residual: &Distribution,
    ) -> Result<(ColorTable, Vec<Part>)> {
        let columns = residual.columns();
        let colored = residual.color().is_some();
        let mut cubes: HashMap<Cube, Channels> = HashMap::new();
        let mut lowered: Vec<Vec<([f64; 4], Rgb)>> = Vec::new();
        for c in &side.columns {
            let mut cells = Vec::new();
            for cell in &c.cells {
                let (at, key) = self.place(side, c.column, cell, columns)?;
                let leaf = tree.leaf(at);
                let rest = channels_at((residual.luminous(), residual.color()), leaf.index);
                let whole = self.sum(side, c.column, rest, cell)?;
                if let Some(other) = cubes.insert(key, whole) {
                    self.same(side, c.column, other, whole)?;
                }
                cells.push((at, rgb_of(rest, colored)));
            }
            lowered.push(cells);
        }
        let (table, color) = with_cubes(residual, tree, &cubes)?;
        let Table::Tree(whole) = &table else { return Ok(((table, color), Vec::new())) };
        let parts = side.columns.iter().zip(lowered).map(|(c, cells)| {
            (peak_of(c), cells.into_iter().map(|(at, rest)| (whole.leaf(at).index, rest)).collect())
        });
        let parts = parts.collect();
        Ok(((table, color), parts))
    }

    /// A point in the part of a cell over a column, and the whole cell.
    fn place(
        &self,
        side: &SideFile,
        column: usize,
        cell: &CellFile,
        columns: &Columns,
    ) -> Result<([f64; 4], Cube)> {
        let finest = match columns {
            Columns::Radial { side } | Columns::Square { side } => 1.0 / *side as f64,
            Columns::Patches(_) => 1.0,
        };
        let fits = |[x, y, size]: &[f64; 3]| {
            let whole = |v: f64| v >= 0.0 && v.fract() == 0.0;
            *size >= finest
                && *size <= 1.0
                && size.log2().fract() == 0.0
                && [*x, *y].into_iter().all(|v| whole(v / size) && v < 1.0)
        };
        let Some([x, y, size]) = cell.square.filter(fits) else {
            return Err(self.error(format!(
                "{}, column {column}: a cell without a square of the tree (corner x, y and edge, edge a power of two from {finest})",
                side.direction
            )));
        };
        // Off the corner by less than the smallest cell.
        let inside = [x + 0.25 * finest, y + 0.25 * finest];
        Ok((point_over(columns, column, inside), cube(columns, column, [x, y], size)))
    }

    /// Do the parts of one cell add up to the same value in all columns?
    fn same(&self, side: &SideFile, column: usize, a: Channels, b: Channels) -> Result<()> {
        let [a, b] = [a[0], b[0]].map(f64::from);
        if (a - b).abs() <= SAME_CELL * a.max(b) {
            return Ok(());
        }
        Err(self.error(format!(
            "{}, column {column}: residual and excess of a cell add up to {b}, in the column before to {a}; peak and residual \
             do not belong together",
            side.direction
        )))
    }
}

fn peak_of(c: &ColumnFile) -> ColumnPeak {
    ColumnPeak {
        through: Rgb::from_array(c.through_rgb),
        contrast: c.contrast.unwrap_or(f64::INFINITY),
        detection_limit: c.detection_limit,
        interval: c.interval,
        lobe_sigma: c.lobe_sigma,
    }
}
