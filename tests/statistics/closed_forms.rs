//! Known answers: lamps, cones, polygons and the moon against formulas on paper.

use crate::promises::common::{ALBEDO, cuboid, ground, lambert, moon, panel, point, receiver, stage, stage_with};
use citylights::base::random::Stream;
use citylights::render::exact::exact;
use citylights::scene::light::{Light, Shape, cone_flux};
use citylights::scene::light_sampling::LightSampling;
use citylights::shading::contribution::contribution;
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;
use std::f64::consts::PI;

fn radiance(stage: &Stage, position: Vec3, normal: Vec3, points: u32) -> f64 {
    exact(stage, &receiver(position, normal), points, 1).mean().x
}

#[test]
fn a_lamp_over_a_plane_follows_the_inverse_square_law() {
    // 0.3 / pi * 100 / 36: the lamp of 100 cd, 6 m up.
    let stage = stage(ground(50.0, vec![point(Vec3::new(0.0, 0.0, 6.0), 100.0)]));
    let below = radiance(&stage, Vec3::ZERO, Vec3::Z, 0);
    assert!((below / 0.265_258_238 - 1.0).abs() < 1e-6, "{below}");
    for x in [0.5f64, 3.0, 6.0, 20.0, 45.0] {
        let wanted = f64::from(ALBEDO) / PI * 100.0 * 6.0 / (36.0 + x * x).powf(1.5);
        let found = radiance(&stage, Vec3::new(x as f32, 0.0, 0.0), Vec3::Z, 0);
        assert!((found / wanted - 1.0).abs() < 2e-6, "{found} for {wanted} at {x} m");
    }
}

#[test]
fn the_moon_gives_its_irradiance_times_the_cosine() {
    let towards = Vec3::new(0.6, 0.0, 0.8);
    let stage = stage(ground(50.0, vec![moon(towards, 0.25)]));
    let found = radiance(&stage, Vec3::new(3.0, 4.0, 0.0), Vec3::Z, 0);
    let wanted = f64::from(ALBEDO) / PI * 0.25 * 0.8;
    assert!((found / wanted - 1.0).abs() < 1e-6, "{found} for {wanted}");
}

#[test]
fn a_box_throws_the_moons_shadow_and_the_moon_shines_beside_it() {
    for (name, offset) in Offset::NAMED {
        let mut parts = ground(50.0, vec![moon(Vec3::new(1.0, 0.0, 1.0), 1.0)]);
        parts.surfaces.extend(cuboid(Vec3::new(2.0, -2.0, 0.0), Vec3::new(4.0, 2.0, 5.0)));
        let stage = stage_with(parts, LeaveOut::Yes, offset);
        assert_eq!(
            radiance(&stage, Vec3::ZERO, Vec3::Z, 0),
            0.0,
            "{name}: 2 m west of a box 5 m high is in its shadow"
        );
        assert!(radiance(&stage, Vec3::new(6.0, 0.0, 0.0), Vec3::Z, 0) > 0.0, "{name}: its east side is lit");
    }
}

#[test]
fn a_triangle_gives_what_lamberts_polygon_formula_says() {
    // A horizontal panel 6 m up that shines down, and a vertical window that shines along +x, both seen by the ground
    // from straight below to grazing: beyond 60 degrees a shadow ray that is not aimed from its pushed origin meets the
    // panel itself before its end.
    let down = [Vec3::new(0.0, 0.0, 6.0), Vec3::new(0.0, 2.0, 6.0), Vec3::new(1.5, 0.0, 6.0)];
    let window = [Vec3::new(0.0, 0.0, 3.0), Vec3::new(0.0, 2.0, 3.0), Vec3::new(0.0, 0.0, 5.0)];
    for (what, corners) in [("panel", down), ("window", window)] {
        for (name, offset) in Offset::NAMED {
            let light = Shape::Triangle { corners, radiance: Vec3::splat(10.0) };
            let stage = stage_with(ground(100.0, vec![light]), LeaveOut::No, offset);
            for x in [0.5f32, 2.0, 5.0, 12.0, 25.0, 40.0] {
                let at = Vec3::new(x, 0.7, 0.0);
                let found = radiance(&stage, at, Vec3::Z, 40_000);
                let wanted = f64::from(ALBEDO) / PI * 10.0 * lambert(corners, at, Vec3::Z);
                assert!(
                    (found / wanted - 1.0).abs() < 1e-3,
                    "{what}, offset {name}, {x} m away: {found} for {wanted}, ratio {}",
                    found / wanted
                );
            }
        }
    }
}

