//! From what the scene files say to what the renderer asks.

use super::portals::{NamedPortals, openings, windows};
use super::{Facing, Object, World};
use crate::WorldOptions;
use crate::accel::{Accel, Geometry, Primitive};
use crate::backlight::Backlights;
use crate::guide::{Guide, ScatteredSun};
use crate::light::{Distant, DistantSources, Lamp, LampShape, Lamps};
use crate::material::{
    Alternate, Antimatter, Ashikhmin, Dielectric, Emitter, EmitterKind, Glass, Material, MaterialId, Mirror,
    Mist, Mixture, Modifiers, Prism, Step, Table, Varying, WardMaterial, WgmdMaterial, stands_for_geometry,
};
use crate::shapes::{Analytic, Cone, MeshSurface, Polygon, Ring, Sphere, Triangle};
use crate::sunlit::SunPatches;
use std::{collections::HashMap, path::Path, sync::Arc};
use sunpeak_bsdf::{Bsdf, PeakRule};
use sunpeak_core::{Error, Frame, Location, Result, Vec3};
use sunpeak_scene::{
    BsdfMaterial, ComponentModifier, Material as Said, Mesh, ModifierId, ModifierKind, Orientation, Scene,
    Shape, Surface,
};

/// Modifiers may name each other this deep; more is a circle.
const MAX_MODIFIER_DEPTH: usize = 100;

/// Triangles of a mesh that shadow rays look for one by one.
const MAX_LAMPS_OF_MESH: usize = 64;

pub(super) fn compile(scene: &Scene, options: &WorldOptions) -> Result<World> {
    let mut compiler = Compiler::new(scene, options);
    for (index, surface) in scene.surfaces.iter().enumerate() {
        compiler.current = index as u32;
        compiler.portals.add(scene, surface);
        compiler.add(surface)?;
    }
    compiler.finish()
}

struct Compiler<'s> {
    scene: &'s Scene,
    options: &'s WorldOptions,
    bsdfs: HashMap<&'s Path, Arc<Bsdf>>,
    materials: Vec<Material>,
    compiled: HashMap<ModifierId, Alternate>,
    objects: Vec<Object>,
    primitives: Vec<Primitive>,
    analytic: Vec<Analytic>,
    sources: Vec<Distant>,
    lamps: Vec<Lamp>,
    mirrors: Vec<u32>,
    prisms: Vec<(u32, Vec3)>,
    /// Pieces of shades, each with its object.
    shades: Vec<(u32, Triangle)>,
    /// Flat pieces of glass, likewise.
    panes: Vec<(u32, Triangle)>,
    /// Holes of opaque polygons, each with its polygon.
    holes: Vec<(u32, Vec<Triangle>)>,
    /// What the caller has named.
    portals: NamedPortals<'s>,
    meshes: Vec<MeshSurface>,
    /// Of each object: where its modifier stands in the scene. Of surfaces at the same place the later is seen.
    ranks: Vec<u32>,
    /// Of each object: which surface of the scene it is.
    surfaces: Vec<u32>,
    /// The surface that is being taken in.
    current: u32,
}

impl<'s> Compiler<'s> {
    fn new(scene: &'s Scene, options: &'s WorldOptions) -> Self {
        Self {
            scene,
            options,
            bsdfs: options.loaded.iter().map(|(path, bsdf)| (path.as_path(), bsdf.clone())).collect(),
            materials: Vec::new(),
            compiled: HashMap::new(),
            objects: Vec::new(),
            primitives: Vec::new(),
            analytic: Vec::new(),
            sources: Vec::new(),
            lamps: Vec::new(),
            mirrors: Vec::new(),
            prisms: Vec::new(),
            shades: Vec::new(),
            panes: Vec::new(),
            holes: Vec::new(),
            portals: NamedPortals::new(&options.portals),
            meshes: Vec::new(),
            ranks: Vec::new(),
            surfaces: Vec::new(),
            current: 0,
        }
    }

