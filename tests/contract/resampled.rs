//! Choosing among another strategy's candidates keeps its promise, whatever they are.

use super::runs::Runs;
use crate::promises::common::{image, sixteen, stage};
use citylights::strategy::{Claim, Configured, Registry};

#[test]
fn resampling_is_unbiased_over_any_unbiased_strategy() {
    let stage = stage(sixteen());
    for name in [
        "resampled",
        "resampled:from=power,m=16",
        "resampled:from=power,m=1",
        "resampled:from=light-tree:arity=2,m=3,visibility=on",
        "resampled:from=uniform,m=5,visibility=on",
        "resampled:from=uniform:picks=3,m=2,picks=2",
        "resampled:from=intensity,m=4,visibility=on,picks=3,points=sobol",
        "resampled:from=influence-tail:picks=2;tail=3;cutoff=255,m=3,points=random",
        "resampled:from=stochastic-cull:draw=receiver,m=2,visibility=on",
    ] {
        Runs::new(name, &stage, 64, 16).assert_unbiased(name);
    }
}

#[test]
fn a_weight_without_its_target_value_would_be_noticed() {
    // The inner strategy is biased by design: the checks above must see such a thing.
    let stage = stage(sixteen());
    let runs = Runs::new("resampled:from=influence:cutoff=255,m=2", &stage, 16, 4);
    let (worst, limit) = runs.worst();
    assert!(worst > limit && runs.energy().mean < 0.99, "{worst} and {}", runs.energy().mean);
}

#[test]
fn more_candidates_lower_the_error_and_visible_ones_lower_it_more() {
    let stage = stage(sixteen());
    let mse = |name: &str| Runs::new(name, &stage, 8, 4).mse();
    let names = [
        "resampled:from=uniform,m=1,points=random",
        "resampled:from=uniform,m=16,points=random",
        "resampled:from=uniform,m=16,visibility=on,points=random",
    ];
    let [one, many, visible] = names.map(mse);
    println!("MSE {one:.3e}, {many:.3e}, {visible:.3e}");
    assert!(many < 0.5 * one && visible < 0.8 * many, "{one}, {many}, {visible}");
}

#[test]
fn one_candidate_of_one_pick_is_that_pick() {
    let mut parts = sixteen();
    parts.lights.truncate(10);
    let stage = stage(parts);
    // Lights without extent, so that no number is drawn but the one that chooses.
    let [inner, outer] =
        ["power:points=random", "resampled:from=power,m=1,points=random"].map(|name| image(name, &stage, 3));
    let differ = inner.iter().zip(&outer).filter(|(a, b)| (**a - **b).length() > 1e-6 * a.length()).count();
    assert!(differ == 0 && inner.iter().any(|x| x.y > 0.0), "{differ} of {} receivers differ", inner.len());
}

#[test]
fn names_hold_the_inner_strategy_and_its_parameters() {
    let name = "resampled:from=influence-tail:picks=2;cutoff=255,m=3";
    assert_eq!(Registry::standard().parse(name).expect("parsed").name(), name);
    let list = Registry::standard().parse_list("power,resampled:from=power:picks=2,m=5,uniform").expect("a list");
    let names: Vec<&str> = list.iter().map(Configured::name).collect();
    assert_eq!(names, ["power", "resampled:from=power:picks=2,m=5", "uniform"]);
    assert_eq!(Registry::standard().parse("resampled:from=light-tree,m=4").expect("the defaults").name(), "resampled");
}

#[test]
fn the_claim_is_that_of_the_inner_strategy() {
    let claim = |name: &str| Registry::standard().parse(name).expect(name).info().claim;
    assert_eq!(claim("resampled:from=uniform"), Claim::Unbiased);
    assert!(matches!(claim("resampled:from=influence"), Claim::Biased { .. }));
    assert_eq!(claim("resampled:from=influence"), claim("influence"));
}

#[test]
fn strategies_that_give_no_candidates_are_refused_with_a_reason() {
    let message = |name: &str| Registry::standard().parse(name).err().map(|e| e.to_string()).unwrap_or_default();
    for inner in ["all", "null", "oracle", "resampled", "restir", "stochastic-cull:draw=pass"] {
        let message = message(&format!("resampled:from={inner}"));
        assert!(
            message.contains("resampled: parameter `from`") && message.contains("gives no candidates"),
            "{message}"
        );
    }
    assert!(message("resampled:from=resampled:from=resampled:from=power").contains("too far"));
    assert!(message("resampled:from=powr").contains("near it: power"), "{}", message("resampled:from=powr"));
    assert!(message("resampled:from=power:picks=0").contains("1 to 1024"));
    assert!(message("resampled:from=power:points=sobol").contains("points"), "numbers are spread by the outer one");
    assert!(message("resampled:m=0").contains("1 to 1024"));
    let deep = "resampled:from=".repeat(100_000);
    assert!(message(&deep).contains("too far"));
}
