//! Large files: read as a stream, refused before they fill the memory, and read once.
#![allow(clippy::unwrap_used)]

mod common;

use common::{directions, fabrics, one_sided, random, shared_files};
use std::{
    fs,
    io::{self, BufReader, Read},
    path::{Path, PathBuf},
};
use sunpeak_bsdf::{Bsdf, Cache, Mode, PeakRule, xml};
use sunpeak_core::{Vec3, luminance};

/// A folder that goes with its owner.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("sunpeak-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn cache(&self) -> Cache {
        Cache::at(self.0.join("cache")).with_limits(0, u64::MAX)
    }

    fn kept(&self) -> Vec<PathBuf> {
        let Ok(entries) = fs::read_dir(self.0.join("cache/bsdf")) else { return Vec::new() };
        entries.map(|e| e.unwrap().path()).collect()
    }

    fn file(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, text).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Tables, colours and splits are the same to the last bit.
fn assert_same(a: &Bsdf, b: &Bsdf, name: &str) {
    assert_eq!((&a.name, &a.manufacturer, &a.structure), (&b.name, &b.manufacturer, &b.structure));
    assert_eq!(a.warnings, b.warnings);
    for w_in in [Vec3::Z, -Vec3::Z] {
        for mode in [Mode::Reflection, Mode::Transmission] {
            let (x, y) = match (a.distribution(w_in, mode), b.distribution(w_in, mode)) {
                (Some(x), Some(y)) => (x, y),
                (x, y) => {
                    assert!(x.is_none() && y.is_none(), "{name}");
                    continue;
                }
            };
            assert_eq!(x.reversed, y.reversed);
            let (x, y) = (&x.distribution, &y.distribution);
            assert!(x.luminous() == y.luminous() && x.color() == y.color(), "{name}: {mode:?}");
            assert!(x.split().columns().eq(y.split().columns()), "{name}");
            for column in 0..x.columns().len() {
                assert!(x.split().overlay(column).eq(y.split().overlay(column)), "{name}: {column}");
            }
        }
    }
    for w_in in directions(50, true).into_iter().chain(directions(50, false)) {
        assert_eq!(a.through(w_in, PeakRule::Split), b.through(w_in, PeakRule::Split), "{name}");
        let u = [0.3, 0.6, 0.8];
        let [x, y] = [a, b].map(|bsdf| bsdf.sample_smooth(w_in, u, PeakRule::Split));
        assert_eq!(x, y, "{name}");
    }
}

/// Files of each kind: gray and coloured, matrices and trees, regular and mixed, with one side and with two.
fn files(folder: &Folder) -> Vec<PathBuf> {
    let own = fabrics().into_iter().chain(one_sided());
    let own = own.map(|(name, bsdf)| folder.file(&format!("{name}.xml"), &bsdf.to_xml()));
    own.chain(shared_files().into_iter().filter(|f| Bsdf::load_with(f, None).is_ok())).collect()
}

#[test]
fn what_comes_from_the_cache_is_the_same() {
    let folder = Folder::new("same");
    for file in files(&folder) {
        let name = file.display().to_string();
        let whole = Bsdf::load_with(&file, None).unwrap();
        assert_same(&whole, &Bsdf::load_with(&file, Some(&folder.cache())).unwrap(), &name);
        let [kept] = folder.kept().try_into().unwrap();
        let stamp = |path: &Path| fs::metadata(path).unwrap().modified().unwrap();
        let long_ago = std::time::SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000);
        fs::File::open(&kept).unwrap().set_modified(long_ago).unwrap();
        let bytes = fs::read(&kept).unwrap();
        assert_same(&whole, &Bsdf::load_with(&file, Some(&folder.cache())).unwrap(), &name);
        assert!(stamp(&kept) > long_ago && fs::read(&kept).unwrap() == bytes, "{name}: was not used");
        fs::remove_file(kept).unwrap();
    }
}