    fn finish(mut self) -> Result<World> {
        let distant = DistantSources::new(std::mem::take(&mut self.sources));
        let is_volume = |m: &Material| matches!(m, Material::Mist(_) | Material::Antimatter(_));
        let has_volumes = self.materials.iter().any(is_volume);
        let suns = self.scattered_suns(&distant);
        let mut world = World {
            accel: Accel::build(self.primitives, self.analytic)?,
            objects: self.objects,
            surfaces: self.surfaces,
            materials: self.materials,
            distant,
            lamps: Lamps::new(self.lamps),
            mirrors: self.mirrors,
            prisms: self.prisms,
            rule: self.options.peak,
            guide: None,
            sun_patches: None,
            backlights: Default::default(),
            meshes: self.meshes,
            has_volumes,
        };
        world.backlights = Backlights::find(&world, &self.shades);
        let shades = self.shades.iter().map(|&(_, triangle)| triangle);
        let portals =
            self.portals.with(shades.chain(windows(&world, &self.panes)), openings(&world, &self.holes))?;
        let patches = SunPatches::new(&world, &portals);
        world.guide = Guide::new(portals, suns);
        world.sun_patches = patches.filter(|patches| patches.count(&world));
        Ok(world)
    }

    /// Each sun that shades of each table and orientation scatter.
    fn scattered_suns(&self, distant: &DistantSources) -> Vec<ScatteredSun> {
        let mut found: Vec<ScatteredSun> = Vec::new();
        for &(object, _) in &self.shades {
            let Object { material, facing: Facing::Flat(normal), .. } = self.objects[object as usize] else {
                continue;
            };
            for id in self.seen_materials(material) {
                let Material::Table(table) = &self.materials[id.0 as usize] else { continue };
                let suns = distant.suns().iter().map(|&sun| distant.get(sun).direction());
                for sun in suns.filter_map(|sun| ScatteredSun::new(table, normal, sun)) {
                    if !found.iter().any(|known| known.is_like(&sun)) {
                        found.push(sun);
                    }
                }
            }
        }
        found
    }

    fn add(&mut self, surface: &'s Surface) -> Result<()> {
        let Some(modifier) = surface.modifier else { return Ok(()) };
        let Some(material) = self.material(modifier, &surface.location, 0)? else { return Ok(()) };
        match &surface.shape {
            Shape::Source { direction, angle_deg } => self.add_source(material, *direction, *angle_deg),
            Shape::Polygon(vertices) => self.add_polygon(surface, material, vertices)?,
            &Shape::Sphere { center, radius, inward } => {
                let sphere = Sphere { center, radius, inward };
                self.add_analytic(surface, material, Analytic::Sphere(sphere), LampShape::Sphere(sphere))?;
            }
            &Shape::Cone { start, end, start_radius, end_radius, inward } => {
                if let Some(cone) = Cone::new(start, end, start_radius, end_radius, inward) {
                    self.add_analytic(surface, material, Analytic::Cone(cone), LampShape::Cone(cone))?;
                }
            }
            &Shape::Ring { center, normal, inner_radius, outer_radius } => {
                let ring = Ring { center, normal, inner_radius, outer_radius };
                self.add_analytic(surface, material, Analytic::Ring(ring), LampShape::Ring(ring))?;
            }
            Shape::Mesh(mesh) => self.add_mesh(surface, material, mesh)?,
        }
        Ok(())
    }

    /// Only emitters shine from infinity; any other material of a `source` is nothing, as in Radiance.
    fn add_source(&mut self, material: MaterialId, direction: Vec3, angle_deg: f64) {
        if let Material::Emitter(emitter) = &self.materials[material.0 as usize] {
            let (emitter, surface) = (emitter.clone(), self.current);
            self.sources.push(Distant::new(direction, angle_deg, emitter, surface));
        }
    }

