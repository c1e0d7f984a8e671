//! Surfaces and triangle lights as meshes.
//!
//! A mesh holds what stands in one cell of a grid, about a building: renderers that build a hierarchy for each object
//! and one over all want neither one object nor a hundred thousand. It has a primitive for each material. Corners are
//! not shared, since each triangle has its own normal.
//!
//! Blender's importer looks at all objects for each primitive. So cells grow with the scene until there are few
//! meshes, and meshes come before the lights.

use super::materials;
use super::place::{place, turned};
use crate::base::error::Result;
use crate::export::meshes::{Corners, groups};
use crate::scene::Scene;
use crate::scene::light::Shape;
use ::gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use ::gltf::json::buffer::{Stride, Target};
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::{Checked, USize64};
use ::gltf::json::{self, Index, Root};
use glam::Vec3;
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Least side of a cell in metres: a city's lots are 28 wide.
const CELL: f32 = 32.0;
/// Greatest side of a cell in metres, beyond which only names keep meshes apart.
const WIDEST_CELL: f32 = 1e6;
/// Most meshes, where cells can be that wide.
const MESHES: usize = 2048;
/// Bytes of a vector.
const STRIDE: usize = size_of::<Vec3>();

/// A triangle that is to be in a mesh.
struct Triangle<'a> {
    /// The order of its mesh's name among all.
    order: usize,
    name: &'a str,
    material: u32,
    corners: Corners,
}

impl Triangle<'_> {
    /// The mesh's place among all: the order of its name, and the cell in which the triangle's middle lies.
    fn mesh(&self, side: f32) -> (usize, [i64; 2]) {
        let middle = (self.corners[0] + self.corners[1] + self.corners[2]) / (3.0 * side);
        (self.order, [middle.x, middle.y].map(|v| v.floor() as i64))
    }
}

/// Adds materials, meshes and their nodes; gives the buffer that they read.
pub(super) fn add(scene: &Scene, root: &mut Root) -> Result<Vec<u8>> {
    let triangles = triangles(scene, root)?;
    let side = side(&triangles);
    let mut meshes: BTreeMap<_, (&str, BTreeMap<u32, Vec<Corners>>)> = BTreeMap::new();
    for triangle in &triangles {
        let (_, primitives) = meshes.entry(triangle.mesh(side)).or_insert_with(|| (triangle.name, BTreeMap::new()));
        primitives.entry(triangle.material).or_default().push(triangle.corners);
    }
    let mut buffer = Buffer { positions: Vec::new(), normals: Vec::new() };
    for (name, chunk) in meshes.into_values() {
        let primitives = chunk.into_iter().map(|(material, triangles)| buffer.primitive(material, &triangles, root));
        let primitives = primitives.collect();
        let mesh = root.push(json::Mesh {
            name: Some(name.to_owned()),
            primitives,
            weights: None,
            extensions: None,
            extras: None,
        });
        root.nodes.push(json::Node { mesh: Some(mesh), name: Some(name.to_owned()), ..json::Node::default() });
    }
    Ok(buffer.finish(root))
}

/// All surfaces and triangle lights, their materials added.
fn triangles<'a>(scene: &'a Scene, root: &mut Root) -> Result<Vec<Triangle<'a>>> {
    let mut out = Vec::new();
    let mut reflectors = HashMap::new();
    for surface in scene.surfaces() {
        let material = *reflectors
            .entry(surface.material)
            .or_insert_with(|| materials::reflector(&scene.materials()[surface.material as usize], root));
        out.push(Triangle { order: 0, name: "surfaces", material, corners: surface.corners });
    }
    let (mut emitters, mut orders) = (HashMap::new(), HashMap::new());
    for (light, name) in scene.lights().iter().zip(groups(scene)) {
        let Shape::Triangle { corners, radiance } = light.shape() else { continue };
        let material = match emitters.entry(radiance.to_array().map(f32::to_bits)) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(new) => *new.insert(materials::emitter(radiance, root)?),
        };
        let next = orders.len() + 1;
        let order = *orders.entry(name).or_insert(next);
        out.push(Triangle { order, name, material, corners });
    }
    Ok(out)
}

/// The least side of a cell that makes few enough meshes.
fn side(triangles: &[Triangle]) -> f32 {
    let mut side = CELL;
    let meshes = |side| triangles.iter().map(|triangle| triangle.mesh(side)).collect::<HashSet<_>>().len();
    while side < WIDEST_CELL && meshes(side) > MESHES {
        side *= 2.0;
    }
    side
}

/// Positions, and normals after them.
struct Buffer {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
}

/// The views of positions and of normals.
const VIEWS: [u32; 2] = [0, 1];

impl Buffer {
    fn primitive(&mut self, material: u32, triangles: &[Corners], root: &mut Root) -> Primitive {
        let offset = self.positions.len() * STRIDE;
        let start = self.positions.len();
        for corners in triangles {
            self.positions.extend(corners.map(place));
            self.normals.extend([normal(corners); 3]);
        }
        let new = &self.positions[start..];
        let fold = |f: fn(Vec3, Vec3) -> Vec3| new.iter().map(|p| Vec3::from(*p)).reduce(f).unwrap_or_default();
        let numbers = |v: Vec3| Some(json::serialize::to_value(v.to_array()).expect("numbers are JSON"));
        let accessor = |view: u32| json::Accessor {
            buffer_view: Some(Index::new(view)),
            byte_offset: Some(USize64::from(offset)),
            count: USize64::from(new.len()),
            component_type: Checked::Valid(GenericComponentType(ComponentType::F32)),
            type_: Checked::Valid(Type::Vec3),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
            extensions: None,
            extras: None,
        };
        let positions =
            json::Accessor { min: numbers(fold(Vec3::min)), max: numbers(fold(Vec3::max)), ..accessor(VIEWS[0]) };
        let normals = accessor(VIEWS[1]);
        Primitive {
            attributes: BTreeMap::from([
                (Checked::Valid(Semantic::Positions), root.push(positions)),
                (Checked::Valid(Semantic::Normals), root.push(normals)),
            ]),
            indices: None,
            material: Some(Index::new(material)),
            mode: Checked::Valid(Mode::Triangles),
            targets: None,
            extensions: None,
            extras: None,
        }
    }

    fn finish(self, root: &mut Root) -> Vec<u8> {
        let length = self.positions.len() * STRIDE;
        for view in VIEWS {
            root.buffer_views.push(json::buffer::View {
                buffer: Index::new(0),
                byte_length: USize64::from(length),
                byte_offset: Some(USize64::from(view as usize * length)),
                byte_stride: Some(Stride(STRIDE)),
                name: None,
                target: Some(Checked::Valid(Target::ArrayBuffer)),
                extensions: None,
                extras: None,
            });
        }
        let mut bytes: Vec<u8> = bytemuck::cast_slice(&self.positions).to_vec();
        bytes.extend_from_slice(bytemuck::cast_slice(&self.normals));
        bytes
    }
}

/// Unit normal on the side from which the corners run counter-clockwise, in glTF's axes.
fn normal([a, b, c]: &Corners) -> [f32; 3] {
    // In f64: the square of a sliver's area would underflow.
    let [a, b, c] = [a, b, c].map(|corner| corner.as_dvec3());
    turned((b - a).cross(c - a).normalize()).as_vec3().to_array()
}
