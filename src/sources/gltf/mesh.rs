//! Which triangles does the scene show?

use super::accessor::{Indices, Positions};
use super::document::{Document, Mesh};
use super::material::{Cover, Palette};
use super::nodes::{Placed, turned, within};
use super::reader::Reader;
use crate::base::error::Result;
use crate::sources::limits::{FARTHEST, FARTHEST_ORIGIN};
use glam::{DVec3, Vec3};
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
#[derive(Clone, Copy)]
struct Place {
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
    place: Place,
    positions: Positions<'a>,
    indices: Option<Indices<'a>>,
    mode: Mode,
    node: &'a Placed,
    mirrored: bool,
    material: Option<u32>,
}

impl<'a> Reader<'a> {
    /// Fails if there are more triangles than a scene may have.
    pub(super) fn check_size(&self, placed: &[Placed]) -> Result<()> {
        let mut total = 0usize;
        for node in placed {
            let Some((mesh_id, mesh)) = self.mesh(node)? else { continue };
            // A primitive without triangles takes time too.
            total = total.saturating_add(mesh.primitives.len());
            self.pieces(std::slice::from_ref(node), &mut |piece| {
                total = total.saturating_add(piece.len());
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

    fn piece(&'a self, node: &'a Placed, place: Place) -> Result<Option<Piece<'a>>> {
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
        let positions = self.positions(position, &format_args!("{place}.attributes.POSITION"))?;
        let indices = primitive.indices.map(|id| self.indices(id, &format_args!("{place}.indices"))).transpose()?;
        let vertices = indices.map_or(positions.len(), |indices| indices.len());
        if matches!(mode, Mode::List) && vertices % 3 != 0 {
            let text = format_args!("there are {vertices} vertices; three for each triangle are asked for");
            return Err(self.wrong(place, text));
        }
        let mirrored = node.to_world.matrix3.determinant() < 0.0;
        let material = primitive.material;
        Ok(Some(Piece { reader: self, place, positions, indices, mode, node, mirrored, material }))
    }
}

impl Piece<'_> {
    /// How many triangles there are.
    pub(super) fn len(&self) -> usize {
        let vertices = self.indices.map_or(self.positions.len(), |indices| indices.len());
        match self.mode {
            Mode::List => vertices / 3,
            Mode::Strip | Mode::Fan => vertices.saturating_sub(2),
        }
    }

    /// What covers it.
    pub(super) fn cover(&self, palette: &Palette) -> Result<Cover> {
        palette.cover(self.reader, self.material, &format_args!("{}.material", self.place))
    }

    /// All triangles in the scene's place and our axes, in metres, counter-clockwise seen from the front.
    pub(super) fn triangles(&self) -> impl Iterator<Item = Result<[DVec3; 3]>> {
        (0..self.len()).map(|t| {
            let [a, b, c] = match self.mode {
                Mode::List => [3 * t, 3 * t + 1, 3 * t + 2],
                Mode::Strip if t % 2 == 1 => [t, t + 2, t + 1],
                Mode::Strip => [t, t + 1, t + 2],
                Mode::Fan => [t + 1, t + 2, 0],
            };
            // A mirror turns what was counter-clockwise.
            let [b, c] = if self.mirrored { [c, b] } else { [b, c] };
            Ok([self.corner(a)?, self.corner(b)?, self.corner(c)?])
        })
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

    fn corner(&self, i: usize) -> Result<DVec3> {
        let vertex = self.indices.map_or(i, |indices| indices.get(i));
        if vertex >= self.positions.len() {
            let text = format_args!("index {i} is {vertex}; there are {} positions", self.positions.len());
            return Err(self.reader.wrong(format_args!("{}.indices", self.place), text));
        }
        let local = Vec3::from_array(self.positions.get(vertex));
        if !local.is_finite() {
            let text = format_args!("position {vertex} is {local}; finite metres are asked for");
            return Err(self.reader.wrong(format_args!("{}.attributes.POSITION", self.place), text));
        }
        let world = turned(self.node.to_world.transform_point3(local.as_dvec3()));
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
