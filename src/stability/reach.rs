//! How much arrives from a light next to the receiver, or a thousand kilometres away?

use super::precise;
use super::tally::{Finding, Tally, relative};
use super::triangles::{direction, magnitude, point};
use crate::base::random::Stream;
use crate::scene::Scene;
use crate::scene::cutoff::{Cutoff, Transfer};
use crate::scene::light::{Light, Shape};
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::shading::importance::importance;
use crate::sources::small;
use crate::strategies::stochastic_cull::drawn2;
use crate::visibility::russian_roulette::chance;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Names what is drawn.
const SEED: u64 = 14;
/// Lights that each case tries.
const TRIED: usize = 4000;
/// Some ten roundings in f32.
const ROUNDING: f64 = 2e-6;

fn receiver(position: Vec3, normal: Vec3) -> Receiver {
    Receiver { position, normal, view: normal, albedo: Vec3::ONE, pixel: 0, surface: 0 }
}

/// A receiver up to 1000 km from the origin that a point light of 1e-6 to 1e12 cd is 1 um to 1000 km away from, or at.
fn pair(stream: &mut Stream) -> (Receiver, Light) {
    let at = receiver((direction(stream) * magnitude(stream, -3.0, 6.0)).as_vec3(), direction(stream).as_vec3());
    let away = if stream.below(20) == 0 { DVec3::ZERO } else { direction(stream) * magnitude(stream, -6.0, 6.0) };
    let position = at.position + away.as_vec3();
    let intensity = Vec3::splat(magnitude(stream, -6.0, 12.0) as f32);
    (at, Light::from(Shape::Point { position, intensity }))
}

/// Irradiance from a point over that of a receiver which faces it, and the latter; the way in f64.
fn exact(at: &Receiver, light: &Light) -> (f64, f64) {
    let way = light.position.as_dvec3() - at.position.as_dvec3();
    let facing = f64::from(light.colour.x) / way.length_squared();
    (at.normal.as_dvec3().dot(way.normalize_or_zero()), facing)
}

/// Error of what a point light adds, over what it would add to a receiver that faces it. Nothing at the light itself.
pub(super) fn point_light() -> Finding {
    let mut stream = Stream::keyed(&[SEED]);
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    for _ in 0..TRIED {
        let (at, light) = pair(&mut stream);
        let (cosine, facing) = exact(&at, &light);
        let error = |irradiance: f64| {
            if facing.is_finite() { (irradiance / facing - cosine.max(0.0)).abs() } else { irradiance }
        };
        let found = contribution::<0b1111>(LightSampling::Area, &light, [0.0; 2], &at).map_or(0.0, |a| a.radiance.x);
        ours.add_positive(f64::from(found), error(f64::from(found) * PI));
        // Distances below 1 cm are taken for 1 cm.
        let way = light.position - at.position;
        let found = light.colour.x * at.normal.dot(way.normalize_or_zero()).max(0.0) / way.length_squared().max(1e-4);
        theirs.add_positive(f64::from(found), error(f64::from(found)));
    }
    Finding { ours, textbook: Some(theirs), limit: ROUNDING }
}

/// The same of the importance that lights are chosen by.
pub(super) fn point_importance() -> Finding {
    let mut stream = Stream::keyed(&[SEED]);
    let mut ours = Tally::default();
    for _ in 0..TRIED {
        let (at, light) = pair(&mut stream);
        let (cosine, facing) = exact(&at, &light);
        let found = f64::from(importance(&light, &at));
        ours.add_positive(found, if facing.is_finite() { (found / facing - cosine.max(0.0)).abs() } else { found });
    }
    Finding { ours, textbook: None, limit: ROUNDING }
}

