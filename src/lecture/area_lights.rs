//! Chapter 3: why does a larger light cast a softer shadow?

use super::asked::{Asked, ready};
use super::colour::shown;
use super::plate::{Drawing, Panel, Plate, Row};
use super::soft::{Soft, soft};
use super::words::{metres, percent};
use crate::base::colour::luminance;
use crate::base::error::{Error, Result};
use crate::report::{Chart, Dot, Line, Mark, Scale, Series};
use crate::scene::Scene;
use crate::scene::light::Shape;
use crate::scene::receiver::Receiver;
use crate::visibility::offset::Offset;
use crate::visibility::stage::Stage;
use crate::visibility::view::Seen;
use glam::Vec3;
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::PI;

/// What the lecture calls the sizes, and how many times the side of the scene's own light each is.
const SIZES: [(&str, f32); 4] = [("Very small", 0.05), ("Small", 0.3), ("Medium", 1.0), ("Large", 3.0)];

/// Side of the grid of points on each triangle, in pictures and in the profile.
const SIDE: u32 = 16;
const FINE: u32 = 64;

/// Which light each triangle belongs to: triangles that share a corner are one light. None for other lights.
fn lights_of(lights: &[Shape]) -> Vec<Option<usize>> {
    let mut first: HashMap<[u32; 3], usize> = HashMap::new();
    let mut parent: Vec<usize> = (0..lights.len()).collect();
    fn root(parent: &mut [usize], mut of: usize) -> usize {
        while parent[of] != of {
            parent[of] = parent[parent[of]];
            of = parent[of];
        }
        of
    }
    for (i, light) in lights.iter().enumerate() {
        let Shape::Triangle { corners, .. } = light else { continue };
        for corner in corners {
            let other = *first.entry(corner.to_array().map(f32::to_bits)).or_insert(i);
            let (a, b) = (root(&mut parent, other), root(&mut parent, i));
            parent[b] = a;
        }
    }
    let is_triangle = |light: &Shape| matches!(light, Shape::Triangle { .. });
    lights.iter().enumerate().map(|(i, light)| is_triangle(light).then(|| root(&mut parent, i))).collect()
}

/// Middle and area of each light that has an extent, by [`lights_of`].
fn extents(lights: &[Shape], of: &[Option<usize>]) -> HashMap<usize, (Vec3, f32)> {
    let mut sums: HashMap<usize, (Vec3, f32)> = HashMap::new();
    for (light, of) in lights.iter().zip(of) {
        let (Shape::Triangle { corners: [a, b, c], .. }, Some(of)) = (light, of) else { continue };
        let area = 0.5 * (*b - *a).cross(*c - *a).length();
        let sum = sums.entry(*of).or_default();
        *sum = (sum.0 + (*a + *b + *c) / 3.0 * area, sum.1 + area);
    }
    sums.into_iter().map(|(of, (weighted, area))| (of, (weighted / area, area))).collect()
}

/// The scene with its area lights `factor` times as wide about their middles and of the same intensity, and no others.
fn resized(scene: &Scene, factor: f32) -> Result<Scene> {
    let mut parts = scene.parts();
    let of = lights_of(&parts.lights);
    let extents = extents(&parts.lights, &of);
    for (light, of) in parts.lights.iter_mut().zip(&of) {
        if let (Shape::Triangle { corners, radiance }, Some(of)) = (light, of) {
            let (middle, _) = extents[of];
            *corners = corners.map(|corner| middle + (corner - middle) * factor);
            *radiance /= factor * factor;
        }
    }
    parts.lights.retain(|light| matches!(light, Shape::Triangle { .. }));
    parts.groups.clear();
    Scene::new(parts)
}

/// Side in m of a square as large as the scene's largest area light.
fn side(scene: &Scene) -> Option<f64> {
    let parts = scene.parts();
    let extents = extents(&parts.lights, &lights_of(&parts.lights));
    extents.values().map(|(_, area)| f64::from(*area).sqrt()).max_by(f64::total_cmp)
}

