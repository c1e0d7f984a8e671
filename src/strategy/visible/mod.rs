//! What does each place see? Lights chosen by what reaches the receivers around here, walls and all.
//!
//! A light tree chooses nearly as well as weighing every light with nothing in between; what is left is what stands in
//! between. Receivers that are near one another and face the same way see nearly the same lights. So they share a table:
//! all lights as some dozens of clusters of a light tree, near ones small and far ones large, each with what is seen of
//! it, learned by a few shadow rays to points on its lights. A pick takes a cluster by its weight at the receiver times
//! what the table says, and a light of it by a walk. Its probability is the product of both, known exactly whatever was
//! learned: a bad table costs noise, and no light that can add anything is ever out of reach.
//!
//! One probability a cluster for the whole cell, without the receiver's own weights, makes cheaper samples and outliers: on
//! first-night 1.8 to 4.9 times the error without the worst 0.1 % of pixels.
//!
//! | question | where |
//! |---|---|
//! | which receivers share a table? | `cells` |
//! | how often is each cluster chosen there? | `table` |
//!
//! A table depends on the scene, the seed and the receivers of its cell, all known when the sampler is built, and on
//! nothing that is sampled. It is made when a receiver of its cell is first arrived at, on that receiver's thread; a second
//! thread that comes meanwhile waits for it. So it does not matter who makes it, and its cost falls into the first pass.
//!
//! Receivers that share no table choose by `light-tree` as it comes: those of no cell, those of cells beyond the bound on
//! memory, and all where nothing can stand in between or there is no choice.
//!
//! Source: this project; clusters of a light tree with learned weights as in Wang et al., ACM TOG 40(6), 2021.

mod cells;
mod table;

use super::light_tree::{self, LightTree};
use super::parameters::Arguments;
use super::tally::{Tally, Uncounted};
use super::target::Target;
use super::tree::walk::USED_UP;
use super::{BuildContext, Claim, Info, LightSampler, Picks, Role, Strategy};
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::base::random::hash;
use crate::scene::receiver::Receiver;
use cells::Cells;
use table::{Lesson, School, Table, Weighed};

/// Slots of a node of the tree: those of `light-tree` as it comes. Nodes of four make the same choice on first-night and take a
/// fifth more error x CPU s on downtown.
const WIDTH: usize = 8;

/// Most receivers of a cell that its clusters are tried at.
const TRIED: usize = 8;

/// `picks` lights by tables of what each place sees.
pub struct Visible {
    /// Side of a cell in metres.
    cell: f32,
    lesson: Lesson,
    /// Share of picks with nothing in between.
    floor: f64,
    picks: u32,
    /// As of the tree.
    far: f32,
    /// Most bytes of all tables.
    memory: usize,
}

impl Strategy for Visible {
    const INFO: Info = Info {
        name: "visible",
        summary: "takes clusters by what is seen of them from around here, then a light of one by a walk down a tree",
        source: "this project; clusters with learned weights: Wang et al., ACM TOG 40(6), 2021",
        claim: Claim::Unbiased,
        role: Role::Choosing,
    };
    type Sampler = Sampler;

    fn configure(arguments: &mut Arguments) -> Result<Self> {
        let cell = "side in metres of the cells whose receivers share a table, one for each way that they face";
        let cell = arguments.real("cell", 4.0, 0.01..=100_000.0, cell)?;
        // The defaults: on downtown, 64 passes, cells of 2 to 12 m, 96 to 192 clusters, 4 or 8 probes and floors of 0.2 to
        // 0.4 stay within 1.6 times of the least error x CPU s. A floor of 0.1 leaves outliers: on first-night the error is
        // 2.1 times that without the worst 0.1 % of pixels, with cells of 3 m, where it is 1.2 times with 0.2.
        let cut = "most clusters of a table, or those of the tree's root if they are more";
        let cut = arguments.count("cut", 96, 1..=4096, cut)?;
        let probes = arguments.count("probes", 4, 1..=256, "shadow rays that each cluster of a table is tried by")?;
        let floor =
            "share of picks by what clusters could add with nothing in between, so that each light stays within reach";
        let floor = arguments.real("floor", 0.2, 0.001..=1.0, floor)?;
        let picks = arguments.count("picks", 1, 1..=1024, "lights drawn a pass")?;
        let far = "as that of `light-tree`; 0 for never";
        let far = arguments.real("far", 0.0, 0.0..=1.0, far)?;
        let memory = "most MB of all tables; cells of few receivers have none where it does not suffice";
        let memory = arguments.count("memory", 16, 0..=65_536, memory)?;
        let lesson = Lesson { cut: cut as usize, probes };
        Ok(Self { cell, lesson, floor: floor.into(), picks, far, memory: memory as usize * 1_000_000 })
    }

