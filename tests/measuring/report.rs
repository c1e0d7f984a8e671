//! Tables, pages and plots follow from the raw rows alone, and drift is noticed.
use crate::promises::common::{IN_PROPORTION, times_as_long};
use citylights::base::claim::Claim;
use citylights::record::store::{self, RowWriter};
use citylights::record::{
    Counts, Interval, Kind, Machine, Point, Read, Reading, ReferenceRecord, ResultFolder, Row, RunRecord, SCHEMA,
    SceneRecord, SharedWork, Summary,
};
use citylights::report::{self, Drift, splice};
use std::fs;
use std::path::Path;

/// A made-up strategy: its error is b^2 + V/t.
struct Maker {
    strategy: &'static str,
    claim: Claim,
    setup_s: f64,
    pass_s: f64,
    v: f64,
    bias2: f64,
}

const RUNS: u32 = 4;

impl Maker {
    fn passes(&self) -> u32 {
        // Powers of 4 up to about two seconds.
        1 << (2 * ((2.0 / self.pass_s).log2().max(0.0) as u32 / 2))
    }

    /// Runs scatter by a factor that depends on the run and the budget, with mean 1.
    fn error(&self, run: u32, passes: u32) -> f64 {
        let scatter = [0.93, 1.05, 1.09, 0.93][run as usize];
        self.bias2 + scatter * self.v / (f64::from(passes) * self.pass_s)
    }

    fn rows(&self) -> impl Iterator<Item = Row> {
        let budgets = (0..).map(|n| 1u32 << (2 * n)).take_while(|&passes| passes <= self.passes());
        budgets.flat_map(|passes| (0..RUNS).map(move |run| (passes, run))).map(|(passes, run)| {
            let error = self.error(run, passes);
            Row {
                scene: "village".to_owned(),
                strategy: self.strategy.to_owned(),
                run,
                passes,
                setup_cpu_s: self.setup_s,
                cpu_s: f64::from(passes) * self.pass_s,
                wall_s: 1.1 * f64::from(passes) * self.pass_s,
                heap_bytes: 123_456,
                mse: 40.0 * error,
                rel_mse: error,
                rel_mse_trimmed: 0.8 * error,
                trimmed_share: if error > 0.0 { 0.2 } else { 0.0 },
                largest: std::array::from_fn(|i| 0.01 * error / (1.0 + i as f64)),
                energy_ratio: 0.999,
                deciles: std::array::from_fn(|i| error * 2.0 / (1.0 + i as f64)),
                error: None,
            }
        })
    }

    fn point(&self, passes: u32) -> Point {
        let rows: Vec<Row> = self.rows().filter(|r| r.passes == passes).collect();
        let mean = rows.iter().map(|r| r.rel_mse).sum::<f64>() / f64::from(RUNS);
        let rel_mse = around(mean, 0.12);
        Point { passes, cpu_s: around(self.setup_s + f64::from(passes) * self.pass_s, 0.02), rel_mse }
    }

    /// When the law above reaches an error.
    fn seconds_to(&self, error: f64) -> Reading {
        let of_noise = self.v / (error - self.bias2);
        let (first, last) = (self.pass_s, f64::from(self.passes()) * self.pass_s);
        let (how, value) = match of_noise {
            _ if error <= self.bias2 => (Read::Never, Interval::NONE),
            t if t <= first => (Read::Measured, around(self.setup_s + first, 0.02)),
            t if t <= last => (Read::Measured, around(self.setup_s + t, 0.13)),
            t => (Read::Extrapolated, around(self.setup_s + t, 0.2)),
        };
        Reading { at: error, value, how }
    }

    fn error_at(&self, seconds: f64) -> Reading {
        let sampling = seconds - self.setup_s;
        let how = match sampling {
            t if t < self.pass_s => Read::TooSoon,
            t if t <= f64::from(self.passes()) * self.pass_s => Read::Measured,
            _ => Read::Extrapolated,
        };
        let value = if how == Read::TooSoon { Interval::NONE } else { around(self.bias2 + self.v / sampling, 0.1) };
        Reading { at: seconds, value, how }
    }

