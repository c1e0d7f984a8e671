//! Criterion for strategies, ours and others: groups of benchmarks as functions of a registry and scenes.
//!
//! | question | group |
//! |---|---|
//! | what do set-up and sampling cost? | [`strategies()`] |
//! | how large is the error of one pass? | [`variance()`] |
//! | how fast are the parts that every strategy stands on? | [`kernels()`] |
//! | does a feature that a scene does not use cost anything? | [`leave_out()`] |
//!
//! To compare a change: `cargo bench --features bench -- --save-baseline before`, change it, `cargo bench --features bench -- --baseline before`. A part of a
//! name as an argument selects: `sample/downtown`.

mod kernels;
mod leave_out;
mod quantity;
mod scenes;
mod strategies;
mod timing;
mod variance;

pub use kernels::kernels;
pub use leave_out::leave_out;
pub use strategies::strategies;
pub use variance::variance;
