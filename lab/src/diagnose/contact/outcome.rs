//! What the recordings say of a contact: the law, its evidence, what else would do, and what is left.

use super::alternative::Alternative;
use super::crosstalk::Crosstalk;
use super::fit::Fit;
use super::learned::Learned;
use super::parasitic_force::ParasiticForce;
use super::rival_curves::Rival;
use super::trial::ContactTrial;
use crate::diagnose::evidence::NamedTerm;
use crate::diagnose::verdict::Verdict;
use crate::recording::Recording;
use crate::recording::assemble::interpolated;

/// Everything found of a contact.
pub struct Outcome {
    /// The trials, as they were looked at.
    pub trials: Vec<ContactTrial>,
    /// Variance of each row by sensors and the motion's uncertainty; infinite where a row is no measurement of the law.
    pub noise: Vec<Vec<f64>>,
    /// What each row is worth: one over its expected deviation.
    pub weights: Vec<Vec<f64>>,
    /// Power of the sensors' noise over that of their noise from row to row, at least one: more where it remembers.
    pub noise_memory: f64,
    /// How it stands.
    pub verdict: Verdict,
    /// The refitted nominal law.
    pub nominal: Fit,
    /// Terms that the rig file already holds.
    pub known_terms: usize,
    /// The law with its effects.
    pub chosen: Fit,
    /// 95 % interval of each of its values.
    pub intervals: Vec<[f64; 2]>,
    /// Covariance of the values by the curvature of the fit; zero for those that were not fitted, empty where it is not known.
    pub covariance: Vec<Vec<f64>>,
    /// The effects that are named.
    pub named: Vec<NamedTerm>,
    /// What else would do.
    pub alternatives: Vec<Alternative>,
    /// What of the effort the force reading seems to hold, where that is likelier than the effects that were found.
    pub crosstalk: Option<Crosstalk>,
    /// Free curves that do better than an effect that was found, or than the nominal law alone.
    pub rivals: Vec<Rival>,
    /// A force of free motion, where the contact is likelier without it. No effect of the list is that; trials, laws and residuals are those
    /// of the force without it.
    pub parasitic: Option<ParasiticForce>,
    /// For what is left beside what is named, where that is notable: a learned element, where unseen rows pay for one.
    pub learned: Option<Learned>,
    /// Measured less predicted force by the rig file as given, by refitted values, and with the named effects, on rows that no fit saw, a
    /// column a trial.
    pub residuals: [Vec<Vec<f64>>; 3],
    /// What the sensors alone leave, N or N m in root mean square.
    pub expected_noise: f64,
    /// Whether most of it is the position's.
    pub is_limited_by_rounding: bool,
}

impl Outcome {
    /// What is left of rows that taught nothing with what was learned and has no name, a column a trial: with the learned element, or where nothing is named with the
    /// force of free motion; `None` where there is neither.
    #[must_use]
    pub fn left_by_learned(&self) -> Option<&Vec<Vec<f64>>> {
        let by_force = (self.parasitic.is_some() && self.named.is_empty()).then_some(&self.residuals[2]);
        self.learned.as_ref().map(Learned::residual).or(by_force)
    }

    /// Takes the user's own simulations, one a trial in their order, for what the rig file as given predicts.
    pub fn compare_with(&mut self, simulations: &[Recording]) {
        for ((trial, run), residual) in self.trials.iter().zip(simulations).zip(&mut self.residuals[0]) {
            let Some(force) = &run.force else { continue };
            let [Some(first), Some(last)] = [run.time.first(), run.time.last()] else { continue };
            // Where the simulation ends before the trial it stays as it ended.
            let clock: Vec<f64> = trial.time.iter().map(|time| (first + time).min(*last)).collect();
            let simulated = interpolated(&run.time, force, &clock);
            for ((rest, measured), simulated) in residual.iter_mut().zip(&trial.force).zip(simulated) {
                *rest = measured - simulated;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::identification::identify;
    use super::super::testing::TestContact;

    #[test]
    fn a_simulation_that_is_the_recording_leaves_nothing() {
        let trials = || [1, 2].map(|seed| TestContact::PLAIN.trial(seed)).to_vec();
        let mut outcome =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        let before = outcome.residuals[0].clone();
        outcome.compare_with(&[TestContact::PLAIN.recording(1)]);
        assert!(outcome.residuals[0][0].iter().all(|rest| rest.abs() < 1e-12));
        assert_eq!(outcome.residuals[0][1], before[1]);
    }
}
