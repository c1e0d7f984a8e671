//! Which triangles does the scene show?

use super::accessor::{COORDINATES, Indices, Numbers, POSITIONS};
use super::document::{Document, Mesh};
use super::mapping::Mapping;
use super::nodes::{Placed, turned, within};
use super::reader::Reader;
use crate::base::error::Result;
use crate::sources::limits::{FARTHEST, FARTHEST_ORIGIN};
use glam::{DVec2, DVec3, Vec3};
use std::fmt;

/// Most triangles of a scene, a mesh counted at every node that shows it: 2^24 take 1 to 2 GiB.
const MOST_TRIANGLES: usize = 1 << 24;

/// How vertices follow one another.
#[derive(Clone, Copy)]
enum Mode {
    List,
    Strip,
    Fan,
}

/// Where a primitive stands in the document.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Place {
    mesh: u32,
    primitive: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "meshes[{}].primitives[{}]", self.mesh, self.primitive)
    }
}

/// The triangles of a primitive at one node.
pub(super) struct Piece<'a> {
    reader: &'a Reader<'a>,
    /// Where it stands in the document.
    pub(super) place: Place,
    /// The number of its material.
    pub(super) material: Option<u32>,
    positions: Numbers<'a>,
    /// What is added to the positions, and by which weight.
    morphs: Vec<(Numbers<'a>, f64)>,
    indices: Option<Indices<'a>>,
    mode: Mode,
    node: &'a Placed,
    mirrored: bool,
}

impl<'a> Reader<'a> {
    /// Fails if there are more triangles than a scene may have.
    pub(super) fn check_size(&self, placed: &[Placed]) -> Result<()> {
        let mut total = 0usize;
        for node in placed {
            let Some((mesh_id, mesh)) = self.mesh(node)? else { continue };
            // A primitive without triangles takes time too, and so does a morph target that moves them.
            total = mesh.primitives.iter().fold(total, |total, p| total.saturating_add(1 + p.targets.len()));
            self.pieces(std::slice::from_ref(node), &mut |piece| {
                total = total.saturating_add(piece.len().saturating_mul(1 + piece.morphs.len()));
                Ok(())
            })?;
            if total > MOST_TRIANGLES {
                return Err(self.wrong(
                    format_args!("nodes[{}].mesh", node.id),
                    format_args!(
                        "with mesh {mesh_id} here the scene has more than {MOST_TRIANGLES} triangles, the most"
                    ),
                ));
            }
        }
        Ok(())
    }

    /// Calls `visit` with all primitives that have triangles, at each node of `placed` in turn.
    pub(super) fn pieces(
        &'a self,
        placed: &'a [Placed],
        visit: &mut dyn FnMut(&Piece<'a>) -> Result<()>,
    ) -> Result<()> {
        for node in placed {
            let Some((mesh_id, mesh)) = self.mesh(node)? else { continue };
            for primitive in 0..mesh.primitives.len() {
                let piece = self.piece(node, Place { mesh: mesh_id, primitive })?;
                piece.map_or(Ok(()), |piece| visit(&piece))?;
            }
        }
        Ok(())
    }

    /// The mesh of a node, if it has one.
    fn mesh(&self, node: &Placed) -> Result<Option<(u32, &'a Mesh)>> {
        let Document { nodes, meshes, .. } = self.document;
        let Some(id) = nodes[node.id as usize].mesh else { return Ok(None) };
        let missing = || self.no_such("mesh", id, meshes.len(), &format_args!("nodes[{}].mesh", node.id));
        Ok(Some((id, meshes.get(id as usize).ok_or_else(missing)?)))
    }

    /// A primitive at a node, if it has triangles.
    pub(super) fn piece(&'a self, node: &'a Placed, place: Place) -> Result<Option<Piece<'a>>> {
        let primitive = &self.document.meshes[place.mesh as usize].primitives[place.primitive];
        let mode = match primitive.mode.unwrap_or(4) {
            0..=3 => return Ok(None),
            4 => Mode::List,
            5 => Mode::Strip,
            6 => Mode::Fan,
            other => {
                let text = format_args!("{other} is given; 4, 5 and 6 are triangles, strips and fans of them");
                return Err(self.wrong(format_args!("{place}.mode"), text));
            }
        };
        // The specification has a primitive without positions skipped.
        let Some(position) = primitive.attributes.position else { return Ok(None) };
        let positions = self.numbers(position, &format_args!("{place}.attributes.POSITION"), &POSITIONS)?;
        let morphs = self.morphs(node, place, positions.len())?;
        let indices = primitive.indices.map(|id| self.indices(id, &format_args!("{place}.indices"))).transpose()?;
        let vertices = indices.as_ref().map_or(positions.len(), Indices::len);
        if matches!(mode, Mode::List) && vertices % 3 != 0 {
            let text = format_args!("there are {vertices} vertices; three for each triangle are asked for");
            return Err(self.wrong(place, text));
        }
        let mirrored = node.to_world.matrix3.determinant() < 0.0;
        let material = primitive.material;
        Ok(Some(Piece { reader: self, place, material, positions, morphs, indices, mode, node, mirrored }))
    }

