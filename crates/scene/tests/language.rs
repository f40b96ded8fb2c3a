//! What scene texts mean, and what is said about wrong ones.

use sunpeak_core::Vec3;
use sunpeak_scene::{LoadOptions, Material, ModifierKind, Orientation, Pattern, Scene, Shape, Thickness};
use sunpeak_sky::{CieSky, SkyDistribution};

fn scene(text: &str) -> Scene {
    Scene::parse(text, "t.rad", &LoadOptions::default()).expect(text)
}

fn message(text: &str) -> String {
    Scene::parse(text, "t.rad", &LoadOptions::default()).expect_err(text).to_string()
}

const WHITE: &str = "void plastic white 0 0 5 .8 .8 .8 0 0\n";
const BLACK: &str = "void plastic black 0 0 5 0 0 0 0 0\n";

fn material(scene: &Scene, index: usize) -> &Material {
    match &scene.modifiers[index].kind {
        ModifierKind::Material(material) => material,
        other => panic!("no material: {other:?}"),
    }
}

#[test]
fn materials_have_the_arguments_of_the_manual() {
    let read = scene(
        "void trans t 0 0 7 .1 .2 .3 .04 .05 .6 .7 void glass g 0 0 3 .9 .8 .7 void glass h 0 0 4 .9 .8 .7 1.6
         void dielectric d 0 0 5 .9 .8 .7 1.5 2 void glow w 0 0 4 1 2 3 -1 void spotlight s 0 0 7 1 2 3 40 0 0 -2
         void metal2 m 6 0 1 0 . -s 2 0 6 1 1 1 .9 .1 .3 void ashik2 a 4 1 0 0 . 0 8 .1 .2 .3 .4 .5 .6 7 80
         void mist f 1 sun 0 3 1 2 3 void antimatter n 2 void t 0 0",
    );
    let expected = [
        "Trans { ward: Ward { color: DVec3(0.1, 0.2, 0.3), specularity: 0.04, roughness: 0.05, anisotropy: None }, \
         transmissivity: 0.6, specular_transmission: 0.7 }",
        "Glass { transmissivity: DVec3(0.9, 0.8, 0.7), index: 1.52 }",
        "Glass { transmissivity: DVec3(0.9, 0.8, 0.7), index: 1.6 }",
        "Dielectric { transmission: DVec3(0.9, 0.8, 0.7), index: 1.5, hartmann: 2.0 }",
        "Glow { radiance: DVec3(1.0, 2.0, 3.0), max_radius: -1.0 }",
        "Spotlight { radiance: DVec3(1.0, 2.0, 3.0), angle_deg: 40.0, axis: DVec3(0.0, 0.0, -2.0) }",
        "Metal(Ward { color: DVec3(1.0, 1.0, 1.0), specularity: 0.9, roughness: 0.1, anisotropy: Some(Anisotropy { \
         orientation: Fixed(DVec3(0.0, 2.0, 0.0)), roughness: 0.3 }) })",
        "Ashikhmin { diffuse: DVec3(0.1, 0.2, 0.3), specular: DVec3(0.4, 0.5, 0.6), powers: [7.0, 80.0], orientation: \
         Fixed(DVec3(1.0, 0.0, 0.0)) }",
        "Mist { sources: [\"sun\"], extinction: DVec3(1.0, 2.0, 3.0), albedo: DVec3(0.0, 0.0, 0.0), eccentricity: 0.0 }",
        "Antimatter { clipped: [ModifierId(0)], face: None }",
    ];
    for (i, expected) in expected.iter().enumerate() {
        assert_eq!(&format!("{:?}", material(&read, i)), expected);
    }
}

#[test]
fn the_last_definition_above_counts() {
    let read = scene(&format!(
        "{WHITE}white sphere a 0 0 4 0 0 0 1\nvoid metal white 0 0 5 1 1 1 1 0\nwhite sphere b 0 0 4 0 0 0 1"
    ));
    let of = |i: usize| read.surfaces[i].modifier.map(|id| id.0);
    assert_eq!((of(0), of(1)), (Some(0), Some(1)));
}