    fn summary(&self) -> Summary {
        let picks = 20_000 * u64::from(self.passes());
        let curve: Vec<Point> = (0..)
            .map(|n| 1u32 << (2 * n))
            .take_while(|&passes| passes <= self.passes())
            .map(|passes| self.point(passes))
            .collect();
        let rel_mse = curve.last().expect("a budget").rel_mse;
        let cpu_s = f64::from(self.passes()) * self.pass_s;
        let mean_bias = Interval::symmetric(-0.1 * self.bias2.abs().sqrt(), 0.000_42);
        let is_unbiased = self.claim == Claim::Unbiased;
        Summary {
            runs: RUNS,
            passes: self.passes(),
            curve,
            setup_cpu_s: around(self.setup_s, 0.05),
            arrival_cpu_s: Interval::symmetric(0.1 * self.pass_s, 0.02 * self.pass_s),
            pass_cpu_s: around(self.pass_s, 0.01),
            cpu_s: around(cpu_s, 0.02),
            wall_s: 1.1 * cpu_s,
            heap_bytes: 123_456,
            rel_mse,
            mse: rel_mse.times(40.0),
            rel_mse_trimmed: Interval::symmetric(0.8 * rel_mse.mean, 0.05 * rel_mse.mean),
            rel_bias2: Interval::symmetric(self.bias2, 3e-5),
            mean_bias,
            simultaneous_bias: if is_unbiased { Interval::symmetric(mean_bias.mean, 0.001) } else { Interval::NONE },
            detectable_bias: 0.000_61,
            variance_seconds: around(self.v, 0.16),
            balance_s: self.claim.may_be_biased().then(|| match self.bias2 > 3e-5 {
                true => around(self.v / self.bias2, 0.3),
                false => Interval { mean: f64::INFINITY, low: cpu_s, high: f64::INFINITY },
            }),
            seconds_to: [0.1, 0.01, 0.001].map(|error| self.seconds_to(error)).to_vec(),
            error_at: [0.03, 0.3, 1.0].map(|seconds| self.error_at(seconds)).to_vec(),
            rank: None,
            letters: String::new(),
            times_oracle: is_unbiased.then(|| around(10.0 * self.v, 0.11)),
            receivers: None,
            counts: Counts {
                samples: picks,
                picks,
                shadow_rays: picks / 2,
                blocked: picks / 8,
                zero_intensity: 0,
                behind_surface: picks / 3,
                behind_light: 0,
                nodes: if self.strategy.starts_with("light-tree") { 17 * picks } else { 0 },
                weighed: if self.strategy.starts_with("light-tree") { 25 * picks / 2 } else { 0 },
                candidates: 0,
                choosing_rays: 0,
            },
            unstable: self.strategy == "uniform",
            skipped: None,
            error: None,
            ..Summary::blank(self.strategy.to_owned(), self.claim.clone())
        }
    }
}

/// With an interval that reaches a share of it down, and farther up.
fn around(mean: f64, share: f64) -> Interval {
    Interval { mean, low: mean * (1.0 - share), high: mean * (1.0 + share * (1.0 + share)) }
}

fn makers() -> Vec<Maker> {
    let biased = |why: &str| Claim::Biased { why: why.to_owned().into() };
    let maker = |strategy, claim, setup_s, pass_s, v, bias2| Maker { strategy, claim, setup_s, pass_s, v, bias2 };
    vec![
        maker("all", Claim::Ceiling, 0.0, 1.7, 0.0, 0.0),
        maker("null", Claim::Floor, 0.0, 0.002, 0.0, 0.997),
        maker("uniform", Claim::Unbiased, 0.000_1, 0.006, 12.0, 0.0),
        maker("power", Claim::Unbiased, 0.000_8, 0.007, 3.1, 0.0),
        maker("light-tree:arity=8,split=0.5,importance=conty", Claim::Unbiased, 0.045, 0.019, 0.071, 0.0),
        maker("range:cutoff=0.5", biased("drops lights below half a display step"), 0.02, 0.011, 0.12, 0.013),
        maker("range:cutoff=9", biased("drops lights below nine display steps"), 0.015, 0.004, 0.06, 0.21),
        maker("reservoir:candidates=32,reuse=biased", biased("reuses neighbours unweighted"), 0.0, 0.03, 0.3, -2e-6),
    ]
}

fn skipped(strategy: &str) -> Summary {
    let skipped = Some("skipped: one pass is 40.00 s of counted work".to_owned());
    Summary { skipped, ..Summary::blank(strategy.to_owned(), Claim::Unbiased) }
}

