//! Into how many parts trials are cut whose halves take turns with them: so that each half tells the law's values as well as may be.
//!
//! A half that moves one way alone does not tell dry friction from a load, whatever is true; its values then say nothing of the other. As
//! in the splitting of data for validation by R. D. Snee (*Technometrics* 19, 1977, 415), the halves are judged by the determinant of what
//! their rows tell of the values: here of inertia, damping, dry friction, a constant load and one that grows with the position.

use nalgebra::{SMatrix, SVector};

use super::criteria::SLOW_PART;
use super::trial::DriveTrial;

/// What a law's values act by: one, position, velocity, its direction, acceleration.
const REGRESSORS: usize = 5;

type Row = SVector<f64, REGRESSORS>;

/// Blocks of a trial whose motion is taken as one: a multiple of every number of parts.
const BLOCKS: usize = 240;

/// Numbers of parts that are tried.
const TRIED: [usize; 3] = [4, 2, 8];

/// Rows that a part holds at the least.
const LEAST_ROWS: usize = 200;

/// What is told of a value that nothing tells.
const LEAST_INFORMATION: f64 = 1e-9;

/// Parts of each of `trials`, at least two, under which the half that tells less tells most.
#[must_use]
pub fn parts(trials: &[DriveTrial]) -> Vec<usize> {
    let motions: Vec<Vec<Row>> = scaled(trials.iter().map(motion).collect());
    let of_each = |parts: usize| -> Vec<usize> {
        trials.iter().map(|trial| (trial.len() / LEAST_ROWS).clamp(2, parts)).collect()
    };
    let told = |parts: usize| {
        let each = of_each(parts);
        [0, 1].map(|half| information(&motions, &each, half)).into_iter().fold(f64::INFINITY, f64::min)
    };
    let tried = TRIED.map(|parts| (told(parts), parts));
    of_each(tried.into_iter().fold(tried[0], |best, other| if other.0 > best.0 { other } else { best }).1)
}

/// Which of both halves part `part` of trial number `trial` is in.
#[must_use]
pub const fn half_of(trial: usize, part: usize) -> usize {
    (trial + part) % 2
}

/// The motion of `trial` by blocks.
fn motion(trial: &DriveTrial) -> Vec<Row> {
    let blocks = BLOCKS.min(trial.len() / 2);
    let mut before = 0.0;
    let row = |block: usize| {
        let [start, end] = [block, block + 1].map(|block| (block * trial.len() / blocks).min(trial.len() - 1));
        let duration = trial.time[end] - trial.time[start];
        let velocity = (trial.position[end] - trial.position[start]) / duration.max(f64::MIN_POSITIVE);
        let acceleration = if block == 0 { 0.0 } else { (velocity - before) / duration.max(f64::MIN_POSITIVE) };
        before = velocity;
        Row::from([1.0, trial.position[start], velocity, 0.0, acceleration])
    };
    (0..blocks).map(row).collect()
}

/// `motions` over the usual size of each regressor, with the direction filled in.
fn scaled(mut motions: Vec<Vec<Row>>) -> Vec<Vec<Row>> {
    let count = motions.iter().map(Vec::len).sum::<usize>().max(1) as f64;
    let squares = motions.iter().flatten().fold(Row::zeros(), |sum, row| sum + row.component_mul(row));
    let size = squares.map(|sum| (sum / count).sqrt().max(f64::MIN_POSITIVE));
    for row in motions.iter_mut().flatten() {
        *row = row.component_div(&size);
        row[3] = row[2] / (row[2].abs() + SLOW_PART.value());
    }
    motions
}

/// ln of the determinant of what the blocks of `half` tell, where trials are cut into `parts`.
fn information(motions: &[Vec<Row>], parts: &[usize], half: usize) -> f64 {
    let mut told = SMatrix::<f64, REGRESSORS, REGRESSORS>::identity() * LEAST_INFORMATION;
    for (trial, (motion, parts)) in motions.iter().zip(parts).enumerate() {
        let of_half = |block: &usize| half_of(trial, block * parts / motion.len()) == half;
        for block in (0..motion.len()).filter(of_half) {
            told += motion[block] * motion[block].transpose();
        }
    }
    told.determinant().max(f64::MIN_POSITIVE).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A trial of 40 s at 100 Hz along `position`.
    fn along(position: impl Fn(f64) -> f64) -> DriveTrial {
        let time: Vec<f64> = (0..4000).map(|row| f64::from(row) / 100.0).collect();
        let position: Vec<f64> = time.iter().map(|time| position(*time)).collect();
        DriveTrial::new("trial".into(), time, &position, vec![0.0; 4000], None, 1)
    }

    /// Two strokes of 20 s, forth for ten and back for ten: of four parts in turns one half goes forth alone, of two or eight each goes both ways.
    #[test]
    fn no_half_moves_one_way_alone() {
        let stroke = |time: f64| {
            let phase = time % 20.0;
            0.01 * if phase < 10.0 { phase } else { 20.0 - phase } + 1e-3 * (3.0 * time).sin()
        };
        let found = parts(&[along(stroke)]);
        assert!(found == [2] || found == [8], "{found:?}");
    }

    /// A fast trial and a slow one in turns: with two parts in the order of time one half would hold the fast motion of one and nothing quick
    /// of the other.
    #[test]
    fn both_halves_see_what_is_quick() {
        let quick_first = |time: f64| if time < 20.0 { 0.01 * (3.0 * time).sin() } else { 0.01 * (0.2 * time).sin() };
        assert_ne!(parts(&[along(quick_first)]), [2]);
    }

    #[test]
    fn a_short_trial_is_cut_in_two() {
        let mut short = along(|time| time.sin());
        short.time.truncate(300);
        short.position.truncate(300);
        assert_eq!(parts(&[short]), [2]);
    }
}
