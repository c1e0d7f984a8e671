//! `citylights new-strategy`: a crate with a strategy that compiles, passes `verify` and has a row.

use super::home::Home;
use super::outcome::Outcome;
use super::terminal::print;
use crate::base::error::{Error, Result};
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub(super) struct Arguments {
    /// The strategy's name, as it will be typed: lower-case letters, digits and hyphens
    name: String,
    /// The folder to write, which must not hold anything; one of the strategy's name by default
    #[arg(long, value_name = "DIR")]
    into: Option<PathBuf>,
    /// The checkout of citylights that the crate is built with; by default the one that this program was built from
    #[arg(long, value_name = "DIR")]
    library: Option<PathBuf>,
}

/// Files by their places, with `{name}`, `{crate}`, `{type}` and `{library}` to be filled in.
const FILES: [(&str, &str); 7] = [
    ("Cargo.toml", include_str!("Cargo.toml.in")),
    ("build.rs", include_str!("build.rs.in")),
    ("src/lib.rs", include_str!("lib.rs.in")),
    ("src/main.rs", include_str!("main.rs.in")),
    ("benches/strategy.rs", include_str!("bench.rs.in")),
    ("tests/contract.rs", include_str!("contract.rs.in")),
    (".gitignore", "/target\n/results/.references\n"),
];

/// A scene to compare on.
const SCENE: (&str, &str) = ("scenes/first-night.toml", include_str!("../../../scenes/first-night.toml"));

/// Words of Rust, and names of crates and folders that it would be built with.
const RESERVED: [&str; 59] = [
    "abstract",
    "alloc",
    "as",
    "async",
    "await",
    "become",
    "box",
    "break",
    "build",
    "citylights",
    "const",
    "continue",
    "core",
    "crate",
    "deps",
    "do",
    "dyn",
    "else",
    "enum",
    "examples",
    "extern",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "if",
    "impl",
    "in",
    "incremental",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "override",
    "priv",
    "proc-macro",
    "pub",
    "ref",
    "return",
    "self",
    "static",
    "std",
    "struct",
    "super",
    "test",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "unsafe",
    "unsized",
    "use",
    "virtual",
    "while",
];

/// Types that the crate's code names already.
const TAKEN: [&str; 25] = [
    "AliasTable",
    "Arguments",
    "BuildContext",
    "Claim",
    "Configured",
    "Cumulative",
    "Draws",
    "Error",
    "Info",
    "Kind",
    "Light",
    "LightId",
    "LightSampler",
    "LightTable",
    "Pick",
    "Picks",
    "Receiver",
    "Registry",
    "Reservoir",
    "Result",
    "Sampler",
    "Scene",
    "Strategy",
    "Tally",
    "Uncounted",
];

pub(super) fn run(arguments: &Arguments, home: &Home<'_>) -> anyhow::Result<Outcome> {
    let name = &arguments.name;
    check_name(name, home)?;
    let library = library(arguments.library.as_deref())?;
    let into = arguments.into.clone().unwrap_or_else(|| PathBuf::from(name));
    if fs::read_dir(&into).is_ok_and(|mut entries| entries.next().is_some()) || into.is_file() {
        let text = format!("{} holds something already; name a new folder with --into", into.display());
        return Err(Error::Invalid(text).into());
    }
    let fill = |text: &str| {
        text.replace("{name}", name)
            .replace("{crate}", &name.replace('-', "_"))
            .replace("{type}", &type_name(name))
            .replace("{library}", &library.display().to_string().replace('\\', "/"))
    };
    for (file, text) in FILES.iter().map(|(file, text)| (*file, fill(text))).chain([(SCENE.0, SCENE.1.to_owned())]) {
        let path = into.join(file);
        let folder = path.parent().unwrap_or(&into);
        fs::create_dir_all(folder).map_err(Error::io("make", folder))?;
        fs::write(&path, text).map_err(Error::io("write", &path))?;
    }
    print(&format!(
        "{into} is a crate with the strategy `{name}`; it picks lights by their flux until you change src/lib.rs. Next:\n\n    \
         cd {into}\n    \
         cargo test                                                      its contract, on small scenes\n    \
         cargo run --release -- verify {scene} -s {name}\n    \
         cargo run --release -- compare {scene} -s {name},power,light-tree\n    \
         cargo bench --features bench                                    set-up and sampling beside all others\n",
        into = into.display(),
        scene = SCENE.0,
    ))?;
    Ok(Outcome::Done)
}

fn check_name(name: &str, home: &Home<'_>) -> Result<()> {
    let refuse = |text: &str| Err(Error::Invalid(format!("`{name}` {text}")));
    let fit = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(fit) || name.ends_with('-') {
        return refuse("is no name for a strategy: lower-case letters, digits and hyphens are right, a letter first");
    }
    if home.registry.infos().any(|info| info.name == name) {
        return refuse("is the name of a strategy that there is; choose another");
    }
    if RESERVED.contains(&name) || TAKEN.contains(&type_name(name).as_str()) || name.contains("--") {
        return refuse("means something else to Rust, to cargo or in the crate's own code; choose another");
    }
    Ok(())
}

/// The checkout to build with, as an absolute path.
fn library(named: Option<&Path>) -> Result<PathBuf> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = named.unwrap_or(own);
    let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
    if !manifest.contains("name = \"citylights\"") {
        let text = "holds no Cargo.toml of citylights: name a checkout of it with --library";
        return Err(Error::Invalid(format!("{} {text}", folder.display())));
    }
    folder.canonicalize().map_err(Error::io("read", folder))
}

/// `my-lights` as `MyLights`.
fn type_name(name: &str) -> String {
    let word = |word: &str| {
        let mut letters = word.chars();
        letters.next().map_or_else(String::new, |first| first.to_ascii_uppercase().to_string() + letters.as_str())
    };
    name.split('-').map(word).collect()
}
