//! `name:key=value,key=value`: parameters as one string, read and printed the same everywhere.

use super::configured::Configured;
use super::parameter::Parameter;
use crate::base::error::{Error, Result};
use crate::base::names;
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Reads a strategy that another one takes candidates from.
pub(crate) type Sources<'r> = dyn Fn(&str) -> Result<Configured> + 'r;

/// The parameters that a user gave, as a strategy reads them one by one.
pub struct Arguments<'r> {
    owner: String,
    given: Vec<(String, String)>,
    read: Vec<Parameter>,
    sources: Option<&'r Sources<'r>>,
}

impl<'r> Arguments<'r> {
    /// Splits `key=value,key=value`.
    pub(crate) fn new(owner: &str, text: &str) -> Result<Self> {
        let mut given: Vec<(String, String)> = Vec::new();
        for part in text.split(',').filter(|part| !part.trim().is_empty()) {
            let Some((name, value)) = part.split_once('=') else {
                return Err(Error::Invalid(format!("{owner}: `{part}` is no parameter; write name=value")));
            };
            let (name, value) = (name.trim().to_owned(), value.trim().to_owned());
            if given.iter().any(|(known, _)| *known == name) {
                return Err(Error::Invalid(format!("{owner}: parameter `{name}` is given twice")));
            }
            given.push((name, value));
        }
        Ok(Self { owner: owner.to_owned(), given, read: Vec::new(), sources: None })
    }

    /// These, where a parameter may name another strategy.
    pub(crate) fn with_sources(self, sources: &'r Sources<'r>) -> Self {
        Self { sources: Some(sources), ..self }
    }

    /// A whole number within `allowed`.
    ///
    /// # Errors
    /// A value that is no whole number within `allowed`.
    pub fn count(
        &mut self,
        name: &'static str,
        default: u32,
        allowed: RangeInclusive<u32>,
        meaning: &'static str,
    ) -> Result<u32> {
        self.number(name, default, &allowed, "a whole number", meaning)
    }

    /// A number within `allowed`.
    ///
    /// # Errors
    /// A value that is no number within `allowed`.
    pub fn real(
        &mut self,
        name: &'static str,
        default: f32,
        allowed: RangeInclusive<f32>,
        meaning: &'static str,
    ) -> Result<f32> {
        self.number(name, default, &allowed, "a number", meaning)
    }

    /// One of a few words; gives its index.
    ///
    /// # Errors
    /// A value that is none of `words`.
    pub fn choice(
        &mut self,
        name: &'static str,
        default: usize,
        words: &[&'static str],
        meaning: &'static str,
    ) -> Result<usize> {
        let allowed = words.join("|");
        let value = self.take(name).unwrap_or_else(|| words[default].to_owned());
        let Some(index) = words.iter().position(|word| *word == value) else {
            return Err(self.refuse(name, &value, format!("one of {allowed}")));
        };
        self.read.push(Parameter { name, value, default: words[default].to_owned(), allowed, meaning });
        Ok(index)
    }

    /// A strategy to take candidates from; its own parameters stand between `;`: `light-tree:arity=2;open=0`.
    ///
    /// # Errors
    /// An unknown strategy; a mistake in its parameters; one that takes a strategy itself.
    pub fn strategy(&mut self, name: &'static str, default: &'static str, meaning: &'static str) -> Result<Configured> {
        let text = self.take(name).unwrap_or_else(|| default.to_owned());
        // One level deep: what is named here takes no strategy itself.
        if text.matches(':').count() > 1 {
            return Err(self.refuse(name, &text, "a strategy in a strategy in a strategy goes too far".into()));
        }
        let unknown = || Error::Invalid("no strategies are known here".into());
        let strategy = self
            .sources
            .ok_or_else(unknown)
            .and_then(|read| read(&text.replace(';', ",")))
            .map_err(|error| self.refuse(name, &text, error.to_string()))?;
        let value = strategy.name().replace(',', ";");
        let allowed = "a strategy that chooses lights, its own parameters between `;`".to_owned();
        self.read.push(Parameter { name, value, default: default.to_owned(), allowed, meaning });
        Ok(strategy)
    }

    fn number<T: FromStr + Display + PartialOrd + Copy>(
        &mut self,
        name: &'static str,
        default: T,
        allowed: &RangeInclusive<T>,
        kind: &str,
        meaning: &'static str,
    ) -> Result<T> {
        let range = format!("{} to {}", allowed.start(), allowed.end());
        let value = match self.take(name) {
            None => default,
            Some(text) => match text.parse() {
                Ok(value) if allowed.contains(&value) => value,
                _ => return Err(self.refuse(name, &text, format!("it must be {kind}, {range}"))),
            },
        };
        self.read.push(Parameter {
            name,
            value: value.to_string(),
            default: default.to_string(),
            allowed: range,
            meaning,
        });
        Ok(value)
    }

    fn take(&mut self, name: &str) -> Option<String> {
        let at = self.given.iter().position(|(given, _)| given == name)?;
        Some(self.given.remove(at).1)
    }

    fn refuse(&self, name: &str, value: &str, expected: String) -> Error {
        Error::Parameter { owner: self.owner.clone(), name: name.to_owned(), value: value.to_owned(), expected }
    }

    /// The parameters read; an error if the user gave one that nobody read.
    pub(crate) fn finish(self) -> Result<Vec<Parameter>> {
        match self.given.into_iter().next() {
            None => Ok(self.read),
            Some((name, _)) if self.read.is_empty() => {
                Err(Error::Invalid(format!("{} has no parameters; `{name}` was given", self.owner)))
            }
            Some((name, _)) => {
                let known: Vec<&str> = self.read.iter().map(|p| p.name).collect();
                let near = names::near(&name, known.iter().copied());
                let known = known.into_iter().map(str::to_owned).collect();
                Err(Error::Unknown { what: "parameter", name: format!("{}:{name}", self.owner), near, known })
            }
        }
    }
}
