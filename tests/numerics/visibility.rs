//! Shadow rays against a slow tracer in f64, and the traps of offsets and slabs.

use crate::promises::common::{camera, cuboid, ground, image, moon, panel, point, receiver, stage, stage_with};
use citylights::base::random::Stream;
use citylights::scene::light::Shape;
use citylights::scene::light_sampling::LightSampling;
use citylights::scene::receiver::Receiver;
use citylights::scene::{Scene, Surface};
use citylights::shading::contribution::contribution;
use citylights::visibility::occluders::Occluders;
use citylights::visibility::offset::{Offset, Segment};
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::{DVec3, Vec3};

/// Boxes on a jittered grid.
fn city(blocks: i32) -> Vec<Surface> {
    let mut stream = Stream::keyed(&[77]);
    let mut surfaces = ground(blocks as f32 * 12.0, Vec::new()).surfaces;
    for x in -blocks..blocks {
        for y in -blocks..blocks {
            let mut jitter = |most: f32| stream.uniform() * most;
            let low = Vec3::new(x as f32 * 12.0 + jitter(3.0), y as f32 * 12.0 + jitter(3.0), 0.0);
            let size = Vec3::new(4.0 + jitter(4.0), 4.0 + jitter(4.0), 3.0 + jitter(30.0));
            surfaces.extend(cuboid(low, low + size));
        }
    }
    surfaces
}

fn occluders(surfaces: Vec<Surface>) -> (Scene, Occluders) {
    let mut parts = ground(1.0, vec![point(Vec3::Z, 1.0)]);
    parts.surfaces = surfaces;
    let scene = Scene::new(parts).expect("a scene");
    let occluders = Occluders::new(&scene);
    (scene, occluders)
}

/// Where a segment stands to one triangle, in f64 (Moller and Trumbore 1997).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    Hit,
    Miss,
    /// Within the tolerance of an edge of the triangle or an end of the segment.
    Near,
}

/// And where its line meets the plane, in multiples of its unit direction; with how far a shift of it by the tolerance moves
/// that.
pub(super) fn moller_trumbore(
    [a, b, c]: [DVec3; 3],
    origin: DVec3,
    direction: DVec3,
    length: f64,
    tolerance: f64,
) -> (Verdict, f64, f64) {
    let (e1, e2) = (b - a, c - a);
    let p = direction.cross(e2);
    let det = e1.dot(p);
    let area = e1.cross(e2).length();
    let cosine = det.abs() / area;
    if cosine < 1e-12 {
        // Parallel to the plane: near only if it runs in it.
        let is_near = e1.cross(e2).dot(origin - a).abs() < tolerance * area;
        return (if is_near { Verdict::Near } else { Verdict::Miss }, f64::NAN, f64::INFINITY);
    }
    let s = origin - a;
    let u = s.dot(p) / det;
    let q = s.cross(e1);
    let v = direction.dot(q) / det;
    let t = e2.dot(q) / det;
    // Distances in the plane from the edges, as far as a shift of the ray by the tolerance moves the crossing.
    let reach = tolerance / cosine;
    let heights = [u * area / e2.length(), v * area / e1.length(), (1.0 - u - v) * area / (c - b).length()];
    let inside = heights.into_iter().fold(f64::INFINITY, f64::min);
    let along = t.min(length - t);
    let verdict = if inside < -reach || along < -reach {
        Verdict::Miss
    } else if inside > reach && along > reach {
        Verdict::Hit
    } else {
        Verdict::Near
    };
    (verdict, t, reach)
}

