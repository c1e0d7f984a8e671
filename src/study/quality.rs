//! How good is a choice of lights, before any ray is cast?
//!
//! With f the unshadowed contribution of a light at its centroid (a luminance) and n how often it is expected to be
//! picked in a call, the second moment of the estimate of F = sum f is sum f^2 / n for one pick, so that its relative
//! variance is
//!
//! ```text
//! sum f^2 / n / F^2 - 1
//! ```
//!
//! exactly, of one pick. Of k independent picks (n is then k times the probability) the relative variance is sum f^2 /
//! n / F^2 - 1 / k; to compare strategies that pick differently often, all are brought to one pick: max(1, N) sum f^2 /
//! n / F^2 - 1 with N = sum n. Where picks are not independent (lists, splitting) this is an upper bound, since such
//! picks vary less together.

use crate::base::colour::luminance;
use crate::base::triangle::CENTROID;
use crate::scene::light::Light;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::strategy::AnySampler;
use crate::visibility::stage::Stage;

/// What a sampler is worth at a receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quality {
    /// Relative variance brought to one pick; infinite where a light that contributes is never picked.
    pub variance: f64,
    /// Expected picks a call.
    pub picks: f64,
}

/// Unshadowed contribution of a light at its centroid, as a luminance in cd/m^2.
pub(crate) fn unshadowed(light: &Light, at: &Receiver) -> f64 {
    contribution::<0b1111>(LightSampling::Area, light, CENTROID, at)
        .map_or(0.0, |arrival| f64::from(luminance(arrival.radiance)))
}

/// What can be said of a sampler at a receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Finding {
    /// No light contributes: nothing is to be chosen.
    Dark,
    /// The sampler cannot tell its expected counts.
    Unknown,
    /// It can.
    Known(Quality),
}

/// The quality of a sampler at a receiver; `counts` is scratch.
pub(crate) fn quality(stage: &Stage, sampler: &dyn AnySampler, at: &Receiver, counts: &mut Vec<f32>) -> Finding {
    let lights = stage.scene().lights();
    let contributions = || lights.iter().map(|light| unshadowed(light, at));
    let total: f64 = contributions().sum();
    if total <= 0.0 {
        return Finding::Dark;
    }
    counts.clear();
    counts.resize(lights.len(), 0.0);
    if !sampler.expected_counts(at, counts) {
        return Finding::Unknown;
    }
    let (mut moment, mut picks) = (0.0, 0.0);
    for (f, &count) in contributions().zip(&*counts) {
        let count = f64::from(count);
        picks += count;
        if f > 0.0 {
            moment += f * f / count;
        }
    }
    Finding::Known(Quality { variance: picks.max(1.0) * moment / (total * total) - 1.0, picks })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::triangle::uniform_point;

    #[test]
    fn the_centroid_has_equal_weights() {
        let [b, c] = uniform_point(CENTROID);
        assert!((b - 1.0 / 3.0).abs() < 1e-6 && (c - 1.0 / 3.0).abs() < 1e-6, "{b}, {c}");
    }
}
