//! Reading LBNL BSDF XML files (schemas 1.4 and 1.7) into named blocks of numbers.
//!
//! The text is read as a stream: numbers go from the reader's buffer to their table, words are kept, all else is passed over. So
//! memory is that of the tables, and whatever a file may hold that is not one is refused before it fills it.

mod draft;
mod numbers;
mod source;

use crate::{table::Table, tree::MAX_VALUES};
use draft::{Bases, BasisDraft, BlockDraft};
use numbers::Numbers;
use quick_xml::{Reader, events::Event};
use source::{LONGEST, Source, Wrong};
use std::{io::BufRead, sync::Arc};
use sunpeak_core::{Error, Location, Result};

/// What a file holds, before sides are given a meaning.
#[derive(Debug, Default)]
pub struct Document {
    /// `Material/Name`.
    pub name: String,
    /// `Material/Manufacturer`.
    pub manufacturer: String,
    /// `Material/Thickness` [m].
    pub thickness_m: Option<f64>,
    /// `Material/Comments`: how it was made, and its statistical error.
    pub comments: String,
    /// Names of all bands of the file, also of those that were not asked for.
    pub bands: Vec<String>,
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

/// Which tables of a file are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Band {
    /// Luminous, and colour by CIE X and Z (matrices) or u' and v' (trees).
    #[default]
    Visible,
    /// Of the whole solar spectrum; its blocks then stand for the luminous ones.
    Solar,
}

impl Band {
    /// Names of its blocks.
    fn names(self) -> &'static [&'static str] {
        match self {
            Self::Visible => &["Visible", "CIE-X", "CIE-Z", "CIE-u", "CIE-v"],
            Self::Solar => &["Solar"],
        }
    }
}

/// More bands than a file has for a purpose are not listed.
const MOST_BANDS: usize = 64;

/// Deepest nesting of elements; the schemas have 9.
const MAX_ELEMENT_DEPTH: usize = 64;

/// Parse the text of a file. `file` names it in messages.
pub fn parse(file: &str, text: &[u8]) -> Result<Document> {
    read(file, text)
}

/// Read a file as a stream. `file` names it in messages.
pub fn read(file: &str, reader: impl BufRead) -> Result<Document> {
    read_band(file, reader, Band::Visible)
}

/// [`read`], of one band.
pub fn read_band(file: &str, reader: impl BufRead, wanted: Band) -> Result<Document> {
    let file: Arc<str> = file.into();
    let (source, skipped) = source::begin(&file, reader)?;
    let mut parser = Parser { wanted, ..Parser::new(file.clone()) };
    if skipped > 0 {
        parser.document.warnings.push(format!("skipped {skipped} bytes before the XML begins"));
    }
    let mut reader = Reader::from_reader(source);
    reader.config_mut().check_end_names = true;
    let mut markup = Vec::new();
    loop {
        parser.text(reader.get_mut())?;
        reader.get_mut().renew();
        let place = reader.get_ref().place(&file);
        markup.clear();
        match reader.read_event_into(&mut markup).map_err(|e| broken(&file, place.clone(), e))? {
            Event::Start(tag) => {
                parser.open(tag.local_name().into_inner(), &place)?;
                let unit = tag.attributes().flatten().find(|a| a.key.local_name().as_ref() == "unit");
                parser.unit = unit.map_or(String::new(), |a| a.value.trim().to_ascii_lowercase());
            }
            Event::End(_) => parser.close(&place)?,
            Event::CData(chunk) => {
                let wrong = |w: Wrong| Error::input(place, w.message);
                parser.take_text(chunk.as_bytes()).map_err(wrong)?;
            }
            Event::DocType(_) => {
                return Err(Error::input(place, "a document type is not allowed in a BSDF file"));
            }
            Event::Eof => return parser.finish(place),
            _ => {}
        }
    }
}

fn broken(file: &str, place: Location, error: quick_xml::Error) -> Error {
    match error {
        quick_xml::Error::Io(e) if e.kind() != std::io::ErrorKind::InvalidData => {
            Error::io(file, std::io::Error::new(e.kind(), e.to_string()))
        }
        quick_xml::Error::Io(e) => Error::input(place, format!("broken XML: {e}")),
        e => Error::input(place, format!("broken XML: {e} (is the file complete?)")),
    }
}

/// Where we are in the document, and what has been said so far.
struct Parser {
    file: Arc<str>,
    wanted: Band,
    document: Document,
    path: Vec<String>,
    /// Attribute of the innermost element.
    unit: String,
    /// Text of the innermost element, if it is a word.
    word: Vec<u8>,
    /// … or its numbers, if it holds them.
    numbers: Option<Numbers>,
    values_left: usize,
    layers: usize,
    bases: Bases,
    basis: BasisDraft,
    band: String,
    block: BlockDraft,
    drafts: Vec<BlockDraft>,
}

