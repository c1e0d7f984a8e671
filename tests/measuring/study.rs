//! Promise: a study records typed tables that its page and plots follow from alone, and what it says holds.
use crate::promises::common::{ground, point, receiver, sampler, spot, stage_with};
use citylights::base::colour::luminance;
use citylights::base::error::{Error, Result};
use citylights::base::random::RunKey;
use citylights::base::statistics::Moments;
use citylights::measure::observer::{Observer, Unobserved};
use citylights::record::study::{
    AxisRecord, Cell, ColumnRecord, Format, PlotRecord, STUDY_SCHEMA, Study, StudyRecord, TableRecord,
};
use citylights::record::study_store::{STUDY_FILE, StudyWriter, read_study};
use citylights::record::{Kind, Machine, ResultFolder};
use citylights::report::{self, Drift};
use citylights::scene::light_sampling::LightSampling;
use citylights::scene::receiver::Receiver;
use citylights::shading::contribution::contribution;
use citylights::sources::Overrides;
use citylights::strategy::Registry;
use citylights::strategy::{Frame, PickBuffer};
use citylights::study::quality::{Finding, quality};
use citylights::study::{self, StudyOptions};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::LeaveOut;
use glam::Vec3;
use std::fs;
use std::path::Path;

fn number(name: &str, format: Format) -> ColumnRecord {
    ColumnRecord { name: name.to_owned(), head: name.replace('_', "\n"), format }
}

/// A study with a column of every format.
fn record() -> StudyRecord {
    let axis =
        |column: &str, logarithmic| AxisRecord { column: column.into(), label: format!("{column}!"), logarithmic };
    let formats = [
        ("lights", Format::Whole),
        ("strategy", Format::Name),
        ("heap_bytes", Format::Bytes),
        ("error", Format::Number),
        ("error_low", Format::Low),
        ("error_high", Format::High),
        ("lost_share", Format::Percent),
        ("setup_cpu_s", Format::Milliseconds),
        ("setup_cpu_s_low", Format::Low),
        ("setup_cpu_s_high", Format::High),
        ("cpu_s_a_sample", Format::Nanoseconds),
        ("remark", Format::Words),
    ];
    StudyRecord {
        schema: STUDY_SCHEMA,
        study: "growth".into(),
        question: "What grows?".into(),
        command: "citylights study growth".into(),
        plan: "scenes street=9f86d081; seed 1".into(),
        date: "2026-11-25".into(),
        program: None,
        version: "0.1.0".into(),
        revision: "67eec73".into(),
        seed: 1,
        machine: Machine { cpu: "a processor".into(), cores: 2, os: "an OS".into() },
        compiler: "rustc 1.95.0".into(),
        flags: "release".into(),
        warnings: Vec::new(),
        finished: false,
        pictures: Vec::new(),
        wall_s: 0.0,
        notes: vec!["as of today".into()],
        tables: vec![TableRecord {
            name: "growth".into(),
            title: "growth with lights".into(),
            columns: formats.map(|(name, format)| number(name, format)).to_vec(),
            notes: vec!["error: relative".into()],
            plots: vec![PlotRecord {
                name: "error".into(),
                title: "error against lights".into(),
                series: "strategy".into(),
                x: axis("lights", true),
                y: axis("error", false),
                beside: vec![("lost_share".into(), ", lost".into())],
                biased: vec!["influence".into()],
            }],
        }],
    }
}

fn rows() -> Vec<Vec<Cell>> {
    let row = |lights: u64, strategy: &str, error: f64, remark: &str| {
        let figures = [error, 0.9 * error, 1.2 * error, 0.123, 4.56e-3, 4.5e-3, f64::INFINITY, 7.89e-8].map(Cell::from);
        let before = [lights.into(), strategy.into(), (100 * lights).into()];
        before.into_iter().chain(figures).chain([remark.into()]).collect()
    };
    let mut rows: Vec<Vec<Cell>> = vec![
        row(100, "power:picks=2", 0.5, ""),
        row(100, "influence", f64::INFINITY, "two\nlines, \"quoted\""),
        row(1_000, "power:picks=2", 1.0 / 3.0, ""),
        row(1_000, "influence", 0.25, ""),
    ];
    rows[3][7] = Cell::Missing;
    rows
}

