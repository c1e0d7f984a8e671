//! How many threads does a verb run on?

/// A pool of `threads` threads; all cores where none is given.
pub(super) fn pool(threads: Option<u32>) -> anyhow::Result<rayon::ThreadPool> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0) as usize).build()?)
}

/// Parses a number of threads.
pub(super) fn threads(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|n| (1..=1024).contains(n)).ok_or_else(|| "a whole number from 1 to 1024 is right".into())
}
