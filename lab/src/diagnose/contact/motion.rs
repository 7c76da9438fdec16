//! The tool's motion behind encoder rows: position, velocity and acceleration with their variances.
//!
//! The motion is a third integral of white noise, x''' = w, seen by an encoder whose rounding and noise are white. The Kalman filter
//! and the fixed-interval smoother (A. E. Bryson, M. Frazier, 1963) are exact for rows at any instants. The density of w is the most likely one, so
//! that no bandwidth has to be chosen. Where a blow changes the velocity within a row, w is not white: there the velocity is free to jump
//! ([`super::velocity_jumps`]), so that the density of the whole trial is not that of its blows.

use super::criteria::LEAST_JUMP_MEMORY;
use super::velocity_jumps::{self, JumpTest};
use crate::diagnose::golden_section::least_between;

/// A smoothed motion, one entry a row.
#[derive(Debug, Clone, Default)]
pub struct Motion {
    /// m or rad.
    pub position: Vec<f64>,
    /// m/s or rad/s.
    pub velocity: Vec<f64>,
    /// m/s^2 or rad/s^2.
    pub acceleration: Vec<f64>,
    /// Variance of the position.
    pub position_variance: Vec<f64>,
    /// Variance of the velocity.
    pub velocity_variance: Vec<f64>,
    /// Variance of the acceleration.
    pub acceleration_variance: Vec<f64>,
}

impl Motion {
    /// Of `count` rows, all at rest and known.
    fn zeros(count: usize) -> Self {
        let zeros = || vec![0.0; count];
        Self {
            position: zeros(),
            velocity: zeros(),
            acceleration: zeros(),
            position_variance: zeros(),
            velocity_variance: zeros(),
            acceleration_variance: zeros(),
        }
    }
}

pub(super) type Vector = [f64; 3];
pub(super) type Matrix = [[f64; 3]; 3];

/// The motion behind `position` at the instants `time`, whose rows have `variance`.
#[must_use]
pub fn smoothed(time: &[f64], position: &[f64], variance: f64) -> Motion {
    let Some(rows) = Rows::of(time, position, variance) else {
        return Motion { position: position.to_vec(), ..Motion::zeros(position.len()) };
    };
    let mut jumps = vec![0.0; time.len()];
    let mut density = rows.most_likely_density(&jumps);
    let (mut motion, mut tests) = rows.smooth(density, &jumps);
    for _ in 0..MOST_ROUNDS {
        let memory = memory_rows(density);
        if memory < LEAST_JUMP_MEMORY.value() {
            break;
        }
        let found = velocity_jumps::beyond_chance(&tests, memory);
        if found.is_empty() {
            break;
        }
        for row in found {
            jumps[row] = jumps[row].max(tests[row].size.powi(2));
        }
        density = rows.most_likely_density(&jumps);
        (motion, tests) = rows.smooth(density, &jumps);
    }
    motion
}

/// Rows that the filter remembers: in so many, a white third derivative of this `density` moves the position by about the noise of a row, which is one here.
fn memory_rows(density: f64) -> f64 {
    density.powf(-1.0 / 6.0)
}

/// Rows in units of the encoder's deviation and of the usual step, in which all numbers are near one.
struct Rows<'a> {
    time: &'a [f64],
    position: &'a [f64],
    /// Deviation of a row.
    deviation: f64,
    /// Usual time between rows, s.
    step: f64,
}

/// What the filter keeps of a row for the way back.
struct Kept {
    state: Vector,
    covariance: Matrix,
    innovation: f64,
    variance: f64,
}

/// ln of the densities between which the most likely one is looked for, in deviations squared over steps to the fifth.
const LN_DENSITY: [f64; 2] = [-46.0, 12.0];

/// Precision of its logarithm.
const LN_PRECISION: f64 = 0.25;

/// Rounds in which jumps are looked for: those of one round lessen the density, beside which smaller ones show. The third found a fiftieth of the jumps of the first.
const MOST_ROUNDS: usize = 6;

impl<'a> Rows<'a> {
    fn of(time: &'a [f64], position: &'a [f64], variance: f64) -> Option<Self> {
        let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if steps.len() < 4 {
            return None;
        }
        let middle = steps.len() / 2;
        let step = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
        let span = position.iter().fold(0.0f64, |most, value| most.max((value - position[0]).abs()));
        // A reading without noise still is one of finite digits.
        let deviation = variance.sqrt().max(1e-9 * span);
        (step > 0.0 && deviation > 0.0).then_some(Self { time, position, deviation, step })
    }

    fn start(&self) -> (Vector, Matrix) {
        let wide = 1e8;
        ([0.0; 3], [[wide, 0.0, 0.0], [0.0, wide, 0.0], [0.0, 0.0, wide]])
    }

