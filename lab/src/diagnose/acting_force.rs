//! The force that acted on the drive, where the contact told what the sensor made of it.

use super::CARRIED_BY_THE_DRIVE;
use super::contact::fit::Fit;
use super::contact::outcome::Outcome;
use super::contact::selection::without_term;
use super::term::Term;
use crate::effects::Place;
use crate::recording::Recording;
use crate::recording::assemble::interpolated;

/// `trials` with the force as it acted, N or N m: what the named effects of the sensor add to the law's reading along the motion is taken
/// off, in the means of rows that the contact was looked at in. The drive would take a zero for a load, and what a clipped reading
/// misses for a force of its own.
#[must_use]
pub fn as_it_acted(contact: &Outcome, trials: &[Recording]) -> Vec<Recording> {
    let shown = &contact.chosen;
    let is_of_sensor = |term: &Term| {
        let spec = term.effect.spec();
        spec.place == Place::Sensor && !CARRIED_BY_THE_DRIVE.contains(&spec.name)
    };
    let named = contact.named.iter().map(|named| named.at);
    let mut sensors: Vec<usize> = named.filter(|at| is_of_sensor(&shown.model.terms[*at])).collect();
    sensors.sort_unstable();
    let mut acted = shown.clone();
    for at in sensors.iter().rev() {
        let (model, values) = without_term(&acted, *at);
        acted = Fit { model, values, ..acted };
    }
    let mut trials = trials.to_vec();
    if sensors.is_empty() {
        return trials;
    }
    for (number, (trial, looked_at)) in trials.iter_mut().zip(&contact.trials).enumerate() {
        let Some(force) = &mut trial.force else { continue };
        let [shown, acted] = [shown, &acted].map(|fit| fit.model.predicted(&fit.values, looked_at, number));
        let added: Vec<f64> = shown.iter().zip(acted).map(|(shown, acted)| shown - acted).collect();
        let clock: Vec<f64> = trial.time.iter().map(|time| time - trial.time[0]).collect();
        let added = interpolated(&looked_at.time, &added, &clock);
        force.iter_mut().zip(added).for_each(|(force, added)| *force -= added);
    }
    trials
}