/// Not timed, on a few receivers.
fn oracle() -> Summary {
    let samples = 1_024;
    Summary {
        runs: 24,
        passes: 64,
        rel_mse: around(0.012, 0.08),
        times_oracle: Some(Interval::certain(1.0)),
        receivers: Some(4_096),
        counts: Counts {
            samples,
            picks: samples,
            weighed: 3_500 * samples,
            choosing_rays: 12_345,
            ..Counts::default()
        },
        ..Summary::blank("oracle".to_owned(), Claim::Oracle)
    }
}

pub(super) fn record() -> (RunRecord, Vec<Row>) {
    let mut rows: Vec<Row> = makers().iter().flat_map(Maker::rows).collect();
    let failure = "a light that contributes is never chosen: light 17, p = 0.0001".to_owned();
    rows.push(Row::failed("village".to_owned(), "broken".to_owned(), 0, 1, failure.clone()));
    let mut summaries: Vec<Summary> = makers().iter().map(Maker::summary).collect();
    for (name, rank, letters) in [("light-tree", [1, 1], "a"), ("power", [2, 3], "b"), ("uniform", [2, 3], "b")] {
        let summary = summaries.iter_mut().find(|s| s.strategy.starts_with(name)).expect("there");
        (summary.rank, summary.letters) = (Some(rank), letters.to_owned());
    }
    summaries.push(skipped("lightcuts:error=0.02"));
    // It failed after its runs: its figures are there, and say nothing.
    let broken = makers().into_iter().find(|maker| maker.strategy == "power").expect("there").summary();
    summaries.push(Summary { strategy: "broken".to_owned(), error: Some(failure), ..broken });
    summaries.push(oracle());
    let scene = SceneRecord {
        name: "village".to_owned(),
        file: "scenes/village.toml".to_owned(),
        hash: "9f86d081".to_owned(),
        seed: 7,
        family: None,
        view: None,
        visits: None,
        lights: 12_345,
        width: 320,
        height: 180,
        pixels_measured: 50_112,
        receivers: 50_112,
        sky_share: 0.1,
        emitter_share: 0.03,
        rel_mse_epsilon: [1.23e-6, 2e-6, 7.5e-7],
        reference: ReferenceRecord {
            kind: "stratified".to_owned(),
            rel_mse: 3.2e-6,
            energy_error: 5e-5,
            rays: 618_632_640,
            cpu_s: 312.5,
            cached: true,
            subset: false,
        },
        shared: vec![SharedWork { what: "occluders".to_owned(), wall_s: 0.031 }],
        errors: vec![0.1, 0.01, 0.001],
        times_s: vec![0.03, 0.3, 1.0],
        ranked_by: 1,
        notes: vec!["exposure 1: the scene states none".to_owned()],
        summaries,
    };
    let run = RunRecord {
        schema: SCHEMA,
        command: "citylights compare scenes/village.toml --repeats 4".to_owned(),
        plan: "scenes; strategies; budget".to_owned(),
        date: "2026-11-22".to_owned(),
        program: None,
        version: "0.1.0".to_owned(),
        revision: "67eec73".to_owned(),
        seed: 1,
        repeats: RUNS,
        machine: Machine { cpu: "A Processor 3000".to_owned(), cores: 2, os: "Linux 6.1".to_owned() },
        compiler: "rustc 1.95.0".to_owned(),
        flags: "release, x86-64-v2".to_owned(),
        base: None,
        parameters: None,
        warnings: vec!["the load average was 3.1 on 2 cores".to_owned()],
        finished: true,
        scenes: vec![scene],
    };
    (run, rows)
}

fn stored(folder: &Path) {
    let (run, rows) = record();
    store::write_run(folder, &run).expect("written");
    let mut writer = RowWriter::create(folder).expect("begun");
    rows.iter().for_each(|row| writer.write(row).expect("written"));
}

#[test]
fn the_terminal_table_is_the_recorded_one() {
    let (run, rows) = record();
    let table = report::table(&run, &run.scenes[0], &rows, 140);
    let widest = table.lines().map(|line| line.chars().count()).max().expect("lines");
    assert!(widest <= 140, "{widest} columns\n{table}");
    insta::assert_snapshot!(table);
}

#[test]
fn the_page_is_the_recorded_one() {
    let (run, rows) = record();
    insta::assert_snapshot!(report::page(&run, &run.scenes[0], &rows, "village.svg"));
}