    /// Steps before row `row`, and the row in deviations.
    fn row(&self, row: usize) -> (f64, f64) {
        let before = if row == 0 { 0.0 } else { (self.time[row] - self.time[row - 1]) / self.step };
        (before, (self.position[row] - self.position[0]) / self.deviation)
    }

    fn most_likely_density(&self, jumps: &[f64]) -> f64 {
        least_between(LN_DENSITY, LN_PRECISION, |ln| -self.log_likelihood(ln.exp(), jumps)).exp()
    }

    /// With the variance of the jump of the velocity before each row.
    fn log_likelihood(&self, density: f64, jumps: &[f64]) -> f64 {
        let (mut state, mut covariance) = self.start();
        let mut sum = 0.0;
        for (row, jump) in jumps.iter().enumerate() {
            let (step, seen) = self.row(row);
            predict(&mut state, &mut covariance, step, density);
            velocity_jumps::allow(&mut covariance, step, *jump);
            let (innovation, variance) = (seen - state[0], covariance[0][0] + 1.0);
            // The first rows find where the motion starts.
            if row >= 3 {
                sum -= 0.5 * (variance.ln() + innovation * innovation / variance);
            }
            correct(&mut state, &mut covariance, innovation, variance);
        }
        sum
    }

    /// The motion, and what each row says of a jump of the velocity before it.
    fn smooth(&self, density: f64, jumps: &[f64]) -> (Motion, Vec<JumpTest>) {
        let count = self.time.len();
        let mut kept = Vec::with_capacity(count);
        let (mut state, mut covariance) = self.start();
        for (row, jump) in jumps.iter().enumerate() {
            let (step, seen) = self.row(row);
            predict(&mut state, &mut covariance, step, density);
            velocity_jumps::allow(&mut covariance, step, *jump);
            let (innovation, variance) = (seen - state[0], covariance[0][0] + 1.0);
            kept.push(Kept { state, covariance, innovation, variance });
            correct(&mut state, &mut covariance, innovation, variance);
        }
        let (mut motion, mut tests) = (Motion::zeros(count), vec![JumpTest::default(); count]);
        let (scale, rate) = (self.deviation, self.deviation / self.step);
        let (mut adjoint, mut information): (Vector, Matrix) = ([0.0; 3], [[0.0; 3]; 3]);
        for row in (0..count).rev() {
            let Kept { state, covariance, innovation, variance } = &kept[row];
            through_row(&mut adjoint, &mut information, covariance, *innovation, *variance);
            // Nothing is known before the first rows, from which a velocity could have jumped.
            if row >= 3 {
                tests[row] = JumpTest::of(&adjoint, &information, self.row(row).0);
            }
            let moved = product(covariance, &adjoint);
            let spread = |at: usize| {
                let column: Vector = std::array::from_fn(|other| covariance[other][at]);
                let taken: f64 = product(&information, &column).iter().zip(&column).map(|(a, b)| a * b).sum();
                (covariance[at][at] - taken).max(0.0)
            };
            motion.position[row] = self.position[0] + scale * (state[0] - moved[0]);
            motion.velocity[row] = rate * (state[1] - moved[1]);
            motion.acceleration[row] = rate / self.step * (state[2] - moved[2]);
            motion.position_variance[row] = scale * scale * spread(0);
            motion.velocity_variance[row] = rate * rate * spread(1);
            motion.acceleration_variance[row] = (rate / self.step).powi(2) * spread(2);
            let (step, _) = self.row(row);
            back_over(&mut adjoint, &mut information, step);
        }
        (motion, tests)
    }
}

/// The transition over `step` usual steps.
fn transition(step: f64) -> Matrix {
    [[1.0, step, 0.5 * step * step], [0.0, 1.0, step], [0.0, 0.0, 1.0]]
}

fn predict(state: &mut Vector, covariance: &mut Matrix, step: f64, density: f64) {
    if step == 0.0 {
        return;
    }
    let forward = transition(step);
    *state = product(&forward, state);
    let half = times(&forward, covariance);
    let (s2, s3) = (step * step, step * step * step);
    let noise =
        [[s2 * s3 / 20.0, s2 * s2 / 8.0, s3 / 6.0], [s2 * s2 / 8.0, s3 / 3.0, s2 / 2.0], [s3 / 6.0, s2 / 2.0, step]];
    for row in 0..3 {
        for column in 0..3 {
            let carried: f64 = (0..3).map(|inner| half[row][inner] * forward[column][inner]).sum();
            covariance[row][column] = carried + density * noise[row][column];
        }
    }
}

fn correct(state: &mut Vector, covariance: &mut Matrix, innovation: f64, variance: f64) {
    let gain: Vector = std::array::from_fn(|row| covariance[row][0] / variance);
    let seen = covariance[0];
    for row in 0..3 {
        state[row] += gain[row] * innovation;
        for column in 0..3 {
            covariance[row][column] -= gain[row] * seen[column];
        }
    }
}

