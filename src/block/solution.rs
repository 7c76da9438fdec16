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
        if let Some(inverse) = sums.regressors.invert(config.independence_floor).filter(|_| moving) {
            let correction = inverse.times(sums.residual);
            if correction.is_finite() {
                return Self { correction, inverse, flags: Flags::empty() };
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