#[test]
fn a_section_holds_the_answer_and_where_it_came_from() {
    let (mut run, rows) = record();
    run.finished = false;
    run.scenes[0].reference.rel_mse = 0.002;
    let section = report::section(&run, &run.scenes[0], &rows, "2026-11-22-village-67eec73/village.svg");
    for part in [
        "## village\n",
        "](2026-11-22-village-67eec73/village.svg)",
        "| `power` | unbiased | 2-3 b | ~31.0 -20 +24 % |",
        "Made by `citylights compare scenes/village.toml --repeats 4` (2026-11-22, revision 67eec73,",
        "- **not finished: some strategies or runs are missing**",
        "- **the best error is only 29 times the reference's own",
    ] {
        assert!(section.contains(part), "{part}\n{section}");
    }
    assert!(!section.contains("Work"));
}

/// The first table's cells of `strategy`, its name left out.
fn cells(run: &RunRecord, rows: &[Row], strategy: &str) -> Vec<String> {
    let section = report::section(run, &run.scenes[0], rows, "village.svg");
    let line = section.lines().find(|line| line.starts_with(&format!("| `{strategy}`"))).expect("a row");
    line.trim_matches('|').split('|').skip(1).map(|cell| cell.trim().to_owned()).collect()
}

/// Where a column stands among [`cells`].
const RANK: usize = 1;
const TO_TENTH: usize = 2;
const AT_FIRST: usize = 5;
const V: usize = 8;

/// A changed summary of `strategy`.
fn of<'a>(run: &'a mut RunRecord, strategy: &str) -> &'a mut Summary {
    run.scenes[0].summaries.iter_mut().find(|s| s.strategy == strategy).expect("there")
}

#[test]
fn readings_say_how_they_were_found() {
    let (mut run, rows) = record();
    let mut shown = |how: Read, value: Interval| {
        of(&mut run, "power").seconds_to[0] = Reading { at: 0.1, value, how };
        of(&mut run, "power").error_at[0] = Reading { at: 0.03, value, how };
        let cells = cells(&run, &rows, "power");
        [cells[TO_TENTH].clone(), cells[AT_FIRST].clone()]
    };
    assert_eq!(shown(Read::Measured, Interval::symmetric(3.0, 0.3)), ["3.00 ±10 %"; 2]);
    assert_eq!(shown(Read::Extrapolated, Interval { mean: 3.0, low: 2.4, high: 4.2 }), ["~3.0 -20 +40 %"; 2]);
    assert_eq!(shown(Read::Never, Interval::NONE), ["never"; 2]);
    assert_eq!(shown(Read::TooSoon, Interval::NONE), ["none yet"; 2]);
    assert_eq!(shown(Read::Unknown, Interval::NONE), ["–"; 2]);
    assert_eq!(shown(Read::Measured, Interval::certain(0.0)), ["0", "exact"]);
}

#[test]
fn an_interval_without_an_upper_end_is_a_bound_and_explained() {
    let (mut run, rows) = record();
    let explained =
        |run: &RunRecord| report::table(run, &run.scenes[0], &rows, 140).matches(" †: too heavy a tail").count();
    assert_eq!(explained(&run), 0);
    of(&mut run, "power").variance_seconds = Interval { mean: 3.1, low: 2.178, high: f64::INFINITY };
    assert_eq!(cells(&run, &rows, "power")[V], ">2.1 †");
    assert_eq!(explained(&run), 1, "under the one table that has the mark");
    of(&mut run, "power").variance_seconds = Interval { mean: 3.1, low: f64::NEG_INFINITY, high: f64::INFINITY };
    assert_eq!(cells(&run, &rows, "power")[V], "3.10 ±?");
    assert!(report::table(&run, &run.scenes[0], &rows, 140).contains(" ±?: the runs give no interval."));
}

#[test]
fn what_failed_has_no_figures_and_is_named_once_more_in_a_warning() {
    let (run, rows) = record();
    let cells = cells(&run, &rows, "broken");
    assert!(cells.iter().all(String::is_empty) && cells.len() > V, "{cells:?}");
    let table = report::table(&run, &run.scenes[0], &rows, 140);
    assert_eq!(
        table.matches("`broken` failed: a light that contributes is never chosen: light 17, p = 0.0001.").count(),
        1
    );
    assert!(table.contains("  warning: failed, without figures or rank: `broken`\n"), "{table}");
    assert_eq!(table.matches("broken").count(), 3, "it stands in no other table\n{table}");
    assert!(table.contains(" `lightcuts:error=0.02` skipped: one pass is 40.00 s of counted work.\n"), "{table}");
    assert!(!report::plot(&run.scenes[0]).expect("drawn").contains("broken"));
}

