//! Promise: what goes to other programs and what comes from them means the same there and here.
//!
//! | file | what it shows |
//! |---|---|
//! | `export` | an exported scene says what ours says, to the last bit where the format can |
//! | `round_trip` | a scene that goes out as glTF comes back as the same scene |
//! | `mask` | pixels in which renderers may see different surfaces are not compared |
//! | `image` | pictures keep their numbers, and are never half-written |
//! | `exr` | EXR files of other tools, whole and broken |
//! | `flip` | FLIP is the authors' FLIP |
//! | `map` | maps of errors have the published colours |

mod export;
mod exr;
mod flip;
mod image;
mod map;
mod mask;
mod round_trip;
