//! Scenes from TOML files.
//!
//! A recipe is a camera and what it looks at: a generated `[city]`, surfaces and lights placed by hand, or both.
//! Lengths are metres, +z is up, angles are degrees, light is photometric (lm, cd, cd/m^2, lx), colours are linear
//! Rec. 709. Every mistake is an [`Error::Input`](crate::base::error::Error::Input) with line, field and what would be right; nothing that a file can
//! say panics or asks for unbounded memory.
//!
//! | table | fields (defaults in parentheses) |
//! |---|---|
//! | top level | `name` (1 to 64 characters), `version = 1`, `seed` (1), `ev100` (none: exposure 1), `origin` (`[0, 0, 0]`, f64) |
//! | `[camera]` | `position`, `target`, `fov` (60, vertical), `resolution` (`[240, 135]`) |
//! | `[city]` | [`City`](crate::sources::city::City), with a table per part |
//! | `[ground]` | `size` (one number or `[x, y]`), `centre` (`[0, 0]`), `height` (0), `material` |
//! | `[materials.NAME]` | `albedo`, `street` (false); the names of a city's materials are known already |
//! | `[[box]]` | `low`, `high`, `material` |
//! | `[[quad]]`, `[[triangle]]` | `corners`, `material` |
//! | `[[light]]` | `kind`, and by kind, below |
//! | `[[bulbs]]` | [`Bulbs`](crate::sources::city::Bulbs), `size`, `centre` (`[0, 0]`), `ground` (0) |
//!
//! Everything is relative to `origin`, the recipe's frame: moving it changes [`Scene::origin`](crate::scene::Scene::origin) and no other byte.
//!
//! | `kind` | where | how bright |
//! |---|---|---|
//! | `"point"` | `position` | `intensity` in cd or `flux` in lm |
//! | `"spot"` | `position`, `target`, half-angles `outer` (45; 0.5 to 90) and `inner` (0; at least 0.1 less) in degrees | `intensity` at the peak or `flux` |
//! | `"directional"` | `towards`, a vector to the light | `irradiance` in lx on a surface that faces it |
//! | `"triangle"` | `corners`, counter-clockwise from the side that emits | `radiance` in cd/m^2 |
//!
//! A caller may ask for a view of the city ([`Overrides::view`](crate::sources::Overrides::view)): its generator then places the
//! camera, and of `[camera]` only `fov` and `resolution` count.
//!
//! The value times `colour` (white) gives the three channels; with `kelvin` it is the luminous value of a black body.

mod camera;
mod lights;
mod place;
mod read;
mod strings;
mod surfaces;
mod toml_table;

pub use read::{load, parse};
