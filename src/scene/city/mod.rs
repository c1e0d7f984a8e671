//! A night city, grown from a few tables of numbers.

/// Version of the generator's output; part of every scene's hash.
pub const GENERATOR_VERSION: u32 = 1;
