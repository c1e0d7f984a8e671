//! What a shipped scene is said to need is what is in it.

use citylights::scene::light::Kind;
use citylights::scene::needs::Needs;
use citylights::sources::Overrides;
use citylights::sources::recipe::load;
use std::path::Path;

fn needs(name: &str) -> Needs {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.toml"));
    Needs::of(&load(&file, &Overrides::default()).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn only_kinds_of_light_that_are_there_are_needed() {
    assert_eq!(needs("lamps-only").kinds, Kind::Point.bit());
    assert!(!needs("downtown").has(Kind::Directional) && needs("moonlit").has(Kind::Directional));
}

#[test]
fn nothing_occludes_in_the_plaza_and_something_does_elsewhere() {
    assert!(!needs("plaza").occlusion);
    for name in ["first-night", "downtown", "lamps-only", "stadium", "moonlit", "shadows"] {
        assert!(needs(name).occlusion, "{name}");
    }
}
