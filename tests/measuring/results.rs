//! Raw results keep every number, and a run that dies keeps its rows.
use citylights::base::claim::Claim;
use citylights::record::folder::MARK;
use citylights::record::store::{self, RowWriter};
use citylights::record::{
    Counts, Interval, Kind, Machine, Point, Read, Reading, ReferenceRecord, ResultFolder, Row, RunRecord, SCHEMA,
    SceneRecord, SharedWork, Summary,
};
use std::fs;
use std::path::{Path, PathBuf};

fn row(run: u32) -> Row {
    Row {
        scene: "village, \"small\"".to_owned(),
        strategy: "light-tree:arity=8,split=0.5".to_owned(),
        run,
        passes: 64,
        setup_cpu_s: 0.1 + 0.2,
        cpu_s: 1.0 / 3.0,
        wall_s: 5e-324,
        heap_bytes: u64::MAX,
        mse: f64::INFINITY,
        rel_mse: f64::MAX,
        rel_mse_trimmed: -0.0,
        trimmed_share: 1e-300,
        largest: std::array::from_fn(|i| 1.0 / (i as f64 + 7.0)),
        energy_ratio: f64::NEG_INFINITY,
        deciles: std::array::from_fn(|i| 1.0 / (i as f64 + 3.0)),
        error: None,
    }
}

fn record() -> RunRecord {
    let value = |mean| Interval { mean, low: 0.9 * mean, high: 1.2 * mean };
    RunRecord {
        schema: SCHEMA,
        plan: "scenes; strategies; budget".into(),
        command: "citylights compare scenes/village.toml".to_owned(),
        date: "2026-11-22".to_owned(),
        program: None,
        version: "0.1.0".to_owned(),
        revision: "67eec73".to_owned(),
        seed: 1,
        repeats: 16,
        machine: Machine { cpu: "a processor".to_owned(), cores: 2, os: "an OS".to_owned() },
        compiler: "rustc 1.95.0".to_owned(),
        flags: "release, x86-64".to_owned(),
        base: None,
        parameters: None,
        warnings: vec!["two other processes ran".to_owned()],
        finished: true,
        scenes: vec![SceneRecord {
            name: "village".to_owned(),
            file: "scenes/village.toml".to_owned(),
            hash: "abcd".to_owned(),
            seed: 7,
            family: None,
            view: None,
            visits: None,
            lights: 1000,
            width: 320,
            height: 180,
            pixels_measured: 50_000,
            receivers: 50_000,
            sky_share: 0.1,
            emitter_share: 0.03,
            rel_mse_epsilon: [1e-4, 2e-4, f64::INFINITY],
            reference: ReferenceRecord {
                kind: "exact sum".to_owned(),
                rel_mse: 0.0,
                energy_error: 0.0,
                rays: 50_000_000,
                cpu_s: 12.5,
                cached: false,
                subset: false,
            },
            shared: vec![SharedWork { what: "occluders".to_owned(), wall_s: 0.03 }],
            errors: vec![0.1, 0.01],
            times_s: vec![1.0],
            ranked_by: 1,
            notes: vec!["exposure 1: the scene states none".to_owned()],
            summaries: vec![Summary {
                runs: 16,
                curve: vec![Point { passes: 64, cpu_s: value(2.01), rel_mse: value(0.25) }],
                passes: 64,
                setup_cpu_s: value(0.01),
                arrival_cpu_s: value(0.08),
                pass_cpu_s: value(0.03),
                cpu_s: value(2.0),
                wall_s: 2.1,
                heap_bytes: 4096,
                rel_mse: value(0.25),
                mse: Interval { mean: f64::NAN, low: f64::NEG_INFINITY, high: f64::INFINITY },
                rel_mse_trimmed: value(0.2),
                rel_bias2: Interval { mean: -1e-5, low: f64::NEG_INFINITY, high: 1e-5 },
                mean_bias: value(-0.01),
                simultaneous_bias: value(-0.01),
                detectable_bias: 0.002,
                variance_seconds: Interval { mean: 0.5, low: 0.4, high: f64::INFINITY },
                balance_s: Some(value(38.0)),
                seconds_to: vec![
                    Reading { at: 0.1, value: value(5.0), how: Read::Extrapolated },
                    Reading { at: 0.01, value: value(0.0), how: Read::Never },
                ],
                error_at: vec![Reading { at: 1.0, value: value(0.5), how: Read::TooSoon }],
                rank: Some([1, 1]),
                letters: "ab".to_owned(),
                times_oracle: Some(value(2.5)),
                receivers: Some(256),
                counts: Counts {
                    samples: 3_200_000,
                    picks: 3_200_000,
                    shadow_rays: 2_000_000,
                    weighed: 9,
                    ..Counts::default()
                },
                ..Summary::blank(
                    "range:cutoff=0.5".to_owned(),
                    Claim::Biased { why: "drops lights below half a display step".into() },
                )
            }],
        }],
    }
}

