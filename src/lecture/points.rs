//! Chapter 4: which point of a triangle do two random numbers stand for?

use super::asked::Asked;
use super::dots::Dots;
use super::plate::{Drawing, Panel, Plate, Row};
use super::words::{metres, share};
use crate::base::error::{Error, Result};
use crate::base::random::Stream;
use crate::base::triangle::{Projected, Seen, SolidAngle, uniform_point};
use crate::scene::light::{Kind, Light};
use crate::scene::receiver::Receiver;
use crate::shading::by_angle::seen;
use glam::{DVec2, DVec3, Vec3};

/// Side of the grid of random numbers: one point from each cell of it is drawn.
const SIDE: u32 = 16;

/// Side of the grid that means and deviations are taken over.
const FINE: u32 = 256;

/// A map of the unit square onto a triangle: barycentric weights of the second and third corner, and the point's weight,
/// one over its density by area times the triangle's area, that a renderer which believes in the map would use.
type Map<'a> = dyn Fn([f64; 2]) -> ([f64; 2], Weight) + 'a;

/// What a point stands for.
enum Weight {
    /// Its share of the area.
    Area,
    /// Its share of this solid angle, in sr.
    Angle(f64),
    /// Its share of this irradiance for a radiance of 1.
    Irradiance(f64),
}

/// Without the square root: as many points along each line through the first corner, however short it is.
fn naive([u, v]: [f64; 2]) -> [f64; 2] {
    [u * (1.0 - v), u * v]
}

/// One number from each cell of a grid, at random within it.
fn cells(side: u32, seed: u64) -> impl Iterator<Item = [f64; 2]> {
    let mut stream = Stream::keyed(&[seed, u64::from(side), u64::from_le_bytes(*b"a square")]);
    (0..side * side).map(move |cell| {
        let [u, v] = [stream.uniform64(), stream.uniform64()];
        [(f64::from(cell % side) + u) / f64::from(side), (f64::from(cell / side) + v) / f64::from(side)]
    })
}

/// What a map's points say of a triangle, as one receiver sees it.
#[derive(Debug)]
struct Judged {
    /// Mean estimate of the irradiance over the exact one.
    mean: f64,
    /// Standard deviation of the estimate from one point, over the exact irradiance.
    deviation: f64,
}

/// The irradiance of a receiver by points of a map, against the closed form.
fn judge(map: &Map<'_>, seen: &Seen, normal: DVec3, area: f64, front: DVec3, seed: u64) -> Judged {
    let exact = seen.irradiance(normal);
    let (mut sum, mut squares) = (0.0, 0.0);
    for u in cells(FINE, seed) {
        let (weights, weight) = map(u);
        let to_light = seen.point(weights);
        let distance2 = to_light.length_squared();
        let direction = to_light / distance2.sqrt();
        let cosine = normal.dot(direction).max(0.0);
        let estimate = match weight {
            Weight::Area => area * cosine * (-front.dot(direction)).max(0.0) / distance2,
            Weight::Angle(angle) => angle * cosine,
            Weight::Irradiance(irradiance) => irradiance,
        } / exact;
        sum += estimate;
        squares += estimate * estimate;
    }
    let n = f64::from(FINE * FINE);
    let mean = sum / n;
    Judged { mean, deviation: (squares / n - mean * mean).max(0.0).sqrt() }
}

/// A triangle laid flat: the plane's axes, right and up as seen from its front.
fn axes(light: &Light) -> (DVec3, DVec3) {
    let front = light.c.as_dvec3().normalize();
    // From the front, right is up x front.
    let up = (DVec3::Z - front * front.z).try_normalize().unwrap_or_else(|| (DVec3::Y - front * front.y).normalize());
    (up.cross(front), up)
}

