//! Two bodies along a trial, corrected at each encoder row: an extended Kalman filter whose transition is that of the free or of the
//! coupled pair.

use super::innovations::Innovations;
use super::input::Inputs;
use super::law::{DriveLaw, Link, Side};
use super::matrix::{Matrix, exponential, identity, product, propagated, transposed_product};
use super::noise::Noise;
use super::trial::DriveTrial;

/// Number of states of two bodies: motor position and velocity, load position and velocity.
const STATES: usize = 4;

/// A period of the pair's own swing has at least this many substeps.
const SUBSTEPS_PER_RADIAN: f64 = 1.0 / 0.35;

/// Most substeps of a row.
const MOST_SUBSTEPS: f64 = 64.0;

/// Step lengths whose pair is kept at hand.
const REMEMBERED_PAIRS: usize = 8;

/// Share of the disturbance's density that acts on the load: without any the filter would trust its load for ever.
const LOAD_DENSITY_SHARE: f64 = 1e-4;

/// The pair over one step length: a transition and a driving noise apart, and coupled.
struct Pair {
    step: f64,
    substeps: usize,
    /// See [`curving`]; s^2.
    curving: f64,
    transition: [Matrix<STATES>; 2],
    driving: [Matrix<STATES>; 2],
    /// State after the step for a constant force of one on the motor.
    response: [[f64; STATES]; 2],
}

impl Pair {
    fn new(law: &DriveLaw, link: &Link, [on_motor, on_load]: [f64; 2], step: f64) -> Self {
        let (motor, load) = masses(law, link);
        let swing = (link.stiffness * (1.0 / motor + 1.0 / load)).sqrt();
        let substeps = (swing * step * SUBSTEPS_PER_RADIAN).ceil().clamp(1.0, MOST_SUBSTEPS) as usize;
        let short = step / substeps as f64;
        let regimes = [(0.0, 0.0), (link.stiffness, link.damping)];
        let both = regimes.map(|(stiffness, damping)| {
            let rates = [
                [0.0, 1.0, 0.0, 0.0],
                [-stiffness / motor, -(damping + law.viscous) / motor, stiffness / motor, damping / motor],
                [0.0, 0.0, 0.0, 1.0],
                [stiffness / load, damping / load, -stiffness / load, -(damping + link.load_viscous) / load],
            ];
            let once = exponential(&rates, short);
            let mut white = [[0.0; STATES]; STATES];
            white[1][1] = on_motor / (motor * motor);
            white[3][3] = on_load / (load * load);
            // The integral of the driving noise over a substep by the trapezoid rule.
            let half = white.map(|row| row.map(|x| 0.5 * short * x));
            let driving = propagated(&once, &half, &half);
            // The same rule for a constant force: half of the velocity that it gives before the substep, half after.
            let push = |state: [f64; STATES]| -> [f64; STATES] {
                let start = [state[0], state[1] + 0.5 * short / motor, state[2], state[3]];
                let mut after: [f64; STATES] = once.map(|row| row.iter().zip(&start).map(|(a, x)| a * x).sum());
                after[1] += 0.5 * short / motor;
                after
            };
            let (mut all, mut sum, mut response) = (once, driving, push([0.0; STATES]));
            for _ in 1..substeps {
                sum = propagated(&once, &sum, &driving);
                all = product(&once, &all);
                response = push(response);
            }
            (all, sum, response)
        });
        let [apart, coupled] = both;
        Self {
            step,
            substeps,
            curving: curving(swing, short),
            transition: [apart.0, coupled.0],
            driving: [apart.1, coupled.1],
            response: [apart.2, coupled.2],
        }
    }
}

/// What the stretch of a link has to be taken further by, over its own acceleration, s^2, for the mean of its force over a substep: with
/// the stretch in the middle alone a pair that swings by `swing` would do so too fast, sin(angle / 2) = swing step / 2 (L. Verlet, *Phys. Rev.* 159,
/// 1967, 98). With it the swing is exact, and so is a link's stretch at rest (W. Gautschi, *Numer. Math.* 3, 1961, 381).
fn curving(swing: f64, step: f64) -> f64 {
    let half = 0.5 * swing * step;
    let exact = half.sin() / half;
    (1.0 - exact * exact) / (swing * swing)
}

