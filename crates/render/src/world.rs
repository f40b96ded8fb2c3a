//! A scene compiled for rendering.

mod compile;
mod portals;

use crate::WorldOptions;
use crate::accel::{Accel, Hit};
use crate::backlight::Backlights;
use crate::guide::Guide;
use crate::light::{DistantSources, Lamps};
use crate::material::{
    Air, Alternate, Arrival, Emitter, EmitterKind, Inside, Material, MaterialId, Plain, Prism, fault_of,
    fault_of_orientation,
};
use crate::shapes::{COINCIDENT, MeshSurface, Ray};
use crate::sunlit::SunPatches;
use sunpeak_bsdf::PeakRule;
use sunpeak_core::{Result, Rgb, Vec3};
use sunpeak_scene::Scene;

/// Materials that show others in their place: so many in a row.
const MAX_ALTERNATES: usize = 100;

/// Surfaces in one hierarchy, materials and emitters. Immutable, shared by all threads.
#[derive(Debug)]
pub struct World {
    pub(crate) accel: Accel,
    pub(crate) objects: Vec<Object>,
    /// Of each object: which surface of the scene it is.
    pub(crate) surfaces: Vec<u32>,
    pub(crate) materials: Vec<Material>,
    pub(crate) distant: DistantSources,
    pub(crate) lamps: Lamps,
    /// Objects that are planar mirrors.
    pub(crate) mirrors: Vec<u32>,
    /// Objects that are prisms, and a point of each.
    pub(crate) prisms: Vec<(u32, Vec3)>,
    pub(crate) rule: PeakRule,
    /// Where diffuse surfaces look for light, if there are shades.
    pub(crate) guide: Option<Guide>,
    /// Where the sun comes in, if it does.
    pub(crate) sun_patches: Option<SunPatches>,
    /// What shades give off in the light of sky and ground.
    pub(crate) backlights: Backlights,
    /// Meshes with normals or local coordinates at their vertices.
    pub(crate) meshes: Vec<MeshSurface>,
    /// Is there mist or antimatter?
    pub(crate) has_volumes: bool,
}

/// A surface of the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Object {
    pub material: MaterialId,
    /// Does it let nothing pass straight, wherever it is met ([`Material::is_wall`])?
    pub is_wall: bool,
    pub facing: Facing,
    /// Index among the lamps.
    pub lamp: Option<u32>,
}

/// Where the normal comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Facing {
    /// The same all over.
    Flat(Vec3),
    /// From an analytic shape.
    Curved(u32),
    /// From a triangle of a mesh, which has local coordinates or normals to interpolate.
    Mesh { mesh: u32, triangle: u32 },
}

