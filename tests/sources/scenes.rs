//! Promise: the shipped scenes are what the README and their comments say, and look like cities at night.
#![cfg(feature = "recipe")]

use citylights::scene::Scene;
use citylights::scene::light::{Kind, Shape};
use citylights::sources::Overrides;
use citylights::sources::recipe::load;
use std::path::Path;

fn scene(name: &str) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.toml"));
    load(&file, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[cfg(feature = "cli")]
#[test]
fn shipped_cities_are_lit_like_cities() {
    for name in ["first-night", "downtown", "plaza", "lamps-only"] {
        let mut inspect = assert_cmd::Command::cargo_bin("citylights").expect("the binary");
        let output = inspect.args(["inspect", &format!("scenes/{name}.toml"), "--json"]).assert().success();
        let found: serde_json::Value = serde_json::from_slice(&output.get_output().stdout).expect("JSON");
        let pixels = |field: &str| found["pixels"][field].as_f64().unwrap_or_else(|| panic!("{name}: {found}"));
        let (lx, clipped, above) = (pixels("street_lx"), pixels("clipped_share"), pixels("street_above_step_share"));
        assert!((5.0..=30.0).contains(&lx), "{name}: mean street illuminance {lx} lx, 5 to 30 are right");
        assert!(clipped < 0.02, "{name}: {clipped} of the pixels are clipped, under 0.02 is right");
        assert!(above >= 0.4, "{name}: {above} of the street is above one display step, 0.4 is right");
    }
}

#[test]
fn the_shipped_recipes_are_what_their_comments_say() {
    let count = |scene: &Scene, kind: Kind| scene.lights().iter().filter(|light| light.kind() == kind).count();
    let first = scene("first-night");
    assert!(first.lights().len() >= 900 && first.camera().resolution() == (160, 90));
    assert!(Kind::ALL.iter().all(|&kind| count(&first, kind) > 0), "every kind of light");
    let downtown = scene("downtown");
    assert!(downtown.lights().len() == 10_000 && count(&downtown, Kind::Directional) == 0);
    let lamps = scene("lamps-only");
    assert_eq!(count(&lamps, Kind::Point), lamps.lights().len());
    assert!(lamps.surfaces().len() > 1_000);
    let moonlit = scene("moonlit");
    assert!(count(&moonlit, Kind::Directional) == 1 && count(&moonlit, Kind::Triangle) == 0);
    let stadium = scene("stadium");
    let mut flux: Vec<f32> = stadium.lights().iter().map(|light| light.flux(1.0).element_sum()).collect();
    flux.sort_by(f32::total_cmp);
    let (all, few): (f32, f32) = (flux.iter().sum(), flux[flux.len() - 24..].iter().sum());
    assert!(few > 0.3 * all, "24 of {} lights have {} of the flux", flux.len(), few / all);
    assert_eq!(scene("metropolis").lights().len(), 100_000);
    assert!((999_999..=1_000_000).contains(&scene("megacity").lights().len()));
}

#[test]
fn every_light_of_the_plaza_stands_before_every_surface() {
    let scene = scene("plaza");
    assert!((4_000..=10_000).contains(&scene.lights().len()));
    for surface in scene.surfaces() {
        let [a, b, c] = surface.corners;
        let normal = (b - a).cross(c - a).normalize();
        let in_front = |p: glam::Vec3| normal.dot(p - a);
        assert!(in_front(scene.camera().position()) > 0.0);
        for light in scene.lights() {
            let (Shape::Point { position, .. } | Shape::Spot { position, .. }) = light.shape() else {
                panic!("{light:?} would occlude")
            };
            assert!(in_front(position) > 0.05, "{light:?} stands behind {surface:?}");
        }
        let corners = scene.surfaces().iter().flat_map(|other| other.corners);
        assert!(corners.map(in_front).all(|d| d > -1e-3), "the room is convex: {surface:?}");
    }
}
