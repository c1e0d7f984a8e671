//! How much of the area lights does a receiver see?

use crate::base::random::Stream;
use crate::scene::light::Kind;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::visibility::stage::Stage;
use glam::DVec3;

/// What a receiver gets from the triangles of a scene, by points spread evenly over each.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Soft {
    /// Radiance in cd/m^2.
    pub(super) radiance: DVec3,
    facing: u32,
    seen: u32,
}

impl Soft {
    /// Whether some of the points that it faces are seen and some are not.
    pub(super) fn is_penumbra(&self) -> bool {
        self.seen > 0 && self.seen < self.facing
    }

    /// Whether it faces points, and none is seen.
    pub(super) fn is_umbra(&self) -> bool {
        self.facing > 0 && self.seen == 0
    }
}

/// `side * side` points on each triangle, each at random in a cell of its own.
pub(super) fn soft(stage: &Stage, at: &Receiver, side: u32, seed: u64) -> Soft {
    let mut rng = Stream::keyed(&[seed, u64::from(at.pixel), u64::from_le_bytes(*b"softness")]);
    let mut soft = Soft::default();
    for light in stage.scene().lights().iter().filter(|light| light.kind() == Kind::Triangle) {
        for cell in 0..side * side {
            let [u, v] = rng.uniform2();
            let step = |cell: u32, u: f32| ((cell as f32 + u) / side as f32).min(1.0 - f32::EPSILON);
            let uv = [step(cell % side, u), step(cell / side, v)];
            let Ok(arrival) = contribution::<0b1111>(LightSampling::Area, light, uv, at) else { continue };
            soft.facing += 1;
            if stage.occluders().visible(&stage.ray_ends().segment(at, light, arrival.direction, arrival.distance)) {
                soft.seen += 1;
                soft.radiance += arrival.radiance.as_dvec3();
            }
        }
    }
    soft.radiance /= f64::from(side * side);
    soft
}
