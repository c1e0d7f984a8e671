//! The colour spaces of FLIP, and its difference of colours (section 4.1 of the paper of 2020).

use glam::{DMat3, DVec3, Mat3, Vec3};
use rayon::prelude::*;

/// Linear Rec. 709 to XYZ (IEC 61966-2-1's primaries and D65, to seven digits), by rows.
const RGB_TO_XYZ: [[f64; 3]; 3] = [
    [0.412_390_8, 0.357_584_3, 0.180_480_8],
    [0.212_639_0, 0.715_168_7, 0.072_192_3],
    [0.019_330_8, 0.119_194_8, 0.950_532_2],
];

/// Exponent on colour differences, which compresses the large ones (`q_c`).
const COMPRESSION: f32 = 0.7;

/// Differences up to this share of the largest (`p_c`) ...
const KNEE: f32 = 0.4;

/// ... are spread over this share of `[0, 1]` (`p_t`).
const SPREAD: f32 = 0.95;

/// XYZ over that of white, and back: both linear in RGB, so that YCxCz is, and filters may act on it.
pub(super) struct Opponent {
    to_white_ratios: Mat3,
    from_white_ratios: Mat3,
}

impl Opponent {
    pub(super) fn new() -> Self {
        let to_xyz = DMat3::from_cols_array_2d(&RGB_TO_XYZ).transpose();
        let to_white_ratios = DMat3::from_diagonal((to_xyz * DVec3::ONE).recip()) * to_xyz;
        Self { to_white_ratios: to_white_ratios.as_mat3(), from_white_ratios: to_white_ratios.inverse().as_mat3() }
    }

    /// The planes Y, Cx and Cz of a picture, clamped to what a display shows.
    pub(super) fn planes(&self, picture: &[Vec3]) -> [Vec<f32>; 3] {
        let plane = |channel: usize| {
            picture
                .par_iter()
                .map(|&rgb| {
                    let Vec3 { x, y, z } = self.to_white_ratios * rgb.clamp(Vec3::ZERO, Vec3::ONE);
                    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)][channel]
                })
                .collect()
        };
        std::array::from_fn(plane)
    }

    /// YCxCz to linear RGB.
    fn rgb(&self, [y, cx, cz]: [f32; 3]) -> Vec3 {
        let y = (y + 16.0) / 116.0;
        self.from_white_ratios * Vec3::new(y + cx / 500.0, y, y - cz / 200.0)
    }

    /// Linear RGB to CIELAB, the chromatic axes scaled by lightness for the Hunt effect.
    fn lab(&self, rgb: Vec3) -> Vec3 {
        const DELTA: f32 = 6.0 / 29.0;
        let f = |t: f32| {
            if t > DELTA * DELTA * DELTA { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
        };
        let [x, y, z] = (self.to_white_ratios * rgb).to_array().map(f);
        let lightness = 116.0 * y - 16.0;
        Vec3::new(lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z))
    }
}

/// What is perceived of filtered planes: colours in which distances mean something.
pub(super) fn perceived(opponent: &Opponent, [y, cx, cz]: &[Vec<f32>; 3]) -> Vec<Vec3> {
    (0..y.len())
        .into_par_iter()
        .map(|i| opponent.lab(opponent.rgb([y[i], cx[i], cz[i]]).clamp(Vec3::ZERO, Vec3::ONE)))
        .collect()
}

/// The difference of two perceived colours on `[0, 1]`: 1 is that of display green and display blue.
pub(super) fn redistributed(opponent: &Opponent) -> impl Fn(Vec3, Vec3) -> f32 + Sync {
    let compressed = |a: Vec3, b: Vec3| hyab(a, b).powf(COMPRESSION);
    let largest = compressed(opponent.lab(Vec3::Y), opponent.lab(Vec3::Z));
    let knee = KNEE * largest;
    move |a, b| {
        let difference = compressed(a, b);
        if difference < knee {
            SPREAD / knee * difference
        } else {
            SPREAD + (difference - knee) / (largest - knee) * (1.0 - SPREAD)
        }
        .min(1.0)
    }
}

/// City-block distance in lightness, Euclidean in chroma.
fn hyab(a: Vec3, b: Vec3) -> f32 {
    let d = a - b;
    d.x.abs() + d.y.hypot(d.z)
}
