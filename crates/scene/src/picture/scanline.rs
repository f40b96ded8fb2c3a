//! Rows of pixels in a file: flat, in the old run-length code, in the new one (Radiance's `doc/filefmts`, "Picture").

/// Rows of other lengths are written flat.
const RUN_LENGTH_WIDTHS: std::ops::RangeInclusive<usize> = 8..=0x7fff;
/// Shorter runs are written as they are.
const SHORTEST_RUN: usize = 4;
/// Counts of equal bytes are written plus this.
const RUN_FLAG: u8 = 128;
const LONGEST_RUN: usize = 127;
const LONGEST_LITERAL: usize = 128;

/// Read a row of `width` pixels from the front of `bytes`.
pub fn read(bytes: &mut &[u8], width: usize) -> Result<Vec<[u8; 4]>, String> {
    match **bytes {
        [2, 2, high, low, ..] if high < 128 => {
            let said = usize::from(high) << 8 | usize::from(low);
            if said != width {
                return Err(format!("a row of {said} pixels, expected {width}"));
            }
            *bytes = &bytes[4..];
            new_run_length(bytes, width)
        }
        _ => old_run_length(bytes, width),
    }
}

const CUT_SHORT: &str = "the file ends too early";

fn take<const N: usize>(bytes: &mut &[u8]) -> Result<[u8; N], String> {
    let (front, rest) = bytes.split_first_chunk::<N>().ok_or(CUT_SHORT)?;
    *bytes = rest;
    Ok(*front)
}

/// The four components one after the other, each in runs and literal bytes.
fn new_run_length(bytes: &mut &[u8], width: usize) -> Result<Vec<[u8; 4]>, String> {
    let mut row = Vec::new();
    for component in 0..4 {
        let mut at = 0;
        while at < width {
            let [code] = take(bytes)?;
            let run = code > RUN_FLAG;
            let count = usize::from(if run { code - RUN_FLAG } else { code });
            if at + count > width {
                return Err("a run that is longer than its row".into());
            }
            // The row grows with the data, so that a wrong width does not cost memory.
            row.resize(row.len().max(at + count), [0; 4]);
            if run {
                let [value] = take(bytes)?;
                row[at..at + count].iter_mut().for_each(|pixel: &mut [u8; 4]| pixel[component] = value);
            } else {
                let literal = bytes.get(..count).ok_or(CUT_SHORT)?;
                row[at..at + count]
                    .iter_mut()
                    .zip(literal)
                    .for_each(|(pixel, &value)| pixel[component] = value);
                *bytes = &bytes[count..];
            }
            at += count;
        }
    }
    Ok(row)
}

/// Pixels; one of (1, 1, 1, n) repeats the one before n times, and the next such one 256 n times.
fn old_run_length(bytes: &mut &[u8], width: usize) -> Result<Vec<[u8; 4]>, String> {
    let mut row: Vec<[u8; 4]> = Vec::new();
    let mut shift = 0;
    while row.len() < width {
        let pixel = take::<4>(bytes)?;
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
    Ok(row)
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
