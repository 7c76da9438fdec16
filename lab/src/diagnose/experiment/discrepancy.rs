//! What a wrong model leaves of what the right one shows.

use super::hypothesis::Hypothesis;
use super::synthetic_rig::SyntheticRig;
use crate::diagnose::estimation::levenberg_marquardt::{self, FitData};
use crate::diagnose::estimation::whitener::{NoiseModel, Whitener};
use crate::diagnose::model::Channels;
use crate::diagnose::signals::filtered_trial::{AnalysisTrial, FilteredTrial};

/// What a wrong model leaves of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Discrepancy {
    /// Sum of squares over the noise models of both channels, beyond what the right model leaves.
    pub energy: f64,
    /// Root mean square in the force reading, N or N m; zero where there is none.
    pub force: f64,
    /// Root mean square in the drive's balance.
    pub effort: f64,
}

impl SyntheticRig<'_> {
    /// What `rival`, all of its values refitted, leaves of `trials`.
    #[must_use]
    pub fn left(&self, rival: &Hypothesis, trials: &[AnalysisTrial]) -> Discrepancy {
        let whitener = self.even(trials);
        let data = FitData { trials, whitener: &whitener, rows: None };
        // From its own values and from the answer's: what looks told apart may be a search that got lost.
        let starts = [rival.values.clone(), rival.about(self.answer())];
        let fits = starts.iter().map(|start| levenberg_marquardt::fit(&data, &rival.model, start, &rival.excitation));
        let best = fits.min_by(|a, b| a.energy.total_cmp(&b.energy));
        let Some(rival_fit) = best else { return Discrepancy { energy: 0.0, force: 0.0, effort: 0.0 } };
        let rests: Vec<_> =
            trials.iter().map(|trial| rival.model.residual(&rival_fit.values, trial, Channels::BOTH)).collect();
        let force = counted(&whitener.force, rests.iter().map(|rest| &rest.force));
        let effort = counted(&whitener.effort, rests.iter().map(|rest| &rest.effort));
        let own = data.energy(&self.answer().model, &self.answer().values);
        Discrepancy {
            energy: (rival_fit.energy - own).max(0.0),
            force: root_mean_square(&force),
            effort: root_mean_square(&effort),
        }
    }

    /// Even noise models, raised so that a row counts for what it is worth.
    fn even(&self, trials: &[AnalysisTrial]) -> Whitener {
        let channel = |effort: bool| {
            let at = usize::from(effort);
            let filtered_trials: Vec<&FilteredTrial> = trials.iter().map(|trial| trial.filtered(effort)).collect();
            self.noise_models[at]
                .map(|noise_model| NoiseModel::even(&filtered_trials, noise_model * self.memory[at].sqrt()))
        };
        Whitener { force: channel(false), effort: channel(true) }
    }
}

/// The rows that count of a channel, all trials together.
fn counted<'a>(noise_model: &Option<NoiseModel>, rests: impl Iterator<Item = &'a Vec<f64>>) -> Vec<f64> {
    let rows = noise_model.iter().flat_map(|noise_model| &noise_model.rows);
    rows.zip(rests).flat_map(|(rows, rest)| rows.iter().filter_map(|&row| rest.get(row).copied())).collect()
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
