//! The force that acted on the drive, where the contact told what the sensor made of it.

use super::contact::crosstalk::Crosstalk;
use super::contact::fit::Fit;
use super::contact::outcome::Outcome;
use super::contact::pruning::without_term;
use super::contact::rest::integrated_autocorrelation;
use super::contact::trial::ContactTrial;
use super::interval::Intervals;
use super::linalg::energy;
use super::local_level::level;
use super::term::Term;
use super::verdict::Verdict;
use crate::effects::Place;
use crate::recording::Recording;
use crate::recording::assemble::interpolated;

/// Effects of the force sensor that the drive tells better than the contact does: force and position alone show them as other values.
pub const CARRIED_BY_THE_DRIVE: [&str; 2] = ["force_gain", "tool_inertia"];

/// Names of the effects of the force sensor that the contact tells.
#[must_use]
pub fn sensor_effects(contact: &Outcome) -> Vec<&'static str> {
    told(contact).into_iter().map(|at| contact.chosen.model.terms[at].name()).collect()
}

/// The named effects of the sensor, which stand at these places among the contact's terms.
fn told(contact: &Outcome) -> Vec<usize> {
    let named = contact.named.iter().map(|named| named.at);
    named.filter(|at| is_of_the_sensor(&contact.chosen.model.terms[*at])).collect()
}

/// Those that the rig file states.
fn known(contact: &Outcome) -> Vec<usize> {
    (0..contact.known_terms).filter(|at| is_of_the_sensor(&contact.chosen.model.terms[*at])).collect()
}

/// Both: where the effects of the force sensor stand among the contact's terms.
#[must_use]
pub fn sensor_terms(contact: &Outcome) -> Vec<usize> {
    [known(contact), told(contact)].concat()
}

fn is_of_the_sensor(term: &Term) -> bool {
    let spec = term.effect.spec();
    spec.place == Place::Sensor && !CARRIED_BY_THE_DRIVE.contains(&spec.name)
}

/// `trials` with the force as it acted, N or N m: what the effects of the sensor, those that the rig file states and those that are named, add to the law's
/// reading along the motion is taken off, in the means of rows that the contact was looked at in. The drive would take a zero for a load, and what a clipped reading
/// misses for a force of its own. A zero that wanders does so beside the straight lines of its law, too: what is left is followed as a
/// random walk. Effort that the reading holds is taken off, too: the drive would be told its own friction for a force.
#[must_use]
pub fn as_it_acted(contact: &Outcome, trials: &[Recording]) -> Vec<Recording> {
    let trials: Vec<Recording> = match contact.crosstalk {
        Some(crosstalk) => trials.iter().map(|trial| without_effort(trial, crosstalk)).collect(),
        None => trials.to_vec(),
    };
    without(contact, trials, sensor_terms(contact))
}

/// `trials` with the force as it is shown, but for what the effects of the sensor that the rig file states add to it.
#[must_use]
pub fn as_the_rig_file_has_it(contact: &Outcome, trials: &[Recording]) -> Vec<Recording> {
    without(contact, trials.to_vec(), known(contact))
}

/// `trials` without what the terms `sensors` of the contact add to their force.
fn without(contact: &Outcome, mut trials: Vec<Recording>, mut sensors: Vec<usize>) -> Vec<Recording> {
    if sensors.is_empty() {
        return trials;
    }
    sensors.sort_unstable();
    let shown = &contact.chosen;
    let mut acted = shown.clone();
    for at in sensors.iter().rev() {
        let (model, values) = without_term(&acted, *at);
        acted = Fit { model, values, ..acted };
    }
    let wanders = sensors.iter().any(|at| shown.model.terms[*at].name() == "force_drift");
    for (number, (trial, looked_at)) in trials.iter_mut().zip(&contact.trials).enumerate() {
        let Some(force) = &mut trial.force else { continue };
        let [shown, acted] = [shown, &acted].map(|fit| fit.model.predicted(&fit.values, looked_at, number));
        let mut added: Vec<f64> = shown.iter().zip(acted).map(|(shown, acted)| shown - acted).collect();
        if wanders {
            let left: Vec<f64> = looked_at.force.iter().zip(&shown).map(|(force, shown)| force - shown).collect();
            // Noise that remembers is the level itself.
            let noise: Vec<f64> = contact.noise[number].iter().map(|all| all / contact.noise_memory).collect();
            let level = level(&looked_at.time, &left, &noise);
            added.iter_mut().zip(level).for_each(|(added, level)| *added += level);
        }
        take_off(force, &trial.time, &added, looked_at);
    }
    trials
}

