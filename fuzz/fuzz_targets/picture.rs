//! Pictures: what is read can be written, and reads back with the same size.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sunpeak_scene::Picture;

fuzz_target!(|data: &[u8]| {
    let Ok(picture) = Picture::decode(data, "fuzz.hdr") else { return };
    let written = picture.encode().expect("what was read can be written");
    let again = Picture::decode(&written, "again.hdr").expect("what was written can be read");
    assert_eq!((again.width, again.height), (picture.width, picture.height));
});
