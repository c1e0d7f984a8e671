//! Promise: the command line says what is wrong, loses nothing, and goes on where it was stopped.
//!
//! | file | what it shows |
//! |---|---|
//! | `cli` | every verb: its mistakes, its exit codes, its bytes |
//! | `killed` | a run that is killed at any moment goes on to the same rows |
//! | `measurable` | what can be measured is, and what cannot is said instead of ranked |
//! | `mutated` | whatever stands in results, vectors and cached references, it is read or refused |
//! | `lecture` | each chapter of the lecture has a command that makes its labelled picture |
//! | `peers` | another renderer's images become rows like any other, whatever it does |
//! | `receivers` | receivers may move from pass to pass, and what cannot be done then is said |
//! | `replicates` | many cities and views of a recipe are scenes of one comparison, and say something together |
//! | `tuned` | each strategy is compared at its best, found on other cities, and an interrupted search is not done again |
//! | `export` | exports are written whole or not at all |
//! | `diff_image` | two pictures are compared by the figures that papers print |
//! | `stability` | a file of exact values is met, or refused with line and column |
//! | `processes` | whoever is asked to stop stops soon, and takes along what it has started |
//! | `bounds` | no file takes more memory, time or length of name than its size allows |
//! | `said` | what is said of a file is text, fits the terminal, and names what is near alone |

mod bounds;
#[cfg(feature = "cli")]
#[path = "../common/broken.rs"]
mod broken;
#[cfg(feature = "cli")]
#[path = "../common/pictures.rs"]
mod pictures;

mod cli;
mod diff_image;
mod export;
mod killed;
mod lecture;
mod measurable;
mod mutated;
mod peers;
mod processes;
mod receivers;
mod replicates;
mod said;
mod stability;
mod tuned;