/// Error of what a triangle adds whose points are drawn by the light they send, over the exact value or 1e-7 pi.
pub(super) fn triangle() -> Finding {
    let mut stream = Stream::keyed(&[SEED, 1]);
    let mut ours = Tally::default();
    for _ in 0..TRIED {
        let size = magnitude(&mut stream, -3.0, 2.0);
        let centre = direction(&mut stream) * (size * magnitude(&mut stream, -3.0, 4.0));
        let corners = [(); 3].map(|()| (centre + point(&mut stream) * size).as_vec3());
        let radiance = magnitude(&mut stream, -6.0, 12.0) as f32;
        let light = Light::from(Shape::Triangle { corners, radiance: Vec3::splat(radiance) });
        let normal = direction(&mut stream).as_vec3();
        let at = receiver(Vec3::ZERO, normal);
        let [p, a, b] = [light.position, light.a, light.b].map(Vec3::as_dvec3);
        // Seen from the front alone.
        let facing = -a.cross(b).dot(p);
        let coordinates = [p, p + a, p + b].map(|corner| corner.to_array());
        let exact = if facing > 0.0 { precise::irradiance(coordinates, normal.as_dvec3().to_array()) } else { 0.0 };
        let uv = stream.uniform2();
        let found = contribution::<0b1111>(LightSampling::Projected, &light, uv, &at).map_or(0.0, |a| a.radiance.x);
        let irradiance = f64::from(found) * PI / f64::from(radiance);
        ours.add_positive(f64::from(found), (irradiance - exact).abs() / exact.max(1e-7 * PI));
    }
    Finding { ours, textbook: None, limit: ROUNDING }
}

/// Whether a light that is `2^k` times as strong adds `2^k` times as much, to the last bit.
pub(super) fn scaled() -> Finding {
    let mut stream = Stream::keyed(&[SEED, 2]);
    let mut ours = Tally::default();
    for i in 0..TRIED {
        let place = direction(&mut stream) * magnitude(&mut stream, -2.0, 4.0);
        let intensity = Vec3::splat(magnitude(&mut stream, -6.0, 12.0) as f32);
        let shape = |intensity: Vec3| match i % 3 {
            0 => Shape::Point { position: place.as_vec3(), intensity },
            1 => Shape::Spot {
                position: place.as_vec3(),
                axis: -place.normalize().as_vec3(),
                intensity,
                cos_inner: 0.9,
                cos_outer: 0.5,
            },
            _ => Shape::Triangle {
                corners: [place, place + place.any_orthogonal_vector(), place - place.cross(DVec3::ONE)]
                    .map(DVec3::as_vec3),
                radiance: intensity,
            },
        };
        let at = receiver(Vec3::ZERO, (place.normalize() + 0.5 * direction(&mut stream)).normalize().as_vec3());
        let factor = 2f32.powi(stream.below(60) as i32 - 20);
        let uv = stream.uniform2();
        let add = |intensity: Vec3| {
            let light = Light::from(shape(intensity));
            contribution::<0b1111>(LightSampling::Auto, &light, uv, &at).map_or(0.0, |a| f64::from(a.radiance.x))
        };
        let (once, often) = (add(intensity), add(intensity * factor));
        ours.add_positive(often, relative(often, once * f64::from(factor)));
    }
    Finding { ours, textbook: None, limit: 0.0 }
}

/// By how much the cosine is off at which a spot's ramp has the value that it gives: cones down to a step of f32 wide.
pub(super) fn cone() -> Finding {
    let mut stream = Stream::keyed(&[SEED, 3]);
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    for _ in 0..TRIED {
        let cos_outer = stream.uniform();
        let width = magnitude(&mut stream, -7.0, 0.0);
        let cos_inner = ((f64::from(cos_outer) + width).min(1.0) as f32).max(cos_outer.next_up());
        let axis = direction(&mut stream).as_vec3().normalize();
        let light = Light::from(Shape::Spot { position: Vec3::ZERO, axis, intensity: Vec3::ONE, cos_inner, cos_outer });
        // In and about the ramp, its ends among them.
        let (inner, outer) = (f64::from(cos_inner), f64::from(cos_outer));
        let wanted = (outer + (inner - outer) * (1.5 * stream.uniform64() - 0.25)).clamp(-1.0, 1.0);
        let exact_axis = axis.as_dvec3().normalize();
        let side = exact_axis.any_orthonormal_vector();
        let towards = (exact_axis * wanted + side * (1.0 - wanted * wanted).max(0.0).sqrt()).as_vec3();
        let cosine = axis.as_dvec3().dot(towards.as_dvec3());
        let ramp = ((cosine - outer) / (inner - outer)).clamp(0.0, 1.0);
        // In the root, where the ramp is straight.
        let error = |lit: f64| (lit.sqrt() - ramp).abs() * (inner - outer);
        let found = f64::from(light.cone(towards));
        ours.add_positive(found, if found <= 1.0 { error(found) } else { f64::INFINITY });
        // The extension's own form, which guards against cones of no width by a least width of 1e-3.
        let scale = 1.0 / (cos_inner - cos_outer).max(1e-3);
        let found = (axis.dot(towards) * scale - cos_outer * scale).clamp(0.0, 1.0).powi(2);
        theirs.add_positive(f64::from(found), error(f64::from(found)));
    }
    Finding { ours, textbook: Some(theirs), limit: ROUNDING }
}

