//! Promise: a run that is killed at any moment is gone on with by the same command, to the same rows, and no two runs
//! write in one folder.
//!
//! Two hundred kills and fifty double starts, in some minutes:
//! `cargo test --release --test command_line -- --ignored --nocapture killed`.
#![cfg(feature = "cli")]

use citylights::base::random::Stream;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A command that fills a result folder, the folder that it fills undisturbed, and how long that takes.
struct Job {
    arguments: Vec<String>,
    home: TempDir,
    undisturbed: BTreeMap<String, String>,
    takes: Duration,
}

/// What became of some kills.
#[derive(Default)]
struct Kills {
    /// How many ended a process that was at work.
    killed: u32,
    /// How many came after its end.
    late: u32,
}

/// Many rows in little time; no budget in seconds that a busy machine could change.
const COMPARE: &str =
    "compare tests/data/lamp.toml --strategies uniform,power,all --budget 4 --seconds 9999 --repeats 6";
const STUDY: &str = "--receivers 40 --pixels 12 --passes 2 --repeats 2 --seconds 9999 --max-lights 100";

impl Job {
    fn new(arguments: &str) -> Self {
        let home = tempfile::tempdir().expect("a folder");
        let arguments = arguments.split(' ').map(str::to_owned).collect();
        let mut job = Self { arguments, home, undisturbed: BTreeMap::new(), takes: Duration::ZERO };
        let begun = Instant::now();
        finished(job.command("undisturbed", "cache").output().expect("it starts"));
        job.takes = begun.elapsed();
        job.undisturbed = content(&job.folder("undisturbed"));
        assert!(job.undisturbed.len() >= 3, "{:?}", job.undisturbed.keys());
        job
    }

    fn folder(&self, name: &str) -> PathBuf {
        self.home.path().join(name)
    }

    fn command(&self, out: &str, cache: &str) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin("citylights"));
        command.args(&self.arguments).arg("--out").arg(self.folder(out)).arg("--cache").arg(self.folder(cache));
        command.stdin(Stdio::null());
        command
    }

    fn start(&self, out: &str, cache: &str) -> Child {
        self.command(out, cache).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts")
    }

    /// Kills the command up to `times` times at random moments of one filling of a folder, lets it end, and looks at
    /// what it left.
    fn kill(&self, times: u32, name: &str, random: &mut Stream) -> Kills {
        let mut kills = Kills::default();
        while kills.killed < times && kills.late == 0 {
            let mut child = self.start(name, "cache of the killed");
            std::thread::sleep(self.takes.mul_f64(random.uniform64()));
            if child.try_wait().expect("asked").is_none() {
                child.kill().expect("killed");
                child.wait().expect("ended");
                kills.killed += 1;
            } else {
                finished(child.wait_with_output().expect("ended"));
                kills.late += 1;
            }
        }
        finished(self.command(name, "cache of the killed").output().expect("it starts"));
        self.assert_whole(name);
        kills
    }

    /// Starts the command twice at nearly the same time; gives whether the second was told that the folder is in use.
    fn start_twice(&self, name: &str, random: &mut Stream) -> bool {
        let first = self.start(name, "cache");
        std::thread::sleep(self.takes.mul_f64(0.5 * random.uniform64()));
        let second = self.start(name, "cache");
        let ends = [first, second].map(|child| child.wait_with_output().expect("ended"));
        let refused = ends.iter().filter(|end| end.status.code() == Some(2)).inspect(|end| {
            let said = String::from_utf8_lossy(&end.stderr);
            assert!(said.contains("in use by another process"), "{said}");
        });
        let refused = refused.count();
        assert!(refused < 2, "nobody came through");
        ends.into_iter().filter(|end| end.status.code() != Some(2)).for_each(finished);
        self.assert_whole(name);
        refused == 1
    }

    /// A folder holds what the undisturbed one holds, and its report agrees.
    fn assert_whole(&self, name: &str) {
        let folder = self.folder(name);
        let found = content(&folder);
        for (file, text) in &self.undisturbed {
            let there = found.get(file).unwrap_or_else(|| panic!("{name}: {file} is not there"));
            assert!(there == text, "{name}: {file} is\n{there}\nwhere an undisturbed run gives\n{text}");
        }
        assert_eq!(found.len(), self.undisturbed.len(), "{name}: {:?}", found.keys());
        let mut report = Command::new(assert_cmd::cargo::cargo_bin("citylights"));
        finished(report.arg("report").arg(&folder).arg("--check").output().expect("it starts"));
        fs::remove_dir_all(folder).expect("removed");
    }
}

