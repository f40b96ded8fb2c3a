//! The command line of `xform`: arrays and argument files unrolled to single invocations.

use super::transform_args::{is_transform_option, parse_transform};
use crate::raw::parse_integer;
use std::sync::Arc;
use sunpeak_core::Transform;

/// More copies than a scene can hold: the counts must be a mistake.
const MAX_COPIES: usize = 1_000_000;
/// Argument files that name argument files: deeper than this they name themselves.
const MAX_ARGUMENT_FILES: usize = 32;

/// One pass over the input.
#[derive(Clone, Debug, Default)]
pub struct Invocation {
    /// `-I`: turn all surfaces around.
    pub invert: bool,
    /// `-c`: leave commands in the input for whoever reads the output.
    pub keep_commands: bool,
    /// `-m`: the modifier that all surfaces get.
    pub modifier: Option<Arc<str>>,
    /// `-n`: what goes before the names of all surfaces.
    pub prefix: Option<String>,
    /// What is done to geometry.
    pub transform: Transform,
    /// The words of the transform, for primitives that keep it among their arguments.
    pub transform_args: Vec<String>,
    /// All options, to be repeated after a kept command.
    pub options: Vec<String>,
    /// Files to read; none: the output of the command before.
    pub files: Vec<String>,
}

/// The passes that the arguments (without the program's name) ask for, in order. `read` reads an argument file.
pub fn plan(
    args: &[String],
    read: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Vec<Invocation>, String> {
    let mut planner = Planner { read, planned: Vec::new(), depth: 0 };
    planner.plan(args)?;
    Ok(planner.planned)
}

struct Planner<'r> {
    read: &'r mut dyn FnMut(&str) -> Result<String, String>,
    planned: Vec<Invocation>,
    depth: usize,
}

impl Planner<'_> {
    /// Argument files first, then arrays, the leftmost outermost: Radiance's order, and so are the names it makes.
    fn plan(&mut self, args: &[String]) -> Result<(), String> {
        if let Some(at) = args.iter().position(|arg| arg == "-f") {
            return self.argument_file(args, at);
        }
        if let Some(at) = args.iter().position(|arg| arg == "-a") {
            return self.array(args, at);
        }
        if self.planned.len() >= MAX_COPIES {
            return Err(too_many());
        }
        self.planned.push(invocation(args)?);
        Ok(())
    }

    fn argument_file(&mut self, args: &[String], at: usize) -> Result<(), String> {
        let name = args.get(at + 1).filter(|name| !name.starts_with('-'));
        let name = name.ok_or("expected a file of arguments after -f")?;
        if self.depth >= MAX_ARGUMENT_FILES {
            return Err(format!("the argument file \"{name}\" names itself, directly or through others"));
        }
        let text = (self.read)(name)?;
        self.depth += 1;
        for (index, words) in argument_lines(&text).into_iter().enumerate() {
            let mut line = [&args[..at], &words, &args[at + 2..]].concat();
            match line.iter().position(|arg| arg == "-n").map(|i| i + 1).filter(|&i| i < line.len()) {
                Some(i) => line[i] = format!("{}.{index}", line[i]),
                None => line.splice(0..0, ["-n".into(), format!("i{index}")]).for_each(drop),
            }
            self.plan(&line)?;
        }
        self.depth -= 1;
        Ok(())
    }

    fn array(&mut self, args: &[String], at: usize) -> Result<(), String> {
        let count = args.get(at + 1).and_then(|word| parse_integer(word)).filter(|&n| n > 0);
        let count = count.ok_or("expected the number of copies, at least 1, after -a")?;
        // Said before the work is done, where the counts alone tell.
        let all_counts =
            args.windows(2).filter(|pair| pair[0] == "-a").filter_map(|pair| parse_integer(&pair[1]));
        if all_counts.fold(1, i64::saturating_mul) > MAX_COPIES as i64 {
            return Err(too_many());
        }
        let names: Vec<usize> = (1..args.len()).filter(|&i| args[i - 1] == "-n").collect();
        let name = names.last().map(|&i| args[i].clone());
        for index in 0..count {
            let mut line = args.to_vec();
            line[at] = "-i".into();
            line[at + 1] = index.to_string();
            match &name {
                Some(name) => names.iter().for_each(|&i| line[i] = format!("{name}.{index}")),
                None => line.splice(0..0, ["-n".into(), format!("a{index}")]).for_each(drop),
            }
            self.plan(&line)?;
        }
        Ok(())
    }
}

fn too_many() -> String {
    format!("more than {MAX_COPIES} copies: are the counts after -a right?")
}

