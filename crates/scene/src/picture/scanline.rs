//! Rows of pixels in a file: flat, in the old run-length code, in the new one (Radiance's `doc/filefmts`, "Picture").

use std::io::{self, BufRead};

/// Rows of other lengths are written flat.
const RUN_LENGTH_WIDTHS: std::ops::RangeInclusive<usize> = 8..=0x7fff;
/// Shorter runs are written as they are.
const SHORTEST_RUN: usize = 4;
/// Counts of equal bytes are written plus this.
const RUN_FLAG: u8 = 128;
const LONGEST_RUN: usize = 127;
const LONGEST_LITERAL: usize = 128;

/// Read a row of `width` pixels into `row`, in place of what is there.
pub fn read(file: &mut impl BufRead, width: usize, row: &mut Vec<[u8; 4]>) -> Result<(), String> {
    row.clear();
    match take(file)? {
        [2, 2, high, low] if high < 128 => {
            let said = usize::from(high) << 8 | usize::from(low);
            if said != width {
                return Err(format!("a row of {said} pixels, expected {width}"));
            }
            new_run_length(file, width, row)
        }
        first => old_run_length(file, first, width, row),
    }
}

fn take<const N: usize>(file: &mut impl BufRead) -> Result<[u8; N], String> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes).map_err(message)?;
    Ok(bytes)
}

fn message(error: io::Error) -> String {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => "the file ends too early".into(),
        _ => error.to_string(),
    }
}

/// The four components one after the other, each in runs and literal bytes.
fn new_run_length(file: &mut impl BufRead, width: usize, row: &mut Vec<[u8; 4]>) -> Result<(), String> {
    let mut literal = [0; RUN_FLAG as usize];
    for component in 0..4 {
        let mut at = 0;
        while at < width {
            let [code] = take(file)?;
            let run = code > RUN_FLAG;
            let count = usize::from(if run { code - RUN_FLAG } else { code });
            if at + count > width {
                return Err("a run that is longer than its row".into());
            }
            // The row grows with the data, so that a wrong width does not cost memory.
            row.resize(row.len().max(at + count), [0; 4]);
            let pixels = row[at..at + count].iter_mut();
            if run {
                let [value] = take(file)?;
                pixels.for_each(|pixel: &mut [u8; 4]| pixel[component] = value);
            } else {
                let literal = &mut literal[..count];
                file.read_exact(literal).map_err(message)?;
                pixels.zip(literal).for_each(|(pixel, value)| pixel[component] = *value);
            }
            at += count;
        }
    }
    Ok(())
}

/// Pixels; one of (1, 1, 1, n) repeats the one before n times, and the next such one 256 n times.
fn old_run_length(
    file: &mut impl BufRead,
    first: [u8; 4],
    width: usize,
    row: &mut Vec<[u8; 4]>,
) -> Result<(), String> {
    let (mut shift, mut next) = (0, Some(first));
    while row.len() < width {
        let pixel = next.take().map_or_else(|| take(file), Ok)?;
        if let [1, 1, 1, count] = pixel {
            let last = *row.last().ok_or("a row that begins with a repetition")?;
            let count = usize::from(count).checked_shl(shift).unwrap_or(usize::MAX).min(width - row.len());
            row.extend(std::iter::repeat_n(last, count));
            shift = (shift + 8).min(usize::BITS);
        } else {
            row.push(pixel);
            shift = 0;
        }
    }
    Ok(())
}

/// Append a row.
pub fn write(row: &[[u8; 4]], output: &mut Vec<u8>) {
    if !RUN_LENGTH_WIDTHS.contains(&row.len()) {
        row.iter().for_each(|pixel| output.extend_from_slice(pixel));
        return;
    }
    output.extend_from_slice(&[2, 2, (row.len() >> 8) as u8, row.len() as u8]);
    for component in 0..4 {
        let bytes: Vec<u8> = row.iter().map(|pixel| pixel[component]).collect();
        write_component(&bytes, output);
    }
}

fn write_component(bytes: &[u8], output: &mut Vec<u8>) {
    let run_at = |at: usize| bytes[at..].iter().take(LONGEST_RUN).take_while(|&&b| b == bytes[at]).count();
    let (mut literal_start, mut at) = (0, 0);
    while at < bytes.len() {
        let run = run_at(at);
        if run >= SHORTEST_RUN {
            write_literal(&bytes[literal_start..at], output);
            output.extend_from_slice(&[RUN_FLAG + run as u8, bytes[at]]);
            literal_start = at + run;
        }
        at += run;
    }
    write_literal(&bytes[literal_start..], output);
}

fn write_literal(bytes: &[u8], output: &mut Vec<u8>) {
    for chunk in bytes.chunks(LONGEST_LITERAL) {
        output.push(chunk.len() as u8);
        output.extend_from_slice(chunk);
    }
}
