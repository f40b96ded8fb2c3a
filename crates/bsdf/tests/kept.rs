//! Long computations that are stopped go on to the same bytes.
#![allow(clippy::unwrap_used)]

use std::{
    fs,
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
    time::Duration,
};
use sunpeak_bsdf::{
    Bsdf, Conversion, Kept, Work,
    model::{Ggx, tabulate},
    synthetic::{Basis, Blind, Fabric, Goniophotometer, Woven, tabulate_exact, tabulate_watched},
    system::{Band, Curve, Layer, Pane, Panes, Shade, System},
};
use sunpeak_core::{Control, Error, Result};

/// A file that goes away.
struct Temporary(PathBuf);

impl Temporary {
    fn new(name: &str) -> Self {
        Self(std::env::temp_dir().join(format!("sunpeak-kept-{}-{name}", std::process::id())))
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

fn basis(name: &str) -> Basis {
    name.parse().unwrap()
}

/// Stop once a few units are done, keep, go on from the file: the same table as without.
fn check(name: &str, make: impl Fn(&Work) -> Result<Bsdf> + Sync) {
    let whole = make(&Work::default()).unwrap().to_xml();
    let (control, kept) = (Control::new(), Kept::new());
    let work = Work::keeping(&control, &kept, |sum| sum.text(name)).unwrap();
    let outcome = thread::scope(|scope| {
        let maker = scope.spawn(|| make(&work));
        while control.progress().0 < 2 && !maker.is_finished() {
            thread::sleep(Duration::from_micros(100));
        }
        control.stop();
        maker.join().unwrap()
    });
    assert!(matches!(outcome, Err(Error::Interrupted)), "{name}: done before it could be stopped");
    let (done, all) = control.progress();
    assert!(0 < done && done < all, "{name}: {done} of {all}");
    let file = Temporary::new(name);
    kept.save(&file.0).unwrap();
    let (control, kept) = (Control::new(), Kept::load(&file.0).unwrap());
    let other = Work::keeping(&control, &kept, |sum| sum.text("another")).unwrap_err();
    assert!(other.to_string().contains("other options"), "{other}");
    let work = Work::keeping(&control, &kept, |sum| sum.text(name)).unwrap();
    assert!(make(&work).unwrap().to_xml() == whole, "{name} is another after going on");
    assert_eq!(control.progress(), (all, all), "{name}");
}

#[test]
fn every_maker_goes_on_to_the_same_table() {
    let ggx = Ggx { index: 1.5, roughness: 0.2, transmits: false };
    check("model", |work| tabulate(&ggx, basis("klems-quarter"), work));
    let blind = Blind { width: 1.1, tilt_deg: 25.0, scattered: 0.2 };
    check("exact", |work| tabulate_exact(&blind, basis("klems-quarter"), work));
    let woven = Woven::new(Fabric::default());
    let seen_by = Goniophotometer { value_noise: 0.3, seed: 5, ..Default::default() };
    check("seen", |work| tabulate_watched(&woven, basis("klems-half"), &seen_by, work));
    let isotropic = Fabric::default().tabulate(basis("t3-256")).unwrap();
    let into = |name: &str| Conversion { basis: Some(basis(name)), ..Default::default() };
    check("sliced", |work| isotropic.convert_watched(&into("t4-256"), work));
    let matrix = Fabric::default().tabulate(basis("klems-half")).unwrap();
    let turned = Conversion { rotate_deg: 20.0, keep_peak: true, ..into("klems-half") };
    check("turned", |work| matrix.convert_watched(&turned, work));
    let pane = Pane {
        wavelengths_um: vec![0.3, 2.5],
        transmittance: vec![0.8; 2],
        reflectance: [vec![0.1; 2], vec![0.1; 2]],
        curve: Curve::Fresnel,
    };
    let shade = Shade { visible: Arc::new(isotropic), solar: None, flipped: false };
    let system = System::new("s".into(), vec![Layer::Pane(pane), Layer::Shade(shade)]).unwrap();
    check("system", |work| system.tabulate(basis("t3-256"), Band::Visible, Panes::Mean, work));
}

#[test]
fn what_is_finished_is_not_made_again() {
    let (control, kept, made) = (Control::new(), Kept::new(), AtomicUsize::new(0));
    let column = |number: usize| {
        if made.fetch_add(1, Ordering::Relaxed) == 3 {
            control.stop();
        }
        vec![number as f32]
    };
    let work = Work::keeping(&control, &kept, |sum| sum.text("one")).unwrap();
    assert!(work.columns("part", 10_000, column).is_err());
    let before = made.load(Ordering::Relaxed);
    let again = Control::new();
    let work = Work::keeping(&again, &kept, |sum| sum.text("one")).unwrap();
    let values = work.columns("part", 10_000, column).unwrap();
    assert_eq!(made.load(Ordering::Relaxed), 10_000);
    assert!(before < 10_000);
    assert!(values.iter().enumerate().all(|(number, value)| value == &[number as f32]));
}

#[test]
fn files_of_something_else_are_refused() {
    let file = Temporary::new("damaged");
    assert!(matches!(Kept::load(&file.0), Err(Error::Io { .. })));
    fs::write(&file.0, b"spwork01 and then something else").unwrap();
    let error = Kept::load(&file.0).unwrap_err().to_string();
    assert!(error.contains("damaged") && error.contains("--resume"), "{error}");
}
