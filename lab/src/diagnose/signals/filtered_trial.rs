//! A trial as the analysis sees it: smoothed motion, force and effort at even steps.

use std::sync::Arc;

use super::derivative_filter::{CascadedFilter, DerivativeFilter};
use super::uniform_trial::UniformTrial;
use crate::diagnose::thresholds::filtered_trial::AT_REST_SIGMAS;

/// A smoothed trial. All columns are of equal length.
#[derive(Debug, Clone)]
pub struct FilteredTrial {
    /// Seconds between rows.
    pub step: f64,
    /// Width of the smoothing filter, s.
    pub filter_width: f64,
    /// Tool position.
    pub position: Vec<f64>,
    /// Its rate.
    pub velocity: Vec<f64>,
    /// Its acceleration.
    pub acceleration: Vec<f64>,
    /// Rate of the acceleration.
    pub jerk: Vec<f64>,
    /// Rate of the jerk.
    pub snap: Vec<f64>,
    /// Rate of the snap.
    pub crackle: Vec<f64>,
    /// Whether the tool stands still as far as can be seen, 0 or 1.
    pub at_rest: Vec<f64>,
    /// What of the velocity is noise.
    pub velocity_noise: f64,
    /// What of the acceleration is.
    pub acceleration_noise: f64,
    /// What of the force is.
    pub force_noise: f64,
    /// Speed at which the encoder steps once within the filter.
    pub one_step_speed: f64,
    /// Force reading.
    pub force: Option<Vec<f64>>,
    /// Its rate.
    pub force_rate: Option<Vec<f64>>,
    /// Rate of that.
    pub force_second_derivative: Option<Vec<f64>>,
    /// And of that.
    pub force_third_derivative: Option<Vec<f64>>,
    /// Effort, held from its row to the next.
    pub effort: Option<Vec<f64>>,
    /// Rate of the effort.
    pub effort_rate: Option<Vec<f64>>,
    /// The effort row by row as it was commanded, and the filter that made the columns of it.
    pub command: Option<CommandedEffort>,
    /// Whether a row was seen whole: not at an end, not beside a gap.
    pub valid: Vec<bool>,
    /// The same motion as laws see it, where the filter is passed in two.
    pub prefiltered: Option<Box<PrefilteredTrial>>,
}

/// A command before any filter.
#[derive(Debug, Clone)]
pub struct CommandedEffort {
    rows: Arc<Vec<f64>>,
    filter: DerivativeFilter,
}

impl CommandedEffort {
    /// The smoothed effort and its rate, if the rows are cut at `limit`.
    #[must_use]
    pub fn cut(&self, limit: f64) -> [Vec<f64>; 2] {
        let rows: Vec<f64> = self.rows.iter().map(|effort| effort.max(-limit).min(limit)).collect();
        [self.filter.smooth_held(&rows), self.filter.held_derivative(&rows)]
    }
}

/// A sharper view, and the filter that makes of what a law leaves there what it leaves in the track it belongs to.
#[derive(Debug, Clone)]
pub struct PrefilteredTrial {
    /// The view.
    pub trial: FilteredTrial,
    /// The rest of the filter.
    pub second_filter: DerivativeFilter,
}

/// A trial through both filters: the contact is analysed with as wide a band as its force allows, the drive as its acceleration does.
#[derive(Debug, Clone)]
pub struct AnalysisTrial {
    /// Which of the trials.
    pub number: usize,
    /// For the force reading.
    pub contact: FilteredTrial,
    /// For the drive's balance.
    pub drive: FilteredTrial,
}

impl AnalysisTrial {
    /// The track of a channel.
    #[must_use]
    pub fn filtered(&self, effort: bool) -> &FilteredTrial {
        if effort { &self.drive } else { &self.contact }
    }
}

