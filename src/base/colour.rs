//! Linear Rec. 709 colour, the sRGB curve, and the colour of a black body.

use glam::Vec3;

/// Luminance of linear Rec. 709 RGB, in the unit of its components (ITU-R BT.709).
#[inline]
pub fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

/// The factor from radiance in cd/m^2 to displayed value at an exposure value at ISO 100: `1 / (1.2 * 2^EV100)`.
///
/// Source: ISO 2720 with q = 0.65, as in Lagarde and de Rousiers, SIGGRAPH course notes, 2014, section 5.2.
pub fn exposure(ev100: f32) -> f32 {
    1.0 / (1.2 * ev100.exp2())
}

/// The inverse of [`exposure`].
pub(crate) fn ev100(exposure: f32) -> f32 {
    -(1.2 * exposure).log2()
}

/// The sRGB transfer curve (IEC 61966-2-1): linear `[0, 1]` to encoded `[0, 1]`; clamps.
pub fn srgb_encode(linear: f32) -> f32 {
    let x = linear.clamp(0.0, 1.0);
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// The inverse of [`srgb_encode`]: encoded `[0, 1]` to linear `[0, 1]`; clamps.
pub(crate) fn srgb_decode(encoded: f32) -> f32 {
    let x = encoded.clamp(0.0, 1.0);
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// Colour of a black body as linear Rec. 709 with luminance 1; `kelvin` is held within 1,700 to 15,000.
///
/// Negative components (a sodium lamp lies outside the gamut) are set to 0 before normalising.
/// Source: Krystek, Color Res. Appl. 10(1), 1985 (rational fit in CIE 1960 u, v).
pub(crate) fn black_body(kelvin: f32) -> Vec3 {
    let t = f64::from(kelvin.clamp(1_700.0, 15_000.0));
    let u = (0.860_117_757 + 1.541_182_54e-4 * t + 1.286_412_12e-7 * t * t)
        / (1.0 + 8.424_202_35e-4 * t + 7.081_451_63e-7 * t * t);
    let v = (0.317_398_726 + 4.228_062_45e-5 * t + 4.204_816_91e-8 * t * t)
        / (1.0 - 2.897_418_16e-5 * t + 1.614_560_53e-7 * t * t);
    let x = 3.0 * u / (2.0 * u - 8.0 * v + 4.0);
    let y = 2.0 * v / (2.0 * u - 8.0 * v + 4.0);
    let (big_x, big_z) = (x / y, (1.0 - x - y) / y);
    // XYZ (Y = 1) to linear Rec. 709, D65 (IEC 61966-2-1).
    let rgb = [
        3.240_454_2 * big_x - 1.537_138_5 - 0.498_531_4 * big_z,
        -0.969_266_0 * big_x + 1.876_010_8 + 0.041_556_0 * big_z,
        0.055_643_4 * big_x - 0.204_025_9 + 1.057_225_2 * big_z,
    ];
    let rgb = Vec3::from_array(rgb.map(|c| c.max(0.0) as f32));
    rgb / luminance(rgb)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn daylight_is_nearly_white_and_lamps_are_warm() {
        let day = black_body(6_504.0);
        assert!((day - Vec3::ONE).abs().max_element() < 0.06, "{day}");
        let lamp = black_body(2_700.0);
        assert!(lamp.x > 1.4 && lamp.z < 0.4, "{lamp}");
        assert!((luminance(lamp) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn srgb_is_continuous_and_monotone() {
        assert!((srgb_encode(0.003_130_8) - srgb_encode(0.003_130_9)).abs() < 2e-6);
        assert!((srgb_encode(1.0) - 1.0).abs() < 1e-6);
        for code in 0..=255u8 {
            let encoded = f32::from(code) / 255.0;
            assert!((srgb_encode(srgb_decode(encoded)) - encoded).abs() < 1e-6, "{code}");
        }
        assert!((srgb_decode(0.5) - 0.214_041_14).abs() < 1e-6);
    }
}
