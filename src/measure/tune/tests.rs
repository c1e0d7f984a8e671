use super::toys::{Same, Toy};
use super::*;
use crate::measure::clock::Cpu;
use crate::measure::observer::Unobserved;
use crate::measure::reference::Reference;
use crate::measure::tuned::Found;
use crate::record::tuned::{self, TunedPoint, TuningCity};
use crate::scene::Scene;
use crate::sources::small::{ground, point};
use crate::strategy::Registry;
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;
use std::path::Path;

/// Every number of passes that these tests come to.
static EVERY: [u32; 4096] = {
    let mut every = [0; 4096];
    let mut i = 0;
    while i < 4096 {
        every[i] = i as u32 + 1;
        i += 1;
    }
    every
};

fn registry() -> Registry {
    Registry::empty().with::<Toy>().with::<Same>()
}

/// One lamp over a ground, higher or lower, with nothing in between.
fn stage(height: f32, lights: usize) -> Stage {
    let lamps = (0..lights).map(|i| point(Vec3::new(i as f32, 0.0, height), 100.0)).collect();
    Stage::new(Scene::new(ground(12.0, lamps)).expect("a scene"), LeaveOut::Yes, Offset::SCALED)
}

fn truth(target: &Target<'_>) -> Truth {
    let cache = tempfile::tempdir().expect("a folder");
    Reference::compute(target, 1e-6, cache.path(), &Unobserved).expect("a reference").truth
}

