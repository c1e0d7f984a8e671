//! A few lights from any number of candidates, seen once each and kept nowhere.
//!
//! Each place holds one of the candidates seen so far with a probability in proportion to its weight. A place that
//! chose when the weights summed to W keeps its candidate until they exceed W / u, u uniform: the candidate that
//! crosses that mark takes it. So a candidate costs one comparison a place and no random number (Efraimidis and
//! Spirakis, Inf. Process. Lett. 97(5), 2006, section 3; with replacement).

use crate::base::random::Stream;
use crate::scene::light::LightId;

/// Places for candidates.
#[derive(Default)]
pub struct Reservoir {
    places: Vec<Place>,
    total: f64,
}

#[derive(Clone, Copy)]
struct Place {
    light: LightId,
    target: f32,
    /// The sum of weights at which another candidate takes this place.
    until: f64,
}

impl Reservoir {
    /// Empties it, and makes so many places.
    pub fn clear(&mut self, places: u32) {
        self.places.clear();
        self.places.resize(places as usize, Place { light: 0, target: 0.0, until: 0.0 });
        self.total = 0.0;
    }

    /// Shows it a light that stands for `1 / chance` of its like, to be chosen by `target`; one of target 0 is passed
    /// over.
    #[inline]
    pub fn offer(&mut self, light: LightId, target: f32, chance: f32, rng: &mut Stream) {
        if target <= 0.0 {
            return;
        }
        self.total += f64::from(target) / f64::from(chance);
        for place in self.places.iter_mut().filter(|place| place.until < self.total) {
            *place = Place { light, target, until: self.total / (1.0 - rng.uniform64()) };
        }
    }

    /// The light in each place and its weight: on average, all places together give each candidate `1 / chance`.
    pub fn picks(&self) -> impl Iterator<Item = (LightId, f32)> {
        let scale = self.total / self.places.len() as f64;
        let chosen = self.places.iter().filter(|place| place.until > 0.0);
        chosen.map(move |place| (place.light, ((scale / f64::from(place.target)) as f32).min(f32::MAX)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_hold_candidates_by_weight_and_give_each_its_due() {
        // Targets and chances of five candidates; the third has nothing to give.
        let candidates = [(1.0f32, 1.0f32), (4.0, 0.5), (0.0, 1.0), (2.0, 0.25), (8.0, 1.0)];
        let total: f64 = candidates.iter().map(|(t, c)| f64::from(t / c)).sum();
        let mut rng = Stream::keyed(&[21]);
        let mut reservoir = Reservoir::default();
        let (mut held, mut weights) = ([0u32; 5], [0.0f64; 5]);
        let n = 40_000;
        for _ in 0..n {
            reservoir.clear(3);
            for (light, &(target, chance)) in (0..).zip(&candidates) {
                reservoir.offer(light, target, chance, &mut rng);
            }
            for (light, weight) in reservoir.picks() {
                held[light as usize] += 1;
                weights[light as usize] += f64::from(weight);
            }
        }
        for (i, (target, chance)) in candidates.into_iter().enumerate() {
            let share = f64::from(target / chance) / total;
            let expected = 3.0 * f64::from(n) * share;
            let sigma = (expected * (1.0 - share)).sqrt().max(1e-9);
            assert!((f64::from(held[i]) - expected).abs() < 4.5 * sigma, "{i}: held {} for {expected}", held[i]);
            if target > 0.0 {
                let mean = weights[i] / f64::from(n) * f64::from(chance);
                assert!((mean - 1.0).abs() < 4.5 * sigma / expected, "{i}: weight {mean}, seed 21");
            }
        }
    }
}
