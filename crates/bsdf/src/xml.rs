//! Reading LBNL BSDF XML files (schemas 1.4 and 1.7) into named blocks of numbers.

use crate::{
    basis::AngleBasis,
    table::{Matrix, Table},
    tree::{Nested, Tree},
};
use quick_xml::{Reader, events::Event};
use std::sync::Arc;
use sunpeak_core::{Error, Location, Result};

/// What a file holds, before sides are given a meaning.
#[derive(Debug, Default)]
pub struct Document {
    /// `Material/Name`.
    pub name: String,
    /// `Material/Manufacturer`.
    pub manufacturer: String,
    /// `IncidentDataStructure`.
    pub structure: String,
    /// Tables, in file order.
    pub blocks: Vec<Block>,
    /// What was tolerated.
    pub warnings: Vec<String>,
}

/// One `WavelengthDataBlock`.
#[derive(Debug)]
pub struct Block {
    /// `Wavelength`: `Visible`, `Solar`, `CIE-X` …
    pub band: String,
    /// `WavelengthDataDirection`: `Transmission Front` …
    pub direction: String,
    /// Its values.
    pub table: Table,
}

/// Bands that are used: luminous, and colour by CIE X and Z (matrices) or u' and v' (trees).
const BANDS: [&str; 5] = ["Visible", "CIE-X", "CIE-Z", "CIE-u", "CIE-v"];

/// Deepest nesting of a tree: 2^15 cells a side resolve 0.004 degrees, and no file is known past 2^8.
const MAX_TREE_DEPTH: usize = 15;

/// Parse the text of a file. `file` names it in messages.
pub fn parse(file: &str, text: &[u8]) -> Result<Document> {
    let file: Arc<str> = file.into();
    let at = |offset: usize| Location::of_offset(file.clone(), text, offset);
    // Some programs leave messages of their own before the XML; Radiance skips them too.
    let start = ["<?xml", "<WindowElement"].iter().filter_map(|s| find(text, s.as_bytes())).min();
    let Some(start) = start else {
        return Err(Error::input(
            at(0),
            "not a BSDF file: neither '<?xml' nor '<WindowElement' found; expected an LBNL BSDF XML file",
        ));
    };
    let mut parser = Parser { file: file.clone(), text, ..Parser::default_for(text) };
    if start > 0 {
        parser.document.warnings.push(format!("skipped {start} bytes before the XML begins"));
    }
    let mut reader = Reader::from_reader(&text[start..]);
    reader.config_mut().check_end_names = true;
    loop {
        let before = start + reader.buffer_position() as usize;
        let event = reader.read_event().map_err(|e| {
            let message = format!("broken XML: {e} (is the file complete?)");
            Error::input(at(start + reader.error_position() as usize), message)
        })?;
        match event {
            Event::Start(tag) => parser.open(tag.local_name().into_inner()),
            Event::End(_) => parser.close(before)?,
            Event::Text(chunk) => parser.text(before, chunk.as_bytes()),
            Event::CData(chunk) => parser.text(before + "<![CDATA[".len(), chunk.as_bytes()),
            Event::DocType(_) => {
                return Err(Error::input(at(before), "a document type is not allowed in a BSDF file"));
            }
            Event::Eof => break,
            _ => {}
        }
    }
    parser.finish()
}

fn find(text: &[u8], word: &[u8]) -> Option<usize> {
    text.windows(word.len()).position(|w| w == word)
}

/// Where we are in the document, and what has been said so far.
struct Parser<'a> {
    file: Arc<str>,
    text: &'a [u8],
    document: Document,
    path: Vec<String>,
    content: Vec<u8>,
    content_at: usize,
    layers: usize,
    bases: Vec<Arc<AngleBasis>>,
    basis: BasisDraft,
    band: String,
    block: BlockDraft,
    drafts: Vec<BlockDraft>,
}

#[derive(Default)]
struct BasisDraft {
    name: String,
    rings: Vec<(f64, usize)>,
    lower_theta_deg: Option<f64>,
    upper_theta_deg: Option<f64>,
    phi_count: Option<usize>,
}

#[derive(Default)]
struct BlockDraft {
    band: String,
    /// Where the block ends in the file.
    end: usize,
    direction: String,
    column_basis: String,
    row_basis: String,
    angle_basis: String,
    data: Option<(usize, Vec<u8>)>,
}

