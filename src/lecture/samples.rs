//! Chapter 6: how many shadow rays does a soft shadow take?

use super::asked::Asked;
use super::colour::{Ramp, mapped, shown};
use super::plate::{Drawing, Panel, Plate, Row};
use super::soft::{Soft, soft};
use super::words::{of_the_mean, percent, rounded, share};
use crate::base::error::{Error, Result};
use crate::base::random::RunKey;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::report::{Chart, Dot, Line, Mark, Scale, Series, grouped};
use crate::scene::light::Kind;
use crate::strategy::BuildContext;
use crate::visibility::stage::Stage;
use glam::DVec3;
use rayon::prelude::*;

/// Shadow rays a pixel, as the lecture has them.
const RAYS: [u32; 4] = [1, 10, 100, 1000];

/// Rays a pixel that the heuristic shares out, on average.
const BUDGET: u32 = 10;

/// Side of the grid of points on each triangle that the error is taken against.
const SIDE: u32 = 40;

/// Radiance of each receiver by so many passes of a strategy.
fn rendered(asked: &Asked<'_>, stage: &Stage, strategy: &str, passes: u32) -> Result<Vec<DVec3>> {
    let sampler = asked.registry.parse(strategy)?.build(BuildContext { stage, seed: asked.seed })?;
    let mut film = Film::new(stage.receivers().len());
    let key = RunKey { seed: asked.seed, run: 0 };
    Plan { stage, receivers: stage.receivers(), sampler: &*sampler, key }.run_parallel(passes, &mut film);
    Ok(film.image().iter().map(|radiance| radiance.as_dvec3()).collect())
}

/// Root mean squared error over the receivers that count, over their mean.
fn rmse(found: &[DVec3], exact: &[Soft], counts: impl Fn(&Soft) -> bool) -> f64 {
    let (mut squares, mut sum, mut n) = (0.0, 0.0, 0.0);
    for (found, exact) in found.iter().zip(exact).filter(|(_, exact)| counts(exact)) {
        squares += (*found - exact.radiance).length_squared() / 3.0;
        sum += exact.radiance.element_sum() / 3.0;
        n += 1.0;
    }
    if sum > 0.0 { (squares / n).sqrt() / (sum / n) } else { 0.0 }
}

