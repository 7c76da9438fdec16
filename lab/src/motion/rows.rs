//! The rows of a recording as the filter and the smoother of the motion take them.

use super::FEWEST_ROWS;
use super::Motion;
use super::criteria::LEAST_JUMP_MEMORY;
use super::encoder_readings::EncoderReadings;
use super::local_density::{self, DensityEvidence};
use super::third_integral::{Matrix, Vector, back_over, correct, predict, process_noise, product, through_row};
use super::velocity_jumps::{self, JumpTest};
use crate::golden_section::least_between;

/// Rows that the filter remembers: in so many, a white third derivative of this `density` moves the position by about the noise of a row, which is one here.
fn memory_rows(density: f64) -> f64 {
    density.powf(-1.0 / 6.0)
}

/// Rows over which the smoother averages where they share one error: the variance that it leaves of white noise R is the integral of 1 / (1 + (w m)^6) over
/// frequency, R / (3 m), with the memory m = (R / q)^(1/6) of density q; with R as many times one as the rows that it averages, n = 3 m, it is n = 3^(6/5) q^(-1/5).
pub(super) fn rows_averaged(density: f64) -> f64 {
    (3f64.powf(1.2) * density.powf(-0.2)).max(1.0)
}

/// Rows in units of the encoder's deviation and of the usual step, in which all numbers are near one.
pub(super) struct Rows<'a> {
    time: &'a [f64],
    position: &'a [f64],
    readings: &'a EncoderReadings,
    /// Rows that the smoother averages at the most: so many of those that share an error tell as much as one.
    pub(super) averaged: f64,
    /// Least variance that a row is taken to have.
    finest: f64,
    /// Deviation of the surest row.
    deviation: f64,
    /// Usual time between rows, s.
    step: f64,
    /// Of the density before each row, over that of the trial; at least one.
    parts: Vec<f64>,
}

/// What the way back tells: the motion, and of each row what all rows say of a jump of the velocity and of the density before it.
pub(super) struct Smoothed {
    pub(super) motion: Motion,
    jumps: Vec<JumpTest>,
    evidence: Vec<DensityEvidence>,
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

/// Rounds in which the density of lively stretches is raised. Behind coarse encoders the third changed no error by a fiftieth; a stretch a thousand times as lively as
/// the rest took four to be known within the root of two.
const LOCAL_ROUNDS: usize = 4;

/// Rounds in which jumps are looked for: those of one round lessen the density, beside which smaller ones show. The third found a fiftieth of the jumps of the first.
const MOST_ROUNDS: usize = 6;

impl<'a> Rows<'a> {
    pub(super) fn of(readings: &'a EncoderReadings) -> Option<Self> {
        let EncoderReadings { time, position, variance, is_row, step_s, .. } = readings;
        if is_row.iter().filter(|is_row| **is_row).count() < FEWEST_ROWS {
            return None;
        }
        let rows = variance.iter().zip(is_row).filter_map(|(variance, is_row)| is_row.then_some(*variance));
        let surest = rows.fold(f64::INFINITY, f64::min);
        let span = position.iter().fold(0.0f64, |most, value| most.max((value - position[0]).abs()));
        // A reading without noise still is one of finite digits.
        let finest = 1e-18 * span * span;
        let deviation = surest.max(finest).sqrt();
        let is_known = *step_s > 0.0 && deviation > 0.0;
        is_known.then_some(Self {
            time,
            position,
            readings,
            averaged: 1.0,
            finest,
            deviation,
            step: *step_s,
            parts: vec![1.0; time.len()],
        })
    }

