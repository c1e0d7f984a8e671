//! What are the lights called together?
//!
//! After their nodes, numbers at the end left off: `Lamp.001` and `Lamp.002` are both of `Lamp`. Where that makes too
//! many groups to read, and where nodes have no names, after their kinds.

use crate::scene::LightGroup;
use crate::scene::light::{Kind, Light, Shape};
use crate::sources::name;
use std::collections::HashMap;

/// Most groups by name.
const MOST_GROUPS: usize = 24;

/// Lights, group by group as they come.
#[derive(Default)]
pub(super) struct Groups {
    names: Vec<String>,
    numbers: HashMap<String, u32>,
    lights: Vec<(u32, Shape)>,
}

impl Groups {
    /// Adds a light of a node of that name.
    pub(super) fn add(&mut self, node: Option<&str>, light: Shape) {
        let stem = node.map(|name| name.trim_end_matches(|c: char| c.is_ascii_digit() || "._- ".contains(c)));
        let known = stem.unwrap_or_default();
        let group = self.numbers.get(known).copied().unwrap_or_else(|| {
            let number = self.names.len() as u32;
            self.names.push(name::made_fit(known).unwrap_or_else(|| "lights without a name".into()));
            self.numbers.insert(known.to_owned(), number);
            number
        });
        self.lights.push((group, light));
    }

    /// The lights with each group's together, groups in the order of their first lights, and the groups.
    pub(super) fn finish(mut self) -> (Vec<Shape>, Vec<LightGroup>) {
        if self.names.len() > MOST_GROUPS {
            self.names = Kind::ALL.iter().map(|kind| format!("{} lights", kind.name())).collect();
            for (group, light) in &mut self.lights {
                *group = Light::from(*light).kind() as u32;
            }
        }
        self.lights.sort_by_key(|(group, _)| *group);
        let mut groups: Vec<LightGroup> = Vec::new();
        for run in self.lights.chunk_by(|(a, _), (b, _)| a == b) {
            let start = groups.last().map_or(0, |group| group.range.end);
            let name = self.names[run[0].0 as usize].clone();
            groups.push(LightGroup { name, range: start..start + run.len() as u32 });
        }
        (self.lights.into_iter().map(|(_, light)| light).collect(), groups)
    }
}
