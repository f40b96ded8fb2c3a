//! The primitive types that Radiance knows (reference manual, "Primitive Types"), whether we render them or not.

/// What a primitive is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Geometry.
    Surface,
    /// Geometry of its own kind: an octree or a mesh.
    Volume,
    /// Another name, or another modifier, for something.
    Alias,
    /// How a surface meets light.
    Material,
    /// Multiplies a colour.
    Pattern,
    /// Bends the normal.
    Texture,
    /// Mixes two modifiers.
    Mixture,
}

/// A row of the table.
#[derive(Debug)]
pub struct PrimitiveType {
    /// The word in the file.
    pub name: &'static str,
    /// What it is for.
    pub class: Class,
    /// Does it have a function file, so that `xform` appends its transform to the string arguments?
    pub has_function: bool,
}

impl PrimitiveType {
    /// Can other primitives name it as their modifier?
    pub fn is_modifier(&self) -> bool {
        !matches!(self.class, Class::Surface | Class::Volume)
    }

    /// The type of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        TYPES.iter().find(|t| t.name == name)
    }
}

const fn plain(name: &'static str, class: Class) -> PrimitiveType {
    PrimitiveType { name, class, has_function: false }
}

const fn function(name: &'static str, class: Class) -> PrimitiveType {
    PrimitiveType { name, class, has_function: true }
}

/// The most frequent ones first: they are searched in order.
static TYPES: [PrimitiveType; 59] = [
    plain("polygon", Class::Surface),
    plain("cylinder", Class::Surface),
    plain("sphere", Class::Surface),
    plain("ring", Class::Surface),
    plain("cone", Class::Surface),
    plain("cup", Class::Surface),
    plain("bubble", Class::Surface),
    plain("tube", Class::Surface),
    plain("source", Class::Surface),
    function("instance", Class::Volume),
    function("mesh", Class::Volume),
    plain("alias", Class::Alias),
    plain("plastic", Class::Material),
    plain("metal", Class::Material),
    plain("glass", Class::Material),
    plain("trans", Class::Material),
    plain("dielectric", Class::Material),
    plain("interface", Class::Material),
    plain("glow", Class::Material),
    plain("light", Class::Material),
    plain("illum", Class::Material),
    plain("spotlight", Class::Material),
    plain("mirror", Class::Material),
    plain("mist", Class::Material),
    plain("antimatter", Class::Material),
    function("BSDF", Class::Material),
    function("aBSDF", Class::Material),
    function("plastic2", Class::Material),
    function("metal2", Class::Material),
    function("trans2", Class::Material),
    function("ashik2", Class::Material),
    function("plasfunc", Class::Material),
    function("metfunc", Class::Material),
    function("transfunc", Class::Material),
    function("BRTDfunc", Class::Material),
    function("WGMDfunc", Class::Material),
    function("plasdata", Class::Material),
    function("metdata", Class::Material),
    function("transdata", Class::Material),
    function("prism1", Class::Material),
    function("prism2", Class::Material),
    function("brightfunc", Class::Pattern),
    function("brightdata", Class::Pattern),
    plain("brighttext", Class::Pattern),
    function("colorfunc", Class::Pattern),
    function("colordata", Class::Pattern),
    function("colorpict", Class::Pattern),
    plain("colortext", Class::Pattern),
    plain("spectrum", Class::Pattern),
    plain("specfile", Class::Pattern),
    function("specfunc", Class::Pattern),
    function("specdata", Class::Pattern),
    function("specpict", Class::Pattern),
    function("texfunc", Class::Texture),
    function("texdata", Class::Texture),
    function("mixfunc", Class::Mixture),
    function("mixdata", Class::Mixture),
    plain("mixtext", Class::Mixture),
    function("mixpict", Class::Mixture),
];
