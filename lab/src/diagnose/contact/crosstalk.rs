//! The recorded effort in the force's reading: no effect of a contact, and one that names for a contact can be fitted to.

use super::criteria::{LEAST_GAIN, LONGEST_COUPLING};
use super::data::Data;
use super::fit::{Effort, Fit};
use super::rest::Rest;
use super::search::Search;
use super::trial::ContactTrial;
use crate::diagnose::linalg::{dot, solve};
use crate::golden_section::least_between;

/// The effort that a force reading holds: `reading = F + part u`, where `u` is the effort, by a common ground or the frame, or what is left of its
/// steps after `memory_s`, by a capacity: `u` falls towards zero with that time constant and follows each step of the effort at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crosstalk {
    /// Of the effort, or of its steps.
    pub part: f64,
    /// Time constant, s; infinite: of the effort itself.
    pub memory_s: f64,
}

/// To what share the part is fitted: a hundredth of it leaves a ten thousandth of its squares.
const PRECISION: f64 = 0.01;

/// The effort in the reading, where that alone beside the refitted nominal law is likelier than two or more effects of `fit` beyond the price of all
/// values (G. Schwarz, *Ann. Stat.* 6, 1978, 461); `None` where it is not, or where no effort is recorded. One effect stays: before a drive
/// without dry friction a mass that the force sensor carries has the same shape, and the effort tells the acceleration with less noise than
/// the position does.
pub(super) fn crosstalk(search: &Search<'_>, fit: &Fit) -> Option<Crosstalk> {
    let (data, nominal) = (&search.data, &search.nominal);
    let effects = fit.model.terms.len().saturating_sub(nominal.model.terms.len());
    if effects < 2 || !data.trials.iter().all(|trial| trial.effort.is_some()) {
        return None;
    }
    let base = data.weighted_residual(&nominal.model, &nominal.values);
    let others = directions(data, nominal, &base);
    let begun = memories(data.trials[0].step_s).filter_map(|memory_s| {
        let (part, taken) = least_squares(&others, coupled(data, memory_s), &base)?;
        Some((Crosstalk { part, memory_s }, taken))
    });
    let (Crosstalk { part, memory_s }, _) = begun.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let refitted = |part: f64| {
        let trials: Vec<ContactTrial> =
            data.trials.iter().map(|trial| without_effort(trial, Crosstalk { part, memory_s })).collect();
        data.of(&trials).fit(&nominal.model, &nominal.values, Effort::FULL)
    };
    let [low, high] = [0.5 * part, 1.5 * part];
    let around = [low.min(high), low.max(high)];
    let part = least_between(around, PRECISION * part.abs(), |part| refitted(part).energy);
    let rest = Rest::of(data, fit);
    // Part and memory are values, too.
    let alone = search.price(&refitted(part), &rest) + 2.0 * search.price_of_value(&rest);
    (alone + LEAST_GAIN < search.price(fit, &rest)).then_some(Crosstalk { part, memory_s })
}

/// The memories that are looked for, where rows are `step_s` apart.
fn memories(step_s: f64) -> impl Iterator<Item = f64> {
    let doubled = std::iter::successors(Some(step_s), |memory| Some(2.0 * memory));
    doubled.take_while(|memory| *memory <= LONGEST_COUPLING).chain([f64::INFINITY])
}

/// Derivatives of the weighted residual `base` of `nominal` by its values.
pub(super) fn directions(data: &Data<'_>, nominal: &Fit, base: &[f64]) -> Vec<Vec<f64>> {
    let ranges = nominal.model.ranges(&nominal.values);
    let free: Vec<usize> = (0..nominal.values.len()).filter(|at| ranges[*at].free).collect();
    data.columns(&nominal.model, &nominal.values, &ranges, &free, base)
}

