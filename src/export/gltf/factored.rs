//! Colours without bound in factors that glTF bounds.

use crate::base::error::{Error, Result};
use glam::Vec3;

/// A colour as a factor within 0 and 1 and a power of two, whose product it is exactly.
pub(super) fn factored(colour: Vec3) -> Result<([f32; 3], f32)> {
    let most = colour.max_element();
    if most == 0.0 {
        return Ok(([0.0; 3], 1.0));
    }
    // The least power of two that is not below the largest channel, from its exponent; subnormal ones have that of
    // 2^-126.
    let exponent = (most.to_bits() >> 23).max(1) + u32::from(most.to_bits() << 9 != 0);
    if exponent > 254 {
        return Err(Error::Invalid(format!("glTF has no word for a light of {colour}: 2^127 is the most")));
    }
    let power = f32::from_bits(exponent << 23);
    Ok(((colour / power).to_array(), power))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_give_every_bit_back() {
        let colours = [[1.0, 0.5, 0.25], [3.7, 1e-3, 0.0], [1e-30, 2e-31, 0.0], [1.6e38, 1.0, 3e5], [1e-42, 0.0, 0.0]];
        for colour in colours.map(Vec3::from_array) {
            let (factor, power) = factored(colour).expect("a colour");
            assert!(factor.iter().all(|f| (0.0..=1.0).contains(f)), "{colour}: {factor:?}");
            assert_eq!(Vec3::from_array(factor) * power, colour);
            assert_eq!(power.to_bits() << 9, 0, "{power} is no power of two");
        }
        assert_eq!(factored(Vec3::splat(4.0)).expect("a colour"), ([1.0; 3], 4.0));
        assert!(factored(Vec3::splat(2e38)).is_err());
    }
}
