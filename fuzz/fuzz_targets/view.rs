//! View options: what is read is printed so that it reads back the same, and its rays are finite.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sunpeak_scene::View;

fuzz_target!(|data: &[u8]| {
    let text = String::from_utf8_lossy(data);
    // A view file could be any file.
    if text.contains("-vf") {
        return;
    }
    let Ok(view) = View::parse(&text) else { return };
    assert_eq!(View::parse(&view.to_string()).expect("what is printed reads back"), view);
    let _ = view.fit_size(640, 480);
    for [x, y] in [[0.0, 0.0], [0.5, 0.5], [0.9, 0.2], [1.0, 1.0]] {
        if let Some(ray) = view.ray(x, y) {
            let _ = view.project(ray.direction);
        }
    }
});
