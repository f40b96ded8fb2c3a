//! Commands that the user allowed to run in a shell.

use std::{
    path::Path,
    process::{Command, Stdio},
};

/// What a command wrote.
pub struct Output {
    /// Standard output.
    pub text: Vec<u8>,
    /// Standard error.
    pub complaint: String,
}

/// Run a line by `sh -c` in a folder, without input.
pub fn run(line: &str, cwd: &Path) -> Result<Output, String> {
    let mut command = Command::new("sh");
    command.arg("-c").arg(line).stdin(Stdio::null());
    if !cwd.as_os_str().is_empty() {
        command.current_dir(cwd);
    }
    let output = command.output().map_err(|error| format!("cannot run \"sh -c\": {error}"))?;
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    if !output.status.success() {
        let said = if complaint.is_empty() { String::new() } else { format!(": {}", complaint.trim()) };
        return Err(format!("the command \"{}\" failed ({}){said}", line.trim(), output.status));
    }
    Ok(Output { text: output.stdout, complaint })
}
