//! Chapter 8: what is lost where each light ends at the distance at which it alone can no longer be seen?

use super::asked::Asked;
use super::colour::{Ramp, mapped};
use super::each::each;
use super::plate::{Drawing, Panel, Plate, Row};
use super::words::share;
use crate::base::colour::luminance;
use crate::base::error::Result;
use crate::report::{grouped, short};
use crate::scene::cutoff::{Cutoff, Transfer};
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::visibility::influence_tree::InfluenceTree;
use crate::visibility::stage::Stage;
use rayon::prelude::*;

/// The cut-off in display steps of 1/255, as the lecture has it.
const STEPS: f32 = 0.5;

/// One receiver's lights by the cut-off.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Dropped {
    /// Lights in range.
    listed: usize,
    /// Luminance in cd/m^2 of all lights, and of those out of range.
    all: f64,
    lost: f64,
    /// The greatest displayed value, in display steps, that one light out of range adds in any channel.
    brightest: f64,
}

fn dropped(stage: &Stage, tree: &InfluenceTree, at: &Receiver, seed: u64) -> Dropped {
    let lights = each(stage, at, seed);
    let mut list: Vec<LightId> = Vec::new();
    tree.list(at.position, &mut list);
    let mut is_listed = vec![false; lights.len()];
    list.iter().for_each(|light| is_listed[*light as usize] = true);
    let grey = |listed: bool| {
        let chosen = lights.iter().zip(&is_listed).filter(|(_, is)| listed || !**is);
        chosen.map(|(light, _)| f64::from(luminance(light.as_vec3()))).sum::<f64>()
    };
    let out = lights.iter().zip(&is_listed).filter(|(_, is)| !**is);
    let brightest = out.map(|(light, _)| light.max_element()).fold(0.0, f64::max);
    let steps = 255.0 * f64::from(stage.scene().exposure());
    Dropped { listed: list.len(), all: grey(true), lost: grey(false), brightest: brightest * steps }
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
    let shares: Vec<f64> =
        found.iter().map(|one| if one.all > 0.0 { 100.0 * one.lost / one.all } else { 0.0 }).collect();
    let sum = |of: fn(&Dropped) -> f64| found.iter().map(of).sum::<f64>();
    let most = |values: &[f64]| values.iter().fold(0.0f64, |most, value| most.max(*value));
    let brightest = found.iter().fold(0.0f64, |most, one| most.max(one.brightest));
    let lights = stage.scene().lights().len() as u64;
    let panels = vec![
        Panel {
            title: "Lights in range".into(),
            drawing: Drawing::Bitmap(mapped(&stage, &listed, Ramp::up_to(most(&listed)), "lights in range")),
            caption: format!(
                "{} of {} lights on average: those that can add half a display step, {STEPS}/255, to a pixel.",
                short(sum(|one| one.listed as f64) / found.len() as f64),
                grouped(lights)
            ),
        },
        Panel {
            title: "Light that the others would have added".into(),
            drawing: Drawing::Bitmap(mapped(
                &stage,
                &shares,
                Ramp::up_to(most(&shares)),
                "lost, % of the exact light of the pixel",
            )),
            caption: format!(
                "{} of all light is lost. The brightest light that was dropped would have added {} of a display step.",
                share(sum(|one| one.lost) / sum(|one| one.all).max(f64::MIN_POSITIVE)),
                short(brightest)
            ),
        },
    ];
    Ok(Plate {
        title: "8  Range: the cut-off".into(),
        subtitle: format!("{}; a linear display, as the cut-off is defined", asked.scene_in_words()),
        rows: vec![Row::Panels(panels)],
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
        let exposure = -1.5;
        let scene = Scene::new(Parts { ev100: Some(exposure), ..parts }).expect("a scene");
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
            let mut expected = Dropped { listed: 0, all: 0.0, lost: 0.0, brightest: 0.0 };
            for (light, adds) in stage.scene().lights().iter().zip(&adds) {
                let grey = f64::from(luminance(adds.as_vec3()));
                expected.all += grey;
                if in_range(light) {
                    expected.listed += 1;
                } else {
                    expected.lost += grey;
                    let shown = 255.0 * f64::from(stage.scene().exposure()) * adds.max_element();
                    expected.brightest = expected.brightest.max(shown);
                }
            }
            assert_eq!(found.listed, expected.listed, "pixel {}", at.pixel);
            for (found, expected) in
                [(found.all, expected.all), (found.lost, expected.lost), (found.brightest, expected.brightest)]
            {
                assert!((found - expected).abs() <= 1e-9 * expected, "pixel {}: {found} for {expected}", at.pixel);
            }
            assert!(found.brightest <= f64::from(STEPS) * 1.0001, "each dropped light is invisible alone");
            partly += u32::from(found.lost > 0.0 && found.lost < found.all);
        }
        assert!(partly > 100, "the cut-off drops something and keeps something at {partly} pixels");
    }
}
