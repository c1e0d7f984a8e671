//! How fast are the parts that every strategy stands on? See [`citylights::bench::kernels`].

use citylights::base::error::Result;
use std::path::Path;

fn main() -> Result<()> {
    citylights::bench::kernels(Path::new("scenes"))
}
