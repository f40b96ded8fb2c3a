//! Views from options, view files and headers.

use super::{View, ViewKind};
use crate::{files::read, raw::parse_real};
use std::path::Path;
use sunpeak_core::{Error, Location, Result, Vec3};

/// A line that begins with one of these (after a path) holds view options; the last line counts.
const VIEW_LINES: [&str; 7] = ["VIEW=", "rpict", "rvu", "rpiece", "rxpiece", "pinterp", "rview"];

impl View {
    /// A view from options, such as `-vta -vp 1 2 3 -vh 180 -vv 180`, or `-vf file` among them; unknown options are
    /// errors. What is not given is as in Radiance's standard view.
    pub fn parse(options: &str) -> Result<Self> {
        Self::parse_words(&options.split_whitespace().collect::<Vec<_>>())
    }

    /// The same from words, which may hold blanks, as file names do.
    pub fn parse_words(words: &[&str]) -> Result<Self> {
        let mut view = Self::default();
        let mut at = 0;
        while at < words.len() {
            at += match (words[at], words.get(at + 1)) {
                ("-vf", Some(name)) => {
                    view.read_file(Path::new(name))?;
                    2
                }
                ("-vf", None) => return Err(Error::value("expected a file after -vf")),
                _ => 1 + view.set_option(&words[at..]).map_err(Error::value)?,
            };
        }
        view.check()?;
        Ok(view)
    }

    /// The view of a `.vf` file, or of a picture's header.
    pub fn load(path: &Path) -> Result<Self> {
        let mut view = Self::default();
        view.read_file(path)?;
        view.check().map_err(|error| Error::input(file_location(path), error.to_string()))?;
        Ok(view)
    }

    fn read_file(&mut self, path: &Path) -> Result<()> {
        let bytes = read(path)?;
        // A picture's pixels follow its header after an empty line.
        let end = bytes.windows(2).position(|pair| pair == b"\n\n").filter(|_| bytes.starts_with(b"#?"));
        let text = String::from_utf8_lossy(&bytes[..end.unwrap_or(bytes.len())]);
        let mut found = false;
        for line in text.lines() {
            found |= apply_header_line(self, line);
        }
        if found {
            return Ok(());
        }
        let message =
            "no view found: expected a line such as \"rvu -vtv -vp 0 0 0 -vd 0 1 0\" or \"VIEW= -vta …\"";
        Err(Error::input(file_location(path), message))
    }

    /// Set what the option at the front of `words` says; how many values it took.
    fn set_option(&mut self, words: &[&str]) -> std::result::Result<usize, String> {
        let option = words[0];
        if let Some(letter) = option.strip_prefix("-vt") {
            let mut letters = letter.chars();
            self.kind = match (letters.next().and_then(ViewKind::from_letter), letters.next()) {
                (Some(kind), None) => kind,
                _ => {
                    return Err(format!(
                        "unknown view type {option}: expected -vtv, -vtl, -vta, -vth, -vts or -vtc"
                    ));
                }
            };
            return Ok(0);
        }
        let real = |at: usize| {
            let word = words.get(at).copied();
            word.and_then(parse_real).ok_or_else(|| {
                let found = word.map_or("the end".into(), |word| format!("\"{word}\""));
                format!("expected a number after {option}, found {found}")
            })
        };
        let vector = || Ok::<_, String>(Vec3::new(real(1)?, real(2)?, real(3)?));
        match option {
            "-vp" => self.position = vector()?,
            "-vd" => self.direction = vector()?,
            "-vu" => self.up = vector()?,
            "-vh" => self.horizontal_deg = real(1)?,
            "-vv" => self.vertical_deg = real(1)?,
            "-vo" => self.fore = real(1)?,
            "-va" => self.aft = real(1)?,
            "-vs" => self.shift = real(1)?,
            "-vl" => self.lift = real(1)?,
            _ => {
                return Err(format!(
                    "unknown view option \"{option}\": expected -vt? -vp -vd -vu -vh -vv -vo -va -vs -vl"
                ));
            }
        }
        Ok(if matches!(option, "-vp" | "-vd" | "-vu") { 3 } else { 1 })
    }
}

/// If `line` is a view line, change `view` by the options in it (others are skipped). Was any?
pub(crate) fn apply_header_line(view: &mut View, line: &str) -> bool {
    let Some(options) = view_options(line) else { return false };
    let words: Vec<&str> = options.split_whitespace().collect();
    let mut any = false;
    let mut at = 0;
    while at < words.len() {
        let used = if words[at].starts_with("-v") { view.set_option(&words[at..]).ok() } else { None };
        any |= used.is_some();
        at += 1 + used.unwrap_or(0);
    }
    any
}

/// What follows `VIEW=` or the name of a program that has a view.
fn view_options(line: &str) -> Option<&str> {
    let first = line.split(char::is_whitespace).next()?;
    let name = first.rsplit('/').next().unwrap_or(first);
    if !VIEW_LINES.iter().any(|known| name.starts_with(known)) {
        return None;
    }
    // "VIEW=-vtv" without a space is read too.
    Some(line.split_once("VIEW=").map_or(&line[first.len()..], |(_, options)| options))
}

fn file_location(path: &Path) -> Location {
    Location::new(path.to_string_lossy().as_ref(), 0, 0)
}
