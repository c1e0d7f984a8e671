//! Which strategies are there? One line each.

use super::erased::{AnySampler, AnyStrategy, Spread};
use super::parameters::{Arguments, Parameter};
use super::{BuildContext, Info, Role, Strategy};
use super::{
    all, allocate, influence, influence_pick, influence_tail, intensity, light_tree, lightcuts, null, oracle, power,
    resampled, restir, stochastic_cull, stochastic_lightcuts, uniform, visible,
};
use crate::base::draws::Points;
use crate::base::error::{Error, Result};
use crate::base::names;

/// Every strategy, in the order of `citylights list strategies`.
pub const STRATEGIES: &[Entry] = &[
    Entry::of::<null::Null>(),
    Entry::of::<all::All>(),
    Entry::of::<allocate::Allocate>(),
    Entry::of::<uniform::Uniform>(),
    Entry::of::<power::Power>(),
    Entry::of::<intensity::Intensity>(),
    Entry::of::<influence::Influence>(),
    Entry::of::<influence_pick::InfluencePick>(),
    Entry::of::<influence_tail::InfluenceTail>(),
    Entry::of::<stochastic_cull::StochasticCull>(),
    Entry::of::<light_tree::LightTree>(),
    Entry::of::<lightcuts::Lightcuts>(),
    Entry::of::<stochastic_lightcuts::StochasticLightcuts>(),
    Entry::of::<visible::Visible>(),
    Entry::of::<resampled::Resampled>(),
    Entry::of::<restir::Restir>(),
    Entry::of::<oracle::Oracle>(),
];

/// A strategy that can be named.
#[derive(Clone, Copy)]
pub struct Entry {
    info: Info,
    make: fn(&mut Arguments) -> Result<Box<dyn AnyStrategy>>,
}

impl Entry {
    /// The entry of a strategy's type.
    pub const fn of<S: Strategy>() -> Self {
        Self { info: S::INFO, make: |arguments| Ok(Box::new(S::configure(arguments)?)) }
    }

    /// What it is.
    pub fn info(&self) -> Info {
        self.info
    }
}

/// A strategy with all its parameters settled.
pub struct Configured {
    name: String,
    parameters: Vec<Parameter>,
    strategy: Box<dyn AnyStrategy>,
    points: Points,
}

impl Configured {
    /// Its name with the parameters that differ from their defaults: `power:picks=4`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it is.
    pub fn info(&self) -> Info {
        self.strategy.info()
    }

    /// As [`Strategy::scale_free`].
    pub fn scale_free(&self) -> bool {
        self.strategy.scale_free()
    }

    /// Its parameters.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// How its numbers are spread over a pixel's passes.
    pub fn points(&self) -> Points {
        self.points
    }

    /// Builds its sampler for a scene.
    pub fn build(&self, context: BuildContext<'_>) -> Result<Box<dyn AnySampler>> {
        Ok(Box::new(Spread { sampler: self.strategy.build(context)?, points: self.points }))
    }
}

/// Reads `name` or `name:parameter=value,...`.
pub fn parse(text: &str) -> Result<Configured> {
    parse_from(STRATEGIES, text)
}

/// Reads a strategy's string by a registry of one's own.
pub fn parse_from(entries: &[Entry], text: &str) -> Result<Configured> {
    read(entries, text, points)
}

/// Reads a strategy that another one takes candidates from. Its numbers are spread as the other's are, so that it has
/// no `points` of its own.
pub(super) fn parse_source(text: &str) -> Result<Configured> {
    let strategy = read(STRATEGIES, text, |_, _| Ok(Points::Random))?;
    if strategy.strategy.gives_candidates() {
        return Ok(strategy);
    }
    let text = "gives no candidates; name a strategy that chooses lights at one receiver by itself, like `power`";
    Err(Error::Invalid(format!("`{}` {text}", strategy.name)))
}

