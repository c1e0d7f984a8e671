//! Promise: every strategy keeps its contract: the same bytes on any number of threads, no light lost, and weights that
//! belong to how often a light is picked.
//!
//! | file | what it shows |
//! |---|---|
//! | `every_strategy` | no allocation once warm, no dependence on threads, nothing lost by leaving out |
//! | `needs` | what can be left out of a scene is not in it |
//! | `expected_counts` | expected counts cover a city and sum to the picks, by brute force |
//! | `allocate` | whole points, shared out without noise, within their budget |
//! | `light_tree` | no light lost, probabilities exact, degenerate sets of lights, lightcuts |
//! | `visible` | whatever was learned, and within its memory |
//! | `stochastic_cull` | as many lights in range as the closed form says, and the whole scene on average |
//! | `resampled`, `restir` | choosing among candidates, and among neighbours' candidates |
//! | `oracle` | what each light adds, and therefore the floor |
//!
//! Allocations are counted for each thread by itself, so that the test that counts them may run beside others.

mod runs;

mod allocate;
mod every_strategy;
mod expected_counts;
mod light_tree;
mod needs;
mod oracle;
mod resampled;
mod restir;
mod stochastic_cull;
mod visible;