/// The triangle that sends most to the receiver.
fn brightest(lights: &[Light], at: &Receiver) -> Option<(usize, f64)> {
    let normal = at.normal.as_dvec3();
    let in_front = |light: &Light| light.kind() == Kind::Triangle && light.c.dot(at.position - light.position) > 0.0;
    let sends = |light: &Light| {
        let strength = f64::from(crate::base::colour::luminance(light.colour));
        if in_front(light) { strength * seen(light, at).irradiance(normal) } else { 0.0 }
    };
    let all = lights.iter().map(sends).enumerate();
    all.filter(|(_, irradiance)| *irradiance > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))
}

pub(super) fn draw(asked: &Asked<'_>) -> Result<Plate> {
    let stage = asked.stage()?;
    let lights = stage.scene().lights();
    if !lights.iter().any(|light| light.kind() == Kind::Triangle) {
        let text = format!("{}: this chapter needs an area light, and there is none", stage.scene().name());
        return Err(Error::Invalid(text));
    }
    let at = asked.receiver(&stage, |receivers| {
        let lit = receivers.iter().filter_map(|at| Some((at, brightest(lights, at)?.1)));
        lit.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(at, _)| at)
    })?;
    let [x, y] = super::asked::place(&stage, at);
    let (id, _) = brightest(lights, at)
        .ok_or_else(|| Error::Invalid(format!("pixel {x},{y} gets no light from any triangle: name another")))?;
    let light = &lights[id];
    let (from, normal) = (seen(light, at), at.normal.as_dvec3());
    let nothing = || Error::Invalid(format!("pixel {x},{y} sees nothing of light {id}: name another"));
    let angle = SolidAngle::new(&from).ok_or_else(nothing)?;
    let projected = Projected::new(&from, normal).ok_or_else(nothing)?;
    let area = |u: [f64; 2]| uniform_point(u.map(|u| u as f32)).map(f64::from);
    let maps: [(&str, &str, Box<Map<'_>>); 4] = [
        ("Without the square root: wrong", "α = u v, β = 1 − u", Box::new(|u| (naive(u), Weight::Area))),
        ("Uniform by area", "α = √u v, β = 1 − √u", Box::new(move |u| (area(u), Weight::Area))),
        (
            "Uniform by solid angle",
            "Idea: Arvo 1995",
            Box::new(|u| (angle.sample(u), Weight::Angle(angle.solid_angle()))),
        ),
        (
            "By solid angle times the receiver's cosine",
            "Idea: Arvo 2001",
            Box::new(|u| (projected.sample(u), Weight::Irradiance(projected.irradiance()))),
        ),
    ];
    let corners = light.corners().map(Vec3::as_dvec3);
    let (right, up) = axes(light);
    let flat = |p: DVec3| [right.dot(p - corners[0]), up.dot(p - corners[0])];
    let (front, size) = (light.c.as_dvec3().normalize(), f64::from(light.area()));
    let nearest = nearest_corner(&corners, at.position.as_dvec3());
    let mut panels = Vec::new();
    for (title, formula, map) in &maps {
        let points: Vec<[f64; 2]> = cells(SIDE, asked.seed).map(|u| map(u).0).collect();
        let in_part = points.iter().filter(|b| weight_of(nearest, **b) > 0.5).count();
        let Judged { mean, deviation } = judge(&**map, &from, normal, size, front, asked.seed);
        let off = match mean - 1.0 {
            off if off.abs() < 2e-3 => "the mean is right".to_owned(),
            off => format!("the mean is {} too {}", share(off.abs()), if off > 0.0 { "high" } else { "low" }),
        };
        let [a, b, c] = corners;
        let place = |[b1, b2]: [f64; 2]| flat(a + (b - a) * b1 + (c - a) * b2);
        panels.push(Panel {
            title: (*title).into(),
            drawing: Drawing::Dots(Dots {
                corners: corners.map(flat),
                points: points.into_iter().map(place).collect(),
                part: part(&corners, nearest).map(flat),
                receiver: foot(flat(at.position.as_dvec3()), &corners.map(flat)),
            }),
            caption: format!(
                "{formula}. {in_part} of {} points lie in the shaded quarter. Irradiance from single points: {off}, the standard \
                 deviation is {}.",
                SIDE * SIDE,
                share(deviation)
            ),
        });
    }
    let below = panels.split_off(2);
    let part = Seen::new(part(&corners, nearest).map(|corner| corner - at.position.as_dvec3()));
    let distance = (corners[nearest] - at.position.as_dvec3()).length();
    Ok(Plate {
        title: "4  Points on a triangle".into(),
        subtitle: format!(
            "{}, pixel {x},{y}. The receiver (cross) is {} from the nearest corner. The shaded quarter of the area is {} of the solid angle, {} of the irradiance.",
            asked.scene_in_words(),
            metres(distance),
            share(part.solid_angle().abs() / from.solid_angle().abs()),
            share(part.irradiance(normal) / from.irradiance(normal)),
        ),
        rows: vec![Row::Panels(panels), Row::Panels(below)],
    })
}

