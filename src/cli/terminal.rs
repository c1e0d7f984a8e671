//! What is said to the user?
//!
//! All that is said goes through here: text of files, whatever they are, moves no cursor and turns no colour on.

use crate::report::{USUAL_COLUMNS, broken};
use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{IsTerminal, Write};

/// Tells the user something on stderr; one that has been closed is no error.
pub(super) fn say(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{}", plain(text));
}

/// Prints to stdout; a reader that has gone away (`| head`) is no error.
pub(super) fn print(text: &str) -> anyhow::Result<()> {
    match std::io::stdout().lock().write_all(plain(text).as_bytes()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(e.into()),
        _ => Ok(()),
    }
}

/// Columns that a table may have: those of the terminal that stdout is, if there are fewer than usual.
pub(super) fn width() -> usize {
    let stdout = std::io::stdout();
    let size = terminal_size::terminal_size_of(&stdout).filter(|_| stdout.is_terminal());
    let columns = size.map_or(USUAL_COLUMNS, |(terminal_size::Width(columns), _)| usize::from(columns));
    // A terminal that does not know says 0.
    if columns == 0 { USUAL_COLUMNS } else { columns.clamp(NARROWEST, USUAL_COLUMNS) }
}

/// A line of parts; those that the terminal has no room for go on below, further in, and words of a part that is wider
/// than that below one another.
pub(super) fn side_by_side(parts: &[String]) -> String {
    within(parts, width())
}

/// The same in so many columns.
fn within(parts: &[String], width: usize) -> String {
    const INDENT: &str = "      ";
    let columns = |text: &str| text.trim_end().chars().count();
    let mut lines: Vec<String> = Vec::new();
    for part in parts {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + columns(part) <= width => {
                line.push(' ');
                line.push_str(part);
            }
            None if columns(part) <= width => lines.push(part.to_owned()),
            _ => lines.extend(broken(part.trim(), width - INDENT.len()).iter().map(|l| format!("{INDENT}{l}"))),
        }
    }
    lines.iter().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// Fewer columns hold no table.
const NARROWEST: usize = 20;

/// The text with what would command a terminal, or turn the direction of letters, written out: `\u001b`, as JSON has
/// it. Line breaks and tabs stay.
pub(super) fn plain(text: &str) -> Cow<'_, str> {
    let commands = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
    let turns = |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let unfit = |c: char| commands(c) || turns(c);
    if !text.contains(unfit) {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if unfit(c) {
            _ = write!(plain, "\\u{:04x}", u32::from(c));
        } else {
            plain.push(c);
        }
    }
    Cow::Owned(plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_that_find_no_room_go_on_below() {
        let parts = ["  name      1.0", "  2.0  ", "what it is, in words"].map(str::to_owned);
        assert_eq!(within(&parts, 80), "  name      1.0   2.0   what it is, in words\n");
        assert_eq!(within(&parts, 30), "  name      1.0   2.0\n      what it is, in words\n");
        assert_eq!(within(&parts, 20), "  name      1.0\n      2.0\n      what it is, in\n        words\n");
    }

    #[test]
    fn whatever_commands_a_terminal_is_written_out() {
        for code in (0..0x20).chain(0x7f..0xa0).chain([0x200e, 0x200f, 0x2028, 0x202e, 0x2066]) {
            let c = char::from_u32(code).expect("a character");
            let expected = if c == '\n' || c == '\t' { format!("a{c}b") } else { format!("a\\u{code:04x}b") };
            assert_eq!(plain(&format!("a{c}b")), expected);
        }
        let kept = "Zürich 100 % ± 5, b² ▲ 夜\n\ttwo";
        assert!(matches!(plain(kept), Cow::Borrowed(text) if text == kept));
        // JSON stays JSON.
        let json = plain("\"\u{7f}\u{9b}\"").into_owned();
        assert_eq!(serde_json::from_str::<String>(&json).expect("JSON"), "\u{7f}\u{9b}");
    }
}
