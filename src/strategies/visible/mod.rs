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
//! first-night 1.8 to 4.9 times the error without the worst 0.1 % of pixels. Probes in proportion to a root of the clusters'
//! weights, instead of as many of each, change little at best (a tenth less error on downtown) and make outliers at worst.
//!
//! | question | where |
//! |---|---|
//! | which receivers share a table? | `cells` |
//! | what is seen of each cluster there? | `learned` |
//! | which cluster is chosen at this receiver? | `weighed` |
//!
//! A table depends on the scene, the seed and places of its cell, all known when the sampler is built, and on nothing that is
//! sampled nor on who arrives. Where receivers move, its places are what a pass visits that no run makes: bounces meet
//! surfaces that the camera does not see. It is made when a receiver of its cell is first arrived at, on that receiver's thread;
//! a second thread that comes meanwhile waits for it. So it does not matter who makes it, and its cost falls into the first
//! pass.
//!
//! Where fewer than `least` receivers are in a cell, its probes would cost more than what they save. So the cells of such
//! receivers are doubled, up to three times, until there are enough. Receivers that even then share no table choose by
//! `light-tree:facing=rms`, the same tree, and so do those of cells beyond the bound on memory. Where nothing can stand in between
//! or there is no choice, all choose by `light-tree` as it comes.
//!
//! Source: this project; clusters of a light tree with learned weights as in Wang et al., ACM TOG 40(6), 2021.

mod cells;
mod learned;
mod weighed;

use super::parts::target_function::TargetFunction;
use super::parts::walks::{self, OPEN, Walks};
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::base::random::hash;
use crate::scene::light::Kind;
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally, Uncounted};
use crate::tree::{Facing, How, USED_UP};
use cells::Cells;
use learned::{Lesson, School, Table, WIDTH};
use weighed::Weighed;

/// Picks a pass where receivers stay: coming to one, which weighs the clusters of a table, takes about as long.
const STAYING: u32 = 16;
/// Picks a pass where each receiver is visited once, so that every pass pays for coming to it.
const MOVING: u32 = 64;

/// About `picks` lights by tables of what each place sees.
pub(crate) struct Visible {
    /// Side of a cell in metres.
    cell: f32,
    /// Fewest receivers of a cell with a table.
    least: u32,
    lesson: Lesson,
    /// 0 for what the condition asks for.
    picks: u32,
    /// Most bytes of all tables.
    memory: usize,
}

impl Strategy for Visible {
    const INFO: Info = Info {
        name: "visible",
        summary: "takes clusters by what is seen of them from around here, then a light of one by a walk down a tree",
        source: "this project; clusters with learned weights: Wang et al., ACM TOG 40(6), 2021",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler;
    const GRID: &'static str = "picks={4,16,64},cut={256,1024}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        // Each against its neighbours: results/README.md, what was tried for `visible`.
        let cell =
            "side in metres of the smallest cells whose receivers share a table, one for each way that they face";
        let cell = arguments.real("cell", 128.0, 0.01..=100_000.0, cell)?;
        let least =
            "fewest receivers of a cell with a table: those of cells with fewer share one of twice the side, and so on";
        let least = arguments.count("least", 4, 1..=65_536, least)?;
        let cut = "most clusters of a table, or those of the tree's root if they are more";
        let cut = arguments.count("cut", 1024, 1..=4096, cut)?;
        let probes = arguments.count("probes", 4, 1..=256, "shadow rays that each cluster of a table is tried by")?;
        let floor = "about the share of picks by what clusters could add with nothing in between: each light stays within reach";
        let floor = arguments.real("floor", 0.25, 0.001..=1.0, floor)?;
        let picks = "lights drawn a pass; 0 for 16 where receivers stay, and 64 where each is visited once";
        let picks = arguments.count("picks", 0, 0..=1024, picks)?;
        let memory = "most MB of all tables; cells of few receivers have none where it does not suffice";
        let memory = arguments.count("memory", 16, 0..=65_536, memory)?;
        let lesson = Lesson { cut: cut as usize, probes, floor: floor.into() };
        Ok(Self { cell, least, lesson, picks, memory: memory as usize * 1_000_000 })
    }

