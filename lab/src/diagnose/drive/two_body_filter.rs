//! Two bodies along a trial, corrected at each encoder row: an extended Kalman filter whose transition is that of the free or of the
//! coupled pair.

use std::collections::HashMap;
use std::sync::Arc;

use super::innovations::Innovations;
use super::input::Inputs;
use super::law::{DriveLaw, Link, Side};
use super::matrix::{Matrix, identity, propagated};
use super::noise::Noise;
use super::presliding::Slips;
use super::trial::DriveTrial;
use super::two_body_smoother::{PairRow, of_stretch, smoothed_pair};
use super::two_mass_motion::{Pushes, advance_pair};
use super::two_mass_system::{Pair, STATES};

/// Parts of a period by which two steps count as alike, and share a pair: a clock that jitters has as many steps as rows, and a pair costs as
/// much as hundreds of rows. What is left, a five-hundredth of a period, is made up for to the first order: by the force of the inputs, which keeps
/// their impulse, and by the way at the speed that was reached.
const GRAINS: f64 = 256.0;

/// Share of the disturbance's density that acts on the side that the encoder does not see: without any the filter would trust it for ever. All of
/// it acts on the other: in a play nothing else can move that, and a strike that comes some rows early or late would cost what hundreds of rows tell.
const HIDDEN_DENSITY_SHARE: f64 = 1e-4;

/// What is not known of the pair along a trial.
#[derive(Clone, Copy, Default)]
struct Uncertainty {
    covariance: Matrix<STATES>,
    gain: [f64; STATES],
    variance: f64,
    /// Pair and regime of the latest row.
    latest: (usize, usize),
    /// Rows since then over which the gain stood.
    steady_rows: usize,
}

/// Rows over which the gain of one pair in one regime has to stand before it is taken as steady, and its relative change. Derivatives
/// are differences over 1e-4 of a value: the gain has to be a hundred millionth of that exact.
const STEADY_ROWS: usize = 10;
const STEADY_CHANGE: f64 = 1e-12;

impl Uncertainty {
    /// Over the row of `pair`, the `at`-th, in `regime`, and its encoder row.
    fn update(&mut self, at: usize, pair: &Pair, regime: usize, measured: usize, encoder: f64) {
        if self.latest != (at, regime) {
            (self.latest, self.steady_rows) = ((at, regime), 0);
        }
        if self.steady_rows >= STEADY_ROWS {
            return;
        }
        self.covariance = propagated(&pair.transition[regime], &self.covariance, &pair.driving[regime]);
        let line = self.covariance[measured];
        self.variance = line[measured] + encoder;
        let gain = line.map(|covariance| covariance / self.variance);
        let stands = gain.iter().zip(self.gain).all(|(new, old)| (new - old).abs() <= STEADY_CHANGE * new.abs());
        self.steady_rows = if stands { self.steady_rows + 1 } else { 0 };
        for (row, gain) in self.covariance.iter_mut().zip(gain) {
            row.iter_mut().zip(line).for_each(|(value, known)| *value -= gain * known);
        }
        self.gain = gain;
    }
}