    fn scale_free(&self) -> bool {
        false
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let stage = context.stage;
        let tree = LightTree::plain(self.picks, self.far)?.sampler::<WIDTH>(context)?;
        // With one light there is no choice, and with nothing in between nothing to learn.
        let cells = if stage.needs().occlusion && stage.lights().len() > 1 {
            let table = Table::<WIDTH>::bytes(tree.tree().most_divided(self.lesson.cut));
            Cells::new(stage.receivers(), self.cell, self.memory, table)
        } else {
            Cells::default()
        };
        let seed = hash(&[context.seed, u64::from_le_bytes(*b"visible:")]);
        let Self { lesson, floor, picks, .. } = *self;
        Ok(Sampler { tree, cells, target: Target::new(context), lesson, floor, picks, seed })
    }
}

/// [`Visible`] for a scene.
pub struct Sampler {
    /// Has the clusters, and chooses where there is no table.
    tree: light_tree::Sampler<WIDTH>,
    cells: Cells,
    target: Target,
    lesson: Lesson,
    floor: f64,
    picks: u32,
    /// Of the probes.
    seed: u64,
}

/// What a worker keeps.
#[derive(Default)]
pub struct Scratch {
    tree: light_tree::Scratch<WIDTH>,
    /// Whether the receiver that was arrived at has a table.
    learned: bool,
    /// By that table.
    weighed: Weighed,
}

impl Sampler {
    /// Weighs the clusters at a receiver, learning what its cell sees if nobody has yet; false where it has no cell.
    fn weigh<T: Tally>(&self, at: &Receiver, scratch: &mut Scratch, tally: &mut T) -> bool {
        let Some(cell) = self.cells.find(at) else { return false };
        let Scratch { tree: light_tree::Scratch { memory, .. }, weighed, .. } = scratch;
        let tree = self.tree.tree();
        let table = self.cells.table(cell, |region, tried, name| {
            let school = School { tree, target: &self.target };
            self.lesson.learn(school, region, tried, hash(&[self.seed, name]), memory, tally)
        });
        tree.arrive(at, memory, tally);
        table.weigh(tree, at, self.floor, memory, weighed, tally);
        true
    }
}

impl LightSampler for Sampler {
    type Scratch = Scratch;

    fn arrive<T: Tally>(&self, at: &Receiver, scratch: &mut Scratch, tally: &mut T) {
        scratch.learned = self.weigh(at, scratch, tally);
        if !scratch.learned {
            self.tree.arrive(at, &mut scratch.tree, tally);
        }
    }

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, scratch: &mut Scratch, out: &mut Picks<'_, T>) {
        if !scratch.learned {
            return self.tree.sample(at, draws, &mut scratch.tree, out);
        }
        let memory = &mut scratch.tree.memory;
        for j in 0..self.picks {
            let Some((element, share, left)) = scratch.weighed.pick(draws.choice(j, self.picks)) else { return };
            let left = if share < USED_UP { draws.stream().uniform64() } else { left };
            if let Some((light, pmf)) = self.tree.tree().pick_in(element, at, left, draws, memory, out.tally) {
                let count = f64::from(self.picks) * share * pmf;
                out.push(light, ((1.0 / count) as f32).min(f32::MAX));
            }
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let mut scratch = Scratch::default();
        if !self.weigh(at, &mut scratch, &mut Uncounted) {
            return self.tree.expected_counts(at, counts);
        }
        for (element, share) in scratch.weighed.elements() {
            let scale = f64::from(self.picks) * share;
            self.tree.tree().expect_in(element, at, scale, &scratch.tree.memory, counts);
        }
        true
    }

    fn heap_bytes(&self) -> usize {
        self.tree.heap_bytes() + self.cells.heap_bytes()
    }
}