#[test]
fn rows_stand_by_the_error_that_ranks() {
    let (mut run, rows) = record();
    let order = |run: &RunRecord| {
        let section = report::section(run, &run.scenes[0], &rows, "village.svg");
        let names = section.lines().filter_map(|line| line.strip_prefix("| `")?.split(['`', ':']).next());
        names.map(str::to_owned).collect::<Vec<_>>()
    };
    let others = ["broken", "lightcuts", "reservoir", "range", "range", "null", "all", "oracle"];
    assert_eq!(order(&run)[..3], ["light-tree", "power", "uniform"]);
    assert_eq!(order(&run)[3..], others);
    assert_eq!(cells(&run, &rows, "power")[RANK], "2-3 b");
    let last = Reading { at: 0.01, value: Interval::NONE, how: Read::Unknown };
    of(&mut run, "power").seconds_to[1] = last;
    (of(&mut run, "power").rank, of(&mut run, "power").letters) = (None, String::new());
    assert_eq!(order(&run)[..3], ["light-tree", "uniform", "power"]);
    assert_eq!(cells(&run, &rows, "power")[RANK], "–");
    // By 0.1 `power` is sooner again.
    run.scenes[0].ranked_by = 0;
    assert_eq!(order(&run)[..3], ["light-tree", "power", "uniform"]);
    assert!(report::page(&run, &run.scenes[0], &rows, "village.svg").contains("| s to<br>▲0.1 | s to<br>0.01 |"));
}

#[test]
fn a_bias_that_may_be_zero_has_no_balance() {
    let (run, rows) = record();
    let page = report::page(&run, &run.scenes[0], &rows, "village.svg");
    let bias = page.split("## Bias\n").nth(1).expect("a table");
    let line = |name: &str| bias.lines().find(|line| line.starts_with(&format!("| `{name}"))).expect("a row");
    assert!(line("range:cutoff=0.5").contains("| 0.0130 ±0.2 % | 9.2 -30 +39 % | -1.140 ±0.042 | – |"));
    assert!(line("reservoir").contains("| -2e-6 ±3.0e-5 | > 1.92 |"), "{}", line("reservoir"));
    assert!(line("power").contains("| – | – | +0.000 ±0.042 | +0.00 ±0.10 |"), "{}", line("power"));
}

#[test]
fn what_errors_are_taken_at_and_what_is_off_the_clock_is_said() {
    let (mut run, rows) = record();
    let table = |run: &RunRecord| report::table(run, &run.scenes[0], &rows, 140);
    assert!(table(&run).contains("  off the clock, shared by all strategies, wall seconds: occluders 0.0310\n"));
    assert!(!table(&run).contains("errors are taken at"));
    run.scenes[0].pixels_measured = 2_000;
    run.scenes[0].shared.clear();
    assert!(
        table(&run).contains("  errors are taken at 2,000 of the receivers") && !table(&run).contains("off the clock")
    );
}

#[test]
fn of_rows_that_stand_twice_the_last_counts() {
    let (run, rows) = record();
    let scene = &run.scenes[0];
    let wrong = rows.iter().map(|row| Row {
        cpu_s: 3.0 * row.cpu_s,
        rel_mse: 7.0 * row.rel_mse,
        trimmed_share: 0.9,
        deciles: [5.0; 10],
        ..row.clone()
    });
    let twice: Vec<Row> = wrong.chain(rows.iter().cloned()).collect();
    assert_eq!(report::page(&run, scene, &twice, "village.svg"), report::page(&run, scene, &rows, "village.svg"));
}

#[test]
fn too_few_runs_to_see_a_large_bias_are_a_warning() {
    let (mut run, rows) = record();
    let mut warned = |lights: u64, detectable: f64| {
        let scene = &mut run.scenes[0];
        scene.lights = lights;
        for summary in scene.summaries.iter_mut().filter(|s| ["uniform", "power", "broken"].contains(&&*s.strategy)) {
            summary.detectable_bias = detectable;
        }
        let table = report::table(&run, &run.scenes[0], &rows, 140);
        table.lines().find(|line| line.contains("could go unseen")).map(str::to_owned)
    };
    assert_eq!(warned(10_000, 0.05), None);
    assert_eq!(warned(10_001, 0.06), None);
    let line = warned(10_000, 0.06).expect("a warning");
    assert!(line.starts_with("  warning: ") && line.ends_with(": `power`, `uniform`"), "{line}");
}

