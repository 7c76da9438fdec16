//! What is told of a contact beside a force that acts in free motion, too.

use super::criteria::NOTABLE_POWER;
use super::data::Data;
use super::held_out::{Folds, rms};
use super::learned::Learned;
use super::outcome::Outcome;
use super::parasitic_force::ParasiticForce;
use crate::diagnose::verdict::Verdict;

/// What is told of trials from which a parasitic force was taken off.
pub(super) struct BesideForce {
    pub(super) outcome: Outcome,
    pub(super) force: ParasiticForce,
}

impl BesideForce {
    /// The same of the trials that hold the force, in the place of what was told of them `without` it: what is left is left by the rig file and by its refitted
    /// values with the force in it, and by the answer with the force as a part of it. What was told without it stands where this leaves notably more of unseen rows: a
    /// force over the place and a spring that takes it back are likely together, and beyond the rows of one half they are anything.
    pub(super) fn instead_of(self, without: Outcome) -> Outcome {
        let Self { mut outcome, force } = self;
        let data = rows_of(&outcome);
        let unseen = force.unseen(&data, &outcome.chosen, &Folds::of(&data));
        let learned = outcome.learned.as_mut().map(Learned::residual_mut);
        for residual in [&mut outcome.residuals[2]].into_iter().chain(learned) {
            let rows = residual.iter_mut().flatten().zip(unseen.iter().flatten());
            rows.for_each(|(rest, more)| *rest += more);
        }
        if left_unseen(&outcome) > NOTABLE_POWER * left_unseen(&without) {
            return without;
        }
        let [given, refitted, _] = without.residuals;
        (outcome.residuals[0], outcome.residuals[1]) = (given, refitted);
        outcome.trials = without.trials;
        outcome.verdict = if outcome.named.is_empty() { Verdict::Unknown } else { Verdict::PartlyExplained };
        outcome.parasitic = Some(force);
        outcome
    }
}

/// Mean square of what `outcome` leaves of unseen rows, N^2 or (N m)^2.
fn left_unseen(outcome: &Outcome) -> f64 {
    rms(&rows_of(outcome), &outcome.residuals[2]).powi(2)
}

fn rows_of(outcome: &Outcome) -> Data<'_> {
    let (weights, noise) = (outcome.weights.clone(), outcome.noise.clone());
    Data { trials: &outcome.trials, weights, noise, noise_factor: 1.0 }
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::identification::identify;
    use super::super::parasitic_force::Along;
    use super::super::testing::TestContact;
    use super::*;

    /// A plain contact, and a force of 0.1 N a millimetre that is said to act beside it and leaves 1 N more of unseen rows, or a twentieth more: the noise is known to some 15 %.
    #[test]
    fn a_force_with_which_more_is_left_of_unseen_rows_is_not_told() {
        let trials = || [1, 2].map(|seed| TestContact::PLAIN.trial(seed)).to_vec();
        let told = || {
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {})
                .expect("a contact")
        };
        let force = || ParasiticForce { along: Along::Place, origin: 0.0, unit: 1e-3, zero: 0.0, parts: vec![0.1] };
        let mut worse = told();
        worse.residuals[2].iter_mut().flatten().for_each(|rest| *rest += 1.0);
        assert!(BesideForce { outcome: worse, force: force() }.instead_of(told()).parasitic.is_none());
        let mut alike = told();
        alike.residuals[2].iter_mut().flatten().for_each(|rest| *rest *= 1.05);
        assert!(BesideForce { outcome: alike, force: force() }.instead_of(told()).parasitic.is_some());
    }
}
