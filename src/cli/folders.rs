//! Where do results and references lie, unless one says otherwise?

/// Where a result folder is made that was not named.
pub(super) const RESULTS: &str = "results";

/// Where finished tiles of references are kept.
pub(super) const CACHE: &str = "results/.references";
