//! `systematic`: lights by what arrives from them, several at even steps from one random start.
use citylights::prelude::*;

/// `picks` lights a pass, by a systematic draw over their unoccluded irradiance (Madow 1949).
pub struct Systematic {
    picks: u32,
}

impl Strategy for Systematic {
    const INFO: Info = Info {
        name: "systematic",
        summary: "picks several lights at even steps over what arrives from all of them",
        source: "Madow, Ann. Math. Stat. 20(3), 1949",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler;
    const GRID: &'static str = "picks={1,2,4,8,16}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        Ok(Self { picks: arguments.count("picks", 4, 1..=64, "lights drawn a pass")? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let stage = context.stage;
        Ok(Sampler { scene: stage.scene().clone(), lights: stage.lights().to_vec(), picks: self.picks })
    }
}

pub struct Sampler {
    scene: std::sync::Arc<Scene>,
    lights: Vec<LightId>,
    picks: u32,
}

impl LightSampler for Sampler {
    type Scratch = Cumulative;

    // Once a receiver, for all its passes: the weight of every light there.
    fn arrive<T: Tally>(&self, at: &Receiver, sums: &mut Cumulative, tally: &mut T) {
        sums.clear();
        tally.weighed(self.lights.len() as u64);
        self.lights.iter().for_each(|&id| sums.push(importance(&self.scene.lights()[id as usize], at)));
    }

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, sums: &mut Cumulative, out: &mut Picks<'_, T>) {
        let (start, picks) = (draws.choice(0, 1), f64::from(self.picks));
        for j in 0..self.picks {
            if let Some((index, probability)) = sums.pick((f64::from(j) + start) / picks) {
                out.push(self.lights[index], (1.0 / (picks * probability)) as f32);
            }
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let mut sums = Cumulative::default();
        self.arrive(at, &mut sums, &mut Uncounted);
        (0..).zip(&self.lights).for_each(|(i, &id)| counts[id as usize] += self.picks as f32 * sums.pmf(i) as f32);
        true
    }

    fn heap_bytes(&self) -> usize {
        size_of_val(&self.lights[..])
    }
}

/// Those of citylights and this one.
pub fn registry() -> Registry {
    Registry::standard().with::<Systematic>()
}
