//! What there is: lights, surfaces, a camera, and how they come to be.
//!
//! Coordinates are f32 metres relative to an f64 [`Scene::origin`], +z up. Units are photometric.

pub mod camera;
pub mod cutoff;
pub mod light;
pub mod light_sampling;
pub(crate) mod needs;
pub mod receiver;

use crate::base::colour::exposure;
use crate::base::error::{Error, Result};
use camera::Camera;
#[cfg(feature = "study")]
use glam::DQuat;
use glam::{DVec3, Vec3};
use light::{Kind, Light, Shape};
use std::ops::Range;

/// What a surface is made of: a Lambertian reflector.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name that reports use.
    pub name: String,
    /// Share of light that is reflected, per channel, within `[0, 1]`.
    pub albedo: Vec3,
    /// Whether people walk or drive on it: `inspect` averages street illuminance over these.
    pub street: bool,
}

/// A triangle that reflects on both sides; corners in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The corners; counter-clockwise seen from outside where the surface bounds a solid.
    pub corners: [Vec3; 3],
    /// Index into the scene's materials.
    pub material: u32,
}

/// A run of the light table that one part of the recipe made: `street lamps`, `windows`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightGroup {
    /// What these lights are.
    pub name: String,
    /// Where they stand in the table.
    pub range: Range<u32>,
}

/// What a scene is made from, before it has been checked.
#[derive(Clone, Debug)]
pub struct Parts {
    /// The scene's name.
    pub name: String,
    /// The seed it was generated from.
    pub seed: u64,
    /// World position of the scene's coordinate origin, in metres.
    pub origin: DVec3,
    /// The lights, in table order.
    pub lights: Vec<Shape>,
    /// Named runs of `lights`; together they need not cover all.
    pub groups: Vec<LightGroup>,
    /// The surfaces.
    pub surfaces: Vec<Surface>,
    /// The materials that surfaces name.
    pub materials: Vec<Material>,
    /// The camera.
    pub camera: Camera,
    /// Exposure value at ISO 100; `None` shows radiance as it is (exposure 1).
    pub ev100: Option<f32>,
    /// What a reader should know.
    pub notes: Vec<String>,
}

#[cfg(feature = "study")]
impl Parts {
    /// With `far` metres added to every coordinate, which is then rounded to f32 where it ends up. (A recipe that is written
    /// far away loses nothing: its [origin](Self::origin) moves instead.)
    pub(crate) fn baked(mut self, far: f64) -> Self {
        let bake = |place: Vec3| (place.as_dvec3() + far).as_vec3();
        for surface in &mut self.surfaces {
            surface.corners = surface.corners.map(bake);
        }
        for light in &mut self.lights {
            match light {
                Shape::Point { position, .. } | Shape::Spot { position, .. } => *position = bake(*position),
                Shape::Triangle { corners, .. } => *corners = corners.map(bake),
                Shape::Directional { .. } => {}
            }
        }
        self.camera = self.camera.turned(bake(self.camera.position()), DQuat::IDENTITY);
        self
    }
}

/// A checked scene: everything finite, no light or surface without area, every material known.
#[derive(Clone, Debug)]
pub struct Scene {
    name: String,
    seed: u64,
    origin: DVec3,
    lights: Vec<Light>,
    groups: Vec<LightGroup>,
    surfaces: Vec<Surface>,
    materials: Vec<Material>,
    camera: Camera,
    ev100: Option<f32>,
    notes: Vec<String>,
}

/// Names what a digest is of, and in which order.
const DIGESTED: &[u8] = b"citylights scene, generator 1\n";

impl Scene {
    /// Checks the parts. Zero-area triangles are dropped, counted in a note.
    ///
    /// # Errors
    /// Anything not finite; a colour below 0, an albedo above 1; a direction that is no unit vector; cones that no spot
    /// has; a material or a run of lights that is not there; no surface with an area.
    pub fn new(parts: Parts) -> Result<Self> {
        let Parts { name, seed, origin, lights, groups, surfaces, materials, camera, ev100, mut notes } = parts;
        for (i, material) in materials.iter().enumerate() {
            if !(material.albedo.cmpge(Vec3::ZERO).all() && material.albedo.cmple(Vec3::ONE).all()) {
                return Err(Error::Invalid(format!(
                    "material {i} (`{}`) has albedo {}; each channel must lie within 0 and 1",
                    material.name, material.albedo
                )));
            }
        }
        if lights.len() >= u32::MAX as usize || surfaces.len() >= u32::MAX as usize / 2 {
            return Err(Error::Invalid("a scene holds at most 2^31 lights and 2^31 surfaces".into()));
        }
        if !origin.is_finite() || ev100.is_some_and(|ev| !ev.is_finite()) {
            return Err(Error::Invalid(format!(
                "scene `{name}` needs a finite origin and EV100, not {origin} and {ev100:?}"
            )));
        }
        for (i, surface) in surfaces.iter().enumerate() {
            if !surface.corners.iter().all(|c| c.is_finite()) || surface.material as usize >= materials.len() {
                return Err(Error::Invalid(format!(
                    "surface {i} has a corner that is not finite, or no material {}",
                    surface.material
                )));
            }
        }
        let total = surfaces.len();
        let surfaces: Vec<Surface> = surfaces.into_iter().filter(|s| has_area(s.corners)).collect();
        if surfaces.is_empty() {
            return Err(Error::Invalid(format!(
                "scene `{name}` has no surfaces with an area: nothing could be lit; add a ground, a box or a city"
            )));
        }
        if surfaces.len() < total {
            notes.push(format!("{} surfaces without area were dropped", total - surfaces.len()));
        }
        if let Some(group) = groups.iter().find(|g| g.range.start > g.range.end || g.range.end as usize > lights.len())
        {
            return Err(Error::Invalid(format!(
                "light group `{}` is {:?} of {} lights",
                group.name,
                group.range,
                lights.len()
            )));
        }
        let mut table = Vec::with_capacity(lights.len());
        let mut kept_before = Vec::with_capacity(lights.len() + 1);
        for (i, shape) in lights.iter().enumerate() {
            check_light(i, shape)?;
            kept_before.push(table.len() as u32);
            if !matches!(shape, Shape::Triangle { corners, .. } if !has_area(*corners)) {
                table.push(Light::from(*shape));
            }
        }
        kept_before.push(table.len() as u32);
        if table.len() < lights.len() {
            notes.push(format!("{} triangle lights without area were dropped", lights.len() - table.len()));
        }
        if table.is_empty() {
            notes.push("the scene has no lights: the image is black".into());
        }
        if ev100.is_none() {
            notes.push("no EV100 is given: exposure is 1".into());
        }
        let groups = groups
            .into_iter()
            .map(|g| LightGroup {
                range: kept_before[g.range.start as usize]..kept_before[g.range.end as usize],
                name: g.name,
            })
            .filter(|g| !g.range.is_empty())
            .collect();
        Ok(Self { name, seed, origin, lights: table, groups, surfaces, materials, camera, ev100, notes })
    }

