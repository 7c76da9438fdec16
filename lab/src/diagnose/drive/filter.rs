//! The law driven along a trial and corrected at each encoder row: innovations, their variance, and the smoothed disturbance.
//!
//! One body has a linear covariance, so its Kalman gains are those of mass, viscous friction and disturbance; friction at rest and
//! position-dependent loads act on the mean alone (innovations form, Ljung, *System Identification*, 1999, section 4.3). Two bodies
//! are followed by an extended Kalman filter whose transition is that of the free or of the coupled pair.

use super::input::Inputs;
use super::law::{DriveLaw, Link, Side};
use super::matrix::{Matrix, exponential, identity, product, propagated, transposed_product};
use super::noise::Noise;
use super::trial::DriveTrial;

/// What the filter makes of a trial, row by row.
#[derive(Debug, Clone, Default)]
pub struct Innovations {
    /// Encoder row less its prediction, m or rad; zero where a stretch starts.
    pub innovation: Vec<f64>,
    /// Variance of it.
    pub variance: Vec<f64>,
    /// Velocity of the measured side after the correction, m/s or rad/s.
    pub velocity: Vec<f64>,
    /// Smoothed force that the law lacks, mean over the interval that ends at the row, N or N m. Empty unless asked for.
    pub disturbance: Vec<f64>,
}

/// Drives `law` along `trial`; with `smooth` the disturbance is smoothed, too.
#[must_use]
pub fn innovations(trial: &DriveTrial, law: &DriveLaw, noise: &Noise, smooth: bool) -> Innovations {
    match law.link {
        None => one_body(trial, law, noise, &Gains::of(trial, law, noise), smooth),
        Some(link) => two_bodies(trial, law, link, noise, smooth),
    }
}

/// Kalman gains of one body along a trial.
#[derive(Debug, Clone, Default)]
pub struct Gains {
    gain: Vec<[f64; 2]>,
    variance: Vec<f64>,
}

/// Rows over which the gain has to stand before it is taken as steady, and its relative change.
const STEADY_ROWS: usize = 25;
const STEADY_CHANGE: f64 = 1e-7;

impl Gains {
    /// Those of `law` with `noise` on the rows of `trial`.
    #[must_use]
    pub fn of(trial: &DriveTrial, law: &DriveLaw, noise: &Noise) -> Self {
        let encoder = noise.encoder();
        let mut gains = Self { gain: vec![[0.0; 2]; trial.len()], variance: vec![encoder; trial.len()] };
        let fastest = trial.fastest();
        let mut covariance = [[0.0; 2]; 2];
        let (mut transition, mut driving) = (covariance, covariance);
        let (mut last_step, mut steady) = (f64::NAN, 0);
        for row in 0..trial.len() {
            if trial.restart[row] {
                covariance = [[encoder, 0.0], [0.0, fastest * fastest + f64::MIN_POSITIVE]];
                steady = 0;
                continue;
            }
            let step = trial.time[row] - trial.time[row - 1];
            let same = (step - last_step).abs() <= 1e-9 * trial.period_s;
            if !same {
                (transition, driving) = (law.transition(step), law.driving_noise(noise, step));
                (last_step, steady) = (step, 0);
            }
            if steady >= STEADY_ROWS {
                gains.gain[row] = gains.gain[row - 1];
                gains.variance[row] = gains.variance[row - 1];
                continue;
            }
            let predicted = propagated(&transition, &covariance, &driving);
            let variance = predicted[0][0] + encoder;
            let gain = [predicted[0][0] / variance, predicted[1][0] / variance];
            for (line, factor) in covariance.iter_mut().zip(predicted.iter().zip(gain)) {
                *line = std::array::from_fn(|column| factor.0[column] - factor.1 * predicted[0][column]);
            }
            let before = gains.gain[row - 1];
            let stands = gain.iter().zip(before).all(|(new, old)| (new - old).abs() <= STEADY_CHANGE * new.abs());
            steady = if stands { steady + 1 } else { 0 };
            gains.gain[row] = gain;
            gains.variance[row] = variance;
        }
        gains
    }
}

impl DriveLaw {
    /// Position and velocity over `step` without any force but viscous friction.
    fn transition(&self, step: f64) -> Matrix<2> {
        let rate = self.viscous / self.inertia;
        let decay = (-rate * step).exp();
        let way = if rate * step > 1e-6 { (1.0 - decay) / rate } else { step * (1.0 - 0.5 * rate * step) };
        [[1.0, way], [0.0, decay]]
    }

