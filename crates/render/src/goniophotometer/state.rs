//! Finished columns in a file, to go on with later: written whole or not at all.

use super::Job;
use super::column::{Column, Counts};
use super::walk::{End, walk};
use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;
use sunpeak_bsdf::codec::{Decoder, Encoder, HASH, damaged, replace_file};
use sunpeak_core::{Error, Location, Result, Rgb, Sampler};

/// The first bytes of the file, with the version of its format.
const MAGIC: [u8; 8] = *b"spgonio1";

/// Walks that tell whether scene and options are those of before.
const PROBES: u64 = 1024;

/// Each column that is finished.
pub(super) type Finished = Vec<Option<Column>>;

/// Write what is finished.
pub(super) fn save(path: &Path, job: &Job, finished: &Finished) -> Result<()> {
    replace_file(path, |file| write(file, job, finished))
}

fn write(file: impl Write, job: &Job, finished: &Finished) -> io::Result<()> {
    let mut out = Encoder::new(file);
    out.bytes(&MAGIC)?;
    out.bytes(&fingerprint(job)?)?;
    out.count(finished.len())?;
    for column in finished {
        out.count(usize::from(column.is_some()))?;
        column.iter().try_for_each(|c| write_column(&mut out, c))?;
    }
    out.finish()?.flush()
}

fn write_column(out: &mut Encoder<impl Write>, column: &Column) -> io::Result<()> {
    out.count(column.rays as usize)?;
    out.numbers(column.through.to_array())?;
    out.numbers([column.through_error, column.lost])?;
    for counts in [&column.transmission, &column.reflection] {
        out.values(&counts.flux)?;
        out.values(&counts.error)?;
        out.numbers([counts.whole_error])?;
    }
    Ok(())
}

/// Read what an earlier run has finished.
pub(super) fn load(path: &Path, job: &Job) -> Result<Finished> {
    let file = File::open(path).map_err(|e| Error::io(path, e))?;
    let length = file.metadata().map_err(|e| Error::io(path, e))?.len();
    let wrong = |what: &str| Error::input(Location::new(&*path.to_string_lossy(), 0, 0), what);
    let mut from = Decoder::new(BufReader::new(file), length);
    let read = read(&mut from, job).and_then(|finished| from.finish().map(|()| finished));
    match read {
        Ok(Some(finished)) => Ok(finished),
        Ok(None) => Err(wrong(
            "it was made from another scene, or with other options; expected the same as before, or a run without --resume",
        )),
        Err(_) => Err(wrong("it is damaged, or no state of a goniophotometer; start again without --resume")),
    }
}

fn read(from: &mut Decoder<impl Read>, job: &Job) -> io::Result<Option<Finished>> {
    if from.array()? != MAGIC {
        return Err(damaged());
    }
    let print: [u8; HASH] = from.array()?;
    let others = print != fingerprint(job)?;
    let count = from.count(8)?;
    let mut finished = Finished::new();
    for _ in 0..count {
        finished.push(if from.count(1)? == 0 { None } else { Some(read_column(from)?) });
    }
    if others {
        return Ok(None);
    }
    let [channels, cells] = [job.channels(), job.exiting.len()];
    let fits = |c: &Counts| c.flux.len() == channels * cells && c.error.len() == cells;
    let sound = finished.iter().flatten().all(|c| fits(&c.transmission) && fits(&c.reflection));
    if sound && count == job.columns() { Ok(Some(finished)) } else { Err(damaged()) }
}

fn read_column(from: &mut Decoder<impl Read>) -> io::Result<Column> {
    let rays = u64::from_le_bytes(from.array()?);
    let through = Rgb::from_array(from.numbers()?);
    let [through_error, lost] = from.numbers()?;
    let mut counts = || -> io::Result<Counts> {
        let (flux, error) = (from.values()?, from.values()?);
        let [whole_error] = from.numbers()?;
        Ok(Counts { flux, error, whole_error })
    };
    let (transmission, reflection) = (counts()?, counts()?);
    Ok(Column { rays, through, through_error, lost, transmission, reflection })
}

/// What a run depends on, as a sum: its options, and where some walks through the scene end, to the last bit.
fn fingerprint(job: &Job) -> io::Result<[u8; HASH]> {
    let mut sum = Encoder::new(io::sink());
    sum.text(&job.choices())?;
    for index in 0..PROBES {
        let mut sampler = Sampler::new(0x5eed, 0, index);
        let direction = sunpeak_core::warp::uniform_sphere(sampler.next_2d());
        let ray = job.cell.entering(direction, sampler.next_2d());
        let (kind, direction, carried) = match walk(job.world, &job.cell, ray, &mut sampler) {
            End::Absorbed => (0.0, Default::default(), Rgb::ZERO),
            End::Straight => (1.0, Default::default(), Rgb::ZERO),
            End::Undeflected(carried) => (2.0, Default::default(), carried),
            End::Out(direction, carried) => (3.0, direction, carried),
            End::Lost(carried) => (4.0, Default::default(), carried),
        };
        sum.numbers([kind])?;
        sum.numbers(direction.to_array())?;
        sum.numbers(carried.to_array())?;
    }
    Ok(sum.sum())
}