#[test]
fn aliases_take_type_and_arguments_and_their_own_modifier() {
    let sky = "void brightfunc sky 2 skybr skybright.cal 0 7 1 2 3 4 0 0 1\nvoid glow base 0 0 4 1 1 1 0\n";
    let read = scene(&format!(
        "{sky}sky alias patterned base\ninherit alias same patterned\nvoid alias bare patterned\nbase alias pattern sky\n"
    ));
    let parents: Vec<_> = read.modifiers.iter().map(|m| m.parent.map(|id| id.0)).collect();
    assert_eq!(parents, [None, None, Some(0), Some(0), None, Some(1)]);
    assert!(matches!(material(&read, 4), Material::Glow { .. }));
    assert!(matches!(read.modifiers[5].kind, ModifierKind::Pattern(_)));
}

#[test]
fn alternates_are_looked_up() {
    let read = scene(&format!(
        "{WHITE}void illum a 1 white 0 3 1 1 1\nvoid illum b 1 void 0 3 1 1 1\nvoid illum c 0 0 3 1 1 1\n\
         void mirror d 0 0 3 1 1 1\nvoid mirror e 1 void 0 3 1 1 1\nvoid mirror f 1 white 0 3 1 1 1"
    ));
    let alternate = |i: usize| match material(&read, i) {
        Material::Illum { alternate, .. } | Material::Mirror { alternate, .. } => {
            alternate.map(|m| m.map(|id| id.0))
        }
        other => panic!("{other:?}"),
    };
    let expected = [Some(Some(0)), Some(None), Some(None), None, Some(None), Some(Some(0))];
    assert_eq!((1..7).map(alternate).collect::<Vec<_>>(), expected);
}

#[test]
fn skies_turn_with_their_transform() {
    let text = "!echo x";
    assert!(message(text).contains("the command \"echo\" is not run"));
    let perez =
        "void brightfunc s 7 skybright /lib/perezlum.cal -rz 90 -s 2 -mx 0 10 1 2 3 4 5 6 7 .6 0 .8\n";
    let read = scene(perez);
    let ModifierKind::Pattern(Pattern::Sky(SkyDistribution::Perez { coefficients, sun, .. })) =
        read.modifiers[0].kind
    else {
        panic!("{:?}", read.modifiers)
    };
    assert_eq!(coefficients, [3.0, 4.0, 5.0, 6.0, 7.0]);
    assert!((sun - Vec3::new(0.0, 0.6, 0.8)).length() < 1e-12, "{sun}");
    let cie = scene("void brightfunc s 2 skybr skybright.cal 0 7 4 2 3 4 .6 0 .8\n");
    let ModifierKind::Pattern(Pattern::Sky(SkyDistribution::Cie { kind, zenith, .. })) =
        cie.modifiers[0].kind
    else {
        panic!("{:?}", cie.modifiers)
    };
    assert_eq!((kind, zenith), (CieSky::Intermediate, 2.0));
}

#[test]
fn generated_skies_are_read() {
    for command in ["gensky 3 21 12 +s", "gensky -ang 40 10 -c", "gendaylit -ang 40 10 -W 500 100"] {
        let glow = "skyfunc glow g 0 0 4 1 1 1 0\ng source sky 0 0 4 0 0 1 180";
        let read = scene(&format!("!{command} | xform -rz 20\n{glow}"));
        let sky = read.surfaces.last().expect("a sky");
        assert_eq!(sky.shape, Shape::Source { direction: Vec3::Z, angle_deg: 180.0 }, "{command}");
        let glow = sky.modifier.expect("a material").0;
        assert!(read.modifiers[glow].parent.is_some(), "{command}");
        assert_eq!(sky.location.line, 3);
    }
    assert!(message("!gensky 3 21").contains("t.rad:1:1: "));
}

