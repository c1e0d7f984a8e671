//! Promise: what goes to other programs and what comes from them means the same there and here.
//!
//! | file | what it shows |
//! |---|---|
//! | `export` | an exported scene says what ours says, to the last bit where the format can |
//! | `round_trip` | a scene that goes out as glTF comes back as the same scene |
//! | `peers` | another renderer's images become rows like any other, whatever it does |
//! | `image` | pictures keep their numbers, and are never half-written |
//! | `exr` | EXR files of other tools, whole and broken |
//! | `flip` | FLIP is the authors' FLIP |
//! | `diff_image` | two pictures are compared by the figures that papers print |

#[path = "../common/mod.rs"]
mod common;

mod diff_image;
mod export;
mod exr;
mod flip;
mod image;
mod peers;
mod round_trip;
