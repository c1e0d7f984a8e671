//! Which of several figures differ, and what may be said of their order?

use super::interval::Bounds;

/// A positive figure, and where it lies at any confidence.
pub(crate) struct Figure<'a> {
    /// The estimate.
    pub estimate: f64,
    /// Its bounds at a confidence within (0, 1).
    pub bounds: &'a dyn Fn(f64) -> Bounds,
}

/// The least level of doubt that [`told_apart`] looks at.
const LEAST: f64 = 1e-12;

/// The p-value that two independent figures are equal; 1 where nothing can be said.
///
/// The interval of the difference of their logarithms is made from theirs (MOVER); the p-value is the doubt at which it
/// touches 0. Only the ends that face each other count, so that a figure without an upper end can still be told to be
/// the greater.
///
/// Source: Zou and Donner, Stat. Med. 27(10), 2008.
pub(crate) fn told_apart(a: &Figure<'_>, b: &Figure<'_>) -> f64 {
    let (less, more) = if a.estimate < b.estimate { (a, b) } else { (b, a) };
    let distance = (more.estimate / less.estimate).ln();
    let apart = |doubt: f64| {
        let below = (more.estimate / (more.bounds)(1.0 - doubt).low.max(0.0)).ln();
        let above = ((less.bounds)(1.0 - doubt).high / less.estimate).ln();
        below.hypot(above) < distance
    };
    // Written so that a NaN anywhere is doubt.
    if !(distance > 0.0 && distance.is_finite()) {
        return 1.0;
    }
    if apart(LEAST) {
        return LEAST;
    }
    let (mut low, mut high) = (LEAST.ln(), 0.0);
    for _ in 0..40 {
        let middle: f64 = 0.5 * (low + high);
        *(if apart(middle.exp()) { &mut high } else { &mut low }) = middle;
    }
    high.exp()
}

/// Which hypotheses are rejected so that the chance of one false rejection among all is at most `level`.
///
/// Source: Holm, Scand. J. Stat. 6(2), 1979.
pub(crate) fn holm(p_values: &[f64], level: f64) -> Vec<bool> {
    let mut order: Vec<usize> = (0..p_values.len()).collect();
    order.sort_by(|&i, &j| p_values[i].total_cmp(&p_values[j]));
    let mut rejected = vec![false; p_values.len()];
    for (k, &i) in order.iter().enumerate() {
        if p_values[i].is_nan() || p_values[i] > level / (p_values.len() - k) as f64 {
            break;
        }
        rejected[i] = true;
    }
    rejected
}

/// The pairs of `n` figures, in the order in which [`Verdicts`] takes what is said of them.
pub(crate) fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)))
}

/// Which pairs of figures, sorted by their estimates, are told apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Verdicts {
    apart: Vec<Vec<bool>>,
}

impl Verdicts {
    /// Of these figures, least first: all pairs tested together at `level`.
    pub(crate) fn of(sorted: &[Figure<'_>], level: f64) -> Self {
        let p_values: Vec<f64> = pairs(sorted.len()).map(|(i, j)| told_apart(&sorted[i], &sorted[j])).collect();
        Self::new(sorted.len(), &holm(&p_values, level))
    }

    /// Of `n` figures, with a verdict for each of [`pairs`].
    pub(crate) fn new(n: usize, told: &[bool]) -> Self {
        let mut apart = vec![vec![false; n]; n];
        for ((i, j), &told) in pairs(n).zip(told) {
            (apart[i][j], apart[j][i]) = (told, told);
        }
        Self { apart }
    }

    /// First and last rank that each may have: behind those told to be less, before those told to be more.
    pub(crate) fn ranks(&self) -> Vec<(usize, usize)> {
        let n = self.apart.len();
        let told = |i: usize, others: std::ops::Range<usize>| others.filter(|&j| self.apart[i][j]).count();
        (0..n).map(|i| (1 + told(i, 0..i), n - told(i, i + 1..n))).collect()
    }

    /// Groups of figures, lettered from the least: two share a letter if and only if they are not told apart.
    ///
    /// Source: the insert-and-absorb algorithm of Piepho, J. Comput. Graph. Stat. 13(2), 2004.
    pub(crate) fn letters(&self) -> Vec<String> {
        let n = self.apart.len();
        let mut groups = vec![vec![true; n]];
        for (i, j) in pairs(n).filter(|&(i, j)| self.apart[i][j]) {
            let (torn, mut kept): (Vec<_>, Vec<_>) = groups.into_iter().partition(|group| group[i] && group[j]);
            for group in torn {
                for out in [i, j] {
                    let mut part = group.clone();
                    part[out] = false;
                    kept.push(part);
                }
            }
            groups = absorbed(kept);
        }
        groups.sort_by_key(|group| group.iter().position(|&within| within));
        let lettered = |i: usize| groups.iter().enumerate().filter(move |(_, group)| group[i]).map(|(g, _)| letter(g));
        (0..n).map(|i| lettered(i).collect()).collect()
    }
}

/// Where a figure stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    /// First and last rank that are allowed.
    pub rank: [u32; 2],
    /// Shared with every figure that it is not told apart from.
    pub letters: String,
}