/// Does something with cities of one lamp each, measured at so many receivers.
fn with_cities<T>(receivers: usize, work: impl FnOnce(&[City<'_>]) -> T) -> T {
    let stages = [4.0, 6.0, 9.0].map(|height| stage(height, 1));
    let targets: Vec<Target<'_>> =
        stages.iter().map(|stage| Target::of(stage, Target::whole(stage).thinned(receivers).measured())).collect();
    let truths: Vec<Truth> = targets.iter().map(truth).collect();
    let cities: Vec<City<'_>> = targets.iter().zip(&truths).map(|(target, truth)| City { target, truth }).collect();
    work(&cities)
}

fn tuner<'a>(engine: &'a Engine<'a>, cities: &'a [City<'a>], time_s: f64, runs: u32, seed: u64) -> Tuner<'a> {
    Tuner { engine, cities, time_s, passes: &EVERY, runs, seed }
}

fn condition() -> Condition {
    Condition { recipe: "lamp".into(), hash: "0123".into(), lights: 1, receivers: "centre".into() }
}

/// What is found for the whole registry on cities of 400 receivers, in the time of about eight passes of four picks.
fn found(threads: usize, list: &str) -> Tuned {
    let clock = Cpu::new();
    let engine = Engine { clock: &clock, workers: threads, seed: threads as u64 };
    with_cities(400, |cities| {
        let grids = registry().grids(list).expect(list);
        tuner(&engine, cities, 8.0 * 400.0 * 480e-9, 8, 3).all(&grids, condition(), None, &Unobserved).expect("tuned")
    })
}

#[test]
fn the_best_number_of_picks_is_that_of_the_closed_form() {
    let tuned = found(2, "toy");
    let strategy = &tuned.strategies[0];
    assert_eq!(strategy.best.as_deref(), Some("toy:picks=4"), "{strategy:#?}");
    // At one pick V is 25 / 16 times as much; a run of about eight passes is a whole number of them.
    let gain = strategy.gain.expect("the default was measured");
    assert!((gain.mean - 25.0 / 16.0).abs() < 0.08, "{gain:?}");
    let second = strategy.second.as_ref().expect("there are five points");
    assert!(["toy:picks=2", "toy:picks=8"].contains(&second.name.as_str()), "{second:?}");
    assert!((second.over_best.mean - 18.0 / 16.0).abs() < 0.06, "{second:?}");
    for point in strategy.points.iter().flat_map(|point| &point.cities) {
        assert!((point.work_s / tuned.time_s - 1.0).abs() < 0.1, "{point:?}");
    }
}

#[test]
fn the_same_is_found_by_any_number_of_threads_and_again() {
    let json = |threads| serde_json::to_string(&found(threads, "toy same")).expect("JSON");
    let first = json(1);
    assert_eq!(json(2), first);
    assert_eq!(json(2), first);
}

#[test]
fn who_wins_by_chance_has_an_honest_score() {
    let clock = Cpu::new();
    let engine = Engine { clock: &clock, workers: 2, seed: 0 };
    let mut ratios = [Vec::new(), Vec::new()];
    with_cities(16, |cities| {
        let grid = registry().grid("same").expect("a grid");
        for seed in 0..40 {
            let tuner = tuner(&engine, cities, 16.0 * 65e-9, 4, seed);
            let found = tuner.tune(&grid, &Unobserved).expect("tuned");
            let best = found.points.iter().find(|point| Some(&point.name) == found.best.as_ref()).expect("a point");
            // Every point has the same error: that of one weight, whose relative variance is 1.
            let exact = cities.iter().map(|city| exact(city).ln()).sum::<f64>() / cities.len() as f64;
            let mean = best.cities.iter().map(|on| on.rel_mse.ln()).sum::<f64>() / cities.len() as f64;
            let chosen = (best.chosen_by.expect("chosen") / best.score.expect("measured")).ln();
            ratios[0].push(mean - exact);
            ratios[1].push(mean - exact + chosen);
        }
    });
    let [fresh, chosen] = ratios.map(crate::base::statistics::Moments::of);
    // Four runs of 16 receivers: the mean of logarithms is a little below the logarithm of the mean.
    let low = -0.15 - 3.0 * fresh.standard_error();
    assert!(fresh.mean > low && fresh.mean < 3.0 * fresh.standard_error(), "{fresh:?}, from {low}, seeds 0 to 39");
    assert!(chosen.mean < fresh.mean - 0.2, "the choice flatters: {chosen:?} beside {fresh:?}");
}

/// relMSE of one pass of weights of relative variance 1.
fn exact(city: &City<'_>) -> f64 {
    city.truth.mean_over(|i| {
        let light = city.truth.mean()[i].as_dvec3();
        light * light * city.truth.weight(i)
    })
}

#[test]
fn a_point_that_cannot_be_measured_says_why_and_the_others_go_on() {
    let tuned = found(2, "toy:picks={1,4},heavy={0,100000}");
    let points = &tuned.strategies[0].points;
    let out: Vec<bool> = points.iter().map(|point| point.out.is_some()).collect();
    assert_eq!(out, [false, true, false, true], "{points:#?}");
    let dear = |point: &&TunedPoint| point.out.as_ref().is_some_and(|why| why.contains("s of counted work"));
    assert!(points.iter().filter(dear).all(|point| point.score.is_none() && point.cities.is_empty()));
    assert_eq!(points.iter().filter(dear).count(), 2);

    let clock = Cpu::new();
    let engine = Engine { clock: &clock, workers: 1, seed: 0 };
    let stage = stage(4.0, 2);
    let target = Target::whole(&stage).thinned(64);
    let cities = [City { target: &target, truth: &truth(&target) }];
    let grid = registry().grid("toy").expect("a grid");
    let found = tuner(&engine, &cities, 1.0, 2, 0).tune(&grid, &Unobserved).expect("none can be measured");
    assert!((found.best.is_none() && found.gain.is_none() && found.second.is_none()), "{found:?}");
    assert!(found.points.iter().all(|point| point.out.as_ref().is_some_and(|why| why.contains("is for one light"))));
}

#[test]
fn nothing_to_tune_on_is_refused() {
    let clock = Cpu::new();
    let engine = Engine { clock: &clock, workers: 1, seed: 0 };
    let grid = registry().grid("toy").expect("a grid");
    let message = |tuner: Tuner<'_>, grid: &[Configured]| {
        tuner.tune(grid, &Unobserved).err().map(|error| error.to_string()).unwrap_or_default()
    };
    with_cities(4, |cities| {
        assert!(message(tuner(&engine, &[], 1.0, 2, 0), &grid).contains("no city"));
        assert!(message(tuner(&engine, cities, 1.0, 2, 0), &[]).contains("no points"));
        assert!(message(tuner(&engine, cities, 1.0, 0, 0), &grid).contains("no runs"));
        for time_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(message(tuner(&engine, cities, time_s, 2, 0), &grid).contains("above 0"));
        }
    });
    let tuned = seeds(17, 8);
    assert!(tuned.iter().enumerate().all(|(i, seed)| *seed != 17 && !tuned[..i].contains(seed)), "{tuned:?}");
}

#[test]
fn what_was_found_is_read_as_it_was_written_and_used_for_its_condition_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("tuned.json");
    let tuned = found(2, "toy");
    tuned::write(&file, &tuned).expect("written");
    assert_eq!(tuned::read(&file).expect("read"), tuned);

    let registry = registry();
    let asked = registry.grids("toy same:tag=3").expect("a list");
    let apply = |tuned: &Tuned, asked: &[Vec<Configured>], condition: &Condition, reported: &[TuningCity]| {
        let found = Found::new(&file, tuned, &registry)?;
        let all = found.apply(&registry, asked, condition, reported)?;
        Ok::<_, Error>(all.iter().map(|one| one.name().to_owned()).collect::<Vec<_>>())
    };
    let other = TuningCity { seed: 12_345_678, hash: "another".into() };
    let names = apply(&tuned, &asked, &condition(), &[other]).expect("applied");
    assert_eq!(names, ["toy:picks=4", "toy", "same:tag=3"]);
    let message = |result: Result<Vec<String>>| result.err().map(|error| error.to_string()).unwrap_or_default();
    let other = Condition { lights: 2, ..condition() };
    assert!(message(apply(&tuned, &asked, &other, &[])).contains("`condition.lights`: is 1, this is 2"));
    let other = Condition { receivers: "spread".into(), ..condition() };
    assert!(message(apply(&tuned, &asked, &other, &[])).contains("is centre, this is spread"));
    let city = &tuned.cities[1];
    for reported in
        [TuningCity { seed: 12_345_678, ..city.clone() }, TuningCity { hash: "another".into(), ..city.clone() }]
    {
        let reported = message(apply(&tuned, &asked, &condition(), &[reported]));
        assert!(reported.contains("`cities[") && reported.contains("take another --scene-seed"), "{reported}");
    }
    let untuned = registry.grids("same").expect("a list");
    assert!(message(apply(&tuned, &untuned, &condition(), &[])).contains("says nothing of `same`"));
    let mut strange = tuned.clone();
    strange.strategies[0].best = Some("tay:picks=4".into());
    let strange = message(apply(&strange, &asked, &condition(), &[]));
    assert!(strange.contains("`strategies[0].best`") && strange.contains("near it: toy"), "{strange}");
    let other_rates = Tuned { rates: RATES + 1, ..tuned.clone() };
    assert!(message(apply(&other_rates, &asked, &condition(), &[])).contains("tune again"));
}

