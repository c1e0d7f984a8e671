//! Do the halves of a reference come from numbers of their own?
//!
//! Their difference says how noisy the reference is: halves that share their numbers claim that it is free of noise.

use super::check::Check;
use crate::render::exact::Exact;

/// The check's name.
const HALVES: &str = "halves";

/// Share of the receivers with light from triangles whose halves may be equal: a triangle far away may give each point
/// the same number.
const EQUAL: f64 = 0.5;

/// Checks the values of a reference; one without light from triangles has no noise to show.
pub(crate) fn halves(values: &[Exact]) -> Check {
    let noisy = || values.iter().filter(|value| value.halves.iter().any(|half| half.max_element() > 0.0));
    let equal = noisy().filter(|value| value.halves[0] == value.halves[1]).count();
    let detail = format!("share of {} receivers with light from triangles whose halves are equal", noisy().count());
    Check::new(HALVES, equal as f64 / noisy().count().max(1) as f64, EQUAL, detail)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn reference(shared: bool) -> Vec<Exact> {
        let of = |x: f64| DVec3::new(x, 2.0 * x, 0.5 * x);
        let value = |i: usize| {
            let first = of((i % 7) as f64);
            Exact { sum: DVec3::ONE, halves: [first, if shared { first } else { first * 1.01 }], rays: 2 }
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
