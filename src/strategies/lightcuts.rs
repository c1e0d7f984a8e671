//! A cut through a binary tree of lights, each cluster standing for its lights through one of them: no chance once the
//! tree is built, so no noise from pass to pass.
//!
//! The tree is drawn once: a node's representative is that of one of its halves, by peak intensity. At a receiver, a
//! cluster is worth what its representative adds, shadow ray included, times the cluster's peak intensity over its own.
//! From the root, the cluster with the greatest bound on what it could add is replaced by its halves, until each bound
//! is at most `error` of the running total (Weber's law: what the eye would not see) or there are `cut` clusters.
//!
//! Where this differs from the source: the tree is that of [`light_tree`](super::light_tree), cut from the top by the
//! surface area orientation heuristic, not paired from the bottom; triangles stand beside points, each through its
//! centroid, and their emission bounds the cosine at the light; the bound on a cluster takes its cosine from the
//! nearest distance and the highest point of its box; a cluster has the colour of its representative, where the source
//! adds up colours; directional lights are in every cut.

use super::parts::target_function::TargetFunction;
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::base::triangle::CENTROID;
use crate::scene::light::{Kind, LightId};
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Pick, Picks, Strategy, Tally, Uncounted};
use crate::tree::{Below, How, Tree};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f32::consts::FRAC_1_PI;

/// The representatives of a cut through the tree.
pub(super) struct Lightcuts {
    error: f32,
    cut: u32,
}

impl Strategy for Lightcuts {
    const INFO: Info = Info {
        name: "lightcuts",
        summary: "clusters lights until each cluster's error is out of sight, one light standing for each",
        source: "Walter, Fernandez, Arbree, Bala, Donikian, Greenberg, SIGGRAPH 2005",
        claim: Claim::biased("one fixed light stands for each cluster"),
    };
    type Sampler = Sampler;
    const GRID: &'static str = "cut={64,256,1000},error={0.02,0.1,0.5}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let error = "a cluster's bound over the total, at most; 0 for none";
        Ok(Self {
            error: arguments.real("error", 0.02, 0.0..=1.0, error)?,
            cut: arguments.count("cut", 1_000, 2..=100_000, "most clusters of a cut")?,
        })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let (scene, lights) = (context.stage.scene(), context.stage.lights());
        let tree = Tree::new(scene, lights, How::default());
        let of_kind = |kind: Kind| {
            let kind_of = move |light: &LightId| scene.lights()[*light as usize].kind() == kind;
            lights.iter().copied().filter(kind_of).collect()
        };
        let mut peaks = vec![0.0; scene.lights().len()];
        tree.peaks(scene).for_each(|(light, peak)| peaks[light as usize] = peak);
        Ok(Sampler {
            representatives: representatives(&tree, &peaks, context.seed),
            target: TargetFunction::new(context),
            directional: of_kind(Kind::Directional),
            peaks,
            tree,
            error: self.error,
            cut: self.cut as usize,
        })
    }
}

/// One light of each node: that of one of its slots, by the slots' peak intensities.
fn representatives(tree: &Tree<2>, peaks: &[f32], seed: u64) -> Vec<LightId> {
    let mut chosen = vec![0; tree.nodes()];
    let mut rng = Stream::keyed(&[seed, u64::from_le_bytes(*b"lightcut")]);
    // From the last node on: those below come after.
    for node in (0..tree.nodes()).rev() {
        let of = |below| match below {
            Below::Light(light) => light,
            Below::Node(below) => chosen[below],
        };
        let (mut total, mut light) = (0.0, 0);
        for (cluster, below) in tree.clusters(node) {
            let peak = f64::from(cluster.peak());
            total += peak;
            if rng.uniform64() * total < peak {
                light = of(below);
            }
        }
        debug_assert!(peaks[light as usize] > 0.0);
        chosen[node] = light;
    }
    chosen
}

