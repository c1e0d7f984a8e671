//! No ray passes between triangles that share an edge or a corner, from either side, and none is stopped beside them: by
//! how the meshes and the rays were made, and by an exact predicate.

use super::crossing::Exactly;
use super::meshes::{closed, sheet};
use crate::promises::common::{ground, point, receiver, stage};
use citylights::base::random::Stream;
use citylights::render::exact::exact;
use citylights::scene::{Parts, Surface};
use citylights::sources::{Overrides, recipe};
use citylights::visibility::occluders::{Met, Occluders};
use citylights::visibility::offset::{Offset, Segment};
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Rays at each mesh, in all some ten million.
const RAYS: u64 = 42_000;
/// Meshes of either kind.
const MESHES: u64 = 120;

#[test]
fn nothing_leaks_out_of_a_closed_surface() {
    let leaks: u64 = (0..MESHES)
        .into_par_iter()
        .map(|nth| {
            let mut stream = Stream::keyed(&[nth, u64::from_le_bytes(*b"closed\0\0")]);
            let mesh = closed(&mut stream);
            let occluders = mesh.occluders();
            let size = mesh.size();
            let mut leaks = 0;
            for _ in 0..RAYS {
                let start = [0.0, 0.0, 0.2][stream.below(3)] * size;
                let origin = Vec3::new(stream.uniform() - 0.5, stream.uniform() - 0.5, stream.uniform() - 0.5) * start;
                let along = mesh.place(&mut stream, |_| true) - origin.as_dvec3();
                // In units of the scene, not all of length 1, and past the surface.
                let far = along.as_vec3() * 4.0;
                leaks += u64::from(occluders.first(origin, along.normalize()).is_none());
                leaks += u64::from(occluders.visible(&Segment::bare(origin, far, 0.0, 1.0)));
                leaks += u64::from(occluders.visible(&Segment::bare(origin + far, -far, 0.0, 1.0)));
            }
            leaks
        })
        .sum();
    assert_eq!(leaks, 0, "of {} rays", 3 * RAYS * MESHES);
}

#[test]
fn nothing_passes_through_a_sheet_and_everything_beside_it() {
    let wrong: u64 = (0..MESHES)
        .into_par_iter()
        .map(|nth| {
            let mut stream = Stream::keyed(&[nth, u64::from_le_bytes(*b"sheet\0\0\0")]);
            let (mesh, n, rough) = sheet(&mut stream);
            let occluders = mesh.occluders();
            let is_inner = |i: usize| (1..n - 1).contains(&(i / n)) && (1..n - 1).contains(&(i % n));
            let [low, across, up] = [0, n * (n - 1), n - 1].map(|i| mesh.corners[i].as_dvec3());
            let (across, up) = (across - low, up - low);
            let over = across.cross(up).normalize() * across.length();
            let mut wrong = 0;
            for _ in 0..RAYS {
                // From above or below, not too flat; through the inside, or beside the rim: by a thousandth of the side, and by as
                // much as the rim is rough.
                let target = mesh.place(&mut stream, |of| of.iter().all(|&i| is_inner(i)));
                let side = [over, -over][stream.below(2)];
                let lean = across * (stream.uniform64() - 0.5) + up * (stream.uniform64() - 0.5);
                let from = (target + side + [DVec3::ZERO, lean][stream.below(2)]).as_vec3();
                let way = target - from.as_dvec3();
                wrong += u64::from(occluders.first(from, way.normalize()).is_none());
                wrong += u64::from(occluders.visible(&Segment::bare(from, way.as_vec3() * 2.0, 0.0, 1.0)));
                let beside = low + up * stream.uniform64() - across * (2e-3 + rough);
                let start = (beside + side).as_vec3();
                let past = (beside - start.as_dvec3()) * 2.0;
                wrong += u64::from(!occluders.visible(&Segment::bare(start, past.as_vec3(), 0.0, 1.0)));
            }
            wrong
        })
        .sum();
    assert_eq!(wrong, 0, "of {} rays", 3 * RAYS * MESHES);
}

#[test]
fn a_roof_of_two_triangles_has_no_gap_along_its_diagonal() {
    let text = include_str!("../data/diagonal.toml");
    let scene = recipe::parse(text, "diagonal.toml".as_ref(), &Overrides::default()).expect("a scene");
    for (name, policy) in Offset::NAMED {
        let stage = Stage::new(scene.clone(), LeaveOut::Yes, policy);
        assert_eq!(stage.receivers().len(), 16 * 12, "{name}: the camera looks at the ground, below the roof");
        let lit = stage.receivers().iter().filter(|at| exact(&stage, at, 1, 1).mean() != DVec3::ZERO).count();
        assert_eq!(lit, 0, "{name}: pixels in the umbra are lit");
    }
}