    fn add_polygon(&mut self, surface: &Surface, material: MaterialId, vertices: &[Vec3]) -> Result<()> {
        if vertices.iter().any(|v| !v.is_finite()) {
            return Err(Error::input(surface.location.clone(), "a vertex is not a finite number"));
        }
        // A polygon without area is nothing, as in Radiance.
        let Some(polygon) = Polygon::new(vertices.to_vec()) else { return Ok(()) };
        let normal = polygon.normal;
        let object = self.add_object(surface, material, Facing::Flat(normal))?;
        match polygon.triangulate() {
            Some(triangles) => {
                self.add_lamp(object, material, LampShape::triangles(triangles.clone(), normal));
                if self.is_any(material, Material::is_shade) {
                    self.shades.extend(triangles.iter().map(|&triangle| (object, triangle)));
                }
                if matches!(self.materials[material.0 as usize], Material::Glass(_)) {
                    self.panes.extend(triangles.iter().map(|&triangle| (object, triangle)));
                }
                if self.objects[object as usize].is_wall {
                    self.holes.extend(polygon.holes().into_iter().map(|hole| (object, hole)));
                }
                triangles.into_iter().for_each(|t| self.add_primitive(object, Geometry::Triangle(t)));
            }
            None => self.add_shape(object, Analytic::Polygon(polygon)),
        }
        Ok(())
    }

    /// Each triangle is an object of its own: it has its own normals.
    fn add_mesh(&mut self, surface: &Surface, material: MaterialId, mesh: &Mesh) -> Result<()> {
        if mesh.vertices.iter().any(|v| !v.is_finite()) {
            return Err(Error::input(
                surface.location.clone(),
                "a vertex of the mesh is not a finite number",
            ));
        }
        let index = self.meshes.len() as u32;
        let has_more = MeshSurface::is_one(mesh);
        if has_more {
            self.meshes.push(MeshSurface(mesh.clone()));
        }
        // Light from more triangles than this is left to paths.
        let are_lamps = mesh.triangles.len() <= MAX_LAMPS_OF_MESH;
        let is_shade = self.is_any(material, Material::is_shade);
        for (i, corners) in mesh.triangles.iter().enumerate() {
            let triangle = Triangle(corners.map(|i| mesh.vertices[i as usize]));
            let Some(normal) = triangle.area_vector().try_normalize() else { continue };
            let facing = match has_more {
                true => Facing::Mesh { mesh: index, triangle: i as u32 },
                false => Facing::Flat(normal),
            };
            let object = self.add_object(surface, material, facing)?;
            if are_lamps {
                self.add_lamp(object, material, LampShape::triangles(vec![triangle], normal));
            }
            if is_shade {
                self.shades.push((object, triangle));
            }
            self.add_primitive(object, Geometry::Triangle(triangle));
        }
        Ok(())
    }

    fn add_analytic(
        &mut self,
        surface: &Surface,
        material: MaterialId,
        shape: Analytic,
        lamp: LampShape,
    ) -> Result<()> {
        let bounds = shape.bounds();
        if !(bounds.min.is_finite() && bounds.max.is_finite()) {
            return Err(Error::input(
                surface.location.clone(),
                "a coordinate or radius is not a finite number",
            ));
        }
        let facing = match &shape {
            Analytic::Ring(ring) => Facing::Flat(ring.normal),
            _ => Facing::Curved(self.analytic.len() as u32),
        };
        let object = self.add_object(surface, material, facing)?;
        self.add_lamp(object, material, Some(lamp));
        self.add_shape(object, shape);
        Ok(())
    }

    fn add_shape(&mut self, object: u32, shape: Analytic) {
        self.add_primitive(object, Geometry::Analytic(self.analytic.len() as u32));
        self.analytic.push(shape);
    }

    fn add_primitive(&mut self, object: u32, geometry: Geometry) {
        let material = self.objects[object as usize].material;
        let is_opaque = !self.is_any(material, Material::is_transparent);
        self.primitives.push(Primitive { geometry, object, is_opaque, rank: self.ranks[object as usize] });
    }

