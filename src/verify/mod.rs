//! Is a strategy right?
//!
//! Level 0, the contract, holds exactly: ids, weights, seeds, threads, expected counts, allocations. Level 1 is
//! statistics with fixed seeds, at one level for all hypotheses of a check together (Sidak 1967): every light that adds
//! something can be chosen, the weights of each light sum to 1 on average, and the mean estimate is the exact sum. Each
//! finds what the others pass: a light of little power that is never chosen does not move an estimate, a weight that is
//! 1 % off disappears in the noise of one light. Level 2 changes the scene (`metamorphic`) in ways whose effect is
//! known.
//!
//! Two more checks look at several runs ([`Verifier::verify`]): another seed gives other picks, and samplers that are
//! built alike agree whoever arrives first. The arithmetic that strategies are held to is checked too, and
//! so are the halves of a reference and what a strategy is charged (`independent`, `halves`, `charged`).
//!
//! The truth is the sum over *all* lights of the scene with a shadow ray each; what a stage leaves out is never left
//! out here. A strategy that declares itself biased is held to level 0, and its bias is measured instead.
//!
//! A check that fails is made a second time, with other numbers and more of them, and has failed if it fails again. So
//! a wrong strategy is found at the ordinary level of the first look, and a right one fails with the *square* of its
//! chance: many checks of many strategies need a tiny level, and there the tails of a mean of finite draws are not
//! Student's.
//!
//! | question | where |
//! |---|---|
//! | is a strategy right on a stage? | [`Verifier`] |
//! | how hard is it looked at? | [`VerifyOptions`], `spread` |
//! | what did one check find, and what are the checks called? | [`Check`], `names` |
//! | which may a right strategy fail? | `BY_CHANCE` |
//! | what does each light really add? | `Truth` |
//! | what is checked, and what does it pick? | `subject`, `calls` |
//! | which picks does no right sampler make? | `impossible` |
//! | does it keep what holds exactly? | `contract`, `moved`, `seeds`, `arrival` |
//! | what does it do in many draws, and what may these not have shown? | `observe`, `pool`, `steady`, `unseen` |
//! | is that right on average? | `coverage`, `weights`, `estimate` |
//! | and in a scene that was changed in ways whose effect is known? | `metamorphic` |
//! | is the arithmetic right that all are held to? | `independent` |
//! | are the halves of a reference independent, and is a strategy charged for all? | `halves`, `charged` |

mod arrival;
mod by_chance;
mod calls;
mod charged;
mod check;
mod contract;
mod coverage;
mod estimate;
mod halves;
mod impossible;
pub(crate) mod independent;
pub(crate) mod metamorphic;
mod moved;
mod names;
mod observe;
mod options;
mod pool;
mod seeds;
mod spread;
mod steady;
mod subject;
mod truth;
mod unseen;
mod verifier;
mod weights;

pub(crate) use by_chance::BY_CHANCE;
pub(crate) use charged::charged;
pub use check::Check;
#[cfg(test)]
pub(crate) use contract::allocations;
pub(crate) use halves::halves;
#[cfg(test)]
pub(crate) use impossible::{picks_in_range, picks_valid};
pub(crate) use names::names;
pub use options::VerifyOptions;
pub(crate) use truth::Truth;
pub use verifier::Verifier;