impl<'a> Parser<'a> {
    fn default_for(text: &'a [u8]) -> Self {
        Self {
            file: "".into(),
            text,
            document: Document::default(),
            path: Vec::new(),
            content: Vec::new(),
            content_at: 0,
            layers: 0,
            bases: Vec::new(),
            basis: BasisDraft::default(),
            band: String::new(),
            block: BlockDraft::default(),
            drafts: Vec::new(),
        }
    }

    fn error(&self, offset: usize, message: impl Into<String>) -> Error {
        Error::input(Location::of_offset(self.file.clone(), self.text, offset), message)
    }

    fn open(&mut self, name: &str) {
        self.path.push(name.to_owned());
        self.content.clear();
        match name {
            "Layer" => self.layers += 1,
            "AngleBasis" => self.basis = BasisDraft::default(),
            "WavelengthDataBlock" => self.block = BlockDraft::default(),
            _ => {}
        }
    }

    fn text(&mut self, offset: usize, chunk: &[u8]) {
        if self.content.is_empty() {
            self.content_at = offset;
        }
        self.content.extend_from_slice(chunk);
    }

    /// An element ends: take what it says. Only the first layer counts, as in Radiance.
    fn close(&mut self, offset: usize) -> Result<()> {
        let Some(name) = self.path.pop() else {
            return Err(self.error(offset, "an element ends that never began"));
        };
        let parent = self.path.last().map_or("", String::as_str).to_owned();
        if self.layers <= 1 {
            self.take(&parent, &name, offset)?;
        }
        self.content.clear();
        Ok(())
    }

    fn word(&self) -> String {
        String::from_utf8_lossy(&self.content).trim().to_owned()
    }

    fn take(&mut self, parent: &str, name: &str, offset: usize) -> Result<()> {
        match (parent, name) {
            ("Material", "Name") => self.document.name = self.word(),
            ("Material", "Manufacturer") => self.document.manufacturer = self.word(),
            ("DataDefinition", "IncidentDataStructure") => self.document.structure = self.word(),
            ("AngleBasis", "AngleBasisName") => self.basis.name = self.word(),
            ("ThetaBounds", "LowerTheta") => self.basis.lower_theta_deg = Some(self.number(offset)?),
            ("ThetaBounds", "UpperTheta") => self.basis.upper_theta_deg = Some(self.number(offset)?),
            ("AngleBasisBlock", "nPhis") => self.basis.phi_count = Some(self.number(offset)? as usize),
            ("AngleBasis", "AngleBasisBlock") => self.end_ring(offset)?,
            ("DataDefinition", "AngleBasis") => self.end_basis(offset)?,
            ("WavelengthData", "Wavelength") => self.band = self.word(),
            ("WavelengthDataBlock", "WavelengthDataDirection") => self.block.direction = self.word(),
            ("WavelengthDataBlock", "ColumnAngleBasis") => self.block.column_basis = self.word(),
            ("WavelengthDataBlock", "RowAngleBasis") => self.block.row_basis = self.word(),
            ("WavelengthDataBlock", "AngleBasis") => self.block.angle_basis = self.word(),
            ("WavelengthDataBlock", "ScatteringData") => {
                self.block.data = Some((self.content_at, std::mem::take(&mut self.content)));
            }
            ("WavelengthData", "WavelengthDataBlock") => self.end_block(offset),
            _ => {}
        }
        Ok(())
    }

    fn number(&self, offset: usize) -> Result<f64> {
        let word = self.word();
        word.parse()
            .ok()
            .filter(|v: &f64| v.is_finite())
            .ok_or_else(|| self.error(offset, format!("'{word}' is not a number")))
    }

    fn end_ring(&mut self, offset: usize) -> Result<()> {
        let (Some(upper), Some(count)) = (self.basis.upper_theta_deg.take(), self.basis.phi_count.take())
        else {
            return Err(self.error(offset, "an AngleBasisBlock needs ThetaBounds/UpperTheta and nPhis"));
        };
        let expected = self.basis.rings.last().map_or(0.0, |r| r.0);
        if let Some(lower) = self.basis.lower_theta_deg.take()
            && !self.basis.rings.is_empty()
            && (lower - expected).abs() > 1e-6 * expected
        {
            return Err(self.error(
                offset,
                format!("LowerTheta is {lower}; expected {expected}, where the ring before ends"),
            ));
        }
        self.basis.rings.push((upper, count));
        Ok(())
    }

