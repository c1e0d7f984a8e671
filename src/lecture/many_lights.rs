//! Chapter 7: of many lights, how many matter at a point?

use super::asked::Asked;
use super::colour::{Ramp, mapped, shown};
use super::each::each;
use super::plate::{Drawing, Panel, Plate, Row};
use super::words::{rounded, share};
use crate::base::colour::luminance;
use crate::base::error::Result;
use crate::base::statistics::quantile;
use crate::report::grouped;
use glam::DVec3;
use rayon::prelude::*;

/// The share of the light that is looked for.
const MOST: f64 = 0.9;

/// How few of the lights carry [`MOST`] of the whole; `None` where there is no light.
fn carrying(mut lights: Vec<f64>) -> Option<usize> {
    let whole: f64 = lights.iter().sum();
    if whole <= 0.0 {
        return None;
    }
    lights.sort_unstable_by(|a, b| b.total_cmp(a));
    let mut sum = 0.0;
    let enough = lights.iter().position(|light| {
        sum += light;
        sum >= MOST * whole
    });
    // Rounding may leave the last sum short.
    Some(enough.map_or(lights.len(), |at| at + 1))
}

pub(super) fn draw(asked: &Asked<'_>) -> Result<Plate> {
    let stage = asked.stage()?;
    let found: Vec<(DVec3, usize, Option<usize>)> = stage
        .receivers()
        .par_iter()
        .map(|at| {
            let lights = each(&stage, at, asked.seed);
            let grey: Vec<f64> = lights.iter().map(|light| f64::from(luminance(light.as_vec3()))).collect();
            (lights.iter().sum(), grey.iter().filter(|light| **light > 0.0).count(), carrying(grey))
        })
        .collect();
    let all = stage.scene().lights().len();
    let radiance: Vec<DVec3> = found.iter().map(|(radiance, ..)| *radiance).collect();
    let counts: Vec<f64> = found.iter().map(|(.., count)| count.map_or(0.0, |count| count as f64)).collect();
    let middle = |mut values: Vec<f64>| {
        values.sort_unstable_by(f64::total_cmp);
        if values.is_empty() { 0.0 } else { quantile(&values, 0.5) }
    };
    let lit = middle(found.iter().filter(|(.., count)| count.is_some()).map(|(_, adds, _)| *adds as f64).collect());
    let carry = middle(counts.iter().copied().filter(|count| *count > 0.0).collect());
    let panels = vec![
        Panel {
            title: format!("All {} lights", grouped(all as u64)),
            drawing: Drawing::Bitmap(shown(&stage, &radiance)),
            caption: format!(
                "At half of the pixels {} lights or fewer add anything at all: the others face away, lie below the horizon or are \
                 hidden.",
                rounded(lit)
            ),
        },
        Panel {
            title: format!("How many lights carry {} of the light", share(MOST)),
            drawing: Drawing::Bitmap(mapped(&stage, &counts, Ramp::decades(&counts), "lights, the brightest first")),
            caption: format!(
                "Median: {} of {} lights, {}.",
                rounded(carry),
                grouped(all as u64),
                share(carry / all.max(1) as f64)
            ),
        },
    ];
    Ok(Plate { title: "7  Many lights".into(), subtitle: asked.scene_in_words(), rows: vec![Row::Panels(panels)] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fewest_lights_are_counted() {
        assert_eq!(carrying(vec![0.0, 0.0]), None);
        assert_eq!(carrying(vec![0.0, 5.0, 0.0]), Some(1));
        assert_eq!(carrying(vec![1.0, 85.0, 5.0, 9.0]), Some(2));
        assert_eq!(carrying(vec![1.0; 10]), Some(9));
        assert_eq!(carrying(vec![0.1; 100]), Some(90));
    }
}
