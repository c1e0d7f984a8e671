//! What do set-up and sampling cost, by strategy and number of lights? See [`citylights::bench::strategies`].

use citylights::base::error::Result;
use citylights::strategy::Registry;
use std::path::Path;

/// Points alone; every kind in a small street; ten thousand lights in canyons.
const SCENES: [&str; 3] = ["scenes/lamps-only.toml", "scenes/first-night.toml", "scenes/downtown.toml"];

fn main() -> Result<()> {
    citylights::bench::strategies(&Registry::standard(), &SCENES.map(Path::new))
}
