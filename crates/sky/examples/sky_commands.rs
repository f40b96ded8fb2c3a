//! Runs `gensky …` and `gendaylit …` lines from standard input, and prints what they give, each followed by a line `---`.
//!
//! ```sh
//! echo 'gendaylit 6 21 12 -W 800 100' | cargo run -p sunpeak-sky --example sky_commands
//! ```

use std::io::{BufRead, stdin};
use sunpeak_sky::command::{gendaylit, gensky};

fn main() -> std::io::Result<()> {
    for line in stdin().lock().lines() {
        let words: Vec<String> = line?.split_whitespace().map(str::to_owned).collect();
        let result = match words.split_first() {
            Some((program, args)) if program == "gensky" => gensky(args),
            Some((program, args)) if program == "gendaylit" => gendaylit(args),
            _ => continue,
        };
        match result {
            Ok(text) => println!("{text}---"),
            Err(error) => println!("error: {error}\n---"),
        }
    }
    Ok(())
}
