//! The contestants: every strategy of this crate, one file or folder each.
//!
//! None knows another but through the [contract](crate::strategy); what several are made of lies in [`parts`]. Adding one
//! takes a file here and a line in [`Registry::standard`].

mod all;
pub(crate) mod allocate;
mod influence;
mod influence_pick;
mod influence_tail;
mod intensity;
mod light_tree;
mod lightcuts;
mod null;
mod oracle;
pub mod parts;
mod power;
mod resampled;
mod restir;
pub(crate) mod stochastic_cull;
mod stochastic_lightcuts;
mod uniform;
pub(crate) mod visible;

use crate::strategy::Registry;

impl Registry {
    /// Every strategy of this crate, in the order in which they are listed.
    pub fn standard() -> Self {
        Self::empty()
            .with::<null::Null>()
            .with::<all::All>()
            .with::<allocate::Allocate>()
            .with::<uniform::Uniform>()
            .with::<power::Power>()
            .with::<intensity::Intensity>()
            .with::<influence::Influence>()
            .with::<influence_pick::InfluencePick>()
            .with::<influence_tail::InfluenceTail>()
            .with::<stochastic_cull::StochasticCull>()
            .with::<light_tree::LightTree>()
            .with::<lightcuts::Lightcuts>()
            .with::<stochastic_lightcuts::StochasticLightcuts>()
            .with::<visible::Visible>()
            .with::<resampled::Resampled>()
            .with::<restir::Restir>()
            .with::<oracle::Oracle>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> crate::base::error::Result<crate::strategy::Configured> {
        Registry::standard().parse(text)
    }

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
        let names: Vec<String> = Registry::standard()
            .parse_list("uniform,influence-pick:picks=2,cutoff=1,power")
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
