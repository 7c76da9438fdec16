//! Recursive least squares in two or three parameters, with forgetting and the reset at a change.

use crate::change_detector::{ChangeConfig, ChangeState};
use crate::error::{ConfigError, require, require_positive};
use crate::math::{larger, smaller, sqrt};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of [`ParameterRls`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParameterRlsConfig<const P: usize> {
    /// lambda, above 0.5 and at most 1.
    pub forgetting_factor: f32,
    /// Standard deviation of the force that one sample is trusted for, internal units.
    pub noise: f32,
    /// Spread of each parameter about zero before the first sample, internal units.
    pub spreads: [f32; P],
    /// When to begin again; never where there is none, which makes it the exponentially weighted law.
    pub change: Option<ChangeConfig>,
    /// Samples that one independent value of the noise is worth ([`crate::ModelStream::correlated_samples`]).
    pub correlated_samples: f32,
}

/// The recursion of [`crate::Ewrls`] and [`crate::CusumRls`] for the rows of [`crate::ModelStream`]: `U D U'` by Bierman's update, so
/// that the covariance keeps its sign in single precision. At two parameters and the same settings it is theirs.
#[derive(Debug, Clone, Copy)]
pub struct ParameterRls<const P: usize> {
    config: ParameterRlsConfig<P>,
}

/// What has been learnt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParameterState<const P: usize> {
    /// The parameters, internal units.
    pub parameters: [f32; P],
    diagonal: [f32; P],
    upper: [[f32; P]; P],
    change: ChangeState,
    /// Sums of innovation times residual, of the weights, and of their squares.
    square: f32,
    weight: f32,
    weight_squared: f32,
}

/// One update.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct ParameterStep {
    /// Force minus what the parameters before predicted, internal units.
    pub innovation: f32,
    /// The material was found to have changed.
    pub changed: bool,
}

impl<const P: usize> ParameterRls<P> {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: ParameterRlsConfig<P>) -> Result<Self, ConfigError> {
        const { assert!(P >= 1 && P <= 3, "one to three parameters") };
        let lambda = config.forgetting_factor;
        require(lambda > 0.5 && lambda <= 1.0, "forgetting_factor", "above 0.5 and at most 1")?;
        require_positive(config.noise, "noise")?;
        for spread in config.spreads {
            require((1e-6..=1e6).contains(&(spread / config.noise)), "spreads", "1e-6 to 1e6 times the noise")?;
        }
        config.change.map(ChangeConfig::check).transpose()?;
        require(config.correlated_samples >= 1.0, "correlated_samples", "at least 1")?;
        Ok(Self { config })
    }

    /// Before the first row.
    pub fn initial_state(&self) -> ParameterState<P> {
        self.from([0.0; P], ChangeState::default())
    }

    fn from(&self, parameters: [f32; P], change: ChangeState) -> ParameterState<P> {
        let mut upper = [[0.0; P]; P];
        for (j, row) in upper.iter_mut().enumerate() {
            row.iter_mut().skip(j).take(1).for_each(|one| *one = 1.0);
        }
        ParameterState {
            parameters,
            diagonal: self.variances(),
            upper,
            change,
            square: 0.0,
            weight: 0.0,
            weight_squared: 0.0,
        }
    }

    fn variances(&self) -> [f32; P] {
        self.config.spreads.map(|spread| (spread / self.config.noise) * (spread / self.config.noise))
    }

    /// One row of the regression. A row that would leave the finite numbers is not taken.
    pub fn update(&self, state: &mut ParameterState<P>, phi: [f32; P], force: f32) -> ParameterStep {
        let innovation = force - dot(&phi, &state.parameters);
        let change = self.config.change.as_ref();
        let changed = change.is_some_and(|change| change.update(&mut state.change, innovation));
        if changed {
            *state = self.from(state.parameters, state.change);
        }
        let mut next = *state;
        let gain = self.observe(&mut next, &phi);
        for (parameter, gain) in next.parameters.iter_mut().zip(&gain) {
            *parameter += gain * innovation;
        }
        let lambda = self.config.forgetting_factor;
        next.square = lambda * state.square + innovation * innovation * (1.0 - dot(&phi, &gain)).abs();
        next.weight = lambda * state.weight + 1.0;
        next.weight_squared = lambda * lambda * state.weight_squared + 1.0;
        if next.is_sound() {
            *state = next;
        }
        ParameterStep { innovation, changed }
    }

    /// Bierman's update of `U D U'`; the gain.
    fn observe(&self, state: &mut ParameterState<P>, phi: &[f32; P]) -> [f32; P] {
        let lambda = self.config.forgetting_factor;
        let (upper, limits) = (&mut state.upper, self.variances());
        let mut f = *phi;
        for j in 0..P {
            for i in 0..j {
                f[j] += upper[i][j] * phi[i];
            }
        }
        let mut gain = [0.0; P];
        let mut alpha = lambda;
        for j in 0..P {
            let g = state.diagonal[j] * f[j];
            let (last, share) = (alpha, -f[j] / alpha);
            alpha += f[j] * g;
            state.diagonal[j] = smaller(state.diagonal[j] * (last / alpha) / lambda, limits[j]);
            for i in 0..j {
                let old = upper[i][j];
                upper[i][j] = old + gain[i] * share;
                gain[i] += old * g;
            }
            gain[j] = g;
        }
        gain.map(|gain| gain / alpha)
    }

    /// Half-widths of the 95 % intervals, internal units: `1.96 sqrt(c s^2 P_jj w2 / w)` with c the correlated samples, s^2 the mean of
    /// innovation times residual, never below the square of the noise over c, and w, w2 the sums of the weights and of their squares: P
    /// takes a weight for a variance, and samples that fade out weigh less than they scatter. It covers noise, not a model that does not
    /// fit.
    pub fn half_widths(&self, state: &ParameterState<P>) -> [f32; P] {
        let c = self.config.correlated_samples;
        let known = self.config.noise * self.config.noise / c;
        let weight = larger(state.weight, 1.0);
        let faded = larger(state.weight_squared, 1.0) / weight;
        let square = larger(state.square / weight, known) * faded;
        let mut widths = [0.0; P];
        for (j, width) in widths.iter_mut().enumerate() {
            let variance: f32 = state
                .upper
                .get(j)
                .map_or(f32::INFINITY, |row| row.iter().zip(&state.diagonal).skip(j).map(|(u, d)| u * u * d).sum());
            *width = 1.96 * sqrt(c * square * variance);
        }
        widths
    }
}

impl<const P: usize> ParameterState<P> {
    fn is_sound(&self) -> bool {
        let positive = self.diagonal.iter().all(|d| *d > 0.0 && d.is_finite());
        let finite = self.parameters.iter().chain(self.upper.iter().flatten()).all(|value| value.is_finite());
        positive && finite && self.square.is_finite()
    }
}

fn dot<const P: usize>(a: &[f32; P], b: &[f32; P]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