    /// Variance of `row` by itself, over the square of the deviation, as many times as it shares its error with others that are averaged.
    fn variance(&self, row: usize) -> f64 {
        let EncoderReadings { variance, sharing, .. } = self.readings;
        variance[row].max(self.finest) / self.deviation.powi(2)
            * sharing[row].min((self.averaged * self.parts[row].powf(-0.2)).max(1.0))
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

    pub(super) fn most_likely_density(&self, jumps: &[f64]) -> f64 {
        least_between(LN_DENSITY, LN_PRECISION, |ln| -self.log_likelihood(ln.exp(), jumps)).exp()
    }

    /// Raises the parts of `density` where the motion is livelier than in the rest of the trial.
    pub(super) fn raise_where_lively(&mut self, density: f64) {
        let none = vec![0.0; self.time.len()];
        for _ in 0..LOCAL_ROUNDS {
            let evidence = self.smooth(density, &none).evidence;
            local_density::raise(&mut self.parts, &evidence, memory_rows(density));
        }
    }

    /// Variances of the jumps of the velocity before each row that are beyond chance, looked for from `density` on, and the density beside them.
    pub(super) fn jumps(&self, density: f64) -> (Vec<f64>, f64) {
        let (mut jumps, mut density) = (vec![0.0; self.time.len()], density);
        for _ in 0..MOST_ROUNDS {
            let memory = memory_rows(density);
            if memory < LEAST_JUMP_MEMORY.value() {
                break;
            }
            let tests = self.smooth(density, &jumps).jumps;
            let found = velocity_jumps::beyond_chance(&tests, memory);
            if found.is_empty() {
                break;
            }
            for row in found {
                jumps[row] = jumps[row].max(tests[row].size.powi(2));
            }
            density = self.most_likely_density(&jumps);
        }
        (jumps, density)
    }

    /// With the variance of the jump of the velocity before each row.
    fn log_likelihood(&self, density: f64, jumps: &[f64]) -> f64 {
        let (mut state, mut covariance) = self.start();
        let mut sum = 0.0;
        for (row, jump) in jumps.iter().enumerate() {
            let (step, seen) = self.row(row);
            predict(&mut state, &mut covariance, step, density * self.parts[row]);
            velocity_jumps::allow(&mut covariance, step, *jump);
            let (innovation, variance) = (seen - state[0], covariance[0][0] + self.variance(row));
            // The first rows find where the motion starts.
            if row >= 3 {
                sum -= 0.5 * (variance.ln() + innovation * innovation / variance);
            }
            correct(&mut state, &mut covariance, innovation, variance);
        }
        sum
    }

    pub(super) fn smooth(&self, density: f64, jumps: &[f64]) -> Smoothed {
        let count = self.time.len();
        let mut kept = Vec::with_capacity(count);
        let (mut state, mut covariance) = self.start();
        for (row, jump) in jumps.iter().enumerate() {
            let (step, seen) = self.row(row);
            predict(&mut state, &mut covariance, step, density * self.parts[row]);
            velocity_jumps::allow(&mut covariance, step, *jump);
            let (innovation, variance) = (seen - state[0], covariance[0][0] + self.variance(row));
            kept.push(Kept { state, covariance, innovation, variance });
            correct(&mut state, &mut covariance, innovation, variance);
        }
        let mut motion = Motion::zeros(count);
        let (mut tests, mut evidence) = (vec![JumpTest::default(); count], vec![DensityEvidence::default(); count]);
        let (scale, rate) = (self.deviation, self.deviation / self.step);
        let (mut adjoint, mut information): (Vector, Matrix) = ([0.0; 3], [[0.0; 3]; 3]);
        for row in (0..count).rev() {
            let Kept { state, covariance, innovation, variance } = &kept[row];
            through_row(&mut adjoint, &mut information, covariance, *innovation, *variance);
            // Nothing is known before the first rows, from which a velocity could have jumped.
            if row >= 3 {
                let (step, _) = self.row(row);
                tests[row] = JumpTest::of(&adjoint, &information, step);
                evidence[row] =
                    DensityEvidence::of(&adjoint, &information, &process_noise(step, density * self.parts[row]));
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
        Smoothed { motion, jumps: tests, evidence }
    }
}

#[cfg(test)]
mod tests {
    use super::super::smoothed;
    use super::super::third_integral::transition;
    use super::*;
    use rand::SeedableRng as _;
    use rand_distr::{Distribution as _, Normal};

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
        let readings = EncoderReadings::white(&time, &place, variance);
        let rows = Rows::of(&readings).unwrap();
        let none = vec![0.0; time.len()];
        let density = rows.most_likely_density(&none);
        let Smoothed { motion: smeared, jumps: tests, .. } = rows.smooth(density, &none);
        let mut found = velocity_jumps::beyond_chance(&tests, memory_rows(density));
        found.sort_unstable();
        assert_eq!(found, blows);
        let weighed = |motion: &Motion| {
            // The first and the last rows are known from one side alone.
            let square = |row: usize| (motion.velocity[row] - velocity[row]).powi(2) / motion.velocity_variance[row];
            (50..1050).map(square).sum::<f64>() / 1000.0
        };
        let (free, bound) = (weighed(&smoothed(&readings)), weighed(&smeared));
        assert!(free < 1.6 && bound > 2.0 * free, "{free} and {bound}");
    }

    /// What a row says of a jump is what generalised least squares says: the innovations regressed on those of a unit jump.
    #[test]
    fn a_jump_is_tested_as_by_generalised_least_squares() {
        let (time, place, ..) = bouncing();
        let readings = EncoderReadings::white(&time[..400], &place[..400], 1e-8 / 12.0);
        let rows = Rows::of(&readings).unwrap();
        let (density, none) = (1e-3, vec![0.0; 400]);
        let tests = rows.smooth(density, &none).jumps;
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
                let variance = covariance[0][0] + rows.variance(row);
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

    /// A motion whose third derivative is thirty times as large for a second as in the rest: its velocity is known there to within the root of two of what its variance says.
    /// With the density of the whole trial alone its errors are more than that again.
    #[test]
    fn a_lively_stretch_is_known_as_well_as_it_says() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(23);
        let normal = Normal::new(0.0, 1.0).unwrap();
        let time: Vec<f64> = (0..9000).map(f64::from).collect();
        let lively = 4000..5000;
        let mut state: Vector = [0.0; 3];
        let (mut velocity, mut seen) = (Vec::new(), Vec::new());
        for row in 0..9000 {
            state = product(&transition(1.0), &state);
            // Drawn back slowly, over more rows than the smoother remembers: a lively stretch that ends far away would say more of its way there.
            state[2] += normal.sample(&mut random) * if lively.contains(&row) { 0.1 } else { 0.003 };
            state[2] -= 0.05 * state[2] + 0.002 * state[1] + 0.00003 * state[0];
            velocity.push(state[1]);
            seen.push(state[0] + normal.sample(&mut random));
        }
        let readings = EncoderReadings::white(&time, &seen, 1.0);
        let mut rows = Rows::of(&readings).unwrap();
        let none = vec![0.0; time.len()];
        let weighed = |motion: &Motion| {
            let square = |row: usize| (motion.velocity[row] - velocity[row]).powi(2) / motion.velocity_variance[row];
            (4050..4950).map(square).sum::<f64>() / 900.0
        };
        let density = rows.most_likely_density(&none);
        let whole = weighed(&rows.smooth(density, &none).motion);
        rows.raise_where_lively(density);
        let local = weighed(&rows.smooth(density, &none).motion);
        assert!((0.5..2.0).contains(&local) && whole > 2.0 * local, "{local} and {whole}");
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
        let readings = EncoderReadings::white(&time, &seen, 1e-4);
        let rows = Rows::of(&readings).unwrap();
        let none = vec![0.0; time.len()];
        let density = rows.most_likely_density(&none);
        let tests = rows.smooth(density, &none).jumps;
        assert!(!velocity_jumps::beyond_chance(&tests, memory_rows(density)).is_empty());
        assert_eq!(rows.jumps(density), (none, density));
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
            let readings = EncoderReadings::white(&time, &place, 1.0);
            let rows = Rows::of(&readings).unwrap();
            let none = vec![0.0; time.len()];
            let density = rows.most_likely_density(&none);
            let found = velocity_jumps::beyond_chance(&rows.smooth(density, &none).jumps, memory_rows(density));
            assert!(found.is_empty(), "{seed}: {found:?}");
        }
    }
}
