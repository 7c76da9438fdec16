//! Stretches in which something from outside pushes: a hand, a stop, another machine.
//!
//! A force that comes and goes is no law of the drive, and a few strokes of it outweigh all that a law explains. What the nominal law
//! lacks is regressed on everything that a rigid drive can have (its own effort for a wrong inertia, viscous and dry friction, a load by
//! place) by least trimmed squares, which half of the blocks cannot mislead (P. J. Rousseeuw, K. Van Driessen, *Data Mining and
//! Knowledge Discovery* 12, 2006, 29); blocks far from that fit are outside forces.

use nalgebra::{DMatrix, DVector};
use rand::SeedableRng as _;
use rand::seq::index::sample;
use rand_chacha::ChaCha12Rng;

use super::criteria::{FAR_FROM_REGRESSION, LEAST_OUTSIDE_SHARE, MOST_OUTSIDE_TIME};
use super::input::Inputs;
use super::law::DriveLaw;
use super::scales::Scales;
use super::trial::DriveTrial;
use crate::diagnose::median::median;

/// A stretch of a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Which trial.
    pub trial: usize,
    /// Its first moment, s on the trial's clock.
    pub start_s: f64,
    /// Its last moment, s.
    pub end_s: f64,
}

/// Length of a block, s: the missing force is seen up to 5 Hz, and two blocks make a period of that.
const BLOCK_S: f64 = 0.1;

/// Fewest blocks for each regressor.
const LEAST_BLOCKS_PER_VALUE: usize = 10;

/// Blocks that are left out on either side: the missing force is smoothed.
const MARGIN: usize = 2;

/// Random subsets that a search starts from, and steps of concentration: Rousseeuw and Van Driessen's.
const SUBSETS: usize = 500;
const FIRST_STEPS: usize = 2;
const KEPT: usize = 10;
const LAST_STEPS: usize = 20;

/// Mean of a block: the missing force, and the regressors.
struct Block {
    trial: usize,
    start_s: f64,
    end_s: f64,
    missing: f64,
    regressors: Vec<f64>,
}

/// Stretches of `trials` in which a force from outside acts; `missing` is what the nominal law lacks, a column a trial. Empty where
/// there is none, and where there is too little to tell.
#[must_use]
pub fn outside_forces(trials: &[DriveTrial], missing: &[Vec<f64>], law: &DriveLaw, scales: &Scales) -> Vec<Stretch> {
    let blocks: Vec<Block> = trials
        .iter()
        .zip(missing)
        .enumerate()
        .flat_map(|(number, (trial, missing))| blocks(number, trial, missing, law, scales))
        .collect();
    let Some(values) = blocks.first().map(|block| block.regressors.len()) else { return Vec::new() };
    if blocks.len() < LEAST_BLOCKS_PER_VALUE * values {
        return Vec::new();
    }
    let Some(residual) = trimmed_residual(&blocks) else { return Vec::new() };
    let deviation = median(residual.iter().map(|rest| rest.abs())).unwrap_or(0.0) / 0.6745;
    let is_far: Vec<bool> = residual.iter().map(|rest| rest.abs() > FAR_FROM_REGRESSION * deviation).collect();
    let squares = |wanted: bool| -> f64 {
        residual.iter().zip(&is_far).filter(|(_, far)| **far || !wanted).map(|(rest, _)| rest * rest).sum()
    };
    let stretches = stretches(&blocks, &is_far);
    let time = |trial: &DriveTrial| trial.duration_s();
    let outside: f64 = stretches.iter().map(|stretch| stretch.end_s - stretch.start_s).sum();
    let is_event = squares(true) > LEAST_OUTSIDE_SHARE * squares(false)
        && outside < MOST_OUTSIDE_TIME * trials.iter().map(time).sum::<f64>();
    if is_event { stretches } else { Vec::new() }
}

/// Means of `trial` over blocks that hold no gap.
fn blocks(number: usize, trial: &DriveTrial, missing: &[f64], law: &DriveLaw, scales: &Scales) -> Vec<Block> {
    let effort = Inputs::of(trial, law).effort;
    let rows = ((BLOCK_S / trial.period_s).round() as usize).max(2);
    let means = (0..trial.len() / rows).filter_map(|at| {
        let own = at * rows..(at + 1) * rows;
        if own.clone().skip(1).any(|row| trial.restart[row]) || trial.restart[own.start] {
            return None;
        }
        let mean = |of: &dyn Fn(usize) -> f64| own.clone().map(of).sum::<f64>() / rows as f64;
        let speed =
            |row: usize| (trial.position[row] - trial.position[row - 1]) / (trial.time[row] - trial.time[row - 1]);
        let usual = 1e-2 * scales.speed;
        let mut regressors = vec![
            1.0,
            mean(&|row| effort[row]) / scales.effort,
            mean(&speed) / scales.speed,
            mean(&|row| (speed(row) / usual).tanh()),
        ];
        if scales.is_rotary {
            regressors.extend([mean(&|row| trial.position[row].sin()), mean(&|row| trial.position[row].cos())]);
        } else {
            regressors.push(mean(&|row| (trial.position[row] - scales.lowest) / scales.travel));
        }
        let [start_s, end_s] = [trial.time[own.start], trial.time[own.end - 1]];
        Some(Block { trial: number, start_s, end_s, missing: mean(&|row| missing[row]), regressors })
    });
    means.collect()
}

