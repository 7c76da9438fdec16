//! Descent laws, each step from the library's own estimate before it: left to itself the way down is chaotic.

use super::{Parity, on_all, rounding, silent_about_damping};
use crate::reference::{self, Row, Theta};
use nalgebra::Vector2;
use palpate::{BlockConfig, BlockLeastMeanFourth, BlockLeastMeanSquare, BlockState, Direction, Flags, Law, Recent};

const EVERY: usize = 23;
const WINDOW: usize = 300;

type Step = fn(&[Row], Theta) -> (Vector2<f64>, i32);

/// Each step of `law` against a numeric minimisation along the direction that `direction` gives.
fn step_by_step<L: Law<State = BlockState>>(name: &'static str, law: &L, direction: Step, flat: [f64; 2], growth: f64) {
    on_all(
        || Parity::new(name, flat, growth),
        EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let mut state = law.start();
            let mut checkpoints = Vec::new();
            for k in 0..contact.len() {
                let before = reference::theta(state.estimate);
                let step = law.update(&mut state, Recent::of(&contact[..=k]));
                let nothing_done = step.flags.contains(Flags::TOO_FEW) || step.flags.contains(Flags::HELD);
                if k % EVERY != EVERY - 1 || nothing_done {
                    continue;
                }
                let seen = &rows[(k + 1).saturating_sub(WINDOW)..=k];
                if silent_about_damping(seen) {
                    continue;
                }
                let (along, power) = direction(seen, before);
                let after = before + along * reference::line_minimum(seen, before, along, power);
                checkpoints.push((state.estimate, after, rounding(seen)));
            }
            parity.contact(case, &checkpoints);
        },
    );
}

fn config() -> BlockConfig {
    BlockConfig::of(WINDOW as u16)
}

#[test]
fn a_step_of_mean_square() {
    let law = BlockLeastMeanSquare::new(config()).expect("sound settings");
    step_by_step(
        "blms 300, a step",
        &law,
        |rows, from| (reference::steepest_direction(rows, from, 2), 2),
        [5e-5, 2e-4],
        64.0,
    );
}

#[test]
fn a_step_of_mean_fourth() {
    let law = BlockLeastMeanFourth::new(config(), Direction::SteepestDescent).expect("sound settings");
    step_by_step(
        "blmf 300, a step",
        &law,
        |rows, from| (reference::steepest_direction(rows, from, 4), 4),
        [5e-5, 2e-4],
        64.0,
    );
}

#[test]
fn a_step_of_mean_fourth_along_newton() {
    let law = BlockLeastMeanFourth::new(config(), Direction::Newton).expect("sound settings");
    step_by_step(
        "newton_blmf 300, a step",
        &law,
        |rows, from| (reference::newton_direction(rows, from), 4),
        [2e-6, 1e-5],
        4.0,
    );
}

#[test]
fn newton_steps_on_one_window_end_at_its_whole_minimum() {
    let law = BlockLeastMeanFourth::new(config(), Direction::Newton).expect("sound settings");
    const EVERY: usize = 151;
    on_all(
        || Parity::new("newton_blmf 300, settled", [2e-6, 1e-5], 4.0),
        2 * EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let mut checkpoints = Vec::new();
            for k in (WINDOW.min(contact.len()) - 1..contact.len()).step_by(EVERY) {
                let first = (k + 1).saturating_sub(WINDOW);
                if silent_about_damping(&rows[first..=k]) {
                    continue;
                }
                let mut state = law.start();
                for _ in 0..60 {
                    law.update(&mut state, Recent::of(&contact[first..=k]));
                }
                let seen = &rows[first..=k];
                checkpoints.push((state.estimate, reference::whole_minimum(seen), rounding(seen)));
            }
            if !checkpoints.is_empty() {
                parity.contact(case, &checkpoints);
            }
        },
    );
}
