//! How often does the gate refuse a right strategy, and what does it cost? Re-runnable; minutes long, so ignored:
//!
//! `cargo test --release --lib false_alarms -- --ignored --nocapture`

#![cfg(all(feature = "measure", feature = "recipe"))]

use citylights::measure::gate::Gate;
use citylights::sources::Overrides;
use citylights::sources::recipe::load;
use citylights::strategy::{Claim, Registry};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use cpu_time::ProcessTime;
use std::path::Path;

/// Comparisons with seeds of their own.
const COMPARISONS: u64 = 100;

/// How many of them may refuse a right strategy.
const MOST: usize = 3;

#[test]
#[ignore = "minutes: a measurement"]
fn right_strategies_pass_the_gate_of_a_hundred_comparisons() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/first-night.toml");
    let overrides = Overrides { resolution: Some((64, 36)), ..Overrides::default() };
    let stage = Stage::new(load(&file, &overrides).expect("a shipped scene"), LeaveOut::Yes, Offset::SCALED);
    let names: Vec<&str> = Registry::standard().infos().map(|info| info.name).collect();
    let strategies: Vec<_> = names.iter().map(|name| Registry::standard().parse(name).expect(name)).collect();
    let (clock, mut alarms) = (ProcessTime::now(), Vec::new());
    for seed in 1..=COMPARISONS {
        let gate = Gate::new(&stage, "scenes/first-night.toml --resolution 64x36", strategies.len(), seed);
        for strategy in strategies.iter().filter(|strategy| strategy.info().claim != Claim::Oracle) {
            if let Err(error) = gate.pass(strategy) {
                println!("seed {seed}, {}: {error}", strategy.name());
                alarms.push(seed);
            }
        }
    }
    let seconds = clock.elapsed().as_secs_f64() / COMPARISONS as f64;
    alarms.dedup();
    println!("{} of {COMPARISONS} comparisons refused a right strategy; {seconds:.2} CPU s a gate", alarms.len());
    assert!(alarms.len() <= MOST, "seeds {alarms:?}");
}
