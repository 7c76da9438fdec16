//! Where a motion is livelier than in the rest of its trial.
//!
//! The adjoint r of the fixed-interval smoother and its variance N say of the process noise of each step, of covariance Q, whether it is as large as taken: r' Q r is
//! tr(N Q) in the mean where it is. Q times the root of the ratio of both sums gains likelihood in every round (H. Zhou, L. Hu, J. Zhou, K. Lange,
//! *MM algorithms for variance components models*, J. Comput. Graph. Stat. 28 (2019) 350); here the sums are those of the rows about each row. Only what is livelier is
//! raised: that a tool moves less than an encoder shows cannot be read from it.

use super::third_integral::{Matrix, Vector};

/// What the rows say of the density of the process noise before one of them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DensityEvidence {
    /// r' Q r.
    pub found: f64,
    /// Its mean where the density is right, tr(N Q).
    pub expected: f64,
}

impl DensityEvidence {
    /// From the `adjoint` state at a row and its variance, `information`, for a process noise of covariance `noise` before it.
    #[must_use]
    pub fn of(adjoint: &Vector, information: &Matrix, noise: &Matrix) -> Self {
        let mut evidence = Self::default();
        for row in 0..3 {
            for column in 0..3 {
                evidence.found += adjoint[row] * noise[row][column] * adjoint[column];
                evidence.expected += noise[row][column] * information[row][column];
            }
        }
        evidence
    }
}

/// Memories of the smoother to either side of a row over which its density is judged. From 5 to 15 the errors of position and velocity, and how well they are
/// known, are the same within two per cent.
const MEMORIES: f64 = 10.0;

/// Raises the `parts` of the trial's density before each row where the evidence about it asks, one round; `memory` in rows.
pub fn raise(parts: &mut [f64], evidence: &[DensityEvidence], memory: f64) {
    let (count, reach) = (parts.len(), (MEMORIES * memory.max(1.0)).ceil() as usize);
    if 2 * reach >= count {
        return;
    }
    let mut sums = vec![DensityEvidence::default(); count + 1];
    for (row, of_row) in evidence.iter().enumerate() {
        let found = sums[row].found + of_row.found;
        sums[row + 1] = DensityEvidence { found, expected: sums[row].expected + of_row.expected };
    }
    for (row, part) in parts.iter_mut().enumerate() {
        let (first, last) = (sums[row.saturating_sub(reach)], sums[(row + reach + 1).min(count)]);
        let ratio = (last.found - first.found) / (last.expected - first.expected).max(f64::MIN_POSITIVE);
        *part = (*part * ratio.sqrt()).max(1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: twice the expected squares raise the density by the root of two, half of them leave it; rows beyond the reach say nothing of it.
    #[test]
    fn only_what_is_livelier_is_raised() {
        let mut evidence = vec![DensityEvidence { found: 0.5, expected: 1.0 }; 300];
        evidence[200..].fill(DensityEvidence { found: 2.0, expected: 1.0 });
        let mut parts = vec![1.0; 300];
        raise(&mut parts, &evidence, 2.0);
        assert!(parts[..170].iter().all(|part| *part == 1.0));
        assert!(parts[220..].iter().all(|part| (part - 2f64.sqrt()).abs() < 1e-9), "{:?}", &parts[220..]);
        let mut short = vec![1.0; 300];
        raise(&mut short, &evidence, 15.0);
        assert_eq!(short, vec![1.0; 300]);
    }
}