/// Two bodies on `link` under `inputs`; with `smooth` the disturbance is smoothed, too.
#[must_use]
pub fn two_bodies(
    trial: &DriveTrial,
    inputs: &Inputs,
    law: &DriveLaw,
    link: Link,
    noise: &Noise,
    smooth: bool,
) -> Innovations {
    let rows = trial.len();
    let encoder = noise.encoder();
    let measured = if link.encoder == Side::Load { 2 } else { 0 };
    let mut out = Innovations { innovation: vec![0.0; rows], ..Innovations::default() };
    let mut variances = vec![encoder; rows];
    let densities = densities(noise, link.encoder, trial.force_density);
    let mut pairs = Pairs::default();
    let mut history: Vec<PairRow> = Vec::with_capacity(if smooth { rows } else { 0 });
    let (mut state, mut slips) = ([0.0; STATES], Slips::default());
    let mut uncertainty = Uncertainty::default();
    for (row, seen) in variances.iter_mut().enumerate() {
        if trial.restart[row] {
            let (position, rate) = (trial.position[row], trial.rate_after(row));
            state = [position, rate, position, rate];
            slips = Slips::default();
            let effort = inputs.effort[(row + 1).min(rows - 1)];
            uncertainty =
                Uncertainty { covariance: unknown_pair(trial, &link, encoder, effort), ..Uncertainty::default() };
            if smooth {
                let spread = of_stretch(&uncertainty.covariance);
                history.push(PairRow { gain: [0.0; STATES], coupled: true, pair: 0, stretch: 0.0, spread });
            }
            continue;
        }
        let step = trial.time[row] - trial.time[row - 1];
        let at = pairs.of(step, trial.period_s / GRAINS, || Pair::new(law, &link, densities, step));
        let pair = &pairs.all[at];
        let [effort, force, borne] =
            [inputs.effort[row], inputs.force[row], inputs.borne(row)].map(|force| force * step / pair.step);
        let coupled = advance_pair(law, &link, &mut state, &mut slips, Pushes { effort, force, borne }, pair);
        let late = step - pair.step;
        state = [state[0] + late * state[1], state[1], state[2] + late * state[3], state[3]];
        let regime = usize::from(coupled);
        uncertainty.update(at, pair, regime, measured, encoder);
        let Uncertainty { gain, variance, .. } = uncertainty;
        let innovation = trial.position[row] - state[measured];
        state.iter_mut().zip(gain).for_each(|(state, gain)| *state += gain * innovation);
        law.friction.follow(&mut slips, gain[0] * innovation);
        (out.innovation[row], *seen) = (innovation, variance);
        if smooth {
            let (stretch, spread) = (state[0] - state[2], of_stretch(&uncertainty.covariance));
            history.push(PairRow { gain, coupled, pair: at, stretch, spread });
        }
    }
    out.variance = Arc::new(variances);
    if smooth {
        [out.disturbance, out.residual, out.stretch] = smoothed_pair(trial, &link, noise, &out, &history, &pairs.all);
    }
    out
}

/// Densities of what disturbs motor and load, of which the encoder sees one `side`; the load feels the noise of the force sensor, too.
fn densities(noise: &Noise, side: Side, of_force: f64) -> [f64; 2] {
    let (seen, hidden) = (noise.disturbance(), HIDDEN_DENSITY_SHARE * noise.disturbance());
    match side {
        Side::Motor => [seen, hidden + of_force],
        Side::Load => [hidden, seen + of_force],
    }
}

/// The pairs of a trial, one for all steps that are alike.
#[derive(Default)]
struct Pairs {
    all: Vec<Pair>,
    /// Place of each by its step, in grains.
    places: HashMap<i64, usize>,
    /// Step and place of the latest: a clock that does not jitter asks for the same in every row.
    latest: (i64, usize),
}

