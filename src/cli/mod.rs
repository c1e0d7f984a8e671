//! The command line: one file a verb.
//!
//! Data on stdout, progress on stderr. Exit code 0: done; 1: a check failed; 2: wrong usage or bad input; 130:
//! interrupted.
//!
//! | question | where |
//! |---|---|
//! | which verb was typed, and which exit code does it end with? | [`run_with`] |
//! | what does a verb do? | `compare`, `verify` and so on: the file of its name |
//! | what did it come to? | `outcome` |
//! | what is said to the user? | `terminal` |
//! | whose strategies are these, and what was typed? | `home` |
//! | how far is it, and has it been interrupted? | `progress` |
//! | what asks the program to stop? | `signals` |
//! | is something said while a scene is read and prepared? | `waiting` |
//! | which scene does it take, and how is that prepared? | `scene` |
//! | which cities and views of it does a comparison take? | `replicates` |
//! | what is recorded of a comparison before anything is measured? | `begun` |
//! | with which parameters does it run its strategies? | `tuning` |
//! | which of its scenes are tuned for together, and on which cities? | `family` |
//! | which other renderers are compared? | `peer_options` |
//! | which text of an option is right? | `values` |
//! | how many threads does it run on? | `threads` |
//! | can its file be written, and how is a picture? | `output` |
//! | where do results and references lie? | `folders` |

mod begun;
mod compare;
mod diff_image;
mod explain;
mod export;
mod family;
mod folders;
mod home;
mod inspect;
mod lecture;
mod list;
mod new_strategy;
mod outcome;
mod output;
mod peer_options;
mod progress;
mod reference;
mod render;
mod replicates;
mod report;
mod run;
mod scene;
mod signals;
mod stability;
mod study;
mod terminal;
mod threads;
mod tuning;
mod values;
mod verify;
mod waiting;

pub use run::run_with;