    /// A basis of a known name is the known one, whatever the file says of it (as Radiance does).
    fn end_basis(&mut self, offset: usize) -> Result<()> {
        let draft = std::mem::take(&mut self.basis);
        if AngleBasis::known(&draft.name).is_none() && !draft.rings.is_empty() {
            let basis =
                AngleBasis::new(&draft.name, &draft.rings).map_err(|e| self.error(offset, e.to_string()))?;
            self.bases.push(Arc::new(basis));
        }
        Ok(())
    }

    fn basis_named(&mut self, name: &str, tag: &str, offset: usize) -> Result<Arc<AngleBasis>> {
        if let Some(basis) = self.bases.iter().find(|b| b.name().eq_ignore_ascii_case(name)) {
            return Ok(basis.clone());
        }
        let basis = AngleBasis::known(name).map(Arc::new).ok_or_else(|| {
            self.error(
                offset,
                format!(
                    "{tag} '{name}' is not defined; expected LBNL/Klems Full, Half or Quarter, or an AngleBasis of the file"
                ),
            )
        })?;
        self.bases.push(basis.clone());
        Ok(basis)
    }

    /// Keep a block of a band that is used. Some files define their basis after it.
    fn end_block(&mut self, offset: usize) {
        let mut block = std::mem::take(&mut self.block);
        if BANDS.iter().any(|b| b.eq_ignore_ascii_case(&self.band)) {
            block.band.clone_from(&self.band);
            block.end = offset;
            self.drafts.push(block);
        }
    }

    fn read_block(&mut self, block: BlockDraft) -> Result<()> {
        let offset = block.end;
        let what = format!("{} {}", block.band, block.direction);
        let Some((data_at, data)) = &block.data else {
            return Err(self.error(offset, format!("{what}: no ScatteringData")));
        };
        let structure = self.document.structure.to_ascii_lowercase();
        let table = match structure.as_str() {
            "columns" | "rows" => {
                let incident = self.basis_named(&block.column_basis, "ColumnAngleBasis", offset)?;
                let exiting = self.basis_named(&block.row_basis, "RowAngleBasis", offset)?;
                let numbers = Numbers { data, at: 0, offset: *data_at, what: &what, parser: self };
                let (matrix, extra) = numbers.matrix(incident, exiting, structure == "rows")?;
                if extra > 0 {
                    let warning = format!("{what}: {extra} values more than the basis has were ignored");
                    self.document.warnings.push(warning);
                }
                Table::Matrix(matrix)
            }
            "tensortree3" | "tensortree4" => {
                if !block.angle_basis.eq_ignore_ascii_case("LBNL/Shirley-Chiu") {
                    let found = &block.angle_basis;
                    return Err(self.error(
                        offset,
                        format!("{what}: angle basis '{found}' is not supported; a tensor tree has LBNL/Shirley-Chiu"),
                    ));
                }
                let rank = if structure.ends_with('3') { 3 } else { 4 };
                let mut numbers = Numbers { data, at: 0, offset: *data_at, what: &what, parser: self };
                let root = numbers.node(rank, 0)?;
                numbers.end()?;
                Table::Tree(Tree::from_nested(rank, root))
            }
            _ => {
                let found = &self.document.structure;
                let message = format!(
                    "IncidentDataStructure is '{found}'; expected Columns, Rows, TensorTree3 or TensorTree4"
                );
                return Err(self.error(offset, message));
            }
        };
        self.document.blocks.push(Block { band: block.band, direction: block.direction, table });
        Ok(())
    }

    fn finish(mut self) -> Result<Document> {
        let end = self.text.len();
        if let Some(open) = self.path.last() {
            return Err(self.error(end, format!("the file ends inside <{open}>: is it complete?")));
        }
        for draft in std::mem::take(&mut self.drafts) {
            self.read_block(draft)?;
        }
        if !self.document.blocks.iter().any(|b| b.band.eq_ignore_ascii_case("Visible")) {
            return Err(self.error(end, "no WavelengthData for the Visible band"));
        }
        Ok(self.document)
    }
}

