//! What does the file say, and where?
//!
//! A [`Table`] reads fields by name with their type, range and unit; a mistake becomes an error with line and path.

use crate::base::error::{Error, Result};
use crate::base::names;
use crate::sources::city::{self, Fields, Plan, count_wanted, number_wanted, span_wanted};
use glam::{DVec2, DVec3};
use std::ops::RangeInclusive;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A recipe's text and name.
pub(super) struct Source<'a> {
    file: &'a Path,
    text: &'a str,
}

impl<'a> Source<'a> {
    pub(super) fn new(file: &'a Path, text: &'a str) -> Self {
        Self { file, text }
    }

    /// The parsed document; a mistake of syntax is an error with its line.
    pub(super) fn document(&self) -> Result<DeTable<'a>> {
        let parsed = DeTable::parse(self.text);
        parsed.map(Spanned::into_inner).map_err(|error| {
            let at = error.span().map(|span| span.start);
            self.error(at, "", format!("is not TOML: {}", error.message()))
        })
    }

    /// An error at a byte of the text.
    pub(super) fn error(&self, at: Option<usize>, field: &str, message: impl Into<String>) -> Error {
        let before = at.map(|at| &self.text.as_bytes()[..at.min(self.text.len())]);
        Error::Input {
            file: self.file.to_owned(),
            line: before.map(|bytes| 1 + bytes.iter().filter(|&&b| b == b'\n').count()),
            field: field.into(),
            message: message.into(),
        }
    }
}

/// A table of the document, with its path and place.
pub(super) struct Table<'a> {
    source: &'a Source<'a>,
    entries: &'a DeTable<'a>,
    path: String,
    at: Option<usize>,
}

impl<'a> Table<'a> {
    /// The document itself.
    pub(super) fn top(source: &'a Source<'a>, document: &'a DeTable<'a>) -> Self {
        Self { source, entries: document, path: String::new(), at: None }
    }

    fn get(&self, name: &str) -> Option<&'a Spanned<DeValue<'a>>> {
        self.entries.iter().find(|(key, _)| key.get_ref() == name).map(|(_, value)| value)
    }

    fn path_of(&self, name: &str) -> String {
        if self.path.is_empty() { name.into() } else { format!("{}.{name}", self.path) }
    }

