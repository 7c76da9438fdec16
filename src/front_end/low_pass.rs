//! The low-pass: second-order Butterworth in state-variable form.

use crate::math::tan;

/// Coefficients for one pair of cut-off and sample period.
///
/// The trapezoidal state-variable form (bilinear transform, pre-warped by `g = tan(pi f T)`): at a steady period it is
/// the textbook Butterworth filter, it stays stable when the period changes from sample to sample, and in single
/// precision it keeps its accuracy at low cut-offs, where a direct form loses it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LowPass {
    g: f32,
    damping: f32,
    norm: f32,
}

/// One channel's memory; its rest value is its input's.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LowPassState {
    band: f32,
    low: f32,
}

impl LowPass {
    /// The largest product of cut-off and period: at 0.4 the cut-off is four fifths of the Nyquist frequency.
    pub const LIMIT: f32 = 0.4;

    /// `cycles` is the cut-off times the sample period, above 0 and at most [`Self::LIMIT`].
    pub fn new(cycles: f32) -> Self {
        let g = tan(core::f32::consts::PI * cycles);
        let damping = core::f32::consts::SQRT_2 + g;
        Self { g, damping, norm: 1.0 / (1.0 + g * damping) }
    }

    /// Takes one input, returns the output.
    pub fn update(&self, state: &mut LowPassState, input: f32) -> f32 {
        let high = (input - state.low - self.damping * state.band) * self.norm;
        let band = self.g * high + state.band;
        let low = self.g * band + state.low;
        state.band = self.g * high + band;
        state.low = self.g * band + low;
        low
    }

    /// Equivalent noise bandwidth over cut-off of a second-order Butterworth filter, pi / (2 sqrt 2).
    pub const NOISE_BANDWIDTH: f32 = core::f32::consts::PI / (2.0 * core::f32::consts::SQRT_2);
}

impl LowPassState {
    /// At rest at `value`.
    pub const fn at_rest(value: f32) -> Self {
        Self { band: 0.0, low: value }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filter_at_rest_stays_there_and_a_step_settles() {
        let filter = LowPass::new(0.02);
        let mut state = LowPassState::at_rest(-3.5);
        assert_eq!(filter.update(&mut state, -3.5), -3.5);
        let mut output = 0.0;
        for _ in 0..2000 {
            output = filter.update(&mut state, 1.25);
        }
        assert!((output - 1.25).abs() <= 4.0 * f32::EPSILON, "{output}");
    }

    #[test]
    fn at_its_cut_off_it_passes_half_the_power() {
        for cycles in [0.002_f32, 0.02, 0.1, 0.3, 0.4] {
            let filter = LowPass::new(cycles);
            let (mut state, mut power) = (LowPassState::default(), 0.0_f64);
            let (settle, measured) = (20_000_u32, 50_000_u32);
            for k in 0..settle + measured {
                let phase = (f64::from(cycles) * f64::from(k)).fract() * core::f64::consts::TAU;
                let output = filter.update(&mut state, libm::sin(phase) as f32);
                if k >= settle {
                    power += f64::from(output) * f64::from(output);
                }
            }
            // A sine has a mean square of one half; the sum covers whole cycles.
            let gain = power / f64::from(measured) / 0.5;
            assert!((gain - 0.5).abs() < 5e-4, "{cycles}: {gain}");
        }
    }
}