fn finished(end: Output) {
    let said = [end.stdout, end.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
    assert_eq!(end.status.code(), Some(0), "{said}");
}

/// Every file of a result folder, and what in it does not depend on the day, the machine's speed or the folder's name.
fn content(folder: &Path) -> BTreeMap<String, String> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"));
    let file = |path: &Path| match path.extension().and_then(|e| e.to_str()) {
        Some("csv") => table(path),
        Some("json") => record(path),
        Some("png") => format!("{:?}", fs::read(path).expect("read")),
        _ => String::new(),
    };
    entries.map(|entry| (entry.file_name().to_string_lossy().into_owned(), file(&entry.path()))).collect()
}

/// The cells of a table but for times and what follows from them, in order of the rows.
fn table(path: &Path) -> String {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_path(path).expect("a table");
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
    let timed = |name: &str| ["cpu_s", "wall_s", "cost"].iter().any(|part| name.contains(part));
    let cells = |row: &csv::StringRecord| {
        let kept = row.iter().zip(&rows[0]).filter(|(_, name)| !timed(name)).map(|(cell, _)| cell.to_owned());
        kept.collect::<Vec<_>>().join(",")
    };
    // Exponents are of times, too.
    let mut lines: Vec<String> =
        rows.iter().map(cells).filter(|l| !l.contains("set-up") && !l.contains("time of")).collect();
    lines.sort();
    lines.join("\n")
}

/// What a record says of what was run and how it ended.
fn record(path: &Path) -> String {
    let record: serde_json::Value = serde_json::from_slice(&fs::read(path).expect("read")).expect("JSON");
    let mut lines: Vec<String> =
        ["plan", "finished", "notes", "tables", "pictures"].iter().map(|key| record[key].to_string()).collect();
    for summary in record["scenes"].as_array().into_iter().flatten().filter_map(|s| s["summaries"].as_array()).flatten()
    {
        let keys = ["strategy", "runs", "passes", "rel_mse", "rel_bias2", "mean_bias", "counts", "error", "skipped"];
        lines.extend(keys.iter().map(|key| summary[key].to_string()));
    }
    lines.join("\n")
}

#[test]
fn a_killed_run_goes_on_to_the_rows_of_an_undisturbed_one() {
    let mut random = Stream::keyed(&[1, 2, 3]);
    for arguments in
        [COMPARE.to_owned(), format!("study strategies --scene tests/data/street.toml -s uniform,power {STUDY}")]
    {
        let job = Job::new(&arguments);
        let (mut killed, mut folders) = (0, 0);
        while killed < 5 && folders < 5 {
            killed += job.kill(3, &format!("killed {folders}"), &mut random).killed;
            folders += 1;
        }
        println!("{:?} undisturbed, {killed} kills in {folders} folders", job.takes);
        assert!(killed > 0, "nothing was killed");
    }
}

#[test]
fn of_two_runs_at_once_one_is_told_that_the_folder_is_in_use() {
    let job = Job::new(COMPARE);
    let mut random = Stream::keyed(&[4, 5, 6]);
    let refused = (0..3).filter(|n| job.start_twice(&format!("twice {n}"), &mut random)).count();
    assert!(refused > 0, "no two runs met");
}

#[test]
#[ignore = "takes minutes"]
fn two_hundred_kills_and_fifty_double_starts() {
    let mut random = Stream::keyed(&[7, 8, 9]);
    let studies = [
        "strategies --scene tests/data/street.toml -s uniform,power",
        "offsets",
        "cutoff -s influence,influence-tail",
        "scaling -s uniform,power",
    ];
    let studies = studies.map(|study| format!("study {study} {STUDY}"));
    // Half of them comparisons.
    let compare = || std::iter::repeat_n(COMPARE.to_owned(), studies.len());
    let jobs: Vec<Job> = compare().chain(studies.clone()).map(|arguments| Job::new(&arguments)).collect();
    jobs.iter().for_each(|job| println!("{:?} undisturbed: {}", job.takes, job.arguments.join(" ")));
    let (mut killed, mut late, mut folders) = (0, 0, 0);
    for job in jobs.iter().cycle() {
        if killed >= 200 {
            break;
        }
        let kills = job.kill(1 + folders % 4, &format!("killed {folders}"), &mut random);
        (killed, late, folders) = (killed + kills.killed, late + kills.late, folders + 1);
    }
    println!("{killed} kills in {folders} folders, {late} more after the end: all as undisturbed");
    let starts = jobs.iter().cycle().take(50).enumerate();
    let refused = starts.filter(|(n, job)| job.start_twice(&format!("twice {n}"), &mut random)).count();
    println!("50 double starts, {refused} told that the folder is in use: all as undisturbed");
}

#[test]
#[ignore = "takes minutes"]
fn a_long_study_goes_on_too() {
    let job = Job::new(&format!("study soft-shadows --resolution 24x16 {STUDY}"));
    let kills = job.kill(5, "killed", &mut Stream::keyed(&[10, 11, 12]));
    println!("{:?} undisturbed, {} kills: {}", job.takes, kills.killed, job.arguments.join(" "));
}
