//! At which parameters may a strategy be tried?
//!
//! A grid is every combination of the values that a strategy declares, or that a text sweeps. Its first point is what
//! the text stands for without any sweep: the default that all others are held against.

use super::configured::Configured;
use super::registry::{Registry, each_once, texts};
use super::sweep;
use crate::base::error::{Error, Result};

impl Registry {
    /// The points at which the strategy of `text` may be tried: first what the text stands for with nothing swept, then
    /// every other combination.
    ///
    /// A text that has a sweep is its own grid. Otherwise the grid is that of [`Strategy::GRID`](super::Strategy::GRID),
    /// in which a parameter that the text gives stays as given.
    ///
    /// ```
    /// use citylights::prelude::*;
    ///
    /// let registry = Registry::standard();
    /// let names = |text: &str| -> Result<Vec<String>> {
    ///     Ok(registry.grid(text)?.iter().map(|point| point.name().to_owned()).collect())
    /// };
    /// assert_eq!(names("light-tree:arity={2,4,8}")?, ["light-tree", "light-tree:arity=2", "light-tree:arity=4"]);
    /// assert_eq!(names("uniform:picks=3")?, ["uniform:picks=3"]);
    /// assert_eq!(names("null")?, ["null"]);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`parse`](Self::parse); braces that are no sweep; a declared grid that its strategy cannot read.
    pub fn grid(&self, text: &str) -> Result<Vec<Configured>> {
        let text = text.trim();
        let (name, given) = text.split_once(':').unwrap_or((text, ""));
        let fixed: Vec<String> = sweep::parts(given).into_iter().filter(|part| !part.contains('{')).collect();
        let with = |varied: &[String]| {
            let parameters: Vec<&str> = fixed.iter().chain(varied).map(String::as_str).collect();
            if parameters.is_empty() { name.to_owned() } else { format!("{name}:{}", parameters.join(",")) }
        };
        // Mistakes in the braces are told of the text as it was typed.
        let own = if text.contains('{') { Some(sweep::expand(text)?) } else { None };
        let first = self.parse(&with(&[]))?;
        let all: Vec<Configured> = match own {
            Some(own) => own.iter().map(|point| self.parse(&point.text)).collect::<Result<_>>()?,
            None => {
                let is_free = |part: &String| !fixed.iter().any(|fixed| key(fixed) == key(part));
                let declared = self.declared(name).unwrap_or_default();
                let free: Vec<String> = sweep::parts(declared).into_iter().filter(is_free).collect();
                let all = sweep::expand(&with(&free));
                let all = all.and_then(|all| all.iter().map(|point| self.parse(&point.text)).collect());
                let of_grid = |error| format!("the grid that `{name}` declares, `{declared}`: {error}");
                all.map_err(|error| Error::Invalid(of_grid(error)))?
            }
        };
        let mut points = vec![first];
        for point in all {
            if points.iter().all(|known| known.plain_name() != point.plain_name()) {
                points.push(point);
            }
        }
        Ok(points)
    }

    /// The [`grid`](Self::grid) of every strategy of a list, which is read as by [`parse_list`](Self::parse_list) but
    /// for the sweeps: each is one grid.
    ///
    /// # Errors
    /// As [`grid`](Self::grid); an empty list; two grids about the same default.
    pub(crate) fn grids(&self, list: &str) -> Result<Vec<Vec<Configured>>> {
        let grids: Vec<Vec<Configured>> = texts(list)?.iter().map(|text| self.grid(text)).collect::<Result<_>>()?;
        each_once(&grids.iter().map(|grid| &grid[0]).collect::<Vec<_>>())?;
        Ok(grids)
    }
}

/// The parameter that `key=value` sets.
fn key(part: &str) -> &str {
    part.split('=').next().unwrap_or(part).trim()
}

#[cfg(test)]
mod tests {
    use crate::strategy::Registry;

    /// No declared grid has more points: each costs what a row costs.
    const MOST: usize = 16;

    fn names(text: &str) -> Vec<String> {
        Registry::standard().grid(text).expect(text).iter().map(|point| point.name().to_owned()).collect()
    }

    fn message(text: &str) -> String {
        Registry::standard().grid(text).err().map(|e| e.to_string()).unwrap_or_default()
    }

    #[test]
    fn every_declared_grid_is_small_and_holds_each_point_once_the_default_first() {
        let registry = Registry::standard();
        for info in registry.infos() {
            let points = names(info.name);
            assert_eq!(points[0], info.name);
            assert!(points.len() <= MOST, "{}: {} points", info.name, points.len());
            assert!(points.iter().enumerate().all(|(i, point)| !points[..i].contains(point)), "{points:?}");
            let declared = registry.declared(info.name).is_some_and(|grid| !grid.is_empty());
            assert_eq!(points.len() > 1, declared && info.claim.chooses(), "{points:?}");
        }
    }

    #[test]
    fn a_text_that_sweeps_is_its_own_grid_and_one_that_gives_a_parameter_keeps_it() {
        assert_eq!(names("power:picks={1,2},mix=0.5"), ["power:mix=0.5", "power:picks=2,mix=0.5"]);
        assert_eq!(names("power:picks={4,2}"), ["power", "power:picks=4", "power:picks=2"]);
        let kept = names("visible:cut=48");
        assert!(kept[0] == "visible:cut=48" && kept.iter().all(|point| point.contains("cut=48")), "{kept:?}");
        assert!(kept.len() > 1 && kept.contains(&"visible:cut=48,picks=4".to_owned()), "{kept:?}");
        assert_eq!(names("oracle:mix=0.2"), ["oracle:mix=0.2"]);
        let grids = Registry::standard().grids("power:picks={1,2},mix=0.5 null,visible:cut=48").expect("a list");
        assert_eq!(
            grids.iter().map(|grid| grid[0].name()).collect::<Vec<_>>(),
            ["power:mix=0.5", "null", "visible:cut=48"]
        );
    }

    #[test]
    fn a_grid_without_values_or_with_an_unknown_parameter_is_refused() {
        for (text, right) in [
            ("power:picks={}", "`power:picks={}`: `{}` holds no values"),
            ("power:picks={ }", "holds no values"),
            ("power:picks={1,,2}", "empty value"),
            ("power:pick={1,2}", "near it: picks"),
            ("power:picks={0,1}", "1 to 1024"),
            ("powr:picks={1,2}", "near it: power"),
            ("power:picks={1,2", "has no `}`"),
        ] {
            assert!(message(text).contains(right), "{text}: {}", message(text));
        }
        let twice = Registry::standard().grids("power:picks={1,2},power").err().map(|e| e.to_string());
        assert!(twice.is_some_and(|text| text.contains("`power` is named twice")));
    }
}
