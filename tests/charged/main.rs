//! Promise: a strategy is charged for all that it starts and waits for, and what it leaves on other threads is found.
//!
//! | file | what it shows |
//! |---|---|
//! | `callers` | every caller that times strategies charges the same |
//!
//! A process of its own: the clock of the process must see one test alone, and so each takes one lock.

#[path = "../common/mod.rs"]
mod common;

mod callers;
