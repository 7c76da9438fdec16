//! What acts on the drive between two encoder rows: means of held and of sampled signals, early or late by any time.

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::*;

use super::law::DriveLaw;
use super::trial::DriveTrial;

/// Mean effort and mean contact force over the interval that ends at each encoder row, N or N m. Row 0 holds nothing. Laws share what they have
/// alike.
#[derive(Debug, Clone)]
pub struct Inputs {
    /// Effort that acts on the motor, less the load that is known.
    pub effort: Arc<Vec<f64>>,
    /// Force with which the tool pushes on what it touches; zero where none is recorded.
    pub force: Arc<Vec<f64>>,
    /// The load that is known; zero where none is given.
    pub load: Arc<Vec<f64>>,
}

impl Inputs {
    /// Those of each of `trials`.
    #[must_use]
    pub fn of_all(trials: &[DriveTrial], law: &DriveLaw) -> Vec<Self> {
        trials.par_iter().map(|trial| Self::of(trial, law)).collect()
    }

    /// The same with the force of `other` on top.
    #[must_use]
    pub fn with_force(&self, other: &Self) -> Self {
        let force = self.force.iter().zip(other.force.iter()).map(|(force, other)| force + other).collect();
        Self { force: Arc::new(force), ..self.clone() }
    }

    /// What the transmission bears over the interval that ends at `row`: the contact's force and the load, N or N m. Friction that grows with
    /// what is borne grows with it.
    #[must_use]
    pub fn borne(&self, row: usize) -> f64 {
        self.force[row] + self.load[row]
    }

    /// The inputs of `trial` under the actuator and the force sensor of `law`.
    #[must_use]
    pub fn of(trial: &DriveTrial, law: &DriveLaw) -> Self {
        let load = Arc::new(load_of(trial, law));
        Self { effort: Arc::new(effort_of(trial, law, &load)), force: Arc::new(force_of(trial, law)), load }
    }

    /// The inputs of `trial` under `law`, where these are those under `before`.
    #[must_use]
    pub fn under(&self, trial: &DriveTrial, before: &DriveLaw, law: &DriveLaw) -> Self {
        let actuator = |law: &DriveLaw| [law.effort_delay_s, law.effort_averaging, law.effort_lag_s, law.load_scale];
        let sensor = |law: &DriveLaw| [law.force_gain_error, law.force_delay_s];
        let is_same_effort = actuator(law) == actuator(before) && law.limit == before.limit;
        let or_else = |is_same: bool, own: &Arc<Vec<f64>>, new: &dyn Fn() -> Vec<f64>| {
            if is_same { Arc::clone(own) } else { Arc::new(new()) }
        };
        let load = or_else(law.load_scale == before.load_scale, &self.load, &|| load_of(trial, law));
        Self {
            effort: or_else(is_same_effort, &self.effort, &|| effort_of(trial, law, &load)),
            force: or_else(sensor(law) == sensor(before), &self.force, &|| force_of(trial, law)),
            load,
        }
    }
}

/// Effort of `trial` through the actuator of `law`, less the `load` that is known.
fn effort_of(trial: &DriveTrial, law: &DriveLaw, load: &[f64]) -> Vec<f64> {
    let acting = unaveraged(&trial.source_time, &trial.effort, law.effort_averaging * trial.recorded_period_s.powi(2));
    let limited = acting.iter().map(|effort| law.limit.passed(*effort));
    let held = Integral::held(&trial.source_time, limited);
    let mut effort = held.means(&trial.time, -law.effort_delay_s);
    if law.effort_lag_s > 0.0 {
        held.lag(&mut effort, &trial.time, -law.effort_delay_s, law.effort_lag_s);
    }
    effort.iter_mut().zip(load).for_each(|(effort, load)| *effort -= load);
    effort
}

/// Load that is known of `trial`, times the factor of `law`.
fn load_of(trial: &DriveTrial, law: &DriveLaw) -> Vec<f64> {
    let Some(load) = &trial.load else { return vec![0.0; trial.len()] };
    let scaled = load.iter().map(|load| law.load_scale * load);
    Integral::sampled(&trial.source_time, scaled).means(&trial.time, 0.0)
}

/// Contact force of `trial` as it acts, where the sensor of `law` recorded it.
fn force_of(trial: &DriveTrial, law: &DriveLaw) -> Vec<f64> {
    let Some(force) = &trial.force else { return vec![0.0; trial.len()] };
    let gain = 1.0 + law.force_gain_error;
    let sampled = Integral::sampled(&trial.source_time, force.iter().map(|force| force / gain));
    sampled.means(&trial.time, law.force_delay_s)
}