pub(super) fn draw(asked: &Asked<'_>) -> Result<Plate> {
    let stage = asked.stage()?;
    if stage.scene().lights().iter().any(|light| light.kind() != Kind::Triangle) || stage.scene().lights().is_empty() {
        let text = format!("{}: this chapter needs area lights and no others", stage.scene().name());
        return Err(Error::Invalid(text));
    }
    let receivers = stage.receivers();
    let exact: Vec<Soft> = receivers.par_iter().map(|at| soft(&stage, at, SIDE, asked.seed)).collect();
    let penumbra = exact.iter().filter(|soft| soft.is_penumbra()).count();
    if penumbra == 0 {
        return Err(Error::Invalid(format!("{}: the camera sees no penumbra", stage.scene().name())));
    }
    let (mut panels, mut points) = (Vec::new(), Vec::new());
    let mut fixed = 0.0;
    for rays in RAYS {
        let found = rendered(asked, &stage, "power:points=random", rays)?;
        let error = rmse(&found, &exact, Soft::is_penumbra);
        if rays == BUDGET {
            fixed = rmse(&found, &exact, |_| true);
        }
        points.push(Dot { x: f64::from(rays), y: error, low: f64::NAN, high: f64::NAN });
        panels.push(Panel {
            title: format!(
                "{} a pixel",
                if rays == 1 { "1 ray".to_owned() } else { format!("{} rays", grouped(rays.into())) }
            ),
            drawing: Drawing::Bitmap(shown(&stage, &found)),
            caption: format!("RMSE in the penumbra: {}.", of_the_mean(error)),
        });
    }
    let heuristic = format!("allocate:rays={BUDGET},points=random");
    let shared = rmse(&rendered(asked, &stage, &heuristic, 1)?, &exact, |_| true);
    let sampler = asked.registry.parse(&heuristic)?.build(BuildContext { stage: &stage, seed: asked.seed })?;
    let rays = |at| {
        let mut counts = vec![0.0; stage.scene().lights().len()];
        sampler.expected_counts(at, &mut counts);
        counts.iter().map(|count| f64::from(*count)).sum::<f64>()
    };
    let given: Vec<f64> = receivers.par_iter().map(rays).collect();
    let radiance: Vec<DVec3> = exact.iter().map(|soft| soft.radiance).collect();
    let below = vec![
        Panel {
            title: "Exact".into(),
            drawing: Drawing::Bitmap(shown(&stage, &radiance)),
            caption: format!(
                "{} points on each of {} triangles. {} of the pixels lie in the penumbra: there rays disagree.",
                grouped((SIDE * SIDE).into()),
                stage.scene().lights().len(),
                percent(penumbra as u64, exact.len() as u64)
            ),
        },
        Panel {
            title: format!("Rays by the heuristic, {BUDGET} on average"),
            drawing: Drawing::Bitmap(mapped(
                &stage,
                &given,
                Ramp::up_to(given.iter().fold(0.0, |most: f64, rays| most.max(*rays))),
                "shadow rays: solid angle × radiance × albedo",
            )),
            caption: format!(
                "RMSE of the whole picture: {} of the mean; with {BUDGET} rays at every pixel: {}. The heuristic does not know where the penumbra is.",
                share(shared),
                share(fixed)
            ),
        },
    ];
    let first = points[0];
    let law = RAYS.map(|rays| Dot { x: f64::from(rays), y: first.y / f64::from(rays).sqrt(), ..first }).to_vec();
    let exponent = {
        let last = points[points.len() - 1];
        (last.y / first.y).ln() / (last.x / first.x).ln()
    };
    let chart = Chart {
        title: "Error against rays".into(),
        subtitle: "RMSE in the penumbra, over its mean".into(),
        x: Scale { label: "shadow rays a pixel, n".into(), logarithmic: true },
        y: Scale { label: "RMSE over the mean".into(), logarithmic: true },
        series: vec![
            Series { name: "measured".into(), mark: Mark::nth(0, false), points },
            Series { name: "1 / √n from the first on".into(), mark: Mark::line(1, Line::Dashed), points: law },
        ],
        remarks: vec![(34, format!("measured: n to the power {}", rounded(exponent)))],
    };
    Ok(Plate {
        title: "6  How many samples".into(),
        subtitle: format!("{}; each ray goes to a random point of the light", asked.scene_in_words()),
        rows: vec![Row::Panels(panels), Row::Panels(below), Row::Chart(chart)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::sources::small;
    use crate::strategy::Registry;
    use glam::Vec3;

    #[test]
    fn a_hundred_times_the_rays_leave_a_tenth_of_the_error() {
        let lights = small::panel(Vec3::new(-3.5, -2.0, 4.0), Vec3::Y, Vec3::X, 400.0);
        let mut parts = small::ground(12.0, lights.to_vec());
        parts.surfaces.extend(small::cuboid(Vec3::new(-1.4, -1.4, 0.0), Vec3::new(1.4, 1.4, 2.6)));
        let registry = Registry::standard();
        let asked = Asked { scene: Scene::new(parts).expect("a scene"), pixel: None, seed: 1, registry: &registry };
        let stage = asked.stage().expect("a stage");
        let exact: Vec<Soft> = stage.receivers().iter().map(|at| soft(&stage, at, SIDE, 1)).collect();
        let error = |rays| {
            let found = rendered(&asked, &stage, "power:points=random", rays).expect("a picture");
            rmse(&found, &exact, |_| true)
        };
        let gain = error(4) / error(400);
        assert!((8.0..12.5).contains(&gain), "{gain}");
    }
}