fn made(folder: &Path) -> Study {
    let mut writer = begun(folder, record()).expect("begun");
    put(&mut writer, &rows());
    writer.note("and a note from its end".into()).expect("written");
    writer.finish(1.5, |_, _| Ok(())).expect("finished")
}

fn begun(folder: &Path, record: StudyRecord) -> Result<StudyWriter> {
    StudyWriter::open(ResultFolder::open(folder, Kind::Study)?, record)
}

/// Puts each row where rows of its lights and strategy stand.
fn put(writer: &mut StudyWriter, rows: &[Vec<Cell>]) {
    for cells in rows {
        let key = [("lights", cells[0].clone()), ("strategy", cells[1].clone())];
        writer.put("growth", &key, vec![cells.clone()]).expect("written");
    }
}

#[test]
fn the_record_and_its_page_are_the_recorded_ones() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = made(folder.path());
    report::report(folder.path()).expect("written");
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect("read");
    // A change of the first two is a change of schema: raise `STUDY_SCHEMA` with it.
    insta::assert_snapshot!("study_schema_2_json", read(STUDY_FILE));
    insta::assert_snapshot!("study_schema_2_csv", read("growth.csv"));
    insta::assert_snapshot!("study_page", read("growth.md"));
    insta::assert_snapshot!("study_terminal", report::study_text(&study, 140));
    let plot = read("growth-error.svg");
    for part in ["error against lights", "lights!", "error!", "power", "picks=2, lost", "dashed and hollow: biased"] {
        assert!(plot.contains(part), "{part}");
    }
    assert!(!plot.contains("NaN") && !plot.contains("inf\n"), "what no axis can show is left out");
}

#[test]
fn a_study_comes_back_as_it_was_made() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = made(folder.path());
    assert_eq!(read_study(folder.path()).expect("read"), study);
    let files = |name: &str| fs::read(folder.path().join(name)).expect("read");
    let before = [files(STUDY_FILE), files("growth.csv")];
    // Again, all of it is there.
    let mut writer = begun(folder.path(), record()).expect("the same");
    assert!(writer.has("growth", &[], 4) && writer.has("growth", &[("lights", 100.into())], 2));
    writer.note("as of today".into()).expect("there");
    assert_eq!(writer.finish(9.0, |_, _| Ok(())).expect("finished"), study);
    assert_eq!([files(STUDY_FILE), files("growth.csv")], before, "results are never overwritten");
    let other = |what: &str, record: StudyRecord| {
        let error = begun(folder.path(), record).err().expect("refused").to_string();
        assert!(error.contains(what), "{error}");
    };
    other("other scenes or options", StudyRecord { plan: "seed 2".into(), ..record() });
    other("other revision", StudyRecord { revision: "67eec73+".into(), ..record() });
    other("holds the study growth", StudyRecord { study: "decay".into(), ..record() });
    other("other tables", StudyRecord { tables: Vec::new(), ..record() });
}

#[test]
fn rows_that_were_measured_together_are_replaced_together() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut writer = begun(folder.path(), record()).expect("begun");
    let all = rows();
    put(&mut writer, &[all[0].clone(), all[2].clone(), all[3].clone()]);
    let hundred = [("lights", 100.into())];
    assert!(!writer.has("growth", &hundred, 2) && writer.has("growth", &[("lights", 1_000.into())], 2));
    writer.put("growth", &hundred, all[..2].to_vec()).expect("written");
    assert!(writer.has("growth", &hundred, 2));
    assert_eq!(writer.table("growth").1, all);
    let lost =
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| writer.put("growth", &hundred, all[2..].to_vec())));
    assert!(lost.is_err(), "rows of another key would be lost");
}

