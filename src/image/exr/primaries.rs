//! Which colours do a file's red, green and blue mean?
//!
//! A file may name their chromaticities; one that does not has those of Rec. 709. Colours of other primaries are turned
//! into Rec. 709, through CIE XYZ; where the whites differ too, white stays white (Bradford's transform, as in ICC.1:2022,
//! annex E). What lies outside Rec. 709 becomes negative, not clipped.
//!
//! Source of the matrices: SMPTE RP 177-1993, "Derivation of Basic Television Color Equations".

use ::exr::math::Vec2;
use ::exr::meta::attribute::Chromaticities;
use glam::{DMat3, DVec3};

/// The primaries and the white of Rec. 709.
pub(super) const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Chromaticities that differ by less are those of Rec. 709, rounded: such files stay as they are to the bit.
const ROUNDED: f32 = 2e-3;

/// Primaries whose triangle has less than half this area lie on a line, but for rounding (that of Rec. 709 has 0.11); so
/// do a white and two primaries where colours fill less of their space.
const FLAT: f64 = 1e-5;

/// What turns colours of these primaries into Rec. 709; `None` where they are those.
///
/// # Errors
/// Chromaticities that span no colours.
pub(super) fn to_rec_709(of: &Chromaticities) -> Result<Option<DMat3>, String> {
    let all = |c: &Chromaticities| [c.red, c.green, c.blue, c.white];
    let near = |(a, b): (Vec2<f32>, Vec2<f32>)| (a.x() - b.x()).abs() < ROUNDED && (a.y() - b.y()).abs() < ROUNDED;
    if all(of).into_iter().zip(all(&REC_709)).all(near) {
        return Ok(None);
    }
    let matrix = to_xyz(&REC_709).inverse() * adapted(of.white, REC_709.white) * to_xyz(of);
    let flat = |matrix: DMat3| matrix.determinant().abs() < FLAT;
    if !matrix.is_finite() || flat(triangle(of)) || flat(matrix) {
        return Err(format!("its chromaticities span no colours: {of:?}"));
    }
    Ok(Some(matrix))
}

/// CIE XYZ of a chromaticity, with Y = 1.
fn xyz(Vec2(x, y): Vec2<f32>) -> DVec3 {
    let (x, y) = (f64::from(x), f64::from(y));
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// The primaries as columns of coordinates whose sum is 1: a blue of y = 0, as ACES nearly has, divides by nothing.
fn triangle(of: &Chromaticities) -> DMat3 {
    let column = |Vec2(x, y): Vec2<f32>| DVec3::new(f64::from(x), f64::from(y), 1.0 - f64::from(x) - f64::from(y));
    DMat3::from_cols(column(of.red), column(of.green), column(of.blue))
}

/// Linear colours to CIE XYZ: (1, 1, 1) is the white.
fn to_xyz(of: &Chromaticities) -> DMat3 {
    let primaries = triangle(of);
    primaries * DMat3::from_diagonal(primaries.inverse() * xyz(of.white))
}

/// What turns XYZ as seen by an eye that is used to one white into what it sees when used to another.
fn adapted(from: Vec2<f32>, to: Vec2<f32>) -> DMat3 {
    let cones = DMat3::from_cols_array(&[
        0.8951, -0.7502, 0.0389, // of X
        0.2664, 1.7135, -0.0685, // of Y
        -0.1614, 0.0367, 1.0296, // of Z
    ]);
    cones.inverse() * DMat3::from_diagonal((cones * xyz(to)) / (cones * xyz(from))) * cones
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ACES 2065-1 (SMPTE ST 2065-1:2021).
    const AP0: Chromaticities = Chromaticities {
        red: Vec2(0.7347, 0.2653),
        green: Vec2(0.0, 1.0),
        blue: Vec2(0.0001, -0.077),
        white: Vec2(0.32168, 0.33767),
    };

    /// Rec. ITU-R BT.2020, of the same white as Rec. 709.
    const REC_2020: Chromaticities = Chromaticities {
        red: Vec2(0.708, 0.292),
        green: Vec2(0.170, 0.797),
        blue: Vec2(0.131, 0.046),
        white: REC_709.white,
    };

    fn rows(matrix: DMat3) -> [[f64; 3]; 3] {
        matrix.transpose().to_cols_array_2d()
    }

    #[test]
    fn matrices_are_those_in_print() {
        // ITU-R BT.2087 for Rec. 2020 (inverted there); ACES 2065-1 to Rec. 709 as in the ACES documents' `ACES_to_Rec709`.
        let printed = [
            (REC_2020, [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]]),
            (AP0, [[2.5217, -1.1341, -0.3876], [-0.2765, 1.3727, -0.0962], [-0.0154, -0.1530, 1.1684]]),
        ];
        for (primaries, wanted) in printed {
            let found = rows(to_rec_709(&primaries).expect("colours").expect("another matrix"));
            for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
                assert!((found - wanted).abs() < 2e-4, "{found} for {wanted}");
            }
            let white = to_rec_709(&primaries).expect("colours").expect("a matrix") * DVec3::ONE;
            assert!((white - DVec3::ONE).length() < 1e-12, "{white}");
        }
    }

    #[test]
    fn rec_709_stays_and_a_line_is_refused() {
        assert_eq!(to_rec_709(&REC_709), Ok(None));
        let rounded = Chromaticities { white: Vec2(0.3127, 0.329_01), ..REC_709 };
        assert_eq!(to_rec_709(&rounded), Ok(None));
        for line in [
            Chromaticities { green: Vec2(0.64, 0.33), ..REC_709 },
            Chromaticities { white: Vec2(0.3, 0.0), ..REC_709 },
            Chromaticities { white: REC_709.red, ..REC_709 },
            Chromaticities { red: Vec2(f32::NAN, 0.3), ..REC_709 },
        ] {
            assert!(to_rec_709(&line).is_err(), "{line:?}");
        }
    }
}