/// What `averaged`, recorded at `time`, was before a drive took its means: the record less `spread` times its second derivative, the first term
/// of the inverse of any mean about its own row, of which `spread` is half the variance, s^2. The ends stay.
fn unaveraged<'a>(time: &[f64], averaged: &'a [f64], spread: f64) -> Cow<'a, [f64]> {
    if spread == 0.0 {
        return Cow::Borrowed(averaged);
    }
    let mut before = averaged.to_vec();
    for row in 1..before.len().saturating_sub(1) {
        let slope = |from: usize| (averaged[from + 1] - averaged[from]) / (time[from + 1] - time[from]);
        before[row] -= spread * 2.0 * (slope(row) - slope(row - 1)) / (time[row + 1] - time[row - 1]);
    }
    Cow::Owned(before)
}

/// Integral of a signal over time, from which the mean over any interval follows.
struct Integral<'a> {
    time: &'a [f64],
    values: Vec<f64>,
    /// How far the mean of a sampled signal over the interval before each row lies below that of its ends.
    bend: Vec<f64>,
    total: Vec<f64>,
    held: bool,
}

impl<'a> Integral<'a> {
    /// Of a signal that holds each value until the next row, as an effort between two control ticks.
    fn held(time: &'a [f64], values: impl Iterator<Item = f64>) -> Self {
        Self::new(time, values.collect(), true)
    }

    /// Of a signal that is sampled, as a force: over an interval the mean of the parabola through its two rows and the one before and of that
    /// through them and the one after. Straight lines lose a fifteenth of what swings in seven rows.
    fn sampled(time: &'a [f64], values: impl Iterator<Item = f64>) -> Self {
        Self::new(time, values.collect(), false)
    }

    fn new(time: &'a [f64], values: Vec<f64>, held: bool) -> Self {
        let mut total = vec![0.0; time.len()];
        let bend: Vec<f64> =
            if held { Vec::new() } else { (0..time.len()).map(|row| bend(time, &values, row)).collect() };
        for row in 1..time.len() {
            let level = if held { values[row - 1] } else { 0.5 * (values[row - 1] + values[row]) - bend[row] };
            total[row] = total[row - 1] + level * (time[row] - time[row - 1]);
        }
        Self { time, values, bend, total, held }
    }

    /// Moves `row` to the last one that is not after `at`, or to the first.
    fn seek(&self, at: f64, row: &mut usize) {
        let last = self.time.len() - 1;
        while *row < last && self.time[*row + 1] <= at {
            *row += 1;
        }
        while *row > 0 && self.time[*row] > at {
            *row -= 1;
        }
    }

    /// The integral up to `at`, `row` being a row near it: signals are constant before the first and after the last row.
    fn up_to(&self, at: f64, row: &mut usize) -> f64 {
        self.seek(at, row);
        let last = self.time.len() - 1;
        let since = at - self.time[*row];
        let (level, next) = (self.values[*row], self.values[(*row + 1).min(last)]);
        if self.held || since <= 0.0 || *row == last {
            return self.total[*row] + level * since;
        }
        let interval = self.time[*row + 1] - self.time[*row];
        let slope = (next - level) / interval;
        let part = since / interval;
        // Below the line by all of the bend at the end, and as smoothly as from its start.
        let below = self.bend[*row + 1] * interval * part * part * (3.0 - 2.0 * part);
        self.total[*row] + since * (level + 0.5 * slope * since) - below
    }

    /// Mean over each interval of `rows`, moved by `shift` seconds.
    fn means(&self, rows: &[f64], shift: f64) -> Vec<f64> {
        let mut near = 0;
        let mut before = rows.first().map_or(0.0, |first| self.up_to(first + shift, &mut near));
        let mut means = vec![0.0; rows.len()];
        for row in 1..rows.len() {
            let after = self.up_to(rows[row] + shift, &mut near);
            means[row] = (after - before) / (rows[row] - rows[row - 1]);
            before = after;
        }
        means
    }

