//! Chapter 5: how large does an area light look, and how far does the formula reach?

use super::asked::Asked;
use super::colour::{Ramp, mapped, shown};
use super::plate::{Drawing, Panel, Plate, Row};
use super::words::{metres, rounded};
use crate::base::error::{Error, Result};
use crate::base::random::Stream;
use crate::base::triangle::Seen;
use crate::report::{Chart, Dot, Mark, Scale, Series};
use crate::scene::light::{Kind, Light};
use crate::scene::receiver::Receiver;
use crate::shading::by_angle::seen;
use crate::stability::{precise, textbook};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Distances as powers of two of the triangle's size.
const POWERS: std::ops::RangeInclusive<i32> = 0..=20;

/// Directions at each distance; the worst of them counts.
const DIRECTIONS: usize = 64;

/// What a right result is shown as: a logarithmic axis has no 0.
const LEAST: f64 = 1e-17;

/// The triangles that face a receiver.
fn facing<'a>(lights: &'a [Light], at: &'a Receiver) -> impl Iterator<Item = &'a Light> {
    lights.iter().filter(|light| light.kind() == Kind::Triangle && light.c.dot(at.position - light.position) > 0.0)
}

/// What a receiver sees of all triangles that face it, in sr, were nothing in between.
fn solid_angle(lights: &[Light], at: &Receiver) -> f64 {
    facing(lights, at).map(|light| seen(light, at).solid_angle().abs()).sum()
}

/// Radiance in cd/m^2 of a receiver by the closed form, were nothing in between.
fn radiance(lights: &[Light], at: &Receiver) -> DVec3 {
    let irradiance = |light: &Light| light.colour.as_dvec3() * seen(light, at).irradiance(at.normal.as_dvec3());
    facing(lights, at).map(irradiance).sum::<DVec3>() * at.albedo.as_dvec3() / PI
}

/// Worst relative errors at a distance from the middle of a triangle: of the textbook's formula in f32, and of ours.
fn errors(corners: [Vec3; 3], distance: f32, seed: u64) -> [f64; 2] {
    let [a, b, c] = corners;
    let (middle, front) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize());
    let mut stream = Stream::keyed(&[seed, u64::from(distance.to_bits()), u64::from_le_bytes(*b"an angle")]);
    let mut worst = [LEAST; 2];
    for _ in 0..DIRECTIONS {
        // Within some 60 degrees of the normal: what is seen from the side is hard for another reason.
        let aside = DVec3::from_array(std::array::from_fn(|_| 2.0 * stream.uniform64() - 1.0)).as_vec3();
        let at = middle + (front + aside).normalize_or(front) * distance;
        let relative = corners.map(|corner| corner - at);
        let exact = precise::solid_angle(relative.map(|corner| corner.as_dvec3().to_array()));
        if exact == 0.0 {
            continue;
        }
        let found = [f64::from(textbook::solid_angle(relative)), Seen::new(relative.map(Vec3::as_dvec3)).solid_angle()];
        for (worst, found) in worst.iter_mut().zip(found) {
            *worst = worst.max((found / exact - 1.0).abs());
        }
    }
    worst
}

pub(super) fn draw(asked: &Asked<'_>) -> Result<Plate> {
    let stage = asked.stage()?;
    let lights = stage.scene().lights();
    let triangles = lights.iter().filter(|light| light.kind() == Kind::Triangle);
    let largest = triangles.max_by(|a, b| a.area().total_cmp(&b.area())).ok_or_else(|| {
        Error::Invalid(format!("{}: this chapter needs an area light, and there is none", stage.scene().name()))
    })?;
    let receivers = stage.receivers();
    let angles: Vec<f64> = receivers.par_iter().map(|at| solid_angle(lights, at)).collect();
    let radiance: Vec<DVec3> = receivers.par_iter().map(|at| radiance(lights, at)).collect();
    let most = angles.iter().fold(0.0f64, |most, angle| most.max(*angle));
    let panels = vec![
        Panel {
            title: "The light and what it lights".into(),
            drawing: Drawing::Bitmap(shown(&stage, &radiance)),
            caption: "What stands in between is left out here: irradiance and solid angle are closed forms.".into(),
        },
        Panel {
            title: "How large it looks from each pixel".into(),
            drawing: Drawing::Bitmap(mapped(&stage, &angles, Ramp::decades(&angles), "solid angle, sr")),
            caption: format!(
                "At most {} sr; half of all directions are 2π = 6.28 sr. Black: a thousandth of that or less, or the light is seen \
                 from behind, where it is dark.",
                rounded(most)
            ),
        },
    ];
    let size = largest.area().sqrt();
    let curve = |which: usize| {
        let at = |power| {
            let distance = size * 2f32.powi(power);
            let error = errors(largest.corners(), distance, asked.seed)[which];
            Dot { x: f64::from(distance), y: error, low: f64::NAN, high: f64::NAN }
        };
        POWERS.map(at).collect::<Vec<_>>()
    };
    let series = vec![
        Series { name: "printed formula in f32".into(), mark: Mark::nth(1, false), points: curve(0) },
        Series { name: "edge form in f64, as here".into(), mark: Mark::nth(0, false), points: curve(1) },
    ];
    let lost = series[0].points.iter().find(|dot| dot.y >= 1.0).map(|dot| dot.x);
    let mut remarks = vec![(34, "an error of 1: no digit is right".to_owned())];
    remarks.extend(lost.map(|x| (22, format!("printed formula: from {} on", metres(x)))));
    if series.iter().flat_map(|curve| &curve.points).any(|dot| dot.y <= LEAST) {
        remarks.push((34, format!("no error at all is drawn at {LEAST:e}")));
    }
    let chart = Chart {
        title: "Error of the solid angle".into(),
        subtitle: format!("the worst of {DIRECTIONS} directions, against the same formula in 31 digits"),
        x: Scale { label: "distance, m".into(), logarithmic: true },
        y: Scale { label: "relative error".into(), logarithmic: true },
        series,
        remarks,
    };
    Ok(Plate {
        title: "5  Solid angle".into(),
        subtitle: format!("{}; formula: Van Oosterom and Strackee 1983, eq. 8", asked.scene_in_words()),
        rows: vec![Row::Panels(panels), Row::Chart(chart)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_printed_formula_loses_its_digits_with_distance_and_ours_keeps_them() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let [near, ours] = errors(corners, 2.0, 1);
        assert!((1e-9..1e-4).contains(&near) && ours < 1e-12, "{near:e} {ours:e}");
        let [far, ours] = errors(corners, 1e5, 1);
        assert!(far > 0.5 && ours < 1e-12, "{far:e} {ours:e}");
    }
}