#[test]
fn an_interrupted_study_keeps_its_rows_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut writer = begun(folder.path(), record()).expect("begun");
    let [first, second, ..] = &rows()[..] else { panic!("four rows") };
    put(&mut writer, &[first.clone(), second.clone()]);
    drop(writer);
    let file = folder.path().join("growth.csv");
    let text = fs::read_to_string(&file).expect("read");
    fs::write(&file, &text[..text.len() - 1]).expect("cut");
    let study = read_study(folder.path()).expect("read");
    assert_eq!(study.rows, [[first.clone()]], "the line that was cut short is left out");
    assert!(report::study_text(&study, 140).contains("warning: not finished: some rows are missing"));
    // Gone on with, it is what it would have been.
    let mut writer = begun(folder.path(), record()).expect("resumed");
    assert!(writer.has("growth", &[], 1));
    put(&mut writer, &rows()[1..]);
    drop(writer);
    fs::remove_file(&file).expect("removed");
    assert!(read_study(folder.path()).expect("read").rows[0].is_empty(), "a table that was not yet begun");
    let mut writer = begun(folder.path(), record()).expect("resumed");
    put(&mut writer, &rows());
    writer.note("and a note from its end".into()).expect("written");
    let study = writer.finish(1.5, |_, _| Ok(())).expect("finished");
    assert_eq!(study, made(tempfile::tempdir().expect("a folder").path()));
}

#[test]
fn a_cell_that_cannot_be_read_is_named_by_file_line_and_column() {
    let folder = tempfile::tempdir().expect("a folder");
    made(folder.path());
    let file = folder.path().join("growth.csv");
    let whole = fs::read_to_string(&file).expect("read");
    for (from, to, expected) in [
        ("0.5,", "half,", "growth.csv:2: `error`: `half` is not a number"),
        ("\n100,", "\n-1,", "growth.csv:2: `lights`: `-1` is not a whole number"),
        ("\n100,", "\n100,100,", "growth.csv:2: 13 fields where 12 are expected"),
        ("heap_bytes", "heap", "growth.csv:1: column `heap` stands where study.json has `heap_bytes`"),
    ] {
        fs::write(&file, whole.replacen(from, to, 1)).expect("written");
        let error = read_study(folder.path()).expect_err("not a row").to_string();
        assert!(error.ends_with(expected), "{error}");
    }
}

#[test]
fn a_section_points_to_the_plots_of_its_folder() {
    let results = tempfile::tempdir().expect("a folder");
    let folder = results.path().join("2026-11-25-study-growth-67eec73");
    fs::create_dir(&folder).expect("made");
    made(&folder);
    let sections = report::sections(&folder, &results.path().join("README.md")).expect("read");
    let [section] = &sections[..] else { panic!("one section") };
    assert_eq!(section.name, "study growth");
    for part in [
        "## study growth\n",
        "](2026-11-25-study-growth-67eec73/growth-error.svg)",
        "Made by `citylights study growth`",
    ] {
        assert!(section.body.contains(part), "{part}\n{}", section.body);
    }
}

/// A street between two facades, in a folder of its own.
const STREET: &str = include_str!("../data/street.toml");

fn options(folder: &Path, strategies: &str) -> StudyOptions {
    StudyOptions {
        registry: Registry::standard(),
        program: None,
        scenes: Vec::new(),
        overrides: Overrides::default(),
        strategies: Some(strategies.to_owned()),
        receivers: 60,
        pixels: Some(32),
        passes: 4,
        seconds: 2.0,
        repeats: 3,
        max_lights: 1_000,
        seed: 1,
        threads: 2,
        cache: folder.join("cache"),
    }
}

