//! Functions of a parameter or two, as the arguments of generators state them, with `-e` and `-f` for definitions.

use super::found;
use crate::raw::CommandLine;
use std::time::{Duration, Instant};
use sunpeak_cal::{Definitions, Expression, Failure, Inputs, Program};

/// The parameters, by the numbers of their channels.
const S: u32 = 1;
const T: u32 = 2;

/// Functions that take longer than this altogether are a mistake.
const LONGEST: Duration = Duration::from_secs(60);

/// Options that end a command line.
#[derive(Default)]
pub struct Options<'a> {
    /// Texts after `-e` and in files after `-f`, with what messages call them.
    definitions: Vec<(String, String)>,
    /// Others.
    pub flags: Vec<&'a str>,
}

impl<'a> Options<'a> {
    pub fn parse(
        args: &'a [String],
        read: &mut dyn FnMut(&str) -> Result<String, String>,
    ) -> Result<Self, String> {
        let mut options = Self::default();
        let mut words = args.iter();
        while let Some(word) = words.next() {
            match word.as_str() {
                "-e" => {
                    let text = words.next().ok_or("expected definitions after -e")?;
                    options.definitions.push(("-e".into(), text.clone()));
                }
                "-f" => {
                    let name = words
                        .next()
                        .ok_or_else(|| format!("expected a file after -f, found {}", found(None)))?;
                    options.definitions.push((name.clone(), read(name)?));
                }
                flag => options.flags.push(flag),
            }
        }
        Ok(options)
    }

    /// Was this flag among the options? It is not any more.
    pub fn take_flag(&mut self, flag: &str) -> bool {
        let before = self.flags.len();
        self.flags.retain(|&given| given != flag);
        self.flags.len() < before
    }
}

/// Compiled functions of `s` and `t`.
pub struct Functions {
    program: Program,
    names: Vec<String>,
    began: Instant,
}

struct Point {
    s: f64,
    t: f64,
}

impl Inputs for Point {
    fn channel(&self, number: u32) -> f64 {
        match number {
            S => self.s,
            T => self.t,
            _ => 0.0,
        }
    }

    fn function(&self, _: u32, _: &[f64]) -> Option<f64> {
        None
    }
}

impl Functions {
    /// Compile expressions in the parameter `t`, and of a surface `s`, which names its `condition`: where the definitions have such a
    /// function of (s,t), it is the last.
    pub fn compile(
        expressions: &[&String],
        options: &Options,
        condition: Option<&str>,
        command: &CommandLine,
    ) -> Result<Self, String> {
        let mut definitions = Definitions::new();
        if condition.is_some() {
            definitions.name_channel("s", S);
        }
        definitions.name_channel("t", T);
        for (name, text) in &options.definitions {
            definitions.load(text.as_bytes(), name, "").map_err(|error| error.to_string())?;
        }
        let mut read = |text: &str| definitions.expression(text, &command.location, "").map_err(message);
        let mut compiled: Vec<Expression> =
            expressions.iter().map(|text| read(text)).collect::<Result<_, _>>()?;
        let condition = condition.filter(|name| definitions.parameters(name, "").is_some());
        if let Some(name) = condition {
            let call = definitions.expression(&format!("{name}(s,t)"), &command.location, "");
            compiled.push(call.map_err(message)?);
        }
        let names =
            expressions.iter().map(|text| (*text).clone()).chain(condition.map(String::from)).collect();
        let program = definitions.compile(&compiled, &[]).map_err(message)?;
        Ok(Self { program, names, began: Instant::now() })
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// All values at a point; 0 where a function is out of its domain, as in Radiance.
    pub fn at(&self, s: f64, t: f64) -> Result<Vec<f64>, String> {
        if self.began.elapsed() > LONGEST {
            return Err(format!("the functions take more than {} seconds", LONGEST.as_secs()));
        }
        let point = Point { s, t };
        let mut started = self.program.start(&point);
        let value = |(root, name): (usize, &String)| match started.value(root, &[]) {
            Ok(value) => Ok(value),
            Err(Failure::Math) => Ok(0.0),
            Err(Failure::Fault(fault)) => Err(format!("\"{name}\" at s = {s}, t = {t}: {fault}")),
        };
        self.names.iter().enumerate().map(value).collect()
    }
}

/// Without the place, which is that of the command.
fn message(error: sunpeak_core::Error) -> String {
    match error {
        sunpeak_core::Error::Input { message, .. } => message,
        other => other.to_string(),
    }
}
