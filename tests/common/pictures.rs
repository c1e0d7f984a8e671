//! Two small pictures of the same thing, one of them noisy.

use citylights::image::Picture;

pub(crate) const WIDTH: u32 = 24;
pub(crate) const HEIGHT: u32 = 16;

/// A picture of values that differ from pixel to pixel and channel to channel.
pub(crate) fn picture(value: impl Fn(usize, usize) -> f32) -> Picture {
    let pixels = (0..(WIDTH * HEIGHT) as usize).map(|i| [0, 1, 2].map(|c| value(i, c))).collect();
    Picture { width: WIDTH, height: HEIGHT, pixels }
}

pub(crate) fn reference() -> Picture {
    picture(|i, c| 0.1 + (i % 7) as f32 * 0.3 + c as f32 * 0.05)
}

pub(crate) fn noisy() -> Picture {
    picture(|i, c| reference().pixels[i][c] * (1.0 + 0.2 * ((i * 5 + c * 3) % 11) as f32 / 11.0))
}
