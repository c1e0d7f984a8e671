//! Promise: the shipped scenes are what the README says, and look like cities at night.
#![cfg(all(feature = "recipe", feature = "measure"))]

use citylights::inspect::{Inspection, inspect};
use citylights::scene::Scene;
use citylights::scene::light::Kind;
use citylights::scene::needs::Needs;
use citylights::sources::Overrides;
use citylights::sources::recipe::load;
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use std::path::Path;

fn scene(name: &str) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.toml"));
    load(&file, &Overrides::default()).expect("a shipped scene")
}

fn look(name: &str) -> Inspection {
    inspect(&Stage::new(scene(name), LeaveOut::Yes, Offset::SCALED))
}

#[test]
fn shipped_cities_are_lit_like_cities() {
    for name in ["first-night", "downtown", "plaza", "lamps-only"] {
        let pixels = look(name).pixels;
        let lx = pixels.street_lx.expect("a street is seen");
        let above = pixels.street_above_step_share.expect("a street is seen");
        assert!((5.0..=30.0).contains(&lx), "{name}: mean street illuminance {lx} lx, 5 to 30 are right");
        assert!(
            pixels.clipped_share < 0.02,
            "{name}: {} of the pixels are clipped, under 0.02 is right",
            pixels.clipped_share
        );
        assert!(above >= 0.4, "{name}: {above} of the street is above one display step, 0.4 is right");
    }
}

#[test]
fn shipped_scenes_have_the_lights_they_promise() {
    assert!(scene("first-night").lights().len() >= 900);
    let (width, height) = scene("first-night").camera().resolution();
    assert!(width >= 160 && height >= 90);
    assert_eq!(scene("downtown").lights().len(), 10_000);
    assert_eq!(scene("metropolis").lights().len(), 100_000);
    assert_eq!(Needs::of(&scene("lamps-only")).kinds, Kind::Point.bit());
    assert!(!Needs::of(&scene("downtown")).has(Kind::Directional));
    assert!(Needs::of(&scene("moonlit")).has(Kind::Directional));
}

#[test]
fn nothing_occludes_in_the_plaza_and_something_does_elsewhere() {
    assert!(!Needs::of(&scene("plaza")).occlusion);
    for name in ["first-night", "downtown", "lamps-only", "stadium", "moonlit", "shadows"] {
        assert!(Needs::of(&scene(name)).occlusion, "{name}");
    }
}