/// The places of figures, in the order given; `sorted` names them least first, as `verdicts` takes them.
pub(crate) fn places(sorted: &[usize], verdicts: &Verdicts) -> Vec<Place> {
    let of = sorted.iter().zip(verdicts.ranks().into_iter().zip(verdicts.letters()));
    let mut places: Vec<(usize, Place)> =
        of.map(|(&i, ((first, last), letters))| (i, Place { rank: [first as u32, last as u32], letters })).collect();
    places.sort_by_key(|(i, _)| *i);
    places.into_iter().map(|(_, place)| place).collect()
}

/// The groups without those that lie within another.
fn absorbed(groups: Vec<Vec<bool>>) -> Vec<Vec<bool>> {
    let within = |a: &[bool], b: &[bool]| a.iter().zip(b).all(|(a, b)| !a || *b);
    let mut kept: Vec<Vec<bool>> = Vec::new();
    for group in groups {
        if kept.iter().any(|other| within(&group, other)) {
            continue;
        }
        kept.retain(|other| !within(other, &group));
        kept.push(group);
    }
    kept
}

/// The name of a group: a to z, then a1, b1 and so on.
fn letter(group: usize) -> String {
    let name = char::from(b'a' + (group % 26) as u8);
    if group < 26 { name.to_string() } else { format!("{name}{}", group / 26) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::interval::{Tail, mean};

    fn bounded(factor: f64, high: f64, estimate: f64) -> impl Fn(f64) -> Bounds {
        // A normal figure on the log scale: the p-value has a closed form.
        move |confidence| {
            let z = crate::base::statistics::normal_quantile(0.5 + 0.5 * confidence);
            Bounds { low: estimate * (-z * factor).exp(), high: (estimate * (z * factor).exp()).max(high) }
        }
    }

    #[test]
    fn the_p_value_of_two_normal_figures_is_that_of_their_difference() {
        let (one, two) = (bounded(0.3, 0.0, 1.0), bounded(0.4, 0.0, 3.0));
        let p = told_apart(&Figure { estimate: 1.0, bounds: &one }, &Figure { estimate: 3.0, bounds: &two });
        // ln 3 / 0.5 = 2.197 standard errors.
        assert!((p - 0.0280).abs() < 2e-4, "{p}");
        let same = told_apart(&Figure { estimate: 3.0, bounds: &two }, &Figure { estimate: 1.0, bounds: &one });
        assert!((p - same).abs() < 1e-12);
    }

    #[test]
    fn a_figure_without_an_upper_end_can_be_told_to_be_the_greater_and_never_the_less() {
        let (sure, open) = (bounded(0.1, 0.0, 1.0), bounded(0.1, f64::INFINITY, 3.0));
        let p = |a, b| told_apart(&Figure { estimate: 1.0, bounds: &sure }, &Figure { estimate: a, bounds: b });
        assert!(p(3.0, &open) < 1e-6);
        let open = bounded(0.1, f64::INFINITY, 0.1);
        assert!(p(0.1, &open) == 1.0);
        assert!(p(f64::NAN, &open) == 1.0);
    }

    #[test]
    fn runs_that_differ_by_half_are_told_apart_and_equal_ones_seldom() {
        let mut stream = crate::base::random::Stream::keyed(&[31]);
        let mut draw = |scale: f64| (0..16).map(|_| scale * (1.0 + 0.5 * stream.uniform64())).collect::<Vec<f64>>();
        let p = |a: &[f64], b: &[f64]| {
            let [one, two] = [a, b].map(|v| (v.iter().sum::<f64>() / 16.0, move |c| mean(v, &Tail::NONE, c)));
            told_apart(&Figure { estimate: one.0, bounds: &one.1 }, &Figure { estimate: two.0, bounds: &two.1 })
        };
        assert!(p(&draw(1.0), &draw(1.5)) < 1e-6);
        let false_alarms = (0..400).filter(|_| p(&draw(1.0), &draw(1.0)) < 0.05).count();
        assert!((4..=32).contains(&false_alarms), "{false_alarms} of 400 at 5 %, seed 31");
    }

    #[test]
    fn holm_steps_down_and_stops() {
        assert_eq!(holm(&[0.03, 0.001, 0.02, 0.9], 0.05), [false, true, false, false]);
        assert_eq!(holm(&[0.012, 0.001, 0.016, 0.9], 0.05), [true, true, true, false]);
        assert_eq!(holm(&[f64::NAN], 0.05), [false]);
    }

    #[test]
    fn two_share_a_letter_if_and_only_if_they_are_not_told_apart() {
        let mut stream = crate::base::random::Stream::keyed(&[32]);
        for _ in 0..200 {
            let n = 2 + stream.below(7);
            let told: Vec<bool> = pairs(n).map(|_| stream.uniform() < 0.4).collect();
            let verdicts = Verdicts::new(n, &told);
            let letters = verdicts.letters();
            for ((i, j), told) in pairs(n).zip(told) {
                assert_eq!(letters[i].chars().any(|c| letters[j].contains(c)), !told, "{letters:?}");
            }
        }
    }

    #[test]
    fn ranks_and_letters_of_a_known_table() {
        // 0 and 1 cannot be told apart, nor 1 and 2; 3 is greater than all.
        let verdicts = Verdicts::new(4, &[false, true, true, false, true, true]);
        assert_eq!(verdicts.letters(), ["a", "ab", "b", "c"]);
        assert_eq!(verdicts.ranks(), [(1, 2), (1, 3), (2, 3), (4, 4)]);
    }
}