    /// Covariance that the disturbance adds over `step`.
    fn driving_noise(&self, noise: &Noise, step: f64) -> Matrix<2> {
        let density = noise.disturbance() / (self.inertia * self.inertia);
        let cross = density * step * step / 2.0;
        [[density * step.powi(3) / 3.0, cross], [cross, density * step]]
    }
}

/// One body with given gains.
#[must_use]
pub fn one_body(trial: &DriveTrial, law: &DriveLaw, noise: &Noise, gains: &Gains, smooth: bool) -> Innovations {
    let inputs = Inputs::of(trial, law);
    let rows = trial.len();
    let mut out =
        Innovations { innovation: vec![0.0; rows], variance: gains.variance.clone(), ..Innovations::default() };
    out.velocity = vec![0.0; rows];
    let inertia = if trial.force.is_some() { law.inertia - law.tool_inertia } else { law.inertia };
    let mut state = [0.0; 2];
    for row in 0..rows {
        if trial.restart[row] {
            state = [trial.position[row], trial.rate_after(row)];
        } else {
            let step = trial.time[row] - trial.time[row - 1];
            let force = inputs.force[row];
            state = law.advance(state, inputs.effort[row] - force, force, inertia, step);
            let innovation = trial.position[row] - state[0];
            let gain = gains.gain[row];
            state = [state[0] + gain[0] * innovation, state[1] + gain[1] * innovation];
            out.innovation[row] = innovation;
        }
        out.velocity[row] = state[1];
    }
    if smooth {
        out.disturbance = smoothed_one(trial, law, noise, gains, &out);
    }
    out
}

/// Disturbance smoother (de Jong, *Biometrika* 76, 1989; Koopman, *Biometrika* 80, 1993): backward through the innovations.
fn smoothed_one(trial: &DriveTrial, law: &DriveLaw, noise: &Noise, gains: &Gains, pass: &Innovations) -> Vec<f64> {
    let mut force = vec![0.0; trial.len()];
    let mut next = [0.0; 2];
    for row in (0..trial.len()).rev() {
        if trial.restart[row] {
            next = [0.0; 2];
            continue;
        }
        let gain = gains.gain[row];
        let weighted = pass.innovation[row] / pass.variance[row] - gain[0] * next[0] - gain[1] * next[1];
        let adjoint = [next[0] + weighted, next[1]];
        let step = trial.time[row] - trial.time[row - 1];
        let driving = law.driving_noise(noise, step);
        force[row] = law.inertia / step * (driving[1][0] * adjoint[0] + driving[1][1] * adjoint[1]);
        next = transposed_product(&law.transition(step), &adjoint);
    }
    force
}

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
    transition: [Matrix<STATES>; 2],
    driving: [Matrix<STATES>; 2],
    /// State after the step for a constant force of one on the motor.
    response: [[f64; STATES]; 2],
}

impl Pair {
    fn new(law: &DriveLaw, link: &Link, noise: &Noise, step: f64) -> Self {
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
                [stiffness / load, damping / load, -stiffness / load, -damping / load],
            ];
            let once = exponential(&rates, short);
            let density = noise.disturbance();
            let mut white = [[0.0; STATES]; STATES];
            white[1][1] = density / (motor * motor);
            white[3][3] = LOAD_DENSITY_SHARE * density / (load * load);
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
            transition: [apart.0, coupled.0],
            driving: [apart.1, coupled.1],
            response: [apart.2, coupled.2],
        }
    }
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
        let (middle_v, middle_load_v) = (v + 0.5 * short * pushed, load_v + 0.5 * short * (now - force) / load);
        let ahead = x + 0.5 * short * v - load_x - 0.5 * short * load_v;
        let passed = link.transmitted(ahead, middle_v - middle_load_v);
        coupled += usize::from(ahead.abs() >= 0.5 * link.play);
        let [x, v] = law.advance([x, v], effort - passed, force, motor, short);
        let after = load_v + short * (passed - force) / load;
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

fn two_bodies(trial: &DriveTrial, law: &DriveLaw, link: Link, noise: &Noise, smooth: bool) -> Innovations {
    let inputs = Inputs::of(trial, law);
    let rows = trial.len();
    let encoder = noise.encoder();
    let measured = if link.encoder == Side::Load { 2 } else { 0 };
    let mut out = Innovations {
        innovation: vec![0.0; rows],
        variance: vec![encoder; rows],
        velocity: vec![0.0; rows],
        disturbance: Vec::new(),
    };
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
        let near = |pair: &Pair| (pair.step - step).abs() <= 1e-9 * trial.period_s;
        // A clock that jitters has as many steps as rows: only the latest are looked through.
        let oldest = pairs.len().saturating_sub(REMEMBERED_PAIRS);
        let at = pairs[oldest..].iter().position(near).map(|latest| oldest + latest).unwrap_or_else(|| {
            pairs.push(Pair::new(law, &link, noise, step));
            pairs.len() - 1
        });
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
        out.disturbance = smoothed_pair(trial, &link, noise, &out, &history, &pairs);
    }
    out
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

