//! Does a feature that a scene does not use cost anything? See [`citylights::bench::leave_out`].
//!
//! With another strategy than `power`: `CITYLIGHTS_BENCH_STRATEGY=uniform cargo bench --features bench --bench leave-out`.

use citylights::base::error::Result;
use citylights::strategy::Registry;
use std::path::Path;

fn main() -> Result<()> {
    let strategy = std::env::var("CITYLIGHTS_BENCH_STRATEGY").unwrap_or_else(|_| "power".into());
    citylights::bench::leave_out(&Registry::standard().parse(&strategy)?, Path::new("scenes"))
}