/// The adjoint state before a row from that behind it: (I - K H)^T and what the row itself says.
fn through_row(adjoint: &mut Vector, information: &mut Matrix, covariance: &Matrix, innovation: f64, variance: f64) {
    let gain: Vector = std::array::from_fn(|row| covariance[row][0] / variance);
    let kept: Matrix = std::array::from_fn(|row| {
        std::array::from_fn(|column| f64::from(row == column) - if column == 0 { gain[row] } else { 0.0 })
    });
    let turned: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| kept[column][row]));
    *adjoint = product(&turned, adjoint);
    adjoint[0] -= innovation / variance;
    *information = times(&times(&turned, information), &kept);
    information[0][0] += 1.0 / variance;
}

/// The same over the time before a row.
fn back_over(adjoint: &mut Vector, information: &mut Matrix, step: f64) {
    let forward = transition(step);
    let turned: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| forward[column][row]));
    *adjoint = product(&turned, adjoint);
    *information = times(&times(&turned, information), &forward);
}

fn product(matrix: &Matrix, vector: &Vector) -> Vector {
    std::array::from_fn(|row| matrix[row].iter().zip(vector).map(|(a, b)| a * b).sum())
}

fn times(left: &Matrix, right: &Matrix) -> Matrix {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| (0..3).map(|inner| left[row][inner] * right[inner][column]).sum())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng as _;
    use rand_distr::{Distribution as _, Normal};

    /// A sine under white noise, rows jittered by a third of their period: the errors are as large as the variances say.
    #[test]
    fn errors_of_the_motion_are_those_of_the_variances() {
        let mut random = rand_chacha::ChaCha12Rng::seed_from_u64(3);
        let normal = Normal::new(0.0, 2e-5).unwrap();
        let jitter = Normal::new(0.0, 1e-4).unwrap();
        let mut late = || -> f64 { jitter.sample(&mut random) };
        let time: Vec<f64> = (0..4000).map(|row| f64::from(row) * 1e-3 + late().clamp(-3e-4, 3e-4)).collect();
        let (size, pulse) = (5e-3, 12.0f64);
        let position: Vec<f64> =
            time.iter().map(|time| 0.3 + size * (pulse * time).sin() + normal.sample(&mut random)).collect();
        let motion = smoothed(&time, &position, 4e-10);
        let (mut place, mut speed, mut change) = (0.0, 0.0, 0.0);
        for (row, time) in time.iter().enumerate().take(3900).skip(100) {
            let truth = (0.3 + size * (pulse * time).sin(), size * pulse * (pulse * time).cos());
            place += (motion.position[row] - truth.0).powi(2) / motion.position_variance[row];
            speed += (motion.velocity[row] - truth.1).powi(2) / motion.velocity_variance[row];
            let turned = -size * pulse * pulse * (pulse * time).sin();
            change += (motion.acceleration[row] - turned).powi(2) / motion.acceleration_variance[row];
            assert!(motion.position_variance[row] < 4e-10);
        }
        // A sine is smoother than what is assumed, the more so the higher the derivative, so that all come out below one; errors are alike
        // over some ten rows.
        let ratios = [place / 3800.0, speed / 3800.0, change / 3800.0];
        assert!(ratios.iter().all(|ratio| (0.1..1.6).contains(ratio)), "{ratios:?}");
    }

    /// A ball that falls from 5 mm above a plate and loses a tenth of its speed at each blow, read in steps of 0.1 mm every millisecond.
    fn bouncing() -> (Vec<f64>, Vec<f64>, Vec<f64>, Vec<usize>) {
        let (mut height, mut speed, gravity, step) = (5e-3, 0.0, 0.8, 1e-3);
        let (mut place, mut velocity, mut blows) = (Vec::new(), Vec::new(), Vec::new());
        for row in 0..1100 {
            place.push((height / 1e-4_f64).round() * 1e-4);
            velocity.push(speed);
            let mut left = step;
            // The instant of the blow solves height + speed t - g t^2 / 2 = 0.
            let ahead = (speed + f64::sqrt(speed * speed + 2.0 * gravity * height)) / gravity;
            if ahead < step {
                speed = -0.9 * (speed - gravity * ahead);
                (height, left) = (0.0, step - ahead);
                blows.push(row + 1);
            }
            height += speed * left - 0.5 * gravity * left * left;
            speed -= gravity * left;
        }
        ((0..1100).map(|row| f64::from(row) * step).collect(), place, velocity, blows)
    }

    /// Every blow of a ball is found to the row, nothing else is, and the velocity is known as its variance says also around them: without
    /// jumps its squared errors are several times that.
    #[test]
    fn a_velocity_may_jump_at_a_blow() {
        let (time, place, velocity, blows) = bouncing();
        let variance = 1e-8 / 12.0;
        let rows = Rows::of(&time, &place, variance).unwrap();
        let none = vec![0.0; time.len()];
        let density = rows.most_likely_density(&none);
        let (smeared, tests) = rows.smooth(density, &none);
        let mut found = velocity_jumps::beyond_chance(&tests, memory_rows(density));
        found.sort_unstable();
        assert_eq!(found, blows);
        let weighed = |motion: &Motion| {
            // The first and the last rows are known from one side alone.
            let square = |row: usize| (motion.velocity[row] - velocity[row]).powi(2) / motion.velocity_variance[row];
            (50..1050).map(square).sum::<f64>() / 1000.0
        };
        let (free, bound) = (weighed(&smoothed(&time, &place, variance)), weighed(&smeared));
        assert!(free < 1.6 && bound > 2.0 * free, "{free} and {bound}");
    }

    /// What a row says of a jump is what generalised least squares says: the innovations regressed on those of a unit jump.
    #[test]
    fn a_jump_is_tested_as_by_generalised_least_squares() {
        let (time, place, ..) = bouncing();
        let rows = Rows::of(&time[..400], &place[..400], 1e-8 / 12.0).unwrap();
        let (density, none) = (1e-3, vec![0.0; 400]);
        let (_, tests) = rows.smooth(density, &none);
        for jump in [60, 171, 333] {
            // Of a unit jump in the middle of the time before its row.
            let ramp = |row: usize| if row < jump { 0.0 } else { (row - jump) as f64 + 0.5 };
            let (mut state, mut covariance) = rows.start();
            let (mut answer, mut ignored) = ([0.0; 3], covariance);
            let (mut product, mut square) = (0.0, 0.0);
            for row in 0..400 {
                let (step, seen) = rows.row(row);
                predict(&mut state, &mut covariance, step, density);
                predict(&mut answer, &mut ignored, step, density);
                let variance = covariance[0][0] + 1.0;
                let (mine, unit) = (seen - state[0], ramp(row) - answer[0]);
                product += mine * unit / variance;
                square += unit * unit / variance;
                let mut same = covariance;
                correct(&mut state, &mut covariance, mine, variance);
                correct(&mut answer, &mut same, unit, variance);
            }
            let test = tests[jump];
            // The wide start costs eight of sixteen digits.
            assert!((test.size - product / square).abs() < 1e-6 * test.size.abs(), "{test:?}");
            assert!((test.statistic - product * product / square).abs() < 1e-6 * test.statistic, "{test:?}");
        }
    }

    /// A stage that starts and stops within two rows, read a hundred times finer than it moves in one: the rows tell the velocity, and no jump is put into
    /// it, though one would gain likelihood.
    #[test]
    fn a_quick_start_behind_a_fine_encoder_is_no_jump() {
        let mut random = rand_chacha::ChaCha12Rng::seed_from_u64(5);
        let normal = Normal::new(0.0, 0.01).unwrap();
        let time: Vec<f64> = (0..1000).map(f64::from).collect();
        let (mut place, mut speed) = (0.0, 0.0);
        let seen: Vec<f64> = (0..1000)
            .map(|row| {
                let aim = if row / 50 % 2 == 0 { 0.0 } else { 1.0 };
                speed += f64::clamp(aim - speed, -0.5, 0.5);
                place += speed;
                place + normal.sample(&mut random)
            })
            .collect();
        let rows = Rows::of(&time, &seen, 1e-4).unwrap();
        let none = vec![0.0; time.len()];
        let density = rows.most_likely_density(&none);
        let (plain, tests) = rows.smooth(density, &none);
        assert!(!velocity_jumps::beyond_chance(&tests, memory_rows(density)).is_empty());
        assert_eq!(smoothed(&time, &seen, 1e-4).velocity, plain.velocity);
    }

    /// Of forty motions whose third derivative is white none has a jump: in a hundred one or less is expected.
    #[test]
    fn a_smooth_motion_has_no_jump() {
        for seed in 0..40 {
            let mut random = rand_chacha::ChaCha12Rng::seed_from_u64(seed);
            let normal = Normal::new(0.0, 1.0).unwrap();
            let time: Vec<f64> = (0..2000).map(f64::from).collect();
            let mut state = [0.0f64; 3];
            let place: Vec<f64> = time
                .iter()
                .map(|_| {
                    state = product(&transition(1.0), &state);
                    state[2] += 0.02 * normal.sample(&mut random);
                    state[0] + normal.sample(&mut random)
                })
                .collect();
            let rows = Rows::of(&time, &place, 1.0).unwrap();
            let none = vec![0.0; time.len()];
            let density = rows.most_likely_density(&none);
            let found = velocity_jumps::beyond_chance(&rows.smooth(density, &none).1, memory_rows(density));
            assert!(found.is_empty(), "{seed}: {found:?}");
        }
    }
}