#[test]
fn a_hundred_thousand_segments_agree_with_a_tracer_in_f64() {
    // The rounding of coordinates around 100 m, 4e-6, times a few.
    let tolerance = 2e-5;
    let (scene, occluders) = occluders(city(5));
    let triangles: Vec<[DVec3; 3]> = scene.surfaces().iter().map(|s| s.corners.map(Vec3::as_dvec3)).collect();
    let boxes: Vec<(DVec3, DVec3)> = triangles
        .chunks(12.min(triangles.len()))
        .map(|chunk| {
            let corners = || chunk.iter().flatten();
            (corners().fold(DVec3::INFINITY, |m, c| m.min(*c)), corners().fold(DVec3::NEG_INFINITY, |m, c| m.max(*c)))
        })
        .collect();
    let mut stream = Stream::keyed(&[1]);
    let mut anywhere = || {
        let mut signed = |half: f32| (stream.uniform() * 2.0 - 1.0) * half;
        Vec3::new(signed(62.0), signed(62.0), signed(18.0) + 18.5)
    };
    let (mut disagree, mut near, mut blocked) = (0, 0, 0);
    let n = 100_000;
    for i in 0..n {
        let (from, mut to) = (anywhere(), anywhere());
        // Every tenth runs along an axis.
        if i % 10 == 0 {
            let axis = i / 10 % 3;
            let far = to[axis];
            to = from;
            to[axis] = far;
        }
        let length = from.distance(to);
        let direction = (to - from) / length;
        let found = !occluders.visible(&Segment::bare(from, direction, 0.0, length));
        let (origin, along) = (from.as_dvec3(), direction.as_dvec3());
        let mut wanted = Verdict::Miss;
        for (chunk, &(low, high)) in triangles.chunks(12.min(triangles.len())).zip(&boxes) {
            if wanted == Verdict::Hit || misses(low, high, origin, along, f64::from(length)) {
                continue;
            }
            for triangle in chunk {
                match moller_trumbore(*triangle, origin, along, f64::from(length), tolerance).0 {
                    Verdict::Hit => wanted = Verdict::Hit,
                    Verdict::Near if wanted == Verdict::Miss => wanted = Verdict::Near,
                    _ => {}
                }
                if wanted == Verdict::Hit {
                    break;
                }
            }
        }
        match wanted {
            Verdict::Near => near += 1,
            Verdict::Hit => {
                blocked += 1;
                disagree += usize::from(!found);
            }
            Verdict::Miss => disagree += usize::from(found),
        }
    }
    println!("{blocked} of {n} blocked, {near} within {tolerance} m of an edge or end, {disagree} disagree");
    assert_eq!(disagree, 0, "of {n} segments");
    assert!(near < n / 1000, "{near} of {n} are too close to call");
    assert!(blocked > n / 5 && blocked < n * 99 / 100, "{blocked} of {n} blocked: the city is no test");
}

/// Whether a segment stays a millimetre clear of a box: lets the slow tracer skip whole buildings.
fn misses(low: DVec3, high: DVec3, origin: DVec3, direction: DVec3, length: f64) -> bool {
    let end = origin + direction * length;
    let (from, to) = (origin.min(end), origin.max(end));
    (from - 1e-3).cmpgt(high).any() || (to + 1e-3).cmplt(low).any()
}

#[test]
fn emitters_block_themselves_unless_the_far_end_is_short() {
    let lights = panel(Vec3::new(-4.0, 6.0, 1.0), Vec3::X * 8.0, Vec3::Z * 5.0, 10.0).to_vec();
    for (name, offset) in Offset::NAMED {
        let lit = |offset| {
            let stage = stage_with(ground(30.0, lights.clone()), LeaveOut::No, offset);
            let image = image("all", &stage, 16);
            let free = image_unoccluded(&lights);
            let sum = |image: &[Vec3]| image.iter().map(|rgb| f64::from(rgb.x)).sum::<f64>();
            sum(&image) / sum(&free)
        };
        let (with, without) = (lit(offset), lit(offset.without_far()));
        println!("{name}: {with:.4} of the light with the far end shortened, {without:.4} without");
        assert!((with - 1.0).abs() < 0.01, "{name}: {with} of the light arrives");
        assert!(without < 0.95, "{name}: an unshortened ray should meet the light itself: {without}");
        // Ended exactly, rounding decides ray by ray; ended a hair beyond the light, it is black.
        let stage = stage_with(ground(30.0, lights.clone()), LeaveOut::No, offset.without_far());
        let (mut rays, mut seen) = (0, 0);
        for at in stage.receivers() {
            for light in stage.scene().lights() {
                let Ok(arrival) = contribution::<0b1111>(LightSampling::Area, light, [0.4, 0.6], at) else { continue };
                let segment = stage.ray_ends().segment(at, light, arrival.direction, arrival.distance);
                rays += 1;
                let Segment { origin, along, t_min, .. } = segment;
                seen += u32::from(stage.occluders().visible(&Segment::bare(origin, along, t_min, 1.0 + 1e-5)));
            }
        }
        println!("{name}: {seen} of {rays} rays see the light that they end a hair beyond");
        assert!(rays > 1_000 && seen == 0, "{name}: {seen} of {rays}");
    }
}

