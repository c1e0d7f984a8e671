//! Do the halves of a reference come from numbers of their own?
//!
//! Their difference says how noisy the reference is: halves that share their numbers claim that it is free of noise.

use super::check::Check;
use crate::render::exact::Exact;

/// The check's name.
const HALVES: &str = "halves";

/// Checks the values of a reference: no receiver may have drawn the same numbers for both halves. Equal values alone are no
/// fault, since every point of a light that is drawn by its irradiance, with nothing in between, gives the same.
pub(crate) fn halves(values: &[Exact]) -> Check {
    let noisy = || values.iter().filter(|value| value.halves.iter().any(|half| half.max_element() > 0.0));
    let shared = noisy().filter(|value| value.marks[0] == value.marks[1]).count();
    let detail = format!("share of {} receivers with light from triangles whose halves drew the same", noisy().count());
    Check::new(HALVES, shared as f64 / noisy().count().max(1) as f64, 0.0, detail)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn reference(shared: bool) -> Vec<Exact> {
        let of = |x: f64| DVec3::new(x, 2.0 * x, 0.5 * x);
        let value = |i: usize| {
            let first = of((i % 7) as f64);
            // A light that gives each point the same, too.
            let second = if shared || i.is_multiple_of(2) { first } else { first * 1.01 };
            let marks = [i as u64, if shared { i as u64 } else { i as u64 + 1 }];
            Exact { sum: DVec3::ONE, halves: [first, second], marks, rays: 2 }
        };
        (0..100).map(value).collect()
    }

    #[test]
    fn halves_from_one_stream_are_refused() {
        assert!(halves(&reference(false)).passed);
        assert!(!halves(&reference(true)).passed);
    }

    #[test]
    fn a_sum_without_noise_may_be_equal() {
        assert!(halves(&[Exact { sum: DVec3::ONE, ..Exact::default() }; 10]).passed);
        assert!(halves(&[]).passed);
    }
}
