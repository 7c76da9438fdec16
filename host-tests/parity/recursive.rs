//! Recursive laws against the batch problems that they claim to solve.

use super::{EPS, Parity, on_all, rounding};
use crate::reference::{self, Prior, SelfPerturbing, Theta};
use palpate::{
    Ewrls, EwrlsConfig, Gradient, GradientConfig, Impedance, Observation, Recent, ResetRls, ResetRlsConfig, Sprls,
    SprlsConfig, UpdateLaw,
};

/// Observations from one comparison to the next; no divisor of the dither's period.
const EVERY: usize = 37;

/// The limit of the covariance is no part of the batch problem, so it is put out of reach.
const NO_LIMIT: f32 = 1e9;

/// Recursive laws against `batch`, which is given all rows so far and the number of rows of the memory.
fn recursive<L: UpdateLaw>(
    law: &L,
    estimate: impl Fn(&L::State) -> Impedance,
    contact: &[Observation],
    mut reference: impl FnMut(usize) -> Theta,
) -> Vec<(Impedance, Theta, Theta)> {
    let rows = reference::rows(contact);
    let mut state = law.initial_state();
    let mut checkpoints = Vec::new();
    for k in 0..contact.len() {
        law.update(&mut state, Recent::of(&contact[k..=k]));
        if k % EVERY == EVERY - 1 {
            checkpoints.push((estimate(&state), reference(k), rounding(&rows[(k + 1).saturating_sub(300)..=k])));
        }
    }
    checkpoints
}

fn weighted_least_squares(name: &'static str, forgetting: f32, covariance: f32, flat: [f64; 2]) {
    let config =
        EwrlsConfig { forgetting_factor: forgetting, initial_covariance: covariance, covariance_limit: NO_LIMIT };
    let law = Ewrls::new(config).expect("sound settings");
    let prior = Some(Prior { at: Theta::zeros(), covariance: covariance.into() });
    on_all(
        |_| Parity::new(name, flat, 4.0),
        EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let batch = |k: usize| reference::weighted(&rows[..=k], forgetting.into(), prior);
            parity.contact(case, &recursive(&law, |s| s.estimate, contact, batch));
        },
    );
}

#[test]
fn plain_least_squares_is_the_batch_with_its_prior() {
    weighted_least_squares("rls, P0 10", 1.0, 10.0, [1e-4, 1e-4]);
}

#[test]
fn forgetting_is_the_weighted_batch_with_its_faded_prior() {
    weighted_least_squares("ewrls .9967, P0 10", 0.9967, 10.0, [2e-5, 5e-5]);
    weighted_least_squares("ewrls .9967, P0 1e5", 0.9967, 1e5, [2e-5, 5e-5]);
    weighted_least_squares("ewrls .98, P0 1e5", 0.98, 1e5, [2e-5, 5e-5]);
}

#[test]
fn without_its_start_it_is_the_weighted_batch_alone() {
    let law = Ewrls::new(EwrlsConfig::default()).expect("sound settings");
    let lambda = f64::from(EwrlsConfig::default().forgetting_factor);
    for trial in crate::simulator::Trial::environments() {
        for contact in
            &super::Case::new(trial.name.to_owned(), trial.samples(1), palpate::FrontEndConfig::BENCH).contacts
        {
            let (rows, mut state, mut far) = (reference::rows(contact), law.initial_state(), 0.0_f64);
            assert_eq!(state.without_start(), None, "nothing has been told");
            for k in 0..contact.len() {
                law.update(&mut state, Recent::of(&contact[k..=k]));
                if k % EVERY != EVERY - 1 {
                    continue;
                }
                let got = reference::theta(state.without_start().expect("both are told"));
                let want = reference::weighted(&rows[..=k], lambda, None);
                far = far.max((reference::theta(state.estimate).x - want.x).abs() / want.x);
                for (axis, name) in ["K", "B"].into_iter().enumerate() {
                    let error = (got[axis] - want[axis]).abs() / want[axis].abs();
                    // What is taken off is many times what stays in the first samples, and is rounded with it; B is told from a
                    // rate that is small beside the depth.
                    let [early, late] = [[0.02, 0.1], [2e-3, 0.01]].map(|bounds| bounds[axis]);
                    let bound = if k < 300 { early } else { late };
                    assert!(error < bound, "{} sample {k}, {name}: {} for {}", trial.name, got[axis], want[axis]);
                }
            }
            assert!(far > 0.3, "{}: the estimate with its start was never far off, {far}", trial.name);
        }
    }
}

#[test]
fn a_reset_makes_the_estimate_the_prior_of_the_next_batch() {
    let config = ResetRlsConfig::default();
    let law = ResetRls::new(config).expect("sound settings");
    let interval = usize::from(config.reset_interval);
    on_all(
        |_| Parity::new("reset_rls 300, P0 10", [5e-5, 5e-5], 4.0),
        EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let batch = |k: usize| {
                let mut prior = Prior { at: Theta::zeros(), covariance: config.initial_covariance.into() };
                let mut blocks = rows[..=k].chunks(interval).peekable();
                while let Some(block) = blocks.next_if(|block| block.len() == interval) {
                    prior.at = reference::weighted(block, 1.0, Some(prior));
                }
                blocks.next().map_or(prior.at, |rest| reference::weighted(rest, 1.0, Some(prior)))
            };
            parity.contact(case, &recursive(&law, |s| s.recursion.estimate, contact, batch));
        },
    );
}

#[test]
fn self_perturbation_in_information_form() {
    let config = SprlsConfig { covariance_limit: NO_LIMIT, ..SprlsConfig::default() };
    let law = Sprls::new(config).expect("sound settings");
    on_all(
        |_| Parity::new("sprls 100, 2", [2e-5, 5e-5], 4.0),
        EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let mut batch = SelfPerturbing::new(
                config.initial_covariance.into(),
                config.perturbation_gain.into(),
                config.perturbation_sensitivity.into(),
            );
            let mut state = law.initial_state();
            let mut checkpoints = Vec::new();
            for k in 0..contact.len() {
                let library = law.perturbation(state.innovation_before) / config.perturbation_gain;
                let level = batch.level();
                // The innovation itself is known to some roundings of the force, the level to twice that over it.
                let blur = 1e-4_f64.max(64.0 * EPS * level.sqrt() * rows[k.saturating_sub(1)].force.abs());
                let tie = (level.fract() - 0.5).abs() < blur;
                batch.update(rows[k], tie.then_some(library.into()));
                law.update(&mut state, Recent::of(&contact[k..=k]));
                if k % EVERY == EVERY - 1 {
                    let rounding = rounding(&rows[(k + 1).saturating_sub(300)..=k]);
                    checkpoints.push((state.recursion.estimate, batch.estimate, rounding));
                }
            }
            parity.contact(case, &checkpoints);
        },
    );
}

#[test]
fn the_gradient_law_is_the_minimiser_that_it_claims() {
    let config = GradientConfig::default();
    let law = Gradient::new(config).expect("sound settings");
    let gains = Theta::new(config.stiffness_gain.into(), config.damping_gain.into());
    on_all(
        |_| Parity::new("gradient 100, 1", [2e-5, 2e-5], 0.0),
        EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let (mut estimate, mut seen) = (Theta::zeros(), 0);
            let implicit = |k: usize| {
                for row in &rows[seen..=k] {
                    estimate = reference::gradient_step(*row, estimate, gains);
                }
                seen = k + 1;
                estimate
            };
            parity.contact(case, &recursive(&law, |s| s.estimate, contact, implicit));
        },
    );
}