fn read(
    entries: &[Entry],
    text: &str,
    points: impl Fn(&Entry, &mut Arguments) -> Result<Points>,
) -> Result<Configured> {
    let (name, rest) = text.trim().split_once(':').unwrap_or((text.trim(), ""));
    let Some(entry) = entries.iter().find(|entry| entry.info.name == name) else {
        let near = names::near(name, entries.iter().map(|entry| entry.info.name));
        return Err(Error::Unknown { what: "strategy", name: name.to_owned(), near });
    };
    let mut arguments = Arguments::new(name, rest)?;
    let strategy = (entry.make)(&mut arguments)?;
    let points = points(entry, &mut arguments)?;
    let parameters = arguments.finish()?;
    let changed: Vec<String> =
        parameters.iter().filter(|p| p.value != p.default).map(|p| format!("{}={}", p.name, p.value)).collect();
    let name = if changed.is_empty() { name.to_owned() } else { format!("{name}:{}", changed.join(",")) };
    Ok(Configured { name, parameters, strategy, points })
}

/// The parameter of every strategy that draws numbers: how they are spread over a pixel's passes.
fn points(entry: &Entry, arguments: &mut Arguments) -> Result<Points> {
    if entry.info.role == Role::Floor {
        return Ok(Points::Random);
    }
    let meaning = "how choices and points on lights are spread over a pixel's passes";
    // The last: fewest errors for the least time.
    let index = arguments.choice("points", Points::ALL.len() - 1, &Points::NAMES, meaning)?;
    Ok(Points::ALL[index])
}

/// Reads a list of strategies; commas between strategies and between parameters are told apart by the `=`.
pub fn parse_list(text: &str) -> Result<Vec<Configured>> {
    let mut strategies: Vec<String> = Vec::new();
    for part in text.split([',', ' ']).filter(|part| !part.is_empty()) {
        let continues = part.contains('=') && !part.split('=').next().is_some_and(|key| key.contains(':'));
        match strategies.last_mut() {
            Some(last) if continues => {
                last.push(if last.contains(':') { ',' } else { ':' });
                last.push_str(part);
            }
            _ => strategies.push(part.to_owned()),
        }
    }
    if strategies.is_empty() {
        return Err(Error::Invalid("no strategy is named".into()));
    }
    let parsed: Vec<Configured> = strategies.iter().map(|text| parse(text)).collect::<Result<_>>()?;
    for (i, strategy) in parsed.iter().enumerate() {
        if parsed[..i].iter().any(|before| before.name == strategy.name) {
            return Err(Error::Invalid(format!("strategy `{}` is named twice", strategy.name)));
        }
    }
    Ok(parsed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_parameters_survive_the_round_trip() {
        for text in ["power", "power:picks=4", "influence-pick:picks=2,cutoff=0.25,transfer=srgb"] {
            let strategy = parse(text).expect(text);
            assert_eq!(strategy.name(), text);
        }
        assert_eq!(parse("power:picks=1").expect("the default").name(), "power");
    }

    #[test]
    fn lists_tell_strategies_from_parameters() {
        let names: Vec<String> = parse_list("uniform,influence-pick:picks=2,cutoff=1,power")
            .expect("a list")
            .iter()
            .map(|s| s.name().to_owned())
            .collect();
        assert_eq!(names, ["uniform", "influence-pick:picks=2,cutoff=1", "power"]);
    }

    #[test]
    fn mistakes_name_what_would_be_right() {
        let message = |text: &str| parse(text).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(message("powr").contains("power"), "{}", message("powr"));
        assert!(message("power:pick=2").contains("picks"), "{}", message("power:pick=2"));
        assert!(message("power:picks=0").contains("1 to 1024"), "{}", message("power:picks=0"));
        assert!(message("power:picks=two").contains("whole number"), "{}", message("power:picks=two"));
        assert!(message("influence:cutoff=NaN").contains("number"), "{}", message("influence:cutoff=NaN"));
        assert!(message("influence:transfer=gamma").contains("linear|srgb"));
        assert!(message("null:picks=2").contains("no parameters"));
        assert!(message("power:picks=2,picks=3").contains("twice"));
    }
}