/// A file in the cache that could not be read is written anew: then its new time is the only thing that tells.
#[test]
fn a_damaged_cache_file_is_passed_over_and_written_anew() {
    let folder = Folder::new("damaged");
    let (_, fabric) = fabrics().swap_remove(3);
    let file = folder.file("fabric.xml", &fabric.to_xml());
    let whole = Bsdf::load_with(&file, Some(&folder.cache())).unwrap();
    let [kept] = folder.kept().try_into().unwrap();
    let good = fs::read(&kept).unwrap();
    let check = |bytes: &[u8], what: &str| {
        fs::write(&kept, bytes).unwrap();
        assert_same(&whole, &Bsdf::load_with(&file, Some(&folder.cache())).unwrap(), what);
        assert_eq!(folder.kept(), std::slice::from_ref(&kept), "{what}");
        assert!(fs::read(&kept).unwrap() == good, "{what}: was not written anew");
    };
    for i in 0..30 {
        let at = (random(i) * good.len() as f64) as usize;
        let mut bad = good.clone();
        bad[at] ^= 1 << (i % 8);
        check(&bad, &format!("bit {} of byte {at}", i % 8));
        check(&good[..at], &format!("cut at {at}"));
    }
    check(&[], "nothing");
    check(&[good.as_slice(), b"more"].concat(), "more");
}

/// Not even a right sum makes the reader trust what it reads.
#[test]
fn a_forged_cache_file_leads_nowhere_astray() {
    let folder = Folder::new("forged");
    let small = fabrics().into_iter().skip(2).take(2);
    for (name, bsdf) in small.chain(one_sided().into_iter().skip(1)) {
        let file = folder.file("forged.xml", &bsdf.to_xml());
        Bsdf::load_with(&file, Some(&folder.cache())).unwrap();
        let [kept] = folder.kept().try_into().unwrap();
        let good = fs::read(&kept).unwrap();
        let end = good.len() - 32;
        for i in 0..60 {
            let mut bad = good.clone();
            // Lengths and nodes stand at the beginning, splits at the end.
            let at = match i % 3 {
                0 => 40 + (random(i) * 600.0) as usize,
                1 => end - 1 - (random(i) * 600.0) as usize,
                _ => 40 + (random(i) * (end - 41) as f64) as usize,
            };
            bad[at.min(end - 1)] = (random(i + 1000) * 256.0) as u8;
            let sum = blake3::hash(&bad[..end]);
            bad[end..].copy_from_slice(sum.as_bytes());
            fs::write(&kept, &bad).unwrap();
            let Ok(read) = Bsdf::load_with(&file, Some(&folder.cache())) else { panic!("{name}") };
            for w_in in directions(8, true).into_iter().chain(directions(8, false)) {
                read.through(w_in, PeakRule::Split);
                read.sample_smooth(w_in, [0.5; 3], PeakRule::Split);
                directions(8, true).iter().for_each(|&w| _ = read.evaluate_smooth(w_in, w, PeakRule::Split));
            }
        }
        fs::remove_file(kept).unwrap();
    }
}

#[test]
fn the_cache_keeps_what_pays_and_no_more_than_it_may() {
    let folder = Folder::new("room");
    let (_, small) = fabrics().swap_remove(2);
    let text = small.to_xml();
    let file = |i: usize| folder.file(&format!("{i}.xml"), &text.replace("</Name>", &format!("{i}</Name>")));
    let load = |file: &Path, least: u64, largest: u64| {
        let cache = Cache::at(folder.0.join("cache")).with_limits(least, largest);
        Bsdf::load_with(file, Some(&cache)).unwrap()
    };
    load(&file(0), 1 << 30, u64::MAX);
    assert!(folder.kept().is_empty(), "smaller than what pays");
    load(&file(1), 0, u64::MAX);
    let [first] = folder.kept().try_into().unwrap();
    let size = fs::metadata(&first).unwrap().len();
    for i in 2..5 {
        load(&file(i), 0, 2 * size + 1000);
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert_eq!(folder.kept().len(), 2);
    assert!(!folder.kept().contains(&first), "the oldest goes first");
    // A folder that cannot be made is no cache, and no error.
    let blocked = Cache::at(file(9)).with_limits(0, u64::MAX);
    Bsdf::load_with(&file(1), Some(&blocked)).unwrap();
}

#[test]
fn a_stream_in_pieces_gives_the_same_as_the_whole_text() {
    for (name, bsdf) in fabrics().into_iter().take(5) {
        let text = bsdf.to_xml();
        let whole = Bsdf::parse("x.xml", text.as_bytes()).unwrap();
        for capacity in [1, 2, 3, 7, 64, 4099] {
            let document = xml::read("x.xml", BufReader::with_capacity(capacity, text.as_bytes())).unwrap();
            for (block, direction) in document.blocks.iter().zip(["Transmission Front", "Transmission Back"])
            {
                let w_in = if direction.ends_with("Front") { -Vec3::Z } else { Vec3::Z };
                let d = &whole.distribution(w_in, Mode::Transmission).unwrap().distribution;
                assert_eq!(block.direction, direction);
                assert!(block.table == *d.luminous(), "{name} in pieces of {capacity}");
            }
        }
    }
}

/// The same bytes for ever.
struct Endless(&'static [u8], usize);

impl Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        for byte in buffer.iter_mut() {
            *byte = self.0[self.1];
            self.1 = (self.1 + 1) % self.0.len();
        }
        Ok(buffer.len())
    }
}

