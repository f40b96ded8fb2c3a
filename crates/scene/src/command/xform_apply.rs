//! What `xform` does to one primitive.

use super::xform::Invocation;
use crate::raw::{Class, CommandLine, Item, Primitive, PrimitiveType};
use sunpeak_core::Vec3;

impl Invocation {
    /// An item as it leaves this pass.
    pub fn apply_to_item(&self, item: &Item) -> Item {
        match item {
            Item::Primitive(primitive) => Item::Primitive(self.apply(primitive.clone())),
            Item::Command(command) => Item::Command(self.apply_to_command(command.clone())),
        }
    }

    /// A primitive as it leaves this pass. Wrong argument counts stay as they are: whoever reads them complains.
    pub fn apply(&self, mut primitive: Primitive) -> Primitive {
        if !primitive.kind.is_modifier() {
            self.rename(&mut primitive);
        }
        if primitive.kind.has_function {
            self.append_transform(&mut primitive.strings);
        }
        self.transform_arguments(&mut primitive);
        if self.invert {
            primitive.kind = inverse(primitive.kind);
        }
        primitive
    }

    /// A kept command: its output goes through this pass when it is run.
    fn apply_to_command(&self, mut command: CommandLine) -> CommandLine {
        command.text.push_str(" | xform -e");
        for option in self.options.iter().filter(|option| *option != "-c") {
            command.text.push_str(&format!(" '{}'", option.replace('\'', "'\\''")));
        }
        command
    }

    fn rename(&self, primitive: &mut Primitive) {
        if let Some(modifier) = &self.modifier {
            primitive.modifier = modifier.clone();
        }
        if let Some(prefix) = &self.prefix {
            primitive.name = format!("{prefix}.{}", primitive.name);
        }
    }

    /// Transforms add up in the string arguments; `-i 1` keeps an iteration of the earlier one to itself.
    fn append_transform(&self, strings: &mut Vec<String>) {
        if self.transform_args.first().is_some_and(|first| first != "-i") {
            strings.extend(["-i".into(), "1".into()]);
        }
        strings.extend_from_slice(&self.transform_args);
    }

    fn transform_arguments(&self, primitive: &mut Primitive) {
        let scale = self.transform.scale();
        let reals = primitive.reals.as_mut_slice();
        match (primitive.kind.name, reals.len()) {
            ("polygon", n) if n % 3 == 0 => self.polygon(reals),
            ("sphere" | "bubble", 4) => {
                self.point(reals, 0);
                reals[3] *= scale;
            }
            ("cylinder" | "tube", 7) | ("cone" | "cup", 8) => {
                self.point(reals, 0);
                self.point(reals, 3);
                reals[6..].iter_mut().for_each(|radius| *radius *= scale);
            }
            ("ring", 8) => {
                self.point(reals, 0);
                self.vector(reals, 3);
                if self.invert {
                    reals[3..6].iter_mut().for_each(|component| *component = -*component);
                }
                reals[6..].iter_mut().for_each(|radius| *radius *= scale);
            }
            ("source", 4) => self.vector(reals, 0),
            ("glow", 4) => reals[3] *= scale,
            ("spotlight", 7) => self.vector(reals, 4),
            ("dielectric", 5) => per_length(&mut reals[..3], scale),
            ("interface", 8) => {
                per_length(&mut reals[..3], scale);
                per_length(&mut reals[4..7], scale);
            }
            ("mist", _) => self.mist(primitive),
            ("brighttext" | "colortext" | "mixtext", 9..) => {
                self.point(reals, 0);
                self.vector(reals, 3);
                self.vector(reals, 6);
            }
            _ => {}
        }
    }

    fn polygon(&self, reals: &mut [f64]) {
        for at in (0..reals.len()).step_by(3) {
            self.point(reals, at);
        }
        // A mirror turns the front to the back, so the vertices go the other way round.
        if self.transform.is_mirror() != self.invert {
            reals.reverse();
            reals.chunks_exact_mut(3).for_each(<[f64]>::reverse);
        }
    }

    /// Extinction is per length; the names of its light sources, `a>b` relayed, get the prefix too.
    fn mist(&self, primitive: &mut Primitive) {
        let scale = self.transform.scale();
        primitive.reals.iter_mut().take(3).for_each(|extinction| *extinction /= scale);
        if let Some(prefix) = &self.prefix {
            for name in &mut primitive.strings {
                *name = name.split('>').map(|n| format!("{prefix}.{n}")).collect::<Vec<_>>().join(">");
            }
        }
    }

    fn point(&self, reals: &mut [f64], at: usize) {
        replace(reals, at, |p| self.transform.point(p));
    }

    fn vector(&self, reals: &mut [f64], at: usize) {
        replace(reals, at, |v| self.transform.vector(v));
    }
}

fn replace(reals: &mut [f64], at: usize, change: impl Fn(Vec3) -> Vec3) {
    let changed = change(Vec3::from_slice(&reals[at..at + 3]));
    reals[at..at + 3].copy_from_slice(&changed.to_array());
}

/// Transmission per unit of length, when lengths grow by `scale`.
fn per_length(transmission: &mut [f64], scale: f64) {
    transmission.iter_mut().for_each(|t| *t = t.powf(1.0 / scale));
}

/// The surface type that faces the other way; the rest is its own inverse.
fn inverse(kind: &'static PrimitiveType) -> &'static PrimitiveType {
    let name = match kind.name {
        "cone" => "cup",
        "cup" => "cone",
        "sphere" => "bubble",
        "bubble" => "sphere",
        "cylinder" => "tube",
        "tube" => "cylinder",
        _ => return kind,
    };
    debug_assert_eq!(kind.class, Class::Surface);
    PrimitiveType::find(name).unwrap_or(kind)
}
