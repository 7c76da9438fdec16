//! A recording that was never made: what a model would show of a motion.

use super::claim::Claim;
use super::course::Course;
use crate::diagnose::bootstrap::problem::Study;
use crate::diagnose::estimation::whitener::{Floor, Whitener};
use crate::diagnose::model::index;
use crate::diagnose::signals::derivative_filter::Lens;
use crate::diagnose::signals::filtered_trial::{Track, Trial};

/// Where motions are tried.
pub struct Bench<'a> {
    study: &'a Study,
    answer: Claim,
    /// Deviation of each channel's floor in a row of its track.
    pub(super) floors: [Option<f64>; 2],
    /// Rows of each channel's track that are worth one.
    pub(super) memory: [f64; 2],
}

/// Steps in which the effort is found that a motion takes.
const TURNS: usize = 30;

/// Growth of the greatest force, or effort, that is no harm.
const MARGIN: f64 = 1.15;

impl<'a> Bench<'a> {
    /// A bench on which `answer` is the truth, its sensors as good as the floors of `whitener` say.
    #[must_use]
    pub fn new(study: &'a Study, whitener: &Whitener, mut answer: Claim) -> Self {
        // Clocks are no physics; a rival may still move its own.
        answer.values[index::FORCE_TIMING] = 0.0;
        answer.values[index::EFFORT_TIMING] = 0.0;
        let floors = [whitener.force.as_ref().and_then(typical), whitener.effort.as_ref().and_then(typical)];
        // White noise behind a Gaussian remembers itself: the sum of its correlation over all rows.
        let memory = |lens: &Lens| (2.0 * std::f64::consts::PI.sqrt() * lens.blur / lens.step()).max(1.0);
        Self { study, answer, floors, memory: [memory(&study.studio.lens), memory(&study.studio.drive_lens)] }
    }

    /// The truth.
    #[must_use]
    pub fn answer(&self) -> &Claim {
        &self.answer
    }

    /// The greatest force, or effort, of the recordings.
    #[must_use]
    pub fn greatest(&self, effort: bool) -> f64 {
        if effort { self.answer.scene.effort } else { self.answer.scene.force }
    }