#[test]
fn a_triangle_is_dark_from_behind() {
    let light = Shape::Triangle {
        corners: [Vec3::Z * 3.0, Vec3::new(1.0, 0.0, 3.0), Vec3::new(0.0, 1.0, 3.0)],
        radiance: Vec3::ONE,
    };
    let stage = stage(ground(10.0, vec![light]));
    assert_eq!(radiance(&stage, Vec3::new(0.2, 0.2, 0.0), Vec3::Z, 100), 0.0);
}

#[test]
fn a_spots_intensity_over_the_sphere_adds_up_to_its_cone_flux() {
    for (cos_inner, cos_outer) in [(0.9f32, 0.5f32), (0.99, 0.0), (1.0, 0.95), (0.7, 0.69)] {
        let axis = Vec3::new(0.36, -0.48, 0.8);
        let light = Light::from(Shape::Spot { position: Vec3::ZERO, axis, intensity: Vec3::ONE, cos_inner, cos_outer });
        // Intensity towards w, measured by a receiver 1 m away that faces the light.
        let mut stream = Stream::keyed(&[1]);
        let (across, along) = (axis.any_orthonormal_vector(), axis.cross(axis.any_orthonormal_vector()));
        let n = 400_000;
        let sum: f64 = (0..n)
            .map(|i| {
                // Stratified in the cosine, at random around the axis.
                let cosine = (f64::from(i) + stream.uniform64()) / f64::from(n) * 2.0 - 1.0;
                let (sin, cos) = (stream.uniform64() * 2.0 * PI).sin_cos();
                let ring = (1.0 - cosine * cosine).max(0.0).sqrt();
                let w = axis.as_dvec3() * cosine + (across.as_dvec3() * cos + along.as_dvec3() * sin) * ring;
                let w = w.normalize().as_vec3();
                let at = receiver(w, -w);
                contribution::<0b1111>(LightSampling::Area, &light, [0.0; 2], &at)
                    .map_or(0.0, |arrival| f64::from(arrival.radiance.x))
            })
            .sum();
        let flux = sum / f64::from(n) * 4.0 * PI * PI / f64::from(ALBEDO);
        let wanted = f64::from(cone_flux(cos_inner, cos_outer));
        assert!((flux / wanted - 1.0).abs() < 1e-4, "cone {cos_inner}..{cos_outer}: {flux} lm for {wanted} lm");
    }
}

#[test]
fn narrow_spots_keep_their_peak_and_their_flux() {
    // An axis off the coordinate axes: its dot products round. Half-angles in degrees, down to the recipes' least.
    let axis = Vec3::new(0.36, -0.48, 0.8);
    let (across, along) = (axis.any_orthonormal_vector(), axis.cross(axis.any_orthonormal_vector()));
    for (inner, outer) in [(0.0f64, 0.5f64), (0.4, 0.5), (0.0, 1.0), (0.5, 1.0), (0.0, 2.0), (1.9, 2.0)] {
        let [cos_inner, cos_outer] = [inner, outer].map(|angle| angle.to_radians().cos() as f32);
        let light = Light::from(Shape::Spot { position: Vec3::ZERO, axis, intensity: Vec3::ONE, cos_inner, cos_outer });
        // Intensity towards w, measured by a receiver 1 m away that faces the light.
        let intensity = |cosine: f64, angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let ring = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
            let w = axis.as_dvec3() * cosine + (across.as_dvec3() * cos + along.as_dvec3() * sin) * ring;
            let w = w.normalize().as_vec3();
            let arrival = contribution::<0b1111>(LightSampling::Area, &light, [0.0; 2], &receiver(w, -w));
            arrival.map_or(0.0, |arrival| f64::from(arrival.radiance.x)) * PI / f64::from(ALBEDO)
        };
        let peak = intensity(1.0, 0.0);
        assert!((peak - 1.0).abs() < 0.01, "cone {inner}..{outer} degrees: {peak} cd of 1 cd on the axis");
        // Midpoints in the cosine over twice the cone's cap, golden angles around the axis.
        let (n, cap) = (100_000, 2.0 * (1.0 - outer.to_radians().cos()));
        let sum: f64 = (0..n)
            .map(|i| intensity(1.0 - cap * (f64::from(i) + 0.5) / f64::from(n), f64::from(i) * 2.399_963_229_728_653))
            .sum();
        let (flux, wanted) = (sum / f64::from(n) * cap * 2.0 * PI, f64::from(cone_flux(cos_inner, cos_outer)));
        println!("cone {inner}..{outer}: peak {peak}, flux ratio {}", flux / wanted);
        assert!((flux / wanted - 1.0).abs() < 0.01, "cone {inner}..{outer} degrees: {flux} lm for {wanted} lm");
    }
}

