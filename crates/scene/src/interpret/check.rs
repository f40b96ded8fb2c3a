//! Every mistake of a primitive, and each once.

use super::{INHERIT, Interpreter, Named, Problem, VOID};
use crate::raw::{Class, Primitive};
use sunpeak_core::{Error, Location};

impl Interpreter<'_> {
    /// Take one primitive in, and tell the mistakes that it makes; what hangs on a mistake told before is left out without a word.
    pub fn check(&mut self, primitive: Primitive) -> Vec<Error> {
        if !matches!(primitive.kind.class, Class::Surface | Class::Volume) {
            let (modifier, name) = (primitive.modifier.clone(), primitive.name.clone());
            let mistake = self.add(primitive).err();
            if mistake.is_some() {
                self.tell_undefined(&modifier);
                self.tell(name);
            }
            return mistake.into_iter().collect();
        }
        let mut mistakes = self.untold(&primitive);
        if !matches!(self.names.get(&*primitive.modifier), Some(Named::Problem(_))) {
            match self.modifier_of(&primitive) {
                Ok(_) => return self.add(primitive).err().into_iter().collect(),
                Err(mistake) => mistakes.push(mistake),
            }
            self.tell_undefined(&primitive.modifier);
        }
        mistakes.extend(self.own_mistake(&primitive));
        mistakes
    }

    /// What is wrong with the modifiers of a surface and was not told yet, the innermost first.
    fn untold(&mut self, primitive: &Primitive) -> Vec<Error> {
        let mut next = match self.names.get(&*primitive.modifier) {
            Some(Named::Problem(problem)) => Some(*problem),
            _ => None,
        };
        let mut mistakes = Vec::new();
        while let Some(problem) = next {
            if self.told.insert(problem) {
                mistakes.push(self.raise(problem, primitive));
            }
            next = self.problems[problem].outer;
        }
        mistakes
    }

    /// What is wrong with a surface beside its modifier.
    fn own_mistake(&mut self, primitive: &Primitive) -> Option<Error> {
        match primitive.kind.class {
            Class::Surface => self.shape(primitive).err(),
            _ => self.compound_file(primitive).err(),
        }
    }

    fn tell_undefined(&mut self, modifier: &str) {
        if !self.names.contains_key(modifier) && ![VOID, INHERIT].contains(&modifier) {
            self.tell(modifier.to_string());
        }
    }

    /// From here on a name stands for a mistake that was told.
    fn tell(&mut self, name: String) {
        self.told.insert(self.problems.len());
        self.names.insert(name, Named::Problem(self.problems.len()));
        self.problems.push(Problem { location: Location::default(), message: String::new(), outer: None });
    }
}
