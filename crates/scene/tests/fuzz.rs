//! Whatever stands in a file, reading it ends, with a scene or with a message.

use proptest::prelude::*;
use sunpeak_scene::{Font, LoadOptions, Picture, Scene, View};

/// Words that get past the first checks more often than random ones.
fn word() -> impl Strategy<Value = String> {
    let known = [
        "void",
        "plastic",
        "polygon",
        "alias",
        "inherit",
        "sphere",
        "BSDF",
        "aBSDF",
        "brightfunc",
        "glow",
        "WGMDfunc",
        "brighttext",
        "source",
        "skybr",
        "skybright.cal",
        "a",
        "b",
        "0",
        "1",
        "3",
        "4",
        "5",
        "12",
        "-1",
        ".5",
        "1e308",
        "nan",
        "99999999999",
        "#",
        "'",
        "\"",
        "\n",
        "\\\n",
        "!genbox a b 1 1 1",
        "!xform",
        "!cat",
        "|",
        "-a",
        "-i",
        "-t",
        "-n",
        "-f",
        "-rz",
        "-s",
        "-b",
        "-r",
    ];
    prop_oneof![8 => prop::sample::select(known.to_vec()).prop_map(String::from), 1 => "\\PC{0,6}"]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC*") {
        let _ = Scene::parse(&text, "t.rad", &LoadOptions::default());
        let _ = View::parse(&text);
    }

    #[test]
    fn any_words_are_read_or_refused(words in prop::collection::vec(word(), 0..60)) {
        let _ = Scene::parse(&words.join(" "), "t.rad", &LoadOptions::default());
    }

    #[test]
    fn any_bytes_and_any_numbers_are_a_font_or_not(
        bytes in prop::collection::vec(any::<u8>(), 0..80), numbers in prop::collection::vec(-1i32..300, 0..40)
    ) {
        let _ = Font::parse(&bytes, "t.fnt");
        let words: Vec<_> = numbers.iter().map(i32::to_string).collect();
        let _ = Font::parse(words.join(" ").as_bytes(), "t.fnt");
    }

    #[test]
    fn any_bytes_are_a_picture_or_not(header in "[ -~]{0,20}", pixels in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut bytes = format!("#?RADIANCE\n{header}\n\n-Y 3 +X 9\n").into_bytes();
        bytes.extend(pixels);
        let _ = Picture::decode(&bytes, "t.hdr");
    }

    #[test]
    fn broken_pictures_are_refused_or_read(at in 0usize..2000, value in any::<u8>(), length in 0usize..2000) {
        let mut bytes = Picture::new(40, 9).encode().expect("bytes");
        let at = at % bytes.len();
        bytes[at] = value;
        bytes.truncate(length.max(at + 1));
        let _ = Picture::decode(&bytes, "t.hdr");
    }
}