fn lines(folder: &Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join(store::ROWS_FILE)).expect("read");
    text.lines().map(str::to_owned).collect()
}

#[test]
fn rows_come_back_bit_for_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut writer = RowWriter::create(folder.path()).expect("begun");
    let why = "no\nlight, \"none\"".to_owned();
    let failed = Row::failed("village".to_owned(), "broken".to_owned(), 3, 1, why);
    for r in [row(0), row(1), failed, Row { energy_ratio: f64::NAN, ..row(2) }] {
        writer.write(&r).expect("written");
        // Each row is in the file at once, while the writer is still open.
        assert!(lines(folder.path()).len() > 1);
    }
    let back = store::read_rows(folder.path()).expect("read");
    assert!(!back.cut_short);
    assert_eq!(back.rows[..2], [row(0), row(1)]);
    assert_eq!(back.rows[2].error.as_deref(), Some("no light, \"none\""));
    assert!(back.rows[2].mse.is_nan() && back.rows[2].deciles.iter().all(|d| d.is_nan()));
    assert!(back.rows[3].energy_ratio.is_nan());
    let lines = lines(folder.path());
    assert!(lines[3].contains("broken,3,1,,,,0,,,") && lines[4].contains(",NaN,"), "{lines:?}");
}

#[test]
fn records_come_back_with_infinities_and_nan() {
    let folder = tempfile::tempdir().expect("a folder");
    store::write_run(folder.path(), &record()).expect("written");
    let mut back = store::read_run(folder.path()).expect("read");
    let mse = &mut back.scenes[0].summaries[0].mse;
    assert!(mse.mean.is_nan() && (mse.low, mse.high) == (f64::NEG_INFINITY, f64::INFINITY));
    let mut expected = record();
    (mse.mean, expected.scenes[0].summaries[0].mse.mean) = (0.0, 0.0);
    assert_eq!(back, expected);
    assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1, "the temporary file is gone");
}

#[test]
fn the_schema_is_the_recorded_one() {
    let folder = tempfile::tempdir().expect("a folder");
    store::write_run(folder.path(), &record()).expect("written");
    RowWriter::create(folder.path()).expect("begun").write(&row(0)).expect("written");
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect("read");
    // A change here is a change of schema: raise `SCHEMA` with it.
    insta::assert_snapshot!("schema_2_run_json", read(store::RUN_FILE));
    insta::assert_snapshot!("schema_2_runs_csv", read(store::ROWS_FILE));
}

#[test]
fn a_line_cut_short_is_left_out_and_removed_on_resuming() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut writer = RowWriter::create(folder.path()).expect("begun");
    (0..3).for_each(|run| writer.write(&row(run)).expect("written"));
    let path = folder.path().join(store::ROWS_FILE);
    let whole = fs::read_to_string(&path).expect("read");
    let last = whole[..whole.len() - 1].rfind('\n').expect("lines") + 1;
    for cut in [last + 1, last + 20, whole.len() - 1] {
        fs::write(&path, &whole[..cut]).expect("written");
        let rows = store::read_rows(folder.path()).expect("read");
        assert!(rows.cut_short && rows.rows == [row(0), row(1)], "cut at {cut}");
        let (mut writer, finished) = RowWriter::resume(folder.path()).expect("resumed");
        assert_eq!(finished, [row(0), row(1)]);
        writer.write(&row(2)).expect("written");
        assert_eq!(fs::read_to_string(&path).expect("read"), whole);
    }
    // Even the header can be cut short.
    fs::write(&path, &whole[..9]).expect("written");
    assert!(store::read_rows(folder.path()).expect("read").cut_short);
    let (mut writer, finished) = RowWriter::resume(folder.path()).expect("resumed");
    assert!(finished.is_empty());
    (0..3).for_each(|run| writer.write(&row(run)).expect("written"));
    assert_eq!(fs::read_to_string(&path).expect("read"), whole);
}

