//! Pictures: what is read can be written, and reads back with the same size. Hyperspectral ones have as many values as they say.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sunpeak_scene::{Picture, SpectralPicture};

fuzz_target!(|data: &[u8]| {
    if let Ok(spectral) = SpectralPicture::decode(data, "fuzz.hsr") {
        assert_eq!(spectral.values.len(), spectral.width * spectral.height * spectral.components);
    }
    let Ok(picture) = Picture::decode(data, "fuzz.hdr") else { return };
    let written = picture.encode().expect("what was read can be written");
    let again = Picture::decode(&written, "again.hdr").expect("what was written can be read");
    assert_eq!((again.width, again.height), (picture.width, picture.height));
});
