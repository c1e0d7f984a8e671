//! What many cities and views say together follows from their records alone.
use super::report::record;
use citylights::base::claim::Claim;
use citylights::record::{Interval, Point, RunRecord, SceneRecord, Summary};
use citylights::report::{derive, replicates};

/// A strategy whose relMSE times CPU seconds is `figure`.
fn measured(strategy: &str, figure: f64) -> Summary {
    let [cpu_s, rel_mse] = [4.0, figure / 4.0].map(Interval::certain);
    let least = Point { passes: 1, cpu_s: Interval::certain(1.0), rel_mse: Interval::certain(9.0 * figure) };
    let curve = vec![least, Point { passes: 16, cpu_s, rel_mse }];
    Summary { runs: 4, passes: 16, curve, ..Summary::blank(strategy.to_owned(), Claim::Unbiased) }
}

/// Four replicates of a village, each ten times as hard as the one before: `half` takes about half of the base's figure,
/// `same` about as much, and `broken` failed once.
fn run() -> RunRecord {
    let (run, _) = record();
    let [village] = &run.scenes[..] else { panic!("one scene") };
    let scene = |at: usize| {
        let (seed, view) = (7 + at as u64 / 2, ["street", "sky"][at % 2]);
        let hard = 10f64.powi(at as i32);
        let failed = Summary { error: Some("a light is never chosen".to_owned()), ..measured("broken", 1.0) };
        let biased = Claim::Biased { why: "drops lights".into() };
        SceneRecord {
            name: format!("village {seed} {view}"),
            seed,
            family: Some("village".to_owned()),
            view: Some(view.to_owned()),
            summaries: vec![
                measured("same", hard * [1.1, 0.9, 1.2, 0.85][at]),
                measured("base", hard),
                measured("half", hard * [0.5, 0.55, 0.4, 0.5][at]),
                if at == 2 { failed } else { measured("broken", 0.1 * hard) },
                Summary { claim: biased, ..measured("biased", 0.01 * hard) },
            ],
            ..village.clone()
        }
    };
    RunRecord { base: Some("base".to_owned()), scenes: (0..4).map(scene).collect(), ..run }
}

#[test]
fn the_table_of_a_family_is_the_recorded_one() {
    let texts = replicates::texts(&run(), 140);
    let [text] = &texts[..] else { panic!("one family: {texts:?}") };
    let widest = text.lines().map(|line| line.chars().count()).max().expect("lines");
    assert!(widest <= 140, "{widest} columns\n{text}");
    insta::assert_snapshot!(text);
}

#[test]
fn the_files_of_a_family_are_derived_and_the_same_each_time() {
    let files = derive(&run(), &[]).expect("files");
    assert_eq!(files, derive(&run(), &[]).expect("files"));
    let text = |name: &str| &files.iter().find(|file| file.name == name).unwrap_or_else(|| panic!("{name}")).text;
    insta::assert_snapshot!(text("replicates-village.md"));
    let plot = text("replicates-village.svg");
    // Four dots, a disc and its edge each, of three strategies and three of the one that failed; two in the legend.
    assert_eq!(plot.matches("<circle").count(), 2 * (3 * 4 + 3 + 2), "{plot}");
    for word in ["half", "same", "base", "broken", "street", "sky"] {
        assert!(plot.contains(word), "{word}");
    }
    assert!(!plot.contains("biased"), "{plot}");
}

#[test]
fn one_replicate_says_nothing_of_others() {
    let mut alone = run();
    alone.scenes.truncate(1);
    assert!(replicates::texts(&alone, 140).is_empty());
    let baseless = RunRecord { base: None, ..run() };
    assert!(replicates::texts(&baseless, 140).is_empty());
    assert!(derive(&baseless, &[]).expect("files").iter().all(|file| !file.name.starts_with("replicates")));
}

#[test]
fn a_scene_named_like_a_family_s_page_is_refused() {
    let mut run = run();
    let odd = SceneRecord { name: "replicates-village".to_owned(), family: None, ..run.scenes[0].clone() };
    run.scenes.push(odd);
    let error = derive(&run, &[]).expect_err("two files of one name").to_string();
    assert!(error.contains("replicates-village.md"), "{error}");
}

#[test]
fn older_records_have_no_families() {
    let older = serde_json::to_string(&record().0).expect("JSON");
    assert!(!older.contains("\"family\"") && !older.contains("\"base\""), "they would not be read by an older program");
    let read: RunRecord = serde_json::from_str(&older).expect("a record");
    assert!(read.base.is_none() && read.scenes[0].family.is_none() && read.scenes[0].view.is_none());
    let newer = serde_json::to_string(&run()).expect("JSON");
    assert_eq!(serde_json::from_str::<RunRecord>(&newer).expect("a record").scenes[3].view.as_deref(), Some("sky"));
}
