//! The answer and its rivals, each of which may be the truth.

use rayon::prelude::*;

use super::Trying;
use super::bench::Bench;
use super::claim::Claim;
use super::library::Motion;
use super::rest::Rest;
use crate::diagnose::bootstrap::problem::Study;
use crate::diagnose::estimation::whitener::Whitener;
use crate::diagnose::signals::filtered_trial::Trial;

/// The answer and its rivals, each on a bench where it is the truth.
pub struct Pairs<'a> {
    /// The answer.
    pub answer: Bench<'a>,
    rivals: Vec<Bench<'a>>,
}

impl<'a> Pairs<'a> {
    /// Sets `answer` against each of `rivals`.
    #[must_use]
    pub fn new(study: &'a Study, whitener: &Whitener, answer: Claim, rivals: Vec<Claim>) -> Self {
        let bench = |claim: Claim| Bench::new(study, whitener, claim);
        Self { answer: bench(answer), rivals: rivals.into_iter().map(bench).collect() }
    }

    /// What each side leaves of the other along `motion`.
    #[must_use]
    pub fn attempt(&self, motion: Motion) -> Trying {
        let (left, reverse) = self.both(&|bench| vec![bench.run(&motion.course)]);
        Trying { motion, left, reverse }
    }

    /// Energy a second in the closest pair along the recorded motions.
    #[must_use]
    pub fn recorded(&self, wider: &[bool]) -> f64 {
        let seconds: f64 =
            self.answer.rerun().iter().map(|trial| trial.contact.len() as f64 * trial.contact.step).sum();
        let (left, reverse) = self.both(&|bench| bench.rerun());
        super::least(&left, &reverse, wider) / seconds
    }

    fn both(&self, run: &(dyn Fn(&Bench<'_>) -> Vec<Trial> + Sync)) -> (Vec<Rest>, Vec<Rest>) {
        let trials = run(&self.answer);
        let one_way = |rival: &Bench<'_>| self.answer.left(rival.answer(), &trials);
        let other_way = |rival: &Bench<'_>| rival.left(self.answer.answer(), &run(rival));
        self.rivals.par_iter().map(|rival| (one_way(rival), other_way(rival))).unzip()
    }
}
