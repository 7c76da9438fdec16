//! The motion of two masses over a row: on a flank, in the play, and against dry friction.

use super::law::{Acting, DriveLaw, Link};
use super::presliding::Slips;
use super::two_mass_system::{Pair, STATES, masses};

/// What pushes the pair through a row, N or N m.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pushes {
    /// On the motor, less the load that is known.
    pub effort: f64,
    /// Of the load on what it touches.
    pub force: f64,
    /// What is borne beside the weight of the law: friction can grow with it.
    pub borne: f64,
}

/// The pair after a row over which it stays coupled and its motor goes one way, exactly but for loads and friction, which are those in the middle;
/// `None` where it does not.
#[must_use]
pub fn after_coupled_row(
    law: &DriveLaw,
    link: &Link,
    state: &[f64; STATES],
    Pushes { effort, force, borne }: Pushes,
    pair: &Pair,
) -> Option<[f64; STATES]> {
    let side = |state: &[f64; STATES]| {
        let ahead = state[0] - state[2];
        if link.play == 0.0 || ahead.abs() >= 0.5 * link.play { ahead.signum() } else { 0.0 }
    };
    let (flank, direction) = (side(state), state[1].signum());
    if flank == 0.0 || (law.friction.acts() && state[1] == 0.0) {
        return None;
    }
    let from_play = flank * 0.5 * link.play * link.stiffness;
    let under = |position: f64, speed: f64| {
        let level = |borne| law.friction.level(speed.abs(), law.borne(borne, position));
        let against = if law.friction.acts() { direction * level(borne) } else { 0.0 };
        pair.coupled.after(state, [effort - law.load(position) - against + from_play, -force - from_play])
    };
    let goes_on = |after: &[f64; STATES]| {
        (!law.friction.acts() || after[1] * direction > 0.0) && (link.play == 0.0 || side(after) == flank)
    };
    let first = under(state[0] + 0.5 * pair.step * state[1], state[1]);
    if !goes_on(&first) {
        return None;
    }
    let after = under(0.5 * (state[0] + first[0]), 0.5 * (state[1] + first[1]));
    goes_on(&after).then_some(after)
}