#[test]
fn columns_that_cannot_vary_are_left_out() {
    let (mut run, rows) = record();
    run.scenes[0].summaries.retain(|s| s.claim == Claim::Unbiased);
    run.scenes[0].summaries.iter_mut().for_each(|s| s.counts.blocked = 0);
    let table = report::table(&run, &run.scenes[0], &rows, 140);
    for absent in ["claim", "b²", "t*,", "blocked", "dark direction", "behind light", "candidates"] {
        assert!(!table.contains(&format!("{absent} ")) && !table.contains(&format!("{absent}\n")), "{absent}\n{table}");
    }
    assert!(table.contains("behind surface"));
}

#[test]
fn strategies_without_numbers_still_make_a_table_and_a_plot() {
    let (mut run, _) = record();
    run.scenes[0].summaries.retain(|s| s.error.is_some() || s.skipped.is_some());
    let table = report::table(&run, &run.scenes[0], &[], 140);
    assert!(table.contains("skipped: one pass") && table.contains("failed: a light"), "{table}");
    assert!(report::plot(&run.scenes[0]).expect("drawn").contains("no points to draw"));
}

#[test]
fn the_plot_names_every_curve_and_what_it_leaves_out() {
    let (run, _) = record();
    let svg = report::plot(&run.scenes[0]).expect("drawn");
    for maker in makers() {
        let name = maker.strategy.split(':').next().expect("a name");
        assert!(svg.contains(&format!("{name}\n</text>")), "{name}");
    }
    assert!(svg.contains("exact, not drawn: all") && !svg.contains("broken") && !svg.contains("NaN"));
    if let Some(path) = std::env::var_os("CITYLIGHTS_PLOT") {
        fs::write(path, &svg).expect("written");
    }
    assert!(svg == report::plot(&run.scenes[0]).expect("drawn"), "the same rows give the same bytes");
}

#[test]
fn a_plot_of_one_budget_and_one_run_is_drawn() {
    let (mut run, _) = record();
    let none = |mean| Interval { mean, low: f64::NEG_INFINITY, high: f64::INFINITY };
    run.scenes[0].summaries.retain(|s| s.strategy == "power");
    of(&mut run, "power").curve = vec![Point { passes: 1, cpu_s: none(0.3), rel_mse: none(2.0) }];
    let svg = report::plot(&run.scenes[0]).expect("drawn");
    assert!(svg.contains("power") && !svg.contains("NaN") && !svg.contains("inf") && !svg.contains("arrow"));
}

#[test]
fn intervals_that_go_on_beyond_the_frame_are_marked_there() {
    let (mut run, _) = record();
    let plot = |run: &RunRecord| report::plot(&run.scenes[0]).expect("drawn");
    let triangles = |svg: &str| svg.lines().filter(|line| line.contains("<polygon") && line.contains(",82 ")).count();
    assert!(!plot(&run).contains("arrow") && triangles(&plot(&run)) == 0);
    for point in &mut of(&mut run, "uniform").curve {
        point.rel_mse.high = f64::INFINITY;
    }
    let svg = plot(&run);
    assert!(svg.contains("filled arrow: too heavy a tail to say") && !svg.contains("open arrow"));
    // One for each of its budgets, and the band, which reaches up to the frame.
    assert_eq!(triangles(&svg), of(&mut run, "uniform").curve.len() + 1);
    of(&mut run, "power").curve[2].rel_mse.low = -1e-3;
    let svg = plot(&run);
    assert!(svg.contains("open arrow: the interval goes on") && !svg.contains("NaN"));
    if let Some(path) = std::env::var_os("CITYLIGHTS_PLOT_OF_ARROWS") {
        fs::write(path, &svg).expect("written");
    }
}