/// Relative error of the squared radius at which a light falls under half a display step.
pub(super) fn radius() -> Finding {
    let mut ours = Tally::default();
    let mut stream = Stream::keyed(&[SEED, 4]);
    if let Ok(scene) = Scene::new(small::ground(1e9, Vec::new())) {
        let cutoff = Cutoff::new(&scene, 0.5, Transfer::Linear);
        for _ in 0..TRIED {
            let (_, light) = pair(&mut stream);
            let exact = f64::from(small::ALBEDO) / PI * 510.0 * f64::from(light.colour.x);
            let found = cutoff.volume(&light).map_or(f64::NAN, |volume| f64::from(volume.radius2));
            ours.add_positive(found, relative(found, exact));
        }
    }
    Finding { ours, textbook: None, limit: ROUNDING }
}

/// How far, over the radius, a point is from the edge of a light's volume that is counted on the wrong side of it.
pub(super) fn in_range() -> Finding {
    let mut ours = Tally::default();
    let mut stream = Stream::keyed(&[SEED, 5]);
    if let Ok(scene) = Scene::new(small::ground(1e9, Vec::new())) {
        let cutoff = Cutoff::new(&scene, 0.5, Transfer::Linear);
        for _ in 0..TRIED {
            let (_, light) = pair(&mut stream);
            let Some(volume) = cutoff.volume(&light) else { continue };
            let radius = f64::from(volume.radius2).sqrt();
            let step = magnitude(&mut stream, -7.0, -0.5) * if stream.below(2) == 0 { 1.0 } else { -1.0 };
            let there = volume.centre + (direction(&mut stream) * (radius * (1.0 + step))).as_vec3();
            let share = (there.as_dvec3() - volume.centre.as_dvec3()).length() / radius;
            let wrong = volume.contains(there) != (share <= 1.0);
            ours.add(share, if wrong { (share - 1.0).abs() } else { 0.0 });
        }
    }
    Finding { ours, textbook: None, limit: ROUNDING }
}

/// Relative error of the probability that a random range reaches a point.
pub(super) fn range_chance() -> Finding {
    let mut ours = Tally::default();
    let mut stream = Stream::keyed(&[SEED, 6]);
    if let Ok(scene) = Scene::new(small::ground(1e9, Vec::new())) {
        let cutoff = Cutoff::new(&scene, 0.5, Transfer::Linear);
        for _ in 0..TRIED {
            let (at, light) = pair(&mut stream);
            let Some(volume) = cutoff.volume(&light) else { continue };
            let way = at.position.as_dvec3() - volume.centre.as_dvec3();
            let exact = (f64::from(volume.radius2) / way.length_squared()).min(1.0);
            let found = f64::from(chance(&volume, at.position));
            ours.add_positive(found, if found <= 1.0 { relative(found, exact) } else { f64::INFINITY });
        }
    }
    Finding { ours, textbook: None, limit: ROUNDING }
}

/// Relative error of the square of a random range `r / sqrt(1 - u)`, at both ends of the numbers that it is drawn by.
pub(super) fn drawn_range() -> Finding {
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    let mut stream = Stream::keyed(&[SEED, 7]);
    for i in 0..TRIED {
        let longest2 = magnitude(&mut stream, 0.0, 20.0) as f32;
        let least2 = (magnitude(&mut stream, -12.0, 20.0) as f32).min(longest2);
        // Every other one next to an end.
        let u = match i % 4 {
            0 => stream.below(3) as f64 * f64::EPSILON,
            1 => 1.0 - (1 + stream.below(3)) as f64 * (0.5 * f64::EPSILON),
            _ => stream.uniform64(),
        };
        let exact = (f64::from(least2) / (1.0 - u)).clamp(f64::from(least2), f64::from(longest2));
        let found = f64::from(drawn2(least2, u, longest2));
        ours.add_positive(found, relative(found, exact));
        // By the number itself, which can be 0, in f32.
        let found = f64::from(least2 / u as f32);
        let exact = (f64::from(least2) / u.max(f64::MIN_POSITIVE)).min(f64::from(longest2));
        theirs.add_positive(found, relative(found.min(f64::from(longest2)), exact));
    }
    Finding { ours, textbook: Some(theirs), limit: ROUNDING }
}