#[test]
fn transforms_reach_the_frames_of_bsdfs() {
    let options = LoadOptions::default();
    let this = file!().rsplit('/').next().expect("a name");
    let place = format!("{}/tests/{this}", env!("CARGO_MANIFEST_DIR"));
    let text = format!(
        "void BSDF b 11 .1 {place} 0 0 1 . -rx 90 -s 2 -mz 0 6 .1 .2 .3 .4 .5 .6\n\
         void aBSDF a 5 {place} 0 1 0 . 0 0\n"
    );
    let read = Scene::parse(&text, "t.rad", &options).expect("a scene");
    let (Material::Bsdf(b), Material::Bsdf(a)) = (material(&read, 0), material(&read, 1)) else {
        panic!("{:?}", read.modifiers)
    };
    let (Orientation::Fixed(b_up), Orientation::Fixed(a_up)) = (&b.up, &a.up) else { panic!("{b:?} {a:?}") };
    assert!((b_up - Vec3::NEG_Y).length() < 1e-12 && b.mirrored, "{b:?}");
    assert!(matches!(b.thickness, Thickness::Fixed(thickness) if (thickness - 0.2).abs() < 1e-12));
    assert_eq!((b.back_diffuse, b.diffuse_transmission), (Vec3::new(0.4, 0.5, 0.6), Vec3::ZERO));
    assert!(a.extract_peak && !a.mirrored && *a_up == Vec3::Y);
    assert!(matches!(a.thickness, Thickness::Fixed(0.0)));
}

#[test]
fn degenerate_surfaces_are_left_out_with_a_warning() {
    let read = scene(&format!(
        "{WHITE}white polygon line 0 0 9 0 0 0 1 0 0 2 0 0\nwhite ring none 0 0 8 0 0 0 0 0 1 1 1\n\
         white cylinder flat 0 0 7 1 1 1 1 1 1 .5\nwhite sphere dot 0 0 4 0 0 0 0\nwhite sphere in 0 0 4 0 0 0 -2\n\
         white ring swapped 0 0 8 0 0 0 0 0 2 3 1\nwhite polygon closed 0 0 12 0 0 0 1 0 0 0 1 0 0 0 0"
    ));
    let shapes: Vec<_> = read.surfaces.iter().map(|s| &s.shape).collect();
    let ring = Shape::Ring { center: Vec3::ZERO, normal: Vec3::Z, inner_radius: 1.0, outer_radius: 3.0 };
    assert_eq!(shapes[0], &Shape::Sphere { center: Vec3::ZERO, radius: 2.0, inward: true });
    assert_eq!(shapes[1], &ring);
    assert!(matches!(shapes[2], Shape::Polygon(points) if points.len() == 3));
    assert_eq!((shapes.len(), read.warnings.len()), (3, 5));
    assert_eq!(read.warnings[0], "t.rad:2:1: polygon \"line\" has no area; left out");
}

#[test]
fn what_cannot_be_used_matters_only_when_it_is_used() {
    let unused = "void specpict c 4 1 1 1 . 0 0\nc plastic p 0 0 5 1 1 1 0 0\ninherit alias q p\nvoid plastic z 0 0 4 1 1 1 0\n";
    let read = scene(unused);
    assert_eq!((read.modifiers.len(), read.warnings.len()), (0, 2));
    let used = message(&format!("{unused}q sphere s 0 0 4 0 0 0 1"));
    assert_eq!(
        used,
        "t.rad:1:1: wrong number of arguments of specpict \"c\": expected at least 5 string arguments (a function, a hyperspectral \
         picture, a function file and two coordinates), found 4 (used by sphere \"s\" at t.rad:5:1)"
    );
}

