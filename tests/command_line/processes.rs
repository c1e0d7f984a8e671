//! Promise: whoever is asked to stop stops soon, and takes along whatever it has started.
#![cfg(all(feature = "cli", target_os = "linux"))]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const LAMP: &str = include_str!("../data/lamp.toml");

/// Seconds that nobody waits for; what a peer has started is known by how long it would sleep, a number of the test's own.
const LONG: u32 = 6_000;

/// Pythons that are none: what they start sleeps for $SLEEP seconds.
const PYTHONS: [(&str, &str); 4] = [
    ("plain", "exec sleep $SLEEP"),
    // A wrapper with a child beside the one that it waits for.
    ("wrapper", "sleep $SLEEP &\nsleep $SLEEP"),
    // One whose child is in a group of its own, as what `timeout` runs is.
    ("group", "timeout 6000 sleep $SLEEP\nexit 1"),
    // One that has ended and left a child behind.
    ("orphan", "sleep $SLEEP >/dev/null 2>&1 &\nexec sleep $SLEEP"),
];

struct Ground {
    folder: TempDir,
    sleep: String,
}

impl Ground {
    /// Of a test that has this number.
    fn new(number: u32) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, text) in PYTHONS {
            let python = folder.path().join(name);
            fs::write(&python, format!("#!/bin/sh\n{text}\n")).expect("written");
            fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).expect("made executable");
        }
        fs::write(folder.path().join("lamp.toml"), LAMP).expect("written");
        Self { folder, sleep: format!("{LONG}.{}{number}", std::process::id()) }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A comparison that waits for a peer.
    fn compare(&self, python: &str, out: &str, more: &[&str]) -> Running {
        let mut command = citylights();
        command.arg("compare").arg(self.path("lamp.toml")).args(["-s", "uniform,null", "--budget", "1"]);
        command.args(["--repeats", "2", "--peer", "mitsuba"]).arg("--peer-python").arg(self.path(python));
        command.arg("--out").arg(self.path(out)).arg("--cache").arg(self.path("cache")).args(more);
        Running::start(command.env("SLEEP", &self.sleep))
    }

    /// How many processes sleep for so long.
    fn sleepers(&self) -> usize {
        let processes = fs::read_dir("/proc").expect("processes").filter_map(Result::ok);
        let told = processes.filter_map(|process| fs::read(process.path().join("cmdline")).ok());
        told.filter(|line| line.split(|byte| *byte == 0).any(|word| word == self.sleep.as_bytes())).count()
    }
}

/// The program at work, and what it has said so far.
struct Running {
    child: Child,
    said: Arc<Mutex<String>>,
}

impl Running {
    fn start(command: &mut Command) -> Self {
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
        let said = Arc::new(Mutex::new(String::new()));
        let (mut stderr, heard) = (child.stderr.take().expect("piped"), Arc::clone(&said));
        std::thread::spawn(move || {
            let mut block = [0; 256];
            while let Ok(n @ 1..) = std::io::Read::read(&mut stderr, &mut block) {
                heard.lock().expect("heard").push_str(&String::from_utf8_lossy(&block[..n]));
            }
        });
        Self { child, said }
    }

    fn said(&self) -> String {
        self.said.lock().expect("heard").clone()
    }

    fn send(&self, signal: &str) {
        let sent = Command::new("kill").args([&format!("-{signal}"), &self.child.id().to_string()]).status();
        assert!(sent.expect("sent").success(), "it has ended before");
    }

