//! Chapter 1: what is a shadow ray, where does it end, and when is none needed?

use super::asked::Asked;
use super::colour::{Ramp, mapped, shown};
use super::plate::{Drawing, Panel, Plate, Row};
use super::words::percent;
use crate::base::error::Result;
use crate::base::triangle::CENTROID;
use crate::report::grouped;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::{EarlyOut, contribution};
use crate::visibility::offset::Segment;
use crate::visibility::stage::Stage;
use glam::DVec3;
use rayon::prelude::*;

/// What becomes of the pairs of a receiver and a light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Found {
    /// Radiance in cd/m^2 without a test, with rays that do not end at the light, and with those that do.
    radiance: [DVec3; 3],
    /// The light sends nothing this way, or the receiver is behind it.
    dark: u64,
    /// The light is below the receiver's horizon.
    below: u64,
    /// Shadow rays.
    rays: u64,
    /// Shadow rays that something before the light blocks.
    blocked: u64,
    /// Shadow rays that only something beyond the light blocks, or the light itself.
    beyond: u64,
}

impl Found {
    fn add(self, other: Self) -> Self {
        Self {
            radiance: std::array::from_fn(|i| self.radiance[i] + other.radiance[i]),
            dark: self.dark + other.dark,
            below: self.below + other.below,
            rays: self.rays + other.rays,
            blocked: self.blocked + other.blocked,
            beyond: self.beyond + other.beyond,
        }
    }
}

/// All lights at one receiver; an area light is taken for its middle.
fn look(stage: &Stage, at: &Receiver) -> Found {
    let mut found = Found::default();
    for light in stage.scene().lights() {
        let arrival = match contribution::<0b1111>(LightSampling::Area, light, CENTROID, at) {
            Ok(arrival) => arrival,
            Err(EarlyOut::BehindSurface) => {
                found.below += 1;
                continue;
            }
            Err(EarlyOut::ZeroIntensity | EarlyOut::BehindLight) => {
                found.dark += 1;
                continue;
            }
        };
        let radiance = arrival.radiance.as_dvec3();
        let ray = stage.ray_ends().segment(at, light, arrival.direction, arrival.distance);
        let endless = Segment::bare(ray.origin, ray.along, ray.t_min, f32::INFINITY);
        let (seen, free) = (stage.occluders().visible(&ray), stage.occluders().visible(&endless));
        found.rays += 1;
        found.radiance[0] += radiance;
        if seen {
            found.radiance[2] += radiance;
        }
        if seen && free {
            found.radiance[1] += radiance;
        }
        found.blocked += u64::from(!seen);
        found.beyond += u64::from(seen && !free);
    }
    found
}

pub(super) fn draw(asked: &Asked<'_>) -> Result<Plate> {
    let stage = asked.stage()?;
    let each: Vec<Found> = stage.receivers().par_iter().map(|at| look(&stage, at)).collect();
    let all = each.iter().fold(Found::default(), |all, found| all.add(*found));
    let picture = |which: usize| {
        let radiance: Vec<DVec3> = each.iter().map(|found| found.radiance[which]).collect();
        Drawing::Bitmap(shown(&stage, &radiance))
    };
    let rays: Vec<f64> = each.iter().map(|found| found.rays as f64).collect();
    let most = rays.iter().fold(1.0, |most: f64, rays| most.max(*rays));
    let pairs = all.dark + all.below + all.rays;
    let panels = [
        Panel {
            title: "No shadow test".into(),
            drawing: picture(0),
            caption: format!(
                "Light passes through everything: in truth {} of these contributions are blocked.",
                percent(all.blocked, all.rays)
            ),
        },
        Panel {
            title: "Shadow rays that do not end at the light".into(),
            drawing: picture(1),
            caption: format!(
                "What lies beyond a light blocks it as well: {} of the contributions that should arrive are lost.",
                percent(all.beyond, all.rays - all.blocked)
            ),
        },
        Panel {
            title: "Shadow rays that end at the light: right".into(),
            drawing: picture(2),
            caption: format!(
                "{} of {} shadow rays meet something before the light.",
                grouped(all.blocked),
                grouped(all.rays)
            ),
        },
        Panel {
            title: "Shadow rays cast at each pixel".into(),
            drawing: Drawing::Bitmap(mapped(&stage, &rays, Ramp::counts(most), "shadow rays")),
            caption: format!(
                "Early outs save {} of {} shadow rays: {} because the light sends nothing this way, {} because it is below \
                 the horizon of the surface (N·L ≤ 0).",
                percent(all.dark + all.below, pairs),
                grouped(pairs),
                percent(all.dark, pairs),
                percent(all.below, pairs)
            ),
        },
    ];
    let mut rows = Vec::new();
    let mut panels = panels.into_iter();
    while let Some(first) = panels.next() {
        rows.push(Row::Panels(std::iter::once(first).chain(panels.next()).collect()));
    }
    Ok(Plate { title: "1  Shadow rays".into(), subtitle: asked.scene_in_words(), rows })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lecture::asked::ready;
    use crate::scene::Scene;
    use crate::sources::small;
    use crate::visibility::offset::Offset;
    use glam::Vec3;

    /// A lamp 3 m over the ground, one below it, and a slab over the lamp.
    fn under_a_slab(lamp: f32) -> Stage {
        let lights = vec![small::point(Vec3::new(0.0, 0.0, lamp), 100.0), small::point(Vec3::NEG_Z, 100.0)];
        let mut parts = small::ground(12.0, lights);
        parts.surfaces.extend(small::cuboid(Vec3::new(-30.0, -30.0, 20.0), Vec3::new(30.0, 30.0, 20.5)));
        ready(Scene::new(parts).expect("a scene"), Offset::SCALED).expect("a stage")
    }

    #[test]
    fn only_rays_without_an_end_meet_what_lies_beyond_the_light() {
        let stage = under_a_slab(3.0);
        for at in stage.receivers().iter().filter(|at| at.position.length() < 4.0) {
            let found = look(&stage, at);
            assert_eq!((found.rays, found.below, found.dark), (1, 1, 0), "{}", at.position);
            assert_eq!((found.blocked, found.beyond), (0, 1), "{}", at.position);
            let [open, endless, right] = found.radiance;
            assert!(open == right && endless == DVec3::ZERO, "{open} {endless} {right}");
        }
    }

    #[test]
    fn what_lies_before_the_light_blocks_either_ray() {
        let stage = under_a_slab(30.0);
        let at = stage.receivers().iter().find(|at| at.position.length() < 5.0).expect("ground below the lamp");
        let found = look(&stage, at);
        assert_eq!((found.blocked, found.beyond), (1, 0));
        assert!(found.radiance[0] != DVec3::ZERO && found.radiance[2] == DVec3::ZERO);
    }
}
