//! What does a texture show over a triangle?
//!
//! | question | where |
//! |---|---|
//! | which texels do the bytes of an image hold? | [`decode`](decode::decode) |
//! | what does an image show, on the whole and in parts? | [`Picture`](picture::Picture) |
//! | what is its mean over a triangle? | [`mean`](coverage::mean) |

pub(crate) mod coverage;
pub(crate) mod decode;
pub(crate) mod picture;
