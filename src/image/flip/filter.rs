//! Separable filters, and what the eye's contrast sensitivity leaves of a picture.

use rayon::prelude::*;
use std::f64::consts::PI;

/// `a sqrt(pi/b) exp(-pi^2 x^2 / b)`, x in degrees: the transform of a Gaussian in cycles per degree.
#[derive(Clone, Copy)]
struct Gaussian {
    a: f64,
    b: f64,
}

/// Contrast sensitivity of luminance (table 1 of the paper of 2020).
const LUMINANCE: [Gaussian; 1] = [Gaussian { a: 1.0, b: 0.0047 }];
/// Of red against green.
const RED_GREEN: [Gaussian; 1] = [Gaussian { a: 1.0, b: 0.0053 }];
/// Of blue against yellow.
const BLUE_YELLOW: [Gaussian; 2] = [Gaussian { a: 34.1, b: 0.04 }, Gaussian { a: 13.5, b: 0.025 }];

/// Three standard deviations of the widest of them, in degrees.
fn reach() -> f64 {
    3.0 * (0.04 / (2.0 * PI * PI)).sqrt()
}

/// One filter a plane: a sum of separable kernels, the same along both axes, of total weight 1.
pub(super) struct Contrast {
    planes: [Vec<Vec<f32>>; 3],
}

impl Contrast {
    pub(super) fn new(pixels_per_degree: f64) -> Self {
        let radius = (reach() * pixels_per_degree).ceil() as i32;
        let kernels = |gaussians: &[Gaussian]| {
            let taps = |b: f64| offsets(radius).map(move |x| (-(PI * x / pixels_per_degree).powi(2) / b).exp());
            let factor = |g: &Gaussian| g.a * (PI / g.b).sqrt();
            let total: f64 = gaussians.iter().map(|g| factor(g) * taps(g.b).sum::<f64>().powi(2)).sum();
            let kernel = |g: &Gaussian| {
                let scale = (factor(g) / total).sqrt();
                taps(g.b).map(|tap| (scale * tap) as f32).collect()
            };
            gaussians.iter().map(kernel).collect()
        };
        Self { planes: [kernels(&LUMINANCE), kernels(&RED_GREEN), kernels(&BLUE_YELLOW)] }
    }

    /// The filtered planes.
    pub(super) fn filter(&self, planes: &[Vec<f32>; 3], width: usize) -> [Vec<f32>; 3] {
        std::array::from_fn(|i| {
            let mut parts = self.planes[i].iter().map(|kernel| separable(&planes[i], width, kernel, kernel));
            let first = parts.next().unwrap_or_default();
            parts.fold(first, |mut sum, part| {
                sum.iter_mut().zip(&part).for_each(|(sum, part)| *sum += part);
                sum
            })
        })
    }
}

/// The offsets of a kernel's taps.
pub(super) fn offsets(radius: i32) -> impl Iterator<Item = f64> {
    (-radius..=radius).map(f64::from)
}

/// A plane filtered by `across` along its rows and by `down` along its columns, both of odd length; its border pixels
/// go on for ever.
pub(super) fn separable(plane: &[f32], width: usize, across: &[f32], down: &[f32]) -> Vec<f32> {
    if plane.is_empty() {
        return Vec::new();
    }
    let mut rows = vec![0.0; plane.len()];
    rows.par_chunks_mut(width).zip(plane.par_chunks(width)).for_each(|(out, row)| {
        let radius = across.len() / 2;
        let mut padded = vec![row[0]; radius];
        padded.extend_from_slice(row);
        padded.resize(width + 2 * radius, row[width - 1]);
        for (offset, tap) in across.iter().enumerate() {
            add(out, *tap, &padded[offset..offset + width]);
        }
    });
    let last = plane.len() / width - 1;
    let mut done = vec![0.0; plane.len()];
    done.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for (offset, tap) in down.iter().enumerate() {
            let y = (y + offset).saturating_sub(down.len() / 2).min(last);
            add(out, *tap, &rows[y * width..(y + 1) * width]);
        }
    });
    done
}

/// `out += factor * row`.
fn add(out: &mut [f32], factor: f32, row: &[f32]) {
    out.iter_mut().zip(row).for_each(|(out, value)| *out += factor * value);
}