/// What a path meets at a surface.
pub(crate) enum Seen<'w> {
    /// Nothing: the surface is invisible to this ray.
    Void,
    /// A source of light.
    Emitter(&'w Emitter),
    /// A surface that scatters.
    Surface(&'w Material),
}

impl World {
    /// Compile a scene: triangulate, load BSDF files, build the hierarchy, find the emitters.
    ///
    /// # Errors
    /// Where the scene asks for something that cannot be rendered: the place in the file and what to do.
    pub fn compile(scene: &Scene, options: &WorldOptions) -> Result<Self> {
        compile::compile(scene, options)
    }

    /// Number of surfaces that rays can hit.
    pub fn surface_count(&self) -> usize {
        self.objects.len()
    }

    /// The rule by which `aBSDF` materials pass light straight.
    pub fn peak_rule(&self) -> PeakRule {
        self.rule
    }

    pub(crate) fn object(&self, hit: &Hit) -> &Object {
        &self.objects[hit.object as usize]
    }

    pub(crate) fn material(&self, id: MaterialId) -> &Material {
        &self.materials[id.0 as usize]
    }

    /// The normal and the lobes of an object that is plain. There is nothing more to be told where a ray meets it: it is no boundary of
    /// a volume, and no pattern tints it.
    pub(crate) fn plain(&self, hit: &Hit) -> Option<(Vec3, Plain<'_>)> {
        let object = self.object(hit);
        let Facing::Flat(normal) = object.facing else { return None };
        let Material::Ward(ward) = self.material(object.material) else { return None };
        ward.plain().filter(|_| !self.has_volumes).map(|plain| (normal, plain))
    }

    pub(crate) fn arrival(&self, hit: &Hit, ray: &Ray) -> Arrival {
        let point = ray.at(hit.t);
        let normal = match self.object(hit).facing {
            Facing::Flat(normal) => normal,
            Facing::Curved(shape) => self.accel.shape(shape).normal(point),
            Facing::Mesh { mesh, triangle } => {
                let (normal, bent, local) = self.meshes[mesh as usize].at(triangle, point);
                let (distance, travelled) = (hit.t, hit.t);
                let flat =
                    Arrival { local, distance, travelled, ..Arrival::new(point, normal, ray.direction) };
                return bent.map_or(flat, |bent| flat.smoothed(bent));
            }
        };
        Arrival { distance: hit.t, travelled: hit.t, ..Arrival::new(point, normal, ray.direction) }
    }

    /// The same of a path that has come so far before: since it was last scattered, and since the camera [m].
    pub(crate) fn arrival_after(&self, way: [f64; 2], hit: &Hit, ray: &Ray) -> Arrival {
        self.arrival(hit, ray).after(way.map(|way| way + hit.t))
    }

    /// What a path that is in these volumes meets where it has arrived at an object; they change where it passes a boundary, and the
    /// arrival where patterns, textures, mixtures or a cut have a say. `choose` gives random numbers in [0, 1), for mixtures.
    pub(crate) fn meet(
        &self,
        object: u32,
        arrival: &mut Arrival,
        view: bool,
        inside: &mut Inside,
        choose: &mut dyn FnMut() -> f64,
    ) -> Seen<'_> {
        let object = &self.objects[object as usize];
        let seen = match self.meet_volume(object, arrival, inside) {
            Some(seen) => seen,
            None => self.seen(object.material, arrival, view),
        };
        self.resolved(seen, arrival, view, choose)
    }

    /// Boundaries of volumes and what they hide; `None` for all other surfaces.
    pub(crate) fn meet_volume(
        &self,
        object: &Object,
        arrival: &mut Arrival,
        inside: &mut Inside,
    ) -> Option<Seen<'_>> {
        if !self.has_volumes {
            return None;
        }
        let (id, at_front) = (object.material, arrival.at_front());
        match self.material(id) {
            Material::Antimatter(antimatter) if !at_front && inside.is_in_clipped(id) => {
                // The ray has come into a solid that does not exist here, and now it does: the cut face.
                if antimatter.face.is_some() {
                    *arrival = arrival.turned();
                    return Some(self.alternate(antimatter.face));
                }
                inside.leave(id);
            }
            Material::Mist(_) | Material::Antimatter(_) if at_front => inside.enter(id),
            Material::Mist(_) | Material::Antimatter(_) => inside.leave(id),
            _ => {
                let clips = |volume: &MaterialId| match self.material(*volume) {
                    Material::Antimatter(antimatter) => antimatter.clipped.contains(&id),
                    _ => false,
                };
                let clipping = inside.volumes().find(clips)?;
                inside.cross_clipped(clipping, at_front);
            }
        }
        Some(Seen::Void)
    }

    /// The air in these volumes, if there is mist.
    pub(crate) fn air(&self, inside: &Inside) -> Option<Air> {
        if inside.is_empty() {
            return None;
        }
        Air::of(inside.volumes().filter_map(|volume| match self.material(volume) {
            Material::Mist(mist) => Some(mist),
            _ => None,
        }))
    }

    /// The mists that a point is in: closed surfaces that a ray from there leaves more often than it enters them.
    pub(crate) fn inside_at(&self, ray: &Ray) -> Inside {
        let mut inside = Inside::default();
        if !self.has_volumes {
            return inside;
        }
        let mut crossings: Vec<(Hit, bool)> = Vec::new();
        self.accel.each_crossing(ray, f64::INFINITY, |hit| {
            let is_mist = matches!(self.material(self.object(&hit).material), Material::Mist(_));
            let is_seam = |(h, _): &(Hit, bool)| h.object == hit.object && (h.t - hit.t).abs() <= COINCIDENT;
            if is_mist && !crossings.iter().any(is_seam) {
                crossings.push((hit, self.arrival(&hit, ray).at_front()));
            }
            true
        });
        crossings.sort_by(|(a, _), (b, _)| a.t.total_cmp(&b.t));
        // From far away back to the point.
        for (hit, at_front) in crossings.into_iter().rev() {
            let volume = self.object(&hit).material;
            if at_front { inside.leave(volume) } else { inside.enter(volume) }
        }
        inside
    }

    /// What a path sees. `view`: it comes from the camera and met only mirrors and clear panes.
    /// Patterns, textures and mixtures are still to be [`Self::resolved`].
    fn seen(&self, id: MaterialId, arrival: &Arrival, view: bool) -> Seen<'_> {
        match self.material(id) {
            Material::Emitter(emitter) => match emitter.kind {
                EmitterKind::Illum { alternate } if view || !arrival.at_front() => self.alternate(alternate),
                _ => Seen::Emitter(emitter),
            },
            Material::Mirror(mirror) => match mirror.alternate {
                Some(alternate) if view || !arrival.at_front() || self.is_transparent(alternate) => {
                    self.alternate(alternate)
                }
                _ => Seen::Surface(self.material(id)),
            },
            Material::Table(table) if table.is_passed(arrival, view) => Seen::Void,
            material => Seen::Surface(material),
        }
    }

    /// Evaluate patterns, textures and mixtures; they change the arrival.
    fn resolved<'w>(
        &'w self,
        mut seen: Seen<'w>,
        arrival: &mut Arrival,
        view: bool,
        choose: &mut dyn FnMut() -> f64,
    ) -> Seen<'w> {
        // What varies may show an alternate that varies, but not for ever.
        for _ in 0..MAX_ALTERNATES {
            let Seen::Surface(Material::Varying(varying)) = seen else { return seen };
            let (material, modulation) = varying.at(&arrival.ray_state(), choose);
            *arrival = arrival.modulated(&modulation);
            seen = material.map_or(Seen::Void, |id| self.seen(id, arrival, view));
        }
        Seen::Void
    }

    /// Reflectance of an object that is a mirror, where a ray meets it.
    pub(crate) fn mirror_reflectance(&self, hit: &Hit, ray: &Ray) -> Rgb {
        match self.material(self.object(hit).material) {
            Material::Mirror(mirror) => mirror.reflectance,
            Material::Varying(varying) => {
                let mut sum = Rgb::ZERO;
                varying.each(&self.arrival(hit, ray).ray_state(), &mut |share, id, modulation| {
                    if let Some(Material::Mirror(mirror)) = id.map(|id| self.material(id)) {
                        sum += mirror.reflectance * modulation.tint * share;
                    }
                });
                sum
            }
            _ => Rgb::ZERO,
        }
    }

    /// The prism that an object is.
    pub(crate) fn prism(&self, object: u32) -> Option<&Prism> {
        let id = self.objects[object as usize].material;
        let prism = |id: MaterialId| match self.material(id) {
            Material::Prism(prism) => Some(prism),
            _ => None,
        };
        match self.material(id) {
            Material::Varying(varying) => varying.materials().into_iter().find_map(prism),
            _ => prism(id),
        }
    }

    /// What is wrong with an expression of the scene, if an evaluation has found that out.
    pub(crate) fn check_expressions(&self) -> Result<()> {
        let fault = |material: &Material| match material {
            Material::Varying(varying) => varying.fault(),
            Material::Emitter(emitter) => fault_of(&emitter.patterns),
            Material::Ward(ward) => ward.fault(),
            Material::Ashikhmin(m) => fault_of_orientation(&m.orientation),
            Material::Table(table) => table.fault(),
            Material::Function(function) => function.field.fault(),
            Material::Wgmd(wgmd) => wgmd.fault(),
            Material::Prism(prism) => prism.field.fault(),
            _ => None,
        };
        self.materials.iter().find_map(fault).map_or(Ok(()), Err)
    }

    fn alternate(&self, alternate: Alternate) -> Seen<'_> {
        match alternate.map(|id| self.material(id)) {
            None => Seen::Void,
            Some(Material::Emitter(emitter)) => Seen::Emitter(emitter),
            Some(material) => Seen::Surface(material),
        }
    }

    fn is_transparent(&self, alternate: Alternate) -> bool {
        alternate.is_none_or(|id| self.material(id).is_transparent())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunpeak_core::{Sampler, warp};
    use sunpeak_scene::LoadOptions;

    #[test]
    fn walls_let_nothing_pass_straight() {
        let materials = [
            ("plastic", "0 0 5 .5 .4 .3 .05 .1", true, false),
            ("plastic", "0 0 5 .5 .4 .3 .05 0", true, false),
            ("metal", "0 0 5 .5 .4 .3 .9 .2", true, false),
            ("plastic2", "4 0 0 1 . 0 6 .5 .4 .3 .05 .1 .2", true, false),
            ("ashik2", "4 0 0 1 . 0 8 .2 .2 .2 .1 .1 .1 20 40", true, false),
            ("trans", "0 0 7 .5 .4 .3 .05 0 .5 .5", false, true),
            ("trans", "0 0 7 .5 .4 .3 .05 .1 .5 .5", false, false),
            ("glass", "0 0 3 .9 .9 .9", false, true),
            ("mirror", "0 0 3 .9 .9 .9", false, false),
        ];
        for (kind, arguments, is_wall, lets_pass) in materials {
            let text = format!("void {kind} m {arguments}\nm polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n");
            let scene = Scene::parse(&text, "material.rad", &LoadOptions::default()).expect("parses");
            let world = World::compile(&scene, &Default::default()).expect("compiles");
            assert_eq!(world.objects[0].is_wall, is_wall, "{kind} {arguments}");
            let material = world.material(world.objects[0].material);
            let mut passes = false;
            for i in 0..100 {
                let direction = warp::uniform_sphere(Sampler::new(0, 0, i).next_2d());
                let arrival = Arrival::new(Vec3::ZERO, Vec3::Z, direction);
                for direct in [true, false] {
                    passes |= material.straight(&arrival, direct) != Rgb::ZERO;
                }
            }
            assert_eq!(passes, lets_pass, "{kind} {arguments}");
        }
    }
}
