//! Points, normals and what is in between, in f64 and from the scene's numbers alone.

use crate::scene::Scene;
use crate::scene::light::{Kind, LightId};
use crate::scene::receiver::Receiver;
use glam::{DVec3, Vec3};

/// Most tests of a ray against a triangle for `visibility`, and as many for `exact-sum`: a quarter of a CPU second each.
/// Scenes of more than 20,000 triangles get fewer shadow rays, and say how many.
const TESTS: usize = 40_000_000;

/// A scene's triangles and camera.
pub(super) struct Geometry<'a> {
    pub(super) scene: &'a Scene,
    /// A corner and two edges: the surfaces, then the emitters.
    triangles: Vec<[DVec3; 3]>,
    emitters: Vec<LightId>,
    /// Greatest coordinate, in metres: the unit of rounding.
    pub(super) size: f64,
}

/// A point that the camera sees.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Where the program says it is: contributions are evaluated there.
    pub(super) position: DVec3,
    /// Where the pixel's ray meets the surface.
    pub(super) met: DVec3,
    pub(super) normal: DVec3,
    pub(super) albedo: DVec3,
    pub(super) surface: u32,
}

impl<'a> Geometry<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let edges = |corners: [Vec3; 3]| {
            let [p, q, r] = corners.map(Vec3::as_dvec3);
            [p, q - p, r - p]
        };
        let is_emitter = |id: &LightId| scene.lights()[*id as usize].kind() == Kind::Triangle;
        let emitters: Vec<LightId> = (0..scene.lights().len() as LightId).filter(is_emitter).collect();
        let surfaces = scene.surfaces().iter().map(|surface| surface.corners);
        let corners = surfaces.chain(emitters.iter().map(|&id| scene.lights()[id as usize].corners()));
        let triangles: Vec<[DVec3; 3]> = corners.map(edges).collect();
        let (low, high) = scene.bounds();
        let size = f64::from(low.abs().max(high.abs()).max(scene.camera().position().abs()).max_element());
        Self { scene, triangles, emitters, size }
    }

    /// The lights that are triangles.
    pub(super) fn emitters(&self) -> &[LightId] {
        &self.emitters
    }

    /// Shadow rays that may be traced.
    pub(super) fn rays(&self) -> usize {
        TESTS / self.triangles.len().max(1)
    }

    pub(super) fn triangles(&self) -> usize {
        self.triangles.len()
    }

    /// What a receiver's pixel sees of its surface, from the camera's position, directions and angle.
    pub(super) fn place(&self, at: &Receiver) -> Option<Place> {
        let surface = self.scene.surfaces().get(at.surface as usize)?;
        let [p, q, r] = surface.corners.map(Vec3::as_dvec3);
        let across = (q - p).cross(r - p).normalize();
        let (eye, ray) = (self.eye(), self.ray(at.pixel, [0.0; 2]));
        let slope = across.dot(ray);
        // The side that the camera sees.
        let normal = if slope < 0.0 { across } else { -across };
        let met = eye + ray * (across.dot(p - eye) / slope);
        let albedo = self.scene.materials().get(surface.material as usize)?.albedo.as_dvec3();
        let (position, surface) = (at.position.as_dvec3(), at.surface);
        Some(Place { position, met, normal, albedo, surface })
    }

    /// The plane of a receiver's surface: its unit normal, and how far from it the receiver lies.
    pub(super) fn plane(&self, at: &Receiver) -> Option<(DVec3, f64)> {
        let surface = self.scene.surfaces().get(at.surface as usize)?;
        let [p, q, r] = surface.corners.map(Vec3::as_dvec3);
        let normal = (q - p).cross(r - p).normalize();
        Some((normal, normal.dot(at.position.as_dvec3() - p)))
    }

    /// Where a direction from the camera meets the film, in pixels from its upper left corner; none behind the camera.
    pub(super) fn on_film(&self, direction: DVec3) -> Option<[f64; 2]> {
        let camera = self.scene.camera();
        let (width, height) = camera.resolution();
        let pixels = 0.5 * f64::from(height) / (0.5 * camera.fov().to_radians()).tan();
        let ahead = camera.forward().dot(direction);
        let [x, y] = [camera.right(), -camera.up()].map(|axis| axis.dot(direction) / ahead * pixels);
        (ahead > 0.0).then_some([x + 0.5 * f64::from(width), y + 0.5 * f64::from(height)])
    }

    pub(super) fn eye(&self) -> DVec3 {
        self.scene.camera().position().as_dvec3()
    }

    /// Unit direction through the centre of a pixel, or a point so many pixels beside it.
    pub(super) fn ray(&self, pixel: u32, beside: [f64; 2]) -> DVec3 {
        let camera = self.scene.camera();
        let (width, height) = camera.resolution();
        // Pixels are square: both axes are measured in half heights of the film.
        let tangent = (0.5 * camera.fov().to_radians()).tan() * 2.0 / f64::from(height);
        let x = f64::from(pixel % width) + 0.5 + beside[0] - 0.5 * f64::from(width);
        let y = f64::from(pixel / width) + 0.5 + beside[1] - 0.5 * f64::from(height);
        (camera.forward() + camera.right() * (x * tangent) - camera.up() * (y * tangent)).normalize()
    }

    /// The first surface or emitter on a ray: its distance, and the surface's index or none.
    pub(super) fn first(&self, origin: DVec3, along: DVec3) -> Option<(f64, Option<u32>)> {
        let hits =
            self.triangles.iter().zip(0u32..).filter_map(|(triangle, i)| Some((meet(triangle, origin, along)?, i)));
        let (t, i) = hits.filter(|(t, _)| *t > 0.0).min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some((t, ((i as usize) < self.scene.surfaces().len()).then_some(i)))
    }

    /// Whether nothing stands between a place and a target: a point, or a direction towards what is infinitely far.
    pub(super) fn free(&self, place: &Place, target: Towards) -> bool {
        self.free_beside(place, target, DVec3::ZERO, DVec3::ZERO)
    }

    /// Whether a ray that starts or ends a hair's breadth beside meets with another fate: then it passes an edge.
    pub(super) fn is_silhouette(&self, place: &Place, target: Towards) -> bool {
        let hair = 1e-3 + 1e-6 * self.size;
        let along = match target {
            Towards::Point(point) => (point - place.met).normalize_or_zero(),
            Towards::Direction(direction) => direction,
        };
        let (a, b) = along.any_orthonormal_pair();
        let (s, t) = place.normal.any_orthonormal_pair();
        let usual = self.free(place, target);
        let starts = [s, -s, t, -t, place.normal, place.normal * 2.0].map(|step| (step * hair, DVec3::ZERO));
        let ends = [a, -a, b, -b, -along].map(|step| (DVec3::ZERO, step * hair));
        starts.into_iter().chain(ends).any(|(start, end)| self.free_beside(place, target, start, end) != usual)
    }

    fn free_beside(&self, place: &Place, target: Towards, start: DVec3, end: DVec3) -> bool {
        // Corners are rounded to half a 16-millionth of a coordinate: neighbours in one plane are so far apart.
        let skin = 1e-6 * (1.0 + self.size);
        let origin = place.met + place.normal * skin + start;
        let (along, last) = match target {
            Towards::Point(point) => {
                let along = point + end - origin;
                (along, 1.0 - skin / along.length())
            }
            Towards::Direction(direction) => (direction, f64::INFINITY),
        };
        let blocks = |(triangle, i): (&[DVec3; 3], u32)| {
            i != place.surface && meet(triangle, origin, along).is_some_and(|t| t > 0.0 && t < last)
        };
        !self.triangles.iter().zip(0..).any(blocks)
    }
}

