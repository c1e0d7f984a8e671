//! Fixes this crate's revision in the program: it stands in every record.
fn main() {
    let git = std::process::Command::new("git").args(["describe", "--always", "--dirty=+"]).output();
    let said = git.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default();
    println!("cargo:rustc-env=CITYLIGHTS_REVISION={}", if said.is_empty() { "unknown" } else { &said });
}
