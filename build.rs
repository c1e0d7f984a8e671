//! What was this program built from, by what, for what? Fixed here, so that a running program asks nobody.
//!
//! The revision is that of the checkout that holds this file; a packaged crate, also one that lies within a checkout of
//! something else, has none.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// All that the program is made of; a change elsewhere in the checkout leaves it the same.
const SOURCES: [&str; 4] = ["src", "build.rs", "Cargo.toml", "Cargo.lock"];

fn main() {
    let root = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
    for path in SOURCES.iter().map(|name| root.join(name)).filter(|path| path.exists()) {
        println!("cargo:rerun-if-changed={}", path.display());
    }
    set("REVISION", &revision(&root).unwrap_or_else(|| "unknown".into()));
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let compiler = said(Command::new(rustc).arg("--version"));
    set("COMPILER", &compiler.unwrap_or_else(|| "rustc, version not known".into()));
    let of = |name: &str| env::var(name).unwrap_or_default();
    let (level, target, features) = (of("OPT_LEVEL"), of("TARGET"), of("CARGO_CFG_TARGET_FEATURE"));
    set("FLAGS", &format!("opt-level {level}, {target}, target features {features}"));
}

fn set(name: &str, value: &str) {
    println!("cargo:rustc-env=CITYLIGHTS_{name}={value}");
}

/// What a command prints, if it succeeds.
fn said(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The revision checked out at `root`, with a `+` where the sources are not those of it.
fn revision(root: &Path) -> Option<String> {
    // The user's settings may name programs to be run for it: not here.
    let git = |arguments: &[&str]| {
        said(Command::new("git").arg("-C").arg(root).args(["-c", "core.fsmonitor=false"]).args(arguments))
    };
    let top = PathBuf::from(git(&["rev-parse", "--show-toplevel"])?);
    if top.canonicalize().ok()? != root.canonicalize().ok()? {
        return None;
    }
    let head = git(&["symbolic-ref", "--quiet", "HEAD"]);
    // The log of HEAD grows whenever that comes to name another commit. A file that is not there would count as changed
    // in every build.
    for name in ["HEAD", "logs/HEAD", "packed-refs"].into_iter().chain(head.as_deref()) {
        let path = root.join(git(&["rev-parse", "--git-path", name])?);
        if path.exists() {
            println!("cargo:rerun-if-changed={}", path.display());
        }
    }
    let revision = git(&["rev-parse", "--short=10", "HEAD"])?;
    let status = git(&[&["status", "--porcelain", "--"], &SOURCES[..]].concat())?;
    Some(if status.is_empty() { revision } else { format!("{revision}+") })
}
