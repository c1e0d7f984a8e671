//! Which strategies can be named, and what does a name with parameters stand for?

use super::arguments::Arguments;
use super::configured::{AnyStrategy, Configured};
use super::contract::Strategy;
use super::info::Info;
use super::sweep;
use crate::base::claim::Claim;
use crate::base::draws::Points;
use crate::base::error::{Error, Result};
use std::borrow::Borrow;

/// A strategy that can be named.
#[derive(Clone)]
struct Entry {
    info: Info,
    grid: &'static str,
    make: fn(&mut Arguments<'_>) -> Result<Box<dyn AnyStrategy>>,
}

/// Strategies by name: a value, handed to whatever reads names.
///
/// `Registry::standard()` holds those of this crate, [`with`](Self::with) adds one of your own. Parameters that name a
/// strategy (`resampled:from=`) are read by the same registry.
#[derive(Clone, Default)]
pub struct Registry {
    entries: Vec<Entry>,
}

impl Registry {
    /// No strategy at all.
    pub fn empty() -> Self {
        Self::default()
    }

    /// With one more, listed last; in place of one of the same name, if there is one.
    #[must_use]
    pub fn with<S: Strategy>(mut self) -> Self {
        let entry = Entry { info: S::INFO, grid: S::GRID, make: |arguments| Ok(Box::new(S::configure(arguments)?)) };
        match self.entries.iter_mut().find(|known| known.info.name == entry.info.name) {
            Some(known) => *known = entry,
            None => self.entries.push(entry),
        }
        self
    }

    /// What each is, with its parameters at their defaults.
    pub fn infos(&self) -> impl Iterator<Item = &Info> {
        self.entries.iter().map(|entry| &entry.info)
    }

    /// Reads `name` or `name:parameter=value,...`.
    ///
    /// # Errors
    /// An unknown name or parameter, with those that come near it; a value that is not allowed, with those that are.
    pub fn parse(&self, text: &str) -> Result<Configured> {
        if text.contains('{') {
            return Err(Error::Invalid(format!("`{text}` stands for several strategies; one is asked for here")));
        }
        self.read(text, &[], points)
    }

    /// Reads a list of strategies; commas between strategies and between parameters are told apart by the `=`.
    ///
    /// Braces are sweeps: `light-tree:arity={2,4,8}` stands for three strategies, `visible:cut={64..1024*2}` for five, whose
    /// names hold the swept parameter whatever its default.
    ///
    /// # Errors
    /// As [`parse`](Self::parse); an empty list; the same strategy twice; braces that are no sweep.
    pub fn parse_list(&self, text: &str) -> Result<Vec<Configured>> {
        let mut parsed: Vec<Configured> = Vec::new();
        for text in texts(text)? {
            for swept in sweep::expand(&text)? {
                parsed.push(self.read(&swept.text, &swept.varied, points)?);
            }
        }
        each_once(&parsed)?;
        Ok(parsed)
    }

    /// The grid that a strategy declares, as [`Strategy::GRID`]; none of one that is not known.
    pub(super) fn declared(&self, name: &str) -> Option<&'static str> {
        self.entries.iter().find(|entry| entry.info.name == name).map(|entry| entry.grid)
    }

    /// Every strategy with its parameters at their defaults.
    ///
    /// # Errors
    /// A strategy that refuses its own defaults.
    pub fn all(&self) -> Result<Vec<Configured>> {
        self.entries.iter().map(|entry| self.parse(entry.info.name)).collect()
    }

    /// Reads a strategy that another one takes candidates from. Its numbers are spread as the other's are, so that it has
    /// no `points` of its own.
    fn parse_source(&self, text: &str) -> Result<Configured> {
        let strategy = self.read(text, &[], |_, _| Ok(Points::Random))?;
        if strategy.gives_candidates() {
            return Ok(strategy);
        }
        let text = "gives no candidates; name a strategy that chooses lights at one receiver by itself, like `power`";
        Err(Error::Invalid(format!("`{}` {text}", strategy.name())))
    }

    /// `varied` are parameters that the name holds even at their defaults.
    fn read(
        &self,
        text: &str,
        varied: &[String],
        points: impl Fn(&Info, &mut Arguments<'_>) -> Result<Points>,
    ) -> Result<Configured> {
        let (name, rest) = text.trim().split_once(':').unwrap_or((text.trim(), ""));
        let Some(entry) = self.entries.iter().find(|entry| entry.info.name == name) else {
            return Err(Error::unknown("strategy", name, self.infos().map(|info| info.name)));
        };
        let sources = |text: &str| self.parse_source(text);
        let mut arguments = Arguments::new(name, rest)?.with_sources(&sources);
        let strategy = (entry.make)(&mut arguments)?;
        let points = points(&entry.info, &mut arguments)?;
        Ok(Configured::new(name, varied, arguments.finish()?, strategy, points))
    }
}

/// The strategies of a list, each as its own text; commas between strategies and between parameters are told apart by
/// the `=`.
///
/// # Errors
/// An empty list.
pub(super) fn texts(list: &str) -> Result<Vec<String>> {
    let mut strategies: Vec<String> = Vec::new();
    for part in sweep::parts(list) {
        let continues = part.contains('=') && !part.split('=').next().is_some_and(|key| key.contains(':'));
        match strategies.last_mut() {
            Some(last) if continues => {
                last.push(if last.contains(':') { ',' } else { ':' });
                last.push_str(&part);
            }
            _ => strategies.push(part),
        }
    }
    if strategies.is_empty() {
        return Err(Error::Invalid("no strategy is named".into()));
    }
    Ok(strategies)
}

/// Refuses a list that holds the same strategy twice.
pub(super) fn each_once<S: Borrow<Configured>>(strategies: &[S]) -> Result<()> {
    for (i, strategy) in strategies.iter().enumerate() {
        let name = strategy.borrow().plain_name();
        if strategies[..i].iter().any(|before| before.borrow().plain_name() == name) {
            return Err(Error::Invalid(format!("strategy `{name}` is named twice")));
        }
    }
    Ok(())
}

/// The parameter of every strategy that draws numbers: how they are spread over a pixel's passes.
fn points(info: &Info, arguments: &mut Arguments<'_>) -> Result<Points> {
    if info.claim == Claim::Floor {
        return Ok(Points::Random);
    }
    let meaning = "how choices and points on lights are spread over a pixel's passes";
    // The last: fewest errors for the least time.
    let index = arguments.choice("points", Points::ALL.len() - 1, &Points::NAMES, meaning)?;
    Ok(Points::ALL[index])
}
