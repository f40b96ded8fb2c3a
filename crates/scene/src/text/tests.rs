use super::*;

/// A box that fills its left half, a space, and a narrow bar in the middle.
const FONT: &[u8] =
    b"# left half\n97 4 0 0 128 0 128 255 0 255\n32 0 # space\n98 4 120 0 140 0 140 255 120 255\n";

fn text(line: &str, spacing: Option<f64>) -> Text {
    let font = Arc::new(Font::parse(FONT, "f.fnt").expect("a font"));
    let frame = TextFrame { origin: Vec3::ZERO, right: Vec3::X, down: -Vec3::Y };
    Text::new(vec![line.into(), "a".into()], font, frame, spacing).expect("a plane")
}

fn ink(text: &Text, x: f64, y: f64) -> bool {
    text.contains(Vec3::new(x, y, 7.0))
}

#[test]
fn characters_have_boxes_of_their_own() {
    let text = text("a ?ba", None);
    // The font has no question mark: it takes no place.
    for (x, expected) in
        [(0.25, true), (0.75, false), (1.25, false), (2.5, true), (2.25, false), (3.25, true)]
    {
        assert_eq!(ink(&text, x, -0.5), expected, "{x}");
    }
    assert!(ink(&text, 0.25, -1.5) && !ink(&text, 2.5, -1.5), "the second line");
    for outside in [(-0.1, -0.5), (0.25, 0.1), (0.25, -2.1), (4.25, -0.5), (f64::NAN, -0.5)] {
        assert!(!ink(&text, outside.0, outside.1), "{outside:?}");
    }
}

#[test]
fn tight_text_keeps_the_distance_between_extents() {
    // Extents 128 and 20 wide, so 74 on average; 51 between them and before the first, of which whole halves of 25 count.
    let text = text("ab", Some(-0.2));
    let unit = 1.0 / (74.0 + 51.0);
    let edges = [
        (49, false),
        (51, true),
        (177, true),
        (179, false),
        (227, false),
        (229, true),
        (247, true),
        (249, false),
    ];
    for (at, expected) in edges {
        assert_eq!(ink(&text, f64::from(at) * unit, -0.5), expected, "{at}");
    }
}

#[test]
fn columns_start_where_mean_characters_would_end() {
    let font = Font::parse(FONT, "f.fnt").expect("a font");
    let line = Line::new(b"ab    a", &font, Spacing::new(0.2));
    // Six characters of 74 + 51 up to the indent, after the first half distance.
    assert_eq!(line.starts[6] - line.starts[0], 6 * 125);
    assert_eq!(line.width, line.starts[0] + 7 * 125);
}

#[test]
fn what_is_no_font_is_refused() {
    for (bytes, expected) in [
        (&b"x"[..], "f.fnt:1:1: expected the code of a character"),
        (b"65\n-1", "f.fnt:2:1: expected a number of vertices"),
        (b"300 0", "f.fnt:1:1: expected the code"),
        (b"65 32001", "f.fnt:1:1: expected a number of vertices, 0 to 32000"),
        (b"65 1 256 0", "expected a coordinate, 0 to 255, found \"256\""),
        (b"65 30000 1", "f.fnt:1:1: the font ends within character 65"),
        (b"\xff\xfe", "expected the code"),
    ] {
        let error = Font::parse(bytes, "f.fnt").expect_err("no font").to_string();
        assert!(error.contains(expected), "{error}");
    }
    assert!(Font::parse(b"", "f.fnt").is_ok());
}
