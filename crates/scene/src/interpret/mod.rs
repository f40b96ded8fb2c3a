//! What primitives mean: names looked up, arguments checked, surfaces and modifiers made.

mod args;
mod bsdf;
mod check;
mod compounds;
mod functions;
mod materials;
mod orientation;
mod patterns;
mod sky;
mod surfaces;
mod text;
mod volumes;
mod wgmd;

use crate::{
    LoadOptions, Modifier, ModifierId, ModifierKind, Scene, Shape, Surface,
    field::FunctionFiles,
    raw::{Class, Primitive},
};
use compounds::Compounds;
use std::{
    collections::{HashMap, HashSet},
    path::PathBuf,
};
use sunpeak_core::{Error, Location, Result};

/// The modifier that is none.
const VOID: &str = "void";
/// The modifier of an alias that keeps its original's.
const INHERIT: &str = "inherit";

/// Makes a scene of primitives, one after the other.
pub struct Interpreter<'o> {
    options: &'o LoadOptions,
    cwd: PathBuf,
    scene: Scene,
    names: HashMap<String, Named>,
    problems: Vec<Problem>,
    compounds: Compounds,
    /// Those of the problems that were told as mistakes.
    told: HashSet<usize>,
    functions: FunctionFiles,
    /// What each of the scene's modifiers is made of.
    makings: Vec<Making>,
}

/// What is in a chain of modifiers.
#[derive(Clone, Copy)]
struct Making {
    has_material: bool,
    /// Mixtures within each other.
    mixtures: usize,
}

/// Mixtures within each other: each doubles what is to be evaluated.
const MAX_MIXTURES: usize = 8;

/// What a name stands for.
#[derive(Clone, Copy)]
enum Named {
    Modifier(ModifierId),
    /// Something that cannot be rendered: an error as soon as a surface needs it, and not before, as in Radiance.
    Problem(usize),
}

/// Why a modifier cannot be used.
struct Problem {
    location: Location,
    message: String,
    /// What is wrong with its own modifier.
    outer: Option<usize>,
}

/// What a word in the place of a modifier means.
enum Reference {
    Void,
    Named(Named),
}

impl<'o> Interpreter<'o> {
    /// With an empty scene.
    pub fn new(options: &'o LoadOptions) -> Self {
        Self {
            options,
            cwd: options.base(),
            scene: Scene::default(),
            names: HashMap::new(),
            problems: Vec::new(),
            compounds: Compounds::default(),
            told: HashSet::new(),
            functions: FunctionFiles::new(),
            makings: Vec::new(),
        }
    }

    /// Take one primitive in.
    pub fn add(&mut self, primitive: Primitive) -> Result<()> {
        match primitive.kind.class {
            Class::Surface => self.surface(primitive),
            Class::Volume => self.compound(&primitive),
            Class::Alias => self.alias(&primitive),
            _ => self.modifier(&primitive),
        }
    }

    /// The scene. Modifiers that cannot be used, and that nothing uses, are warnings in it.
    pub fn finish(mut self) -> Scene {
        let untold = self.problems.iter().enumerate().filter(|(index, _)| !self.told.contains(index));
        let unused = untold.map(|(_, p)| format!("{}: {} (nothing uses it)", p.location, p.message));
        self.scene.warnings.extend(unused);
        self.scene
    }

    fn modifier(&mut self, primitive: &Primitive) -> Result<()> {
        let named = match self.parent(primitive, &primitive.modifier)? {
            Reference::Named(problem @ Named::Problem(outer)) => match self.kind_of(primitive) {
                Err(Unusable::Because(message)) => self.problem(primitive, message, Some(outer)),
                _ => problem,
            },
            Reference::Void => self.make(primitive, None),
            Reference::Named(Named::Modifier(parent)) => self.make(primitive, Some(parent)),
        };
        self.define(primitive, named)
    }

