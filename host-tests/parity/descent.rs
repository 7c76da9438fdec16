//! Descent laws, each step from the library's own estimate before it: left to itself the way down is chaotic.

use super::{Parity, on_all, rounding, silent_about_damping};
use crate::reference::{self, RegressionRow, Theta};
use nalgebra::Vector2;
use palpate::{
    BlockConfig, BlockLeastMeanFourth, BlockLeastMeanSquare, Direction, Flags, Impedance, Recent, UpdateLaw, direct,
};

const EVERY: usize = 23;
const WINDOW: usize = 300;

/// How a law keeps its sums: from which sample of a contact on they are compared, and by how much more they may lose than
/// a window that is summed anew. CompensatedSums sums are about a rough centre at the start of a contact: some forty samples where it
/// is dithered, a hundred and fifty where a recorded swing dies away. A power of a residual loses as that power of the ratio
/// of the residuals about the two; until then a step is good to about a percent. In a
/// recorded creep next to nothing tells B from K, and a step along Newton's direction shares that.
struct Kept {
    young: usize,
    simulated: f64,
    recorded: f64,
}

const ANEW: Kept = Kept { young: 0, simulated: 1.0, recorded: 1.0 };
const RUNNING: Kept = Kept { young: 150, simulated: 64.0, recorded: 4096.0 };

type Step = fn(&[RegressionRow], Theta) -> (Vector2<f64>, i32);

/// Each step of `law` against a numeric minimisation along the direction that `direction` gives.
fn step_by_step<L: UpdateLaw>(name: &'static str, law: &L, direction: Step, flat: [f64; 2], growth: f64, kept: Kept) {
    on_all(
        |kind| Parity::new(name, flat, growth * if kind == "simulated" { kept.simulated } else { kept.recorded }),
        EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let mut state = law.initial_state();
            let mut checkpoints = Vec::new();
            let mut estimate = Impedance::ZERO;
            for k in 0..contact.len() {
                let before = reference::theta(estimate);
                let step = law.update(&mut state, Recent::of(&contact[..=k]));
                estimate = step.estimate;
                let nothing_done = step.flags.contains(Flags::TOO_FEW) || step.flags.contains(Flags::HELD);
                if k % EVERY != EVERY - 1 || k < kept.young || nothing_done {
                    continue;
                }
                let seen = &rows[(k + 1).saturating_sub(WINDOW)..=k];
                if silent_about_damping(seen) {
                    continue;
                }
                let (along, power) = direction(seen, before);
                let after = before + along * reference::line_minimum(seen, before, along, power);
                checkpoints.push((estimate, after, rounding(seen)));
            }
            if !checkpoints.is_empty() {
                parity.contact(case, &checkpoints);
            }
        },
    );
}

fn config() -> BlockConfig {
    BlockConfig::of(WINDOW as u16)
}

const SOUND: &str = "sound settings";

#[test]
fn a_step_of_mean_square() {
    let steepest: Step = |rows, from| (reference::steepest_direction(rows, from, 2), 2);
    let running = BlockLeastMeanSquare::new(config()).expect(SOUND);
    step_by_step("blms 300, a step", &running, steepest, [5e-5, 2e-4], 64.0, RUNNING);
    let anew = direct::BlockLeastMeanSquare::new(config()).expect(SOUND);
    step_by_step("blms 300, a step, summed anew", &anew, steepest, [5e-5, 2e-4], 64.0, ANEW);
}

#[test]
fn a_step_of_mean_fourth() {
    let steepest: Step = |rows, from| (reference::steepest_direction(rows, from, 4), 4);
    let running = BlockLeastMeanFourth::new(config(), Direction::SteepestDescent).expect(SOUND);
    step_by_step("blmf 300, a step", &running, steepest, [5e-5, 2e-4], 64.0, RUNNING);
    let anew = direct::BlockLeastMeanFourth::new(config(), Direction::SteepestDescent).expect(SOUND);
    step_by_step("blmf 300, a step, summed anew", &anew, steepest, [5e-5, 2e-4], 64.0, ANEW);
}

#[test]
fn a_step_of_mean_fourth_along_newton() {
    let newton: Step = |rows, from| (reference::newton_direction(rows, from), 4);
    let running = BlockLeastMeanFourth::new(config(), Direction::Newton).expect(SOUND);
    step_by_step("newton_blmf 300, a step", &running, newton, [2e-6, 1e-5], 4.0, RUNNING);
    let anew = direct::BlockLeastMeanFourth::new(config(), Direction::Newton).expect(SOUND);
    step_by_step("newton_blmf 300, a step, summed anew", &anew, newton, [2e-6, 1e-5], 4.0, ANEW);
}

#[test]
fn newton_steps_on_one_window_end_at_its_whole_minimum() {
    let law = direct::BlockLeastMeanFourth::new(config(), Direction::Newton).expect("sound settings");
    const EVERY: usize = 151;
    on_all(
        |_| Parity::new("newton_blmf 300, settled", [2e-6, 1e-5], 4.0),
        2 * EVERY,
        |parity, case, contact| {
            let rows = reference::rows(contact);
            let mut checkpoints = Vec::new();
            for k in (WINDOW.min(contact.len()) - 1..contact.len()).step_by(EVERY) {
                let first = (k + 1).saturating_sub(WINDOW);
                if silent_about_damping(&rows[first..=k]) {
                    continue;
                }
                let mut state = law.initial_state();
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