    /// What the scene is made from, with the notes so far: to make another like it.
    pub fn parts(&self) -> Parts {
        Parts {
            name: self.name.clone(),
            seed: self.seed,
            origin: self.origin,
            lights: self.lights.iter().map(Light::shape).collect(),
            groups: self.groups.clone(),
            surfaces: self.surfaces.clone(),
            materials: self.materials.clone(),
            camera: self.camera,
            ev100: self.ev100,
            notes: self.notes.clone(),
        }
    }

    /// The scene under another name.
    #[cfg(feature = "cli")]
    pub(crate) fn named(self, name: String) -> Self {
        Self { name, ..self }
    }

    /// The scene's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The seed that it was generated from.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// World position of the coordinate origin, in metres.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The light table.
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// Named runs of the light table.
    pub fn groups(&self) -> &[LightGroup] {
        &self.groups
    }

    /// The surfaces.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// The materials.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Exposure value at ISO 100, if the scene states one.
    pub fn ev100(&self) -> Option<f32> {
        self.ev100
    }

    /// The factor from radiance in cd/m^2 to displayed value: [`exposure`] of its EV100, or 1 where none is given.
    pub fn exposure(&self) -> f32 {
        self.ev100.map_or(1.0, exposure)
    }

    /// What a reader should know about how this scene came to be.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The corners of the box around all surfaces and all lights that have a place.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let surfaces = self.surfaces.iter().flat_map(|s| s.corners);
        let lights =
            self.lights.iter().filter(|l| l.kind() != Kind::Directional).flat_map(|light| match light.kind() {
                Kind::Triangle => light.corners(),
                _ => [light.position; 3],
            });
        surfaces.chain(lights).fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    }

    /// Radius in metres of a sphere around everything.
    pub fn radius(&self) -> f32 {
        let (low, high) = self.bounds();
        0.5 * (high - low).length()
    }

    /// Feeds every byte that decides the image to `sink`, in a fixed order; the origin is left out.
    pub fn digest(&self, mut sink: impl FnMut(&[u8])) {
        sink(DIGESTED);
        sink(bytemuck::cast_slice(&self.lights));
        for surface in &self.surfaces {
            sink(bytemuck::cast_slice(&surface.corners));
            sink(&surface.material.to_le_bytes());
        }
        for material in &self.materials {
            sink(bytemuck::bytes_of(&material.albedo));
        }
        sink(bytemuck::cast_slice(&self.camera.numbers()));
        sink(&self.exposure().to_le_bytes());
    }
}

fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    (b - a).cross(c - a).length_squared() > 0.0
}

fn check_light(index: usize, shape: &Shape) -> Result<()> {
    let (finite, colour) = match shape {
        Shape::Point { position, intensity } => (position.is_finite(), *intensity),
        Shape::Spot { position, axis, intensity, cos_inner, cos_outer } => {
            if !(*cos_outer >= 0.0 && cos_outer < cos_inner && *cos_inner <= 1.0) {
                return Err(Error::Invalid(format!(
                    "light {index}: a spot's cones need 0 <= inner < outer <= 90 degrees; their cosines are {cos_inner} and {cos_outer}"
                )));
            }
            (position.is_finite() && (axis.length() - 1.0).abs() < 1e-5, *intensity)
        }
        Shape::Directional { towards, irradiance } => ((towards.length() - 1.0).abs() < 1e-5, *irradiance),
        Shape::Triangle { corners, radiance } => (corners.iter().all(|c| c.is_finite()), *radiance),
    };
    if !finite || !colour.is_finite() || colour.min_element() < 0.0 {
        return Err(Error::Invalid(format!(
            "light {index} needs finite coordinates, unit directions and a colour of 0 or more: {shape:?}"
        )));
    }
    Ok(())
}