fn image_unoccluded(lights: &[Shape]) -> Vec<Vec3> {
    let mut needs = citylights::scene::needs::Needs::ALL;
    needs.occlusion = false;
    image("all", &stage(ground(30.0, lights.to_vec())).with_needs(needs), 16)
}

/// Share of receivers on a flat open ground, `far` from the origin, that a lamp over it fails to light.
fn acne(far: f32, offset: Offset) -> f64 {
    let shift = Vec3::new(far, 0.7 * far, far);
    let mut parts =
        ground(12.0, vec![point(shift + Vec3::new(1.0, 2.0, 6.0), 100.0), moon(Vec3::new(0.4, 0.1, 0.5), 1.0)]);
    // A slope, so that heights are rounded too.
    let tilt = |p: Vec3| Vec3::new(p.x, p.y, p.x * 0.11 + p.y * 0.07) + shift;
    parts.surfaces.iter_mut().for_each(|s| s.corners = s.corners.map(tilt));
    // Something that makes the scene need shadow rays, far from them all.
    parts.surfaces.extend(cuboid(shift + Vec3::new(-60.0, -60.0, 30.0), shift + Vec3::new(-50.0, -50.0, 31.0)));
    parts.camera = camera(shift + Vec3::new(0.3, -18.0, 14.0), shift + Vec3::new(0.0, 1.0, 0.0));
    let stage = stage_with(parts, LeaveOut::No, offset);
    let (mut lost, mut n) = (0, 0);
    for at in stage.receivers() {
        for light in stage.scene().lights() {
            n += 1;
            let mut rays = 0;
            let seen =
                citylights::render::exact::shadowed(&stage, stage.light_sampling(), at, light, [0.0; 2], &mut rays);
            lost += usize::from(seen == DVec3::ZERO);
        }
    }
    assert!(n > 1_000, "{n}");
    lost as f64 / n as f64
}

#[test]
fn the_default_offset_gives_no_acne_far_from_the_origin() {
    for far in [0.0, 100.0, 1e3, 1e4] {
        let lost = acne(far, Offset::SCALED);
        assert_eq!(lost, 0.0, "scaled at {far} m");
    }
}

#[test]
fn a_push_of_a_tenth_of_a_millimetre_fails_from_2_km_on() {
    assert_eq!(acne(0.0, Offset::ORIGIN_PUSH), 0.0);
    for far in [2_100.0, 4_096.0, 1e4] {
        let lost = acne(far, Offset::ORIGIN_PUSH);
        println!("origin-push at {far} m: {lost:.4} of the light lost");
        assert!(lost > 0.02, "{lost} of the samples lost at {far} m: the push should do nothing here");
    }
}

#[test]
fn a_slope_of_kilometres_does_not_shadow_itself() {
    // Corners so far off are rounded, and so is every height over the slope: to millimetres, far above a push near the
    // origin.
    let slope = |x: f32, y: f32| Vec3::new(x, y, 0.13 * x - 0.21 * y);
    let corners = [slope(-9_000.0, -7_000.0), slope(8_000.0, -6_000.0), slope(500.0, 9_500.0)];
    let mut parts = ground(12.0, vec![moon(Vec3::new(0.9, 0.1, 0.15), 1.0)]);
    parts.surfaces = vec![Surface { corners, material: 0 }];
    // A place that nothing is seen from, that the scene needs shadow rays.
    parts.surfaces.extend(cuboid(Vec3::new(-60.0, -60.0, 90.0), Vec3::new(-50.0, -50.0, 91.0)));
    let lit = |offset| {
        let stage = stage_with(parts.clone(), LeaveOut::No, offset);
        let mut rays = 0;
        let light = &stage.scene().lights()[0];
        let exact = |at: &Receiver| {
            citylights::render::exact::shadowed(&stage, LightSampling::Area, at, light, [0.0; 2], &mut rays)
        };
        let lit = stage.receivers().iter().map(exact).filter(|radiance| *radiance != DVec3::ZERO).count();
        (lit, stage.receivers().len())
    };
    let (with, of) = lit(Offset::SCALED);
    assert!(of > 500, "{of}");
    assert_eq!(with, of, "lit under the default");
    let (without, _) = lit(Offset::ORIGIN_PUSH);
    assert!(without < of, "a push near the origin is too short here, or this is no test: {without} of {of}");
}

