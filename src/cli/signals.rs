//! What asks the program to stop?

use std::io;
use std::sync::mpsc;

/// Hears each wish to stop: Ctrl-C, and where there are such signals TERM, QUIT and HUP.
///
/// A HUP that was switched off before the program began (`nohup`) stays off.
///
/// # Errors
/// What the system says where it cannot be heard.
#[cfg(unix)]
pub(super) fn wishes() -> io::Result<mpsc::Receiver<()>> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    use signal_hook::iterator::Signals;

    let heard =
        [SIGINT, SIGTERM, SIGQUIT, SIGHUP].into_iter().filter(|&signal| signal != SIGHUP || !is_ignored(signal));
    let mut signals = Signals::new(heard)?;
    let (send, receive) = mpsc::channel();
    std::thread::spawn(move || signals.forever().try_for_each(|_| send.send(())));
    Ok(receive)
}

/// The same.
///
/// # Errors
/// What the system says where it cannot be heard.
#[cfg(not(unix))]
pub(super) fn wishes() -> io::Result<mpsc::Receiver<()>> {
    let (send, receive) = mpsc::channel();
    // Nobody listens any more at the program's end.
    ctrlc::set_handler(move || _ = send.send(())).map_err(io::Error::other)?;
    Ok(receive)
}

/// Whether this process ignores a signal, as far as the system tells (Linux).
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask >> (signal - 1) & 1 == 1
}
