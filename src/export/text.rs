//! Numbers and names as text that reads back as the same.

use glam::{DVec3, Vec3};
use std::fmt::{Display, Formatter, Result};

/// A number in the fewest digits that read back as its very bits; with an exponent where that is shorter.
#[derive(Clone, Copy)]
pub(super) struct Number(pub(super) f32);

impl Display for Number {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-4..1e7).contains(&size) { write!(f, "{}", self.0) } else { write!(f, "{:e}", self.0) }
    }
}

/// Three numbers, the separator between them.
pub(super) struct Three(pub(super) Vec3, pub(super) &'static str);

impl Display for Three {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let Self(v, between) = self;
        write!(f, "{}{between}{}{between}{}", Number(v.x), Number(v.y), Number(v.z))
    }
}

/// A point far along `axis` from `from`, in f32: so far that rounding it turns the direction by under 3e-7.
pub(super) fn aim(from: Vec3, axis: DVec3) -> Vec3 {
    let reach = f64::from(from.abs().max_element().max(1.0)).log2().ceil().exp2();
    (from.as_dvec3() + axis * reach).as_vec3()
}

/// A name of letters, digits, `-` and `_` that a file can hold without quoting.
pub(super) fn word(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || c == '-' { c } else { '_' }).collect()
}