/// Words of the lines of an argument file, without empty lines, comments and a leading `!xform`.
fn argument_lines(text: &str) -> Vec<Vec<String>> {
    let joined = text.replace("\r\n", "\n").replace("\\\n", " ");
    let lines = joined.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines
        .map(|line| {
            let line = line.strip_prefix('!').unwrap_or(line);
            split_quoted(line.strip_prefix("xform ").unwrap_or(line))
        })
        .collect()
}

/// Words, which may be in quotes.
fn split_quoted(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut rest = line.trim_start();
    while let Some(first) = rest.chars().next() {
        let (word, after) = match first {
            '"' | '\'' => rest[1..].split_once(first).unwrap_or((&rest[1..], "")),
            _ => rest.split_once(char::is_whitespace).unwrap_or((rest, "")),
        };
        words.push(word.to_string());
        rest = after.trim_start();
    }
    words
}

/// Options, then the transform, then the files.
fn invocation(args: &[String]) -> Result<Invocation, String> {
    let mut planned = Invocation::default();
    let mut at = 0;
    while let Some(option) = args.get(at) {
        match option.as_str() {
            "-c" => planned.keep_commands = true,
            "-e" => planned.keep_commands = false,
            "-I" => planned.invert = !planned.invert,
            "-m" | "-n" => {
                at += 1;
                let name = args.get(at).ok_or_else(|| format!("expected a name after {option}"))?;
                planned.set_name(option, name);
            }
            _ => break,
        }
        at += 1;
    }
    let (transform, used) = parse_transform(&args[at..])?;
    planned.transform = transform;
    planned.transform_args = args[at..at + used].to_vec();
    planned.options = args[..at + used].to_vec();
    planned.files = args[at + used..].to_vec();
    match planned.files.first() {
        Some(word) if word.starts_with('-') => Err(misplaced(word)),
        _ => Ok(planned),
    }
}

impl Invocation {
    /// The first new modifier counts; prefixes are joined.
    fn set_name(&mut self, option: &str, name: &str) {
        if option == "-m" {
            self.modifier.get_or_insert_with(|| name.into());
        } else {
            self.prefix = Some(match &self.prefix {
                Some(before) => format!("{before}.{name}"),
                None => name.into(),
            });
        }
    }
}

fn misplaced(word: &str) -> String {
    if matches!(word, "-c" | "-e" | "-I" | "-m" | "-n") || is_transform_option(word) {
        return format!("the option {word} stands too late: -c -e -I -m -n come first, then the transform");
    }
    format!(
        "unknown option {word}: expected -c -e -I -m -n -f, -t -rx -ry -rz -s -mx -my -mz -i -a, then files"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::Vec3;

    fn passes(line: &str, file: &str) -> Result<Vec<Invocation>, String> {
        let args: Vec<String> = line.split_whitespace().map(String::from).collect();
        plan(&args, &mut |_| Ok(file.to_string()))
    }

    #[test]
    fn arrays_nest_and_name_their_copies() {
        let planned =
            passes("-n lamp -rz 90 -a 2 -t 3 0 0 -a 3 -t 0 2 0 -i 1 -t 0 0 9 a.rad", "").expect("a plan");
        let places: Vec<_> = planned
            .iter()
            .map(|p| (p.prefix.clone().unwrap_or_default(), p.transform.point(Vec3::X)))
            .collect();
        assert_eq!(places.len(), 6);
        // The third of the second row: x turned to y, then moved.
        assert_eq!(places[5].0, "lamp.1.2");
        assert!((places[5].1 - Vec3::new(3.0, 5.0, 9.0)).length() < 1e-12, "{:?}", places[5]);
        assert_eq!(passes("-a 1 -a 2 -t 1 0 0", "").expect("a plan")[1].prefix.as_deref(), Some("a0.1"));
    }

    #[test]
    fn argument_files_are_inserted_line_by_line() {
        let file = "# two\n-t 1 0 0\n\n!xform -m \"my mat\" -rz 90\n";
        let planned = passes("-n x -f args a.rad", file).expect("a plan");
        assert_eq!(planned.len(), 2);
        assert_eq!(planned[1].prefix.as_deref(), Some("x.1"));
        assert_eq!(planned[1].modifier.as_deref(), Some("my mat"));
        assert_eq!(planned[0].files, ["a.rad"]);
        assert_eq!(passes("-f args", file).expect("a plan")[0].prefix.as_deref(), Some("i0"));
    }

    #[test]
    fn mistakes_are_said() {
        for (line, expected) in [
            ("-a 0 -t 1 0 0", "at least 1, after -a"),
            ("-a 100000 -a 100000 -t 1 0 0", "more than 1000000 copies"),
            ("-t 1 0 0 -n x", "the option -n stands too late"),
            ("-q", "unknown option -q"),
            ("-n", "expected a name after -n"),
            ("-f args", "names itself"),
        ] {
            let message = passes(line, "-f args").expect_err(line);
            assert!(message.contains(expected), "{message}");
        }
    }
}
