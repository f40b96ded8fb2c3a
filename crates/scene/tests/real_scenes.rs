//! Scenes, views and pictures that others made.

use std::path::{Path, PathBuf};
use sunpeak_scene::{LoadOptions, Picture, Scene, View};

/// The folder of real files, if it is there.
fn real(folder: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let shared = std::env::var_os("SUNPEAK_SHARED").map_or(beside, PathBuf::from);
    let path = shared.join("data").join(folder);
    if path.is_dir() {
        return Some(path);
    }
    eprintln!("skipped: no real files in {} (set SUNPEAK_SHARED)", path.display());
    None
}

fn load(folder: &Path, files: &[&str]) -> Result<Scene, String> {
    let options = LoadOptions { cwd: Some(folder.to_path_buf()), ..LoadOptions::default() };
    let files: Vec<PathBuf> = files.iter().map(PathBuf::from).collect();
    Scene::load(&files, &options).map_err(|error| error.to_string())
}

fn surfaces(folder: &Path, files: &[&str]) -> usize {
    load(folder, files).expect("a scene").surfaces.len()
}

#[test]
fn rooms_load_whole() {
    let Some(scenes) = real("scenes") else { return };
    let frads = scenes.join("frads-room");
    let parts = ["materials.mat", "walls.rad", "ceiling.rad", "floor.rad", "windowframe.rad", "extwalls.rad"];
    let mut files: Vec<String> =
        parts.iter().chain(&["ground.rad", "desks.rad"]).map(|f| format!("Objects/{f}")).collect();
    files.push("Resources/ec60.rad".into());
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    // As many surfaces as `xform` prints.
    assert_eq!(surfaces(&frads, &files), 61 + 1 + 1 + 168 + 58 + 1 + 5840 + 1);

    let tutorial = scenes.join("tutorial-room");
    let with = |part: &str| surfaces(&tutorial, &["materials.rad", "room.rad", part]);
    assert_eq!(with("objects/Glazing.rad"), 18 + 1);
    assert_eq!(with("overhang/aluminiumGrate.rad"), 18 + 272);
    assert_eq!(with("blinds/blinds.rad"), 18 + 311);
    assert_eq!(surfaces(&tutorial, &["blinds/blindsOnly.rad"]), 307);
    let proxy =
        load(&tutorial, &["materials.rad", "room.rad", "blinds/blindsWithProxy.rad"]).expect_err("no XML");
    assert!(proxy.contains("blindsT4c.xml") && proxy.contains("looked for"), "{proxy}");

    let cornell = scenes.join("cornell-box");
    assert_eq!((surfaces(&cornell, &["cornell.rad"]), surfaces(&cornell, &["cornell_window.rad"])), (8, 11));
}

/// One small scene for nearly each material: what we can render loads, the rest is refused by name.
#[test]
fn scenes_load_or_say_what_is_missing() {
    let Some(scenes) = real("scenes/radiance-renders") else { return };
    let loadable = [
        "antimatter_portal",
        "ball_in_cube",
        "bubble_in_cube",
        "closed_end",
        "constellation",
        "dielectric_pane",
        "diorama_walls",
        "dummysky",
        "front_cap",
        "glass_pane",
        "glowbulb",
        "illum_glass",
        "illum_trans2",
        "mirror",
        "gymbal",
        "gymbal2",
        "mist",
        "prism1",
        "prism2",
        "ringlight",
        "prism1",
        "spotcones",
        "spotlights",
        "torus",
        "trans_pane",
    ];
    for name in loadable {
        load(&scenes, &["basic.mat", "chrome.mat", "gold.mat", &format!("{name}.rad")]).expect(name);
    }
    for (name, missing) in [
        ("ballcompare", "font file: cannot find the file \"helvet.fnt\""),
        ("blinds", "the command \"pkgBSDF\" is not run"),
        ("glass_ill", "illum.cal"),
        ("porsches", "cannot find the file \"porsche.octf\""),
        ("rect_fixture", "source.cal"),
        ("sunset_sky", "sunset.hdr"),
        ("woman", "cannot find the file \"woman.rtm\""),
    ] {
        let message = load(&scenes, &["basic.mat", "chrome.mat", &format!("{name}.rad")]).expect_err(name);
        assert!(message.contains(missing), "{name}: {message}");
    }
}

#[test]
fn view_files_are_read() {
    let Some(scenes) = real("scenes") else { return };
    let mut count = 0;
    for folder in ["cornell-box", "frads-room/Resources", "tutorial-room/views", "radiance-renders"] {
        for entry in std::fs::read_dir(scenes.join(folder)).expect("a folder").flatten() {
            if entry.path().extension().is_some_and(|ext| ext == "vf") {
                View::load(&entry.path()).expect("a view");
                count += 1;
            }
        }
    }
    assert_eq!(count, 24);
    let fish = View::load(&scenes.join("radiance-renders/fish.vf")).expect("a view");
    assert_eq!((fish.horizontal_deg, fish.vertical_deg, fish.position.x), (180.0, 175.0, -5.56568));
}

#[test]
fn pictures_are_read() {
    let Some(pictures) = real("hdr") else { return };
    let two = Picture::load(&pictures.join("two-exposures.hdr")).expect("a picture");
    assert_eq!((two.width, two.height), (544, 544));
    assert_eq!(two.view.map(|v| v.horizontal_deg), Some(180.0));
    // As `pvalue -o` prints: the pixel in the middle, both exposures undone.
    let middle = two.pixels[272 * 544 + 272];
    let expected = [1.627, 0.6815, 0.4114];
    assert!(middle.iter().zip(expected).all(|(a, b)| (a / b - 1.0).abs() < 1e-3), "{middle:?}");
}
