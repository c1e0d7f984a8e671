//! Wrong strategies of the harder kind: misuse of even numbers, of a frame, of reservoirs, of trees, of mixtures, of units;
//! each rejected by the check that is meant for it, and by the gate before a comparison.

#![cfg(feature = "measure")]

mod common;

use citylights::base::colour::luminance;
use citylights::base::discrete::Cumulative;
use citylights::base::draws::Draws;
use citylights::base::error::Result;
use citylights::scene::light::{Kind, Light, LightId};
use citylights::scene::receiver::Receiver;
use citylights::scene::{Parts, Scene};
use citylights::strategy::erased::{AnySampler, Frame, FrameSampler, PerPass};
use citylights::strategy::parameters::Arguments;
use citylights::strategy::registry::{Configured, Entry, parse_from};
use citylights::strategy::tally::Tally;
use citylights::strategy::{BuildContext, Claim, Info, LightSampler, Picks, Role, Strategy};
use citylights::verify::metamorphic::{Copies, Metamorphic};
use citylights::verify::{Check, Options, Verifier};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::Stage;
use common::{cuboid, ground, panel, sixteen, stage};
use glam::Vec3;
use std::collections::HashMap;
use std::sync::Arc;

fn info(name: &'static str) -> Info {
    Info { name, summary: "one thing is wrong", source: "this test", claim: Claim::Unbiased, role: Role::Choosing }
}

/// Strategies of one type of sampler with one thing wrong or not, told apart by a number.
macro_rules! mutants {
    ($mutant:ident, $sampler:ident, $names:expr) => {
        struct $mutant<const KIND: u8>;

        impl<const KIND: u8> Strategy for $mutant<KIND> {
            const INFO: Info = Info { name: $names[KIND as usize], ..INFO };
            type Sampler = $sampler<KIND>;

            fn configure(_arguments: &mut Arguments) -> Result<Self> {
                Ok(Self)
            }

            fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
                Ok($sampler::new(context.stage))
            }
        }
    };
}

const INFO: Info =
    Info { name: "", summary: "one thing is wrong", source: "this test", claim: Claim::Unbiased, role: Role::Choosing };