/// `trial` without the effort in its force.
fn without_effort(trial: &Recording, crosstalk: Crosstalk) -> Recording {
    let mut trial = trial.clone();
    let step_s = trial.period();
    if let (Some(force), Some(effort)) = (&mut trial.force, &trial.effort) {
        crosstalk.take_off(force, effort, step_s);
    }
    trial
}

/// Trials with the force that a contact's law gives along the motion.
pub struct LawForce {
    /// The trials.
    pub trials: Vec<Recording>,
    /// Error of that force by the law's values, N or N m in root mean square: of p values fitted to n rows that leave r, r sqrt(p t / n), where t
    /// rows tell no more than one.
    pub error: f64,
}

/// `trials` without what the contact's law leaves of their force: the force by the law, which holds none of the sensor's noise; `None` where
/// the law leaves more than that noise.
///
/// The drive feels the force on the tool and not the sensor's noise. Where that is louder than what else disturbs the drive, a wrong law of
/// the drive fits better that gives the contact's force by the position and hears the sensor less, as a link as stiff as the contact does.
#[must_use]
pub fn by_the_law(contact: &Outcome, trials: &[Recording]) -> Option<LawForce> {
    if !matches!(contact.verdict, Verdict::NoMismatch | Verdict::Parameters | Verdict::Explained) {
        return None;
    }
    let fit = &contact.chosen;
    let (mut trials, mut left) = (trials.to_vec(), Vec::new());
    for (number, (trial, looked_at)) in trials.iter_mut().zip(&contact.trials).enumerate() {
        let predicted = fit.model.predicted(&fit.values, looked_at, number);
        let noise: Vec<f64> = looked_at.force.iter().zip(&predicted).map(|(force, shown)| force - shown).collect();
        take_off(trial.force.as_mut()?, &trial.time, &noise, looked_at);
        left.push(noise);
    }
    let memory = integrated_autocorrelation(&left.iter().map(Vec::as_slice).collect::<Vec<_>>());
    let rows = left.iter().map(Vec::len).sum::<usize>() as f64;
    let power = left.iter().map(|noise| energy(noise)).sum::<f64>() / rows;
    let error = (power * memory * fit.model.free_count() as f64 / rows).sqrt();
    Some(LawForce { trials, error })
}

/// Changes of the force by the law of `contact` in the rows of `trials`, a column a trial, for one deviation of its values along each of as
/// many directions that are independent of one another: together they have the covariance of the values.
#[must_use]
pub fn deviations_of_law(contact: &Outcome, trials: &[Recording]) -> Vec<Vec<Vec<f64>>> {
    let fit = &contact.chosen;
    let predicted = |values: &[f64]| -> Vec<Vec<f64>> {
        let each = contact.trials.iter().enumerate();
        each.map(|(number, trial)| fit.model.predicted(values, trial, number)).collect()
    };
    let at = predicted(&fit.values);
    let moved = |direction: Vec<f64>| -> Vec<Vec<f64>> {
        let values: Vec<f64> = fit.values.iter().zip(direction).map(|(value, change)| value + change).collect();
        let each = predicted(&values).into_iter().zip(&at).zip(&contact.trials).zip(trials);
        each.map(|(((after, before), looked_at), trial)| {
            let change: Vec<f64> = after.iter().zip(before).map(|(after, before)| after - before).collect();
            on_clock(&trial.time, &change, looked_at)
        })
        .collect()
    };
    let intervals = Intervals { ends: contact.intervals.clone(), covariance: contact.covariance.clone() };
    let directions = intervals.directions(&fit.values).into_iter().map(moved);
    directions.filter(|change| change.iter().flatten().all(|change| change.is_finite())).collect()
}

/// Takes `added` off `force`, whose rows are at `time`: a value for each row that the contact was looked at in. Means of rows begin after
/// the first row and end before the last.
fn take_off(force: &mut [f64], time: &[f64], added: &[f64], looked_at: &ContactTrial) {
    force.iter_mut().zip(on_clock(time, added, looked_at)).for_each(|(force, added)| *force -= added);
}

/// `values` of the rows that the contact was looked at in, at each of the recorded rows, whose instants are `time`.
#[must_use]
pub fn on_clock(time: &[f64], values: &[f64], looked_at: &ContactTrial) -> Vec<f64> {
    interpolated(&looked_at.time, values, &clock(time, looked_at))
}

