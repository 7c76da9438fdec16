//! Where the tool's velocity jumps within a row: a blow.
//!
//! The adjoint r of the fixed-interval smoother and its variance N are all that the rows from one on say of a shock before that row: the
//! most likely jump of a component of the state is r / N, and twice the gain of log likelihood by it is r^2 / N, chi-squared of one degree
//! of freedom where there is none. One pass tests every row (P. de Jong, J. Penzer, *Diagnosing shocks in time series*, J. Am. Stat. Assoc. 93
//! (1998) 796; A. S. Willsky, H. L. Jones, IEEE Trans. Autom. Control 21 (1976) 108).

use super::criteria::FALSE_JUMP;
use super::third_integral::{Matrix, Vector};

/// What the rows from one on say of a jump before it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct JumpTest {
    /// Most likely jump of the velocity, in deviations of a row over the usual step.
    pub size: f64,
    /// Twice the log likelihood that it gains.
    pub statistic: f64,
}

impl JumpTest {
    /// Of the `adjoint` state at a row, of the smoother's sign (the smoothed state is the filtered one less the covariance times it), and its variance,
    /// `information`, for a jump in the middle of the `step` before it.
    #[must_use]
    pub fn of(adjoint: &Vector, information: &Matrix, step: f64) -> Self {
        let moved = 0.5 * step;
        let spread = information[1][1] + moved * (2.0 * information[0][1] + moved * information[0][0]);
        // Behind the last row nothing is known of the velocity.
        if spread <= f64::EPSILON {
            return Self::default();
        }
        let drive = -(adjoint[1] + moved * adjoint[0]);
        Self { size: drive / spread, statistic: drive * drive / spread }
    }
}

/// Lets the velocity jump by a deviation of the root of `variance` at an instant anywhere in the `step` before a row: a jump d with t left has moved the
/// position by d t, of second moments d^2 (h^2 / 3, h / 2, 1) over a whole step h.
pub fn allow(covariance: &mut Matrix, step: f64, variance: f64) {
    covariance[0][0] += variance * step * step / 3.0;
    covariance[0][1] += variance * step / 2.0;
    covariance[1][0] += variance * step / 2.0;
    covariance[1][1] += variance;
}

/// Memories of the smoother to either side of a jump within which what shows is that jump: what a jump leaves of its own statistic falls by e
/// with each, to a fiftieth.
const OWN_MEMORIES: f64 = 4.0;

/// The rows before which the velocity jumps by more than chance in any of them, the greatest first. One explains what shows
/// within `OWN_MEMORIES` of it, of `memory` rows each.
#[must_use]
pub fn beyond_chance(tests: &[JumpTest], memory: f64) -> Vec<usize> {
    // A deviation beyond s^1/2 to either side has a probability below e^(-s/2).
    let least = 2.0 * (tests.len() as f64 / FALSE_JUMP.value()).ln();
    let mut rows: Vec<usize> = (0..tests.len()).filter(|&row| tests[row].statistic > least).collect();
    rows.sort_by(|&a, &b| tests[b].statistic.total_cmp(&tests[a].statistic));
    let apart = OWN_MEMORIES * memory.max(1.0);
    let mut taken = std::collections::BTreeSet::new();
    rows.retain(|&row| {
        let (low, high) = ((row as f64 - apart).max(0.0) as usize, row + apart as usize);
        taken.range(low..=high).next().is_none() && taken.insert(row)
    });
    rows
}
