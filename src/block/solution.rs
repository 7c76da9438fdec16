//! The least-squares solution of a window's sums.

use crate::block::config::BlockConfig;
use crate::block::second_order::SecondOrderSums;
use crate::contact::Impedance;
use crate::math::larger;
use crate::math::sym2::Sym2;
use crate::quality::Flags;

/// The least-squares solution of a window, as a move from the estimate that the sums were taken about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution {
    pub correction: Impedance,
    pub inverse: Sym2,
    pub flags: Flags,
}

impl Solution {
    /// Both where the tool moves and the columns are independent, K alone where they are in line or it holds still,
    /// neither where it is not in the surface.
    ///
    /// A prior of `config` pulls towards zero; `centre` is the estimate that the sums of so many `samples` were taken about.
    #[inline(always)]
    pub fn of(sums: &SecondOrderSums, samples: f32, config: &BlockConfig, centre: Impedance) -> Self {
        match config.prior {
            None => Self::plain(sums, samples, config),
            Some(prior) => {
                let (ridge, mut sums) = (prior.ridge(), *sums);
                sums.regressors.xx += ridge.stiffness;
                sums.regressors.vv += ridge.damping;
                sums.residual.stiffness -= ridge.stiffness * centre.stiffness;
                sums.residual.damping -= ridge.damping * centre.damping;
                Self::plain(&sums, samples, config)
            }
        }
    }

    fn plain(sums: &SecondOrderSums, samples: f32, config: &BlockConfig) -> Self {
        let moving = sums.regressors.vv > samples * (config.rate_floor * config.rate_floor);
        if let Some(regressors) = sums.regressors.factored(config.independence_floor).filter(|_| moving) {
            let correction = regressors.solve(sums.residual);
            if correction.is_finite() {
                return Self { correction, inverse: regressors.inverse(), flags: Flags::empty() };
            }
        }
        let stiffness = sums.residual.stiffness / sums.regressors.xx;
        if sums.regressors.xx > 0.0 && stiffness.is_finite() {
            return Self {
                correction: Impedance { stiffness, damping: 0.0 },
                inverse: Sym2 { xx: 1.0 / sums.regressors.xx, ..Sym2::UNKNOWN },
                flags: Flags::DAMPING_HELD,
            };
        }
        Self { correction: Impedance::ZERO, inverse: Sym2::UNKNOWN, flags: Flags::HELD }
    }

    /// Mean square of the residual that the solution leaves.
    pub fn residual_variance(&self, sums: &SecondOrderSums, samples: f32) -> f32 {
        let explained =
            self.correction.stiffness * sums.residual.stiffness + self.correction.damping * sums.residual.damping;
        let left = sums.residual_energy - explained;
        if left > 0.0 { left / larger(samples - 2.0, 1.0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two unknowns are taken off the count of samples, and at least one sample is left.
    #[test]
    fn the_residual_variance_is_unbiased() {
        let sums = SecondOrderSums {
            regressors: Sym2::diagonal(4.0, 2.0),
            residual: Impedance { stiffness: 8.0, damping: 2.0 },
            residual_energy: 30.0,
            ..SecondOrderSums::default()
        };
        let solution = Solution::of(&sums, 8.0, &BlockConfig::default(), Impedance::ZERO);
        assert_eq!(solution.correction, Impedance { stiffness: 2.0, damping: 1.0 });
        // 30 - (2 * 8 + 1 * 2) = 12 over so many samples less two.
        for (samples, variance) in [(8.0, 2.0), (6.0, 3.0), (5.0, 4.0), (3.0, 12.0), (2.0, 12.0)] {
            assert_eq!(solution.residual_variance(&sums, samples), variance, "{samples} samples");
        }
        let explained = SecondOrderSums { residual_energy: 17.0, ..sums };
        assert_eq!(solution.residual_variance(&explained, 8.0), 0.0, "rounding does not make it negative");
    }
}