#[test]
fn a_file_that_no_tuning_wrote_is_refused_with_what_is_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("tuned.json");
    let tuned = found(2, "toy");
    let message = |text: &str| {
        std::fs::write(&file, text).expect("written");
        tuned::read(&file).err().map(|error| error.to_string()).unwrap_or_default()
    };
    let text = serde_json::to_string(&tuned).expect("JSON");
    let with = |change: &dyn Fn(&mut Tuned)| {
        let mut tuned = tuned.clone();
        change(&mut tuned);
        serde_json::to_string(&tuned).expect("JSON")
    };
    for (text, right) in [
        ("picks=4".to_owned(), "tuned.json:1:"),
        (String::new(), "`--tune` wrote is wanted"),
        (text.replacen("\"schema\":1", "\"schema\":7", 1), "`schema`: is 7, this program reads 1"),
        (text.replacen("\"rates\"", "\"rate\"", 1), "unknown field `rate`"),
        (with(&|tuned| tuned.time_s = -1.0), "`time_s`: is -1"),
        (with(&|tuned| tuned.cities.clear()), "`cities`: is empty"),
        (with(&|tuned| tuned.runs = 0), "`runs`: is 0"),
        (with(&|tuned| tuned.strategies[0].best = Some("toy:picks=3".into())), "is none of its points"),
        (with(&|tuned| tuned.strategies[0].points.clear()), "does not begin with the default"),
        (with(&|tuned| tuned.strategies.push(tuned.strategies[0].clone())), "is an earlier one's, too"),
        (with(&|tuned| tuned.strategies[0].points[1].cities.truncate(1)), "3, one each, or none is right"),
    ] {
        assert!(message(&text).contains(right), "{right}: {}", message(&text));
    }
    let nowhere = tuned::read(Path::new("no/such/file.json")).err().map(|error| error.to_string());
    assert!(nowhere.is_some_and(|text| text.contains("cannot read no/such/file.json")));
}