    /// Turns `means`, of a held signal over each interval of `rows` moved by `shift`, into those of what follows it by a first-order
    /// lag, exactly: from lag du/dt = input - u the integral of u is that of the input less `lag` times the change of u.
    fn lag(&self, means: &mut [f64], rows: &[f64], shift: f64, lag_s: f64) {
        let mut follows = vec![self.values.first().copied().unwrap_or(0.0); self.time.len()];
        let after = |input: f64, before: f64, since: f64| input + (before - input) * (-since / lag_s).exp();
        for row in 1..follows.len() {
            follows[row] = after(self.values[row - 1], follows[row - 1], self.time[row] - self.time[row - 1]);
        }
        let mut near = 0;
        let mut at = |instant: f64| {
            self.seek(instant, &mut near);
            after(self.values[near], follows[near], (instant - self.time[near]).max(0.0))
        };
        let mut before = rows.first().map_or(0.0, |first| at(first + shift));
        for row in 1..rows.len() {
            let now = at(rows[row] + shift);
            means[row] -= lag_s * (now - before) / (rows[row] - rows[row - 1]);
            before = now;
        }
    }
}

/// How far the mean over the interval before `row` lies below that of its ends for a parabola of the curvature about it, that
/// times the interval's square over twelve. At an end, or beside a gap, none.
fn bend(time: &[f64], values: &[f64], row: usize) -> f64 {
    if row < 2 || row + 1 >= time.len() {
        return 0.0;
    }
    let step = |row: usize| time[row] - time[row - 1];
    if [row - 1, row, row + 1]
        .iter()
        .any(|at| step(*at) > MOST_UNEVEN * step(row) || step(row) > MOST_UNEVEN * step(*at))
    {
        return 0.0;
    }
    let slope = |row: usize| (values[row] - values[row - 1]) / step(row);
    let curvature = (slope(row + 1) - slope(row - 1)) / (0.5 * step(row + 1) + step(row) + 0.5 * step(row - 1));
    curvature * step(row).powi(2) / 12.0
}

