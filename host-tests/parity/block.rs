//! Block least squares against QR over the window: at constant cost, and summed anew.

use super::{Parity, on_all, rounding, rounding_of_stiffness, silent_about_damping};
use crate::reference::{self, Theta};
use palpate::{BlockConfig, BlockLeastSquares, Flags, Recent, UpdateLaw, direct};

const EVERY: usize = 11;

/// Multiples of what rounding may do to a window. SecondOrderSums about a centre that is not the estimate itself lose one
/// bit more than a window that is summed anew about the estimate.
const ANEW: f64 = 4.0;
const RUNNING: f64 = 8.0;

fn running(name: &'static str, window: u16, flat: [f64; 2], growth: f64) {
    agrees(name, &BlockLeastSquares::new(BlockConfig::of(window)).expect("sound settings"), flat, growth);
}

fn summed_anew(name: &'static str, window: u16, flat: [f64; 2]) {
    agrees(name, &direct::BlockLeastSquares::new(BlockConfig::of(window)).expect("sound settings"), flat, ANEW);
}

fn agrees(name: &'static str, law: &impl UpdateLaw, flat: [f64; 2], growth: f64) {
    let window = law.window();
    on_all(
        |_| Parity::new(name, flat, growth),
        EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let mut state = law.initial_state();
            let mut checkpoints = Vec::new();
            let mut damping = 0.0;
            for k in 0..contact.len() {
                let held = damping;
                let step = law.update(&mut state, Recent::of(&contact[..=k]));
                damping = f64::from(step.estimate.damping);
                if k % EVERY != EVERY - 1 || step.flags.contains(Flags::TOO_FEW) {
                    continue;
                }
                let seen = &rows[(k + 1).saturating_sub(window)..=k];
                let batch = if step.flags.contains(Flags::DAMPING_HELD) {
                    assert!(silent_about_damping(seen), "{case}: B was held without need");
                    (Theta::new(reference::stiffness_alone(seen, held), held), rounding_of_stiffness(seen))
                } else {
                    (reference::least_squares(seen), rounding(seen))
                };
                checkpoints.push((step.estimate, batch.0, batch.1));
            }
            parity.contact(case, &checkpoints);
        },
    );
}

#[test]
fn a_long_window() {
    running("bls 300", 300, [2e-6, 1e-5], RUNNING);
    summed_anew("bls 300, summed anew", 300, [2e-6, 1e-5]);
}

#[test]
fn a_short_window() {
    running("bls 50", 50, [2e-6, 1e-5], RUNNING);
    summed_anew("bls 50, summed anew", 50, [2e-6, 1e-5]);
}

#[test]
fn a_window_of_ten_is_judged_by_its_conditioning_alone() {
    // So short a window is summed anew by either.
    running("bls 10", 10, [0.0, 0.0], ANEW);
    summed_anew("bls 10, summed anew", 10, [0.0, 0.0]);
}
