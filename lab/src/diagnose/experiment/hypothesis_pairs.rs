//! The answer and its alternatives, each of which may be the truth.

use rayon::prelude::*;

use super::TriedMotion;
use super::discrepancy::Discrepancy;
use super::hypothesis::Hypothesis;
use super::synthetic_rig::SyntheticRig;
use super::test_motions::TestMotion;
use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::estimation::whitener::Whitener;
use crate::diagnose::signals::filtered_trial::AnalysisTrial;

/// The answer and its alternatives, each on a bench where it is the truth.
pub struct HypothesisPairs<'a> {
    /// The answer.
    pub answer: SyntheticRig<'a>,
    rivals: Vec<SyntheticRig<'a>>,
}

impl<'a> HypothesisPairs<'a> {
    /// Sets `answer` against each of `rivals`.
    #[must_use]
    pub fn new(
        problem: &'a IdentificationProblem,
        whitener: &Whitener,
        answer: Hypothesis,
        rivals: Vec<Hypothesis>,
    ) -> Self {
        let bench = |claim: Hypothesis| SyntheticRig::new(problem, whitener, claim);
        Self { answer: bench(answer), rivals: rivals.into_iter().map(bench).collect() }
    }

    /// What each side leaves of the other along `motion`.
    #[must_use]
    pub fn attempt(&self, motion: TestMotion) -> TriedMotion {
        let (left, reverse) = self.both(&|bench| vec![bench.run(&motion.course)]);
        TriedMotion { motion, left, reverse }
    }

    /// Energy a second in the closest pair along the recorded motions.
    #[must_use]
    pub fn recorded(&self, wider: &[bool]) -> f64 {
        let seconds: f64 =
            self.answer.rerun().iter().map(|trial| trial.contact.len() as f64 * trial.contact.step).sum();
        let (left, reverse) = self.both(&|bench| bench.rerun());
        super::least(&left, &reverse, wider) / seconds
    }

    fn both(
        &self,
        run: &(dyn Fn(&SyntheticRig<'_>) -> Vec<AnalysisTrial> + Sync),
    ) -> (Vec<Discrepancy>, Vec<Discrepancy>) {
        let trials = run(&self.answer);
        let one_way = |rival: &SyntheticRig<'_>| self.answer.left(rival.answer(), &trials);
        let other_way = |rival: &SyntheticRig<'_>| rival.left(self.answer.answer(), &run(rival));
        self.rivals.par_iter().map(|rival| (one_way(rival), other_way(rival))).unzip()
    }
}