#[test]
fn what_stands_a_millimetre_before_a_surface_or_a_light_still_blocks() {
    // A wall and a poster a millimetre before it, and a lamp; the poster's own front is lit, the wall behind it is not.
    let sheet = |y: f32, half: f32| {
        let corner = |x: f32, z: f32| Vec3::new(x * half, y, 2.0 + z * half);
        [
            [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0)],
            [corner(-1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        ]
        .map(|corners| Surface { corners, material: 0 })
    };
    // Half a millimetre behind the poster, that is before the wall, there is a lamp and a lit panel that shines at the
    // poster.
    let mut lights = vec![point(Vec3::new(0.1, -5.0, 2.5), 100.0), point(Vec3::new(0.2, -0.000_5, 2.1), 100.0)];
    lights.extend(panel(Vec3::new(-0.2, -0.000_5, 1.8), Vec3::X * 0.3, Vec3::Z * 0.3, 10.0));
    let mut parts = ground(12.0, lights);
    parts.surfaces.extend(sheet(0.0, 1.0));
    parts.surfaces.extend(sheet(-0.001, 0.5));
    let stage = stage_with(parts, LeaveOut::No, Offset::SCALED);
    let seen = |from: Vec3, light: usize| {
        let at = receiver(from, Vec3::NEG_Y);
        let light = &stage.scene().lights()[light];
        let arrival = contribution::<0b1111>(LightSampling::Area, light, [0.4, 0.6], &at).expect("in front");
        stage.occluders().visible(&stage.ray_ends().segment(&at, light, arrival.direction, arrival.distance))
    };
    assert!(!seen(Vec3::new(0.3, 0.0, 2.2), 0), "the wall is in the poster's shadow");
    assert!(seen(Vec3::new(0.7, 0.0, 2.2), 0), "the wall beside it is not");
    assert!(seen(Vec3::new(0.3, -0.001, 2.2), 0), "nor is the poster");
    let street = |light: usize| {
        let at = receiver(Vec3::new(0.3, -4.0, 0.0), Vec3::Z);
        let light = &stage.scene().lights()[light];
        contribution::<0b1111>(LightSampling::Area, light, [0.4, 0.6], &at).is_ok_and(|arrival| {
            stage.occluders().visible(&stage.ray_ends().segment(&at, light, arrival.direction, arrival.distance))
        })
    };
    assert!(street(0), "the street sees the lamp before it");
    for hidden in 1..4 {
        assert!(!street(hidden), "light {hidden} is behind the poster");
    }
}

#[test]
fn rays_along_an_axis_beside_a_slab_are_not_lost() {
    // A sliver 2e-6 m wide at the origin, seen along an axis from far away: with the library's own inverse direction
    // the ray leaves the sliver's box, 2e-7 m beside it, after a metre or two.
    for axis in 0..3 {
        for sign in [1.0f32, -1.0] {
            let mut direction = Vec3::ZERO;
            direction[axis] = sign;
            let (u, v) = (direction.any_orthonormal_vector(), direction.cross(direction.any_orthonormal_vector()));
            let sliver = [u * -1e-6 - v * 0.1, u * 1e-6 - v * 0.1, v * 0.1];
            let aside = [direction + u * 9.0, direction + u * 10.0, direction + u * 9.0 + v];
            let surfaces = [sliver, aside].map(|corners| Surface { corners, material: 0 });
            let (_, occluders) = occluders(surfaces.to_vec());
            for distance in [50.0, 90.0, 200.0, 2_000.0] {
                let origin = direction * -distance;
                let ray = Segment::bare(origin, direction, 0.0, 1e4);
                assert!(!occluders.visible(&ray), "{direction} from {distance} m");
                // The same ray with negative zeros.
                let negative = Vec3::select(direction.cmpeq(Vec3::ZERO), Vec3::splat(-0.0), direction);
                assert!(
                    !occluders.visible(&Segment::bare(origin, negative, 0.0, 1e4)),
                    "{negative:?} from {distance} m"
                );
                assert!(occluders.first(origin, negative.as_dvec3()).is_some());
            }
        }
    }
}

#[test]
fn rays_that_graze_the_side_of_a_block_agree_with_its_shape() {
    let (_, occluders) = occluders(cuboid(Vec3::new(100.0, -5.0, -5.0), Vec3::new(300.0, 5.0, 5.0)));
    for off in [1e-5f32, 1e-4, 1e-3] {
        for side in [1.0, -1.0] {
            let ray = |y: f32| Segment::bare(Vec3::new(0.0, y, 0.3), Vec3::X, 0.0, 1e3);
            assert!(!occluders.visible(&ray(side * (5.0 - off))), "{off} m inside");
            assert!(occluders.visible(&ray(side * (5.0 + off))), "{off} m outside");
        }
    }
}

#[test]
fn ten_times_as_many_coincident_triangles_and_lights_build_in_about_ten_times_the_time() {
    use crate::promises::common::{IN_PROPORTION, expected, times_as_long};
    use citylights::render::exact::exact;
    let window = panel(Vec3::new(0.0, 5.0, 1.0), Vec3::X, Vec3::Z, 10.0)[0];
    let at = receiver(Vec3::new(0.5, 0.5, 0.0), Vec3::Z);
    let built = |count: usize| {
        let mut lights = vec![window; count];
        lights.extend(vec![point(Vec3::new(0.0, 0.0, 5.0), 1.0); count]);
        let stage = stage(ground(12.0, lights));
        let listed: f32 = expected("influence", &stage, &at).iter().sum();
        assert!(listed >= count as f32, "{listed}");
        stage
    };
    // A ray to each of them passes all of them: that much does grow as the square.
    assert!(exact(&built(1_000), &at, 0, 1).sum.x > 0.0);
    let ratio = times_as_long(|| drop(built(100_000)), || drop(built(10_000)));
    assert!(ratio < IN_PROPORTION, "{ratio} times as long");
}

#[test]
fn what_is_not_finite_is_refused() {
    let refused = |change: &dyn Fn(&mut citylights::scene::Parts)| {
        let mut parts = ground(12.0, vec![point(Vec3::Z, 1.0)]);
        change(&mut parts);
        Scene::new(parts).is_err()
    };
    assert!(!refused(&|_| {}));
    for bad in [f32::NAN, f32::INFINITY] {
        assert!(refused(&|p| p.surfaces[0].corners[1].y = bad), "surface {bad}");
        assert!(refused(&|p| p.materials[0].albedo.y = bad), "albedo {bad}");
        assert!(refused(&|p| p.lights[0] = point(Vec3::splat(bad), 1.0)), "position {bad}");
        assert!(refused(&|p| p.lights[0] = point(Vec3::Z, bad)), "intensity {bad}");
        assert!(refused(&|p| p.lights[0] = Shape::Directional { towards: Vec3::splat(bad), irradiance: Vec3::ONE }));
        assert!(refused(&|p| p.lights.extend(panel(Vec3::Z, Vec3::X * bad, Vec3::Y, 1.0))), "panel {bad}");
        assert!(refused(&|p| p.lights.extend(panel(Vec3::Z, Vec3::X, Vec3::Y, bad))), "radiance {bad}");
        assert!(refused(&|p| p.ev100 = Some(bad)), "ev100 {bad}");
        assert!(refused(&|p| p.origin.x = f64::from(bad)), "origin {bad}");
        let spot = |cos_inner, cos_outer| Shape::Spot {
            position: Vec3::Z,
            axis: Vec3::NEG_Z,
            intensity: Vec3::ONE,
            cos_inner,
            cos_outer,
        };
        assert!(refused(&|p| p.lights[0] = spot(bad, 0.5)), "cone {bad}");
        assert!(refused(&|p| p.lights[0] = spot(0.9, bad)), "cone {bad}");
    }
    assert!(refused(&|p| p.lights[0] = point(Vec3::Z, -1.0)), "a negative light");
    assert!(refused(&|p| p.surfaces.iter_mut().for_each(|s| s.corners[1] = s.corners[0])), "no surface with an area");
}

#[test]
fn a_receiver_lies_on_its_surface_and_faces_the_viewer() {
    let mut parts = ground(60.0, vec![point(Vec3::Z * 5.0, 1.0)]);
    parts.surfaces = city(5);
    let stage: Stage = stage(parts);
    let receivers: &[Receiver] = stage.receivers();
    assert!(receivers.len() > 500);
    for at in receivers {
        let [a, b, c] = stage.scene().surfaces()[at.surface as usize].corners.map(Vec3::as_dvec3);
        let off = (b - a).cross(c - a).normalize().dot(at.position.as_dvec3() - a);
        assert!(off.abs() < 4e-6, "{off} m off its surface at {}", at.position);
        assert!(at.normal.dot(at.view) > 0.0 && (at.normal.length() - 1.0).abs() < 1e-6);
    }
}