/// What couples in of a part of one, weighted, trial after trial.
fn coupled(data: &Data<'_>, memory_s: f64) -> Vec<f64> {
    let each = data.trials.iter().zip(&data.weights);
    let weighted = |(trial, weights): (&ContactTrial, &Vec<f64>)| -> Vec<f64> {
        let effort = trial.effort.as_deref().unwrap_or_default();
        let added = Crosstalk { part: 1.0, memory_s }.added(effort, trial.step_s);
        added.iter().zip(weights).map(|(added, weight)| added * weight).collect()
    };
    each.flat_map(weighted).collect()
}

/// The part of `effort` in `residual` beside `others`, and the squares that all of them take of it; `None` where they are not told apart.
fn least_squares(others: &[Vec<f64>], effort: Vec<f64>, residual: &[f64]) -> Option<(f64, f64)> {
    let directions: Vec<(usize, Vec<f64>)> = others.iter().cloned().chain([effort]).enumerate().collect();
    let found = solve(&directions, residual)?;
    let taken = directions.iter().zip(&found).map(|((_, direction), size)| size * dot(direction, residual)).sum();
    Some((found[others.len()], taken))
}

impl Crosstalk {
    /// Takes off `force`, rows `step_s` apart, what `effort` adds to it.
    pub fn take_off(&self, force: &mut [f64], effort: &[f64], step_s: f64) {
        force.iter_mut().zip(self.added(effort, step_s)).for_each(|(force, added)| *force -= added);
    }

    /// What it adds to the force where `effort` is recorded, rows `step_s` apart, N or N m.
    fn added(&self, effort: &[f64], step_s: f64) -> Vec<f64> {
        if self.memory_s.is_infinite() {
            return effort.iter().map(|effort| self.part * effort).collect();
        }
        let kept = (-step_s / self.memory_s).exp();
        let mut left = 0.0;
        let mut before = effort.first().copied().unwrap_or_default();
        let step = |effort: &f64| {
            left = kept * left + effort - before;
            before = *effort;
            self.part * left
        };
        effort.iter().map(step).collect()
    }
}