/// What is said of a text that goes on with 2 GB of the same.
fn said_of_endless(start: &str, more: &'static [u8]) -> String {
    let reader = BufReader::with_capacity(1 << 16, start.as_bytes().chain(Endless(more, 0)).take(2 << 30));
    xml::read("x.xml", reader).unwrap_err().to_string()
}

/// Largest memory so far [bytes], where the system tells.
fn largest_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM"))?;
    Some(1024 * line.split_whitespace().nth(1)?.parse::<u64>().ok()?)
}

fn start(structure: &str, rest: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?><WindowElement><Optical><Layer><DataDefinition><IncidentDataStructure>{structure}\
         </IncidentDataStructure></DataDefinition>{rest}"
    )
}

const DATA: &str = "<WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock>\
                    <WavelengthDataDirection>Transmission Front</WavelengthDataDirection>\
                    <AngleBasis>LBNL/Shirley-Chiu</AngleBasis><ScatteringData>";

#[test]
fn gigabytes_of_nothing_are_refused_before_they_fill_the_memory() {
    let before = largest_memory();
    let tree = start("TensorTree4", DATA);
    let layer = start("Columns", "");
    for (text, more, message) in [
        (tree.clone(), &b"{"[..], "more than 8 levels deep"),
        (start("TensorTree3", DATA), b"{ ", "more than 12 levels deep"),
        (tree.clone(), b"}", "found '}'"),
        (tree.clone() + "{", b"1", "characters in a number"),
        (tree.clone() + "{{", b"1}{2}{", "more than 16 children"),
        (tree.clone() + "<!--", b"x", "more than 16777216 bytes"),
        (tree.clone() + "<", b"x", "more than 16777216 bytes"),
        (tree.clone() + "<![CDATA[", b"{ ", "more than 16777216 bytes"),
        (tree + "{1}</ScatteringData", b" ", "more than 16777216 bytes"),
        (layer.clone(), b"<a>", "nested more than 64 deep"),
        (layer.clone() + "<Material><Name>", b"x", "a word of more than 16777216 bytes"),
        (layer, b"<!DOCTYPE a [<!ENTITY b \"bbbbbbbbbbbb\">", "more than 16777216 bytes"),
        (String::new(), b" <", "not a BSDF file"),
    ] {
        let said = said_of_endless(&text, more);
        assert!(said.starts_with("x.xml:") && said.contains(message), "{said}; expected {message}");
    }
    if let (Some(before), Some(after)) = (before, largest_memory()) {
        // 16 MB of a word in a buffer that doubles, and what other tests need meanwhile.
        assert!(after - before < 400 << 20, "{} MB", (after - before) >> 20);
    }
}

#[test]
fn entities_are_not_expanded() {
    let laughs = "<?xml version=\"1.0\"?><!DOCTYPE lolz [<!ENTITY lol \"lol\"><!ENTITY lol1 \"&lol;&lol;&lol;\">]>\
                  <WindowElement>&lol1;</WindowElement>";
    let said = Bsdf::parse("x.xml", laughs.as_bytes()).unwrap_err().to_string();
    assert!(said.starts_with("x.xml:1:22:") && said.contains("document type"), "{said}");
}

