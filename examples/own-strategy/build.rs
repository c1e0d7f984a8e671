//! Fixes this crate's revision in the program: it stands in every record, with a `+` where the sources were changed.
const SOURCES: [&str; 4] = ["src", "build.rs", "Cargo.toml", "Cargo.lock"];
fn main() {
    let git = |arguments: &[&str]| {
        let output = std::process::Command::new("git").args(arguments).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let log = git(&["rev-parse", "--git-path", "logs/HEAD"]);
    SOURCES.into_iter().chain(log.as_deref()).for_each(|path| println!("cargo:rerun-if-changed={path}"));
    let revision = git(&["rev-parse", "--short=10", "HEAD"]).unwrap_or_else(|| "unknown".into());
    let changes = git(&[&["status", "--porcelain", "--"], &SOURCES[..]].concat()).unwrap_or_default();
    println!("cargo:rustc-env=CITYLIGHTS_REVISION={revision}{}", if changes.is_empty() { "" } else { "+" });
}
