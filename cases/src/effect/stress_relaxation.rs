//! `stress_relaxation`: springs that lead into dampers.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::stress_relaxation::MaxwellBranch;
use crate::rng::{CaseRng, log_uniform};
use crate::scale::Unit;

/// `stress_relaxation`, of one or two branches.
#[derive(Debug)]
pub struct StressRelaxation {
    times: Vec<f64>,
    shares: Vec<f64>,
    unit: f64,
}

impl StressRelaxation {
    /// With time constants that the holds of the trials can show.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let unit = 0.1 * motion.nominal.stiffness;
        let time = log_uniform(rng, 0.04, 2.0);
        if rng.random_bool(0.6) {
            return Self { times: vec![time], shares: vec![1.0], unit };
        }
        let share = rng.random_range(0.4..0.7);
        Self { times: vec![time, time * rng.random_range(5.0..10.0)], shares: vec![share, 1.0 - share], unit }
    }
}

impl EffectShape for StressRelaxation {
    fn form(&self) -> &'static str {
        if self.times.len() == 1 { "one Maxwell branch" } else { "two Maxwell branches" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 50.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let names = [("branch_stiffness", "time_constant"), ("second_branch_stiffness", "second_time_constant")];
        let branches = self.times.iter().zip(&self.shares).zip(names);
        branches
            .flat_map(|((time, share), (stiffness_name, time_name))| {
                let stiffness = size * self.unit * share;
                [
                    EffectParameter::new(stiffness_name, stiffness, Unit::Stiffness),
                    EffectParameter::new(time_name, *time, Unit::Time),
                ]
            })
            .collect()
    }
}

impl SimulatedEffect for StressRelaxation {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let branches = self.times.iter().zip(&self.shares);
        model.contact.branches =
            branches.map(|(time, share)| MaxwellBranch::new(size * self.unit * share, *time)).collect();
    }
}