#[test]
fn what_is_no_row_is_named_by_file_line_and_column() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut writer = RowWriter::create(folder.path()).expect("begun");
    (0..3).for_each(|run| writer.write(&row(run)).expect("written"));
    let path = folder.path().join(store::ROWS_FILE);
    let whole = fs::read_to_string(&path).expect("read");
    for (from, to, expected) in [
        ("inf", "fast", "runs.csv:2: `mse`: `fast` is not a number"),
        (",64,", ",-1,", "runs.csv:2: `passes`: `-1` is not a whole number"),
        (",64,", ",,", "runs.csv:2: `passes`: `` is not a whole number"),
        (",64,", ",64,64,", "runs.csv:2: 29 fields where 28 are expected"),
        ("cpu_s", "cpu_ms", "runs.csv:1: column 5 is `setup_cpu_ms` where schema 2 has `setup_cpu_s`"),
        (",error\n", "\n", "runs.csv:1: 27 columns where schema 2 has 28"),
    ] {
        fs::write(&path, whole.replacen(from, to, 1)).expect("written");
        let error = store::read_rows(folder.path()).expect_err("not a row").to_string();
        assert!(error.ends_with(expected), "{error}");
    }
}

#[test]
fn records_of_another_schema_or_cut_short_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    store::write_run(folder.path(), &record()).expect("written");
    let path = folder.path().join(store::RUN_FILE);
    let whole = fs::read_to_string(&path).expect("read");
    for (from, to, expected) in [
        ("\"schema\": 2", "\"schema\": 1", "`schema`: is 1, this program reads 2"),
        ("\"seed\": 1", "\"sed\": 1", "run.json:8: unknown field `sed`"),
        ("\"inf\"", "\"fast\"", "expected a number, \"inf\", \"-inf\" or \"nan\""),
    ] {
        fs::write(&path, whole.replacen(from, to, 1)).expect("written");
        let error = store::read_run(folder.path()).expect_err("refused").to_string();
        assert!(error.contains(expected), "{error}");
    }
    fs::write(&path, &whole[..whole.len() / 2]).expect("written");
    assert!(store::read_run(folder.path()).is_err());
}

#[test]
fn of_rows_that_stand_twice_the_last_is_gone_on_with() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut writer, none) = RowWriter::resume(folder.path()).expect("begun");
    assert!(none.is_empty());
    let other = Row { cpu_s: 7.0, ..row(0) };
    [row(0), row(1), other.clone()].iter().for_each(|row| writer.write(row).expect("written"));
    let (_, rows) = RowWriter::resume(folder.path()).expect("resumed");
    assert_eq!(rows, [row(1), other]);
    assert_eq!(store::read_rows(folder.path()).expect("read").rows, rows);
}

#[test]
fn new_result_folders_stand_beside_those_that_are_there() {
    let results = tempfile::tempdir().expect("a folder");
    let results = results.path().join("deep/results");
    let make = || {
        let folder = ResultFolder::create(&results, "2026-11-22", "old town/1", "67eec73abcdef", Kind::Comparison);
        folder.expect("made").path().to_owned()
    };
    let names: Vec<_> = (0..3).map(|_| make().file_name().expect("a name").to_string_lossy().into_owned()).collect();
    let first = "2026-11-22-old-town-1-67eec73";
    assert_eq!(names, [first.to_owned(), format!("{first}-2"), format!("{first}-3")]);
    let folder = results.join(first);
    RowWriter::create(&folder).expect("begun");
    assert!(RowWriter::create(&folder).is_err(), "rows that are there stay");
}

/// Every file below a folder and what is in it.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder).expect("listed").map(|entry| entry.expect("an entry").path());
    let mut found: Vec<_> = entries
        .flat_map(|path| if path.is_dir() { files(&path) } else { vec![(path.clone(), fs::read(path).expect("read"))] })
        .collect();
    found.sort();
    found
}