/// What an element's text is.
#[derive(PartialEq)]
enum Content {
    Word,
    Numbers,
    Ignored,
}

impl Parser {
    fn new(file: Arc<str>) -> Self {
        Self {
            file,
            wanted: Band::Visible,
            document: Document::default(),
            path: Vec::new(),
            unit: String::new(),
            word: Vec::new(),
            numbers: None,
            values_left: MAX_VALUES,
            layers: 0,
            bases: Bases::default(),
            basis: BasisDraft::default(),
            band: String::new(),
            block: BlockDraft::default(),
            drafts: Vec::new(),
        }
    }

    /// Only the first layer counts, as in Radiance.
    fn content(&self) -> Content {
        let [.., parent, name] = self.path.as_slice() else { return Content::Ignored };
        if self.layers > 1 {
            return Content::Ignored;
        }
        match (parent.as_str(), name.as_str()) {
            ("WavelengthDataBlock", "ScatteringData") if self.band_is_used() => Content::Numbers,
            ("WavelengthDataBlock", "ScatteringData") => Content::Ignored,
            (
                "Material"
                | "DataDefinition"
                | "AngleBasis"
                | "ThetaBounds"
                | "AngleBasisBlock"
                | "WavelengthData"
                | "WavelengthDataBlock",
                _,
            ) => Content::Word,
            _ => Content::Ignored,
        }
    }

    fn band_is_used(&self) -> bool {
        self.wanted.names().iter().any(|b| b.eq_ignore_ascii_case(&self.band))
    }

    fn open(&mut self, name: &str, place: &Location) -> Result<()> {
        if self.path.len() >= MAX_ELEMENT_DEPTH {
            let message = format!("elements are nested more than {MAX_ELEMENT_DEPTH} deep");
            return Err(Error::input(place.clone(), message));
        }
        self.path.push(name.to_owned());
        self.word.clear();
        match name {
            "Layer" => self.layers += 1,
            "AngleBasis" => self.basis = BasisDraft::default(),
            "WavelengthData" => self.band.clear(),
            "WavelengthDataBlock" => self.block = BlockDraft::default(),
            _ => {}
        }
        if self.content() == Content::Numbers {
            let rank = self.rank().map_err(|message| Error::input(place.clone(), message))?;
            self.numbers = Some(Numbers::new(rank, self.values_left));
        }
        Ok(())
    }

    /// 3 or 4 for tensor trees, none for matrices; some files of matrices say so only after their data.
    fn rank(&self) -> std::result::Result<Option<usize>, String> {
        match self.document.structure.to_ascii_lowercase().as_str() {
            "columns" | "rows" | "" => Ok(None),
            "tensortree3" => Ok(Some(3)),
            "tensortree4" => Ok(Some(4)),
            _ => Err(format!(
                "IncidentDataStructure is '{}'; expected Columns, Rows, TensorTree3 or TensorTree4",
                self.document.structure
            )),
        }
    }

    /// The text up to the next markup.
    fn text(&mut self, source: &mut Source<impl BufRead>) -> Result<()> {
        let file = self.file.clone();
        match self.content() {
            Content::Ignored => source.text(&file, |_| Ok(())),
            _ => source.text(&file, |piece| self.take_text(piece)),
        }
    }

    fn take_text(&mut self, piece: &[u8]) -> std::result::Result<(), Wrong> {
        match self.content() {
            Content::Ignored => Ok(()),
            Content::Numbers => match &mut self.numbers {
                Some(numbers) => numbers.feed(piece).map_err(|w| Wrong {
                    at: w.at,
                    message: format!("{} {}: {}", self.band, self.block.direction, w.message),
                }),
                None => Ok(()),
            },
            Content::Word if self.word.len() + piece.len() > LONGEST => {
                Err(Wrong { at: 0, message: format!("a word of more than {LONGEST} bytes") })
            }
            Content::Word => {
                self.word.extend_from_slice(piece);
                Ok(())
            }
        }
    }

    /// An element ends: take what it says.
    fn close(&mut self, place: &Location) -> Result<()> {
        if self.layers <= 1
            && let [.., parent, name] = self.path.as_slice()
        {
            let (parent, name) = (parent.clone(), name.clone());
            self.take(&parent, &name, place)?;
        }
        self.path.pop();
        self.word.clear();
        Ok(())
    }