/// Residual of every block under the fit of least trimmed squares; `None` where no subset determines one.
fn trimmed_residual(blocks: &[Block]) -> Option<Vec<f64>> {
    let values = blocks[0].regressors.len();
    let covered = usize::midpoint(blocks.len(), values + 1);
    let residual = |law: &DVector<f64>| -> Vec<f64> {
        let predicted = |block: &Block| block.regressors.iter().zip(law.iter()).map(|(x, c)| x * c).sum::<f64>();
        blocks.iter().map(|block| block.missing - predicted(block)).collect()
    };
    let closest = |law: &DVector<f64>| -> (Vec<usize>, f64) {
        let rest = residual(law);
        let mut order: Vec<usize> = (0..blocks.len()).collect();
        order.select_nth_unstable_by(covered - 1, |a, b| rest[*a].abs().total_cmp(&rest[*b].abs()));
        order.truncate(covered);
        let squares = order.iter().map(|at| rest[*at] * rest[*at]).sum();
        (order, squares)
    };
    let concentrated = |mut law: DVector<f64>, steps: usize| -> Option<(f64, DVector<f64>)> {
        for _ in 0..steps {
            law = fitted(blocks, &closest(&law).0)?;
        }
        Some((closest(&law).1, law))
    };
    let mut rng = ChaCha12Rng::seed_from_u64(0);
    let mut starts: Vec<(f64, DVector<f64>)> = (0..SUBSETS)
        .filter_map(|_| {
            concentrated(fitted(blocks, &sample(&mut rng, blocks.len(), values + 1).into_vec())?, FIRST_STEPS)
        })
        .collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts.truncate(KEPT);
    let ends = starts.into_iter().filter_map(|(_, law)| concentrated(law, LAST_STEPS));
    let (_, law) = ends.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(residual(&law))
}

/// Part of the diagonal that keeps a regressor that does not vary from being told.
const RIDGE: f64 = 1e-9;

/// Least squares over the blocks `of`.
fn fitted(blocks: &[Block], of: &[usize]) -> Option<DVector<f64>> {
    let count = blocks[0].regressors.len();
    let (mut matrix, mut right) = (DMatrix::<f64>::zeros(count, count), DVector::<f64>::zeros(count));
    for &at in of {
        let x = DVector::from_column_slice(&blocks[at].regressors);
        matrix.ger(1.0, &x, &x, 1.0);
        right.axpy(blocks[at].missing, &x, 1.0);
    }
    let ridge = RIDGE * matrix.trace().max(f64::MIN_POSITIVE);
    (0..count).for_each(|at| matrix[(at, at)] += ridge);
    Some(matrix.cholesky()?.solve(&right))
}

/// Far blocks with their margins, those that touch joined.
fn stretches(blocks: &[Block], is_far: &[bool]) -> Vec<Stretch> {
    let mut found: Vec<Stretch> = Vec::new();
    for (at, _) in is_far.iter().enumerate().filter(|(_, far)| **far) {
        let trial = blocks[at].trial;
        let mut own = at.saturating_sub(MARGIN)..(at + MARGIN + 1).min(blocks.len());
        while blocks[own.start].trial != trial {
            own.start += 1;
        }
        while blocks[own.end - 1].trial != trial {
            own.end -= 1;
        }
        let (start_s, end_s) = (blocks[own.start].start_s, blocks[own.end - 1].end_s);
        match found.last_mut() {
            Some(last) if last.trial == trial && start_s <= last.end_s + BLOCK_S => last.end_s = end_s,
            _ => found.push(Stretch { trial, start_s, end_s }),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::testing::TestDrive;
    use super::*;

    const SCALES: Scales = Scales {
        effort: 1.0,
        peak_effort: 5.0,
        usual_effort: 1.3,
        speed: 0.1,
        travel: 0.06,
        lowest: -0.03,
        period_s: 1e-3,
        recorded_period_s: 1e-3,
        latest_effort_s: 0.02,
        duration_s: 20.0,
        inertia: 0.8,
        inertia_factor: 5.0,
        viscous: 4.0,
        resolution: 0.0,
        is_rotary: false,
        touches: false,
    };

    /// Missing force by balance, of a drive whose motion does not matter here: dry friction, noise, and what `push` adds.
    fn missing(trial: &DriveTrial, push: impl Fn(f64) -> f64) -> Vec<f64> {
        let speed = |row: usize| trial.position[row] - trial.position[row.max(1) - 1];
        let friction = |row: usize| -0.3 * (speed(row) / 1e-6).tanh();
        (0..trial.len())
            .map(|row| friction(row) + push(trial.time[row]) + 0.01 * (1e3 * trial.time[row]).sin())
            .collect()
    }

    #[test]
    fn two_pushes_are_found_where_they_are_and_friction_is_none() {
        let trial = TestDrive { encoder: 0.0, ..TestDrive::PLAIN }.trial(20.0, 3);
        let law = DriveLaw::nominal(0.8, 4.0, 0.0);
        let pushed = missing(&trial, |t| if (4.0..5.0).contains(&t) || (12.0..12.5).contains(&t) { 8.0 } else { 0.0 });
        let found = outside_forces(std::slice::from_ref(&trial), &[pushed], &law, &SCALES);
        assert_eq!(found.len(), 2, "{found:?}");
        for (stretch, [start, end]) in found.iter().zip([[4.0, 5.0], [12.0, 12.5]]) {
            // A margin of two blocks on either side, and up to one where the push begins within a block.
            let margin = (MARGIN + 1) as f64 * BLOCK_S + 1e-9;
            assert!(stretch.start_s <= start && stretch.start_s > start - margin, "{stretch:?}");
            assert!(stretch.end_s >= end - 1e-3 && stretch.end_s < end + margin, "{stretch:?}");
        }
        let quiet = missing(&trial, |_| 0.0);
        assert_eq!(outside_forces(&[trial], &[quiet], &law, &SCALES), []);
    }
}