/// Where light comes from.
#[derive(Clone, Copy)]
pub(super) enum Towards {
    Point(DVec3),
    Direction(DVec3),
}

/// Where a ray meets a triangle from either side, as a multiple of `along`; behind its start too.
///
/// Source: Moeller and Trumbore, Journal of Graphics Tools 2(1), 1997.
#[inline]
fn meet(&[corner, a, b]: &[DVec3; 3], origin: DVec3, along: DVec3) -> Option<f64> {
    let p = along.cross(b);
    let determinant = a.dot(p);
    let from_corner = origin - corner;
    let u = from_corner.dot(p);
    // Weights times the determinant, whose sign they have inside.
    if u * determinant < 0.0 || u.abs() > determinant.abs() {
        return None;
    }
    let q = from_corner.cross(a);
    let v = along.dot(q);
    if v * determinant < 0.0 || (u + v).abs() > determinant.abs() || determinant == 0.0 {
        return None;
    }
    Some(b.dot(q) / determinant)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_a_triangle_inside_its_edges_from_both_sides() {
        let triangle = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 2.0];
        let from = |x: f64, y: f64| DVec3::new(x, y, 3.0);
        for (x, y, inside) in
            [(0.5, 0.5, true), (1.5, 0.4, true), (1.2, 0.9, false), (-0.1, 0.5, false), (0.5, -0.1, false)]
        {
            let down = meet(&triangle, from(x, y), DVec3::NEG_Z * 6.0);
            assert_eq!(down, inside.then_some(0.5), "{x} {y}");
            let up = meet(&triangle, from(x, y) * DVec3::new(1.0, 1.0, -1.0), DVec3::Z * 6.0);
            assert_eq!(up, inside.then_some(0.5), "{x} {y} from below");
        }
        assert_eq!(meet(&triangle, DVec3::Z, DVec3::X), None, "along its plane");
    }
}