/// Pixels across the shadow: of one row or column and one plane, from light through umbra to light.
///
/// Of those that cross at least half as much umbra as any, the one with most penumbra.
fn crossing(stage: &Stage, found: &[Soft]) -> Option<Vec<[u32; 2]>> {
    let (width, height) = stage.view().resolution();
    let rows = (0..height).map(|y| (0..width).map(|x| [x, y]).collect::<Vec<_>>());
    let columns = (0..width).map(|x| (0..height).map(|y| [x, y]).collect::<Vec<_>>());
    let normal = |at: &[u32; 2]| receiver(stage, *at).map(|i| stage.receivers()[i].normal.to_array().map(f32::to_bits));
    let is = |at: &[u32; 2], kind: fn(&Soft) -> bool| receiver(stage, *at).is_some_and(|i| kind(&found[i]));
    let mut all: Vec<(usize, usize, Vec<[u32; 2]>)> = Vec::new();
    for line in rows.chain(columns) {
        for run in line.chunk_by(|a, b| normal(a).is_some() && normal(a) == normal(b)) {
            let dim = |at: &[u32; 2]| is(at, Soft::is_umbra) || is(at, Soft::is_penumbra);
            let (Some(first), Some(last)) = (run.iter().position(dim), run.iter().rposition(dim)) else { continue };
            // As much light before and behind as half of the shadow: so an edge can be told from what casts it.
            let room = (last + 1 - first) / 2 + 2;
            if first >= room && run.len() - last > room {
                let count = |kind| run.iter().filter(|at| is(at, kind)).count();
                all.push((count(Soft::is_umbra), count(Soft::is_penumbra), run[first - room..=last + room].to_vec()));
            }
        }
    }
    let most = all.iter().map(|(umbra, ..)| *umbra).max()?;
    all.retain(|(umbra, ..)| 2 * umbra >= most);
    all.into_iter().max_by_key(|(_, penumbra, _)| *penumbra).map(|(.., pixels)| pixels)
}

/// The receiver that a pixel within the film sees.
fn receiver(stage: &Stage, [x, y]: [u32; 2]) -> Option<usize> {
    match stage.view().seen(x, y) {
        Ok(Seen::Receiver(index)) => Some(index as usize),
        _ => None,
    }
}

/// Irradiance along some pixels, in lx, over the distance from the first of them in m.
fn profile(stage: &Stage, pixels: &[[u32; 2]], seed: u64) -> Vec<Dot> {
    let along: Vec<_> =
        pixels.iter().filter_map(|pixel| receiver(stage, *pixel)).map(|i| stage.receivers()[i]).collect();
    let Some(first) = along.first().map(|at| at.position) else { return Vec::new() };
    let dot = |at: &Receiver| {
        let white = Receiver { albedo: Vec3::ONE, ..*at };
        let y = PI * f64::from(luminance(soft(stage, &white, FINE, seed).radiance.as_vec3()));
        Dot { x: f64::from(at.position.distance(first)), y, low: f64::NAN, high: f64::NAN }
    };
    along.par_iter().map(dot).collect()
}

