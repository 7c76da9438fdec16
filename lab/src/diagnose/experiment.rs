//! The experiment that would tell the answer from its alternatives.
//!
//! What a motion is worth is what the best-fitting alternative leaves of it, were the answer the truth: T-optimality over pairs,
//! of which the worst counts. The motions stay within what the recordings did, so that the rig has borne it all before.

mod description;
mod discrepancy;
mod hypothesis;
mod hypothesis_pairs;
mod motion_limits;
mod separating_experiment;
mod synthetic_rig;
mod test_motions;
mod trajectory;

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::estimation::whitener::Whitener;
use crate::diagnose::model::Model;
pub use crate::diagnose::thresholds::experiment::DECISIVE_CHI2;
use crate::diagnose::thresholds::experiment::SPEED_FRACTIONS;
use discrepancy::Discrepancy;
use hypothesis::Hypothesis;
use hypothesis_pairs::HypothesisPairs;
use motion_limits::MotionLimits;
pub use separating_experiment::separated_by;
use synthetic_rig::SyntheticRig;
use test_motions::TestMotion;
use trajectory::Trajectory;

/// A trajectory to run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Experiment {
    /// What it is and what it would tell.
    pub text: String,
    /// Seconds.
    pub time: Vec<f64>,
    /// Commanded position.
    pub reference: Vec<f64>,
}

/// A motion that was tried.
struct TriedMotion {
    motion: TestMotion,
    /// What each alternative leaves of it, were the answer true.
    left: Vec<Discrepancy>,
    /// What the answer leaves of it, were each alternative true.
    reverse: Vec<Discrepancy>,
}

impl TriedMotion {
    /// Energy in the closest of the pairs.
    fn least(&self, wider: &[bool]) -> f64 {
        least(&self.left, &self.reverse, wider)
    }

    /// The same a second.
    fn rate(&self, wider: &[bool]) -> f64 {
        self.least(wider) / self.motion.course.seconds()
    }
}

/// Energy in the closest of the pairs. Where a alternative is `wider`, that is, can do all that the answer does, only its own
/// truth could tell them apart.
fn least(left: &[Discrepancy], reverse: &[Discrepancy], wider: &[bool]) -> f64 {
    let both = left.iter().zip(reverse).zip(wider);
    let energy = both.map(|((left, reverse), wider)| if *wider { reverse.energy } else { left.energy });
    energy.fold(f64::INFINITY, f64::min)
}

/// What a motion is worth, in energy a second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InformationRate {
    /// Of the recorded motions.
    pub recorded: f64,
    /// Of the experiment.
    pub designed: f64,
}

/// The experiment that best tells `answer`, a model with its values, from the closest of its `rivals`, and what it is
/// worth; `None` where there is no alternative, or nothing moved.
#[must_use]
pub fn design(
    problem: &IdentificationProblem,
    whitener: &Whitener,
    answer: (&Model, &[f64]),
    rivals: &[(&Model, &[f64])],
) -> Option<(Experiment, InformationRate)> {
    let room = MotionLimits::of(problem, answer.0, answer.1).filter(|_| !rivals.is_empty())?;
    let claims: Vec<Hypothesis> = rivals.iter().map(|rival| Hypothesis::of(problem, rival.0, rival.1)).collect();
    let pairs = HypothesisPairs::new(problem, whitener, Hypothesis::of(problem, answer.0, answer.1), claims);
    let mut tried: Vec<TriedMotion> = bearable(&pairs.answer, room).into_par_iter().map(|m| pairs.attempt(m)).collect();
    let wider: Vec<bool> =
        (0..rivals.len()).map(|at| tried.iter().all(|t| t.left[at].energy < DECISIVE_CHI2)).collect();
    tried.sort_by(|a, b| b.rate(&wider).total_cmp(&a.rate(&wider)));
    let best = best(&pairs, tried, &wider, room)?;
    let worth = InformationRate { recorded: pairs.recorded(&wider), designed: best.rate(&wider) };
    let text = description::text(problem, &pairs.answer, &best, &wider, worth, answer.0, rivals);
    let (time, reference) = sampled(problem, &best.motion.course);
    Some((Experiment { text, time, reference }, worth))
}

/// The first of `tried`, or what it gains from company or from being repeated.
fn best(
    pairs: &HypothesisPairs<'_>,
    tried: Vec<TriedMotion>,
    wider: &[bool],
    room: MotionLimits,
) -> Option<TriedMotion> {
    // Against several alternatives, one motion may do what another leaves undone.
    let both = match tried.as_slice() {
        [first, second, ..] => Some(pairs.attempt(first.motion.then(&second.motion))),
        _ => None,
    };
    let best = tried.into_iter().take(1).chain(both).max_by(|a, b| a.rate(wider).total_cmp(&b.rate(wider)))?;
    let once = best.least(wider);
    let wanted = (2.0 * DECISIVE_CHI2 / once.max(f64::MIN_POSITIVE)).ceil();
    let count = wanted.min((room.seconds / best.motion.course.seconds()).floor());
    if count < 2.0 || once >= DECISIVE_CHI2 || once * count < DECISIVE_CHI2 {
        return Some(best);
    }
    Some(pairs.attempt(best.motion.times(count as usize)))
}

/// Every motion as quick as the force and the effort of the recordings allow, or as slow as it gets.
fn bearable(bench: &SyntheticRig<'_>, room: MotionLimits) -> Vec<TestMotion> {
    let eased = SPEED_FRACTIONS.map(|part| test_motions::motions(room.eased(part)));
    let last = eased.len() - 1;
    let pick = |at: usize| {
        let mut list = eased.iter().enumerate().filter_map(|(ease, list)| Some((ease, list.get(at)?)));
        list.find(|(ease, motion)| *ease == last || bench.bears(&motion.course)).map(|(_, motion)| motion.clone())
    };
    (0..eased[0].len()).into_par_iter().filter_map(pick).collect()
}

/// The reference at the period of the recordings.
fn sampled(problem: &IdentificationProblem, course: &Trajectory) -> (Vec<f64>, Vec<f64>) {
    let period = problem.sampler.contact_filter.period;
    let reference: Vec<f64> = course.rows(period).iter().map(|row| row[0]).collect();
    ((0..reference.len()).map(|row| row as f64 * period).collect(), reference)
}