/// The recorded rows at `time` on the clock of the rows that the contact was looked at in, no earlier than their first and no later than
/// their last.
fn clock(time: &[f64], looked_at: &ContactTrial) -> Vec<f64> {
    let [first, last] = [0, looked_at.len() - 1].map(|row| looked_at.time[row]);
    time.iter().map(|at| (at - time[0]).clamp(first, last)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::contact::circumstances::Circumstances;
    use crate::diagnose::contact::identification::identify;
    use crate::diagnose::contact::nominal::NominalContact;
    use crate::diagnose::contact::testing::{FORCE_NOISE, RATE, TestContact};
    use crate::diagnose::interval::NORMAL_97_5;
    use crate::effects::Resolved;

    /// A zero that wanders by 0.05 N in a root second. Eight straight lines in twelve seconds leave 25 mN of it, 0.05 sqrt(1.5 / 6); what is
    /// followed beside them leaves a quarter.
    #[test]
    fn a_wandering_zero_is_followed() {
        let recordings = [1, 2].map(|seed| TestContact::PLAIN.wandering(0.05, seed));
        let trials = || recordings.each_ref().map(TestContact::seen).to_vec();
        let contact =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        assert_eq!(contact.chosen.model.names(0), ["force_drift"]);
        for (acted, seed) in as_it_acted(&contact, &recordings).iter().zip([1, 2]) {
            let whole = TestContact::PLAIN.recording(seed);
            let pairs = acted.force.iter().flatten().zip(whole.force.iter().flatten());
            let squares: Vec<f64> = pairs.map(|(acted, whole)| (acted - whole).powi(2)).collect();
            let error = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            // The level's own error is 6 mN by sqrt(q r) / 2 of the walk and the sensor's noise; the law's values add to it.
            assert!(error < 10e-3, "{error} N");
        }
    }

    /// A quarter of an effort of 2 N, and of one that steps by 2 N in the row before the last and is forgotten to a half from row to row.
    #[test]
    fn effort_in_the_reading_did_not_act() {
        let mut recordings = [1, 2].map(|seed| TestContact::PLAIN.recording(seed));
        let rows = recordings[0].time.len();
        recordings[0].effort = Some(vec![2.0; rows]);
        recordings[1].effort = Some((0..rows).map(|row| if row + 2 < rows { 0.0 } else { 2.0 }).collect());
        let trials = || recordings.each_ref().map(TestContact::seen).to_vec();
        let mut contact =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        let mut taken_off = |memory_s: f64, number: usize| {
            contact.crosstalk = Some(Crosstalk { part: 0.25, memory_s });
            let acted = &as_it_acted(&contact, &recordings)[number];
            let pairs = recordings[number].force.iter().flatten().zip(acted.force.iter().flatten());
            pairs.map(|(shown, acted)| shown - acted).skip(rows - 3).collect::<Vec<_>>()
        };
        // Forces of some newtons, to their rounding.
        let is = |found: Vec<f64>, expected: [f64; 3]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(is(taken_off(f64::INFINITY, 0), [0.5; 3]));
        let halved = recordings[1].period() / std::f64::consts::LN_2;
        assert!(is(taken_off(halved, 1), [0.0, 0.5, 0.25]));
    }

    /// Variances of a fit's prediction over those of the rows sum to the number of values (the leverages), whatever the law and however its values
    /// make up for each other: here times the mean of how much wider the intervals are than the curvature has them.
    #[test]
    fn the_laws_deviations_make_up_the_error_of_its_force() {
        let recordings = [1, 2].map(|seed| TestContact::PLAIN.recording(seed));
        let trials = || [1, 2].map(|seed| TestContact::PLAIN.trial(seed)).to_vec();
        let contact =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        let changes = deviations_of_law(&contact, &recordings);
        assert_eq!(changes.len(), 4, "stiffness, damping, surface and the timing of the clocks");
        let wider = |at: usize| {
            let [low, high] = contact.intervals[at];
            (high - low).powi(2) / (4.0 * NORMAL_97_5.powi(2) * contact.covariance[at][at])
        };
        let told = (0..contact.covariance.len()).filter(|at| contact.covariance[*at][*at] > 0.0);
        let by_hand: f64 = told.map(wider).sum();
        let leverage = |change: &Vec<Vec<f64>>| -> f64 {
            let rows = change.iter().flatten().zip(contact.noise.iter().flatten());
            rows.map(|(change, variance)| change * change / variance).sum()
        };
        let made_up: f64 = changes.iter().map(leverage).sum();
        // The residual's power and the sensors' differ by some hundredths.
        assert!((made_up / by_hand - 1.0).abs() < 0.1, "{made_up} {by_hand}");
    }

    /// The pad's own spring and damper along the encoder's positions are the truth.
    #[test]
    fn the_force_by_a_law_that_explains_it_holds_none_of_the_sensors_noise() {
        let contact = |contact: TestContact| {
            let trials = || [1, 2].map(|seed| contact.trial(seed)).to_vec();
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap()
        };
        let plain = TestContact::PLAIN;
        let quiet = by_the_law(&contact(TestContact::PLAIN), &[1, 2].map(|seed| plain.recording(seed))).unwrap();
        // Three values, 6000 rows that tell each for itself, or nearly so.
        let by_hand = FORCE_NOISE * f64::sqrt(3.0 / 6000.0);
        assert!((0.9 * by_hand..2.0 * by_hand).contains(&quiet.error), "{} N", quiet.error);
        for (quiet, seed) in quiet.trials.iter().zip([1, 2]) {
            let position = plain.recording(seed).position;
            let force = quiet.force.as_ref().unwrap();
            let error = |row: usize| {
                let velocity = 0.5 * RATE * (position[row + 1] - position[row - 1]);
                force[row] - plain.stiffness * position[row] - plain.damping * velocity
            };
            let deep: Vec<f64> = (1..force.len() - 1).filter(|row| position[*row] > 1e-3).map(error).collect();
            let left = (energy(&deep) / deep.len() as f64).sqrt();
            // The encoder's 2 um make 0.6 mN by the spring, and 2.1 mN by the damper and this difference over two rows.
            assert!(deep.len() > 1000 && left < 3e-3, "{left} N of {FORCE_NOISE}");
        }
        // What a law leaves that explains nothing is no noise.
        let mut unknown = contact(TestContact::PLAIN);
        unknown.verdict = Verdict::Unknown;
        assert!(by_the_law(&unknown, &[1, 2].map(|seed| plain.recording(seed))).is_none());
    }

    /// A zero of 0.3 N that the rig file states: the force without it is what acted, and what is shown but for what is known.
    #[test]
    fn what_the_rig_file_states_of_the_sensor_did_not_act() {
        let zero = TestContact { zero: 0.3, ..TestContact::PLAIN };
        let trials = || [1, 2].map(|seed| zero.trial(seed)).to_vec();
        let effect = crate::effects::find("force_bias").unwrap();
        let stated = Resolved { effect, form: 0, values: vec![0.28] };
        let rig = NominalContact { effects: vec![stated], ..TestContact::nominal() };
        let contact = identify(trials(), &trials(), &rig, Circumstances::default(), &|_| {}).unwrap();
        assert!(contact.named.is_empty());
        let shown = [1, 2].map(|seed| zero.recording(seed));
        for acted in [as_it_acted(&contact, &shown), as_the_rig_file_has_it(&contact, &shown)] {
            for (acted, shown) in acted.iter().zip(&shown) {
                let pairs = acted.force.iter().flatten().zip(shown.force.iter().flatten());
                // 6000 rows of 20 mN tell the zero to a hundredth of a deviation; the spring beside it to some more.
                assert!(
                    pairs.clone().all(|(acted, shown)| (shown - acted - 0.3).abs() < 0.1 * FORCE_NOISE),
                    "{:?}",
                    pairs.clone().next()
                );
            }
        }
    }

    /// A sensor that shows no more than 2 N of a contact that pushes harder: the drive is told of all of it.
    #[test]
    fn what_a_clipped_reading_misses_is_given_back() {
        let clipped = TestContact { limit: 2.0, ..TestContact::PLAIN };
        let trials = || [1, 2].map(|seed| clipped.trial(seed)).to_vec();
        let contact =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        assert_eq!(contact.chosen.model.names(0), ["force_saturation"]);
        let acted = as_it_acted(&contact, &[1, 2].map(|seed| clipped.recording(seed)));
        for (acted, seed) in acted.iter().zip([1, 2]) {
            let whole = TestContact::PLAIN.recording(seed);
            let pairs = || acted.force.iter().flatten().zip(whole.force.iter().flatten());
            assert!(pairs().filter(|(_, whole)| **whole > 2.3).count() > 100);
            for (acted, whole) in pairs() {
                // Five deviations of the noise, which a clipped row does not hold, and those of the law in 5000 rows.
                assert!((acted - whole).abs() < 6.0 * FORCE_NOISE, "{acted} N for {whole} N");
            }
        }
    }
}
