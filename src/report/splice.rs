//! Sections of a hand-written page that the tool keeps current.
//!
//! A section lies between `<!-- citylights:begin NAME -->` and `<!-- citylights:end NAME -->`, each on a line of its
//! own; everything outside belongs to people and is not touched.

use crate::base::error::{Error, Result};
use crate::base::file::write_whole;
use std::io::ErrorKind;
use std::path::Path;

/// Puts `body` into section `name` of the Markdown file `page`; a missing section is appended, a missing file is made.
///
/// # Errors
/// A page that cannot be read or written; a section that has one end, stands there twice or ends before it begins, with
/// its line.
pub(crate) fn splice(page: &Path, name: &str, body: &str) -> Result<()> {
    let text = match std::fs::read_to_string(page) {
        Err(e) if e.kind() == ErrorKind::NotFound => String::new(),
        read => read.map_err(Error::io("read", page))?,
    };
    let new = spliced(page, &text, name, body)?;
    if new == text { Ok(()) } else { write_whole(page, new.as_bytes()) }
}

/// Whether section `name` of the Markdown file `page` says `body`.
///
/// # Errors
/// A page that cannot be read; a section that has one end, stands there twice or ends before it begins, with its line.
pub(crate) fn is_current(page: &Path, name: &str, body: &str) -> Result<bool> {
    let text = std::fs::read_to_string(page).map_err(Error::io("read", page))?;
    Ok(spliced(page, &text, name, body)? == text)
}

/// `text` with `body` in section `name`; `page` is for errors.
fn spliced(page: &Path, text: &str, name: &str, body: &str) -> Result<String> {
    let (begin, end) = (format!("<!-- citylights:begin {name} -->"), format!("<!-- citylights:end {name} -->"));
    let section = format!("{begin}\n\n{}\n\n{end}", body.trim());
    let found = |mark: &str| text.match_indices(mark).map(|(at, _)| at).collect::<Vec<_>>();
    let wrong = |at: usize, message: String| Error::Input {
        file: page.to_owned(),
        line: Some(text[..at].matches('\n').count() + 1),
        field: String::new(),
        message,
    };
    match (&found(&begin)[..], &found(&end)[..]) {
        ([], []) => {
            let gap = match text {
                "" => "",
                _ if text.ends_with("\n\n") => "",
                _ if text.ends_with('\n') => "\n",
                _ => "\n\n",
            };
            Ok(format!("{text}{gap}{section}\n"))
        }
        (&[from], &[to]) if from < to => Ok(format!("{}{section}{}", &text[..from], &text[to + end.len()..])),
        (&[from], &[]) => Err(wrong(from, format!("this section has no `{end}`"))),
        (&[], &[to, ..]) => Err(wrong(to, format!("this section has no `{begin}`"))),
        (&[from], &[to]) => Err(wrong(from.max(to), format!("section `{name}` ends before it begins"))),
        (&[_, again, ..], _) | (_, &[_, again, ..]) => Err(wrong(again, format!("section `{name}` stands here twice"))),
    }
}