/// [`Lightcuts`] for a scene.
pub(super) struct Sampler {
    tree: Tree<2>,
    /// A light for each node.
    representatives: Vec<LightId>,
    directional: Vec<LightId>,
    /// Luminance of the peak intensity of each light of the scene in the tree.
    peaks: Vec<f32>,
    target: TargetFunction,
    error: f32,
    cut: usize,
}

/// A cluster of a cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// The most that it can add; 0 of a light alone, which is worth what it adds.
    bound: f32,
    /// What its representative says that it adds.
    estimate: f32,
    below: Below,
    representative: LightId,
    /// The cluster's peak intensity over its representative's.
    weight: f32,
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then_with(|| other.representative.cmp(&self.representative))
    }
}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl LightSampler for Sampler {
    type Scratch = BinaryHeap<Part>;

    fn arrive<T: Tally>(&self, at: &Receiver, parts: &mut Self::Scratch, tally: &mut T) {
        parts.clear();
        // No more at any receiver: the storage is taken once.
        parts.reserve(self.cut.min(self.tree.len()) + 1);
        if self.tree.is_empty() {
            return;
        }
        let directional = self.directional.iter().map(|&light| f64::from(self.value(light, at, tally)));
        let mut total: f64 = directional.sum();
        self.open(0, None, at, parts, &mut total, tally);
        while parts.len() < self.cut
            && let Some(part) =
                parts.peek().filter(|part| f64::from(part.bound) > f64::from(self.error) * total).copied()
            && let Below::Node(node) = part.below
        {
            parts.pop();
            total -= f64::from(part.estimate);
            self.open(node, Some(part), at, parts, &mut total, tally);
        }
    }

    fn sample<T: Tally>(&self, _at: &Receiver, _draws: &mut Draws, parts: &mut Self::Scratch, out: &mut Picks<'_, T>) {
        self.directional.iter().for_each(|&light| out.push(light, 1.0));
        for part in parts.iter().filter(|part| part.estimate > 0.0) {
            out.push_at(part.representative, part.weight, CENTROID);
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let mut parts = BinaryHeap::new();
        self.arrive(at, &mut parts, &mut Uncounted);
        self.directional.iter().for_each(|&light| counts[light as usize] += 1.0);
        parts.iter().filter(|part| part.estimate > 0.0).for_each(|part| counts[part.representative as usize] += 1.0);
        true
    }

    fn heap_bytes(&self) -> usize {
        self.tree.heap_bytes()
            + size_of_val(&self.representatives[..])
            + size_of_val(&self.directional[..])
            + size_of_val(&self.peaks[..])
    }
}

impl Sampler {
    /// Adds the halves of a node that can add anything. The half that shares the representative of `whole` needs no new
    /// ray.
    fn open<T: Tally>(
        &self,
        node: usize,
        whole: Option<Part>,
        at: &Receiver,
        parts: &mut BinaryHeap<Part>,
        total: &mut f64,
        tally: &mut T,
    ) {
        tally.nodes(1);
        for (cluster, below) in self.tree.clusters(node) {
            // In the unit of the estimates, which are reflected radiances from a white surface.
            let bound = cluster.bound(at) * FRAC_1_PI;
            if bound <= 0.0 {
                continue;
            }
            let (representative, bound) = match below {
                Below::Light(light) => (light, 0.0),
                Below::Node(node) => (self.representatives[node], bound),
            };
            let weight = (cluster.peak() / self.peaks[representative as usize]).min(f32::MAX);
            let estimate = match whole {
                Some(whole) if whole.representative == representative => whole.estimate * (weight / whole.weight),
                _ => weight * self.value(representative, at, tally),
            };
            let estimate = if estimate.is_nan() { 0.0 } else { estimate.min(f32::MAX) };
            *total += f64::from(estimate);
            parts.push(Part { bound, estimate, below, representative, weight });
        }
    }

    /// What a light's centroid adds at a white receiver; 0 if it is hidden.
    fn value<T: Tally>(&self, light: LightId, at: &Receiver, tally: &mut T) -> f32 {
        self.target.of_visible_point(&Pick { light, weight: 1.0, uv: CENTROID }, at, tally)
    }
}