pub(super) fn draw(asked: &Asked<'_>) -> Result<Plate> {
    let own = side(&asked.scene).ok_or_else(|| {
        Error::Invalid(format!("{}: this chapter needs an area light, and there is none", asked.scene.name()))
    })?;
    let mut taken = Vec::new();
    for (name, factor) in SIZES {
        let stage = ready(resized(&asked.scene, factor)?, Offset::SCALED)?;
        let found: Vec<Soft> = stage.receivers().par_iter().map(|at| soft(&stage, at, SIDE, asked.seed)).collect();
        taken.push((name, own * f64::from(factor), stage, found));
    }
    // The scene's own size says where the profile is taken.
    let way =
        taken.iter().find(|(name, ..)| *name == SIZES[2].0).and_then(|(_, _, stage, found)| crossing(stage, found));
    let (mut panels, mut series) = (Vec::new(), Vec::new());
    for (i, (name, side, stage, found)) in taken.iter().enumerate() {
        let radiance: Vec<_> = found.iter().map(|soft| soft.radiance).collect();
        let mut bitmap = shown(stage, &radiance);
        bitmap.line = way.as_ref().and_then(|way| Some([*way.first()?, *way.last()?]));
        let count =
            |of: fn(&Soft) -> bool| percent(found.iter().filter(|soft| of(soft)).count() as u64, found.len() as u64);
        panels.push(Panel {
            title: format!("{name}: {} wide", metres(*side)),
            drawing: Drawing::Bitmap(bitmap),
            caption: format!(
                "Umbra: {} of the picture. Penumbra: {}.",
                count(Soft::is_umbra),
                count(Soft::is_penumbra)
            ),
        });
        let points = way.as_ref().map_or_else(Vec::new, |way| profile(stage, way, asked.seed));
        series.push(Series { name: format!("{} wide", metres(*side)), mark: Mark::line(i, Line::Solid), points });
    }
    let below = panels.split_off(2);
    let chart = Chart {
        title: "Across the shadow".into(),
        subtitle: "irradiance along the line in the pictures, from its upper end, or its left one".into(),
        x: Scale { label: "distance along the line, m".into(), logarithmic: false },
        y: Scale { label: "irradiance, lx".into(), logarithmic: false },
        series,
        remarks: vec![(34, "a step: hard shadow".into()), (22, "a slope: penumbra".into())],
    };
    Ok(Plate {
        title: "3  Area lights: umbra and penumbra".into(),
        subtitle: format!("{}; one intensity whatever the size", asked.scene_in_words()),
        rows: vec![Row::Panels(panels), Row::Panels(below), Row::Chart(chart)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sources::small;

    fn under_a_panel() -> Scene {
        let lights = small::panel(Vec3::new(-3.5, -2.0, 4.0), Vec3::Y, Vec3::X, 400.0);
        let mut parts = small::ground(12.0, lights.to_vec());
        parts.surfaces.extend(small::cuboid(Vec3::new(-1.4, -1.4, 0.0), Vec3::new(1.4, 1.4, 2.6)));
        Scene::new(parts).expect("a scene")
    }

    #[test]
    fn a_light_keeps_its_middle_and_its_intensity_whatever_its_size() {
        let scene = under_a_panel();
        assert!((side(&scene).expect("an area light") - 1.0).abs() < 1e-6);
        let large = resized(&scene, 3.0).expect("a scene");
        assert!((side(&large).expect("an area light") - 3.0).abs() < 1e-5);
        for (a, b) in scene.lights().iter().zip(large.lights()) {
            assert!((a.peak_intensity() / b.peak_intensity() - 1.0).abs().max_element() < 1e-5);
        }
        let middle = |scene: &Scene| {
            let lights = scene.parts().lights;
            extents(&lights, &lights_of(&lights)).into_values().map(|(middle, _)| middle).collect::<Vec<_>>()
        };
        assert_eq!(middle(&scene).len(), 1, "two triangles with a common edge are one light");
        assert!(middle(&scene)[0].distance(middle(&large)[0]) < 1e-5);
    }

    #[test]
    fn the_larger_the_light_the_wider_the_penumbra() {
        let penumbra = |factor: f32| {
            let stage = ready(resized(&under_a_panel(), factor).expect("a scene"), Offset::SCALED).expect("a stage");
            stage.receivers().iter().filter(|at| soft(&stage, at, 8, 1).is_penumbra()).count()
        };
        let widths = SIZES.map(|(_, factor)| penumbra(factor));
        assert!(widths.is_sorted() && widths[3] > widths[0] + 10, "{widths:?}");
    }
}