    /// The names of this table's entries.
    pub(super) fn keys(&self) -> impl Iterator<Item = &'a str> {
        self.entries.keys().map(|key| key.get_ref().as_ref())
    }

    /// An error about a field, at its line if it is there and at the table's if not.
    pub(super) fn wrong(&self, name: &str, message: impl Into<String>) -> Error {
        let at = self.get(name).map(|value| value.span().start).or(self.at);
        self.source.error(at, &self.path_of(name), message)
    }

    /// An error about a field with a path that starts at this table's own name, `city.lamps.spacing`.
    pub(super) fn at_path(&self, path: &str, message: String) -> Error {
        let (mut entries, mut at) = (self.entries, self.at);
        for name in path.split('.').skip(1) {
            let Some((_, value)) = entries.iter().find(|(key, _)| key.get_ref() == name) else { break };
            at = Some(value.span().start);
            let DeValue::Table(inner) = value.get_ref() else { break };
            entries = inner;
        }
        self.source.error(at, path, message)
    }

    /// Refuses all names but these.
    pub(super) fn only(&self, known: &[&str]) -> Result<()> {
        let Some(key) = self.entries.keys().find(|key| !known.contains(&key.get_ref().as_ref())) else { return Ok(()) };
        let message = format!("unknown field{}", names::hint(key.get_ref(), known.iter().copied()));
        Err(self.source.error(Some(key.span().start), &self.path_of(key.get_ref()), message))
    }

    pub(super) fn missing(&self, name: &str, what: &str) -> Error {
        self.source.error(self.at, &self.path_of(name), format!("is missing; {what} is asked for"))
    }

    /// A table within this one.
    pub(super) fn table(&self, name: &str) -> Result<Option<Self>> {
        let Some(value) = self.get(name) else { return Ok(None) };
        let DeValue::Table(entries) = value.get_ref() else {
            return Err(self.wrong(name, format!("{} is given; a table [{name}] is asked for", given(value.get_ref()))));
        };
        Ok(Some(self.inner(self.path_of(name), entries, value)))
    }

    fn inner(&self, path: String, entries: &'a DeTable<'a>, value: &Spanned<DeValue>) -> Self {
        Self { source: self.source, entries, path, at: Some(value.span().start) }
    }

    /// A table that must be there.
    pub(super) fn needed_table(&self, name: &str) -> Result<Self> {
        self.table(name)?.ok_or_else(|| self.missing(name, &format!("a table [{name}]")))
    }

    /// The tables `[[name]]`, in order; their paths count from 0.
    pub(super) fn tables(&self, name: &str) -> Result<Vec<Self>> {
        let Some(value) = self.get(name) else { return Ok(Vec::new()) };
        let wanted = || format!("{} is given; tables [[{name}]] are asked for", given(value.get_ref()));
        let DeValue::Array(items) = value.get_ref() else { return Err(self.wrong(name, wanted())) };
        let table = |(i, item): (usize, &'a Spanned<DeValue<'a>>)| match item.get_ref() {
            DeValue::Table(entries) => Ok(self.inner(format!("{}[{i}]", self.path_of(name)), entries, item)),
            _ => Err(self.wrong(name, wanted())),
        };
        items.iter().enumerate().map(table).collect()
    }

    /// A number within a range.
    pub(super) fn number(&self, name: &str, allowed: RangeInclusive<f64>, unit: &str) -> Result<Option<f64>> {
        let Some(value) = self.get(name) else { return Ok(None) };
        let number = number(value.get_ref()).filter(|number| allowed.contains(number));
        let refuse =
            || self.wrong(name, format!("{} is given; {}", given(value.get_ref()), number_wanted(&allowed, unit)));
        number.map(Some).ok_or_else(refuse)
    }

    /// A number that must be there.
    pub(super) fn needed_number(&self, name: &str, allowed: RangeInclusive<f64>, unit: &str) -> Result<f64> {
        self.number(name, allowed.clone(), unit)?.ok_or_else(|| self.missing(name, &number_asked(&allowed, unit)))
    }

    /// A whole number within a range; one written with a fraction of 0 or an exponent counts.
    pub(super) fn count(&self, name: &str, allowed: RangeInclusive<u64>) -> Result<Option<u64>> {
        let Some(value) = self.get(name) else { return Ok(None) };
        let count = match value.get_ref() {
            DeValue::Integer(integer) => u64::from_str_radix(integer.as_str(), integer.radix()).ok(),
            other => number(other).filter(|x| x.fract() == 0.0 && (0.0..=9e15).contains(x)).map(|x| x as u64),
        };
        let refuse = || self.wrong(name, format!("{} is given; {}", given(value.get_ref()), count_wanted(&allowed)));
        count.filter(|count| allowed.contains(count)).map(Some).ok_or_else(refuse)
    }

    /// A whole number that must be there.
    pub(super) fn needed_count(&self, name: &str, allowed: RangeInclusive<u64>) -> Result<u64> {
        self.count(name, allowed)?.ok_or_else(|| self.missing(name, "a whole number"))
    }

    /// `N` numbers within a range.
    fn numbers<const N: usize>(
        &self,
        name: &str,
        allowed: &RangeInclusive<f64>,
        unit: &str,
    ) -> Result<Option<[f64; N]>> {
        let Some(value) = self.get(name) else { return Ok(None) };
        let refuse = || self.wrong(name, not_numbers::<N>(value.get_ref(), allowed, unit));
        list::<N>(value.get_ref(), allowed).map(Some).ok_or_else(refuse)
    }

    /// Two numbers within a range.
    pub(super) fn pair(&self, name: &str, allowed: RangeInclusive<f64>, unit: &str) -> Result<Option<DVec2>> {
        Ok(self.numbers::<2>(name, &allowed, unit)?.map(DVec2::from))
    }

    /// Two numbers that must be there.
    pub(super) fn needed_pair(&self, name: &str, allowed: RangeInclusive<f64>, unit: &str) -> Result<DVec2> {
        self.pair(name, allowed, unit)?.ok_or_else(|| self.missing(name, &format!("[x, y] in {unit}")))
    }

    /// A position in m, each coordinate at most `limit`.
    pub(super) fn vector(&self, name: &str, limit: f64) -> Result<Option<DVec3>> {
        Ok(self.numbers::<3>(name, &(-limit..=limit), "metres")?.map(DVec3::from))
    }

    /// A position that must be there.
    pub(super) fn needed_vector(&self, name: &str, limit: f64) -> Result<DVec3> {
        self.vector(name, limit)?.ok_or_else(|| self.missing(name, "[x, y, z] in metres"))
    }

    /// Three numbers, red, green and blue.
    pub(super) fn colour(&self, name: &str, most: f64) -> Result<Option<DVec3>> {
        Ok(self.numbers::<3>(name, &(0.0..=most), "linear red, green and blue")?.map(DVec3::from))
    }

    /// `N` positions that must be there.
    pub(super) fn needed_corners<const N: usize>(&self, name: &str, limit: f64) -> Result<[DVec3; N]> {
        let wanted = || format!("{N} corners [x, y, z] in metres, each within {limit} of 0");
        let Some(value) = self.get(name) else { return Err(self.missing(name, &wanted())) };
        let DeValue::Array(items) = value.get_ref() else {
            return Err(self.wrong(name, format!("{} is given; {} are asked for", given(value.get_ref()), wanted())));
        };
        let corners: Option<Vec<DVec3>> =
            items.iter().map(|item| list::<3>(item.get_ref(), &(-limit..=limit)).map(DVec3::from)).collect();
        let refuse = || self.wrong(name, format!("{} entries are given; {} are asked for", items.len(), wanted()));
        corners.and_then(|corners| corners.try_into().ok()).ok_or_else(refuse)
    }

    /// A text.
    pub(super) fn text(&self, name: &str, what: &str) -> Result<Option<String>> {
        let Some(value) = self.get(name) else { return Ok(None) };
        let refuse = || self.wrong(name, format!("{} is given; {what} in quotes is asked for", given(value.get_ref())));
        value.get_ref().as_str().map(|text| Some(text.to_owned())).ok_or_else(refuse)
    }

    /// A text that must be there.
    pub(super) fn needed_text(&self, name: &str, what: &str) -> Result<String> {
        self.text(name, what)?.ok_or_else(|| self.missing(name, &format!("{what} in quotes")))
    }

    /// One of some words, by its place among them.
    pub(super) fn choice(&self, name: &str, options: &[&str]) -> Result<Option<usize>> {
        let Some(text) = self.text(name, &format!("one of {}", options.join(", ")))? else { return Ok(None) };
        let refuse = || {
            let near = names::near(&text, options.iter().copied());
            let near = if near.is_empty() { String::new() } else { format!("near it: {}; ", near.join(", ")) };
            let text = text.escape_debug();
            self.wrong(name, format!("\"{text}\" is unknown; {near}one of {} is asked for", options.join(", ")))
        };
        options.iter().position(|option| *option == text).map(Some).ok_or_else(refuse)
    }

    /// True or false.
    pub(super) fn flag(&self, name: &str) -> Result<Option<bool>> {
        let Some(value) = self.get(name) else { return Ok(None) };
        let refuse = || self.wrong(name, format!("{} is given; true or false is asked for", given(value.get_ref())));
        value.get_ref().as_bool().map(Some).ok_or_else(refuse)
    }

    /// Sets the fields of a plan that this table names; all others are refused.
    pub(super) fn fill(&self, plan: &mut dyn Plan) -> Result<()> {
        self.fill_with(plan, &[])
    }

    /// As [`fill`](Self::fill), with further names that the caller reads.
    pub(super) fn fill_with(&self, plan: &mut dyn Plan, more: &[&'static str]) -> Result<()> {
        let mut known = city::names(plan);
        known.extend(more);
        self.only(&known)?;
        plan.visit(&mut Filler(self))
    }
}