    /// The sensor that would tell where no motion does.
    #[must_use]
    pub fn wanted(&self) -> &'static str {
        match (self.answer.model.contact.is_some(), self.answer.model.drive) {
            (true, false) => "record the drive's effort as well, or use a quieter force sensor",
            (false, _) => "record the contact force as well, or the position on the motor's side",
            (true, true) => {
                "a finer position sensor, a quieter force sensor, or the position on the motor's side would tell"
            }
        }
    }

    /// The floor of a channel, N or N m.
    #[must_use]
    pub fn floor(&self, effort: bool) -> Option<f64> {
        self.floors[usize::from(effort)]
    }

    /// What the answer would show of `course`.
    #[must_use]
    pub fn run(&self, course: &Course) -> Trial {
        let track = |lens: &Lens| {
            let rows = course.rows(lens.step());
            let column = |at: usize| rows.iter().map(|row| row[at]).collect::<Vec<f64>>();
            self.track(lens, column(0), column(1), column(2), vec![true; rows.len()])
        };
        self.shown(track(&self.study.studio.lens), track(&self.study.studio.drive_lens))
    }

    /// What the answer would show of the recorded motions themselves.
    #[must_use]
    pub fn rerun(&self) -> Vec<Trial> {
        let again = |lens: &Lens, track: &Track| {
            let (position, velocity) = (track.position.clone(), track.velocity.clone());
            self.track(lens, position, velocity, track.acceleration.clone(), track.seen.clone())
        };
        let (lens, drive) = (&self.study.studio.lens, &self.study.studio.drive_lens);
        let trials = self.study.studio.trials.iter();
        trials.map(|trial| self.shown(again(lens, &trial.contact), again(drive, &trial.drive))).collect()
    }

    fn track(
        &self,
        lens: &Lens,
        position: Vec<f64>,
        velocity: Vec<f64>,
        acceleration: Vec<f64>,
        seen: Vec<bool>,
    ) -> Track {
        let noise = self.study.studio.raws.iter().map(|raw| raw.figures.position.noise).fold(0.0, f64::max);
        let [level_noise, slope_noise, bend_noise] = lens.noise();
        let force_noise = self.study.studio.raws.iter().filter_map(|raw| raw.figures.force).map(|force| force.noise);
        // As a recording of it would be looked at.
        let still = |(v, a): (&f64, &f64)| {
            f64::from(v.abs() <= 3.0 * noise * slope_noise && a.abs() <= 3.0 * noise * bend_noise)
        };
        let jerk = slope(&acceleration, lens.step());
        let snap = slope(&jerk, lens.step());
        Track {
            step: lens.step(),
            blur: lens.blur,
            still: velocity.iter().zip(&acceleration).map(still).collect(),
            speed_noise: noise * slope_noise,
            shake_noise: noise * bend_noise,
            force_noise: level_noise * force_noise.fold(0.0, f64::max),
            position,
            velocity,
            crackle: slope(&snap, lens.step()),
            jerk,
            snap,
            acceleration,
            force: None,
            force_rate: None,
            force_bend: None,
            force_jerk: None,
            effort: None,
            effort_rate: None,
            command: None,
            pace: 0.0,
            seen,
            near: None,
        }
    }

    fn shown(&self, mut contact: Track, mut drive: Track) -> Trial {
        self.sense(&mut contact);
        self.sense(&mut drive);
        if self.answer.model.drive {
            self.drive(&mut drive);
        }
        Trial { number: 0, contact, drive }
    }

    /// Whether `course` would ask for no more force and effort than the recordings did, by what the answer says of both.
    #[must_use]
    pub fn bears(&self, course: &Course) -> bool {
        let trial = self.run(course);
        let peak =
            |values: &Option<Vec<f64>>| values.iter().flatten().fold(0.0f64, |peak, value| peak.max(value.abs()));
        let within = |values: &Option<Vec<f64>>, most: f64| peak(values) <= MARGIN * most;
        within(&trial.contact.force, self.greatest(false)) && within(&trial.drive.effort, self.greatest(true))
    }

    /// Fills in the reading of the force sensor.
    fn sense(&self, track: &mut Track) {
        let Some(bilateral) = self.answer.model.contact else { return };
        let Claim { model, values, .. } = &self.answer;
        let borne = model.contact_force(values, 0, track, bilateral);
        let force = model.reading(values, 0, track, &borne);
        let rate = slope(&force, track.step);
        let bend = slope(&rate, track.step);
        track.force_jerk = Some(slope(&bend, track.step));
        track.force_bend = Some(bend);
        track.force_rate = Some(rate);
        track.force = Some(force);
    }

    /// Fills in the effort that the motion takes; rows that the drive cannot follow do not count.
    fn drive(&self, track: &mut Track) {
        let mut effort = self.rigid(track);
        let mut best = (f64::INFINITY, effort.clone(), Vec::new());
        // What the drive makes of a command may depend on the command: what is left of the balance is taken off it, for as
        // long as that helps.
        for _ in 0..TURNS {
            track.effort_rate = Some(slope(&effort, track.step));
            track.effort = Some(effort.clone());
            let rest = self.effort_rest(track);
            let size: f64 = rest.iter().map(|rest| rest * rest).sum();
            let next = effort.iter().zip(&rest).map(|(effort, rest)| effort - rest).collect();
            if size.is_nan() || size >= best.0 {
                break;
            }
            best = (size, std::mem::replace(&mut effort, next), rest);
        }
        let (_, effort, rest) = best;
        track.effort_rate = Some(slope(&effort, track.step));
        track.effort = Some(effort);
        let floor = self.floors[1].unwrap_or(f64::INFINITY);
        for (at, seen) in track.seen.iter_mut().enumerate() {
            *seen &= track.still[at] == 0.0 && rest.get(at).is_some_and(|rest| rest.abs() <= floor);
        }
    }

    /// The effort that a stiff drive without friction would take.
    fn rigid(&self, track: &Track) -> Vec<f64> {
        let (inertia, viscous) = (self.answer.values[index::INERTIA], self.answer.values[index::VISCOUS]);
        let force = |at: usize| track.force.as_ref().map_or(0.0, |force| force[at]);
        let load = |at: usize| inertia * track.acceleration[at] + viscous * track.velocity[at] + force(at);
        (0..track.len()).map(load).collect()
    }

    fn effort_rest(&self, track: &Track) -> Vec<f64> {
        let Claim { model, values, .. } = &self.answer;
        let bilateral = model.contact.unwrap_or(false);
        let force = model.contact.map(|_| model.contact_force(values, 0, track, bilateral));
        model.balance(values, 0, track, |at| force.as_ref().map_or(0.0, |force| force[at]))
    }
}

/// The floor of an ordinary row.
fn typical(floor: &Floor) -> Option<f64> {
    let mut all: Vec<f64> = floor.deviation.iter().flatten().copied().filter(|value| value.is_finite()).collect();
    let middle = all.len() / 2;
    (!all.is_empty()).then(|| *all.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Rate of values `step` seconds apart.
fn slope(values: &[f64], step: f64) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    (0..values.len())
        .map(|at| {
            let (before, after) = (at.saturating_sub(1), (at + 1).min(last));
            (values[after] - values[before]) / (step * (after - before).max(1) as f64)
        })
        .collect()
}