fn masses(law: &DriveLaw, link: &Link) -> (f64, f64) {
    let load = link.load_share * law.inertia;
    (law.inertia - load, load)
}

/// The pair over a row under constant effort and force; tells whether the sides were coupled for most of it.
fn advance_pair(law: &DriveLaw, link: &Link, state: &mut [f64; STATES], input: [f64; 2], pair: &Pair) -> bool {
    let (motor, load) = masses(law, link);
    let short = pair.step / pair.substeps as f64;
    let [effort, force] = input;
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
        let [x, v] = law.advance([x, v], effort - passed, force, motor, short);
        let after = load_v + short * (passed - braked) / load;
        *state = [x, v, load_x + 0.5 * short * (load_v + after), after];
    }
    2 * coupled >= pair.substeps
}

/// A row of the pair's filter, as the smoother needs it.
struct PairRow {
    gain: [f64; STATES],
    coupled: bool,
    pair: usize,
}

/// Two bodies on `link`; with `smooth` the disturbance is smoothed, too.
#[must_use]
pub fn two_bodies(trial: &DriveTrial, law: &DriveLaw, link: Link, noise: &Noise, smooth: bool) -> Innovations {
    let inputs = Inputs::of(trial, law);
    let rows = trial.len();
    let encoder = noise.encoder();
    let measured = if link.encoder == Side::Load { 2 } else { 0 };
    let mut out = Innovations {
        innovation: vec![0.0; rows],
        variance: vec![encoder; rows],
        velocity: vec![0.0; rows],
        ..Innovations::default()
    };
    let densities = [noise.disturbance(), LOAD_DENSITY_SHARE * noise.disturbance() + trial.force_density];
    let mut pairs: Vec<Pair> = Vec::new();
    let mut history: Vec<PairRow> = Vec::with_capacity(if smooth { rows } else { 0 });
    let mut state = [0.0; STATES];
    let mut covariance = [[0.0; STATES]; STATES];
    for row in 0..rows {
        if trial.restart[row] {
            let (position, rate) = (trial.position[row], trial.rate_after(row));
            state = [position, rate, position, rate];
            covariance = unknown_pair(trial, &link, encoder, inputs.effort[(row + 1).min(rows - 1)]);
            if smooth {
                history.push(PairRow { gain: [0.0; STATES], coupled: true, pair: 0 });
            }
            out.velocity[row] = rate;
            continue;
        }
        let step = trial.time[row] - trial.time[row - 1];
        let at = pair_of(&mut pairs, step, 1e-9 * trial.period_s, || Pair::new(law, &link, densities, step));
        let pair = &pairs[at];
        let coupled = advance_pair(law, &link, &mut state, [inputs.effort[row], inputs.force[row]], pair);
        let regime = usize::from(coupled);
        covariance = propagated(&pair.transition[regime], &covariance, &pair.driving[regime]);
        let variance = covariance[measured][measured] + encoder;
        let gain: [f64; STATES] = std::array::from_fn(|of| covariance[of][measured] / variance);
        let innovation = trial.position[row] - state[measured];
        let line = covariance[measured];
        for of in 0..STATES {
            state[of] += gain[of] * innovation;
            for (value, known) in covariance[of].iter_mut().zip(line) {
                *value -= gain[of] * known;
            }
        }
        (out.innovation[row], out.variance[row], out.velocity[row]) = (innovation, variance, state[measured + 1]);
        if smooth {
            history.push(PairRow { gain, coupled, pair: at });
        }
    }
    if smooth {
        (out.disturbance, out.residual) = smoothed_pair(trial, &link, noise, &out, &history, &pairs);
    }
    out
}