    fn add_object(&mut self, surface: &Surface, material: MaterialId, facing: Facing) -> Result<u32> {
        let object = self.objects.len() as u32;
        for id in self.seen_materials(material) {
            match (&self.materials[id.0 as usize], facing) {
                (Material::Table(Table { up: Orientation::Fixed(up), .. }), Facing::Flat(normal))
                    if Frame::from_normal_up(normal, *up).is_none() =>
                {
                    let message =
                        format!("the BSDF's up vector {up} runs along the surface's normal; give one across");
                    return Err(Error::input(surface.location.clone(), message));
                }
                (Material::Mirror(_), Facing::Flat(_)) => self.mirrors.push(object),
                (Material::Prism(_), Facing::Flat(_)) => self.prisms.push((object, a_point(&surface.shape))),
                _ => {}
            }
        }
        self.surfaces.push(self.current);
        self.ranks.push(surface.modifier.map_or(0, |id| id.0 as u32));
        let is_wall = self.materials[material.0 as usize].is_wall();
        self.objects.push(Object { material, is_wall, facing, lamp: None });
        Ok(object)
    }

    /// The materials that may be seen of this one: several of a mixture.
    fn seen_materials(&self, id: MaterialId) -> Vec<MaterialId> {
        match &self.materials[id.0 as usize] {
            Material::Varying(varying) => varying.materials(),
            _ => vec![id],
        }
    }

    fn is_any(&self, id: MaterialId, test: impl Fn(&Material) -> bool) -> bool {
        let has_gaps = matches!(&self.materials[id.0 as usize], Material::Varying(v) if v.has_gaps());
        has_gaps || self.seen_materials(id).into_iter().any(|id| test(&self.materials[id.0 as usize]))
    }

    fn add_lamp(&mut self, object: u32, material: MaterialId, shape: Option<LampShape>) {
        let (Material::Emitter(emitter), Some(shape)) = (&self.materials[material.0 as usize], shape) else {
            return;
        };
        if emitter.illuminates() {
            self.objects[object as usize].lamp = Some(self.lamps.len() as u32);
            self.lamps.push(Lamp { object, emitter: emitter.clone(), shape });
        }
    }

    /// The material that a modifier comes down to; `None` if the chain ends in `void` without one.
    fn material(&mut self, id: ModifierId, user: &Location, depth: usize) -> Result<Alternate> {
        if let Some(&done) = self.compiled.get(&id) {
            return Ok(done);
        }
        if depth > MAX_MODIFIER_DEPTH {
            return Err(Error::input(user.clone(), "the modifiers of this surface go round in a circle"));
        }
        let compiled = self.compile_chain(id, user, depth)?;
        self.compiled.insert(id, compiled);
        Ok(compiled)
    }

    /// Patterns, textures and mixtures before and behind the material of the chain all count for it.
    fn compile_chain(&mut self, id: ModifierId, user: &Location, depth: usize) -> Result<Alternate> {
        let (varying, emitter) = self.varying(id, user, depth)?;
        let material = match (varying.material, varying.steps.is_empty() || emitter) {
            (None, _) if !varying.mixes_materials => None,
            (material, true) => material,
            _ => Some(self.push(Material::Varying(varying))),
        };
        Ok(material)
    }

    /// A chain of modifiers, and whether its material is an emitter, which holds its patterns itself.
    fn varying(&mut self, id: ModifierId, user: &Location, depth: usize) -> Result<(Varying, bool)> {
        let mut varying = Varying::default();
        let mut said: Option<(&'s Said, &'s Location)> = None;
        // Patterns and textures before the material.
        let mut before = 0;
        let mut next = Some(id);
        let mut steps = 0;
        while let Some(id) = next {
            let Some(modifier) = self.scene.modifiers.get(id.0).filter(|_| steps <= MAX_MODIFIER_DEPTH)
            else {
                return Err(Error::input(user.clone(), "the modifiers of this surface do not end in void"));
            };
            steps += 1;
            match &modifier.kind {
                ModifierKind::Pattern(pattern) => varying.steps.push(Step::Pattern(pattern.clone())),
                ModifierKind::Texture(field) => varying.steps.push(Step::Texture(field.clone())),
                ModifierKind::Mixture { fore, back, weight } => {
                    let [fore, back] = [*fore, *back].map(|part| self.part(part, user, depth + 1));
                    let mixture = Mixture { fore: fore?, back: back?, weight: weight.clone() };
                    varying.mixes_materials |= mixture.mixes_materials();
                    varying.steps.push(Step::Mixture(Box::new(mixture)));
                }
                ModifierKind::Material(material) if said.is_none() => {
                    said = Some((material, &modifier.location));
                    before = varying.steps.len();
                }
                ModifierKind::Material(_) => {
                    let message = format!(
                        "material \"{}\" modifies another material; only patterns, textures and mixtures can",
                        modifier.name
                    );
                    return Err(Error::input(modifier.location.clone(), message));
                }
            }
            next = modifier.parent;
        }
        let Some((said, location)) = said else { return Ok((varying, false)) };
        if varying.mixes_materials {
            let message = "a mixture of materials and another material: a surface can have only one";
            return Err(Error::input(location.clone(), message));
        }
        let emitter = self.compile_emitter(said, &varying.steps, location, depth)?;
        let is_emitter = emitter.is_some();
        let material = match (emitter, said) {
            (Some(emitter), _) => Material::Emitter(emitter),
            (None, Said::Wgmd(wgmd)) => {
                let own = varying.steps.split_off(before);
                Material::Wgmd(self.compile_wgmd(wgmd, own, location, depth)?)
            }
            (None, _) => self.compile_material(said, location, depth)?,
        };
        varying.material = Some(self.push(material));
        Ok((varying, is_emitter))
    }