    /// Waits for it for a minute at most.
    fn end(&mut self) -> ExitStatus {
        until("it ends", || self.child.try_wait().expect("asked").is_some());
        self.child.wait().expect("ended")
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // Of a test that has failed.
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

fn citylights() -> Command {
    Command::new(assert_cmd::cargo::cargo_bin("citylights"))
}

fn until(what: &str, is: impl FnMut() -> bool) -> Duration {
    let begun = Instant::now();
    let mut is = is;
    while !is() {
        assert!(begun.elapsed() < Duration::from_secs(60), "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(10));
    }
    begun.elapsed()
}

fn rows(out: &Path) -> usize {
    fs::read_to_string(out.join("runs.csv")).map_or(0, |text| text.lines().skip(1).count())
}

#[test]
fn nothing_that_a_peer_has_started_outlives_the_wish_to_stop() {
    let ground = Ground::new(1);
    let signals = ["INT", "TERM", "HUP"];
    for (at, (python, _)) in PYTHONS.iter().enumerate() {
        // Every way of starting, each with a signal of its own; the wrapper with all of them.
        let signals = if *python == "wrapper" { &signals[..] } else { &signals[at % 3..=at % 3] };
        for signal in signals {
            let out = format!("{python} {signal}");
            let mut running = ground.compare(python, &out, &[]);
            let expected = if *python == "plain" || *python == "group" { 1 } else { 2 };
            until("the peer has started", || ground.sleepers() >= expected);
            running.send(signal);
            assert_eq!(running.end().code(), Some(130), "{out}: {}", running.said());
            until(&format!("{out}: what the peer started ends"), || ground.sleepers() == 0);
            assert!(running.said().contains("the same command with --out"), "{}", running.said());
            assert_eq!(rows(&ground.path(&out)), 4, "{out}: two runs of two strategies were finished");
        }
    }
}

#[test]
fn nothing_that_a_peer_has_started_outlives_its_patience() {
    let ground = Ground::new(2);
    for (python, _) in PYTHONS {
        let mut running = ground.compare(python, &format!("{python} out"), &["--peer-patience", "1"]);
        until("the peer has started", || ground.sleepers() > 0);
        assert_eq!(running.end().code(), Some(0), "{}", running.said());
        assert!(running.said().contains("said nothing for 1 s and was stopped"), "{}", running.said());
        until(&format!("{python}: what it started ends"), || ground.sleepers() == 0);
    }
}

#[test]
fn a_signal_is_heard_while_a_scene_is_still_being_made() {
    let folder = tempfile::tempdir().expect("a folder");
    // Seconds of work, a minute on a busy machine, in which nothing looks up.
    let start = |name: &str| {
        let mut command = citylights();
        command.args(["compare", "scenes/megacity.toml", "--out"]).arg(folder.path().join(name));
        let running = Running::start(command.arg("--cache").arg(folder.path().join("cache")));
        until("it says what takes so long", || running.said().contains("megacity: being prepared"));
        running
    };
    let mut once = start("once");
    once.send("TERM");
    let took = until("it ends", || once.child.try_wait().expect("asked").is_some());
    assert_eq!(once.end().code(), Some(130), "{}", once.said());
    assert!(took < Duration::from_secs(20), "it took {took:?}");
    assert!(once.said().contains("stopping; what is finished is kept"), "{}", once.said());

    let mut twice = start("twice");
    twice.send("INT");
    until("the first is heard", || twice.said().contains("once more to stop at once"));
    twice.send("INT");
    let took = until("it ends", || twice.child.try_wait().expect("asked").is_some());
    assert_eq!(twice.end().code(), Some(130), "{}", twice.said());
    assert!(took < Duration::from_millis(2_500), "the second was not heard: {took:?}");
}

#[test]
fn a_hangup_that_was_switched_off_stays_off() {
    let ground = Ground::new(3);
    // As `nohup` does.
    let mut command = Command::new("sh");
    command.args(["-c", "trap '' HUP; exec \"$@\"", "sh"]).arg(assert_cmd::cargo::cargo_bin("citylights"));
    command.arg("compare").arg(ground.path("lamp.toml")).args(["-s", "null", "--budget", "1", "--repeats", "2"]);
    command.args(["--peer", "mitsuba", "--peer-python"]).arg(ground.path("wrapper")).arg("--out");
    command.arg(ground.path("out")).arg("--cache").arg(ground.path("cache")).env("SLEEP", &ground.sleep);
    let mut running = Running::start(&mut command);
    until("the peer has started", || ground.sleepers() >= 2);
    running.send("HUP");
    std::thread::sleep(Duration::from_millis(500));
    assert!(running.child.try_wait().expect("asked").is_none(), "it heard the hangup: {}", running.said());
    assert!(!running.said().contains("stopping"), "{}", running.said());
    running.send("TERM");
    assert_eq!(running.end().code(), Some(130), "{}", running.said());
    until("what the peer started ends", || ground.sleepers() == 0);
}

#[test]
fn rows_are_kept_at_term_as_at_ctrl_c() {
    let ground = Ground::new(4);
    let out = ground.path("out");
    let compare = |repeats: &str| {
        let mut command = citylights();
        command.arg("compare").arg(ground.path("lamp.toml")).args(["-s", "uniform,all", "--repeats", repeats]);
        command.args(["--threads", "1", "--out"]).arg(&out).arg("--cache").arg(ground.path("cache"));
        Running::start(&mut command)
    };
    for signal in ["TERM", "HUP"] {
        let mut running = compare("250");
        let before = rows(&out);
        until("rows come", || rows(&out) >= before + 5);
        running.send(signal);
        assert_eq!(running.end().code(), Some(130), "{}", running.said());
        assert!(rows(&out) >= before + 5 && running.said().contains("goes on from there"), "{}", running.said());
    }
    assert_eq!(compare("250").end().code(), Some(0));
}
