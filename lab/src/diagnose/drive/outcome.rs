//! What the recordings say of a drive: the law, its evidence, what else would do, and what is left.

use super::alternatives::Alternative;
use super::fit::Fit;
use super::outside_force::Stretch;
use super::trial::DriveTrial;
use crate::diagnose::evidence::NamedTerm;
use crate::diagnose::verdict::Verdict;

/// Everything found of a drive.
pub struct Outcome {
    /// The trials, as they were looked at.
    pub trials: Vec<DriveTrial>,
    /// How it stands.
    pub verdict: Verdict,
    /// The refitted nominal law.
    pub nominal: Fit,
    /// The law with its terms.
    pub chosen: Fit,
    /// 95 % interval of each of its values.
    pub intervals: Vec<[f64; 2]>,
    /// Covariance of the values by the curvature of the fit; zero for those that were not fitted, empty where it is not known.
    pub covariance: Vec<Vec<f64>>,
    /// The terms that are named.
    pub named: Vec<NamedTerm>,
    /// What else would do.
    pub alternatives: Vec<Alternative>,
    /// Missing force by the rig file as given, by refitted values, and with the named terms, a column a trial.
    pub missing: [Vec<Vec<f64>>; 3],
    /// What the sensors alone would show as missing force, N or N m in root mean square.
    pub expected_noise: f64,
    /// Up to which frequency the missing force is seen, Hz.
    pub band_hz: f64,
    /// Stretches in which something from outside pushes, left out of everything else.
    pub outside_forces: Vec<Stretch>,
    /// Step, m or rad, of the coarser encoder that it was taken for, where only the slower motion follows a law.
    pub coarser_step: Option<f64>,
}

impl Outcome {
    /// Takes the names off the drive's list that the contact tells already; where none is left, nothing is missing in the drive.
    pub fn leave_to_the_contact(&mut self, is_told: impl Fn(&str) -> bool) {
        let model = &self.chosen.model;
        self.named.retain(|term| !is_told(model.terms[term.at].name()));
        if self.named.is_empty() && self.verdict == Verdict::Explained {
            self.verdict = Verdict::Parameters;
        }
    }
}