#[test]
fn wrong_texts_are_said_to_be_wrong_and_where() {
    let surface = |text: &str| format!("{WHITE}{BLACK}{text}");
    for (text, expected) in [
        (surface("grey sphere s 0 0 4 0 0 0 1"), "t.rad:3:1: undefined modifier \"grey\" of sphere \"s\""),
        (surface("white sphere s 0 0 3 0 0 1"), "expected 0 string and 4 real arguments (xcent ycent zcent radius), found 0 and 3"),
        (surface("white polygon s 0 0 6 0 0 0 1 1 1"), "3 real arguments a vertex, 9 or more, found 0 and 6"),
        (surface("white alias a grey"), "alias \"a\" stands for \"grey\", which no material or pattern above"),
        (surface("inherit sphere s 0 0 4 0 0 0 1"), "only an alias can inherit"),
        (surface("void plastic void 0 0 5 1 1 1 0 0"), "\"void\" has a meaning of its own"),
        (surface("white source s 0 0 4 0 0 0 1"), "the direction is zero"),
        (surface("white source s 0 0 4 0 0 1 400"), "the angle is 400, expected degrees over 0, up to 360"),
        (surface("black plastic p 0 0 5 1 1 1 0 0 p sphere s 0 0 4 0 0 0 1"), "\"p\" and \"black\" are both materials"),
        (surface("white instance i 1 a.oct 0 0"), "t.rad:3:1: cannot find the file \"a.oct\""),
        (surface("white mesh m 0 0 0"), "expected a file, a transform if it is to be moved, and no real arguments"),
        (surface("white mesh m 2 a.rtm -rz 0 0"), "mesh \"m\": bad transform: expected a number after -rz"),
        (surface("void plastic2 a 4 1 0 0 . 0 6 1 1 1 0 0 .1 a sphere s 0 0 4 0 0 0 1"), "plastic2 \"a\": urough is 0, expected more than"),
        (surface("void plastic2 a 3 1 0 0 0 6 1 1 1 0 .1 .1 a sphere s 0 0 4 0 0 0 1"), "the last ones ux uy uz of the orientation and a"),
        (surface("void mist a 0 0 7 1 1 1 1 1 1 1 a sphere s 0 0 4 0 0 0 1"), "the eccentricity is 1, expected -1 to 1"),
        (surface("void antimatter a 1 b 0 0 a sphere s 0 0 4 0 0 0 1"), "the modifier that is to be clipped, \"b\", is not defined above"),
        (surface("void interface a 0 0 8 1 1 1 1.5 1 1 1 0 a sphere s 0 0 4 0 0 0 1"), "the index of refraction is 0"),
        (surface("white sphere"), "expected the name of this sphere, found the end of the text"),
        (
            "void plastic p 0 0 4 1 1 1 0 p sphere s 0 0 4 0 0 0 1".into(),
            "expected 0 string and 5 real arguments (red green blue specularity roughness), found 0 and 4",
        ),
        (
            "void plastic p 0 0 5 1 1 -1 0 0 p sphere s 0 0 4 0 0 0 1".into(),
            "plastic \"p\": the colour is -1, expected 0 or more",
        ),
        (
            "void aBSDF b 5 no.xml 0 0 1 . 0 0 b sphere s 0 0 4 0 0 0 1".into(),
            "aBSDF \"b\": cannot find the file \"no.xml\"; looked for no.xml (used by",
        ),
        (
            "void BSDF b 6 nosuch no.xml 0 0 1 . 0 0 b sphere s 0 0 4 0 0 0 1".into(),
            "the variable \"nosuch\" is not defined",
        ),
        (
            "void brightfunc f 2 skybr skybright.cal 0 7 1 1 1 1 0 0 1 f sphere s 0 0 4 0 0 0 1".into(),
            "\"f\" has no material among its modifiers",
        ),
        (
            "void brightfunc f 4 skybr skybright.cal -rx 20 0 7 1 1 1 1 0 0 1 f glow g 0 0 4 1 1 1 0 g source s 0 0 4 0 0 1 180".into(),
            "function file: cannot find the file \"skybright.cal\"; looked for skybright.cal",
        ),
        (
            "void colorfunc c 4 Px Pi Pz . 0 0 c plastic p 0 0 5 1 1 1 0 0 p sphere s 0 0 4 0 0 0 1".into(),
            "t.rad:1:1: colorfunc \"c\": the variable \"Pi\" is not defined (used by",
        ),
        (
            "void brightfunc b 2 A1+A2 . 0 1 3 b plastic p 0 0 5 1 1 1 0 0 p sphere s 0 0 4 0 0 0 1".into(),
            "the real argument A2 is asked for, but only 1 are given",
        ),
        (
            "void mixfunc m 4 void grey Px . 0 0 m sphere s 0 0 4 0 0 0 1".into(),
            "mixfunc \"m\": the modifier to be mixed, \"grey\", is not defined above",
        ),
        (
            "void brightdata b 4 noop no.dat . Px 0 0 b plastic p 0 0 5 1 1 1 0 0 p sphere s 0 0 4 0 0 0 1".into(),
            "data file: cannot find the file \"no.dat\"; looked for no.dat",
        ),
        (
            "void plastic a 0 0 5 1 1 1 0 0 void mixfunc m 4 void a Px . 0 0 m plastic b 0 0 5 1 1 1 0 0 b sphere s 0 0 4 0 0 0 1".into(),
            "\"b\" and \"m\" are both materials",
        ),
        ("!genbox white b 1 2".into(), "expected genbox material name xsize ysize zsize"),
        ("!xform -t 1 0 no.rad".into(), "xform: expected a number after -t, found \"no.rad\""),
        ("!xform no.rad".into(), "t.rad:1:1: cannot find the file \"no.rad\"; looked for no.rad"),
        ("!xform -t 0 0 1".into(), "xform: no file is given"),
        ("\n !rm -rf x".into(), "t.rad:2:2: the command \"rm\" is not run"),
        ("!xform *.rad".into(), "`*` needs a shell"),
    ] {
        let message = message(&text);
        assert!(message.contains(expected), "{text}\n{message}");
    }
}