#[test]
fn wrong_numbers_are_refused_where_they_stand() {
    let full = |data: &str| {
        start("TensorTree3", DATA)
            + data
            + "</ScatteringData></WavelengthDataBlock></WavelengthData></Layer></Optical></WindowElement>"
    };
    assert!(Bsdf::parse("x.xml", full("{1}").as_bytes()).is_ok());
    for (data, place, message) in [
        ("\n{1 1 1 1\n 1 1 1 -1}", "x.xml:3:8:", "value -1"),
        ("\n{ NaN }", "x.xml:2:3:", "value NaN"),
        ("\n{ inf }", "x.xml:2:3:", "value inf"),
        ("\n{1e39}", "x.xml:2:2:", "value 1e39"),
        ("\n{0x10}", "x.xml:2:2:", "'0x10' is not a number"),
        ("\n{1 2 3}", "x.xml:2:7:", "3 values; expected a power of 8"),
        ("\n{{1}{2}}", "x.xml:2:8:", "2 children; expected 8"),
        ("\n{1} 2 ", "x.xml:2:5:", "follows the end"),
        ("\n{{1}", "x.xml:2:5:", "ends too early"),
        ("", "x.xml:1:", "ends too early; expected '{'"),
    ] {
        let said = Bsdf::parse("x.xml", full(data).as_bytes()).unwrap_err().to_string();
        assert!(said.starts_with(place) && said.contains(message), "{said}; expected {place} {message}");
    }
}

#[test]
fn bases_of_absurd_size_are_refused() {
    for (count, message) in [
        ("1000000000", "nPhis is 1000000000; expected a whole number from 1 to 16384"),
        ("-3", "nPhis is -3"),
        ("8.5", "nPhis is 8.5"),
        ("0", "nPhis is 0"),
        ("1e999", "is not a number"),
        ("16384", "more than 16384 patches"),
    ] {
        let ring = |upper: u32| {
            format!(
                "<AngleBasisBlock><nPhis>{count}</nPhis><ThetaBounds><UpperTheta>{upper}</UpperTheta></ThetaBounds>\
                 </AngleBasisBlock>"
            )
        };
        let basis = format!(
            "<DataDefinition><AngleBasis><AngleBasisName>own</AngleBasisName>{}{}",
            ring(10),
            ring(90)
        );
        let text = start("Columns", &basis);
        let said = Bsdf::parse("x.xml", text.as_bytes()).unwrap_err().to_string();
        assert!(said.contains(message), "{said}; expected {message}");
    }
}

#[test]
fn a_file_that_is_cut_is_refused_wherever_it_is_cut() {
    for (_, bsdf) in fabrics().into_iter().take(4) {
        let text = bsdf.to_xml();
        for i in 0..40 {
            let cut = (random(i) * (text.len() - 20) as f64) as usize;
            let said = Bsdf::parse("x.xml", &text.as_bytes()[..cut]).unwrap_err().to_string();
            assert!(said.starts_with("x.xml:"), "{said}");
        }
    }
}

#[test]
fn a_table_that_was_read_scatters_what_it_should() {
    // The sum over a column's cells is what its samples are drawn from: in files of one million values too.
    let fabric = sunpeak_bsdf::synthetic::Fabric::default();
    let bsdf = fabric.tabulate("t4-1024".parse().unwrap()).unwrap();
    for w_in in directions(10, true) {
        let whole = luminance(bsdf.hemispherical_smooth(w_in, Mode::Transmission, PeakRule::Off));
        let rest = luminance(bsdf.hemispherical_smooth(w_in, Mode::Transmission, PeakRule::Split));
        let theta = w_in.z.acos();
        assert!((rest - fabric.scattered).abs() < 0.01 * fabric.scattered, "{rest}");
        if theta < 0.8 {
            assert!((whole - rest - fabric.through(theta)).abs() < 0.05 * fabric.openness, "{whole} {rest}");
        }
    }
}