fn smoothed_pair(
    trial: &DriveTrial,
    link: &Link,
    noise: &Noise,
    pass: &Innovations,
    history: &[PairRow],
    pairs: &[Pair],
) -> Vec<f64> {
    let measured = if link.encoder == Side::Load { 2 } else { 0 };
    let mut force = vec![0.0; trial.len()];
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
        adjoint[measured] += pass.innovation[row] / pass.variance[row] - along;
        let regime = usize::from(*coupled);
        let seen: f64 = pair.response[regime].iter().zip(&adjoint).map(|(response, adjoint)| response * adjoint).sum();
        force[row] = noise.disturbance() / pair.step * seen;
        next = transposed_product(&pair.transition[regime], &adjoint);
    }
    force
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::testing::TestDrive;

    fn noise(drive: &TestDrive) -> Noise {
        Noise { ln_disturbance: drive.disturbance.max(1e-12).ln(), ln_encoder: drive.encoder.powi(2).ln() }
    }

    #[test]
    fn innovations_of_the_true_law_are_white_and_as_large_as_they_say() {
        let drive = TestDrive { disturbance: 1e-4, ..TestDrive::PLAIN };
        let trial = drive.trial(8.0, 3);
        let pass = innovations(&trial, &DriveLaw::nominal(0.8, 4.0, 0.0), &noise(&drive), false);
        let white: Vec<f64> = pass.innovation.iter().zip(&pass.variance).skip(20).map(|(e, s)| e / s.sqrt()).collect();
        let count = white.len() as f64;
        let power = white.iter().map(|w| w * w).sum::<f64>() / count;
        let next = white.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / count;
        // A mean of squares has a deviation of sqrt(2 / n), a product of neighbours one of 1 / sqrt(n); four of each.
        assert!((power - 1.0).abs() < 4.0 * (2.0 / count).sqrt(), "{power}");
        assert!(next.abs() < 4.0 / count.sqrt(), "{next}");
    }

    #[test]
    fn a_constant_force_that_the_law_lacks_is_what_the_smoother_shows() {
        let drive = TestDrive { load: 0.3, ..TestDrive::PLAIN };
        let trial = drive.trial(4.0, 5);
        let noise = noise(&drive).with_crossing(20.0, 1e-3, 0.8);
        let missing = innovations(&trial, &DriveLaw::nominal(0.8, 4.0, 0.0), &noise, true).disturbance;
        let inner = &missing[500..3500];
        let mean = inner.iter().sum::<f64>() / inner.len() as f64;
        // A load takes from the effort: the missing force is its negative. The mean over 3 s of a band of 20 Hz is known to a
        // hundredth of the noise in it, which is 15 mN.
        assert!((mean + 0.3).abs() < 2e-3, "{mean}");
    }

    #[test]
    fn two_bodies_on_a_stiff_link_are_one() {
        let trial = TestDrive::PLAIN.trial(2.0, 7);
        let noise = Noise { ln_disturbance: (1e-6f64).ln(), ln_encoder: (25e-12f64).ln() };
        let one = DriveLaw::nominal(0.8, 4.0, 0.0);
        let link = Link { stiffness: 4e5, damping: 200.0, play: 0.0, load_share: 0.4, encoder: Side::Motor };
        let both = DriveLaw { link: Some(link), ..one.clone() };
        let [rigid, linked] = [one, both].map(|law| innovations(&trial, &law, &noise, true));
        let power = |x: &[f64]| x[100..].iter().map(|x| x * x).sum::<f64>();
        let apart: Vec<f64> = rigid.innovation.iter().zip(&linked.innovation).map(|(a, b)| a - b).collect();
        // The link gives by force over stiffness, 5 um a newton for 2 N at most, and a tenth of the encoder's noise in the mean.
        assert!(power(&apart) < 0.05 * power(&rigid.innovation), "{}", power(&apart) / power(&rigid.innovation));
        let rms = |x: &[f64]| (power(x) / (x.len() - 100) as f64).sqrt();
        assert!((rms(&linked.disturbance) / rms(&rigid.disturbance) - 1.0).abs() < 0.2);
    }
}
