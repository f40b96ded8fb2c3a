//! The numbers of one `ScatteringData` element, taken from the text piece by piece.

use super::source::Wrong;
use crate::tree::{self, Tree, TreeBuilder};

/// Longest number: a float in full has 150 digits.
const LONGEST_NUMBER: usize = 400;

/// Values as they stand in the file.
#[derive(Debug)]
pub enum Values {
    /// Of a matrix.
    List(Vec<f32>),
    /// Of a tensor tree.
    Tree(Tree),
}

impl Values {
    /// How many.
    pub fn len(&self) -> usize {
        match self {
            Self::List(values) => values.len(),
            Self::Tree(tree) => tree.values().len(),
        }
    }
}

/// Reads values; forms the tree at once.
#[derive(Debug)]
pub struct Numbers {
    draft: Draft,
    /// A number that goes on in the next piece.
    partial: Vec<u8>,
    allowance: usize,
}

#[derive(Debug)]
enum Draft {
    List(Vec<f32>),
    Tree(TreeBuilder),
}

impl Numbers {
    /// Of a matrix, `rank` none, or of a tree; at most `allowance` values.
    pub fn new(rank: Option<usize>, allowance: usize) -> Self {
        let draft = match rank {
            None => Draft::List(Vec::new()),
            Some(rank) => Draft::Tree(TreeBuilder::new(rank, allowance)),
        };
        Self { draft, partial: Vec::new(), allowance }
    }

    /// The next piece of the text.
    pub fn feed(&mut self, piece: &[u8]) -> Result<(), Wrong> {
        let mut at = 0;
        if !self.partial.is_empty() {
            at = piece.iter().position(|&b| ends_number(b)).unwrap_or(piece.len());
            if self.partial.len() + at > LONGEST_NUMBER {
                return Err(Wrong {
                    at: 0,
                    message: format!("more than {LONGEST_NUMBER} characters in a number"),
                });
            }
            self.partial.extend_from_slice(&piece[..at]);
            if at == piece.len() {
                return Ok(());
            }
            self.end_partial().map_err(|message| Wrong { at: 0, message })?;
        }
        while let Some(&byte) = piece.get(at) {
            let taken = match byte {
                b'{' | b'}' => self.brace(byte).map(|()| 1),
                b',' => Ok(1),
                _ if byte.is_ascii_whitespace() => Ok(1),
                _ => {
                    let rest = &piece[at..];
                    match rest.iter().position(|&b| ends_number(b)) {
                        Some(length) => self.number(&rest[..length]).map(|()| length),
                        None if rest.len() > LONGEST_NUMBER => {
                            Err(format!("more than {LONGEST_NUMBER} characters in a number"))
                        }
                        None => {
                            self.partial.extend_from_slice(rest);
                            return Ok(());
                        }
                    }
                }
            };
            at += taken.map_err(|message| Wrong { at, message })?;
        }
        Ok(())
    }

    fn end_partial(&mut self) -> Result<(), String> {
        let word = std::mem::take(&mut self.partial);
        if word.is_empty() { Ok(()) } else { self.number(&word) }
    }

    fn brace(&mut self, brace: u8) -> Result<(), String> {
        match &mut self.draft {
            Draft::Tree(tree) if brace == b'{' => tree.open(),
            Draft::Tree(tree) => tree.close(),
            Draft::List(_) => Err(format!(
                "found '{}'; expected a number of a matrix (a tensor tree needs its IncidentDataStructure before the data)",
                brace as char
            )),
        }
    }

    fn number(&mut self, word: &[u8]) -> Result<(), String> {
        let value: f32 = std::str::from_utf8(word)
            .ok()
            .and_then(|w| w.parse().ok())
            .ok_or_else(|| format!("'{}' is not a number", shown(word)))?;
        if !(value >= 0.0 && value.is_finite()) {
            return Err(format!("value {}; a BSDF is finite and not negative", shown(word)));
        }
        match &mut self.draft {
            Draft::Tree(tree) => tree.value(value),
            Draft::List(values) if values.len() >= self.allowance => Err(tree::too_many_values()),
            Draft::List(values) => {
                values.push(value);
                Ok(())
            }
        }
    }

    /// All values, once the element ends.
    pub fn finish(mut self) -> Result<Values, String> {
        self.end_partial()?;
        Ok(match self.draft {
            Draft::List(values) => Values::List(values),
            Draft::Tree(tree) => Values::Tree(tree.finish()?),
        })
    }
}

fn ends_number(byte: u8) -> bool {
    byte.is_ascii_whitespace() || matches!(byte, b',' | b'{' | b'}')
}

/// A word for a message, cut where it is long.
fn shown(word: &[u8]) -> String {
    String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn pieces_of_any_length_give_the_same_values(values in proptest::collection::vec(0.0f32..1e6, 1..40), cuts in proptest::collection::vec(1usize..30, 1..20)) {
            let text: String = values.iter().map(|v| format!("{v:e},\n")).collect();
            let mut numbers = Numbers::new(None, 1 << 20);
            let mut rest = text.as_bytes();
            for cut in cuts.iter().cycle() {
                let (piece, after) = rest.split_at(rest.len().min(*cut));
                numbers.feed(piece).unwrap();
                rest = after;
                if rest.is_empty() {
                    break;
                }
            }
            let Values::List(read) = numbers.finish().unwrap() else { panic!() };
            prop_assert_eq!(read, values);
        }
    }
}
