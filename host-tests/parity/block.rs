//! Block least squares against QR over the window.

use super::{Parity, on_all, rounding, rounding_of_stiffness, silent_about_damping};
use crate::reference::{self, Theta};
use palpate::{BlockConfig, BlockLeastSquares, Flags, Law, Recent};

const EVERY: usize = 11;

fn window_of(name: &'static str, window: u16, flat: [f64; 2]) {
    let law = BlockLeastSquares::new(BlockConfig::of(window)).expect("sound settings");
    on_all(
        || Parity::new(name, flat, 4.0),
        EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let mut state = law.start();
            let mut checkpoints = Vec::new();
            for k in 0..contact.len() {
                let damping = f64::from(state.estimate.damping);
                let step = law.update(&mut state, Recent::of(&contact[..=k]));
                if k % EVERY != EVERY - 1 || step.flags.contains(Flags::TOO_FEW) {
                    continue;
                }
                let seen = &rows[(k + 1).saturating_sub(window.into())..=k];
                let batch = if step.flags.contains(Flags::DAMPING_HELD) {
                    assert!(silent_about_damping(seen), "{case}: B was held without need");
                    (Theta::new(reference::stiffness_alone(seen, damping), damping), rounding_of_stiffness(seen))
                } else {
                    (reference::least_squares(seen), rounding(seen))
                };
                checkpoints.push((state.estimate, batch.0, batch.1));
            }
            parity.contact(case, &checkpoints);
        },
    );
}

#[test]
fn a_long_window() {
    window_of("bls 300", 300, [2e-6, 1e-5]);
}

#[test]
fn a_short_window() {
    window_of("bls 50", 50, [2e-6, 1e-5]);
}

#[test]
fn a_window_of_ten_is_judged_by_its_conditioning_alone() {
    window_of("bls 10", 10, [0.0, 0.0]);
}
