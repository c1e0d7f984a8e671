//! How do radiance and other quantities become pixels?

use super::plate::{Bitmap, ColourBar};
use crate::image::map::magma;
use crate::image::png::texels;
use crate::render::picture::picture;
use crate::report::{Scale, ticks};
use crate::visibility::stage::Stage;
use crate::visibility::view::Seen;
use glam::DVec3;

/// The sky and the dark backs of emitters in a map, and emitters' fronts: greys, which the colour map has not.
const SKY: [u8; 3] = [120; 3];
const EMITTER: [u8; 3] = [200; 3];

/// What the camera sees, in display colours; radiance in cd/m^2 of each receiver.
pub(super) fn shown(stage: &Stage, radiance: &[DVec3]) -> Bitmap {
    let rounded: Vec<_> = radiance.iter().map(|radiance| radiance.as_vec3()).collect();
    bitmap(stage, texels(&picture(stage, &rounded), stage.scene().exposure()), None)
}

/// How values become colours.
#[derive(Clone, Copy)]
pub(super) struct Ramp {
    /// The values at the ends of the colour bar.
    ends: [f64; 2],
    /// Whether equal factors are equal steps; the ends are above 0 then.
    logarithmic: bool,
    /// Whether all values are whole.
    whole: bool,
}

impl Ramp {
    /// From 0 to a value.
    pub(super) fn up_to(high: f64) -> Self {
        Self { ends: [0.0, if high > 0.0 { high } else { 1.0 }], logarithmic: false, whole: false }
    }

    /// From 0 to a number of things.
    pub(super) fn counts(high: f64) -> Self {
        Self { whole: true, ..Self::up_to(high) }
    }

    /// By factors, from the least of the values that are above 0 to the greatest: at least one decade, at most three.
    pub(super) fn decades(values: &[f64]) -> Self {
        let (low, high) = values
            .iter()
            .filter(|value| **value > 0.0 && value.is_finite())
            .fold((f64::INFINITY, 0.0f64), |(low, high), &value| (low.min(value), high.max(value)));
        let high = if high > 0.0 { high } else { 1.0 };
        Self { ends: [low.clamp(1e-3 * high, 0.1 * high), high], logarithmic: true, whole: false }
    }

    fn place(self, value: f64) -> f64 {
        let [low, high] = self.ends;
        let place = if self.logarithmic {
            (value.max(f64::MIN_POSITIVE) / low).ln() / (high / low).ln()
        } else {
            (value - low) / (high - low)
        };
        place.clamp(0.0, 1.0)
    }
}

/// A value of each receiver in false colour, dark for little and pale for much; `label` names it with its unit.
pub(super) fn mapped(stage: &Stage, values: &[f64], ramp: Ramp, label: &str) -> Bitmap {
    let texel = |seen: &Seen| match seen {
        Seen::Sky | Seen::EmitterBack => SKY,
        Seen::Emitter(_) => EMITTER,
        Seen::Receiver(index) => magma(ramp.place(values[*index as usize])),
    };
    let scale = Scale { label: label.to_owned(), logarithmic: ramp.logarithmic };
    let mut ticks = ticks(&scale, ramp.ends);
    ticks.retain(|(_, value)| !ramp.whole || value.parse::<u64>().is_ok());
    let bar = ColourBar { label: label.to_owned(), ticks };
    bitmap(stage, stage.view().pixels().iter().map(texel).collect(), Some(bar))
}

fn bitmap(stage: &Stage, texels: Vec<[u8; 3]>, bar: Option<ColourBar>) -> Bitmap {
    let (width, height) = stage.view().resolution();
    Bitmap { width, height, texels, bar, cross: None, line: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_run_from_one_end_to_the_other() {
        let decades = Ramp::decades(&[0.0, 0.01, 1.0, f64::NAN]);
        assert_eq!(decades.ends, [0.01, 1.0]);
        for (value, place) in [(0.0, 0.0), (0.01, 0.0), (0.1, 0.5), (1.0, 1.0), (7.0, 1.0)] {
            assert!((decades.place(value) - place).abs() < 1e-12, "{value}");
        }
        assert_eq!(Ramp::up_to(4.0).place(1.0), 0.25);
        assert_eq!(Ramp::up_to(0.0).place(0.0), 0.0, "nothing at all is still a map");
        assert_eq!(Ramp::decades(&[3.0]).ends, [0.1 * 3.0, 3.0]);
        assert_eq!(Ramp::decades(&[1e-9, 2.0]).ends, [1e-3 * 2.0, 2.0]);
    }
}
