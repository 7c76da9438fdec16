//! The recordings as an explanation would give them: what they hold of its values, and what they would have shown of another rig.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::discrimination::{LinearizedResponse, Noise, prior, steps, whitened};
use super::loop_model::LoopModel;
use super::prediction::predict;
use crate::recording::Recording;
use crate::rig::Rig;

/// Rows of a recorded reference that are simulated, for the time that it takes.
pub const MAX_RECORDED_ROWS: usize = 30_000;

/// An explanation along every recorded reference.
pub struct Recorded<'a> {
    closed_loop: &'a LoopModel,
    noise: &'a Noise,
    references: Vec<&'a [f64]>,
    responses: Vec<LinearizedResponse>,
    information: DMatrix<f64>,
}

impl<'a> Recorded<'a> {
    /// `rig` along the references of `trials`, but for those along which it cannot be simulated; steps of its values are scaled by `travel`.
    #[must_use]
    pub fn new(rig: &Rig, trials: &'a [Recording], closed_loop: &'a LoopModel, noise: &'a Noise, travel: f64) -> Self {
        let steps = steps(rig, travel);
        let references: Vec<&[f64]> = trials
            .iter()
            .filter_map(|trial| trial.reference.as_ref())
            .map(|reference| &reference[..reference.len().min(MAX_RECORDED_ROWS)])
            .collect();
        let along = |reference: &&'a [f64]| {
            let response = LinearizedResponse::new(rig, &steps, closed_loop, reference, noise).ok()?;
            Some((*reference, response))
        };
        let (references, responses): (Vec<_>, Vec<_>) = references.par_iter().filter_map(along).unzip();
        let information = responses.iter().fold(prior(steps.len()), |sum, response| sum + response.information());
        Self { closed_loop, noise, references, responses, information }
    }

    /// Fisher information that they hold of the explanation's values, a step each, with what was known of them beforehand.
    #[must_use]
    pub fn information(&self) -> &DMatrix<f64> {
        &self.information
    }

    /// Energy of the difference to `rig` along all of them, after the best change of the explanation's values; infinite where `rig` cannot
    /// be simulated.
    #[must_use]
    pub fn energy(&self, rig: &Rig) -> f64 {
        let (mut own, mut gradient) = (0.0, DVector::zeros(self.information.ncols()));
        for (reference, here) in self.references.iter().zip(&self.responses) {
            let Ok(shown) = predict(rig, self.closed_loop, reference) else { return f64::INFINITY };
            let response = whitened(&shown, self.noise);
            if response.len() != here.response.len() {
                return f64::INFINITY;
            }
            let difference = response - &here.response;
            own += difference.norm_squared();
            gradient += here.sensitivity.tr_mul(&difference);
        }
        let Some(solver) = self.information.clone().cholesky() else { return f64::INFINITY };
        let left = own - gradient.dot(&solver.solve(&gradient));
        if left.is_nan() { f64::INFINITY } else { left.max(0.0) }
    }
}
