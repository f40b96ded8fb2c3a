//! Primitives as text that reads back as the same.

use super::{Class, Primitive};
use std::fmt;

impl fmt::Display for Primitive {
    /// As it stands in a scene file, with every digit of its numbers.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { modifier, kind, name, strings, reals, .. } = self;
        write!(f, "{} {} {}", Quoted(modifier), kind.name, Quoted(name))?;
        if kind.class == Class::Alias {
            return writeln!(f, " {}", Quoted(strings.first().map_or("", String::as_str)));
        }
        write!(f, "\n{}", strings.len())?;
        strings.iter().try_for_each(|word| write!(f, " {}", Quoted(word)))?;
        write!(f, "\n0\n{}", reals.len())?;
        for (i, number) in reals.iter().enumerate() {
            let separator = if i > 0 && i % 3 == 0 { "\n\t" } else { " " };
            write!(f, "{separator}{number}")?;
        }
        f.write_str("\n")
    }
}

/// A word, in quotes where it needs them.
struct Quoted<'w>(&'w str);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = self.0;
        let is_plain = |c: char| !c.is_whitespace() && !matches!(c, '"' | '\'');
        // A first word that begins so would be a comment or a command.
        if !word.is_empty() && word.chars().all(is_plain) && !word.starts_with(['#', '!']) {
            return f.write_str(word);
        }
        // Quotes of one kind hold those of the other; a word with both is several quoted ones without space between.
        for (i, part) in word.split('"').enumerate() {
            if i > 0 {
                f.write_str("'\"'")?;
            }
            write!(f, "\"{part}\"")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::raw::{Item, parse};
    use std::path::Path;

    fn primitives(text: &str) -> Vec<super::Primitive> {
        let items = parse(text.as_bytes(), "t.rad", Path::new(".")).expect("a scene");
        items
            .into_iter()
            .map(|item| match item {
                Item::Primitive(primitive) => primitive,
                Item::Command(command) => panic!("a command: {}", command.text),
            })
            .collect()
    }

    #[test]
    fn what_is_written_reads_back_the_same() {
        let text = "void plastic 'a b' 0 0 5 .1 1e-300 .3333333333333333 0 0\n'a b' alias \"it's\" 'a b'\n\
                    \"it's\" polygon 'say \"o'\"'\" 0 0 9 1 2 3 4 5 6 -7e20 8 9\nvoid brightfunc '#f' 2 '!x' '' 0 1 1";
        let first = primitives(text);
        let written: String = first.iter().map(ToString::to_string).collect();
        let second = primitives(&written);
        assert_eq!(first.len(), 4);
        for (a, b) in first.iter().zip(&second) {
            assert_eq!((&a.modifier, &a.name, &a.strings), (&b.modifier, &b.name, &b.strings));
            assert_eq!((a.kind.name, &a.reals), (b.kind.name, &b.reals));
        }
    }
}
