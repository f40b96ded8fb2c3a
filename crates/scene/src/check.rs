//! All that is wrong with scene files, at once.

use crate::{
    LoadOptions, Scene, Source,
    command::Expander,
    interpret::Interpreter,
    load::load_source,
    raw::{Class, Primitive},
};
use std::collections::HashMap;
use sunpeak_core::{Error, Location};

/// What a scene that was read to its end in spite of mistakes came to.
#[derive(Debug)]
pub struct SceneCheck {
    /// What could be read.
    pub scene: Scene,
    /// Mistakes, in the order in which they were met; a scene with one cannot be rendered.
    pub errors: Vec<Error>,
    /// What is odd: surfaces without area or off their plane, things that nothing uses, empty files.
    pub warnings: Vec<String>,
}

impl Scene {
    /// Read files and texts to their end and say everything that is wrong with them. A mistake that others hang on (an undefined
    /// material of a thousand polygons) is told once.
    pub fn check(sources: &[Source], options: &LoadOptions) -> SceneCheck {
        let mut expander = Expander::gathering(options);
        let mut interpreter = Interpreter::new(options);
        let (mut errors, mut names) = (Vec::new(), Names::default());
        for source in sources {
            let primitives = load_source(&mut expander, source, options);
            errors.extend(expander.take_mistakes());
            match primitives {
                Ok(primitives) => {
                    for primitive in primitives {
                        names.see(&primitive);
                        errors.extend(interpreter.check(primitive));
                    }
                }
                Err(error) => errors.push(error),
            }
        }
        let mut warnings = std::mem::take(&mut expander.warnings);
        let mut scene = interpreter.finish();
        warnings.append(&mut scene.warnings);
        warnings.append(&mut names.finish());
        SceneCheck { scene, errors, warnings }
    }
}

/// Which names are defined, and not used so far.
#[derive(Default)]
struct Names {
    unused: HashMap<String, (usize, Location, String)>,
    warnings: Vec<String>,
    count: usize,
}

impl Names {
    fn see(&mut self, primitive: &Primitive) {
        self.unused.remove(&*primitive.modifier);
        if matches!(primitive.kind.class, Class::Surface | Class::Volume) {
            return;
        }
        // Materials that are seen instead, parts of mixtures, what an alias stands for.
        for word in &primitive.strings {
            self.unused.remove(word);
        }
        self.count += 1;
        let title = format!("{} \"{}\"", primitive.kind.name, primitive.name);
        let entry = (self.count, primitive.location.clone(), title);
        if let Some((_, location, title)) = self.unused.insert(primitive.name.clone(), entry) {
            let again = &primitive.location;
            self.warnings
                .push(format!("{location}: {title} is defined again at {again} before anything uses it"));
        }
    }

    fn finish(self) -> Vec<String> {
        let mut unused: Vec<_> = self.unused.into_values().collect();
        unused.sort_by_key(|(index, ..)| *index);
        let mut warnings = self.warnings;
        warnings.extend(unused.into_iter().map(|(_, at, title)| format!("{at}: nothing uses {title}")));
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_wrong_is_said_once() {
        let text = "void plastic white 0 0 4 .5 .5 .5 0\nwhite polygon a 0 0 9 0 0 0 1 0 0 0 1 0\n\
                    white polygon b 0 0 9 0 0 0 1 0 0 0 1 0\nvoid metall grey 0 0 5 1 1 1 0 0\n\
                    grey sphere c 0 0 4 0 0 0 1\ngrey sphere d 0 0 4 0 0 0 1\nvoid polygon e 0 0 6 0 0 0 1 0 0\n\
                    void polygon f 0 0 9 0 0 0 1 0 0 2 0 0\nvoid polygon g 0 0 12 0 0 0 1 0 0 1 1 1 0 1 0\n\
                    !nosuch 1\n!genbox none box 1 1 1\nvoid light lamp 0 0 3 1 1 1\n\
                    none ring h 0 0 7 0 0 0 0 0 1 0\nwhite sphere i 0 0 4 0 0 0 0\nnone mesh j 1 none.rtm 0 0\n\
                    white plastic pale 0 0 3 .5 .5 .5\npale sphere k 0 0 3 0 0 0\nnowhere sphere l 0 0 3 0 0 0";
        let source = Source::Text { name: "t.rad".into(), text: text.into(), directory: ".".into() };
        let check = Scene::check(&[source], &LoadOptions::default());
        let errors: Vec<_> = check.errors.iter().map(ToString::to_string).collect();
        let expected = [
            "t.rad:4:6: unknown primitive \"metall\"",
            "t.rad:10:1: the command \"nosuch\" is not run",
            "t.rad:1:1: wrong number of arguments of plastic \"white\"",
            "t.rad:5:1: undefined modifier \"grey\"",
            "t.rad:7:1: wrong number of arguments of polygon \"e\"",
            "t.rad:11:1: undefined modifier \"none\"",
            "t.rad:13:1: wrong number of arguments of ring \"h\"",
            "t.rad:15:1: cannot find the file \"none.rtm\"",
            "t.rad:16:1: wrong number of arguments of plastic \"pale\"",
            "t.rad:17:1: wrong number of arguments of sphere \"k\"",
            "t.rad:18:1: undefined modifier \"nowhere\"",
            "t.rad:18:1: wrong number of arguments of sphere \"l\"",
        ];
        assert_eq!(errors.len(), expected.len(), "{errors:#?}");
        for (error, expected) in errors.iter().zip(expected) {
            assert!(error.starts_with(expected), "{error}");
        }
        let expected =
            ["\"f\" has no area", "\"g\" has a vertex", "\"i\" has no radius", "nothing uses light \"lamp\""];
        assert_eq!(check.warnings.len(), expected.len(), "{:#?}", check.warnings);
        for (warning, expected) in check.warnings.iter().zip(expected) {
            assert!(warning.contains(expected), "{warning}");
        }
    }
}
