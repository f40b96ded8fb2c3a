//! Splits a command line as a shell would, as far as scene files need it: words, quotes, pipes, comments.

/// The programs of a pipeline, each with its arguments.
pub type Pipeline = Vec<Vec<String>>;

/// Words of a pipeline, or what in it only a real shell can do.
pub fn split(line: &str) -> Result<Pipeline, String> {
    let mut splitter = Splitter { stages: vec![Vec::new()], word: None };
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '\\' => match chars.next() {
                // An escaped line end joins the lines.
                Some('\n') => {}
                Some(escaped) => splitter.push(escaped),
                None => splitter.push('\\'),
            },
            '\'' => loop {
                match chars.next() {
                    Some('\'') => break splitter.open(),
                    Some(quoted) => splitter.push(quoted),
                    None => return Err("the quote ' is not closed".into()),
                }
            },
            '"' => splitter.double_quoted(&mut chars)?,
            '|' if chars.peek() != Some(&'|') => splitter.end_stage()?,
            '#' if splitter.word.is_none() => while chars.next_if(|&c| c != '\n').is_some() {},
            // Nothing may follow the last separator.
            ';' if chars.clone().all(char::is_whitespace) => splitter.end_word(),
            '|' | '&' | ';' | '<' | '>' | '(' | ')' | '$' | '`' | '*' | '?' => {
                return Err(format!("`{c}` needs a shell"));
            }
            _ if c.is_whitespace() => splitter.end_word(),
            _ => splitter.push(c),
        }
    }
    splitter.finish()
}

struct Splitter {
    stages: Pipeline,
    word: Option<String>,
}

impl Splitter {
    fn open(&mut self) {
        self.word.get_or_insert_default();
    }

    fn push(&mut self, c: char) {
        self.word.get_or_insert_default().push(c);
    }

    fn end_word(&mut self) {
        if let (Some(word), Some(stage)) = (self.word.take(), self.stages.last_mut()) {
            stage.push(word);
        }
    }

    fn end_stage(&mut self) -> Result<(), String> {
        self.end_word();
        if self.stages.last().is_none_or(Vec::is_empty) {
            return Err("a pipe without a command before it".into());
        }
        self.stages.push(Vec::new());
        Ok(())
    }

    fn double_quoted(&mut self, chars: &mut impl Iterator<Item = char>) -> Result<(), String> {
        self.open();
        loop {
            match chars.next() {
                Some('"') => return Ok(()),
                Some(c @ ('$' | '`')) => return Err(format!("`{c}` needs a shell")),
                Some('\\') => match chars.next() {
                    Some('\n') => {}
                    Some(c @ ('"' | '\\' | '$' | '`')) => self.push(c),
                    Some(c) => {
                        self.push('\\');
                        self.push(c);
                    }
                    None => {}
                },
                Some(c) => self.push(c),
                None => return Err("the quote \" is not closed".into()),
            }
        }
    }

    fn finish(mut self) -> Result<Pipeline, String> {
        self.end_word();
        if self.stages.last().is_none_or(Vec::is_empty) {
            return Err("no command is given".into());
        }
        Ok(self.stages)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_quotes_pipes_and_comments() {
        let line = "genbox 'my mat' \"b\\\" x\" 1 \\\n 2 a\\ b ''|xform -t 0 0 1 # move it";
        let expected =
            vec![vec!["genbox", "my mat", "b\" x", "1", "2", "a b", ""], vec!["xform", "-t", "0", "0", "1"]];
        assert_eq!(split(line).expect("a pipeline"), expected);
        assert_eq!(split("cat a#b ;").expect("a pipeline"), [["cat", "a#b"]]);
    }

    #[test]
    fn what_needs_a_shell_is_said() {
        for line in ["xform *.rad", "a && b", "a; b", "cat < x", "echo $HOME", "a || b", "x \"$y\"", "`x`"] {
            assert!(split(line).expect_err(line).contains("needs a shell"), "{line}");
        }
        for line in ["", "| xform", "xform |", "xform 'a", "xform \"a"] {
            assert!(split(line).is_err(), "{line}");
        }
    }
}