/// What came of rays that an exact predicate was asked about.
#[derive(Clone, Copy, Default, Debug)]
struct Told {
    rays: u64,
    /// Met something and nothing, as was right.
    hits: u64,
    misses: u64,
    /// So near an outline that rounding may decide.
    open: u64,
    /// Missed what is there, met what is not, or met it somewhere else.
    leaks: u64,
    blocks: u64,
    displaced: u64,
}

impl Told {
    fn plus(self, other: Self) -> Self {
        Self {
            rays: self.rays + other.rays,
            hits: self.hits + other.hits,
            misses: self.misses + other.misses,
            open: self.open + other.open,
            leaks: self.leaks + other.leaks,
            blocks: self.blocks + other.blocks,
            displaced: self.displaced + other.displaced,
        }
    }

    /// Asks a mesh about a ray in all ways, and an exact predicate. From inside a closed mesh, whichever edges are near,
    /// nothing passes.
    fn ask(&mut self, mesh: &Exactly, occluders: &Occluders, origin: Vec3, along: Vec3, is_inside: bool) {
        let unit = along.as_dvec3().normalize();
        let margin = margin(mesh.mesh.size(), origin, unit);
        let exact = mesh.crossing(origin, along, margin);
        let is_met = !exact.met.is_empty();
        assert!(is_met || !is_inside, "a closed mesh has no gap: {origin} along {along}");
        self.rays += 1;
        if exact.outline && !is_inside {
            self.open += 1;
            return;
        }
        *if is_met { &mut self.hits } else { &mut self.misses } += 1;
        let ways = [along.as_dvec3(), unit].map(|direction| (direction, occluders.first(origin, direction)));
        let seen = [
            occluders.visible(&Segment::bare(origin, along, 0.0, f32::INFINITY)),
            occluders.visible(&Segment::bare(origin, along, f32::MIN_POSITIVE, f32::MAX)),
        ];
        let free = ways.iter().filter(|(_, met)| met.is_none()).count() + seen.iter().filter(|&&seen| seen).count();
        *if is_met { &mut self.leaks } else { &mut self.blocks } += if is_met { free } else { 4 - free } as u64;
        if exact.outline || !is_met {
            return;
        }
        let nearest = exact.met.iter().min_by(|a, b| a.1.total_cmp(&b.1)).expect("is met");
        for (direction, met) in ways {
            let Some((Met::Surface(index), t)) = met else { continue };
            let place = origin.as_dvec3() + direction * t;
            let (far, right) = (t * direction.length(), nearest.1 * along.as_dvec3().length());
            // Which is the first of two is known no better than to a few units of the distance.
            let is_off = (far - right).abs() > margin / exact.flat + 4.0 * f64::from(f32::EPSILON) * right;
            let aside = mesh.distance(index as usize, place);
            if is_off || aside > margin {
                println!(
                    "{origin} along {along}: triangle {index} at {far} m, not {nearest:?}; {aside} of {margin} m beside it"
                );
                self.displaced += 1;
            }
        }
    }
}

/// How far across the ray rounding may move what it sees, in metres: four units in the last place of how far it goes aside
/// from its greatest direction component, and of the size of the mesh.
///
/// A corner less the origin, the depth, the lean, their product and the difference are rounded, by half a unit each.
fn margin(size: f32, origin: Vec3, unit: DVec3) -> f64 {
    let depth = f64::from(origin.length() + size);
    let aside = depth * (1.0 - unit.abs().max_element().powi(2)).max(0.0).sqrt();
    4.0 * f64::from(f32::EPSILON) * (aside + f64::from(size))
}

/// A start 10^3 to 10^7 times as far off as a mesh is large: nearly along an axis, or aslant.
fn far(stream: &mut Stream, apart: DVec3) -> DVec3 {
    let distance = 10f64.powf(3.0 + 4.0 * stream.uniform64());
    let aside = apart * [0.0, 1.0, 1e3, distance][stream.below(4)];
    let axis = DVec3::AXES[stream.below(3)] * distance;
    if stream.below(2) == 0 { aside + axis } else { aside - axis }
}

