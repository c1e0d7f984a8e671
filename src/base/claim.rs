//! What does a row of a table say of its own estimate?

use std::borrow::Cow;

/// What a strategy, or another renderer, says of its own estimate, and so what part it plays in a comparison.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "measure",
    derive(serde::Serialize, serde::Deserialize),
    serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)
)]
pub enum Claim {
    /// It chooses among lights, and is right on average: the contract holds for every light.
    Unbiased,
    /// It chooses among lights, and is off on average by design.
    Biased {
        /// What is left out or approximated.
        why: Cow<'static, str>,
    },
    /// It does nothing (`null`): its time is the harness's own.
    Floor,
    /// It takes every light (`all`): no choice, no noise from choosing.
    Ceiling,
    /// It chooses by what it cannot know without paying for it (`oracle`): the least error of any choice, never timed.
    Oracle,
    /// Another renderer's image of the exported scene: it says nothing here, its bias is measured. No strategy of a
    /// registry claims this.
    External {
        /// Its name and version, as far as they are known.
        renderer: String,
    },
}

impl Claim {
    /// A bias by design, with what is left out or approximated.
    pub const fn biased(why: &'static str) -> Self {
        Self::Biased { why: Cow::Borrowed(why) }
    }

    /// Why a strategy is not held to a bias of zero; none if it is.
    pub fn bias(&self) -> Option<&str> {
        match self {
            Self::Biased { why } => Some(why),
            Self::Floor => Some("no light is ever picked"),
            Self::External { .. } => Some("another renderer's"),
            Self::Unbiased | Self::Ceiling | Self::Oracle => None,
        }
    }

    /// Whether its bias is measured and printed: it claims one, or claims nothing.
    pub(crate) fn may_be_biased(&self) -> bool {
        matches!(self, Self::Biased { .. }) || self.is_external()
    }

    /// Whether it chooses among lights at a price that is measured.
    pub fn chooses(&self) -> bool {
        matches!(self, Self::Unbiased | Self::Biased { .. } | Self::External { .. })
    }

    /// Whether another renderer makes it.
    pub(crate) fn is_external(&self) -> bool {
        matches!(self, Self::External { .. })
    }

    /// It in a word, as tables show it.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Unbiased => "unbiased",
            Self::Biased { .. } => "biased",
            Self::Floor => "floor",
            Self::Ceiling => "ceiling",
            Self::Oracle => "oracle",
            Self::External { .. } => "external",
        }
    }
}
