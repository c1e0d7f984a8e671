//! Every registered strategy against its contract, on scenes small and real.

mod common;

use citylights::strategy::Claim;
use citylights::strategy::registry::{self, STRATEGIES};
use citylights::verify::{Options, Truth, verify};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use common::{ground, panel, point, sixteen, spot, stage, stage_with};
use glam::Vec3;

fn all_pass(scene: &str, stage: &Stage, options: &Options) {
    for entry in STRATEGIES {
        passes(scene, entry.info().name, stage, options);
    }
}

fn passes(scene: &str, name: &str, stage: &Stage, options: &Options) {
    let checks = verify(&registry::parse(name).expect(name), stage, options).expect(name);
    let text: Vec<String> = checks.iter().map(|check| format!("{name:<16} {check}")).collect();
    println!("{scene}\n{}", text.join("\n"));
    assert!(checks.iter().all(|check| check.passed), "{scene}\n{}", text.join("\n"));
    let wanted =
        if matches!(registry::parse(name).expect(name).info().claim, Claim::Biased(_)) { "bias" } else { "image-mean" };
    assert!(checks.iter().any(|check| check.name == wanted), "{name} was not looked at");
}

#[test]
fn every_strategy_keeps_its_contract_among_sixteen_lights() {
    all_pass("sixteen", &stage(sixteen()), &Options::default());
    for name in ["uniform:picks=4", "power:picks=3", "intensity:picks=2", "influence-tail:picks=2,tail=3,cutoff=255"] {
        passes("sixteen", name, &stage(sixteen()), &Options::default());
    }
    all_pass(
        "sixteen, nothing left out",
        &stage_with(sixteen(), LeaveOut::No, Offset::SCALED),
        &Options { receivers: 8, ..Options::default() },
    );
}

#[test]
fn every_strategy_keeps_its_contract_with_few_lights() {
    let lights = [
        point(Vec3::new(1.0, 2.0, 5.0), 100.0),
        spot(Vec3::new(-3.0, 0.0, 6.0), Vec3::new(0.2, 0.0, -1.0), 300.0),
        panel(Vec3::new(2.0, -2.0, 4.0), Vec3::Y, Vec3::X, 80.0)[0],
    ];
    let options = Options { receivers: 8, draws: 2_000, ..Options::default() };
    for n in 0..=3 {
        all_pass(&format!("{n} lights"), &stage(ground(12.0, lights[..n].to_vec())), &options);
    }
    let same = vec![point(Vec3::new(1.0, 1.0, 5.0), 100.0); 50];
    all_pass("identical lights", &stage(ground(12.0, same)), &options);
    let below = (0..20).map(|i| point(Vec3::new(i as f32 - 10.0, 0.0, -1.0), 100.0)).collect();
    all_pass("all behind the horizon", &stage_with(ground(12.0, below), LeaveOut::No, Offset::SCALED), &options);
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

#[cfg(feature = "recipe")]
#[test]
fn every_strategy_keeps_its_contract_on_first_night() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/first-night.toml");
    if !path.exists() {
        println!("scenes/first-night.toml is not there yet");
        return;
    }
    let scene =
        citylights::scene::recipe::load(&path, &citylights::scene::recipe::Overrides::default()).expect("first-night");
    let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    all_pass("first-night", &stage, &Options { receivers: 16, draws: 10_000, points: 16, ..Options::default() });
}