#[test]
fn a_closed_box_keeps_light_out_and_in() {
    let inside = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(-1.9, 1.9, 0.0), Vec3::new(1.5, -1.0, 0.0)];
    let outside = [Vec3::new(6.0, 0.0, -1.0), Vec3::new(-7.0, 7.0, -1.0)];
    let boxed = |lights: Vec<Shape>, offset| {
        let mut parts = ground(50.0, lights);
        parts.surfaces = cuboid(Vec3::new(-2.0, -2.0, 0.0), Vec3::new(2.0, 2.0, 3.0));
        let far = [Vec3::new(-50.0, -50.0, -1.0), Vec3::new(50.0, -50.0, -1.0), Vec3::new(0.0, 80.0, -1.0)];
        parts.surfaces.push(citylights::scene::Surface { corners: far, material: 0 });
        stage_with(parts, LeaveOut::Yes, offset)
    };
    for (name, offset) in Offset::NAMED {
        let mut out = vec![moon(Vec3::new(0.1, 0.2, 1.0), 10.0), point(Vec3::new(0.0, 0.0, 8.0), 1e4)];
        out.extend((0..40).map(|i| {
            let angle = i as f32 * 0.157;
            point(Vec3::new(5.0 * angle.cos(), 5.0 * angle.sin(), 0.5 + 0.2 * i as f32), 1e4)
        }));
        out.extend(panel(Vec3::new(-3.0, -3.0, 4.0), Vec3::Y * 6.0, Vec3::X * 6.0, 100.0));
        let stage = boxed(out, offset);
        for at in inside {
            assert_eq!(radiance(&stage, at, Vec3::Z, 400), 0.0, "{name}: light leaks in at {at}");
        }
        assert!(radiance(&stage, outside[0], Vec3::Z, 400) > 0.0, "{name}: the world outside is lit");
        let mut within = vec![point(Vec3::new(0.3, 0.2, 2.0), 100.0)];
        within.extend(panel(Vec3::new(-0.5, -0.5, 2.9), Vec3::Y, Vec3::X, 100.0));
        let stage = boxed(within, offset);
        for at in inside {
            assert!(radiance(&stage, at, Vec3::Z, 400) > 0.0, "{name}: dark inside at {at}");
        }
        for at in outside {
            assert_eq!(radiance(&stage, at, Vec3::Z, 400), 0.0, "{name}: light leaks out at {at}");
        }
    }
}

#[test]
fn a_light_of_kilometres_overhead_is_exact_in_the_reference() {
    for half in [1e3, 1e6] {
        let light = panel(Vec3::new(-half, -half, 11.0), Vec3::Y * (2.0 * half), Vec3::X * (2.0 * half), 10.0);
        let stage = stage(ground(40.0, light.to_vec()));
        for place in [Vec3::ZERO, Vec3::new(9.0, -3.0, 0.0)] {
            let at = receiver(place, Vec3::Z);
            let corners = |shape: &Shape| Light::from(*shape).corners();
            let wanted: f64 = light.iter().map(|shape| lambert(corners(shape), place, Vec3::Z)).sum();
            let mean = exact(&stage, &at, 400, 3).mean().x * PI / f64::from(ALBEDO) / 10.0;
            assert!((mean / wanted - 1.0).abs() < 1e-6, "{half} m: {mean}, not {wanted}");
        }
    }
}
