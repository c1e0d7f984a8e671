//! Running a peer's script and listening to it.
//!
//! The script prints one JSON object a line: what it is (`about`), that its renderer is not installed (`missing`), and
//! each finished image (`image`). It is ended, with all that it has started, when the user stops the comparison, and when
//! it has said nothing for too long.

use super::group::Group;
use crate::base::error::Error;
use crate::measure::observer::Observer;
use serde::Deserialize;
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// One call of a script.
pub(super) struct Call<'a> {
    /// The interpreter.
    pub(super) python: &'a Path,
    /// The script.
    pub(super) script: &'a Path,
    /// The exported scene.
    pub(super) scene: &'a Path,
    /// Where images go.
    pub(super) out: &'a Path,
    /// Sample counts, ascending.
    pub(super) spp: &'a [u32],
    /// One for each run; of none, the script only says what it is.
    pub(super) seeds: &'a [u32],
    /// What the peer's parameters add.
    pub(super) arguments: &'a [String],
    /// How long it may say nothing.
    pub(super) patience: Duration,
}

/// What a script says: a line.
#[derive(Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub(super) enum Line {
    /// First: which renderer this is.
    About {
        /// Name and version.
        renderer: String,
        /// What a reader of the figures must know.
        remarks: Vec<String>,
    },
    /// The renderer is not installed; the last line.
    Missing {
        /// What Python said.
        why: String,
    },
    /// An image is finished.
    Image(Image),
}

/// A finished image.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Image {
    /// Its seed.
    pub(super) seed: u32,
    /// Its samples per pixel.
    pub(super) spp: u32,
    /// CPU seconds before the first sample.
    pub(super) setup_s: f64,
    /// CPU seconds of sampling, on one thread.
    pub(super) cpu_s: f64,
    /// Wall seconds of the same.
    pub(super) wall_s: f64,
    /// The EXR file, in the folder for images.
    pub(super) file: String,
}

/// Why there are no figures.
pub(super) enum Trouble {
    /// The renderer or Python itself is not there.
    Missing(String),
    /// It is there and did not do what it should.
    Failed(String),
    /// The comparison itself must end.
    Stop(Error),
}

impl From<Error> for Trouble {
    fn from(error: Error) -> Self {
        Self::Stop(error)
    }
}

/// Most bytes that a script may say, and most of its complaints that are kept.
const MOST_SAID: u64 = 1 << 24;
const MOST_KEPT: usize = 1 << 12;

/// How long what a script said may be on its way after its end.
const LAST_WORDS: Duration = Duration::from_secs(2);

/// How often the user's wish to stop is looked at.
const BEAT: Duration = Duration::from_millis(50);

/// Runs a script to its end; `each` hears every line.
pub(super) fn run(
    call: &Call<'_>,
    watch: &dyn Observer,
    mut each: impl FnMut(Line) -> Result<(), Trouble>,
) -> Result<(), Trouble> {
    let mut running = Group::start(&mut command(call)).map_err(|error| no_python(call.python, &error))?;
    let complaints = complaints(&mut running);
    let lines = lines(&mut running);
    let mut heard = Instant::now();
    let failed = |why: String| Trouble::Failed(format!("{why}{}", last_line(&complaints)));
    let mut has_ended = false;
    loop {
        watch.check()?;
        let text = match (lines.recv_timeout(BEAT), has_ended) {
            (Ok(text), _) => text,
            (Err(RecvTimeoutError::Disconnected), true) => break,
            // One that has ended may leave a child of its own that holds the pipe open.
            (Err(RecvTimeoutError::Timeout), true) if heard.elapsed() > LAST_WORDS => break,
            (Err(_), false) if heard.elapsed() > call.patience => {
                let seconds = call.patience.as_secs_f64();
                return Err(failed(format!("said nothing for {seconds} s and was stopped")));
            }
            (Err(end), false) => {
                has_ended = running.has_ended().map_err(|error| failed(error.to_string()))?;
                if has_ended {
                    heard = Instant::now();
                } else if end == RecvTimeoutError::Disconnected {
                    std::thread::sleep(BEAT);
                }
                continue;
            }
            (Err(_), true) => continue,
        };
        heard = Instant::now();
        let line = serde_json::from_str(&text).map_err(|error| {
            let start: String = text.chars().take(60).collect();
            failed(format!("its script said `{start}`, which is no line of the contract ({error})"))
        })?;
        each(line)?;
    }
    let status = running.end().map_err(|error| failed(error.to_string()))?;
    if status.success() { Ok(()) } else { Err(failed(ended(status))) }
}

fn command(call: &Call<'_>) -> Command {
    let list = |numbers: &[u32]| numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(",");
    let mut command = Command::new(call.python);
    command.arg(call.script).arg(call.scene).arg("--out").arg(call.out);
    command.args(["--spp", &list(call.spp), "--seeds", &list(call.seeds)]).args(call.arguments);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn no_python(python: &Path, error: &std::io::Error) -> Trouble {
    let python = python.display();
    match error.kind() {
        ErrorKind::NotFound => Trouble::Missing(format!("there is no Python `{python}`")),
        _ => Trouble::Missing(format!("cannot start Python `{python}`: {error}")),
    }
}

fn ended(status: ExitStatus) -> String {
    match status.code() {
        Some(code) => format!("its script ended with exit code {code}"),
        None => format!("its script was ended: {status}"),
    }
}

/// What a process prints, line by line.
fn lines(process: &mut Group) -> mpsc::Receiver<String> {
    let (send, receive) = mpsc::channel();
    if let Some(stdout) = process.stdout() {
        std::thread::spawn(move || {
            let lines = BufReader::new(stdout.take(MOST_SAID)).split(b'\n').map_while(std::io::Result::ok);
            // Ends when nobody listens any more.
            let _ = lines.map(|line| String::from_utf8_lossy(&line).into_owned()).try_for_each(|line| send.send(line));
        });
    }
    receive
}

/// The end of what a process complains about, kept up to date.
fn complaints(process: &mut Group) -> Arc<Mutex<Vec<u8>>> {
    let kept = Arc::new(Mutex::new(Vec::new()));
    if let Some(mut stderr) = process.stderr() {
        let kept = Arc::clone(&kept);
        std::thread::spawn(move || {
            let mut block = [0; 1024];
            while let Ok(n @ 1..) = stderr.read(&mut block) {
                let Ok(mut kept) = kept.lock() else { return };
                kept.extend_from_slice(&block[..n]);
                let old = kept.len().saturating_sub(MOST_KEPT);
                kept.drain(..old);
            }
        });
    }
    kept
}

/// The last line of the complaints, to be put after what went wrong; empty where there are none.
fn last_line(complaints: &Mutex<Vec<u8>>) -> String {
    // The reader may be a moment behind a process that has just ended.
    std::thread::sleep(BEAT);
    let Ok(kept) = complaints.lock() else { return String::new() };
    let text = String::from_utf8_lossy(&kept);
    text.lines().rfind(|line| !line.trim().is_empty()).map_or_else(String::new, |line| format!(": {}", line.trim()))
}
