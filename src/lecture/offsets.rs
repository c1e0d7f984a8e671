//! Chapter 2: where does a shadow ray start, so that its own surface does not block it?

use super::asked::{Asked, ready};
use super::colour::shown;
use super::plate::{Drawing, Panel, Plate, Row};
use super::words::{metres, percent};
use crate::base::error::{Error, Result};
use crate::base::triangle::CENTROID;
use crate::report::grouped;
use crate::scene::Scene;
use crate::scene::light::Kind;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::stability::tracer::{Tracer, Truth, tolerance};
use crate::visibility::offset::Offset;
use crate::visibility::stage::Stage;
use glam::DVec3;
use rayon::prelude::*;

/// How far the scene is moved, in m: a push of 1e-4 m does nothing from 2,048 m on.
const FAR: f64 = 10_000.0;

/// Most tests of a ray against a triangle that the truth may take: some ten seconds.
const MOST_TESTS: f64 = 4e9;

/// What a policy makes of a picture.
#[derive(Debug, Default)]
struct Outcome {
    /// Radiance in cd/m^2.
    radiance: Vec<DVec3>,
    /// Pixels at which a light is seen or not against the truth.
    wrong: u64,
    /// Pixels at which the truth hangs on less than the tolerance, and nothing is wrong otherwise.
    undecided: u64,
    /// In m.
    tolerance: f64,
}

/// Each light at one receiver, an area light by its middle: radiance under the policy, whether any is wrong, whether any
/// is undecided.
fn look(stage: &Stage, tracer: &Tracer, tolerance: f64, at: &Receiver) -> (DVec3, bool, bool) {
    let (mut radiance, mut wrong, mut undecided) = (DVec3::ZERO, false, false);
    let mut emitter = stage.scene().surfaces().len();
    for light in stage.scene().lights() {
        let own = (light.kind() == Kind::Triangle).then_some(emitter);
        emitter += usize::from(own.is_some());
        let Ok(arrival) = contribution::<0b1111>(LightSampling::Area, light, CENTROID, at) else { continue };
        let ray = stage.ray_ends().segment(at, light, arrival.direction, arrival.distance);
        let seen = stage.occluders().visible(&ray);
        if seen {
            radiance += arrival.radiance.as_dvec3();
        }
        match tracer.sees(tolerance, at, (light, own), CENTROID).0 {
            Truth::Undecided => undecided = true,
            truth => wrong |= seen != (truth == Truth::Lit),
        }
    }
    (radiance, wrong, undecided)
}

fn outcome(stage: &Stage) -> Outcome {
    let scene = stage.scene();
    let (tracer, tolerance) = (Tracer::new(scene), tolerance(scene));
    let found: Vec<_> = stage.receivers().par_iter().map(|at| look(stage, &tracer, tolerance, at)).collect();
    Outcome {
        wrong: found.iter().filter(|(_, wrong, _)| *wrong).count() as u64,
        undecided: found.iter().filter(|(_, wrong, undecided)| *undecided && !wrong).count() as u64,
        radiance: found.into_iter().map(|(radiance, ..)| radiance).collect(),
        tolerance,
    }
}

pub(super) fn draw(asked: &Asked<'_>) -> Result<Plate> {
    let scene = &asked.scene;
    let (width, height) = scene.camera().resolution();
    let triangles = scene.surfaces().len() + scene.lights().len();
    let tests = 4.0 * f64::from(width) * f64::from(height) * scene.lights().len() as f64 * triangles as f64;
    if tests > MOST_TESTS {
        return Err(Error::Invalid(format!(
            "{}: this chapter tries every triangle for each shadow ray to know the truth, {tests:.1e} tests here and at most \
             {MOST_TESTS:.0e}; give a smaller scene or fewer pixels",
            scene.name()
        )));
    }
    let far = || Scene::new(scene.parts().baked(FAR));
    let cases = [
        ("No offset, near the origin", scene.clone(), Offset::NONE, "The surface blocks its own rays: shadow acne."),
        (
            "Origin pushed by 1e-4 m, near the origin",
            scene.clone(),
            Offset::ORIGIN_PUSH,
            "The same scene without acne.",
        ),
        (
            "Origin pushed by 1e-4 m, 10 km away",
            far()?,
            Offset::ORIGIN_PUSH,
            "There the push is less than half a step of the coordinates and is rounded away.",
        ),
        ("Push grown with the coordinates, 10 km away", far()?, Offset::SCALED, "The default."),
    ];
    let mut panels = Vec::new();
    for (title, scene, offset, says) in cases {
        let stage = ready(scene, offset)?;
        let Outcome { radiance, wrong, undecided, tolerance } = outcome(&stage);
        let all = stage.receivers().len() as u64;
        let hang = match undecided {
            0 => String::new(),
            some => {
                format!(" At {} more, less than {} decides: they are not judged.", grouped(some), metres(tolerance))
            }
        };
        panels.push(Panel {
            title: title.into(),
            drawing: Drawing::Bitmap(shown(&stage, &radiance)),
            caption: format!(
                "{says} {} of {} pixels are wrong ({}).{hang}",
                grouped(wrong),
                grouped(all),
                percent(wrong, all)
            ),
        });
    }
    let below = panels.split_off(2);
    Ok(Plate {
        title: "2  Where a shadow ray starts".into(),
        subtitle: format!(
            "{}; the truth is traced in f64, without the two ends' own triangles",
            asked.scene_in_words()
        ),
        rows: vec![Row::Panels(panels), Row::Panels(below)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sources::small;
    use glam::Vec3;

    /// A slope under a lamp, so that heights are rounded.
    fn slope(far: f64, offset: Offset) -> Outcome {
        let mut parts = small::ground(12.0, vec![small::point(Vec3::new(0.5, 0.25, 4.0), 100.0)]);
        for surface in &mut parts.surfaces {
            surface.corners = surface.corners.map(|corner| corner + Vec3::Z * 0.11 * corner.x);
        }
        parts.surfaces.extend(small::cuboid(Vec3::new(1.5, 2.0, -1.0), Vec3::new(2.5, 3.0, 2.0)));
        let scene = Scene::new(parts.baked(far)).expect("a scene");
        outcome(&ready(scene, offset).expect("a stage"))
    }

    #[test]
    fn no_offset_shows_acne_and_the_default_none() {
        let pixels = slope(0.0, Offset::SCALED).radiance.len() as u64;
        assert!(pixels > 500);
        let none = slope(0.0, Offset::NONE).wrong;
        assert!(none > pixels / 5, "{none} of {pixels}");
        assert_eq!(slope(0.0, Offset::SCALED).wrong, 0);
        assert_eq!(slope(0.0, Offset::ORIGIN_PUSH).wrong, 0);
        assert_eq!(slope(FAR, Offset::SCALED).wrong, 0);
        let pushed = slope(FAR, Offset::ORIGIN_PUSH).wrong;
        assert!(pushed > pixels / 10, "{pushed} of {pixels}");
    }
}