    fn make(&mut self, primitive: &Primitive, parent: Option<ModifierId>) -> Named {
        match self.kind_of(primitive) {
            Ok(kind) if self.making(parent, &kind).mixtures > MAX_MIXTURES => {
                let message = format!(
                    "{}: more than {MAX_MIXTURES} mixtures within each other",
                    args::title(primitive)
                );
                self.problem(primitive, message, None)
            }
            Ok(kind) => self.push(primitive, parent, kind),
            Err(Unusable::Named(named)) => named,
            Err(Unusable::Because(message)) => self.problem(primitive, message, None),
        }
    }

    fn problem(&mut self, primitive: &Primitive, message: String, outer: Option<usize>) -> Named {
        self.problems.push(Problem { location: primitive.location.clone(), message, outer });
        Named::Problem(self.problems.len() - 1)
    }

    fn push(&mut self, primitive: &Primitive, parent: Option<ModifierId>, kind: ModifierKind) -> Named {
        self.makings.push(self.making(parent, &kind));
        let (name, location) = (primitive.name.clone(), primitive.location.clone());
        self.scene.modifiers.push(Modifier { name, parent, kind, location });
        Named::Modifier(ModifierId(self.scene.modifiers.len() - 1))
    }

    fn define(&mut self, primitive: &Primitive, named: Named) -> Result<()> {
        if [VOID, INHERIT].contains(&primitive.name.as_str()) {
            let message = format!("\"{}\" has a meaning of its own: expected another name", primitive.name);
            return Err(Error::input(primitive.location.clone(), message));
        }
        self.names.insert(primitive.name.clone(), named);
        Ok(())
    }

    /// An alias takes type and arguments from what it names, and its own modifier, or `inherit`s that too.
    fn alias(&mut self, primitive: &Primitive) -> Result<()> {
        let inherits = &*primitive.modifier == INHERIT;
        let parent = if inherits { Reference::Void } else { self.parent(primitive, &primitive.modifier)? };
        let named = match (self.target(primitive)?, parent) {
            (problem @ Named::Problem(_), _) | (_, Reference::Named(problem @ Named::Problem(_))) => problem,
            (Named::Modifier(target), parent) => {
                let original = &self.scene.modifiers[target.0];
                let parent = match parent {
                    _ if inherits => original.parent,
                    Reference::Named(Named::Modifier(parent)) => Some(parent),
                    _ => None,
                };
                let kind = original.kind.clone();
                self.push(primitive, parent, kind)
            }
        };
        self.define(primitive, named)
    }

    fn target(&self, alias: &Primitive) -> Result<Named> {
        let target = alias.strings.first().map_or("", String::as_str);
        self.names.get(target).copied().ok_or_else(|| {
            let message = format!(
                "alias \"{}\" stands for \"{target}\", which no material or pattern above is named",
                alias.name
            );
            Error::input(alias.location.clone(), message)
        })
    }

    fn surface(&mut self, primitive: Primitive) -> Result<()> {
        let modifier = self.modifier_of(&primitive)?;
        if let Some(shape) = self.shape(&primitive)? {
            let Primitive { name, location, .. } = primitive;
            self.scene.surfaces.push(Surface { name, modifier, shape, location });
        }
        Ok(())
    }

    /// What a surface is made of; `None` is void.
    fn modifier_of(&self, primitive: &Primitive) -> Result<Option<ModifierId>> {
        let modifier = match (self.compounds.modifier, self.parent(primitive, &primitive.modifier)?) {
            (Some(id), _) => Some(id),
            (None, Reference::Void) => None,
            (None, Reference::Named(Named::Modifier(id))) => Some(id),
            (None, Reference::Named(Named::Problem(problem))) => return Err(self.raise(problem, primitive)),
        };
        modifier.map_or(Ok(()), |id| self.check_chain(id, primitive)).map(|()| modifier)
    }

