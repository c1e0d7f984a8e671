//! From a recipe's text to a scene.

use super::place::inside;
use super::surfaces::Surfaces;
use super::toml_table::{Source, Table};
use super::{camera, lights, strings};
use crate::base::error::{Error, Result};
use crate::scene::{LightGroup, Parts, Scene};
use crate::sources::city::{self, City, Grown, Standpoint};
use crate::sources::limits::FARTHEST_ORIGIN;
use crate::sources::name;
use crate::sources::overrides::Overrides;
use glam::DVec3;
use std::io::Read;
use std::path::Path;

/// Larger files are refused: 16 MiB hold about 200,000 lights written by hand.
const LARGEST_FILE: u64 = 16 << 20;
const TOP: [&str; 14] = [
    "name",
    "version",
    "seed",
    "ev100",
    "origin",
    "camera",
    "city",
    "ground",
    "materials",
    "box",
    "quad",
    "triangle",
    "light",
    "bulbs",
];

/// The scene of a recipe file.
///
/// # Errors
/// A file that cannot be read, larger than 16 MiB or no UTF-8 text; as [`parse`].
pub fn load(path: &Path, overrides: &Overrides) -> Result<Scene> {
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(Error::io("read", path))?;
    file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(Error::io("read", path))?;
    let refuse = |line, message: String| Error::Input { file: path.to_owned(), line, field: String::new(), message };
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(refuse(None, format!("the file is larger than {LARGEST_FILE} bytes, the most for a recipe")));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let upto = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..upto].iter().filter(|&&b| b == b'\n').count();
        refuse(Some(line), "is not UTF-8 text; a recipe is a TOML file".into())
    })?;
    parse(&text, path, overrides)
}

/// The scene of a recipe's text; `file` is the name that errors give.
///
/// # Errors
/// A recipe with a mistake, with its line and field; an override of the camera, or of the lights or the view where no city
/// is.
pub fn parse(text: &str, file: &Path, overrides: &Overrides) -> Result<Scene> {
    let source = Source::new(file, text);
    if text.trim().is_empty() {
        return Err(source.error(None, "", "the file is empty; a recipe starts with `name`, `seed` and `version = 1`"));
    }
    if overrides.camera.is_some() {
        return Err(source.error(None, "camera", "a recipe has one camera: none can be chosen by name"));
    }
    if overrides.lamps_divided_by.is_some() {
        let text = "a recipe's lamps are as bright as it says: only those of a glTF file can be divided";
        return Err(source.error(None, "light", text));
    }
    let document = source.document()?;
    let top = Table::top(&source, &document);
    top.only(&TOP)?;
    if top.needed_count("version", 0..=u64::MAX >> 1)? != 1 {
        return Err(top.wrong("version", "this program reads version 1 of recipes: `version = 1` is asked for"));
    }
    let name = scene_name(&top)?;
    let seed = top.count("seed", 0..=u64::MAX >> 1)?.unwrap_or(1);
    let seed = overrides.seed.unwrap_or(seed);
    let ev100 = top.number("ev100", -30.0..=40.0, "EV at ISO 100")?.map(|ev| ev as f32);
    let frame = top.vector("origin", FARTHEST_ORIGIN)?.unwrap_or(DVec3::ZERO);

    let (grown, viewed) = top.table("city")?.map(|table| grow(&table, seed, overrides)).transpose()?.unzip();
    if grown.is_none() && overrides.lights.is_some() {
        return Err(top.missing("city", "a generated city, whose number of lights is to be changed,"));
    }
    if let Some(view) = overrides.view.filter(|_| grown.is_none()) {
        let what =
            format!("a generated city, in which views (street, roof, sky) such as `{}` are placed,", view.name());
        return Err(top.missing("city", &what));
    }
    let by_hand = Surfaces::read(&top, grown.as_ref())?;
    let lights = lights::read(&top)?;
    let strings = strings::read(&top)?;

    // A city lies about the frame's origin. What is placed by hand may lie anywhere: f32 has 0.1 mm at 1 km.
    let shift = if grown.is_some() { DVec3::ZERO } else { (by_hand.centre() / 1000.0).round() * 1000.0 };
    let camera_table = top.needed_table("camera")?;
    let own = camera::standpoint(&camera_table)?;
    let standpoint = viewed.flatten().unwrap_or(own);
    let eye = standpoint.eye;
    by_hand.keep_out(&camera_table, eye)?;
    let camera = camera::read(&camera_table, standpoint, shift, overrides.resolution)?;

    let grown = grown.unwrap_or_default();
    if let Some(solid) = grown.solids.iter().find(|solid| solid.contains(eye.as_vec3())) {
        return Err(inside(&camera_table, &format!("a building of the city of seed {seed}"), *solid));
    }
    let Grown { lights: mut all, mut groups, surfaces: mut triangles, notes, .. } = grown;
    let (placed, materials) = by_hand.finish(shift);
    triangles.extend(placed);
    let mut add = |name: &str, more: Vec<_>| {
        let start = all.len() as u32;
        all.extend(more);
        groups.push(LightGroup { name: name.into(), range: start..all.len() as u32 });
    };
    add("placed lights", lights.into_iter().map(|light| light.at(shift)).collect());
    add("strings of bulbs", strings.iter().flat_map(|strings| strings.bulbs(shift)).collect());
    Scene::new(Parts {
        name,
        seed,
        origin: frame + shift,
        lights: all,
        groups,
        surfaces: triangles,
        materials,
        camera,
        ev100: overrides.ev100.or(ev100),
        notes,
    })
    .map_err(|error| match error {
        Error::Invalid(message) => source.error(None, "", message),
        other => other,
    })
}

/// The scene's name, which stands in tables, file names and reports.
fn scene_name(top: &Table) -> Result<String> {
    let name = top.needed_text("name", "the scene's name")?;
    if name::is_fit(&name) {
        return Ok(name);
    }
    let length = name.chars().count();
    let shown: String = name.chars().take(name::LONGEST).collect();
    Err(top.wrong(
        "name",
        format!(
            "\"{}\" of {length} characters is given; 1 to {} printable ones are asked for, not all blank, \
             without < > | / \\ , and quotes",
            shown.escape_debug(),
            name::LONGEST
        ),
    ))
}

/// The city of a table, and where the view stands that is asked for.
fn grow(table: &Table, seed: u64, overrides: &Overrides) -> Result<(Grown, Option<Standpoint>)> {
    let mut plan = City::default();
    table.fill(&mut plan)?;
    plan.lights = overrides.lights.unwrap_or(plan.lights);
    let view = overrides.view.map(|view| city::stand(&plan, seed, view)).transpose();
    view.and_then(|view| Ok((city::generate(&plan, seed)?, view))).map_err(|error| match error {
        // The plan was read from this file: say where.
        Error::Parameter { owner, name, value, expected } => {
            table.at_path(&format!("{owner}.{name}"), format!("{value} is given or assumed; {expected}"))
        }
        other => other,
    })
}
