//! `light-tree:arity={2,4,8}`, `visible:cut={64..1024*2}`: one text for a strategy at several values of a parameter.
//!
//! Braces hold a list, or a range from its first to its last value: by steps of 1, of `+STEP` or by a factor `*FACTOR`.
//! Several of them give every combination.

use crate::base::error::{Error, Result};

/// Most strategies that one text may stand for.
const MOST: usize = 64;

/// A strategy's text with values in place of all braces, and the names of the parameters that had them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Swept {
    pub(super) text: String,
    pub(super) varied: Vec<String>,
}

/// The parts of a list, at commas and blanks outside braces.
pub(super) fn parts(list: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut depth = 0;
    for c in list.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        match parts.last_mut() {
            Some(last) if depth > 0 || !(c == ',' || c == ' ') => last.push(c),
            _ => parts.push(String::new()),
        }
    }
    parts.retain(|part| !part.is_empty());
    parts
}

/// All strategies that a text stands for: itself, where it has no braces.
pub(super) fn expand(text: &str) -> Result<Vec<Swept>> {
    let mut all = vec![Swept { text: String::new(), varied: Vec::new() }];
    let mut rest = text;
    while let Some(open) = rest.find('{') {
        let (before, after) = rest.split_at(open);
        let wrong = |what: &str| Err(Error::Invalid(format!("`{text}`: {what}")));
        let Some(close) = after.find('}') else { return wrong("a `{` has no `}`") };
        let Some(parameter) = before.strip_suffix('=').map(|b| b.rsplit([':', ',', ';']).next().unwrap_or(b)) else {
            return wrong("braces stand for a parameter's value, as in `light-tree:arity={2,4,8}`");
        };
        if after[1..close].trim().is_empty() {
            return wrong("`{}` holds no values; name some, as in `light-tree:arity={2,4,8}`");
        }
        if after[1..close].contains('{') {
            return wrong("braces do not stand within braces");
        }
        if before.matches(':').count() > 1 {
            return wrong(
                "a sweep is of a strategy's own parameters; sweep whole ones, as `from={power:picks=1,power:picks=2}`",
            );
        }
        let values = values(text, &after[1..close])?;
        if all.len() * values.len() > MOST {
            return wrong(&format!("stands for more than {MOST} strategies"));
        }
        let with = |swept: &Swept, value: &String| Swept {
            text: format!("{}{before}{value}", swept.text),
            varied: swept.varied.iter().cloned().chain([parameter.to_owned()]).collect(),
        };
        all = all.iter().flat_map(|swept| values.iter().map(move |value| with(swept, value))).collect();
        rest = &after[close + 1..];
    }
    if rest.contains('}') {
        return Err(Error::Invalid(format!("`{text}`: a `}}` has no `{{`")));
    }
    all.iter_mut().for_each(|swept| swept.text.push_str(rest));
    Ok(all)
}

fn values(text: &str, braces: &str) -> Result<Vec<String>> {
    let Some((first, rest)) = braces.split_once("..") else {
        let values: Vec<String> = braces.split(',').map(|value| value.trim().to_owned()).collect();
        if values.iter().any(String::is_empty) {
            return Err(Error::Invalid(format!("`{text}`: `{{{braces}}}` has an empty value")));
        }
        return Ok(values);
    };
    let at = rest.find(['*', '+']);
    let (last, step) = at.map_or((rest, "+1"), |at| rest.split_at(at));
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    let (Some(first), Some(last), Some(by)) = (number(first), number(last), number(&step[1..])) else {
        let right = "a range is FIRST..LAST, FIRST..LAST+STEP or FIRST..LAST*FACTOR";
        return Err(Error::Invalid(format!("`{text}`: `{{{braces}}}` is no range: {right}")));
    };
    let times = step.starts_with('*');
    if (times && (by <= 1.0 || first <= 0.0)) || (!times && by <= 0.0) || last < first {
        let right = "it must rise: a step above 0, or a factor above 1 from a first value above 0";
        return Err(Error::Invalid(format!("`{text}`: `{{{braces}}}` comes to no end: {right}")));
    }
    // By their number, so that no rounding adds up; a last one that rounding put just beyond the end belongs to it.
    let value = |i: u32| if times { first * by.powi(i as i32) } else { first + by * f64::from(i) };
    let end = if times { last * (1.0 + 1e-9 * (by - 1.0)) } else { last + 1e-9 * by };
    let within = |value: &f64| *value <= end;
    let all: Vec<String> = (0..).map(value).take_while(within).take(MOST + 1).map(shown).collect();
    Ok(all)
}

/// A number without what rounding left in its last digits.
fn shown(value: f64) -> String {
    let rounded: f64 = format!("{value:.12e}").parse().unwrap_or(value);
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<String> {
        expand(text).expect(text).into_iter().map(|swept| swept.text).collect()
    }

    #[test]
    fn lists_and_ranges_stand_for_their_values() {
        assert_eq!(
            texts("light-tree:arity={2,4,8}"),
            ["light-tree:arity=2", "light-tree:arity=4", "light-tree:arity=8"]
        );
        assert_eq!(
            texts("visible:cut={64..256*2},picks=2"),
            ["64", "128", "256"].map(|n| format!("visible:cut={n},picks=2"))
        );
        assert_eq!(texts("power:mix={0..0.3+0.1}"), ["0", "0.1", "0.2", "0.3"].map(|n| format!("power:mix={n}")));
        assert_eq!(texts("power:picks={1..3}"), ["1", "2", "3"].map(|n| format!("power:picks={n}")));
        let both = expand("power:picks={1,2},mix={0,1}").expect("both");
        assert_eq!(both.len(), 4);
        assert_eq!(both[1], Swept { text: "power:picks=1,mix=1".into(), varied: vec!["picks".into(), "mix".into()] });
        assert_eq!(texts("power:mix={-0.2..0+0.1}"), ["-0.2", "-0.1", "0"].map(|n| format!("power:mix={n}")));
        assert_eq!(texts("resampled:from={power:picks=2,uniform}").len(), 2);
        assert_eq!(texts("power"), ["power"]);
        assert_eq!(parts("power:mix={0,1},picks=2 uniform"), ["power:mix={0,1}", "picks=2", "uniform"]);
    }

    #[test]
    fn what_is_no_sweep_is_refused_with_what_would_be_right() {
        let message = |text: &str| expand(text).err().map(|e| e.to_string()).unwrap_or_default();
        for (text, right) in [
            ("power:mix={0,1", "has no `}`"),
            ("power:mix=0}", "has no `{`"),
            ("power{1,2}", "a parameter's value"),
            ("power:mix={0,,1}", "empty value"),
            ("power:mix={}", "holds no values"),
            ("power:mix={a..b}", "FIRST..LAST"),
            ("power:picks={4..1}", "must rise"),
            ("power:picks={0..8*2}", "must rise"),
            ("power:picks={1..8*1}", "must rise"),
            ("power:picks={1..1000}", "more than 64"),
            ("power:picks={{1,2}}", "within braces"),
            ("resampled:from=power:picks={1,2}", "own parameters"),
        ] {
            assert!(message(text).contains(right), "{text}: {}", message(text));
        }
    }
}