/// Runs a study, checks that its derived files follow from its cells, and that a changed cell is noticed.
fn ran(name: &str, options: &StudyOptions, folder: &Path) -> Study {
    let out = folder.join(name);
    let make = || ResultFolder::open(&out, Kind::Study);
    let study = study::find(name).expect("known").run(options, format!("citylights study {name}"), &make, &Unobserved);
    let study = study.expect("finished");
    report::report(&out).expect("written");
    assert_eq!(report::check(&out).expect("checked"), []);
    assert_eq!(read_study(&out).expect("read"), study);
    assert!(study.record.finished && study.record.wall_s > 0.0);
    for (table, rows) in study.record.tables.iter().zip(&study.rows) {
        assert!(!rows.is_empty(), "table `{}` is empty", table.name);
    }

    // A count in the last row of the first table, made another one.
    let table = &study.record.tables[0];
    let file = out.join(format!("{}.csv", table.name));
    let text = fs::read_to_string(&file).expect("read");
    let at = table.columns.iter().position(|c| c.format == Format::Whole).expect("a count");
    let last = text.trim_end().rfind('\n').expect("lines") + 1;
    let mut fields: Vec<&str> = text[last..].trim_end().split(',').collect();
    fields[at] = "123456";
    fs::write(&file, format!("{}{}\n", &text[..last], fields.join(","))).expect("written");
    let drifts = report::check(&out).expect("checked");
    assert!(
        matches!(&drifts[..], [Drift::Differs { file, .. }, ..] if file.ends_with(format!("{name}.md"))),
        "{drifts:?}"
    );
    study
}

/// The cells of a strategy's row in the table of that name.
fn cells<'a>(study: &'a Study, table: &str, strategy: &str, column: &str) -> Vec<&'a Cell> {
    let at = study.record.tables.iter().position(|t| t.name == table).expect("the table");
    let (record, rows) = (&study.record.tables[at], &study.rows[at]);
    let (name, column) = (record.column("strategy").expect("names"), record.column(column).expect("the column"));
    rows.iter().filter(|cells| cells[name] == strategy.into()).map(|cells| &cells[column]).collect()
}

fn figure(study: &Study, table: &str, strategy: &str, column: &str) -> f64 {
    let cells = cells(study, table, strategy, column);
    cells.first().and_then(|cell| cell.number()).unwrap_or_else(|| panic!("no {column} of {strategy} in {table}"))
}

#[test]
fn strategies_are_told_apart_by_probability_and_by_measuring() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("street.toml");
    fs::write(&scene, STREET).expect("written");
    let options =
        StudyOptions { scenes: vec![scene], ..options(folder.path(), "uniform,intensity,influence:cutoff=100") };
    let study = ran("strategies", &options, folder.path());
    let quality = |strategy, column| figure(&study, "quality-street", strategy, column);
    // Points and spots alone: intensity is exact but for the facades' colours.
    assert!(quality("intensity", "mean_variance").abs() < 1e-3, "{}", quality("intensity", "mean_variance"));
    assert!(quality("uniform", "median_variance") > 0.1, "{}", quality("uniform", "median_variance"));
    assert!(quality("influence:cutoff=100", "biased_receivers") > 10.0, "lights out of range are never picked");
    assert!(quality("influence:cutoff=100", "mean_variance").is_infinite());
    assert_eq!(figure(&study, "measured-street", "intensity", "error_passes_to_intensity"), 1.0);
    assert!(figure(&study, "measured-street", "uniform", "error_passes_to_intensity") > 1.0);
    assert_eq!(*cells(&study, "measured-street", "influence:cutoff=100", "error_passes")[0], Cell::Missing);
}

#[test]
fn the_cut_off_loses_what_its_closed_form_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let options =
        StudyOptions { pixels: Some(128), ..options(folder.path(), "influence,influence-tail,stochastic-cull") };
    let study = ran("cutoff", &options, folder.path());
    for strategy in ["influence:cutoff=2", "influence", "influence:cutoff=0.125", "influence:transfer=srgb"] {
        let ratio = figure(&study, "law", strategy, "ratio");
        assert!((ratio - 1.0).abs() < 0.1, "{strategy}: {ratio} of the closed form");
    }
    let lost = |table, strategy| figure(&study, table, strategy, "lost_share");
    let law = figure(&study, "law", "influence", "lost_share");
    assert!(
        (lost("plane", "influence") / law - 1.0).abs() < 1e-3,
        "measured and listed: {} for {law}",
        lost("plane", "influence")
    );
    assert!(lost("open-city", "influence") > 3.0 * lost("city", "influence"), "buildings hide the far lamps");
    for table in ["plane", "open-city", "city"] {
        let end = |end| figure(&study, table, "stochastic-cull", &format!("lost_share_{end}"));
        let (low, high) = (end("low"), end("high"));
        let width = high - low;
        assert!(
            low - width < 0.0 && high + width > 0.0,
            "{table}: {} from {low} to {high}",
            lost(table, "stochastic-cull")
        );
    }
}

