//! `gensky` and `gendaylit`: the sky crate knows them.

use sunpeak_core::Result;

/// The scene text that the program would write.
pub fn run(program: &str, args: &[String]) -> Result<String> {
    match program {
        "gensky" => sunpeak_sky::command::gensky(args),
        _ => sunpeak_sky::command::gendaylit(args),
    }
}