    /// One side of a mixture.
    fn part(&mut self, id: Option<ModifierId>, user: &Location, depth: usize) -> Result<Varying> {
        let Some(id) = id else { return Ok(Varying::default()) };
        if depth > MAX_MODIFIER_DEPTH {
            return Err(Error::input(user.clone(), "the modifiers of this surface go round in a circle"));
        }
        let (mut varying, is_emitter) = self.varying(id, user, depth)?;
        if is_emitter {
            // It holds its patterns itself.
            varying.steps.clear();
        }
        Ok(varying)
    }

    fn push(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId(self.materials.len() as u32 - 1)
    }

    fn compile_material(&mut self, said: &'s Said, location: &Location, depth: usize) -> Result<Material> {
        Ok(match said {
            Said::Plastic(ward) => Material::Ward(WardMaterial::opaque(ward, false)),
            Said::Metal(ward) => Material::Ward(WardMaterial::opaque(ward, true)),
            Said::Trans { ward, transmissivity, specular_transmission } => {
                Material::Ward(WardMaterial::trans(ward, *transmissivity, *specular_transmission))
            }
            &Said::Glass { transmissivity, index } => {
                Material::Glass(Glass::new(transmissivity, checked_index(index, location)?))
            }
            &Said::Dielectric { transmission, index, hartmann } => {
                Material::Dielectric(Dielectric::new(transmission, checked_index(index, location)?, hartmann))
            }
            Said::Interface { inside, outside } => {
                Material::Dielectric(Dielectric::interface(inside, outside))
            }
            Said::Ashikhmin { diffuse, specular, powers, orientation } => Material::Ashikhmin(Ashikhmin {
                diffuse: *diffuse,
                specular: *specular,
                powers: *powers,
                orientation: orientation.clone(),
            }),
            &Said::Mist { extinction, albedo, eccentricity, .. } => {
                Material::Mist(Mist { extinction, albedo, eccentricity })
            }
            Said::Antimatter { clipped, face } => {
                let mut materials = Vec::new();
                for &id in clipped {
                    materials.extend(self.alternate(Some(id), location, depth)?);
                }
                let face = self.alternate(*face, location, depth)?;
                Material::Antimatter(Antimatter { clipped: materials, face })
            }
            Said::Mirror { reflectance, alternate } => {
                let alternate = match alternate {
                    None => None,
                    Some(named) => Some(self.alternate(*named, location, depth)?),
                };
                Material::Mirror(Mirror { reflectance: *reflectance, alternate })
            }
            Said::Bsdf(bsdf) => Material::Table(self.compile_table(bsdf)?),
            Said::Function(function) => Material::Function(function.clone()),
            Said::Prism { field, ways } => Material::Prism(Prism { field: field.clone(), ways: *ways }),
            Said::Light(_)
            | Said::Illum { .. }
            | Said::Glow { .. }
            | Said::Spotlight { .. }
            | Said::Wgmd(_) => {
                return Err(Error::input(location.clone(), "a material that is compiled elsewhere"));
            }
        })
    }