/// Place in `pairs` of the one over `step`, to `tolerance`; a new one where none of the latest is.
fn pair_of(pairs: &mut Vec<Pair>, step: f64, tolerance: f64, new: impl FnOnce() -> Pair) -> usize {
    // A clock that jitters has as many steps as rows: only the latest are looked through.
    let oldest = pairs.len().saturating_sub(REMEMBERED_PAIRS);
    let near = |pair: &Pair| (pair.step - step).abs() <= tolerance;
    pairs[oldest..].iter().position(near).map(|latest| oldest + latest).unwrap_or_else(|| {
        pairs.push(new());
        pairs.len() - 1
    })
}

/// Covariance of a pair of which only one encoder row is known: its stretch under `effort`, its place in the play, its velocity.
fn unknown_pair(trial: &DriveTrial, link: &Link, encoder: f64, effort: f64) -> Matrix<STATES> {
    let stretch = effort * link.load_share / link.stiffness;
    let speed = trial.fastest().powi(2) + f64::MIN_POSITIVE;
    let hidden = encoder + 0.25 * link.play * link.play + stretch * stretch;
    let mut covariance = identity::<STATES>();
    let (known, other) = if link.encoder == Side::Load { (2, 0) } else { (0, 2) };
    (covariance[known][known], covariance[other][other]) = (encoder, hidden);
    (covariance[1][1], covariance[3][3]) = (speed, speed);
    covariance
}

/// Disturbance smoother, as that of one body with the pair of each row; and what it leaves of each encoder row.
fn smoothed_pair(
    trial: &DriveTrial,
    link: &Link,
    noise: &Noise,
    pass: &Innovations,
    history: &[PairRow],
    pairs: &[Pair],
) -> (Vec<f64>, Vec<f64>) {
    let measured = if link.encoder == Side::Load { 2 } else { 0 };
    let (mut force, mut residual) = (vec![0.0; trial.len()], vec![0.0; trial.len()]);
    let mut next = [0.0; STATES];
    for row in (0..trial.len()).rev() {
        if trial.restart[row] {
            next = [0.0; STATES];
            continue;
        }
        let PairRow { gain, coupled, pair } = &history[row];
        let pair = &pairs[*pair];
        let along: f64 = gain.iter().zip(&next).map(|(gain, next)| gain * next).sum();
        let mut adjoint = next;
        let weighted = pass.innovation[row] / pass.variance[row] - along;
        residual[row] = noise.encoder() * weighted;
        adjoint[measured] += weighted;
        let regime = usize::from(*coupled);
        let seen: f64 = pair.response[regime].iter().zip(&adjoint).map(|(response, adjoint)| response * adjoint).sum();
        force[row] = noise.disturbance() / pair.step * seen;
        next = transposed_product(&pair.transition[regime], &adjoint);
    }
    (force, residual)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pair with the encoder on its motor, without friction.
    fn pair_law(stiffness: f64) -> (DriveLaw, Link) {
        let link =
            Link { stiffness, damping: 0.0, play: 0.0, load_share: 0.3, load_viscous: 0.0, encoder: Side::Motor };
        (DriveLaw { link: Some(link), ..DriveLaw::nominal(0.6, 0.0, 0.0) }, link)
    }

    /// Steps of a millisecond by a third of a radian of the pair's own swing each, as one substep takes.
    #[test]
    fn a_pair_swings_as_fast_as_its_link_is_stiff() {
        let (law, link) = pair_law(12_000.0);
        let pair = Pair::new(&law, &link, [1.0; 2], 1e-3);
        assert_eq!(pair.substeps, 1);
        let (mut stepped, mut exact) = ([1e-3, 0.0, 0.0, 0.0], [1e-3, 0.0, 0.0, 0.0]);
        for row in 0..500 {
            advance_pair(&law, &link, &mut stepped, [0.0; 2], &pair);
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
        let mut state = [3.0 / 12_000.0, 0.0, 0.0, 0.0];
        for _ in 0..500 {
            advance_pair(&law, &link, &mut state, [3.0, 3.0], &pair);
        }
        assert!((state[0] - state[2] - 3.0 / 12_000.0).abs() < 1e-12, "{state:?}");
    }
}
