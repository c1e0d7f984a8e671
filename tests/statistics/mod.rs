//! Promise: what is right on average is right on average: against the exact image, against formulas on paper, and in
//! scenes that were changed in a way that changes nothing.
//!
//! | file | what it shows |
//! |---|---|
//! | `verified` | every registered strategy passes all checks of its contract, on scenes small and real |
//! | `awkward` | scenes where right strategies were accused, and pass |
//! | `false_alarms` | how often the gate and `verify` refuse a right strategy (`--ignored`: minutes) |
//! | `metamorphic` | a scene scaled, turned, moved, permuted, with a light split or a black one |
//! | `closed_forms` | lamps, cones, polygons and the moon |
//! | `cutoff` | the bias of finite lights: its closed form, its repair, and the test that it fails |
//! | `reference` | a reference is exact, says how exact, and keeps to its bound of work |

mod awkward;
mod closed_forms;
mod cutoff;
mod false_alarms;
mod metamorphic;
mod reference;
mod verified;
