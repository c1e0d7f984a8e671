//! What does this scene need, and what can be left out?
//!
//! Only what is *provably* without effect is left out: the image stays the same to the last bit.

use super::Scene;
use super::light::{Kind, Light};
use glam::{DVec3, Vec3};

/// What a scene needs of a renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Needs {
    /// The kinds of light that exist, as a set of [`Kind::bit`]s.
    pub kinds: u8,
    /// Whether anything can stand between a surface and a light.
    pub occlusion: bool,
}

impl Needs {
    /// Everything: nothing is left out.
    pub(crate) const ALL: Self = Self { kinds: 0b1111, occlusion: true };

    /// Looks at a scene once.
    pub(crate) fn of(scene: &Scene) -> Self {
        let kinds = scene.lights().iter().fold(0, |set, light| set | light.kind().bit());
        Self { kinds, occlusion: can_occlude(scene) }
    }

    /// Whether a kind of light exists.
    pub(crate) fn has(self, kind: Kind) -> bool {
        self.kinds & kind.bit() != 0
    }
}

/// Whether any segment between a surface and a light can be cut by a triangle.
///
/// It cannot where all lights and all surfaces lie on one side of every triangle's plane, the lights strictly: the
/// scene is then the inside of a convex shape, open or closed. In f64, where these products of f32 numbers keep their
/// sign but for nearly coplanar points; those count as occluding unless exactly 0.
///
/// Almost any triangle of a city settles it; planes are tried in scattered order, since the ground, which does not,
/// fills whole runs of the list. Where none settles it and there are too many to try, the answer is the safe one.
fn can_occlude(scene: &Scene) -> bool {
    let emitters = scene.lights().iter().filter(|light| light.kind() == Kind::Triangle).map(Light::corners);
    let planes: Vec<[Vec3; 3]> = scene.surfaces().iter().map(|surface| surface.corners).chain(emitters).collect();
    let points = scene.lights().len() + 3 * scene.surfaces().len();
    let tries = (MOST_TESTS / points.max(1)).max(1);
    // A prime step visits every plane once: no list is a multiple of it in length.
    let scattered = (0..planes.len()).map(|i| planes[(i as u64 * 2_147_483_647 % planes.len() as u64) as usize]);
    scattered.take(tries).any(|plane| cuts(scene, plane)) || planes.len() > tries
}

/// Most tests of a point against a plane: a second.
const MOST_TESTS: usize = 300_000_000;

/// Whether something lies on both sides of a triangle's plane, or a light in it.
fn cuts(scene: &Scene, [p, q, r]: [Vec3; 3]) -> bool {
    let (p, q, r) = (p.as_dvec3(), q.as_dvec3(), r.as_dvec3());
    let normal = (q - p).cross(r - p);
    let side = |point: DVec3| normal.dot(point - p);
    let mut seen = (false, false);
    let mut note = |value: f64| {
        seen.0 |= value > 0.0;
        seen.1 |= value < 0.0;
        seen.0 && seen.1
    };
    for light in scene.lights() {
        let cut = match light.kind() {
            Kind::Directional => {
                let value = normal.dot(light.position.as_dvec3());
                value == 0.0 || note(value)
            }
            // A triangle's own plane holds its own corners, and may hold other emitters: they do not cut it.
            Kind::Triangle => light.corners().into_iter().any(|corner| note(side(corner.as_dvec3()))),
            Kind::Point | Kind::Spot => {
                let value = side(light.position.as_dvec3());
                value == 0.0 || note(value)
            }
        };
        if cut {
            return true;
        }
    }
    scene.surfaces().iter().flat_map(|surface| surface.corners).any(|corner| note(side(corner.as_dvec3())))
}
