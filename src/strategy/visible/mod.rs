//! What does each place see? Lights chosen by what reaches the receivers around here, walls and all.
//!
//! A light tree chooses nearly as well as weighing every light with nothing in between; what is left is what stands in
//! between. Receivers that are near one another and face the same way see nearly the same lights. So they share a table:
//! all lights as a few dozen clusters of a light tree, near ones small and far ones large, each with a probability that was
//! learned by a few shadow rays to points on its lights. A pick takes a cluster by the table and a light of it by a walk
//! at the receiver itself. Its probability is the product of both, known exactly whatever was learned: a bad table costs
//! noise and no light is ever out of reach.
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
use super::{BuildContext, Claim, Info, LightSampler, Picks, Role, Strategy};
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::base::random::hash;
use crate::scene::receiver::Receiver;
use cells::Cells;
use table::{Lesson, School, Table};

/// Slots of a node of the tree.
const WIDTH: usize = 4;

/// Most receivers of a cell that its clusters are tried at.
const TRIED: usize = 8;

/// `picks` lights by tables of what each place sees.
pub struct Visible {
    /// Side of a cell in metres.
    cell: f32,
    lesson: Lesson,
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
        let cell = arguments.real("cell", 12.0, 0.01..=100_000.0, cell)?;
        let cut = "most clusters of a table, or those of the tree's root if they are more";
        let cut = arguments.count("cut", 64, 1..=4096, cut)?;
        let probes = arguments.count("probes", 4, 1..=256, "shadow rays that each cluster of a table is tried by")?;
        let floor =
            "share of picks by what clusters could add with nothing in between, so that each light stays within reach";
        let floor = arguments.real("floor", 0.2, 0.001..=1.0, floor)?;
        let picks = arguments.count("picks", 1, 1..=1024, "lights drawn a pass")?;
        let far = "as that of `light-tree`; 0 for never";
        let far = arguments.real("far", 0.0, 0.0..=1.0, far)?;
        let memory = "most MB of all tables; cells of few receivers have none where it does not suffice";
        let memory = arguments.count("memory", 16, 0..=65_536, memory)?;
        let lesson = Lesson { cut: cut as usize, probes, floor: floor.into() };
        Ok(Self { cell, lesson, picks, far, memory: memory as usize * 1_000_000 })
    }

    fn scale_free(&self) -> bool {
        false
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let stage = context.stage;
        let tree = LightTree::plain(self.picks, self.far)?.sampler::<WIDTH>(context)?;
        let most = tree.tree().most_elements(self.lesson.cut);
        let learns = stage.needs().occlusion && tree.tree().len() + most > 2;
        let cells = if learns {
            Cells::new(stage.receivers(), self.cell, self.memory, most * size_of::<table::Entry>())
        } else {
            Cells::default()
        };
        let seed = hash(&[context.seed, u64::from_le_bytes(*b"visible:")]);
        Ok(Sampler { tree, cells, target: Target::new(context), lesson: self.lesson, picks: self.picks, seed })
    }
}

/// [`Visible`] for a scene.
pub struct Sampler {
    /// Has the clusters, and chooses where there is no table.
    tree: light_tree::Sampler<WIDTH>,
    cells: Cells,
    target: Target,
    lesson: Lesson,
    picks: u32,
    /// Of the probes.
    seed: u64,
}

/// What a worker keeps.
#[derive(Default)]
pub struct Scratch {
    tree: light_tree::Scratch<WIDTH>,
    /// The cell that was arrived at.
    cell: Option<u32>,
}

impl Sampler {
    /// The table of a cell, made if it is not yet there.
    fn table<T: Tally>(&self, cell: u32, scratch: &mut light_tree::Scratch<WIDTH>, tally: &mut T) -> &Table {
        let school = School { tree: self.tree.tree(), target: &self.target };
        self.cells.table(cell, |region, tried, name| {
            self.lesson.learn(school, region, tried, hash(&[self.seed, name]), &mut scratch.memory, tally)
        })
    }
}

impl LightSampler for Sampler {
    type Scratch = Scratch;

    fn arrive<T: Tally>(&self, at: &Receiver, scratch: &mut Scratch, tally: &mut T) {
        scratch.cell = self.cells.find(at);
        match scratch.cell {
            Some(cell) => {
                self.table(cell, &mut scratch.tree, tally);
                self.tree.tree().arrive(at, &mut scratch.tree.memory, tally);
            }
            None => self.tree.arrive(at, &mut scratch.tree, tally),
        }
    }

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, scratch: &mut Scratch, out: &mut Picks<'_, T>) {
        let Some(cell) = scratch.cell else {
            return self.tree.sample(at, draws, &mut scratch.tree, out);
        };
        let table = self.table(cell, &mut scratch.tree, out.tally);
        let memory = &mut scratch.tree.memory;
        for j in 0..self.picks {
            let Some((element, share, left)) = table.pick(draws.choice_bits(j, self.picks)) else { return };
            if let Some((light, pmf)) = self.tree.tree().pick_in(element, at, left, draws, memory, out.tally) {
                out.push(light, (1.0 / (f64::from(self.picks) * share * pmf)).min(f64::from(f32::MAX)) as f32);
            }
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let Some(cell) = self.cells.find(at) else { return self.tree.expected_counts(at, counts) };
        let (mut scratch, mut tally) = (light_tree::Scratch::default(), Uncounted);
        let table = self.table(cell, &mut scratch, &mut tally);
        self.tree.tree().arrive(at, &mut scratch.memory, &mut tally);
        for (element, share) in table.elements() {
            let scale = f64::from(self.picks) * share;
            self.tree.tree().expect_in(element, at, scale, &scratch.memory, counts);
        }
        true
    }

    fn heap_bytes(&self) -> usize {
        self.tree.heap_bytes() + self.cells.heap_bytes()
    }
}