impl Pairs {
    /// Place of the one over `step`, to a `grain`; a `new` one where there is none yet.
    fn of(&mut self, step: f64, grain: f64, new: impl FnOnce() -> Pair) -> usize {
        let grains = (step / grain).round() as i64;
        if self.latest.0 != grains || self.all.is_empty() {
            let place = *self.places.entry(grains).or_insert_with(|| {
                self.all.push(new());
                self.all.len() - 1
            });
            self.latest = (grains, place);
        }
        self.latest.1
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::testing::pair_law;
    use crate::diagnose::drive::two_mass_system::Coupled;

    /// A load that is pushed by a force of its own, seen by an encoder of 1 um on the motor alone.
    #[test]
    fn the_lead_of_a_motor_is_smoothed_to_a_hundredth_of_it() {
        let (law, link) = pair_law(2_000.0);
        let exact = Coupled::new(&law, &link, 1e-3);
        let push = |row: usize, hz: f64| 2.0 * (std::f64::consts::TAU * hz * 1e-3 * row as f64).cos();
        let rows = 4000;
        let time: Vec<f64> = (0..rows).map(|row| 1e-3 * row as f64).collect();
        let effort: Vec<f64> = (0..rows).map(|row| push(row, 1.3)).collect();
        let force: Vec<f64> = (0..rows).map(|row| 0.5 * push(row, 2.9)).collect();
        // The filter begins with no stretch, give or take what the first effort would make of it, 0.3 mm.
        let mut state = [0.3e-3, 0.0, 0.0, 0.0];
        let (mut position, mut lead) = (vec![state[0]], vec![state[0] - state[2]]);
        for row in 1..rows {
            state = exact.after(&state, [effort[row - 1], -0.5 * (force[row - 1] + force[row])]);
            position.push(state[0] + 1e-6 * (row as f64 * 1.618).sin());
            lead.push(state[0] - state[2]);
        }
        let trial = DriveTrial::new("lead.csv".to_owned(), time, &position, effort, Some(force), 1);
        let noise = Noise { ln_disturbance: (1e-9f64).ln(), ln_encoder: (1e-12f64).ln() };
        let pass = two_bodies(&trial, &Inputs::of(&trial, &law), &law, link, &noise, true);
        let rms = |values: &mut dyn Iterator<Item = f64>| (values.map(|x| x * x).sum::<f64>() / rows as f64).sqrt();
        let error = rms(&mut pass.stretch.iter().zip(&lead).map(|(found, truth)| found - truth));
        // From the first row on, whose lead only later rows tell.
        assert!(error < 0.01 * rms(&mut lead.iter().copied()), "{error}");
        assert!((pass.stretch[0] - lead[0]).abs() < 0.02 * lead[0], "{} {}", pass.stretch[0], lead[0]);
    }

    /// The same motion of a load on a spring of 15 Hz by a clock that is early and late by up to a tenth: rows that share a pair leave what rows
    /// that each have their own do.
    #[test]
    fn rows_of_a_clock_that_jitters_share_pairs_and_are_followed_as_exactly() {
        let (law, link) = pair_law(2_000.0);
        let exact = |step: f64| Coupled::new(&law, &link, step);
        let rows = 3000;
        let time: Vec<f64> = (0..rows).map(|row| 1e-3 * (row as f64 + 0.1 * (row as f64 * 2.39996).sin())).collect();
        let effort: Vec<f64> = time.iter().map(|time| 2.0 * (std::f64::consts::TAU * 1.3 * time).cos()).collect();
        let (mut state, mut position) = ([0.0; STATES], vec![0.0]);
        for row in 1..rows {
            state = exact(time[row] - time[row - 1]).after(&state, [effort[row - 1], 0.0]);
            position.push(state[0]);
        }
        let trial = DriveTrial::new("jitter.csv".to_owned(), time, &position, effort, None, 1);
        // A quiet disturbance and a loud encoder: the filter simulates.
        let noise = Noise { ln_disturbance: (1e-16f64).ln(), ln_encoder: (1e-8f64).ln() };
        let pass = two_bodies(&trial, &Inputs::of(&trial, &law), &law, link, &noise, false);
        let rms = |values: &[f64]| (values.iter().map(|x| x * x).sum::<f64>() / rows as f64).sqrt();
        // By grain the force of a row is right to half of 1/256 of what it changes by within the row, a fiftieth of it.
        assert!(rms(&pass.innovation) < 2e-5 * rms(&position), "{} {}", rms(&pass.innovation), rms(&position));
    }

    #[test]
    fn the_variance_that_stands_is_the_fixed_point_of_riccatis_recursion() {
        let (law, link) = pair_law(2_000.0);
        let noise = Noise { ln_disturbance: (1e-6f64).ln(), ln_encoder: (1e-10f64).ln() };
        let time: Vec<f64> = (0..6000).map(|row| 1e-3 * f64::from(row)).collect();
        let trial = DriveTrial::new("still.csv".to_owned(), time.clone(), &vec![0.0; 6000], vec![0.0; 6000], None, 1);
        let pass = two_bodies(&trial, &Inputs::of(&trial, &law), &law, link, &noise, false);
        let pair = Pair::new(&law, &link, densities(&noise, Side::Motor, 0.0), 1e-3);
        let mut covariance = identity::<STATES>();
        for _ in 0..100_000 {
            covariance = propagated(&pair.transition[1], &covariance, &pair.driving[1]);
            let line = covariance[0];
            let gain = line.map(|known| known / (line[0] + noise.encoder()));
            for (row, gain) in covariance.iter_mut().zip(gain) {
                row.iter_mut().zip(line).for_each(|(value, known)| *value -= gain * known);
            }
        }
        let standing = propagated(&pair.transition[1], &covariance, &pair.driving[1])[0][0] + noise.encoder();
        // A gain that stands to 1e-12 a row is off by that times the rows over which it forgets, some hundreds.
        assert!((pass.variance[5999] / standing - 1.0).abs() < 1e-9, "{} {standing}", pass.variance[5999]);
    }
}