#[test]
fn growth_is_recorded_with_its_exponents() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = StudyOptions { max_lights: 10_000, ..options(folder.path(), "uniform,power,influence") };
    let study = ran("scaling", &options, folder.path());
    let lights: Vec<f64> = cells(&study, "growth", "power", "lights").iter().filter_map(|cell| cell.number()).collect();
    assert!(lights.len() == 3 && lights.windows(2).all(|w| w[1] > 5.0 * w[0]), "{lights:?}");
    let exponents = cells(&study, "exponents", "power", "exponent");
    assert_eq!(exponents.len(), 4, "of set-up, memory, time and error");
    let memory = exponents[1].number().expect("of memory");
    assert!((memory - 1.0).abs() < 0.2, "memory grows as lights^{memory}");
    assert_eq!(cells(&study, "exponents", "influence", "exponent").len(), 3, "an error that does not fall has none");
}

#[test]
fn each_step_to_what_places_see_stands_beside_the_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let few = StudyOptions { pixels: Some(8), passes: 1, repeats: 2, ..options(folder.path(), "visible,light-tree") };
    let missing = StudyOptions { scenes: vec!["scenes/no-such.toml".into()], ..few.clone() };
    let error = study::find("visible").expect("known").run(&missing, String::new(), &|| unreachable!(), &Unobserved);
    assert!(error.expect_err("no such scene").to_string().contains("no-such"));
    let study = ran("visible", &few, folder.path());
    let classic = "light-tree:arity=2,importance=classic,open=0,points=random";
    for table in ["canyon-1000", "plaza"] {
        assert_eq!(figure(&study, table, classic, "to_classic"), 1.0);
        assert_eq!(figure(&study, table, "light-tree", "to_tree"), 1.0);
        assert_eq!(*cells(&study, table, "oracle", "cpu_s")[0], Cell::Missing);
    }
    assert_eq!(cells(&study, "sweep", "light-tree", "to_first").len(), 2, "two scenes");
}