/// Fills a plan from a table.
struct Filler<'a, 'b>(&'b Table<'a>);

impl Fields for Filler<'_, '_> {
    fn number(
        &mut self,
        name: &'static str,
        value: &mut f64,
        allowed: RangeInclusive<f64>,
        unit: &'static str,
    ) -> Result<()> {
        *value = self.0.number(name, allowed, unit)?.unwrap_or(*value);
        Ok(())
    }
    fn span(
        &mut self,
        name: &'static str,
        value: &mut [f64; 2],
        allowed: RangeInclusive<f64>,
        unit: &'static str,
    ) -> Result<()> {
        let Some(found) = self.0.get(name) else { return Ok(()) };
        // One number stands for both ends.
        let single = number(found.get_ref()).filter(|number| allowed.contains(number)).map(|number| [number; 2]);
        let ends = single.or_else(|| list::<2>(found.get_ref(), &allowed)).filter(|ends| ends[0] <= ends[1]);
        let refuse =
            || self.0.wrong(name, format!("{} is given; {}", given(found.get_ref()), span_wanted(&allowed, unit)));
        *value = ends.ok_or_else(refuse)?;
        Ok(())
    }
    fn count(&mut self, name: &'static str, value: &mut u64, allowed: RangeInclusive<u64>) -> Result<()> {
        *value = self.0.count(name, allowed)?.unwrap_or(*value);
        Ok(())
    }
    fn choice(&mut self, name: &'static str, value: &mut usize, options: &[&'static str]) -> Result<()> {
        *value = self.0.choice(name, options)?.unwrap_or(*value);
        Ok(())
    }
    fn has(&mut self, name: &'static str, _: bool) -> bool {
        self.0.get(name).is_some()
    }
    fn table(&mut self, name: &'static str, plan: &mut dyn Plan) -> Result<()> {
        self.0.needed_table(name)?.fill(plan)
    }
}