/// Factor between neighbouring steps from which there is a gap, over which nothing is known of a bend.
const MOST_UNEVEN: f64 = 2.5;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::effort_limit::EffortLimit;

    #[test]
    fn a_held_signal_that_is_late_by_a_quarter_of_a_row_is_mixed_of_both() {
        let time = [0.0, 1.0, 2.0, 3.0];
        let held = Integral::held(&time, [4.0, 8.0, 2.0, 2.0].into_iter());
        assert_eq!(held.means(&time, -0.25), [0.0, 4.0, 7.0, 3.5]);
        assert_eq!(held.means(&time, 0.0), [0.0, 4.0, 8.0, 2.0]);
    }

    /// The mean of t^2 over a window of w about its row is t^2 + w^2 / 12, at whatever times the rows are.
    #[test]
    fn what_a_mean_about_its_row_was_of_is_found_again() {
        let time = [0.0, 0.9, 2.1, 3.0, 4.2];
        let window: f64 = 1.5;
        let means = time.map(|t| t * t + window * window / 12.0);
        let before = unaveraged(&time, &means, window * window / 24.0);
        for (t, before) in time.iter().zip(before.iter()).skip(1).take(3) {
            assert!((before - t * t).abs() < 1e-12, "{before} at {t}");
        }
        assert_eq!(unaveraged(&time, &means, 0.0), means.as_slice());
    }

    #[test]
    fn a_sampled_signal_is_integrated_along_straight_lines_at_its_ends_and_beside_gaps() {
        let time = [0.0, 1.0, 3.0];
        let sampled = Integral::sampled(&time, [0.0, 2.0, 6.0].into_iter());
        assert_eq!(sampled.means(&time, 0.0), [0.0, 1.0, 4.0]);
        // From 0.5 to 1.5: the line reaches 1, 2 and 3; its mean over both halves is 2.
        assert!((sampled.means(&[0.5, 1.5], 0.0)[1] - 2.0).abs() < 1e-15);
        let gap = Integral::sampled(&[0.0, 1.0, 2.0, 12.0, 13.0, 14.0], [0.0, 0.0, 4.0, 4.0, 0.0, 0.0].into_iter());
        assert_eq!(gap.means(&[1.0, 2.0, 12.0, 13.0], 0.0), [0.0, 2.0, 4.0, 2.0]);
    }

    /// sin(w t) by seven rows a period: the mean over an interval is the difference of its integral, from any instant.
    #[test]
    fn what_swings_in_seven_rows_is_integrated_to_a_hundredth() {
        let swing = std::f64::consts::TAU / 7.0;
        let time: Vec<f64> = (0..60).map(f64::from).collect();
        let sampled = Integral::sampled(&time, time.iter().map(|t| (swing * t).sin()));
        for shift in [0.0, 0.3] {
            let means = sampled.means(&time, shift);
            for row in 5..50 {
                let [from, to] = [time[row - 1] + shift, time[row] + shift];
                let exact = ((swing * from).cos() - (swing * to).cos()) / swing;
                // Of the rule's own error (w dt)^4 11 / 720 is left, 0.0099; between rows the bend's own shape is one of the third degree.
                assert!((means[row] - exact).abs() < 0.015, "{row} {shift}: {} {exact}", means[row]);
            }
        }
    }

    /// 3 N for half a second, then nothing, recorded each 10 ms.
    fn pulse() -> (Vec<f64>, Vec<f64>) {
        let time = (0..200).map(|row| 0.01 * f64::from(row)).collect();
        (time, (0..200).map(|row| if row < 50 { 3.0 } else { 0.0 }).collect())
    }

    #[test]
    fn a_lag_loses_nothing_of_a_constant_and_all_of_a_pulse_after_a_long_time() {
        let (time, values) = pulse();
        let held = Integral::held(&time, values.into_iter());
        let mut means = held.means(&time, 0.0);
        held.lag(&mut means, &time, 0.0, 0.05);
        assert!((means[49] - 3.0).abs() < 1e-12);
        // After 1.5 s, thirty time constants, e^-30 of it is left.
        assert!(means[199].abs() < 1e-12);
        let lost: f64 = means[51..].iter().sum::<f64>() * 0.01;
        // What a first-order lag gives late is its time constant times the step.
        assert!((lost - 3.0 * 0.05).abs() < 1e-10, "{lost}");
    }

    #[test]
    fn a_lag_between_few_encoder_rows_is_that_of_every_recorded_row() {
        let time: Vec<f64> = (0..40).map(|row| 0.01 * f64::from(row)).collect();
        let values = (0..40).map(|row| f64::from((row * row * 7) % 11));
        let held = Integral::held(&time, values);
        let lagged = |rows: &[f64]| {
            let mut means = held.means(rows, -0.004);
            held.lag(&mut means, rows, -0.004, 0.013);
            means
        };
        let every_fourth: Vec<f64> = time.iter().step_by(4).copied().collect();
        let (all, few) = (lagged(&time), lagged(&every_fourth));
        for row in 1..few.len() {
            let mean = all[4 * row - 3..=4 * row].iter().sum::<f64>() / 4.0;
            assert!((few[row] - mean).abs() < 1e-12, "{} {mean}", few[row]);
        }
    }

    /// Of a law that differs in one thing, only what that touches is computed, and all of it is what the law has by itself.
    #[test]
    fn what_two_laws_have_alike_is_shared_and_the_rest_is_the_laws_own() {
        let (time, effort) = pulse();
        let position = vec![0.0; time.len()];
        let force = time.iter().map(|t| (9.0 * t).sin()).collect();
        let mut trial = DriveTrial::new("trial".to_owned(), time.clone(), &position, effort, Some(force), 1);
        trial.load = Some(time.iter().map(|t| t * t).collect());
        let before = DriveLaw::nominal(1.0, 0.0, 0.0);
        let inputs = Inputs::of(&trial, &before);
        let changed = |change: &dyn Fn(&mut DriveLaw)| {
            let mut law = before.clone();
            change(&mut law);
            let (shared, own) = (inputs.under(&trial, &before, &law), Inputs::of(&trial, &law));
            assert_eq!([&shared.effort, &shared.force, &shared.load], [&own.effort, &own.force, &own.load]);
            [(&shared.effort, &inputs.effort), (&shared.force, &inputs.force), (&shared.load, &inputs.load)]
                .map(|(shared, before)| Arc::ptr_eq(shared, before))
        };
        assert_eq!(changed(&|law| law.inertia = 2.0), [true, true, true]);
        assert_eq!(changed(&|law| law.effort_delay_s = 3e-3), [false, true, true]);
        assert_eq!(changed(&|law| law.effort_averaging = 0.2), [false, true, true]);
        assert_eq!(changed(&|law| law.effort_lag_s = 0.02), [false, true, true]);
        assert_eq!(changed(&|law| law.limit = EffortLimit::Sharp(2.0)), [false, true, true]);
        assert_eq!(changed(&|law| law.force_gain_error = 0.1), [true, false, true]);
        assert_eq!(changed(&|law| law.force_delay_s = 3e-3), [true, false, true]);
        // The effort is told less the load.
        assert_eq!(changed(&|law| law.load_scale = 0.9), [false, true, false]);
    }
}
