//! How are lights chosen?
//!
//! A [`Strategy`] holds parameters; built for a scene it gives a [`LightSampler`], which returns *weighted lights*. The
//! harness shades them, so strategies differ in choice alone. The contract is one identity: for every light `l` that
//! can add anything at a receiver and every function `g` of the point on it,
//!
//! ```text
//! E[ sum over picks of l of weight * g(uv) ] = integral of g      (g = 1: the weights of l sum to 1 on average)
//! ```
//!
//! A strategy that tests points before it picks one may leave out those that add nothing there: the identity then holds
//! for every g that is 0 at them, which is all that shading asks for.
//!
//! A strategy that breaks it by design says so in its [`Claim`].
//!
//! | question | where |
//! |---|---|
//! | what is a strategy, before any scene is known? | [`Strategy`], [`Info`], [`BuildContext`] |
//! | how does it read its parameters? | [`Arguments`] |
//! | how are lights chosen at one receiver? | [`LightSampler`], [`Picks`] |
//! | and with state of a pass, or a view of the frame? | [`FrameSampler`] |
//! | how is a sampler of any type called? | [`AnySampler`], [`Source`] |
//! | which strategy does a name stand for? | [`Registry`], [`Configured`] |
//! | at which parameters may it be tried? | `grid` |
//! | what does choosing cost? | [`Tally`] |

mod any_sampler;
mod arguments;
mod buffer;
mod configured;
mod context;
mod contract;
mod frame;
mod grid;
mod info;
mod parameter;
mod pick;
mod registry;
mod sampler;
mod source;
mod sweep;
mod tally;

pub use crate::base::claim::Claim;
pub use any_sampler::{AnySampler, Block, PerPass, Worker, blocks};
pub use arguments::Arguments;
pub use buffer::PickBuffer;
pub use configured::Configured;
pub use context::BuildContext;
pub use contract::Strategy;
pub use frame::{Frame, FrameSampler};
pub use info::Info;
pub use parameter::Parameter;
pub use pick::{Pick, Picks};
pub use registry::Registry;
pub use sampler::LightSampler;
pub use source::Source;
pub use tally::{Tally, Uncounted};