impl FilteredTrial {
    /// Looks at `raw` through `filter`.
    #[must_use]
    pub fn of(raw: &UniformTrial, filter: &DerivativeFilter) -> Self {
        let prefiltered = filter.passes().map(|passes| {
            let CascadedFilter { first, second } = passes;
            Box::new(PrefilteredTrial { trial: Self::of(raw, first), second_filter: second.clone() })
        });
        let [level_noise, slope_noise, bend_noise] = filter.noise();
        let noise = raw.figures.position.noise;
        let (velocity_noise, acceleration_noise) = (noise * slope_noise, noise * bend_noise);
        let (velocity, acceleration) =
            (filter.first_derivative(&raw.position), filter.second_derivative(&raw.position));
        let at_rest = velocity.iter().zip(&acceleration).map(|(speed, shake)| {
            f64::from(
                speed.abs() <= AT_REST_SIGMAS * velocity_noise && shake.abs() <= AT_REST_SIGMAS * acceleration_noise,
            )
        });
        Self {
            step: filter.step(),
            filter_width: filter.filter_width,
            position: filter.smooth(&raw.position),
            at_rest: at_rest.collect(),
            velocity,
            acceleration,
            jerk: filter.jerk(&raw.position),
            snap: filter.snap(&raw.position),
            crackle: filter.crackle(&raw.position),
            velocity_noise,
            acceleration_noise,
            force_noise: raw.figures.force.map_or(0.0, |force| force.noise * level_noise),
            one_step_speed: raw.figures.position.resolution / filter.filter_width,
            force: raw.force.as_ref().map(|force| filter.smooth(force)),
            force_rate: raw.force.as_ref().map(|force| filter.first_derivative(force)),
            force_second_derivative: raw.force.as_ref().map(|force| filter.second_derivative(force)),
            force_third_derivative: raw.force.as_ref().map(|force| filter.jerk(force)),
            effort: raw.effort.as_ref().map(|effort| filter.smooth_held(effort)),
            effort_rate: raw.effort.as_ref().map(|effort| filter.held_derivative(effort)),
            command: None,
            valid: seen(raw, filter),
            prefiltered,
        }
    }

    /// The same with the commands of `raw`, which it was made of through `filter`.
    #[must_use]
    pub fn commanded(mut self, raw: &UniformTrial, filter: &DerivativeFilter) -> Self {
        let Some(rows) = raw.effort.clone().map(Arc::new) else { return self };
        if let (Some(prefiltered), Some(passes)) = (&mut self.prefiltered, filter.passes()) {
            prefiltered.trial.command = Some(CommandedEffort { rows: rows.clone(), filter: passes.first.clone() });
        }
        self.command = Some(CommandedEffort { rows, filter: filter.clone() });
        self
    }

    /// The view that laws act in.
    #[must_use]
    pub fn law_input(&self) -> &Self {
        self.prefiltered.as_ref().map_or(self, |prefiltered| &prefiltered.trial)
    }

    /// What `law` leaves of it: of the sharper view, if there is one, and smoothed like the rest then.
    pub fn apply_law(&self, law: impl Fn(&Self) -> Vec<f64>) -> Vec<f64> {
        match &self.prefiltered {
            Some(prefiltered) => prefiltered.second_filter.smooth(&law(&prefiltered.trial)),
            None => law(self),
        }
    }

    /// Rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
}

fn seen(raw: &UniformTrial, filter: &DerivativeFilter) -> Vec<bool> {
    let half_width_rows = filter.half_width_rows();
    let rows = raw.len();
    // Bad rows up to each row, so that a stretch is looked up in two steps.
    let mut sum = vec![0usize; rows + 1];
    for (at, good) in raw.good.iter().enumerate() {
        sum[at + 1] = sum[at] + usize::from(!good);
    }
    (0..rows)
        .step_by(filter.stride)
        .map(|at| {
            at >= half_width_rows
                && at + half_width_rows < rows
                && sum[at + half_width_rows + 1] == sum[at - half_width_rows]
        })
        .collect()
}