/// Rays at closed meshes from inside and outside, at sheets, and at closed meshes from far away.
fn told(meshes: u64, rays: u64) -> Told {
    let of = |nth: u64| {
        let mut stream = Stream::keyed(&[nth, u64::from_le_bytes(*b"exactly\0")]);
        let mesh = if nth.is_multiple_of(4) { sheet(&mut stream).0 } else { closed(&mut stream) };
        let (occluders, exactly, size) = (mesh.occluders(), Exactly::new(&mesh), mesh.size());
        let mut told = Told::default();
        for _ in 0..rays {
            // Corners, edges, triangles, next to them, and somewhere around.
            let aside = DVec3::from_array([0; 3].map(|_| stream.uniform64() - 0.5)) * f64::from(size);
            let target = mesh.place(&mut stream, |_| true) + aside * [0.0, 0.0, 0.0, 1e-6, 3.0][stream.below(5)];
            let apart = DVec3::from_array([0; 3].map(|_| stream.uniform64() - 0.5));
            let (origin, is_inside) = match nth % 4 {
                // Just behind the surface; the centre and around it.
                1 if stream.below(3) == 0 => (mesh.place(&mut stream, |_| true) * 0.999 / f64::from(size), true),
                1 => (apart * [0.0, 0.2][stream.below(2)], true),
                2 => (apart.normalize() * (2.0 + 8.0 * stream.uniform64()), false),
                3 => (far(&mut stream, apart), false),
                _ => (apart.normalize() * (20.0 + 8.0 * stream.uniform64()), false),
            };
            let origin = (origin * f64::from(size)).as_vec3();
            let along = (target - origin.as_dvec3()).as_vec3();
            told.ask(&exactly, &occluders, origin, along * [1.0, 1.0, 1e-3, 1e3][stream.below(4)], is_inside);
        }
        told
    };
    (0..meshes).into_par_iter().map(of).reduce(Told::default, Told::plus)
}

fn assert_told(told: &Told) {
    println!("{told:?}");
    assert_eq!((told.leaks, told.blocks, told.displaced), (0, 0, 0), "{told:?}");
    assert!(told.hits > told.rays / 2 && told.misses > told.rays / 100 && told.open < told.rays / 3, "{told:?}");
}

#[test]
fn rays_meet_what_an_exact_predicate_says() {
    assert_told(&told(400, 1_000));
}

/// `cargo test --release --lib promises::numerics::watertight -- --ignored --nocapture`
#[test]
#[ignore = "a minute of CPU time"]
fn ten_million_rays_meet_what_an_exact_predicate_says() {
    assert_told(&told(1_000, 10_000));
}

/// Receivers within closed meshes, each with a sheet so near before it that it counts as the receiver's own surface: rays
/// pass over that, and are asked again. The path is that of references and strategies.
#[test]
fn nothing_leaks_past_what_a_shadow_ray_passes_over() {
    const LIGHTS: usize = 200;
    let (mut passed_over, mut seen, mut rays) = (0, 0, 0);
    for nth in 0..MESHES {
        let mut stream = Stream::keyed(&[nth, u64::from_le_bytes(*b"passover")]);
        let mesh = closed(&mut stream);
        let size = mesh.size();
        let mut apart = || Vec3::from([0; 3].map(|_| stream.uniform() - 0.5));
        let (place, normal) = (apart() * 0.2 * size, apart().normalize());
        let (u, v) = normal.any_orthonormal_pair();
        let middle = place + normal * (4.0 * f32::EPSILON * size);
        let sheet = [u, v - u, -u - v].map(|corner| middle + corner * (0.2 * size));
        let beyond = (0..LIGHTS).map(|_| {
            let way = mesh.place(&mut stream, |_| true) - place.as_dvec3();
            let way = if way.dot(normal.as_dvec3()) < 0.0 { -way } else { way };
            (place.as_dvec3() + way * 3.0).as_vec3()
        });
        let beyond: Vec<Vec3> = beyond.collect();
        let lights: Vec<_> = beyond.iter().map(|&at| point(at, size * size)).collect();
        let mut surfaces = vec![Surface { corners: sheet, material: 0 }];
        let of = |surfaces: &[Surface]| stage(Parts { surfaces: surfaces.to_vec(), ..ground(1.0, lights.clone()) });
        let at = receiver(place, normal);
        let alone = of(&surfaces);
        for (light, &end) in alone.scene().lights().iter().zip(&beyond) {
            let way = end - place;
            let segment = alone.ray_ends().segment(&at, light, way.normalize(), way.length());
            rays += 1;
            let is_met = alone.occluders().first(segment.origin, segment.along.as_dvec3()).is_some();
            passed_over += u64::from(is_met && alone.occluders().visible(&segment));
        }
        surfaces.extend(mesh.surfaces());
        seen += u64::from(exact(&of(&surfaces), &at, 1, 1).mean() != DVec3::ZERO);
    }
    println!("{passed_over} of {rays} rays passed over a sheet");
    assert_eq!(seen, 0, "of {MESHES} receivers");
    assert!(passed_over > rays / 2, "{passed_over} of {rays} rays passed over a sheet");
}