#[test]
fn every_strategy_is_measured_elsewhere_at_its_best_and_at_its_defaults() {
    let folder = tempfile::tempdir().expect("a folder");
    let few = StudyOptions {
        overrides: Overrides { resolution: Some((16, 9)), ..Overrides::default() },
        pixels: Some(4),
        seconds: 0.15,
        repeats: 4,
        ..options(folder.path(), "power:picks={1,4},light-tree:picks={1,2},visible:picks={1,2}")
    };
    let refused = |options: &StudyOptions| -> String {
        let run = study::find("elsewhere").expect("known").run(options, String::new(), &|| unreachable!(), &Unobserved);
        run.expect_err("refused").to_string()
    };
    let with = |strategies: &str| StudyOptions { strategies: Some(strategies.into()), ..few.clone() };
    assert!(refused(&with("influence")).contains("unbiased"));
    assert!(refused(&with("power:picks={}")).contains("power:picks={}"));
    let scenes = |files: &[&str]| StudyOptions { scenes: files.iter().map(Into::into).collect(), ..few.clone() };
    assert!(refused(&scenes(&["scenes/plaza.toml"])).contains("city"), "{}", refused(&scenes(&["scenes/plaza.toml"])));
    assert!(refused(&scenes(&["scenes/downtown.toml", "scenes/stadium.toml"])).contains("a single --scene"));

    let study = ran("elsewhere", &few, folder.path());
    let rows = |table: &str| {
        let at = study.record.tables.iter().position(|t| t.name == table).expect("the table");
        (&study.record.tables[at], &study.rows[at])
    };
    // Three conditions, five cities, three strategies, at their best and at their defaults.
    let (table, cases) = rows("cases");
    assert_eq!(cases.len(), 3 * 5 * 3 * 2);
    let at = |column: &str| table.column(column).expect("a column");
    let texts = |column: &str| -> Vec<&Cell> { cases.iter().map(|row| &row[at(column)]).collect() };
    for view in ["street", "roof", "sky"] {
        assert!(texts("view").contains(&&view.into()));
    }
    let v = at("v");
    assert!(cases.iter().all(|row| row[v].number().is_some_and(|v| v > 0.0)), "{cases:?}");
    // No city that parameters were found on is reported: seeds are those of the recipe and the four after it.
    let mut seeds: Vec<f64> = cases.iter().filter_map(|row| row[at("seed")].number()).collect();
    seeds.sort_by(f64::total_cmp);
    seeds.dedup();
    assert_eq!(seeds, [17.0, 18.0, 19.0, 20.0, 21.0]);
    for table in ["best", "default"] {
        for column in ["ratio_centre", "ratio_spread", "ratio_bounce", "ratio_all"] {
            assert_eq!(cells(&study, table, "light-tree", column)[0].number(), Some(1.0), "{table} {column}");
        }
        assert_eq!(*cells(&study, table, "visible", "cases")[0], Cell::Whole(15));
    }
    // The ratio of the table is that of its cases.
    let logs: Vec<f64> = ["visible", "light-tree"]
        .map(|strategy| {
            let own = |row: &&Vec<Cell>| row[at("strategy")] == strategy.into() && row[at("at")] == "best".into();
            let logs: Vec<f64> = cases.iter().filter(own).filter_map(|row| row[v].number()).map(f64::ln).collect();
            logs.iter().sum::<f64>() / logs.len() as f64
        })
        .to_vec();
    let ratio = cells(&study, "best", "visible", "ratio_all")[0].number().expect("measured");
    assert!((ratio / (logs[0] - logs[1]).exp() - 1.0).abs() < 1e-9, "{ratio}");
    assert_eq!(rows("loss").1.len(), 3 * 3, "for the one size");
}

/// The figure of a policy in a table of the study of offsets.
fn offset_figure(study: &Study, table: &str, distance: Option<u64>, policy: &str, column: &str) -> Option<f64> {
    let at = study.record.tables.iter().position(|t| t.name == table).expect("the table");
    let (record, rows) = (&study.record.tables[at], &study.rows[at]);
    let place = |name: &str| record.column(name).unwrap_or_else(|| panic!("no column {name} in {table}"));
    let row = rows.iter().find(|cells| {
        cells[place("policy")] == policy.into()
            && distance.is_none_or(|distance| cells[place("distance_m")] == distance.into())
    });
    row.unwrap_or_else(|| panic!("no {policy} in {table}"))[place(column)].number()
}

