//! Which picks does no right sampler make?

use super::check::Check;
use crate::scene::light::LightId;
use crate::strategy::Pick;

/// The checks' names.
pub(super) const IDS: &str = "ids";
pub(super) const VALID: &str = "weights-finite";
/// Where one of these fails, nothing else can be looked at.
pub(super) const POSSIBLE: [&str; 2] = [IDS, VALID];

/// How many picks name no light of a scene with so many.
pub(crate) fn picks_in_range(picks: &[Pick], lights: usize) -> usize {
    picks.iter().filter(|pick| pick.light as usize >= lights).count()
}

/// How many picks have a weight that is negative or not finite.
pub(crate) fn picks_valid(picks: &[Pick]) -> usize {
    picks.iter().filter(|pick| !(pick.weight.is_finite() && pick.weight >= 0.0)).count()
}

/// Picks that no right sampler makes: of no light, or with a weight that none can have.
#[derive(Clone, Default)]
pub(super) struct Impossible {
    picks: u64,
    ids: u64,
    weights: u64,
    /// Pixel and light of the first of each.
    first_id: Option<(u32, LightId)>,
    first_weight: Option<(u32, LightId)>,
}

impl Impossible {
    /// Whether there are any.
    pub(super) fn any(&self) -> bool {
        self.ids + self.weights > 0
    }

    /// Counts a pick at a pixel; gives whether it is possible.
    pub(super) fn look(&mut self, pick: &Pick, pixel: u32, lights: usize) -> bool {
        let picks = std::slice::from_ref(pick);
        let (beyond, invalid) = (picks_in_range(picks, lights) > 0, picks_valid(picks) > 0);
        self.picks += 1;
        if beyond {
            self.ids += 1;
            self.first_id.get_or_insert((pixel, pick.light));
        }
        if invalid {
            self.weights += 1;
            self.first_weight.get_or_insert((pixel, pick.light));
        }
        !beyond && !invalid
    }

    /// Adds what was found elsewhere.
    pub(super) fn add(&mut self, other: &Self) {
        self.picks += other.picks;
        self.ids += other.ids;
        self.weights += other.weights;
        self.first_id = self.first_id.or(other.first_id);
        self.first_weight = self.first_weight.or(other.first_weight);
    }
}

/// The checks that nothing else makes sense without.
pub(super) fn possible(found: &Impossible) -> [Check; 2] {
    let Impossible { picks, ids, weights, first_id, first_weight } = *found;
    let check = |name, count: u64, first: Option<(u32, LightId)>, what: &str| {
        let detail = format!("{what}, of {picks} picks; the first is named");
        Check::new(name, count as f64, 0.0, detail).at(first.map(|at| at.0), first.map(|at| at.1))
    };
    [
        check(IDS, ids, first_id, "ids beyond the table of lights"),
        check(VALID, weights, first_weight, "weights below 0 or not finite"),
    ]
}
