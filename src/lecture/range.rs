//! Chapter 8: what is lost where each light ends at the distance at which it alone can no longer be seen?

use super::asked::Asked;
use super::colour::{Ramp, mapped, shown};
use super::each::each;
use super::plate::{Drawing, Panel, Plate, Row};
use super::words::{rounded, share};
use crate::base::colour::luminance;
use crate::base::error::Result;
use crate::report::grouped;
use crate::scene::cutoff::{Cutoff, Transfer};
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::visibility::influence_tree::InfluenceTree;
use crate::visibility::stage::Stage;
use glam::DVec3;
use rayon::prelude::*;

/// The cut-off in display steps of 1/255, as the lecture has it.
const STEPS: f32 = 0.5;

/// One receiver's lights by the cut-off.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Dropped {
    /// Lights in range.
    listed: usize,
    /// Radiance in cd/m^2 of all lights, and of those out of range.
    all: DVec3,
    lost: DVec3,
    /// The greatest displayed value, in display steps, that one light out of range adds in any channel.
    brightest: f64,
}

fn dropped(stage: &Stage, tree: &InfluenceTree, at: &Receiver, seed: u64) -> Dropped {
    let lights = each(stage, at, seed);
    let mut list: Vec<LightId> = Vec::new();
    tree.list(at.position, &mut list);
    let mut is_listed = vec![false; lights.len()];
    list.iter().for_each(|light| is_listed[*light as usize] = true);
    let out = || lights.iter().zip(&is_listed).filter(|(_, is)| !**is).map(|(light, _)| *light);
    let brightest = out().map(DVec3::max_element).fold(0.0, f64::max);
    let steps = 255.0 * f64::from(stage.scene().exposure());
    Dropped { listed: list.len(), all: lights.iter().sum(), lost: out().sum(), brightest: brightest * steps }
}

fn grey(radiance: DVec3) -> f64 {
    f64::from(luminance(radiance.as_vec3()))
}

fn tree(stage: &Stage) -> InfluenceTree {
    let every: Vec<LightId> = (0..stage.scene().lights().len() as LightId).collect();
    InfluenceTree::new(stage.scene(), &every, Cutoff::new(stage.scene(), STEPS, Transfer::Linear))
}

pub(super) fn draw(asked: &Asked<'_>) -> Result<Plate> {
    let stage = asked.stage()?;
    let tree = tree(&stage);
    let receivers = stage.receivers();
    let found: Vec<Dropped> = receivers.par_iter().map(|at| dropped(&stage, &tree, at, asked.seed)).collect();
    let listed: Vec<f64> = found.iter().map(|one| one.listed as f64).collect();
    let shares = found.iter().map(|one| if grey(one.all) > 0.0 { 100.0 * grey(one.lost) / grey(one.all) } else { 0.0 });
    let shares: Vec<f64> = shares.collect();
    let sum = |of: fn(&Dropped) -> f64| found.iter().map(of).sum::<f64>();
    let most = |values: &[f64]| values.iter().fold(0.0f64, |most, value| most.max(*value));
    let brightest = found.iter().fold(0.0f64, |most, one| most.max(one.brightest));
    let lights = stage.scene().lights().len() as u64;
    let picture = |of: fn(&Dropped) -> DVec3| {
        let radiance: Vec<DVec3> = found.iter().map(of).collect();
        Drawing::Bitmap(shown(&stage, &radiance))
    };
    let pictures = vec![
        Panel {
            title: format!("All {} lights", grouped(lights)),
            drawing: picture(|one| one.all),
            caption: "The exact picture.".into(),
        },
        Panel {
            title: "At each pixel the lights in range alone".into(),
            drawing: picture(|one| one.all - one.lost),
            caption: format!(
                "{} of all light is lost. Yet the brightest light that is left out anywhere adds {} of a display step.",
                share(sum(|one| grey(one.lost)) / sum(|one| grey(one.all)).max(f64::MIN_POSITIVE)),
                rounded(brightest)
            ),
        },
    ];
    let maps = vec![
        Panel {
            title: "Lights in range".into(),
            drawing: Drawing::Bitmap(mapped(&stage, &listed, Ramp::counts(most(&listed)), "lights in range")),
            caption: format!(
                "{} of {} on average. Out of range, a light adds less than half a display step, {STEPS}/255, even to the brightest \
                 surface that faces it.",
                rounded(sum(|one| one.listed as f64) / found.len() as f64),
                grouped(lights)
            ),
        },
        Panel {
            title: "What is lost".into(),
            drawing: Drawing::Bitmap(mapped(
                &stage,
                &shares,
                Ramp::up_to(most(&shares)),
                "% of the pixel's light that the others add",
            )),
            caption: "The more lights beyond their range, the more is lost: each is invisible, their sum is not."
                .into(),
        },
    ];
    Ok(Plate {
        title: "8  Range: the cut-off".into(),
        subtitle: format!("{}; a linear display, as the cut-off is defined", asked.scene_in_words()),
        rows: vec![Row::Panels(pictures), Row::Panels(maps)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lecture::asked::ready;
    use crate::scene::light::Kind;
    use crate::scene::{Parts, Scene};
    use crate::sources::small;
    use crate::visibility::offset::Offset;
    use std::f32::consts::PI;

    #[test]
    fn the_figures_are_those_of_brute_force() {
        // Bare lamps alone: they have no side on which they are dark, and no noise.
        let mut parts = small::sixteen();
        parts.lights.retain(|light| matches!(light, crate::scene::light::Shape::Point { .. }));
        let scene = Scene::new(Parts { ev100: Some(4.8), ..parts }).expect("a scene");
        let stage = ready(scene, Offset::SCALED).expect("a stage");
        let tree = tree(&stage);
        let albedo = stage.scene().materials().iter().fold(0.0f32, |most, m| most.max(m.albedo.max_element()));
        let mut partly = 0;
        for at in stage.receivers() {
            let found = dropped(&stage, &tree, at, 1);
            let adds = each(&stage, at, 1);
            // Displayed at its brightest: intensity over squared distance on the brightest material.
            let in_range = |light: &crate::scene::light::Light| {
                assert_eq!(light.kind(), Kind::Point);
                let d2 = light.position.distance_squared(at.position);
                let displayed = stage.scene().exposure() * albedo / PI * light.colour.max_element() / d2;
                displayed >= STEPS / 255.0
            };
            let mut expected = Dropped { listed: 0, all: DVec3::ZERO, lost: DVec3::ZERO, brightest: 0.0 };
            for (light, adds) in stage.scene().lights().iter().zip(&adds) {
                expected.all += adds;
                if in_range(light) {
                    expected.listed += 1;
                } else {
                    expected.lost += adds;
                    let shown = 255.0 * f64::from(stage.scene().exposure()) * adds.max_element();
                    expected.brightest = expected.brightest.max(shown);
                }
            }
            assert_eq!(found.listed, expected.listed, "pixel {}", at.pixel);
            for (found, expected) in [(found.all, expected.all), (found.lost, expected.lost)] {
                assert!((found - expected).length() <= 1e-9 * expected.length(), "pixel {}: {found}", at.pixel);
            }
            assert!((found.brightest - expected.brightest).abs() <= 1e-9 * expected.brightest, "pixel {}", at.pixel);
            assert!(found.brightest <= f64::from(STEPS) * 1.0001, "each dropped light is invisible alone");
            partly += u32::from(found.lost != DVec3::ZERO && found.lost != found.all);
        }
        assert!(partly > 100, "the cut-off drops something and keeps something at {partly} pixels");
    }
}