    /// The morph targets of a primitive that its node or its mesh gives a weight.
    fn morphs(&self, node: &Placed, place: Place, vertices: usize) -> Result<Vec<(Numbers<'a>, f64)>> {
        let Document { nodes, meshes, .. } = self.document;
        let mesh = &meshes[place.mesh as usize];
        let weights = nodes[node.id as usize].weights.as_ref().or(mesh.weights.as_ref());
        let targets = mesh.primitives[place.primitive].targets.iter();
        let mut morphs = Vec::new();
        for (i, (target, &weight)) in targets.zip(weights.into_iter().flatten()).enumerate() {
            let Some(position) = target.position.filter(|_| weight != 0.0) else { continue };
            let field = format_args!("{place}.targets[{i}].POSITION");
            let added = self.numbers(position, &field, &POSITIONS)?;
            if added.len() < vertices {
                let text =
                    format_args!("{} are given for {vertices} positions; one for each is asked for", added.len());
                return Err(self.wrong(field, text));
            }
            morphs.push((added, weight));
        }
        Ok(morphs)
    }
}

impl Piece<'_> {
    /// How many triangles there are.
    pub(super) fn len(&self) -> usize {
        let vertices = self.indices.as_ref().map_or(self.positions.len(), Indices::len);
        match self.mode {
            Mode::List => vertices / 3,
            Mode::Strip | Mode::Fan => vertices.saturating_sub(2),
        }
    }

    /// The field that names its material.
    pub(super) fn material_field(&self) -> String {
        format!("{}.material", self.place)
    }

    /// The three vertices of each triangle, counter-clockwise seen from the front, as numbers in its order.
    fn faces(&self) -> impl Iterator<Item = [usize; 3]> {
        (0..self.len()).map(|t| {
            let [a, b, c] = match self.mode {
                Mode::List => [3 * t, 3 * t + 1, 3 * t + 2],
                Mode::Strip if t % 2 == 1 => [t, t + 2, t + 1],
                Mode::Strip => [t, t + 1, t + 2],
                Mode::Fan => [t + 1, t + 2, 0],
            };
            // A mirror turns what was counter-clockwise.
            if self.mirrored { [a, c, b] } else { [a, b, c] }
        })
    }

    /// All triangles in the scene's place and our axes, in metres, counter-clockwise seen from the front.
    pub(super) fn triangles(&self) -> impl Iterator<Item = Result<[DVec3; 3]>> {
        self.faces().map(|[a, b, c]| Ok([self.corner(a)?, self.corner(b)?, self.corner(c)?]))
    }

    /// Where the corners of all triangles lie in an image, in widths and heights from its upper left corner. A primitive
    /// without these coordinates has 0 for all.
    pub(super) fn places(&self, mapping: &Mapping) -> Result<impl Iterator<Item = Result<[DVec2; 3]>>> {
        let attributes =
            &self.reader.document.meshes[self.place.mesh as usize].primitives[self.place.primitive].attributes;
        let field = format!("{}.attributes.TEXCOORD_{}", self.place, mapping.set);
        let read = |accessor| self.reader.numbers(accessor, &field, &COORDINATES);
        let coordinates = attributes.coordinates(mapping.set).map(read).transpose()?;
        let (mapping, reader) = (*mapping, self.reader);
        let place = move |i: usize| -> Result<DVec2> {
            let vertex = self.vertex(i)?;
            let Some(coordinates) = &coordinates else { return Ok(mapping.place(DVec2::ZERO)) };
            if vertex >= coordinates.len() {
                let text = format_args!("index {i} is {vertex}; there are {} coordinates", coordinates.len());
                return Err(reader.wrong(&field, text));
            }
            let [u, v] = coordinates.get(vertex).map(f64::from);
            let place = mapping.place(DVec2::new(u, v));
            if !place.is_finite() {
                let text = format_args!("coordinates {vertex} come to {place}; finite ones are asked for");
                return Err(reader.wrong(&field, text));
            }
            Ok(place)
        };
        Ok(self.faces().map(move |[a, b, c]| Ok([place(a)?, place(b)?, place(c)?])))
    }

    /// Whether it has the coordinates that a texture asks for.
    pub(super) fn has_coordinates(&self, mapping: &Mapping) -> bool {
        let mesh = &self.reader.document.meshes[self.place.mesh as usize];
        mesh.primitives[self.place.primitive].attributes.coordinates(mapping.set).is_some()
    }

    /// All triangles relative to `origin`.
    pub(super) fn triangles_from(&self, origin: DVec3) -> impl Iterator<Item = Result<[Vec3; 3]>> {
        self.triangles().map(move |corners| {
            let corners = corners?.map(|corner| corner - origin);
            if let Some(far) = corners.iter().find(|corner| corner.abs().max_element() > FARTHEST) {
                return Err(self.outside(&format_args!("{far} from the scene's middle {origin}, within {FARTHEST}")));
            }
            Ok(corners.map(DVec3::as_vec3))
        })
    }

    /// The number of a vertex among the positions.
    fn vertex(&self, i: usize) -> Result<usize> {
        let vertex = self.indices.as_ref().map_or(i, |indices| indices.get(i));
        if vertex >= self.positions.len() {
            let text = format_args!("index {i} is {vertex}; there are {} positions", self.positions.len());
            return Err(self.reader.wrong(format_args!("{}.indices", self.place), text));
        }
        Ok(vertex)
    }

    fn corner(&self, i: usize) -> Result<DVec3> {
        let vertex = self.vertex(i)?;
        let rest = DVec3::from_array(self.positions.get(vertex).map(f64::from));
        let local = self
            .morphs
            .iter()
            .fold(rest, |local, (added, weight)| local + *weight * DVec3::from_array(added.get(vertex).map(f64::from)));
        if !local.is_finite() {
            let text = format_args!("position {vertex} is {local}; finite metres are asked for");
            return Err(self.reader.wrong(format_args!("{}.attributes.POSITION", self.place), text));
        }
        let world = turned(self.node.to_world.transform_point3(local));
        if !within(world, FARTHEST_ORIGIN) {
            return Err(self.outside(&format_args!("{world}, within {FARTHEST_ORIGIN} of the world's")));
        }
        Ok(world)
    }

    fn outside(&self, text: &dyn fmt::Display) -> crate::base::error::Error {
        let text = format_args!("node {} puts a vertex too far out, at {text} metres", self.node.id);
        self.reader.wrong(format_args!("{}.attributes.POSITION", self.place), text)
    }
}
