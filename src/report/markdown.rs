//! How does the text of a record stand in Markdown, whatever it is? As text: it begins no tag, no line and no code.

/// Words on one line, in which nothing begins a tag.
pub(super) fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut characters = text.chars().peekable();
    while let Some(c) = characters.next() {
        let is_tag = |next: &char| next.is_ascii_alphabetic() || "/!?".contains(*next);
        match c {
            '<' if characters.peek().is_some_and(is_tag) => plain.push_str("&lt;"),
            c if c.is_control() => plain.push(' '),
            c => plain.push(c),
        }
    }
    plain
}

/// Words in a cell of a table.
pub(super) fn cell(text: &str) -> String {
    plain(text).replace('|', "\\|")
}

/// A name between marks of code, on one line.
pub(super) fn code(text: &str) -> String {
    let line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    match longest_run(&line) {
        0 => format!("`{line}`"),
        // More marks than there are within, and blanks, which are not shown.
        run => format!("{0} {line} {0}", "`".repeat(run + 1)),
    }
}

/// A block of code.
pub(super) fn block(text: &str) -> String {
    let fence = "`".repeat(longest_run(text).max(2) + 1);
    format!("{fence}\n{text}\n{fence}")
}

/// What stands for a picture, or is the text of a link.
pub(super) fn label(text: &str) -> String {
    plain(text).replace('[', "\\[").replace(']', "\\]")
}

/// A name within a comment, which does not end there.
pub(super) fn comment(text: &str) -> String {
    plain(text).replace("-->", "--&gt;")
}

/// The most marks of code side by side.
fn longest_run(text: &str) -> usize {
    text.split(|c| c != '`').map(str::len).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_says_nothing_in_markdown_stays() {
        for text in ["t* > the longest time, a < b, 3 <4", "`power:mix=1`: b² | c", "a--b", "~0.367 ±9 %"] {
            assert_eq!(plain(text), text);
        }
        assert_eq!(code("power:mix=0.5"), "`power:mix=0.5`");
        assert_eq!(block("citylights compare a.toml"), "```\ncitylights compare a.toml\n```");
    }

    #[test]
    fn nothing_ends_what_it_stands_in() {
        assert_eq!(plain("<script>x</script>\n# y <!-- <?"), "&lt;script>x&lt;/script> # y &lt;!-- &lt;?");
        assert_eq!(cell("a|<b>"), "a\\|&lt;b>");
        assert_eq!(code("a`<b>``\n"), "``` a`<b>``  ```");
        assert_eq!(block("```\n<b>"), "````\n```\n<b>\n````");
        assert_eq!(label("](javascript:x)"), "\\](javascript:x)");
        assert_eq!(comment("--><b>"), "--&gt;&lt;b>");
    }
}
