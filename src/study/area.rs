//! Receivers by area rather than by pixel: what a city is lit like, not what one camera sees of it.
//!
//! Half lie on streets (level surfaces of a material that is a street), half on facades (upright surfaces of others),
//! each with equal chance for every square metre. A point that lies within a solid is drawn again.

use crate::base::error::{Error, Result};
use crate::base::random::Stream;
use crate::base::triangle::uniform_point;
use crate::scene::receiver::Receiver;
use crate::scene::{Scene, Surface};
use crate::visibility::occluders::{Met, Occluders};
use glam::{DVec3, Vec3};

/// Receivers on streets and on facades.
pub(super) struct ByArea {
    /// The first half on streets, the second on facades.
    pub(super) receivers: Vec<Receiver>,
    /// How many lie on streets.
    pub(super) streets: usize,
}

/// Draws in vain after which a kind of surface is taken to lie within solids altogether.
const MOST_DRAWS: usize = 1_000;

/// Draws `count` receivers of a scene.
pub(super) fn by_area(scene: &Scene, occluders: &Occluders, count: usize, seed: u64) -> Result<ByArea> {
    let is_street = |surface: &Surface| scene.materials()[surface.material as usize].street;
    let street = Kind::new(scene, |surface, normal| is_street(surface) && normal.z.abs() > 0.99);
    let facade = Kind::new(scene, |surface, normal| !is_street(surface) && normal.z.abs() < 0.01);
    let streets = count.div_ceil(2);
    let draw = |(i, kind): (usize, &Kind)| {
        let mut stream = Stream::keyed(&[seed, u64::from_le_bytes(*b"by  area"), i as u64]);
        (0..MOST_DRAWS)
            .find_map(|_| kind.draw(scene, i as u32, &mut stream).filter(|at| !is_hidden(scene, occluders, at)))
    };
    let kinds = std::iter::repeat_n(&street, streets).chain(std::iter::repeat_n(&facade, count - streets));
    let drawn: Option<Vec<Receiver>> = kinds.enumerate().map(draw).collect();
    let none = || {
        Error::Invalid(format!("scene `{}` has no open street or no open facade to take receivers on", scene.name()))
    };
    Ok(ByArea { receivers: drawn.ok_or_else(none)?, streets })
}

/// The surfaces of one kind with the running sum of their areas, in m^2.
struct Kind {
    surfaces: Vec<u32>,
    sums: Vec<f64>,
}

impl Kind {
    fn new(scene: &Scene, belongs: impl Fn(&Surface, Vec3) -> bool) -> Self {
        let (mut surfaces, mut sums, mut sum) = (Vec::new(), Vec::new(), 0.0);
        for (surface, i) in scene.surfaces().iter().zip(0..) {
            let twice = twice_area(surface);
            if belongs(surface, twice.normalize().as_vec3()) {
                sum += 0.5 * twice.length();
                surfaces.push(i);
                sums.push(sum);
            }
        }
        Self { surfaces, sums }
    }

    /// A uniform point of all the area; `None` where there is none.
    fn draw(&self, scene: &Scene, pixel: u32, stream: &mut Stream) -> Option<Receiver> {
        let at = stream.uniform64() * self.sums.last()?;
        let place = self.sums.partition_point(|&sum| sum <= at).min(self.sums.len() - 1);
        let index = self.surfaces[place];
        let surface = &scene.surfaces()[index as usize];
        let [p, q, r] = surface.corners;
        let [b, c] = uniform_point(stream.uniform2());
        let front = twice_area(surface).normalize().as_vec3();
        // What people walk on is lit from above, however it is wound.
        let normal = if front.z < -0.99 { -front } else { front };
        let albedo = scene.materials()[surface.material as usize].albedo;
        Some(Receiver { position: p + (q - p) * b + (r - p) * c, normal, view: normal, albedo, pixel, surface: index })
    }
}

/// Front normal, twice the area long.
fn twice_area(surface: &Surface) -> DVec3 {
    let [p, q, r] = surface.corners.map(Vec3::as_dvec3);
    (q - p).cross(r - p)
}

/// Whether a point lies within a solid: straight up from just before it, the first surface is met from behind.
fn is_hidden(scene: &Scene, occluders: &Occluders, at: &Receiver) -> bool {
    // 5 cm before the surface: a building stands on a block or against another without a gap.
    match occluders.first(at.position + at.normal * 0.05, DVec3::Z) {
        Some((Met::Surface(index), _)) => twice_area(&scene.surfaces()[index as usize]).z > 0.0,
        Some((Met::Light(_), _)) | None => false,
    }
}