#[test]
fn a_folder_that_is_somebodys_own_is_refused_and_stays_as_it_is() {
    let home = tempfile::tempdir().expect("a folder");
    for name in ["films/holiday.mkv", ".hidden", store::RUN_FILE, ".citylights"] {
        let folder = home.path().join("own");
        let file = folder.join(name);
        fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        fs::write(&file, "mine").expect("written");
        fs::write(folder.join("notes.txt"), "mine").expect("written");
        let before = files(&folder);
        for refused in [
            ResultFolder::check(&folder, Kind::Comparison),
            ResultFolder::open(&folder, Kind::Comparison).map(drop),
            ResultFolder::open(&folder, Kind::Study).map(drop),
        ] {
            let error = refused.expect_err("refused").to_string();
            assert!(error.contains("nothing was touched") && error.contains("own"), "{name}: {error}");
        }
        assert_eq!(files(&folder), before, "{name}");
        fs::remove_dir_all(folder).expect("removed");
    }
}

#[test]
fn a_marked_folder_has_one_writer_and_one_kind() {
    let home = tempfile::tempdir().expect("a folder");
    let path = home.path().join("out");
    ResultFolder::check(&path, Kind::Study).expect("nothing is there");
    assert!(!path.exists(), "asking makes nothing");
    let held = ResultFolder::open(&path, Kind::Study).expect("made");
    fs::write(path.join("study.json"), "{}").expect("written");
    for refused in [
        ResultFolder::check(&path, Kind::Study),
        ResultFolder::open(&path, Kind::Study).map(drop),
        ResultFolder::hold(&path).map(drop),
    ] {
        let error = refused.expect_err("refused").to_string();
        assert!(error.contains("in use by another process"), "{error}");
    }
    drop(held);
    ResultFolder::check(&path, Kind::Study).expect("free");
    let error = ResultFolder::open(&path, Kind::Comparison).expect_err("refused").to_string();
    assert!(error.contains("marked as a study"), "{error}");
    assert!(ResultFolder::hold(&path).expect("free").is_some());
    assert!(ResultFolder::hold(home.path()).expect("not marked").is_none());
}

#[test]
fn a_folder_whose_maker_died_at_any_time_is_opened_again() {
    let home = tempfile::tempdir().expect("a folder");
    let path = home.path().join("out");
    for half_made in [None, Some(""), Some("{\"sch")] {
        fs::create_dir_all(&path).expect("made");
        half_made.map_or(Ok(()), |text| fs::write(path.join(MARK), text)).expect("written");
        let folder = ResultFolder::open(&path, Kind::Scratch).expect("opened");
        fs::write(path.join(".run.json.123.part"), "half").expect("written");
        fs::create_dir(path.join("deep")).expect("made");
        fs::write(path.join("deep/file"), "whole").expect("written");
        drop(folder);
        let folder = ResultFolder::open(&path, Kind::Scratch).expect("opened again");
        assert!(!path.join(".run.json.123.part").exists(), "half a file stays");
        folder.remove().expect("removed");
        assert!(!path.exists());
    }
}

#[test]
fn a_comparison_is_gone_on_with_by_its_like_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = RunRecord { finished: false, ..record() };
    assert_eq!(store::begun(folder.path(), &run).expect("nothing there"), None);
    store::write_run(folder.path(), &run).expect("written");
    let again = RunRecord { command: "the same, typed another way".into(), date: "2027-01-01".into(), ..run.clone() };
    assert!(store::begun(folder.path(), &again).expect("the same").is_some());
    let other = |what: &str, run: RunRecord| {
        let error = store::begun(folder.path(), &run).expect_err("refused").to_string();
        assert!(error.contains("another comparison") && error.contains(what), "{error}");
    };
    other("other scenes or options", RunRecord { plan: "another".into(), ..run.clone() });
    other("other revision", RunRecord { revision: "another".into(), ..run.clone() });
    other("other compiler, build flags", RunRecord { compiler: "a".into(), flags: "b".into(), ..run.clone() });
    other("other machine", RunRecord { machine: Machine { cores: 64, ..run.machine.clone() }, ..run });
}
