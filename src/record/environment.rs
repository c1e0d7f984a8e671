//! Where and by what was it measured?
//!
//! By what was fixed when this was built (`build.rs`): nothing is executed here.

/// The processor's name, as far as the system tells.
pub(crate) fn cpu() -> String {
    let described = std::fs::read_to_string("/proc/cpuinfo").ok();
    described
        .as_deref()
        .and_then(|text| text.lines().find_map(|line| line.strip_prefix("model name")))
        .and_then(|rest| rest.split_once(':'))
        .map_or_else(|| format!("unnamed {}", std::env::consts::ARCH), |(_, name)| name.trim().to_owned())
}

/// Cores that this process may use.
pub(crate) fn cores() -> u32 {
    std::thread::available_parallelism().map_or(1, |n| n.get() as u32)
}

/// Operating system and architecture.
pub(crate) fn os() -> String {
    format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)
}

/// Today, UTC, as `2026-11-22`.
pub(crate) fn date() -> String {
    jiff::Timestamp::now().strftime("%Y-%m-%d").to_string()
}

/// The crate's version.
pub(crate) fn version() -> String {
    env!("CARGO_PKG_VERSION").into()
}

/// Revision of the source that this was built from, `unknown` outside its checkout; `+` marks uncommitted changes.
pub(crate) fn revision() -> String {
    env!("CITYLIGHTS_REVISION").into()
}

/// The compiler that built this.
pub(crate) fn compiler() -> String {
    env!("CITYLIGHTS_COMPILER").into()
}

/// What changes the code: debug assertions, the level of optimisation, the target and its features.
pub(crate) fn flags() -> String {
    let checks = if cfg!(debug_assertions) { "debug assertions" } else { "release" };
    format!("{checks}, {}", env!("CITYLIGHTS_FLAGS"))
}

/// What makes figures doubtful here.
pub(crate) fn warnings() -> Vec<String> {
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
