//! Which program ran: this crate's own, or one with strategies of its own.

use serde::{Deserialize, Serialize};

/// A program by its crate.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Program {
    /// The crate's name, and the program's.
    pub name: String,
    /// The crate's version.
    pub version: String,
    /// Revision of its source, `unknown` outside a checkout; `+` marks uncommitted changes.
    pub revision: String,
}

impl Program {
    /// Whether it is not this crate's own, whose version and revision stand in every record anyway.
    pub(crate) fn is_foreign(&self) -> bool {
        self.name != env!("CARGO_PKG_NAME")
    }
}

/// The [`Program`] of the crate that this is written in, as fixed when it was built. Its revision
/// is what its build script set as `CITYLIGHTS_REVISION`: see the `build.rs` that `citylights new-strategy` writes.
#[macro_export]
macro_rules! program {
    () => {
        $crate::record::Program {
            name: env!("CARGO_PKG_NAME").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            revision: option_env!("CITYLIGHTS_REVISION").unwrap_or("unknown").to_owned(),
        }
    };
}
