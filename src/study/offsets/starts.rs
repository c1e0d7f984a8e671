//! How far from the origin does a policy start to fail?

use super::counts::{Counts, POLICIES};
use super::geometry::Geometry;
use crate::base::error::Result;
use crate::record::study::{Cell, Cells, Format, TableRecord};
use crate::study::columns::column;
use crate::visibility::offset::Offset;

/// The greatest power of two of the series that shows where a policy starts to fail: 1,049 km.
const MOST_DOUBLINGS: u32 = 20;

/// For each policy, and each geometry and kind of failure, the first power of two that shows it.
pub(super) fn starts(measure: impl Fn(Geometry, u32) -> Result<[Counts; POLICIES.len()]>) -> Result<Vec<Cells>> {
    let mut starts = [[[None; 2]; Geometry::ALL.len()]; POLICIES.len()];
    for distance in (0..=MOST_DOUBLINGS).map(|power| 1 << power) {
        for (place, geometry) in Geometry::ALL.into_iter().enumerate() {
            for (starts, found) in starts.iter_mut().zip(measure(geometry, distance)?) {
                for (start, failures) in starts[place].iter_mut().zip([found.acne, found.leaks]) {
                    if failures > 0 {
                        start.get_or_insert(u64::from(distance));
                    }
                }
            }
        }
    }
    let row = |((policy, _), starts): (&(&str, Offset), [[Option<u64>; 2]; Geometry::ALL.len()])| {
        std::iter::once((*policy).into()).chain(starts.into_iter().flatten().map(Cell::from)).collect()
    };
    Ok(POLICIES.iter().zip(starts).map(row).collect())
}

pub(super) fn starts_table() -> TableRecord {
    let mut columns = vec![column("policy", "policy", Format::Name)];
    for geometry in Geometry::ALL {
        let name = geometry.name();
        for (failure, head) in [("acne", "acne"), ("leaks", "leaks")] {
            columns.push(column(&format!("{name}_{failure}_m"), &format!("{name}:\n{head}, m"), Format::Whole));
        }
    }
    TableRecord {
        name: "starts".into(),
        title: "the distance at which failures start".into(),
        columns,
        notes: vec![format!(
            "the first of 1, 2, 4, ... 2^{MOST_DOUBLINGS} m at which one ray fails; nothing where none does at any of them."
        )],
        plots: Vec::new(),
    }
}