fn number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|i| i as f64),
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => None,
    }
}

fn list<const N: usize>(value: &DeValue, allowed: &RangeInclusive<f64>) -> Option<[f64; N]> {
    let items = value.as_array()?.iter();
    let numbers: Option<Vec<f64>> =
        items.map(|item| number(item.get_ref()).filter(|number| allowed.contains(number))).collect();
    numbers?.try_into().ok()
}

fn not_numbers<const N: usize>(value: &DeValue, allowed: &RangeInclusive<f64>, unit: &str) -> String {
    let (low, high) = (allowed.start(), allowed.end());
    format!("{} is given; {N} numbers within {low} and {high} are asked for ({unit})", given(value))
}

fn number_asked(allowed: &RangeInclusive<f64>, unit: &str) -> String {
    format!("a number within {} and {} ({unit})", allowed.start(), allowed.end())
}

/// What stands in the file, in few words.
fn given(value: &DeValue) -> String {
    let short = |text: &str| {
        let mut short: String = text.chars().take(40).flat_map(char::escape_debug).collect();
        if text.chars().nth(40).is_some() {
            short.push_str("...");
        }
        short
    };
    match value {
        DeValue::String(text) => format!("the text \"{}\"", short(text)),
        DeValue::Integer(integer) => short(integer.as_str()),
        DeValue::Float(float) => short(float.as_str()),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(date) => format!("the date {date}"),
        DeValue::Array(items) => {
            let inner: Vec<String> = items
                .iter()
                .take(4)
                .map(|item| match item.get_ref() {
                    DeValue::Array(inner) => format!("a list of {}", inner.len()),
                    DeValue::Table(_) => "a table".into(),
                    plain => given(plain),
                })
                .collect();
            format!("[{}{}]", inner.join(", "), if items.len() > 4 { ", ..." } else { "" })
        }
        DeValue::Table(_) => "a table".into(),
    }
}