fn nearest_corner(corners: &[DVec3; 3], to: DVec3) -> usize {
    let distance = |i: &usize| (corners[*i] - to).length();
    (0..3).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

/// Barycentric weight of a corner.
fn weight_of(corner: usize, [b1, b2]: [f64; 2]) -> f64 {
    [1.0 - b1 - b2, b1, b2][corner]
}

/// The quarter of a triangle at a corner: where its weight is above one half.
fn part(corners: &[DVec3; 3], at: usize) -> [DVec3; 3] {
    corners.map(|corner| 0.5 * (corner + corners[at]))
}

/// A place in the triangle's plane, brought within a quarter of the triangle's size of it.
fn foot(place: [f64; 2], corners: &[[f64; 2]; 3]) -> [f64; 2] {
    let corners = corners.map(DVec2::from_array);
    let (low, high) = (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]));
    let room = 0.25 * (high - low).max_element();
    DVec2::from_array(place).clamp(low - room, high + room).to_array()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_map_but_the_naive_one_gives_the_closed_form() {
        let corners = [DVec3::new(-0.2, 0.1, 0.3), DVec3::new(0.4, 2.0, 1.0), DVec3::new(-0.3, 0.5, 2.5)];
        let from = Seen::new(corners);
        let normal = DVec3::new(0.1, 0.5, 1.0).normalize();
        let cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        // It shines towards the receiver, at the origin.
        let front = if cross.dot(corners[0]) < 0.0 { cross.normalize() } else { -cross.normalize() };
        let (angle, projected) = (SolidAngle::new(&from).expect("seen"), Projected::new(&from, normal).expect("lit"));
        let judged = |map: &Map<'_>| judge(map, &from, normal, 0.5 * cross.length(), front, 1);
        let area = judged(&|u| (uniform_point(u.map(|u| u as f32)).map(f64::from), Weight::Area));
        let by_angle = judged(&|u| (angle.sample(u), Weight::Angle(angle.solid_angle())));
        let by_light = judged(&|u| (projected.sample(u), Weight::Irradiance(projected.irradiance())));
        for right in [&area, &by_angle, &by_light] {
            assert!((right.mean - 1.0).abs() < 2e-3, "{right:?}");
        }
        let wrong = judged(&|u| (naive(u), Weight::Area));
        assert!((wrong.mean - 1.0).abs() > 0.05, "{wrong:?}");
        assert!(area.deviation > by_angle.deviation && by_angle.deviation > by_light.deviation);
        assert!(by_light.deviation < 1e-6, "without shadows it has no noise at all");
    }

    #[test]
    fn the_naive_map_puts_half_of_its_points_into_a_quarter_of_the_area() {
        let count = |map: &dyn Fn([f64; 2]) -> [f64; 2]| cells(64, 3).filter(|u| weight_of(0, map(*u)) > 0.5).count();
        assert_eq!(count(&naive), 64 * 32);
        let right = count(&|u| uniform_point(u.map(|u| u as f32)).map(f64::from));
        assert!(right.abs_diff(64 * 16) < 40, "{right}");
    }
}
