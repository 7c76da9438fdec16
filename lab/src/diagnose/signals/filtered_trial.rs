//! A trial as the analysis sees it: smoothed motion, force and effort at even steps.

use std::sync::Arc;

use super::derivative_filter::{Lens, Passes};
use super::uniform_trial::Raw;

/// A smoothed trial. All columns are of equal length.
#[derive(Debug, Clone)]
pub struct Track {
    /// Seconds between rows.
    pub step: f64,
    /// Width of the smoothing filter, s.
    pub blur: f64,
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
    pub still: Vec<f64>,
    /// What of the velocity is noise.
    pub speed_noise: f64,
    /// What of the acceleration is.
    pub shake_noise: f64,
    /// What of the force is.
    pub force_noise: f64,
    /// Speed at which the encoder steps once within the filter.
    pub pace: f64,
    /// Force reading.
    pub force: Option<Vec<f64>>,
    /// Its rate.
    pub force_rate: Option<Vec<f64>>,
    /// Rate of that.
    pub force_bend: Option<Vec<f64>>,
    /// And of that.
    pub force_jerk: Option<Vec<f64>>,
    /// Effort, held from its row to the next.
    pub effort: Option<Vec<f64>>,
    /// Rate of the effort.
    pub effort_rate: Option<Vec<f64>>,
    /// The effort row by row as it was commanded, and the filter that made the columns of it.
    pub command: Option<Command>,
    /// Whether a row was seen whole: not at an end, not beside a gap.
    pub seen: Vec<bool>,
    /// The same motion as laws see it, where the filter is passed in two.
    pub near: Option<Box<Near>>,
}

/// A command before any filter.
#[derive(Debug, Clone)]
pub struct Command {
    rows: Arc<Vec<f64>>,
    lens: Lens,
}

impl Command {
    /// The smoothed effort and its rate, if the rows are cut at `limit`.
    #[must_use]
    pub fn cut(&self, limit: f64) -> [Vec<f64>; 2] {
        let rows: Vec<f64> = self.rows.iter().map(|effort| effort.max(-limit).min(limit)).collect();
        [self.lens.held(&rows), self.lens.held_slope(&rows)]
    }
}

/// A sharper view, and the filter that makes of what a law leaves there what it leaves in the track it belongs to.
#[derive(Debug, Clone)]
pub struct Near {
    /// The view.
    pub track: Track,
    /// The rest of the filter.
    pub rest: Lens,
}

/// A trial through both lenses: the contact is looked at as sharply as its force allows, the drive as its acceleration does.
#[derive(Debug, Clone)]
pub struct Trial {
    /// Which of the trials.
    pub number: usize,
    /// For the force reading.
    pub contact: Track,
    /// For the drive's balance.
    pub drive: Track,
}

impl Trial {
    /// The track of a channel.
    #[must_use]
    pub fn track(&self, effort: bool) -> &Track {
        if effort { &self.drive } else { &self.contact }
    }
}

/// Deviations of noise within which a velocity counts as none.
const STILL: f64 = 3.0;

impl Track {
    /// Looks at `raw` through `lens`.
    #[must_use]
    pub fn of(raw: &Raw, lens: &Lens) -> Self {
        let near = lens.passes().map(|passes| {
            let Passes { first, second } = passes;
            Box::new(Near { track: Self::of(raw, first), rest: second.clone() })
        });
        let [level_noise, slope_noise, bend_noise] = lens.noise();
        let noise = raw.figures.position.noise;
        let (speed_noise, shake_noise) = (noise * slope_noise, noise * bend_noise);
        let (velocity, acceleration) = (lens.slope(&raw.position), lens.bend(&raw.position));
        let still = velocity
            .iter()
            .zip(&acceleration)
            .map(|(speed, shake)| f64::from(speed.abs() <= STILL * speed_noise && shake.abs() <= STILL * shake_noise));
        Self {
            step: lens.step(),
            blur: lens.blur,
            position: lens.level(&raw.position),
            still: still.collect(),
            velocity,
            acceleration,
            jerk: lens.jerk(&raw.position),
            snap: lens.snap(&raw.position),
            crackle: lens.crackle(&raw.position),
            speed_noise,
            shake_noise,
            force_noise: raw.figures.force.map_or(0.0, |force| force.noise * level_noise),
            pace: raw.figures.position.resolution / lens.blur,
            force: raw.force.as_ref().map(|force| lens.level(force)),
            force_rate: raw.force.as_ref().map(|force| lens.slope(force)),
            force_bend: raw.force.as_ref().map(|force| lens.bend(force)),
            force_jerk: raw.force.as_ref().map(|force| lens.jerk(force)),
            effort: raw.effort.as_ref().map(|effort| lens.held(effort)),
            effort_rate: raw.effort.as_ref().map(|effort| lens.held_slope(effort)),
            command: None,
            seen: seen(raw, lens),
            near,
        }
    }

    /// The same with the commands of `raw`, which it was made of through `lens`.
    #[must_use]
    pub fn commanded(mut self, raw: &Raw, lens: &Lens) -> Self {
        let Some(rows) = raw.effort.clone().map(Arc::new) else { return self };
        if let (Some(near), Some(passes)) = (&mut self.near, lens.passes()) {
            near.track.command = Some(Command { rows: rows.clone(), lens: passes.first.clone() });
        }
        self.command = Some(Command { rows, lens: lens.clone() });
        self
    }

    /// The view that laws act in.
    #[must_use]
    pub fn behind(&self) -> &Self {
        self.near.as_ref().map_or(self, |near| &near.track)
    }

    /// What `law` leaves of it: of the sharper view, if there is one, and smoothed like the rest then.
    pub fn left_by(&self, law: impl Fn(&Self) -> Vec<f64>) -> Vec<f64> {
        match &self.near {
            Some(near) => near.rest.level(&law(&near.track)),
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

fn seen(raw: &Raw, lens: &Lens) -> Vec<bool> {
    let reach = lens.reach();
    let rows = raw.len();
    // Bad rows up to each row, so that a stretch is looked up in two steps.
    let mut sum = vec![0usize; rows + 1];
    for (at, good) in raw.good.iter().enumerate() {
        sum[at + 1] = sum[at] + usize::from(!good);
    }
    (0..rows)
        .step_by(lens.stride)
        .map(|at| at >= reach && at + reach < rows && sum[at + reach + 1] == sum[at - reach])
        .collect()
}