    fn word(&self) -> String {
        let text = String::from_utf8_lossy(&self.word);
        match quick_xml::escape::unescape(text.trim()) {
            Ok(unescaped) => unescaped.into_owned(),
            Err(_) => text.trim().to_owned(),
        }
    }

    fn take(&mut self, parent: &str, name: &str, place: &Location) -> Result<()> {
        let wrong = |message| Error::input(place.clone(), message);
        match (parent, name) {
            ("Material", "Name") => self.document.name = self.word(),
            ("Material", "Manufacturer") => self.document.manufacturer = self.word(),
            ("Material", "Comments") => self.document.comments = self.word(),
            // Files without a thickness leave it empty; nothing here depends on it.
            ("Material", "Thickness") => self.document.thickness_m = self.length_m(),
            ("DataDefinition", "IncidentDataStructure") => self.document.structure = self.word(),
            ("AngleBasis", "AngleBasisName") => self.basis.name = self.word(),
            ("ThetaBounds", "LowerTheta") => self.basis.lower_theta_deg = Some(self.number().map_err(wrong)?),
            ("ThetaBounds", "UpperTheta") => self.basis.upper_theta_deg = Some(self.number().map_err(wrong)?),
            ("AngleBasisBlock", "nPhis") => {
                let count = self.number().map_err(wrong)?;
                self.basis.set_phi_count(count).map_err(wrong)?;
            }
            ("AngleBasis", "AngleBasisBlock") => self.basis.end_ring().map_err(wrong)?,
            ("DataDefinition", "AngleBasis") => {
                self.bases.define(std::mem::take(&mut self.basis)).map_err(wrong)?;
            }
            ("WavelengthData", "Wavelength") => {
                self.band = self.word();
                let bands = &mut self.document.bands;
                if bands.len() < MOST_BANDS && !bands.contains(&self.band) {
                    bands.push(self.band.clone());
                }
            }
            ("WavelengthDataBlock", "WavelengthDataDirection") => self.block.direction = self.word(),
            ("WavelengthDataBlock", "ColumnAngleBasis") => self.block.column_basis = self.word(),
            ("WavelengthDataBlock", "RowAngleBasis") => self.block.row_basis = self.word(),
            ("WavelengthDataBlock", "AngleBasis") => self.block.angle_basis = self.word(),
            ("WavelengthDataBlock", "ScatteringData") => self.end_numbers(place)?,
            ("WavelengthData", "WavelengthDataBlock") => self.end_block(place),
            _ => {}
        }
        Ok(())
    }

    fn number(&self) -> std::result::Result<f64, String> {
        let word = self.word();
        word.parse()
            .ok()
            .filter(|v: &f64| v.is_finite())
            .ok_or_else(|| format!("'{}' is not a number", word.chars().take(40).collect::<String>()))
    }

    /// A length [m] with its unit, as Radiance has them; none if it is not one.
    fn length_m(&self) -> Option<f64> {
        let unit = match self.unit.as_str() {
            "" | "meter" => 1.0,
            "millimeter" => 1e-3,
            "centimeter" => 1e-2,
            "inch" => 0.0254,
            "foot" => 0.3048,
            _ => return None,
        };
        self.number().ok().filter(|length| *length >= 0.0).map(|length| length * unit)
    }

    fn end_numbers(&mut self, place: &Location) -> Result<()> {
        let Some(numbers) = self.numbers.take() else { return Ok(()) };
        let values = numbers.finish().map_err(|message| {
            Error::input(place.clone(), format!("{} {}: {message}", self.band, self.block.direction))
        })?;
        self.values_left -= values.len().min(self.values_left);
        self.block.values = Some((place.clone(), values));
        Ok(())
    }

    /// Keep a block of a band that is used. Some files define their basis after it.
    fn end_block(&mut self, place: &Location) {
        let mut block = std::mem::take(&mut self.block);
        if self.band_is_used() {
            block.band = if self.wanted == Band::Visible { self.band.clone() } else { "Visible".into() };
            block.end = place.clone();
            self.drafts.push(block);
        }
    }

    fn finish(mut self, end: Location) -> Result<Document> {
        if let Some(open) = self.path.last() {
            return Err(Error::input(end, format!("the file ends inside <{open}>: is it complete?")));
        }
        for draft in std::mem::take(&mut self.drafts) {
            let block =
                draft.table(&self.document.structure, &mut self.bases, &mut self.document.warnings)?;
            self.document.blocks.push(block);
        }
        if !self.document.blocks.iter().any(|b| b.band.eq_ignore_ascii_case("Visible")) {
            let name = self.wanted.names()[0];
            return Err(Error::input(end, format!("no WavelengthData for the {name} band")));
        }
        Ok(self.document)
    }
}