    /// A surface's shape; `None` where light meets nothing.
    fn shape(&mut self, primitive: &Primitive) -> Result<Option<Shape>> {
        let at = |message: String| Error::input(primitive.location.clone(), message);
        Ok(match surfaces::shape(primitive).map_err(at)? {
            surfaces::Outcome::Good(shape) => Some(shape),
            surfaces::Outcome::Odd(shape, oddity) => {
                self.warn(primitive, &oddity);
                Some(shape)
            }
            surfaces::Outcome::Skip(reason) => {
                self.warn(primitive, &format!("{reason}; left out"));
                None
            }
        })
    }

    fn warn(&mut self, primitive: &Primitive, message: &str) {
        self.scene.warnings.push(format!("{}: {} {message}", primitive.location, args::title(primitive)));
    }

    fn raise(&self, problem: usize, user: &Primitive) -> Error {
        let Problem { location, message, .. } = &self.problems[problem];
        Error::input(
            location.clone(),
            format!("{message} (used by {} at {})", args::title(user), user.location),
        )
    }

    /// A surface needs one material among its modifiers.
    fn check_chain(&self, id: ModifierId, surface: &Primitive) -> Result<()> {
        let message = match self.materials_of(id).as_slice() {
            [_] => return Ok(()),
            [] => format!("\"{}\" has no material among its modifiers", surface.modifier),
            [a, b, ..] => {
                format!("\"{a}\" and \"{b}\" are both materials: a surface can have only one")
            }
        };
        Err(Error::input(surface.location.clone(), format!("{}: {message}", args::title(surface))))
    }

    /// The names of materials in a chain of modifiers; a mixture of materials counts as one.
    fn materials_of(&self, id: ModifierId) -> Vec<&str> {
        let chain = std::iter::successors(Some(id), |id| self.scene.modifiers[id.0].parent);
        let is_material = |id: &ModifierId| match &self.scene.modifiers[id.0].kind {
            ModifierKind::Material(_) => true,
            ModifierKind::Pattern(_) | ModifierKind::Texture(_) => false,
            ModifierKind::Mixture { fore, back, .. } => {
                [fore, back].into_iter().flatten().any(|id| self.makings[id.0].has_material)
            }
        };
        chain.filter(is_material).map(|id| self.scene.modifiers[id.0].name.as_str()).collect()
    }

    /// What a new modifier is made of.
    fn making(&self, parent: Option<ModifierId>, kind: &ModifierKind) -> Making {
        let mut making = Making { has_material: matches!(kind, ModifierKind::Material(_)), mixtures: 0 };
        let parts = match kind {
            ModifierKind::Mixture { fore, back, .. } => [*fore, *back],
            _ => [None; 2],
        };
        for part in parts.into_iter().flatten().map(|id| self.makings[id.0]) {
            making.has_material |= part.has_material;
            making.mixtures = making.mixtures.max(part.mixtures + 1);
        }
        if let Some(parent) = parent.map(|id| self.makings[id.0]) {
            making.has_material |= parent.has_material;
            making.mixtures = making.mixtures.max(parent.mixtures);
        }
        making
    }

    /// The last definition above.
    fn parent(&self, primitive: &Primitive, name: &str) -> Result<Reference> {
        if name == VOID {
            return Ok(Reference::Void);
        }
        if let Some(&named) = self.names.get(name) {
            return Ok(Reference::Named(named));
        }
        let message = match name {
            INHERIT => "only an alias can inherit its modifier".to_string(),
            _ => format!(
                "undefined modifier \"{name}\" of {}: it must be defined above, or in a file that is named before \
                 this one",
                args::title(primitive)
            ),
        };
        Err(Error::input(primitive.location.clone(), message))
    }
}

/// Why a modifier cannot be made.
enum Unusable {
    Because(String),
    /// Another one that it needs cannot.
    Named(Named),
}

impl From<String> for Unusable {
    fn from(message: String) -> Self {
        Self::Because(message)
    }
}
