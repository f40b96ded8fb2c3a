//! Text to items. The language is a stream of words that counts its own arguments, so that a tokeniser with
//! positions reads it whole; a grammar library would add nothing but its types.

use super::{
    Class, CommandLine, Item, Primitive, PrimitiveType,
    cursor::{Cursor, Mark, Word},
    parse_integer, parse_real,
};
use std::{borrow::Cow, fmt, path::Path, sync::Arc};
use sunpeak_core::{Error, Result};

/// Counts are believed only so far before the arguments are seen.
const MAX_PREALLOCATED: usize = 1024;

/// The items of a scene text, in order; `name` is what error messages call it.
pub fn parse(text: &[u8], name: &str, directory: &Path) -> Result<Vec<Item>> {
    let mut parser = Parser::new(text, name, directory);
    let mut items = Vec::new();
    while let Some(item) = parser.item()? {
        items.push(item);
    }
    Ok(items)
}

/// The items of a scene text and all that is wrong in it: after a mistake reading goes on where a primitive seems to begin.
pub fn parse_all(text: &[u8], name: &str, directory: &Path) -> (Vec<Item>, Vec<Error>) {
    let mut parser = Parser::new(text, name, directory);
    let (mut items, mut errors) = (Vec::new(), Vec::new());
    loop {
        parser.skip_blank();
        let begin = parser.cursor.mark();
        match parser.item() {
            Ok(Some(item)) => items.push(item),
            Ok(None) => return (items, errors),
            Err(error) => {
                errors.push(error);
                parser.cursor.skip_to_line(begin, begins_primitive);
            }
        }
    }
}

/// Does a line look like `modifier type …`, or like a command?
fn begins_primitive(line: &[u8]) -> bool {
    let mut words = line.split(|byte| byte.is_ascii_whitespace()).filter(|word| !word.is_empty());
    let Some(first) = words.next() else { return false };
    let second = words.next().and_then(|word| std::str::from_utf8(word).ok());
    let is_type = |word: &str| first == b"void" || PrimitiveType::find(word).is_some();
    first[0] == b'!' || second.is_some_and(is_type)
}

/// A primitive as messages call it: put into words only where there is something to say.
#[derive(Clone)]
struct Named<'t> {
    kind: &'static str,
    name: Cow<'t, str>,
}

impl fmt::Display for Named<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} \"{}\"", self.kind, self.name)
    }
}

struct Parser<'t> {
    cursor: Cursor<'t>,
    directory: Arc<Path>,
    /// The modifier read last: surfaces of the same material follow each other and share its name.
    modifier: Arc<str>,
    /// The primitive read last, for a hint: its argument count may be wrong.
    last: Option<Named<'t>>,
}

impl<'t> Parser<'t> {
    fn new(text: &'t [u8], name: &str, directory: &Path) -> Self {
        Self {
            cursor: Cursor::new(text, name.into()),
            directory: directory.into(),
            modifier: "void".into(),
            last: None,
        }
    }

    fn item(&mut self) -> Result<Option<Item>> {
        self.skip_blank();
        match self.cursor.peek() {
            None => Ok(None),
            Some(b'!') => Ok(Some(self.command())),
            Some(_) => self.primitive().map(|p| Some(Item::Primitive(p))),
        }
    }

    /// Skip white space and comments.
    fn skip_blank(&mut self) {
        self.cursor.skip_space();
        while self.cursor.peek() == Some(b'#') {
            self.cursor.skip_line();
            self.cursor.skip_space();
        }
    }

    fn command(&mut self) -> Item {
        let mark = self.cursor.mark();
        let line = self.cursor.continued_line();
        Item::Command(CommandLine {
            text: line[1..].to_string(),
            location: self.cursor.location(mark),
            directory: self.directory.clone(),
        })
    }

    fn primitive(&mut self) -> Result<Primitive> {
        let modifier = self.expect(&"a modifier")?;
        let kind_word = self.expect(&"a primitive's type")?;
        let Some(kind) = PrimitiveType::find(&kind_word.text) else {
            return Err(self.unknown_type(&modifier, &kind_word));
        };
        let name = self.expect(&format_args!("the name of this {}", kind.name))?.text;
        let what = Named { kind: kind.name, name: name.clone() };
        let (strings, reals) = if kind.class == Class::Alias {
            let reference = self.expect(&format_args!("the name that {what} stands for"))?;
            (vec![reference.text.into_owned()], Vec::new())
        } else {
            self.arguments(&what)?
        };
        self.last = Some(what);
        let location = self.cursor.location(modifier.mark);
        Ok(Primitive {
            modifier: self.share(&modifier.text),
            kind,
            name: name.into_owned(),
            strings,
            reals,
            location,
            directory: self.directory.clone(),
        })
    }

    fn share(&mut self, modifier: &str) -> Arc<str> {
        if *self.modifier != *modifier {
            self.modifier = modifier.into();
        }
        self.modifier.clone()
    }

    fn arguments(&mut self, what: &Named) -> Result<(Vec<String>, Vec<f64>)> {
        let strings = self.list(what, "string", |word| Some(word.to_string()))?;
        let (integers, mark) = self.count(what, "integer")?;
        if integers != 0 {
            let message =
                format!("{what} cannot have {integers} integer arguments: no primitive has any, expected 0");
            return Err(self.cursor.error(mark, message));
        }
        Ok((strings, self.list(what, "real", parse_real)?))
    }