    fn scale_free(&self) -> bool {
        false
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let stage = context.stage;
        let picks = match self.picks {
            0 if stage.visits().moves() => MOVING,
            0 => STAYING,
            asked => asked,
        };
        // With one light there is no choice, and with nothing in between nothing to learn.
        let learns = stage.needs().occlusion && stage.lights().len() > 1;
        let how = How { facing: if learns { Facing::Rms } else { Facing::Mean }, ..How::default() };
        let walks = Walks { picks, split: 0.0, cut: 0, open: OPEN };
        let tree = walks::Sampler::<WIDTH>::new(context, how, walks);
        let cells = if learns {
            let table = Table::<WIDTH>::bytes(tree.tree().most_divided(self.lesson.cut));
            Cells::new(&stage.places(), self.cell, self.least, self.memory, table)
        } else {
            Cells::default()
        };
        let seed = hash(&[context.seed, u64::from_le_bytes(*b"visible:")]);
        Ok(Sampler { tree, cells, target: TargetFunction::new(context), lesson: self.lesson, picks, seed })
    }
}

/// [`Visible`] for a scene.
pub(crate) struct Sampler {
    /// Has the clusters, and chooses where there is no table.
    tree: walks::Sampler<WIDTH>,
    cells: Cells,
    target: TargetFunction,
    lesson: Lesson,
    picks: u32,
    /// Of the probes.
    seed: u64,
}

/// What a worker keeps.
#[derive(Default)]
pub(crate) struct Scratch {
    tree: walks::Scratch<WIDTH>,
    /// Whether the receiver that was arrived at has a table.
    learned: bool,
    /// By that table.
    weighed: Weighed<WIDTH>,
}

impl Sampler {
    /// Weighs the clusters at a receiver, learning what its cell sees if nobody has yet; false where it has no cell.
    fn weigh<T: Tally>(&self, at: &Receiver, scratch: &mut Scratch, tally: &mut T) -> bool {
        let Some(cell) = self.cells.find(at) else { return false };
        let Scratch { tree: walks::Scratch { memory, .. }, weighed, .. } = scratch;
        let tree = self.tree.tree();
        let table = self.cells.table(cell, |region, tried, name| {
            let school = School { tree, target: &self.target };
            self.lesson.learn(school, region, tried, hash(&[self.seed, name]), memory, tally)
        });
        tree.walk(at, memory, tally).arrive();
        weighed.weigh(table, tree, at, memory, tally);
        let lights = self.target.scene().lights();
        weighed.settle(self.picks, tree, |light| lights[light as usize].kind() == Kind::Triangle, tally);
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
        for &(light, count) in scratch.weighed.certain() {
            // All points of one light in all passes are one sequence.
            for j in 0..count {
                out.push_at(light, 1.0 / count as f32, draws.nested(j, count, |draws| draws.point_of(1 << 31 | light)));
            }
        }
        let memory = &mut scratch.tree.memory;
        let picks = scratch.weighed.left();
        for j in 0..picks {
            let Some((element, share, left)) = scratch.weighed.pick(draws.choice(j, picks)) else { return };
            let left = if share < USED_UP { draws.stream().uniform64() } else { left };
            if let Some((light, pmf)) = self.tree.tree().walk(at, memory, out.tally).pick_in(element, left, draws) {
                let count = f64::from(picks) * share * pmf;
                out.push(light, ((1.0 / count) as f32).min(f32::MAX));
            }
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let mut scratch = Scratch::default();
        if !self.weigh(at, &mut scratch, &mut Uncounted) {
            return self.tree.expected_counts(at, counts);
        }
        scratch.weighed.certain().iter().for_each(|&(light, count)| counts[light as usize] += count as f32);
        for (element, share) in scratch.weighed.elements() {
            let scale = f64::from(scratch.weighed.left()) * share;
            self.tree.tree().expect_in(element, at, scale, &scratch.tree.memory, counts);
        }
        true
    }

    fn heap_bytes(&self) -> usize {
        self.tree.heap_bytes() + self.cells.heap_bytes()
    }
}
