//! The parts of the uncertainty of an estimate.

use crate::contact::Impedance;
use crate::math::sym2::Sym2;

/// The parts of the uncertainty of one estimate, in internal units.
///
/// The variance of the estimate is `c * noise`, c being the number of samples that one independent value of the noise is
/// worth; beside it stand two errors that averaging does not reduce, `startup_bias` and `offset_gain` times the force that a
/// misplaced surface makes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Confidence {
    /// Variance of the estimate if the residuals that were seen are white noise.
    pub noise: Sym2,
    /// The same for white noise of variance one.
    pub noise_gain: Sym2,
    /// Bias that is left from the initial estimate of a recursive law, or the distance that an iterative descent still has to its
    /// minimum.
    pub startup_bias: Impedance,
    /// Change of the estimate for a constant force of one unit.
    pub offset_gain: Impedance,
    /// Samples that the estimate rests on, by weight.
    pub samples: f32,
}

impl Confidence {
    /// No information: infinite variance.
    pub const NONE: Self = Self {
        noise: Sym2::UNKNOWN,
        noise_gain: Sym2::UNKNOWN,
        startup_bias: Impedance::ZERO,
        offset_gain: Impedance::ZERO,
        samples: 0.0,
    };
}