#[test]
fn files_that_include_themselves_are_found_out() {
    let folder = std::env::temp_dir().join(format!("sunpeak-scene-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("a file");
    write("a.rad", "!xform b.rad\n");
    write("b.rad", "!xform -t 1 0 0 ./a.rad\n");
    write("c.rad", "!cat c.rad\n");
    write("d.rad", "!xform -c -t 1 0 0 d.rad\n");
    let load = |name: &str| {
        let options = LoadOptions { cwd: Some(folder.clone()), ..LoadOptions::default() };
        Scene::load(&[name.into()], &options).expect_err(name).to_string()
    };
    assert!(load("a.rad").contains("b.rad:1:1: the file \"./a.rad\" includes itself"), "{}", load("a.rad"));
    assert!(load("c.rad").contains("commands within commands"), "{}", load("c.rad"));
    assert!(load("d.rad").contains("commands within commands"), "{}", load("d.rad"));
    assert!(load("none.rad").contains("none.rad: No such file"), "{}", load("none.rad"));
    std::fs::remove_dir_all(&folder).expect("removed");
}

#[test]
fn other_commands_run_only_when_allowed() {
    let options = LoadOptions { allow_commands: true, ..LoadOptions::default() };
    let parse = |text: &str| Scene::parse(text, "t.rad", &options);
    let read = parse(&format!("{WHITE}!echo 'white sphere s 0 0 4 0 0 0 1'; echo odd >&2")).expect("a scene");
    assert_eq!((read.surfaces.len(), read.surfaces[0].location.line), (1, 2));
    assert_eq!(read.warnings, ["t.rad:2:1: odd"]);
    let failed = parse("!echo sorry >&2; exit 3").expect_err("a failure").to_string();
    assert!(
        failed.starts_with("t.rad:1:1: the command \"echo sorry") && failed.ends_with("sorry"),
        "{failed}"
    );
    let wrong = parse("!echo void plastik x").expect_err("an error").to_string();
    let expected = "t.rad:1:1: in the output of \"!echo void plastik x\":1:6: unknown primitive \"plastik\"";
    assert!(wrong.starts_with(expected), "{wrong}");
}