#[test]
fn another_renderer_stands_apart_and_leaves_the_others_as_they_are() {
    let (mut run, mut rows) = record();
    let before = report::plot(&run.scenes[0]).expect("drawn");
    let renderer = "Cycles in Blender 5".to_owned();
    let claim = Claim::External { renderer };
    let peer = Maker { strategy: "cycles", claim, setup_s: 1.5, pass_s: 0.04, v: 0.9, bias2: 0.02 };
    run.scenes[0].summaries.push(peer.summary());
    rows.extend(peer.rows());
    let table = report::table(&run, &run.scenes[0], &rows, 140);
    let line = table.lines().find(|line| line.trim_start().starts_with("cycles")).expect("a row");
    assert!(line.contains("external") && line.contains(" – "), "{line}");
    assert!(table.contains("`cycles`: Cycles in Blender 5."), "{table}");
    let cost = table.split("\nCost\n").nth(1).expect("a table of cost");
    let line = cost.lines().find(|line| line.trim_start().starts_with("cycles")).expect("a row");
    assert!(line.ends_with(" –"), "nobody knows its memory: {line}");
    let work = table.split("\nWork\n").nth(1).expect("a table of work").split("\nWork of choosing").next();
    assert!(!work.expect("text").contains("cycles"), "nobody counted its work");
    assert!(table.contains("holds for all 3 unbiased rows"), "it is not held to be unbiased");
    let after = report::plot(&run.scenes[0]).expect("drawn");
    assert!(after.contains("dotted: other renderers") && !before.contains("dotted"));
    let colours = |svg: &str, name: &str| {
        let legend = svg.lines().position(|line| line.trim() == name).expect("in the legend");
        let drawn: Vec<String> = svg
            .lines()
            .take(legend)
            .filter(|line| line.contains("<polygon") || line.contains("<circle"))
            .map(str::to_owned)
            .collect();
        drawn.last().and_then(|line| line.split("fill=\"").nth(1)?.split('"').next().map(str::to_owned))
    };
    assert_eq!(colours(&before, "uniform"), colours(&after, "uniform"), "a strategy's colour changed");
}

#[test]
fn an_edited_page_or_row_is_drift() {
    let folder = tempfile::tempdir().expect("a folder");
    stored(folder.path());
    let missing = report::check(folder.path()).expect("checked");
    assert!(matches!(&missing[..], [Drift::Missing(page), Drift::Missing(_)] if page.ends_with("village.md")));
    let written = report::report(folder.path()).expect("written");
    assert_eq!(written.len(), 2);
    assert_eq!(report::check(folder.path()).expect("checked"), []);

    let page = fs::read_to_string(&written[0]).expect("read");
    fs::write(&written[0], page.replacen("light-tree", "light-bush", 1)).expect("written");
    let line = page.lines().position(|l| l.contains("light-tree")).expect("in the table") + 1;
    let expected = Drift::Differs { file: written[0].clone(), line };
    assert_eq!(report::check(folder.path()).expect("checked"), [expected]);
    assert_eq!(report::report(folder.path()).expect("written"), written);
    assert_eq!(report::check(folder.path()).expect("checked"), []);

    let rows_file = folder.path().join(store::ROWS_FILE);
    let rows = fs::read_to_string(&rows_file).expect("read");
    fs::write(&rows_file, rows.replace(",0.2,", ",0.4,")).expect("written");
    let drifts = report::check(folder.path()).expect("checked");
    assert!(matches!(&drifts[..], [Drift::Differs { file, .. }] if file.ends_with("village.md")), "{drifts:?}");
}

/// What a check says of rows, changed by `change`.
fn faults(change: impl FnOnce(&mut RunRecord, &mut Vec<Row>)) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut run, mut rows) = record();
    change(&mut run, &mut rows);
    store::write_run(folder.path(), &run).expect("written");
    let mut writer = RowWriter::create(folder.path()).expect("begun");
    rows.iter().for_each(|row| writer.write(row).expect("written"));
    report::report(folder.path()).expect("written");
    let drifts = report::check(folder.path()).expect("checked");
    drifts.iter().map(|drift| drift.to_string().rsplit_once("runs.csv: ").expect("a row").1.to_owned()).collect()
}

#[test]
fn doubled_missing_and_unnamed_rows_are_found_and_named() {
    assert!(faults(|_, _| ()).is_empty());
    let power = |row: &Row| row.strategy == "power" && row.passes == 64;
    assert_eq!(
        faults(|_, rows| rows.extend(rows.iter().find(|row| power(row)).cloned())),
        ["village, `power`, run 0, 64 passes: stands 2 times"]
    );
    assert_eq!(
        faults(|_, rows| rows.retain(|row| !power(row) || row.run == 1)),
        ["village, `power`, 64 passes: run 0 is missing", "village, `power`, 64 passes: runs 2 to 3 are missing",]
    );
    assert_eq!(
        faults(|_, rows| rows.retain(|row| !row.strategy.starts_with("power") || row.passes < 256)),
        ["village, `power`, 256 passes: runs 0 to 3 are missing"]
    );
    let edited = faults(|_, rows| {
        rows.iter_mut().filter(|row| power(row) && row.run == 2).for_each(|row| row.rel_mse *= 0.5);
    });
    assert!(edited[0].contains("`power`, 64 passes: the mean relMSE is"), "{edited:?}");
    let more = |rows: &mut Vec<Row>| {
        let row = rows.iter().find(|row| power(row)).cloned().expect("a row");
        rows.extend([Row { run: 9, ..row.clone() }, Row { strategy: "nobody".into(), ..row }]);
    };
    assert_eq!(
        faults(|_, rows| more(rows)),
        ["village, `power`, 64 passes: run 9 where there are 4", "village, `nobody`: the record names none"]
    );
    // While scenes are still to come, their rows are in no summary.
    assert_eq!(
        faults(|run, rows| {
            run.finished = false;
            run.scenes.clear();
            more(rows);
        }),
        [""; 0]
    );
}

