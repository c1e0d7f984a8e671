//! Is a strategy right on a stage?

use super::by_chance::by_chance;
use super::check::Check;
use super::impossible::{POSSIBLE, possible};
use super::options::VerifyOptions;
use super::spread::spread;
use super::subject::Subject;
use super::truth::Truth;
use super::{arrival, contract, coverage, estimate, observe, seeds, weights};
use crate::base::error::Result;
use crate::base::random::hash;
use crate::render::visit::Visit;
use crate::scene::receiver::Receiver;
use crate::strategy::{AnySampler, BuildContext, Claim, Configured};
use crate::visibility::stage::Stage;
use rayon::prelude::*;
use std::borrow::Cow;
use std::sync::OnceLock;

/// What is sampled on a stage: that of the first pass stands for all, where receivers move.
fn frame(stage: &Stage) -> Cow<'_, [Receiver]> {
    if stage.visits().moves() {
        Visit::moving(stage, stage.receivers(), 0).receivers.into_owned().into()
    } else {
        stage.receivers().into()
    }
}

/// How many times as much the second look draws.
const MORE: usize = 4;

/// A stage and what is true at some of its receivers: checks any number of strategies, on any threads.
pub struct Verifier<'a> {
    pub(super) stage: &'a Stage,
    pub(super) options: VerifyOptions,
    /// All that is sampled: what pixels see through their centres or, where receivers move, what a pass visits.
    frame: Cow<'a, [Receiver]>,
    pub(super) receivers: Vec<Receiver>,
    pub(super) truths: Vec<Truth>,
    /// How many of them, the first, get more light than rounding may make.
    bright: usize,
    /// The same with other numbers and more of them, made when first needed.
    second: OnceLock<Box<Self>>,
}

impl<'a> Verifier<'a> {
    /// Finds the truth at `options.receivers` receivers of a stage.
    pub fn new(stage: &'a Stage, options: VerifyOptions) -> Self {
        let receivers = spread(&frame(stage), options.receivers);
        Self::at(stage, &receivers, options)
    }

    /// Finds the truth at receivers of a stage.
    pub(super) fn at(stage: &'a Stage, receivers: &[Receiver], options: VerifyOptions) -> Self {
        let truth = |at: &Receiver| Truth::new(stage, at, options.points, options.seed);
        let known: Vec<(Receiver, Truth)> = receivers.par_iter().map(|at| (*at, truth(at))).collect();
        let (bright, dim): (Vec<_>, Vec<_>) = known.into_iter().partition(|(_, truth)| !truth.dim());
        let first = bright.len();
        let (receivers, truths) = bright.into_iter().chain(dim).unzip();
        Self { stage, options, frame: frame(stage), receivers, truths, bright: first, second: OnceLock::new() }
    }

    /// The receivers that statistics can look at, and what is true there.
    pub(super) fn bright(&self) -> (&[Receiver], &[Truth]) {
        (&self.receivers[..self.bright], &self.truths[..self.bright])
    }

    /// How many receivers get some light, but no more than rounding may make: statistics leave them out.
    pub(crate) fn dim(&self) -> usize {
        self.receivers.len() - self.bright
    }

    /// How many receivers are looked at.
    pub(crate) fn looked_at(&self) -> usize {
        self.receivers.len()
    }

    /// What each light adds, at each receiver.
    #[cfg(test)]
    pub(crate) fn truths(&self) -> &[Truth] {
        &self.truths
    }

    /// Checks a strategy: levels 0 and 1.
    ///
    /// # Errors
    /// A strategy that cannot serve the scene.
    pub fn verify(&self, strategy: &Configured) -> Result<Vec<Check>> {
        let build = || strategy.build(BuildContext { stage: self.stage, seed: self.options.seed });
        let sampler = build()?;
        let mut checks = self.verify_sampler(&*sampler, &strategy.info().claim);
        if checks.iter().all(|check| check.passed || !POSSIBLE.contains(&check.name)) {
            checks.push(arrival::order(&self.frame, &self.receivers, self.options.seed, build)?);
        }
        Ok(checks)
    }

    /// Checks a sampler that was built for the stage and claims so much. What takes more than one sampler to see,
    /// [`verify`](Self::verify) checks.
    pub fn verify_sampler(&self, sampler: &dyn AnySampler, claim: &Claim) -> Vec<Check> {
        let mut checks = self.look(sampler, claim);
        if checks.iter().any(|check| !check.passed && by_chance(check)) {
            let second = self.second().look(sampler, claim);
            for check in checks.iter_mut().filter(|check| !check.passed && by_chance(check)) {
                if let Some(again) = second.iter().find(|again| again.name == check.name) {
                    check.clone_from(again);
                }
            }
        }
        checks
    }

    /// One look: every check fails a right sampler with the chance `options.level`.
    pub(crate) fn look(&self, sampler: &dyn AnySampler, claim: &Claim) -> Vec<Check> {
        let subject = self.subject(sampler);
        let mut impossible = contract::impossible(&subject);
        // An id that is out of range has nothing to be looked up, and no number is near one that is none.
        if impossible.any() {
            return possible(&impossible).into();
        }
        let seen = observe::seen(&self.bright_subject(sampler));
        let sites = &seen.sites;
        sites.iter().for_each(|site| impossible.add(&site.impossible));
        let mut checks = Vec::from(possible(&impossible));
        if impossible.any() {
            return checks;
        }
        checks.extend(contract::exact(&subject));
        checks.push(seeds::another(&subject));
        checks.push(contract::picks(sites, &self.options));
        match claim.bias() {
            None => {
                // A biased strategy's pick may stand for other lights than itself, as those of lightcuts do.
                checks.push(contract::reciprocal(sites));
                checks.push(coverage::coverage(self.stage.scene(), sites));
                checks.extend(weights::weights(sites, &self.options));
                checks.extend(estimate::estimate(&seen, &self.options));
            }
            Some(why) => checks.push(estimate::bias(sites, why)),
        }
        checks
    }

    /// A sampler, to be checked against what is true here.
    pub(super) fn subject<'v>(&'v self, sampler: &'v dyn AnySampler) -> Subject<'v> {
        let Self { stage, options, frame, receivers, truths, .. } = self;
        Subject { stage, options, frame, receivers, truths, sampler }
    }

    /// The same where statistics can look.
    pub(super) fn bright_subject<'v>(&'v self, sampler: &'v dyn AnySampler) -> Subject<'v> {
        let (receivers, truths) = self.bright();
        Subject { receivers, truths, ..self.subject(sampler) }
    }

    /// The same with other numbers and more of them.
    pub(super) fn second(&self) -> &Self {
        self.second.get_or_init(|| {
            let options = VerifyOptions {
                draws: self.options.draws * MORE,
                points: self.options.points * MORE as u32,
                seed: hash(&[self.options.seed, u64::from_le_bytes(*b"2nd look")]),
                ..self.options
            };
            Box::new(Self::at(self.stage, &self.receivers, options))
        })
    }
}