/// The numbers of one ScatteringData element.
struct Numbers<'a, 'b> {
    data: &'a [u8],
    at: usize,
    offset: usize,
    what: &'a str,
    parser: &'a Parser<'b>,
}

impl Numbers<'_, '_> {
    fn error(&self, message: impl std::fmt::Display) -> Error {
        self.parser.error(self.offset + self.at, format!("{}: {message}", self.what))
    }

    fn peek(&mut self) -> Option<u8> {
        while let Some(&b) = self.data.get(self.at) {
            if !(b.is_ascii_whitespace() || b == b',') {
                return Some(b);
            }
            self.at += 1;
        }
        None
    }

    fn value(&mut self) -> Result<Option<f32>> {
        let Some(first) = self.peek() else { return Ok(None) };
        if first == b'{' || first == b'}' {
            return Ok(None);
        }
        let rest = &self.data[self.at..];
        let end = rest
            .iter()
            .position(|b| b.is_ascii_whitespace() || matches!(b, b',' | b'{' | b'}'))
            .unwrap_or(rest.len());
        let word = std::str::from_utf8(&rest[..end]).unwrap_or("?");
        let value: f32 = word.parse().map_err(|_| self.error(format!("'{word}' is not a number")))?;
        if !(value >= 0.0 && value.is_finite()) {
            return Err(self.error(format!("value {word}; a BSDF is finite and not negative")));
        }
        self.at += end;
        Ok(Some(value))
    }

    /// The matrix, and how many values stood past its end.
    fn matrix(
        mut self,
        incident: Arc<AngleBasis>,
        exiting: Arc<AngleBasis>,
        by_rows: bool,
    ) -> Result<(Matrix, usize)> {
        let (columns, rows) = (incident.len(), exiting.len());
        let mut values = vec![0.0; columns * rows];
        for n in 0..columns * rows {
            let Some(value) = self.value()? else {
                return Err(self.error(format!(
                    "{n} values; expected {columns} x {rows} = {} for '{}' by '{}'",
                    columns * rows,
                    incident.name(),
                    exiting.name()
                )));
            };
            // In order "Columns" a line of the file is one exiting patch.
            let (i, o) = if by_rows { (n / rows, n % rows) } else { (n % columns, n / columns) };
            values[i * rows + o] = value;
        }
        let mut extra = 0;
        while self.value()?.is_some() {
            extra += 1;
        }
        Ok((Matrix { incident, exiting, values }, extra))
    }

    fn node(&mut self, rank: usize, depth: usize) -> Result<Nested> {
        if depth > MAX_TREE_DEPTH {
            return Err(self.error(format!("the tensor tree is more than {MAX_TREE_DEPTH} levels deep")));
        }
        self.expect(b'{')?;
        let node = if self.peek() == Some(b'{') {
            let mut children = Vec::with_capacity(1 << rank);
            for n in 0..1usize << rank {
                if self.peek() != Some(b'{') {
                    let all = 1usize << rank;
                    return Err(
                        self.error(format!("a branch of the tensor tree has {n} children; expected {all}"))
                    );
                }
                children.push(self.node(rank, depth + 1)?);
            }
            Nested::Branch(children)
        } else {
            let mut values = Vec::new();
            while let Some(value) = self.value()? {
                values.push(value);
            }
            let log2 = (0..=MAX_TREE_DEPTH as u8)
                .find(|&l| 1usize.checked_shl(u32::from(l) * rank as u32) == Some(values.len()))
                .ok_or_else(|| {
                    self.error(format!(
                        "a grid of the tensor tree has {} values; expected a power of {}",
                        values.len(),
                        1 << rank
                    ))
                })?;
            Nested::Grid(log2, values)
        };
        self.expect(b'}')?;
        Ok(node)
    }

    fn expect(&mut self, brace: u8) -> Result<()> {
        match self.peek() {
            Some(b) if b == brace => {
                self.at += 1;
                Ok(())
            }
            Some(b) => Err(self.error(format!("found '{}'; expected '{}'", b as char, brace as char))),
            None => Err(self.error(format!("the tensor tree ends too early; expected '{}'", brace as char))),
        }
    }

    fn end(&mut self) -> Result<()> {
        match self.peek() {
            None => Ok(()),
            Some(_) => Err(self.error("something follows the end of the tensor tree")),
        }
    }
}
