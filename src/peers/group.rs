//! A process and all that it starts: ended together, whoever wraps whom.
//!
//! Each leads a process group of its own. Where the system tells (Linux), what has left the group is ended too: `timeout`
//! makes a group for what it runs.

use std::io;
use std::process::{Child, ChildStderr, ChildStdout, Command, ExitStatus};
use std::sync::Mutex;
#[cfg(feature = "cli")]
use std::time::Duration;

/// The leaders of all groups that run.
static RUNNING: Mutex<Vec<u32>> = Mutex::new(Vec::new());

/// A group that does not outlive this.
pub(super) struct Group(Child);

impl Group {
    /// Starts a command as the leader of a group.
    pub(super) fn start(command: &mut Command) -> io::Result<Self> {
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(command, 0);
        // Held until the number is noted: whoever ends all groups meanwhile ends this one, too.
        let mut running = RUNNING.lock().map_err(|_| io::Error::other("a thread died while it started a process"))?;
        let child = command.spawn()?;
        running.push(child.id());
        Ok(Self(child))
    }

    /// What the leader prints.
    pub(super) fn stdout(&mut self) -> Option<ChildStdout> {
        self.0.stdout.take()
    }

    /// What the leader complains about.
    pub(super) fn stderr(&mut self) -> Option<ChildStderr> {
        self.0.stderr.take()
    }

    /// Whether the leader has ended, of itself or not.
    pub(super) fn has_ended(&mut self) -> io::Result<bool> {
        #[cfg(unix)]
        {
            use rustix::process::{WaitId, WaitIdOptions, waitid};
            // Left unreaped: its number, which is the group's, can be nobody else's until the group has been ended.
            let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
            let leader = pid(self.0.id()).ok_or_else(|| io::Error::other("a process has no number"))?;
            Ok(waitid(WaitId::Pid(leader), options)?.is_some())
        }
        #[cfg(not(unix))]
        Ok(self.0.try_wait()?.is_some())
    }

    /// Ends the group; gives how its leader ended.
    pub(super) fn end(&mut self) -> io::Result<ExitStatus> {
        let mut running = RUNNING.lock();
        end(self.0.id());
        // It fails only for a process that has ended already.
        let _ = self.0.kill();
        let status = self.0.wait();
        if let Ok(running) = &mut running {
            running.retain(|leader| *leader != self.0.id());
        }
        status
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        let is_running = RUNNING.lock().is_ok_and(|running| running.contains(&self.0.id()));
        if is_running {
            // Nobody is left to be told.
            let _ = self.end();
        }
    }
}

/// Ends all groups: before the process ends itself, which drops nothing.
#[cfg(feature = "cli")]
pub(crate) fn end_all() {
    for _ in 0..TRIES {
        if let Ok(running) = RUNNING.try_lock() {
            return running.iter().for_each(|&leader| end(leader));
        }
        // One is just being started or ended, which takes no time unless the system hangs.
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// How often it is tried to look at what runs.
#[cfg(feature = "cli")]
const TRIES: u32 = 100;

#[cfg(unix)]
fn pid(number: u32) -> Option<rustix::process::Pid> {
    rustix::process::Pid::from_raw(i32::try_from(number).ok()?)
}

/// Ends a group and what its members have started, wherever that went.
#[cfg(unix)]
fn end(leader: u32) {
    use rustix::process::{Signal, kill_process, kill_process_group};
    let signal = |number: u32, signal| _ = pid(number).map(|pid| kill_process(pid, signal));
    let mut stopped: Vec<u32> = Vec::new();
    // What is stopped starts nothing more, and stays its parent's child: a few rounds find all.
    for _ in 0..ROUNDS {
        let found: Vec<u32> = descendants(leader).into_iter().filter(|number| !stopped.contains(number)).collect();
        if found.is_empty() {
            break;
        }
        found.iter().for_each(|&number| signal(number, Signal::STOP));
        stopped.extend(found);
    }
    // Each of these fails only where all have ended already.
    _ = pid(leader).map(|leader| kill_process_group(leader, Signal::KILL));
    stopped.into_iter().for_each(|number| signal(number, Signal::KILL));
}

#[cfg(not(unix))]
fn end(_leader: u32) {}

/// Most rounds of looking for processes that were just started.
#[cfg(unix)]
const ROUNDS: u32 = 16;

/// All that a process has started, and they in turn, as far as the system tells.
#[cfg(unix)]
fn descendants(of: u32) -> Vec<u32> {
    let Ok(entries) = std::fs::read_dir("/proc") else { return Vec::new() };
    let number = |entry: io::Result<std::fs::DirEntry>| entry.ok()?.file_name().to_str()?.parse().ok();
    let all: Vec<(u32, u32)> = entries.filter_map(number).filter_map(|one| Some((one, parent(one)?))).collect();
    let mut found = vec![of];
    let mut next = 0;
    while let Some(&parent) = found.get(next) {
        let children = all.iter().filter(|(child, its)| *its == parent && !found.contains(child));
        let children: Vec<u32> = children.map(|(child, _)| *child).collect();
        found.extend(children);
        next += 1;
    }
    found.split_off(1)
}

/// The parent of a process; its name, in brackets, may hold anything.
#[cfg(unix)]
fn parent(of: u32) -> Option<u32> {
    let status = std::fs::read_to_string(format!("/proc/{of}/stat")).ok()?;
    status.rsplit_once(')')?.1.split_whitespace().nth(1)?.parse().ok()
}
