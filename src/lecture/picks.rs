//! Chapter 9: by which chance should a light be picked?

use super::asked::{Asked, place};
use super::colour::shown;
use super::each::each;
use super::plate::{Bars, Drawing, Panel, Plate, Row};
use super::words::{of_the_mean, share};
use crate::base::error::{Error, Result};
use crate::base::random::RunKey;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::report::{Mark, grouped};
use crate::scene::Scene;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::{AnySampler, BuildContext};
use crate::verify::Truth;
use crate::visibility::stage::Stage;
use glam::DVec3;
use rayon::prelude::*;

/// The strategies that are compared.
const STRATEGIES: [(&str, &str); 3] =
    [("uniform", "any light alike"), ("power", "by flux"), ("intensity", "by intensity at the pixel")];

/// Picks a pixel of the pictures.
const PICKS: u32 = 16;

/// Lights whose shares are shown.
const SHOWN: usize = 5;

/// Points on triangles at the pixel, in each of the truth's repetitions.
const POINTS: u32 = 1024;

/// Share of a pixel's light, and the chance of each strategy.
#[derive(Debug)]
struct Share {
    light: LightId,
    exact: f64,
    chances: Vec<f64>,
}

/// The exact shares at a receiver, greatest first, beside the chances of each sampler.
fn shares(stage: &Stage, samplers: &[Box<dyn AnySampler>], at: &Receiver, seed: u64) -> Vec<Share> {
    let truth = Truth::new(stage, at, POINTS, seed);
    let chances: Vec<Vec<f64>> = samplers.iter().map(|sampler| chances(&**sampler, at, truth.lights().len())).collect();
    let whole = truth.total().max(f64::MIN_POSITIVE);
    let share = |(light, adds): (LightId, &f64)| Share {
        light,
        exact: adds / whole,
        chances: chances.iter().map(|chances| chances[light as usize]).collect(),
    };
    let mut shares: Vec<Share> = (0..).zip(truth.lights()).map(share).collect();
    shares.sort_by(|a, b| b.exact.total_cmp(&a.exact).then(a.light.cmp(&b.light)));
    shares
}

/// How often each light is picked, as a share of all picks; zeros where the sampler cannot tell.
fn chances(sampler: &dyn AnySampler, at: &Receiver, lights: usize) -> Vec<f64> {
    let mut counts = vec![0.0; lights];
    sampler.expected_counts(at, &mut counts);
    let sum: f64 = counts.iter().map(|count| f64::from(*count)).sum();
    counts.iter().map(|count| if sum > 0.0 { f64::from(*count) / sum } else { 0.0 }).collect()
}

/// The receiver that is seen a little below and to the right of the film's middle, or near there: down a street, where the
/// light of several lamps meets.
fn usual<'s>(stage: &Stage, receivers: &'s [Receiver]) -> Option<&'s Receiver> {
    let (width, height) = stage.view().resolution();
    let wanted = [0.63 * f64::from(width), 0.61 * f64::from(height)];
    let off = |at: &Receiver| {
        let [x, y] = place(stage, at).map(f64::from);
        (x - wanted[0]).powi(2) + (y - wanted[1]).powi(2)
    };
    receivers.iter().min_by(|a, b| off(a).total_cmp(&off(b)))
}

/// Number and part of the scene of a light.
fn name(scene: &Scene, light: LightId) -> [String; 2] {
    let group = scene.groups().iter().find(|group| group.range.contains(&light));
    let of = group.map_or(scene.lights()[light as usize].kind().name(), |group| &group.name);
    [format!("light {light}"), of.to_owned()]
}

