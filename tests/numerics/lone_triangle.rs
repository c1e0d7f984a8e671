//! A ray and one triangle: the same verdict and distance as Moller and Trumbore's test in f64 gives, and a place on the
//! triangle, however thin that is.

use super::crossing::Exactly;
use super::meshes::Mesh;
use super::visibility::{Verdict, moller_trumbore};
use citylights::base::random::Stream;
use citylights::visibility::offset::Segment;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Somewhere in the cube of half-width 1.
fn somewhere(stream: &mut Stream) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| 2.0 * stream.uniform64() - 1.0))
}

fn alone(corners: [DVec3; 3]) -> Mesh {
    Mesh { corners: corners.map(DVec3::as_vec3).to_vec(), triangles: vec![[0, 1, 2]] }
}

/// What came of a million rays: decided hits and misses, and wrong ones.
fn verdicts(nth: u64) -> [u64; 3] {
    let mut stream = Stream::keyed(&[nth, u64::from_le_bytes(*b"lone\0\0\0\0")]);
    let scale = 10f64.powf(-3.0 + 9.0 * stream.uniform64());
    let mesh = alone([0; 3].map(|_| somewhere(&mut stream) * scale));
    let (occluders, size) = (mesh.occluders(), f64::from(mesh.size()));
    let corners = [0, 1, 2].map(|i| mesh.corners[i].as_dvec3());
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let mut told = [0; 3];
    for _ in 0..100 {
        let origin = (somewhere(&mut stream) * 3.0 * scale).as_vec3();
        let target = corners[0] + (corners[1] - corners[0]) * (1.6 * stream.uniform64() - 0.3);
        let target = target + (corners[2] - target) * (1.3 * stream.uniform64() - 0.2);
        let along = (target - origin.as_dvec3()).as_vec3();
        let (start, unit) = (origin.as_dvec3(), along.as_dvec3().normalize());
        // Four units of what is farthest, and of the longer side of a plane that three rounded edges give.
        let far = size + start.length();
        let thin = size * size / normal.length();
        let tolerance = 4.0 * f64::from(f32::EPSILON) * far * thin.max(1.0);
        let (verdict, right, reach) = moller_trumbore(corners, start, unit, f64::INFINITY, tolerance);
        let met = occluders.first(origin, unit);
        let free = |end: f64| {
            let end = (end / along.as_dvec3().length()) as f32;
            occluders.visible(&Segment::bare(origin, along, 0.0, end))
        };
        let is_right = match verdict {
            Verdict::Near => continue,
            Verdict::Miss => met.is_none() && free(f64::INFINITY),
            Verdict::Hit => {
                met.is_some_and(|(_, t)| (t - right).abs() < reach) && free(right - reach) && !free(right + reach)
            }
        };
        told[usize::from(verdict == Verdict::Miss)] += 1;
        told[2] += u64::from(!is_right);
    }
    told
}

#[test]
fn a_million_rays_and_triangles_agree_with_moller_and_trumbore_in_f64() {
    let told = (0..10_000u64).into_par_iter().map(verdicts);
    let [hits, misses, wrong] = told.reduce(|| [0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
    println!("{hits} hits and {misses} misses decided, {wrong} wrong");
    assert_eq!(wrong, 0, "of {hits} hits and {misses} misses");
    assert!(hits > 300_000 && misses > 300_000, "{hits} hits and {misses} misses are decided");
}

#[test]
fn a_sliver_is_met_where_it_is() {
    let (mut met, mut off) = (0, 0);
    for nth in 0..4_000 {
        let mut stream = Stream::keyed(&[nth, u64::from_le_bytes(*b"sliver\0\0")]);
        // Down to less than the corners' own rounding: two units wide, and a metre long.
        let width = 10f64.powf(-6.6 * stream.uniform64());
        let (one, way) = (somewhere(&mut stream), somewhere(&mut stream).normalize());
        let aside = way.cross(somewhere(&mut stream)).normalize() * width;
        let mesh = alone([one, one + way, one + way * stream.uniform64() + aside]);
        let [a, b, c] = [0, 1, 2].map(|i| mesh.corners[i].as_dvec3());
        if (b - a).cross(c - a) == DVec3::ZERO {
            continue;
        }
        let (occluders, exactly) = (mesh.occluders(), Exactly::new(&mesh));
        for _ in 0..100 {
            let target = a.lerp(b, stream.uniform64()).lerp(c, stream.uniform64() * [0.0, 1.0][stream.below(2)]);
            // From anywhere, or from nearly within its plane: then it is seen edge on.
            let over = (b - a).cross(c - a).normalize() * [1.0, 1e-3, 1e-6, 0.0][stream.below(4)];
            let from = (target + (b - a) * (6.0 * stream.uniform64() - 3.0) + (c - a) / width + over).as_vec3();
            let along: Vec3 = (target - from.as_dvec3()).as_vec3();
            let Some((_, t)) = occluders.first(from, along.as_dvec3()) else { continue };
            met += 1;
            let place = from.as_dvec3() + along.as_dvec3() * t;
            let far = f64::from(from.length() + mesh.size());
            off += u64::from(exactly.distance(0, place) > 4.0 * f64::from(f32::EPSILON) * far);
        }
    }
    println!("{met} slivers met, {off} of them off the triangle");
    assert_eq!(off, 0, "of {met} slivers met");
    assert!(met > 100_000, "{met} slivers met");
}