/// The pair over a row under constant effort and force; tells whether the sides were coupled for most of it.
pub fn advance_pair(
    law: &DriveLaw,
    link: &Link,
    state: &mut [f64; STATES],
    slips: &mut Slips,
    pushes: Pushes,
    pair: &Pair,
) -> bool {
    if pair.substeps > 1
        && law.friction.presliding == 0.0
        && let Some(after) = after_coupled_row(law, link, state, pushes, pair)
    {
        *state = after;
        return true;
    }
    let (motor, load) = masses(law, link);
    let short = pair.step / pair.substeps as f64;
    let Pushes { effort, force, borne } = pushes;
    let mut coupled = 0;
    for _ in 0..pair.substeps {
        let [x, v, load_x, load_v] = *state;
        let now = link.transmitted(x - load_x, v - load_v);
        // Midpoint rule; a motor that dry friction may hold is predicted to keep its velocity.
        let pushed = if law.friction.acts() { 0.0 } else { (effort - now - law.viscous * v) / motor };
        let (middle_v, middle_load_v) =
            (v + 0.5 * short * pushed, load_v + 0.5 * short * (now - force - link.load_viscous * load_v) / load);
        let ahead = x + 0.5 * short * v - load_x - 0.5 * short * load_v;
        let mid = link.transmitted(ahead, middle_v - middle_load_v);
        let is_held = law.friction.acts() && v == 0.0;
        let motor_rate = if is_held { 0.0 } else { (effort - mid - law.viscous * middle_v) / motor };
        let braked = force + link.load_viscous * middle_load_v;
        let stretch_rate = motor_rate - (mid - braked) / load;
        let passed = link.transmitted(ahead + pair.curving * stretch_rate, middle_v - middle_load_v);
        coupled += usize::from(ahead.abs() >= 0.5 * link.play);
        let acting = Acting { push: effort - passed, borne, friction_factor: 1.0, viscous_factor: 1.0 };
        let [x, v] = law.advance([x, v], slips, &acting, motor, short);
        let after = load_v + short * (passed - braked) / load;
        *state = [x, v, load_x + 0.5 * short * (load_v + after), after];
    }
    2 * coupled >= pair.substeps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::testing::pair_law;

    /// Steps of a millisecond by a third of a radian of the pair's own swing each, as one substep takes.
    #[test]
    fn a_pair_swings_as_fast_as_its_link_is_stiff() {
        let (law, link) = pair_law(12_000.0);
        let pair = Pair::new(&law, &link, [1.0; 2], 1e-3);
        assert_eq!(pair.substeps, 1);
        let (mut stepped, mut exact) = ([1e-3, 0.0, 0.0, 0.0], [1e-3, 0.0, 0.0, 0.0]);
        for row in 0..500 {
            advance_pair(&law, &link, &mut stepped, &mut Slips::default(), Pushes::default(), &pair);
            exact = pair.transition[1].map(|line| line.iter().zip(&exact).map(|(a, x)| a * x).sum());
            let stretch = |state: [f64; STATES]| state[0] - state[2];
            // By the stretch in the middle of a step alone the angle would be wrong by 0.0012 a row, 0.6 at the end. What is left is
            // where the energy of a step is counted, (swing step)^2 / 24 of the stretch.
            assert!((stretch(stepped) - stretch(exact)).abs() < 1e-5, "{row} {} {}", stretch(stepped), stretch(exact));
        }
    }

    #[test]
    fn a_load_that_is_pushed_stretches_its_link_by_force_over_stiffness() {
        let (law, link) = pair_law(12_000.0);
        let pair = Pair::new(&law, &link, [1.0; 2], 1e-3);
        // Pulled from both ends by 3 N.
        let pulled = Pushes { effort: 3.0, force: 3.0, borne: 3.0 };
        let mut state = [3.0 / 12_000.0, 0.0, 0.0, 0.0];
        for _ in 0..500 {
            advance_pair(&law, &link, &mut state, &mut Slips::default(), pulled, &pair);
        }
        assert!((state[0] - state[2] - 3.0 / 12_000.0).abs() < 1e-12, "{state:?}");
    }

    /// A row of 1.6 rad of the pair's swing, at once and in a thousand steps of the other rule, on a flank of a play and against dry friction.
    #[test]
    fn a_coupled_row_at_once_is_a_thousand_short_ones() {
        let (law, link) = pair_law(300_000.0);
        let link = Link { damping: 4.0, play: 1e-3, load_viscous: 1.0, ..link };
        let mut law = DriveLaw { viscous: 2.0, link: Some(link), ..law };
        (law.friction.coulomb, law.weight.constant) = (3.0, 1.5);
        let (row, short) = (Pair::new(&law, &link, [1.0; 2], 1e-3), Pair::new(&law, &link, [1.0; 2], 1e-6));
        assert!(row.substeps > 4 && short.substeps == 1);
        let start = [0.61e-3, 0.2, 0.0, 0.19];
        let pushes = Pushes { effort: 40.0, force: 5.0, borne: 5.0 };
        let at_once = after_coupled_row(&law, &link, &start, pushes, &row).expect("it stays coupled");
        let mut stepped = start;
        (0..1000).for_each(|_| {
            advance_pair(&law, &link, &mut stepped, &mut Slips::default(), pushes, &short);
        });
        // The short steps err by the square of their own swing, (1.6e-3)^2 / 24, of what moves within the row: 1e-3 of 0.2 m/s.
        for (state, scale) in [(0, 2e-4), (1, 0.2), (2, 2e-4), (3, 0.2)] {
            assert!((at_once[state] - stepped[state]).abs() < 1e-6 * scale, "{state}: {at_once:?} {stepped:?}");
        }
    }

    #[test]
    fn a_row_that_leaves_its_flank_or_turns_is_none_at_once() {
        let (law, link) = pair_law(300_000.0);
        let link = Link { play: 1e-3, ..link };
        let mut law = DriveLaw { link: Some(link), ..law };
        let row = Pair::new(&law, &link, [1.0; 2], 1e-3);
        let alone = |law: &DriveLaw, state: [f64; STATES]| {
            after_coupled_row(law, &link, &state, Pushes::default(), &row).is_none()
        };
        // In the play; leaving it at 2 m/s, four tenths of a millimetre beyond its end.
        assert!(alone(&law, [0.2e-3, 0.1, 0.0, 0.1]) && alone(&law, [0.9e-3, -1.0, 0.0, 1.0]));
        law.friction.coulomb = 5.0;
        // 5 N on 0.42 kg take 12 mm/s in a row.
        assert!(alone(&law, [0.5e-3, 1e-3, 0.0, 0.0]));
    }
}