    fn list<T>(&mut self, what: &Named, kind: &str, convert: impl Fn(&str) -> Option<T>) -> Result<Vec<T>> {
        let (count, counted) = self.count(what, kind)?;
        let mut values = Vec::with_capacity(count.min(MAX_PREALLOCATED));
        for i in 1..=count {
            let Some(word) = self.cursor.word()? else {
                let message = format!(
                    "{what} says that it has {count} {kind} arguments, but the text ends after {}",
                    values.len()
                );
                return Err(self.cursor.error(counted, message));
            };
            values.push(convert(&word.text).ok_or_else(|| {
                let message = format!(
                    "expected {kind} argument {i} of {count} of {what}, a finite number, found \"{}\"",
                    word.text
                );
                self.cursor.error(word.mark, message)
            })?);
        }
        Ok(values)
    }

    fn count(&mut self, what: &Named, kind: &str) -> Result<(usize, Mark)> {
        let word = self.expect(&format_args!("the number of {kind} arguments of {what}"))?;
        let count = parse_integer(&word.text).and_then(|n| usize::try_from(n).ok());
        let count = count.ok_or_else(|| {
            let message =
                format!("expected the number of {kind} arguments of {what}, found \"{}\"", word.text);
            self.cursor.error(word.mark, message)
        })?;
        Ok((count, word.mark))
    }

    fn expect(&mut self, wanted: &dyn fmt::Display) -> Result<Word<'t>> {
        match self.cursor.word()? {
            Some(word) => Ok(word),
            None => Err(self
                .cursor
                .error(self.cursor.mark(), format!("expected {wanted}, found the end of the text"))),
        }
    }

    fn unknown_type(&self, modifier: &Word, kind: &Word) -> Error {
        if let (Some(last), Some(_)) = (&self.last, parse_real(&modifier.text)) {
            let message = format!(
                "expected a modifier and a primitive's type, found \"{} {}\": does {last} above count its arguments \
                 right?",
                modifier.text, kind.text
            );
            return self.cursor.error(modifier.mark, message);
        }
        let message = format!(
            "unknown primitive \"{}\": expected a type such as polygon, plastic or alias after the modifier \"{}\"",
            kind.text, modifier.text
        );
        self.cursor.error(kind.mark, message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::Location;

    fn primitives(text: &str) -> Vec<Primitive> {
        let items = parse(text.as_bytes(), "t.rad", Path::new(".")).expect("a scene");
        let primitive = |item| match item {
            Item::Primitive(primitive) => primitive,
            Item::Command(command) => panic!("a command: {}", command.text),
        };
        items.into_iter().map(primitive).collect()
    }

    fn message(text: &str) -> String {
        parse(text.as_bytes(), "t.rad", Path::new(".")).expect_err("an error").to_string()
    }

    #[test]
    fn reads_primitives_quotes_comments_and_aliases() {
        let text =
            "# head\nvoid plastic 'a b'\n0 0\r\n5 .1 .2 .3 0 0\n  \"a b\" alias c\"d e\"f 'a b' # tail\n";
        let read = primitives(text);
        assert_eq!(
            (&*read[0].modifier, read[0].kind.name, read[0].name.as_str()),
            ("void", "plastic", "a b")
        );
        assert_eq!(read[0].reals, [0.1, 0.2, 0.3, 0.0, 0.0]);
        assert_eq!((read[1].name.as_str(), read[1].strings[0].as_str()), ("cd ef", "a b"));
        assert_eq!(read[1].location, Location::new("t.rad", 5, 3));
    }

    #[test]
    fn reads_commands_with_continued_lines() {
        let items = parse(b"!xform \\\n a.rad\nvoid alias x y", "t.rad", Path::new(".")).expect("a scene");
        assert!(matches!(&items[0], Item::Command(c) if c.text == "xform \\\n a.rad"));
        assert!(matches!(&items[1], Item::Primitive(p) if p.location.line == 3));
    }

    #[test]
    fn reading_goes_on_after_a_mistake() {
        let text = "void plastik a\n0 0 5 1 1 1 0 0\nvoid plastic b 0 0 6 1 1 1 0 0\nb sphere s 0 0 4 0 0 0 1\n\
                    b sphere t\n0 0 four\n# end\n!genbox b c 1 1 1\nvoid light 'l";
        let (items, errors) = parse_all(text.as_bytes(), "t.rad", Path::new("."));
        let lines: Vec<_> =
            errors.iter().map(|e| e.to_string().split(':').nth(1).map(String::from)).collect();
        assert_eq!(lines, ["1", "4", "6", "9"].map(|line| Some(line.to_string())), "{errors:?}");
        assert!(matches!(&items[..], [Item::Primitive(s), Item::Command(_)] if s.name == "s"), "{items:?}");
    }

    #[test]
    fn says_what_is_wrong_and_where() {
        let cases = [
            ("void plastik a 0 0 0", "t.rad:1:6: unknown primitive \"plastik\""),
            ("void plastic a\n0 0 5 1 2 x 4 5", "t.rad:2:11: expected real argument 3 of 5 of plastic \"a\""),
            ("void plastic a 0 0 5 1 2", "t.rad:1:20: plastic \"a\" says that it has 5 real arguments, but"),
            ("void plastic a 0 0 1 nan", "t.rad:1:22: expected real argument 1 of 1"),
            ("void plastic a 0 1 7 0", "t.rad:1:18: plastic \"a\" cannot have 1 integer arguments"),
            ("void plastic a -1 0 0", "t.rad:1:16: expected the number of string arguments of plastic \"a\""),
            ("void plastic", "t.rad:1:13: expected the name of this plastic, found the end"),
            ("void light a 1 'b c\n0 3 1 1 1", "t.rad:1:16: this quote is not closed"),
            (
                "void plastic a 0 0 4 1 1 1 0 0\na polygon b 0 0 0",
                "does plastic \"a\" above count its arguments",
            ),
        ];
        for (text, expected) in cases {
            let message = message(text);
            assert!(message.contains(expected), "{message}");
        }
    }
}
