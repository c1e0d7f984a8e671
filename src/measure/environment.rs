//! Where and by what was it measured?

use std::process::Command;

/// The processor's name, as far as the system tells.
pub fn cpu() -> String {
    let described = std::fs::read_to_string("/proc/cpuinfo").ok();
    described
        .as_deref()
        .and_then(|text| text.lines().find_map(|line| line.strip_prefix("model name")))
        .and_then(|rest| rest.split_once(':'))
        .map_or_else(|| format!("unnamed {}", std::env::consts::ARCH), |(_, name)| name.trim().to_owned())
}

/// Cores that this process may use.
pub fn cores() -> u32 {
    std::thread::available_parallelism().map_or(1, |n| n.get() as u32)
}

/// Operating system and architecture.
pub fn os() -> String {
    format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)
}

/// Today, UTC, as `2026-11-22`.
pub fn date() -> String {
    jiff::Timestamp::now().strftime("%Y-%m-%d").to_string()
}

/// Revision of the source in the working folder, `unknown` outside a checkout; `+` marks uncommitted changes.
pub fn revision() -> String {
    let ask = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let Some(revision) = ask(&["rev-parse", "--short=10", "HEAD"]) else { return "unknown".into() };
    let changed = ask(&["status", "--porcelain", "--untracked-files=no"]).is_none_or(|status| !status.is_empty());
    if changed { format!("{revision}+") } else { revision }
}

/// The compiler that built this, where it can still be asked.
pub fn compiler() -> String {
    let output = Command::new("rustc").arg("--version").output().ok().filter(|output| output.status.success());
    output.map_or_else(|| "rustc, version not known".into(), |o| String::from_utf8_lossy(&o.stdout).trim().to_owned())
}

/// What changes the code: the profile and the vector instructions compiled in.
pub fn flags() -> String {
    let profile = if cfg!(debug_assertions) { "debug assertions" } else { "release" };
    let vectors = if cfg!(target_feature = "avx512f") {
        "avx512"
    } else if cfg!(target_feature = "avx2") {
        "avx2"
    } else {
        "default target"
    };
    format!("{profile}, {vectors}")
}

/// What makes figures doubtful here.
pub fn warnings() -> Vec<String> {
    let mut warnings = Vec::new();
    if cfg!(debug_assertions) {
        warnings.push("built with debug assertions: times are not those of a release build".into());
    }
    let load = std::fs::read_to_string("/proc/loadavg").ok();
    let load = load.as_deref().and_then(|text| text.split(' ').next()).and_then(|first| first.parse::<f64>().ok());
    if let Some(load) = load.filter(|&load| load > f64::from(cores()) * 0.75) {
        warnings.push(format!("the machine was busy when this began: load {load} on {} cores", cores()));
    }
    warnings
}
