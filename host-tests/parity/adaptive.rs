//! Laws that begin again at a change, against the batch of what came since; directional forgetting by its covariance.

use super::{EPS, Parity, on_all, rounding};
use crate::reference::{self, Cusum, Directional, Theta};
use palpate::{
    AdaptiveWindow, AdaptiveWindowConfig, BlockConfig, BlockLeastSquares, CusumRls, CusumRlsConfig, DirectionalRls,
    DirectionalRlsConfig, Flags, Impedance, Observation, Prior, Recent, UpdateLaw,
};

const EVERY: usize = 17;

/// Rounding that the batch's own prior, as far from the data as 1e8 to 1, adds to that of [`rounding`].
const GROWTH: f64 = 32.0;

fn ridge() -> [f64; 2] {
    let ridge = Prior::default().ridge();
    [ridge.stiffness.into(), ridge.damping.into()]
}

fn pair(at: Theta) -> [f64; 2] {
    [at.x, at.y]
}

#[test]
fn what_begins_again_is_the_batch_since_the_change_about_the_estimate_before_it() {
    let config = CusumRlsConfig::default();
    let law = CusumRls::new(config).expect("sound settings");
    on_all(
        |_| Parity::new("cusum_rls", [2e-5, 5e-5], GROWTH),
        EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let (mut state, mut begin, mut at) = (law.initial_state(), 0, Theta::zeros());
            let (mut checkpoints, mut limited) = (Vec::new(), false);
            let mut sum = Cusum::default();
            for k in 0..contact.len() {
                let before = reference::theta(state.recursion.estimate);
                let step = law.update(&mut state, Recent::of(&contact[k..=k]));
                let changed = step.flags.contains(Flags::CHANGED);
                let (expected, near) = sum.update(&config.change, step.innovation.into());
                // A rise this near to the threshold is on either side of it by rounding.
                assert!(
                    changed == expected || near < 1e-4,
                    "{case}, {k}: changed {changed}, {near} from the threshold"
                );
                if changed {
                    (begin, at, limited) = (k, before, false);
                }
                // A covariance that was cut is no batch.
                limited |= step.flags.intersects(Flags::LIMITED | Flags::RESET);
                if k % EVERY == EVERY - 1 && k >= begin + 20 && !limited {
                    let since = &rows[begin..=k];
                    let lambda = f64::from(config.forgetting_factor);
                    let batch = reference::ridged(&reference::columns(since), lambda, &pair(at), &ridge());
                    checkpoints.push((step.estimate, Theta::new(batch[0], batch[1]), rounding(since)));
                }
            }
            if !checkpoints.is_empty() {
                parity.contact(case, &checkpoints);
            }
        },
    );
}

fn shrinking(name: &'static str, config: AdaptiveWindowConfig) {
    let law = AdaptiveWindow::new(config).expect("sound settings");
    on_all(
        |_| Parity::new(name, [2e-6, 1e-5], GROWTH),
        EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let (mut state, mut length, mut checkpoints) = (law.initial_state(), 0, Vec::new());
            for k in 0..contact.len() {
                let step = law.update(&mut state, Recent::of(&contact[..=k]));
                let changed = step.flags.contains(Flags::CHANGED);
                length = if changed { usize::from(config.shortest) } else { length + 1 };
                let seen = &rows[(k + 1).saturating_sub(length.min(law.window()))..=k];
                if k % EVERY == EVERY - 1 && seen.len() >= 20 && !step.flags.contains(Flags::DAMPING_HELD) {
                    let batch = reference::ridged(&reference::columns(seen), 1.0, &[0.0; 2], &ridge());
                    checkpoints.push((step.estimate, Theta::new(batch[0], batch[1]), rounding(seen)));
                }
            }
            if !checkpoints.is_empty() {
                parity.contact(case, &checkpoints);
            }
        },
    );
}

#[test]
fn a_window_that_shrinks_is_the_batch_of_what_it_holds() {
    shrinking("adaptive_bls 300", AdaptiveWindowConfig::default());
    shrinking("adaptive_bls 50", AdaptiveWindowConfig::of(50));
}

#[test]
fn a_ridge_is_the_batch_with_two_more_rows_from_the_second_sample_on() {
    let config = BlockConfig { minimum_fill: 2, prior: Some(Prior::default()), ..BlockConfig::of(50) };
    let law = BlockLeastSquares::new(config).expect("sound settings");
    let contact: Vec<_> = (0..40)
        .map(|k| {
            let (x, v) = (1e-3 + 2e-4 * k as f32, 0.1 + 0.05 * (0.4 * k as f32).sin());
            Observation { penetration: x, rate: v, force: 300.0 * x + 5.0 * v }
        })
        .collect();
    let mut state = law.initial_state();
    for k in 0..contact.len() {
        let got = reference::theta(law.update(&mut state, Recent::of(&contact[..=k])).estimate);
        if k == 0 {
            assert_eq!(got, Theta::zeros(), "one sample is too few");
            continue;
        }
        let want = reference::ridged(&reference::columns(&reference::rows(&contact[..=k])), 1.0, &[0.0; 2], &ridge());
        // The angle between two columns that are nearly one line magnifies rounding by a thousand.
        for axis in [0, 1] {
            let error = (got[axis] - want[axis]).abs() / [300.0, 5.0][axis];
            assert!(error < 1e4 * EPS, "sample {k}, parameter {axis}: {} for {}", got[axis], want[axis]);
        }
    }
}

#[test]
fn directional_forgetting_by_its_covariance() {
    let config = DirectionalRlsConfig::default();
    let law = DirectionalRls::new(config).expect("sound settings");
    let variances = Prior::default().variances();
    let variances = Theta::new(variances.stiffness.into(), variances.damping.into());
    for trial in crate::simulator::Trial::environments() {
        for contact in
            &super::Case::new(trial.name.to_owned(), trial.samples(1), palpate::FrontEndConfig::BENCH).contacts
        {
            let (mut state, mut double) =
                (law.initial_state(), Directional::new(config.forgetting_factor.into(), variances));
            for (k, o) in contact.iter().enumerate() {
                law.update(&mut state, Recent::of(std::slice::from_ref(o)));
                double.update((*o).into());
                let Impedance { stiffness, damping } = state.estimate;
                // Information that is never visited keeps its rounding; a thousandth of the estimate is a hundredth of its noise.
                if k > 100 {
                    let scale = double.estimate.abs();
                    let error = Theta::new(f64::from(stiffness), f64::from(damping)) - double.estimate;
                    assert!(
                        error.x.abs() <= 1e-3 * scale.x,
                        "{} {k}: K {stiffness}, {}",
                        trial.name,
                        double.estimate.x
                    );
                    assert!(
                        error.y.abs() <= 1e-3 * scale.y + 0.02,
                        "{} {k}: B {damping}, {}",
                        trial.name,
                        double.estimate.y
                    );
                }
            }
        }
    }
}