#[test]
fn only_the_default_offset_has_neither_acne_nor_leaks_far_from_the_origin() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = StudyOptions { receivers: 4_000, ..options(folder.path(), "power") };
    let study = ran("offsets", &options, folder.path());
    let figure =
        |distance, policy, column| offset_figure(&study, "totals", Some(distance), policy, column).expect("a figure");
    for distance in [0, 1_000, 2_048, 10_000] {
        let (lit, dark) = (figure(distance, "scaled", "lit"), figure(distance, "scaled", "dark"));
        let undecided = figure(distance, "scaled", "undecided") / figure(distance, "scaled", "rays");
        assert!(lit > 20_000.0 && dark > 20_000.0 && undecided < 0.25, "{distance} m: {lit}, {dark}, {undecided}");
        assert_eq!(figure(distance, "scaled", "acne"), 0.0, "at {distance} m");
        assert_eq!(figure(distance, "scaled", "leaks"), 0.0, "at {distance} m");
    }
    // A ten-thousandth of a metre is nothing from 2,048 m on.
    assert!(figure(1_000, "origin-push", "acne") < 10.0, "{}", figure(1_000, "origin-push", "acne"));
    assert!(figure(2_048, "origin-push", "acne") > 0.4 * figure(2_048, "origin-push", "lit"));
    // A grazing ray meets its own surface farther off than that.
    assert!(figure(1_000, "t-min", "acne") > 0.05 * figure(1_000, "t-min", "lit"));
    // 256 units reach through walls.
    assert!(figure(10_000, "ulps", "leaks") > 0.1 * figure(10_000, "ulps", "dark"));
    assert_eq!(figure(1_000_000, "ulps", "leaks"), figure(1_000_000, "ulps", "dark"), "all of it leaks");

    let start = |policy: &str, column: String| offset_figure(&study, "starts", None, policy, &column);
    for geometry in ["flat", "grazing", "concave"] {
        for failure in ["acne", "leaks"] {
            assert_eq!(start("scaled", format!("{geometry}_{failure}_m")), None, "{geometry}, {failure}");
        }
        assert!(start("ulps", format!("{geometry}_leaks_m")).is_some_and(|m| m <= 1_024.0), "{geometry}");
        assert!(start("t-min", format!("{geometry}_acne_m")).is_some_and(|m| m <= 1_024.0), "{geometry}");
        assert!(start("origin-push", format!("{geometry}_acne_m")).is_some_and(|m| m <= 2_048.0), "{geometry}");
        assert_eq!(start("origin-push", format!("{geometry}_leaks_m")), None, "{geometry}");
    }
}

#[test]
fn a_scene_without_a_city_cannot_be_grown() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("street.toml");
    fs::write(&scene, STREET).expect("written");
    let options = StudyOptions { scenes: vec![scene], ..options(folder.path(), "power") };
    let nowhere = || panic!("no folder is made for what cannot be run");
    let error = study::find("scaling").expect("known").run(&options, String::new(), &nowhere, &Unobserved);
    let error = error.expect_err("refused").to_string();
    assert!(error.contains("street.toml") && error.contains("`city`"), "{error}");
    let error = study::find("strategy").err().expect("unknown").to_string();
    assert!(error.contains("unknown study `strategy`") && error.contains("strategies"), "{error}");
}

/// Somebody who wants to stop at once.
struct Stopped;

impl Observer for Stopped {
    fn stopped(&self) -> bool {
        true
    }
}

#[test]
fn a_study_stops_when_asked_to_and_keeps_its_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = options(folder.path(), "power");
    for entry in study::STUDIES {
        let out = folder.path().join(entry.name);
        let make = || ResultFolder::open(&out, Kind::Study);
        let error = entry.run(&options, String::new(), &make, &Stopped).expect_err("stopped");
        assert!(matches!(error, Error::Interrupted), "{error}");
        assert!(!read_study(&out).expect("a readable study").record.finished);
    }
}

