//! How a table of numbers is gone through: to read it from a recipe, to list its names, to check it.
//!
//! A part of a city is a struct with defaults that names its fields, in one place, with range and unit: [`Plan::visit`].
//! Whoever reads a recipe, lists the known names or checks a plan made in code is a [`Fields`].

use crate::base::error::{Error, Result};
use std::ops::RangeInclusive;

/// A table of a recipe.
pub(crate) trait Plan {
    /// Shows every field to `fields`, in order.
    ///
    /// # Errors
    /// What `fields` refuses.
    fn visit(&mut self, fields: &mut dyn Fields) -> Result<()>;
}

/// Someone who goes through the fields of a [`Plan`], reading or checking them.
pub(crate) trait Fields {
    /// A number in `unit`.
    ///
    /// # Errors
    /// A value that is no number within `allowed`.
    fn number(
        &mut self,
        name: &'static str,
        value: &mut f64,
        allowed: RangeInclusive<f64>,
        unit: &'static str,
    ) -> Result<()>;
    /// Two numbers in `unit`, the lower first.
    ///
    /// # Errors
    /// Values that are no numbers within `allowed`, or the greater first.
    fn span(
        &mut self,
        name: &'static str,
        value: &mut [f64; 2],
        allowed: RangeInclusive<f64>,
        unit: &'static str,
    ) -> Result<()>;
    /// A whole number.
    ///
    /// # Errors
    /// A value that is no whole number within `allowed`.
    fn count(&mut self, name: &'static str, value: &mut u64, allowed: RangeInclusive<u64>) -> Result<()>;
    /// One of `options`, by its place in the list.
    ///
    /// # Errors
    /// A value that is none of `options`.
    fn choice(&mut self, name: &'static str, value: &mut usize, options: &[&'static str]) -> Result<()>;
    /// Whether an optional table is there; `now` says whether the plan already holds one.
    fn has(&mut self, name: &'static str, now: bool) -> bool;
    /// A table within this one; only where [`has`](Self::has) said yes.
    ///
    /// # Errors
    /// A value in it that is not allowed; read from a recipe, also a name that the plan does not know.
    fn table(&mut self, name: &'static str, plan: &mut dyn Plan) -> Result<()>;
}

/// Visits an optional table, making it where it is wanted and not there yet.
pub(super) fn part<T: Plan + Default>(f: &mut dyn Fields, name: &'static str, value: &mut Option<T>) -> Result<()> {
    if f.has(name, value.is_some()) { f.table(name, value.get_or_insert_default()) } else { Ok(()) }
}

/// The names of a plan's fields and tables.
pub(crate) fn names(plan: &mut dyn Plan) -> Vec<&'static str> {
    let mut names = Names(Vec::new());
    // The collector refuses nothing.
    let _ = plan.visit(&mut names);
    names.0
}

struct Names(Vec<&'static str>);

impl Fields for Names {
    fn number(&mut self, name: &'static str, _: &mut f64, _: RangeInclusive<f64>, _: &'static str) -> Result<()> {
        self.0.push(name);
        Ok(())
    }
    fn span(&mut self, name: &'static str, _: &mut [f64; 2], _: RangeInclusive<f64>, _: &'static str) -> Result<()> {
        self.0.push(name);
        Ok(())
    }
    fn count(&mut self, name: &'static str, _: &mut u64, _: RangeInclusive<u64>) -> Result<()> {
        self.0.push(name);
        Ok(())
    }
    fn choice(&mut self, name: &'static str, _: &mut usize, _: &[&'static str]) -> Result<()> {
        self.0.push(name);
        Ok(())
    }
    fn has(&mut self, name: &'static str, _: bool) -> bool {
        self.0.push(name);
        false
    }
    fn table(&mut self, _: &'static str, _: &mut dyn Plan) -> Result<()> {
        Ok(())
    }
}

/// Holds the values of a plan made in code against their ranges.
pub(super) struct Check {
    pub(super) owner: String,
}

impl Check {
    fn hold(&self, ok: bool, name: &str, value: String, expected: impl FnOnce() -> String) -> Result<()> {
        if ok {
            return Ok(());
        }
        Err(Error::Parameter { owner: self.owner.clone(), name: name.into(), value, expected: expected() })
    }
}

impl Fields for Check {
    fn number(
        &mut self,
        name: &'static str,
        value: &mut f64,
        allowed: RangeInclusive<f64>,
        unit: &'static str,
    ) -> Result<()> {
        self.hold(allowed.contains(value), name, value.to_string(), || number_wanted(&allowed, unit))
    }
    fn span(
        &mut self,
        name: &'static str,
        value: &mut [f64; 2],
        allowed: RangeInclusive<f64>,
        unit: &'static str,
    ) -> Result<()> {
        let ok = value.iter().all(|v| allowed.contains(v)) && value[0] <= value[1];
        self.hold(ok, name, format!("{value:?}"), || span_wanted(&allowed, unit))
    }
    fn count(&mut self, name: &'static str, value: &mut u64, allowed: RangeInclusive<u64>) -> Result<()> {
        self.hold(allowed.contains(value), name, value.to_string(), || count_wanted(&allowed))
    }
    fn choice(&mut self, name: &'static str, value: &mut usize, options: &[&'static str]) -> Result<()> {
        self.hold(*value < options.len(), name, value.to_string(), || format!("one of {}", options.join(", ")))
    }
    fn has(&mut self, _: &'static str, now: bool) -> bool {
        now
    }
    fn table(&mut self, name: &'static str, plan: &mut dyn Plan) -> Result<()> {
        plan.visit(&mut Self { owner: format!("{}.{name}", self.owner) })
    }
}

/// What is right for a number, in words.
pub(crate) fn number_wanted(allowed: &RangeInclusive<f64>, unit: &str) -> String {
    format!("a number within {} and {} is asked for ({unit})", allowed.start(), allowed.end())
}

/// What is right for two numbers, in words.
pub(crate) fn span_wanted(allowed: &RangeInclusive<f64>, unit: &str) -> String {
    format!("[least, greatest] within {} and {} is asked for ({unit})", allowed.start(), allowed.end())
}

/// What is right for a whole number, in words.
pub(crate) fn count_wanted(allowed: &RangeInclusive<u64>) -> String {
    format!("a whole number within {} and {} is asked for", allowed.start(), allowed.end())
}