    /// What stands before the material modifies all of it, its `own` modifiers only the components that say so.
    fn compile_wgmd(
        &mut self,
        said: &sunpeak_scene::WgmdMaterial,
        own: Vec<Step>,
        location: &Location,
        depth: usize,
    ) -> Result<WgmdMaterial> {
        let mut steps = |modifier: ComponentModifier| match modifier {
            ComponentModifier::Own => Ok(None),
            ComponentModifier::Named(id) => Ok(Some(self.part(id, location, depth + 1)?.steps)),
        };
        let modifiers = Modifiers {
            reflection: steps(said.reflection_modifier)?,
            transmission: steps(said.transmission_modifier)?,
            diffuse_transmission: steps(said.diffuse_transmission_modifier)?,
            own,
        };
        Ok(WgmdMaterial::new(said, modifiers))
    }

    fn compile_emitter(
        &mut self,
        said: &Said,
        steps: &[Step],
        location: &Location,
        depth: usize,
    ) -> Result<Option<Emitter>> {
        let (radiance, kind) = match said {
            Said::Light(radiance) => (*radiance, EmitterKind::Light),
            Said::Illum { radiance, alternate } => {
                let alternate = self.alternate(alternate.flatten(), location, depth)?;
                (*radiance, EmitterKind::Illum { alternate })
            }
            &Said::Glow { radiance, max_radius } => (radiance, EmitterKind::Glow { max_radius }),
            Said::Spotlight { radiance, angle_deg, axis } => {
                let Some(unit) = axis.try_normalize() else {
                    return Err(Error::input(location.clone(), "the spotlight's axis has no direction"));
                };
                let edge_cosine = (0.5 * angle_deg.to_radians()).cos();
                (*radiance, EmitterKind::Spotlight { axis: unit, edge_cosine, focal_length: axis.length() })
            }
            _ => return Ok(None),
        };
        // An emitter has no use for its normal.
        let patterns = steps.iter().filter(|step| !matches!(step, Step::Texture(_))).cloned().collect();
        Ok(Some(Emitter { radiance, patterns, kind }))
    }

    fn alternate(
        &mut self,
        named: Option<ModifierId>,
        location: &Location,
        depth: usize,
    ) -> Result<Alternate> {
        named.map_or(Ok(None), |id| self.material(id, location, depth + 1))
    }

    fn compile_table(&mut self, said: &'s BsdfMaterial) -> Result<Table> {
        let rule = match self.options.peak {
            rule if said.extract_peak => rule,
            PeakRule::Split if stands_for_geometry(&said.thickness) => PeakRule::Split,
            _ => PeakRule::Off,
        };
        Ok(Table {
            bsdf: self.bsdf(&said.file)?,
            is_aperture: said.extract_peak,
            thickness: said.thickness.clone(),
            rule,
            up: said.up.clone(),
            mirrored: said.mirrored,
            front_diffuse: said.front_diffuse,
            back_diffuse: said.back_diffuse,
            diffuse_transmission: said.diffuse_transmission,
        })
    }

    /// Each file is read once.
    fn bsdf(&mut self, file: &'s Path) -> Result<Arc<Bsdf>> {
        if let Some(bsdf) = self.bsdfs.get(file) {
            return Ok(bsdf.clone());
        }
        let bsdf = Arc::new(Bsdf::load(file)?);
        self.bsdfs.insert(file, bsdf.clone());
        Ok(bsdf)
    }
}

/// Some point of a flat surface.
fn a_point(shape: &Shape) -> Vec3 {
    match shape {
        Shape::Polygon(vertices) => vertices.iter().sum::<Vec3>() / vertices.len().max(1) as f64,
        Shape::Ring { center, .. } => *center,
        _ => Vec3::ZERO,
    }
}

fn checked_index(index: f64, location: &Location) -> Result<f64> {
    if index >= 1.0 {
        return Ok(index);
    }
    Err(Error::input(location.clone(), format!("the index of refraction is {index}; it must be at least 1")))
}
