//! The oracle knows what each light adds, and is therefore the floor.

use super::runs::Runs;
use crate::promises::alone::Alone;
use crate::promises::common::{cuboid, expected, ground, point, sixteen, stage};
use citylights::base::claim::Claim;
use citylights::measure::compare::{Compared, ComparisonOptions, compare};
use citylights::measure::engine::Engine;
use citylights::measure::image_store::ImageStore;
use citylights::measure::observer::Unobserved;
use citylights::measure::plan::Budget;
use citylights::record::Interval;
use citylights::record::store::RowWriter;
use citylights::strategy::Registry;
use citylights::verify::{Truth, Verifier, VerifyOptions};
use glam::Vec3;

#[test]
fn the_oracle_keeps_its_contract() {
    let stage = stage(sixteen());
    for name in ["oracle", "oracle:mix=0.001", "oracle:mix=0.5"] {
        let checks = Verifier::new(&stage, VerifyOptions::default())
            .verify(&Registry::standard().parse(name).expect(name))
            .expect(name);
        let failed: Vec<String> = checks.iter().filter(|c| !c.passed).map(ToString::to_string).collect();
        assert!(checks.len() > 10 && failed.is_empty(), "{name}\n{}", failed.join("\n"));
    }
    Runs::new("oracle", &stage, 32, 8).assert_unbiased("oracle");
}

#[test]
fn of_lights_without_extent_it_picks_by_exactly_what_they_add() {
    let mut parts = sixteen();
    parts.lights.truncate(10);
    let stage = stage(parts);
    for at in stage.receivers().iter().step_by(41) {
        let truth = Truth::new(&stage, at, 0, 1);
        let counts = expected("oracle", &stage, at);
        for (found, value) in counts.iter().zip(truth.lights()) {
            assert!((f64::from(*found) * truth.total() - value).abs() <= 1e-5 * truth.total(), "pixel {}", at.pixel);
        }
    }
    // Grey lights, chosen by exactly what they add: each pass is exact.
    let grey = (0..6).map(|i| point(Vec3::new(i as f32 * 3.0 - 8.0, 2.0, 4.0), 50.0 + 40.0 * i as f32)).collect();
    let mut parts = ground(12.0, grey);
    parts.surfaces.extend(cuboid(Vec3::new(-2.0, -2.0, 0.0), Vec3::new(2.0, 1.0, 6.0)));
    let stage = crate::promises::common::stage(parts);
    let [oracle, intensity] = ["oracle", "intensity"].map(|name| Runs::new(name, &stage, 4, 1).mse());
    assert!(oracle < 1e-6 * intensity, "{oracle} beside {intensity}");
}

#[test]
fn it_errs_least_of_all_that_pick_one_light() {
    let stage = stage(sixteen());
    let mse = |name: &str| Runs::new(&format!("{name}points=random"), &stage, 8, 4).mse();
    let oracle = mse("oracle:");
    for name in ["intensity:", "power:", "uniform:", "resampled:from=power,m=16,"] {
        let other = mse(name);
        println!("{name} {:.2} x oracle", other / oracle);
        assert!(other > oracle, "{name} {other} below {oracle}");
    }
}

#[test]
fn a_comparison_gives_every_choosing_row_its_multiple_of_the_oracle() {
    let stage = stage(sixteen());
    let folder = tempfile::tempdir().expect("a folder");
    let strategies = Registry::standard().parse_list("all,power,oracle,intensity,restir").expect("a list");
    let films = ImageStore::of(folder.path(), "oracle");
    let engine = Engine { clock: &Alone::new(), workers: 2, seed: 1 };
    let options = ComparisonOptions {
        scenes: 1,
        typed: "made.toml",
        strategies: &strategies,
        budget: Budget::up_to(16, 5.0),
        repeats: 8,
        seed: 1,
        engine: &engine,
        reference_work_s: 30.0,
        cache: folder.path(),
        films: &films,
    };
    let mut writer = RowWriter::create(folder.path()).expect("begun");
    let Compared { scene: record, rows, .. } =
        compare(&stage, "made", &options, &[], &mut writer, &Unobserved).expect("compared");
    let of = |name: &str| record.summaries.iter().find(|s| s.strategy == name).expect(name);
    let ratios = ["power", "intensity", "restir"].map(|name| of(name).times_oracle.expect(name));
    println!("x oracle of power, intensity, restir: {ratios:?}");
    let [power, intensity, restir] = ratios.map(|ratio| ratio.mean);
    assert!(power > 3.0 * intensity && intensity > 1.0 && restir < power, "{power}, {intensity}, {restir}");
    assert!(ratios.iter().all(|ratio| ratio.low < ratio.mean && ratio.mean < ratio.high), "{ratios:?}");
    let oracle = of("oracle");
    assert!(oracle.claim == Claim::Oracle && oracle.times_oracle == Some(Interval::certain(1.0)), "{oracle:?}");
    assert!(oracle.cpu_s.mean.is_nan() && oracle.variance_seconds.mean.is_nan(), "the oracle is not timed");
    assert!(oracle.counts.choosing_rays > 0 && oracle.receivers.is_some() && of("power").receivers.is_none());
    assert!(rows.iter().all(|row| row.strategy != "oracle"), "the oracle is not timed");
    assert_eq!(of("all").times_oracle, None);
}
