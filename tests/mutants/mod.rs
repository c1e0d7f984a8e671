//! Promise: a check that cannot fail proves nothing, and each check rejects the wrong strategy that it is meant for.
//!
//! | file | what goes wrong |
//! |---|---|
//! | `gate` | one thing in a choice by flux: a weight, a count, a light, a random number, an allocation |
//! | `machinery` | even numbers, frames, reservoirs, trees, mixtures, units of length |
//! | `frames` | weights of whole frames whose counts nobody tells |
//! | `moved` | right where receivers stay, wrong where they move |
//! | `runs` | right in one run, wrong over several |
//! | `truth` | the code that the truth shares with what it judges |
//! | `visible` | chances that are learned |
//!
//! Allocations are counted for each thread by itself, so that tests may run beside one another.

mod frames;
mod gate;
mod machinery;
mod moved;
mod runs;
mod truth;
mod visible;