#[test]
fn the_quality_is_the_variance_of_an_estimate() {
    let mut lights: Vec<_> =
        (0..12).map(|i| point(Vec3::new(i as f32 * 1.7 - 9.0, (i % 3) as f32, 3.0), 20.0 + i as f32)).collect();
    lights.push(spot(Vec3::new(2.0, 3.0, 5.0), Vec3::new(-0.2, -0.3, -1.0), 300.0));
    let stage = stage_with(ground(12.0, lights), LeaveOut::No, Offset::SCALED);
    let at = receiver(Vec3::new(0.5, 1.0, 0.0), Vec3::Z);
    // As many receivers at one place as estimates: each draws its own numbers.
    let copies: Vec<Receiver> = (0..400_000).map(|pixel| Receiver { pixel, ..at }).collect();
    // In importance of points and spots nothing is left to chance, so that intensity's variance is 0.
    for (name, picks) in [("uniform", 1.0), ("power", 1.0), ("power:picks=4,points=random", 4.0), ("intensity", 1.0)] {
        let sampler = sampler(name, &stage);
        let Finding::Known(known) = quality(&stage, sampler.as_ref(), &at, &mut Vec::new()) else { panic!("{name}") };
        assert!((known.picks - picks).abs() < 1e-4, "{name}: {} picks", known.picks);
        let block = sampler.begin(Frame::new(&copies, RunKey { seed: 3, run: 0 }), 0..1);
        let (mut worker, mut buffer) = (block.worker(false), PickBuffer::default());
        worker.fill(&copies, 0..1, false, &mut buffer);
        let value = |light: u32| {
            contribution::<0b1111>(LightSampling::Area, &stage.scene().lights()[light as usize], [0.5; 2], &at)
                .map_or(0.0, |arrival| f64::from(luminance(arrival.radiance)))
        };
        let total: f64 = (0..stage.scene().lights().len() as u32).map(value).sum();
        let estimates =
            buffer.calls().map(|call| call.iter().map(|p| f64::from(p.weight) * value(p.light)).sum::<f64>());
        // Brought to one pick, as the quality is.
        let squares: Vec<f64> = estimates.map(|x| picks * (x / total - 1.0).powi(2)).collect();
        let found = Moments::of(squares.iter().copied());
        let t = (found.mean - known.variance) / (found.standard_error() + 1e-9);
        println!("{name}: {} by probabilities, {} found, t = {t}", known.variance, found.mean);
        assert!(
            t.abs() < 4.5,
            "{name}: {} by probabilities, {} found, t = {t}, limit 4.5, seed 3",
            known.variance,
            found.mean
        );
        assert!(
            name == "intensity" || found.standard_error() < 0.02 * known.variance,
            "{name}: too noisy to see anything"
        );
    }
}

#[test]
fn soft_shadows_fall_as_the_rays_and_the_best_shares_are_best() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = StudyOptions {
        pixels: Some(192),
        repeats: 8,
        overrides: Overrides { resolution: Some((48, 32)), ..Overrides::default() },
        ..options(folder.path(), "power")
    };
    let study = ran("soft-shadows", &options, folder.path());
    let rows = |table: &str| {
        let at = study.record.tables.iter().position(|t| t.name == table).expect("the table");
        let record = &study.record.tables[at];
        study.rows[at].iter().map(move |cells| move |column: &str| &cells[record.column(column).expect("the column")])
    };
    let number = |cell: &Cell| cell.number().unwrap_or_else(|| panic!("{cell:?} is no number"));
    // Independent points, and a penumbra that many receivers lie in.
    let law = rows("laws").find(|cell| *cell("light") == "large random".into()).expect("the large light");
    assert!((number(law("exponent")) + 1.0).abs() < 0.15, "relMSE grows as rays^{}", number(law("exponent")));
    let penumbras: Vec<f64> = rows("rays").map(|cell| number(cell("penumbra_share"))).collect();
    assert!(penumbras.is_sorted() && penumbras[0] < 0.01 && penumbras[penumbras.len() - 1] > 0.1, "{penumbras:?}");
    for cell in rows("shares") {
        let by = cell("by");
        if *by == "optimal".into() {
            assert_eq!(number(cell("distance")), 1.0);
        } else {
            // Beyond what the runs' noise explains.
            assert!(number(cell("distance")) > 1.2, "{by:?} is {} of the optimal", number(cell("distance")));
        }
        assert!(*by != "heuristic".into() || number(cell("gain")) > 1.2, "gain {}", number(cell("gain")));
    }
    for cell in rows("ways") {
        assert!(number(cell("projected_variance")) < 1e-9, "every projected point is worth the same");
        let (ratio, pays) = (number(cell("ratio")), number(cell("solid_angle_cost")) < 1.0);
        assert!(pays == (*cell("auto") == "solid-angle".into()) || (1.0..=4.0).contains(&ratio), "at {ratio}");
    }
    let picture = &study.record.pictures[0];
    assert!(folder.path().join("soft-shadows").join(&picture.file).is_file(), "{}", picture.file);
}
