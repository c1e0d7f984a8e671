//! Does a path of the program pass all checks?

use super::geometry::Geometry;
use super::path::Path;
use super::{means, pairs, receivers, sums, visits};
use crate::verify::check::Check;
use crate::visibility::stage::Stage;

/// The checks' names.
pub(in crate::verify) const NAMES: [&str; 7] = [
    receivers::RECEIVERS,
    visits::VISITS,
    pairs::CONTRIBUTION,
    pairs::VISIBILITY,
    means::MEAN,
    means::IMPORTANCE,
    sums::SUM,
];

/// Checks a path of the scene of a stage. `level` is the chance that the one check of them that goes by chance,
/// `exact-sum`, fails although all is right.
pub(crate) fn independent(stage: &Stage, path: &dyn Path, seed: u64, level: f64) -> Vec<Check> {
    let geometry = Geometry::new(stage.scene());
    let mut checks = vec![receivers::receivers(&geometry, path.receivers(), seed)];
    if stage.visits().moves() {
        checks.push(visits::visits(&geometry, path, stage.visits(), seed));
    }
    checks.extend(pairs::pairs(&geometry, path, seed));
    checks.extend(means::means(&geometry, path, stage.light_sampling(), seed));
    checks.push(sums::sum(&geometry, path, seed, level));
    checks
}
