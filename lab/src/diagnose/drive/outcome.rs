//! What the recordings say of a drive: the law, its evidence, what else would do, and what is left.

use super::alternatives::Alternative;
use super::fit::Fit;
use super::model::index;
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
    /// Names in whose place a force of no law does far better, and which are not told for it.
    pub rivalled: Vec<&'static str>,
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
    /// Inertia beyond the force sensor, kg or kg m^2, with its 95 % interval, where the contact told it and the law does not hold it: the reading that
    /// was taken off the effort held its inertial force, and the law's inertia is the rest.
    pub beyond_the_sensor: Option<(f64, [f64; 2])>,
}

impl Outcome {
    /// Inertia of all that the drive moves, kg or kg m^2, with its 95 % interval. What is beyond the force sensor is told by the force, the rest by the
    /// effort. Their errors are taken as independent; what an error of the force adds to the one it takes from the other, so that the interval is rather
    /// too wide.
    #[must_use]
    pub fn inertia(&self) -> (f64, [f64; 2]) {
        let (rest, ends) = (self.chosen.values[index::INERTIA], self.intervals[index::INERTIA]);
        let Some((beyond, beyond_ends)) = self.beyond_the_sensor else { return (rest, ends) };
        let whole = rest + beyond;
        let [below, above] = [0, 1].map(|end| (ends[end] - rest).hypot(beyond_ends[end] - beyond));
        (whole, [whole - below, whole + above])
    }

    /// Takes the names off the drive's list that the contact tells already; where none is left, nothing is missing in the drive.
    pub fn leave_to_the_contact(&mut self, is_told: impl Fn(&str) -> bool) {
        let model = &self.chosen.model;
        self.named.retain(|term| !is_told(model.terms[term.at].name()));
        if self.named.is_empty() && self.verdict == Verdict::Explained {
            self.verdict = Verdict::Parameters;
        }
    }
}