/// `trial` without the effort in its force.
fn without_effort(trial: &ContactTrial, crosstalk: Crosstalk) -> ContactTrial {
    let mut trial = trial.clone();
    crosstalk.take_off(&mut trial.force, trial.effort.as_deref().unwrap_or_default(), trial.step_s);
    trial
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::identification::identify;
    use super::super::nominal::nominal_fit;
    use super::super::outcome::Outcome;
    use super::super::testing::{RATE, TestContact};
    use super::*;
    use crate::diagnose::term::Term;
    use crate::diagnose::verdict::Verdict;
    use crate::recording::Recording;

    /// Mass, kg, and viscous friction, N s/m, of the drive behind the force sensor, and its dry friction, N.
    const DRIVE: [f64; 3] = [4.0, 8.0, 0.7];

    /// `recording` with the effort of a `drive`, of which the force holds some, and with the inertia of `carried` kg. The steps of the effort
    /// are forgotten in twenty turns a row.
    fn driven(mut recording: Recording, crosstalk: Crosstalk, carried: f64, drive: [f64; 3]) -> Recording {
        let effort: Vec<f64> = recording.time.iter().map(|t| effort_at(*t, drive)).collect();
        let (mut left, mut before) = (0.0, effort_at(0.0, drive));
        let force = recording.force.as_mut().unwrap();
        for ((force, t), effort) in force.iter_mut().zip(&recording.time).zip(&effort) {
            for turn in (0..20).rev() {
                let now = effort_at(t - f64::from(turn) / (20.0 * RATE), drive);
                left = left * (-1.0 / (20.0 * RATE * crosstalk.memory_s)).exp() + now - before;
                before = now;
            }
            let coupled = if crosstalk.memory_s.is_finite() { left } else { *effort };
            *force += carried * motion_at(*t)[2] + crosstalk.part * coupled;
        }
        recording.effort = Some(effort);
        recording
    }

    /// Depth, speed and acceleration of [`TestContact`]'s recordings.
    fn motion_at(t: f64) -> [f64; 3] {
        let depth = |t: f64| 4e-3 * (1.0 - (4.0 * t).cos()) * (1.0 + 0.4 * (1.1 * t).sin()) - 2e-3;
        let [before, now, after] = [t - 1e-4, t, t + 1e-4].map(depth);
        [now, (after - before) / 2e-4, (after - 2.0 * now + before) / 1e-8]
    }

    /// Effort of a drive that moves so, without the sensor's noise, which none feels.
    fn effort_at(t: f64, [mass, viscous, dry]: [f64; 3]) -> f64 {
        let TestContact { stiffness, damping, .. } = TestContact::PLAIN;
        let [x, v, a] = motion_at(t);
        let touched = if x > 0.0 { (stiffness * x + damping * v).max(0.0) } else { 0.0 };
        touched + mass * a + viscous * v + dry * v.signum()
    }

    fn found(part: f64, memory_s: f64, carried: f64, drive: [f64; 3]) -> Outcome {
        let crosstalk = Crosstalk { part, memory_s };
        let trials = || -> Vec<ContactTrial> {
            let recorded = [1, 2].map(|seed| driven(TestContact::PLAIN.recording(seed), crosstalk, carried, drive));
            recorded.iter().map(TestContact::seen).collect()
        };
        identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap()
    }

    #[test]
    fn effort_in_the_force_reading_is_no_mass_and_no_loop() {
        let outcome = found(0.1, f64::INFINITY, 0.0, DRIVE);
        assert_eq!((outcome.named.len(), outcome.verdict), (0, Verdict::Unknown));
        // 6000 rows of 20 mN before 0.7 N of dry friction, which nothing else looks like: 3.7e-4, of which four.
        let Crosstalk { part, memory_s } = outcome.crosstalk.expect("it holds a tenth of the effort");
        assert!((part - 0.1).abs() < 1.5e-3 && memory_s.is_infinite(), "{part}, {memory_s} s");
    }

    /// Beside a mass and a memory that were fitted to it: before a heavy drive, whose effort is not the contact's.
    #[test]
    fn steps_of_the_effort_are_told_from_effects_of_the_contact_with_their_memory() {
        let coupled = Crosstalk { part: 1.0, memory_s: 0.016 };
        let recorded = [1, 2].map(|seed| driven(TestContact::PLAIN.recording(seed), coupled, 0.0, [40.0, 8.0, 0.0]));
        let trials = recorded.each_ref().map(TestContact::seen);
        let nominal = nominal_fit(&Data::new(&trials), &TestContact::nominal());
        let [data, coarse] = [(), ()].map(|()| Data::new(&trials).weighed(&nominal));
        let term = |name: &str| Term { effect: crate::effects::find(name).unwrap(), form: 0 };
        let model = nominal.model.with(term("tool_inertia")).with(term("stress_relaxation"));
        let start: Vec<f64> = nominal.values.iter().copied().chain([0.1, 60.0, 0.4]).collect();
        let fit = data.fit(&model, &start, Effort::FULL);
        let search = Search { nominal: data.again(&nominal), data, coarse, circumstances: Circumstances::default() };
        let Crosstalk { part, memory_s } = crosstalk(&search, &fit).expect("it holds the steps of the effort");
        // Rows of 4 ms see a step up to one row late, a quarter of the memory, and an eighth in the mean.
        assert!((part - 1.0).abs() < 0.25 && (memory_s - 0.016).abs() < 1e-9, "{part}, {memory_s} s");
    }

    /// Before a drive without friction the effort is what the mass takes and the contact gives: the same shape, and less noise.
    #[test]
    fn a_mass_that_the_sensor_carries_stays_one() {
        for drive in [DRIVE, [4.0, 0.0, 0.0]] {
            let outcome = found(0.0, f64::INFINITY, 2.0, drive);
            let names = outcome.chosen.model.names(outcome.known_terms);
            assert!(matches!(names[..], ["tool_inertia" | "environment_mass"]), "{names:?}");
            assert_eq!(outcome.crosstalk, None);
        }
    }
}