pub(super) fn draw(asked: &Asked<'_>) -> Result<Plate> {
    let stage = asked.stage()?;
    let at = asked.receiver(&stage, |receivers| usual(&stage, receivers))?;
    let [x, y] = place(&stage, at);
    let build =
        |(name, _): &(&str, &str)| asked.registry.parse(name)?.build(BuildContext { stage: &stage, seed: asked.seed });
    let samplers = STRATEGIES.iter().map(build).collect::<Result<Vec<_>>>()?;
    let shares = shares(&stage, &samplers, at, asked.seed);
    let shown_lights: Vec<&Share> = shares.iter().filter(|share| share.exact > 0.0).take(SHOWN).collect();
    if shown_lights.is_empty() {
        return Err(Error::Invalid(format!("pixel {x},{y} gets no light: name another with --pixel")));
    }
    let exact: Vec<DVec3> =
        stage.receivers().par_iter().map(|at| each(&stage, at, asked.seed).into_iter().sum()).collect();
    let mean = exact.iter().map(|radiance| radiance.element_sum()).sum::<f64>() / (3 * exact.len()) as f64;
    let mut panels = Vec::new();
    for ((strategy, by), sampler) in STRATEGIES.iter().zip(&samplers) {
        let key = RunKey { seed: asked.seed, run: 0 };
        let mut film = Film::new(stage.receivers().len());
        Plan { stage: &stage, receivers: stage.receivers(), sampler: &**sampler, key }.run_parallel(PICKS, &mut film);
        let found: Vec<DVec3> = film.image().iter().map(|radiance| radiance.as_dvec3()).collect();
        let squares: f64 = found.iter().zip(&exact).map(|(found, exact)| (*found - *exact).length_squared()).sum();
        let rmse = (squares / (3 * exact.len()) as f64).sqrt() / mean.max(f64::MIN_POSITIVE);
        let mut bitmap = shown(&stage, &found);
        bitmap.cross = Some([x, y]);
        panels.push(Panel {
            title: format!("{strategy}: {by}"),
            drawing: Drawing::Bitmap(bitmap),
            caption: format!("{PICKS} picks a pixel. RMSE: {}.", of_the_mean(rmse)),
        });
    }
    let names = std::iter::once("exact share of the light").chain(STRATEGIES.iter().map(|(name, _)| *name));
    let bars = Bars {
        title: format!("The {} brightest of {} lights at the cross", shown_lights.len(), grouped(shares.len() as u64)),
        label: format!(
            "% of the pixel's light, and of the picks there; together these lights are {} of the light",
            share(shown_lights.iter().map(|share| share.exact).sum())
        ),
        names: names.enumerate().map(|(i, name)| (name.to_owned(), Mark::nth(i, false))).collect(),
        groups: shown_lights
            .iter()
            .map(|share| {
                let bars = std::iter::once(share.exact).chain(share.chances.iter().copied());
                (name(stage.scene(), share.light), bars.collect())
            })
            .collect(),
    };
    Ok(Plate {
        title: "9  Picking lights".into(),
        subtitle: format!("{}, pixel {x},{y}", asked.scene_in_words()),
        rows: vec![Row::Panels(panels), Row::Bars(bars)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sources::small;
    use crate::strategy::Registry;

    #[test]
    fn shares_and_chances_are_whole_and_intensity_comes_nearest() {
        let scene = Scene::new(small::sixteen()).expect("a scene");
        let registry = Registry::standard();
        let asked = Asked { scene, pixel: None, seed: 1, registry: &registry };
        let stage = asked.stage().expect("a stage");
        let build = |(name, _): &(&str, &str)| {
            registry.parse(name).expect("a name").build(BuildContext { stage: &stage, seed: 1 }).expect("a sampler")
        };
        let samplers: Vec<_> = STRATEGIES.iter().map(build).collect();
        let at = usual(&stage, stage.receivers()).expect("a receiver");
        let shares = shares(&stage, &samplers, at, 1);
        assert_eq!(shares.len(), stage.scene().lights().len());
        assert!((shares.iter().map(|share| share.exact).sum::<f64>() - 1.0).abs() < 1e-9);
        assert!(shares.is_sorted_by(|a, b| a.exact >= b.exact));
        let apart = |which: usize| shares.iter().map(|share| (share.exact - share.chances[which]).abs()).sum::<f64>();
        for (which, (name, _)) in STRATEGIES.iter().enumerate() {
            let sum: f64 = shares.iter().map(|share| share.chances[which]).sum();
            assert!((sum - 1.0).abs() < 1e-5, "{name}: {sum}");
        }
        assert!(apart(2) < apart(0) && apart(2) < apart(1), "{} {} {}", apart(0), apart(1), apart(2));
    }
}
