//! Every registered strategy against its contract, on scenes small and real.

use crate::promises::common::{ground, panel, point, sixteen, stage, stage_with};
use citylights::sources::small;
use citylights::strategy::Registry;
use citylights::verify::{Truth, Verifier, VerifyOptions};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;

fn all_pass(scene: &str, stage: &Stage, options: &VerifyOptions) {
    let names: Vec<&str> = Registry::standard().infos().map(|info| info.name).collect();
    pass(scene, &names, stage, options);
}

/// Every strategy is looked at before the first failure is reported.
fn pass(scene: &str, names: &[&str], stage: &Stage, options: &VerifyOptions) {
    let mut failed = Vec::new();
    let verifier = Verifier::new(stage, *options);
    println!("{scene}");
    for name in names {
        let strategy = Registry::standard().parse(name).expect(name);
        let checks = verifier.verify(&strategy).expect(name);
        for check in &checks {
            println!("{name:<16} {check}");
            if !check.passed {
                failed.push(format!("{name:<16} {check}"));
            }
        }
        let wanted = if strategy.info().claim.bias().is_some() { "bias" } else { "image-mean" };
        assert!(checks.iter().any(|check| check.name == wanted), "{name} was not looked at");
    }
    assert!(failed.is_empty(), "{scene}\n{}", failed.join("\n"));
}

#[test]
fn every_strategy_keeps_its_contract_among_sixteen_lights() {
    all_pass("sixteen", &stage(sixteen()), &VerifyOptions::default());
    let more = ["uniform:picks=4", "power:picks=3", "intensity:picks=2", "influence-tail:picks=2,tail=3,cutoff=255"];
    pass("sixteen", &more, &stage(sixteen()), &VerifyOptions::default());
    all_pass(
        "sixteen, nothing left out",
        &stage_with(sixteen(), LeaveOut::No, Offset::SCALED),
        &VerifyOptions { receivers: 8, ..VerifyOptions::default() },
    );
}

#[test]
fn every_strategy_keeps_its_contract_on_scenes_where_strategies_go_wrong() {
    let options = VerifyOptions { receivers: 8, draws: 5_000, ..VerifyOptions::default() };
    for parts in small::all() {
        let name = parts.name.clone();
        all_pass(&name, &stage_with(parts, LeaveOut::No, Offset::SCALED), &options);
    }
}

#[test]
fn every_strategy_covers_a_window_whose_centre_is_below_the_horizon() {
    // 2 m of it below the ground, 1 m above: weighed at its centre it would add nothing.
    let mut lights = panel(Vec3::new(-2.0, 8.0, -2.0), Vec3::X * 4.0, Vec3::Z * 3.0, 100.0).to_vec();
    lights.push(point(Vec3::new(4.0, -4.0, 5.0), 60.0));
    let stage = stage_with(ground(12.0, lights), LeaveOut::No, Offset::SCALED);
    all_pass("a window across the horizon", &stage, &VerifyOptions { points: 1_000, ..VerifyOptions::default() });
}

#[test]
fn the_truth_per_light_adds_up_to_the_exact_image() {
    let stage = stage(sixteen());
    for at in stage.receivers().iter().step_by(37) {
        let truth = Truth::new(&stage, at, 2_000, 5);
        let exact = citylights::render::exact::exact(&stage, at, 40_000, 6).mean();
        let grey = f64::from(citylights::base::colour::luminance(exact.as_vec3()));
        assert!((truth.total() - grey).abs() <= 4e-3 * grey, "{} for {grey} at pixel {}", truth.total(), at.pixel);
    }
}

fn shipped(name: &str, seed: u64, draws: usize, level: f64) {
    use citylights::sources::Overrides;
    use citylights::sources::recipe::load;
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).with_extension("toml");
    let scene = load(&path, &Overrides::default()).expect(name);
    let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    all_pass(
        name,
        &stage,
        &VerifyOptions { receivers: 16, draws, points: 16, seed, level, ..VerifyOptions::default() },
    );
}

#[test]
fn every_strategy_keeps_its_contract_on_first_night() {
    shipped("first-night", 1, 10_000, VerifyOptions::default().level);
}

#[test]
#[ignore = "takes five minutes; for a change to strategies or to leaving out"]
fn every_strategy_keeps_its_contract_on_the_scenes_of_one_street() {
    use citylights::base::statistics::sidak;
    // A check keeps its level within one strategy, scene and seed; here it is asked 96 times.
    let level = sidak(VerifyOptions::default().level, 4 * 3 * Registry::standard().infos().count());
    for name in ["lamps-only", "plaza", "moonlit", "stadium"] {
        for seed in 1..=3 {
            // Few draws leave means lopsided by lights that are rarely drawn: with 10,000, 2 of 12 seeds of a right
            // strategy failed on stadium; with 200,000 none did.
            shipped(name, seed, 100_000, level);
        }
    }
}
