//! Promise: what is measured is kept, bit for bit, and tables, pages and plots follow from it alone.
//!
//! | file | what it shows |
//! |---|---|
//! | `coverage` | how often an interval holds the truth (`--ignored`: minutes) |
//! | `engine` | a plan, and the order of its rows, do not follow the machine |
//! | `moving` | receivers, truth and errors where passes visit receivers of their own |
//! | `results` | raw results keep every number, and a run that dies keeps its rows |
//! | `report` | tables, pages and plots follow from the raw rows, and drift is noticed |
//! | `replicates` | what many cities and views say together follows from their records |
//! | `study` | a study records typed tables, and what it says holds |

mod coverage;
mod engine;
mod moving;
mod replicates;
mod report;
mod results;
mod study;