#[test]
fn a_record_of_absurdly_many_runs_is_checked_in_no_more_time() {
    // As many as a record may claim.
    const MOST: u32 = 1 << 16;
    let claimed = |runs: u32| {
        faults(|run, _| {
            run.repeats = runs;
            run.scenes[0].summaries.iter_mut().filter(|s| s.strategy == "power").for_each(|s| s.runs = runs);
        })
    };
    let found = claimed(MOST);
    assert_eq!(found.len(), 5, "one for each budget");
    assert!(found[0].ends_with("1 passes: runs 4 to 65535 are missing"), "{found:?}");
    let ratio = times_as_long(|| drop(claimed(MOST)), || drop(claimed(RUNS + 1)));
    assert!(ratio < IN_PROPORTION, "{ratio} times as long for ten thousand times as many");
}

#[test]
fn a_folder_in_use_is_read_but_not_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let held = ResultFolder::open(folder.path(), Kind::Comparison).expect("marked");
    stored(folder.path());
    assert_eq!(report::check(folder.path()).expect("read").len(), 2);
    let error = report::report(folder.path()).expect_err("refused").to_string();
    assert!(error.contains("in use by another process"), "{error}");
    drop(held);
    report::report(folder.path()).expect("written");
    let own = tempfile::tempdir().expect("a folder");
    fs::write(own.path().join("village.md"), "mine").expect("written");
    report::report(own.path()).expect_err("no record");
    assert_eq!(fs::read_to_string(own.path().join("village.md")).expect("read"), "mine");
}

#[test]
fn a_splice_keeps_what_people_wrote() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = folder.path().join("README.md");
    let read = || fs::read_to_string(&page).expect("read");
    splice::splice(&page, "village", "| old |\n").expect("made");
    let section =
        |body: &str| format!("<!-- citylights:begin village -->\n\n{body}\n\n<!-- citylights:end village -->");
    assert_eq!(read(), format!("{}\n", section("| old |")));

    fs::write(&page, format!("# Results\n\nwords  \n{}\n\nmore words, no last line break", section("| old |")))
        .expect("written");
    assert!(!splice::is_current(&page, "village", "| new |").expect("read"));
    splice::splice(&page, "village", "| new |").expect("spliced");
    let spliced = format!("# Results\n\nwords  \n{}\n\nmore words, no last line break", section("| new |"));
    assert_eq!(read(), spliced);
    assert!(splice::is_current(&page, "village", "| new |").expect("read"));
    splice::splice(&page, "town", "| town |").expect("appended");
    assert!(read().starts_with(&format!("{spliced}\n\n<!-- citylights:begin town -->\n\n| town |")), "{}", read());
}

#[test]
fn a_broken_section_is_named_and_left_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = folder.path().join("README.md");
    let (begin, end) = ("<!-- citylights:begin a -->", "<!-- citylights:end a -->");
    for (text, expected) in [
        (format!("words\n{begin}\n"), "README.md:2: this section has no `<!-- citylights:end a -->`"),
        (format!("{end}\n"), "README.md:1: this section has no `<!-- citylights:begin a -->`"),
        (format!("{end}\n\n{begin}\n"), "README.md:3: section `a` ends before it begins"),
        (format!("{begin}\n{end}\n{begin}\n{end}\n"), "README.md:3: section `a` stands here twice"),
    ] {
        fs::write(&page, &text).expect("written");
        let error = splice::splice(&page, "a", "body").expect_err("broken").to_string();
        assert!(error.ends_with(expected), "{error}");
        assert_eq!(fs::read_to_string(&page).expect("read"), text);
    }
}
