//! What a strategy of one's own needs, in one import.
//!
//! ```
//! use citylights::prelude::*;
//!
//! let strategy = Registry::standard().parse("power:picks=4")?;
//! assert_eq!(strategy.name(), "power:picks=4");
//! # Ok::<(), Error>(())
//! ```

pub use crate::base::colour::luminance;
pub use crate::base::discrete::{AliasTable, Cumulative};
pub use crate::base::draws::Draws;
pub use crate::base::error::{Error, Result};
#[cfg(feature = "cli")]
pub use crate::calls::{compare, render, verify};
pub use crate::scene::Scene;
pub use crate::scene::light::{Kind, Light, LightId};
pub use crate::scene::receiver::Receiver;
pub use crate::shading::importance::importance;
pub use crate::strategies::parts::{LightTable, Reservoir};
pub use crate::strategy::{
    Arguments, BuildContext, Claim, Configured, Info, LightSampler, Pick, Picks, Registry, Strategy, Tally, Uncounted,
};
