//! Promise: the command line says what is wrong, loses nothing, and goes on where it was stopped.
//!
//! | file | what it shows |
//! |---|---|
//! | `cli` | every verb: its mistakes, its exit codes, its bytes |
//! | `killed` | a run that is killed at any moment goes on to the same rows |

mod cli;
mod killed;
