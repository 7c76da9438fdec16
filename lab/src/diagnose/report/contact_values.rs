//! The values of a contact's law with their intervals, and how they go together.

use super::channel;
use super::contact_report::CHANNEL;
use super::correlation;
use super::diagnosis::{Correlations, Nominal};
use crate::diagnose::contact::model::index;
use crate::diagnose::contact::outcome::Outcome;
use crate::diagnose::interval::NORMAL_97_5;
use crate::effects::slug;
use crate::rig::Rig;

/// The rig file's values of a contact and the fitted ones; none where the rig has no contact.
pub(super) fn nominal(outcome: &Outcome, rig: &Rig) -> Vec<Nominal> {
    let c = rig.coordinate;
    let Some(contact) = rig.contact else { return Vec::new() };
    let row = |name: &str, unit: &str, given: f64, at: usize| {
        let fitted = outcome.chosen.values[at];
        let ends = if at == index::SURFACE { ends_of_the_surface(outcome) } else { outcome.intervals[at] };
        let ci95 = channel::told(fitted, ends);
        Nominal { name: format!("{name}_{}", slug(unit)), unit: unit.to_owned(), given, fitted, ci95 }
    };
    vec![
        row("stiffness", c.stiffness_unit(), contact.stiffness, index::STIFFNESS),
        row("damping", c.damping_unit(), contact.damping, index::DAMPING),
        row("surface", c.position_unit(), contact.surface, index::SURFACE),
    ]
}

/// The 95 % interval of the surface's place as others measure it. To the force of the law where an encoder began is nothing: that goes by the
/// encoder's own places.
fn ends_of_the_surface(outcome: &Outcome) -> [f64; 2] {
    let steps: Vec<f64> = outcome.trials.iter().map(|trial| trial.figures.position.resolution).collect();
    beside_the_encoders_start(outcome.chosen.values[index::SURFACE], outcome.intervals[index::SURFACE], &steps)
}

/// The `ends` of the interval of a `place` that is fitted to trials whose encoders have these `steps`, with where they began: anywhere within
/// a step, which moves all places of a trial by one error, uniform over it.
fn beside_the_encoders_start(place: f64, [low, high]: [f64; 2], steps: &[f64]) -> [f64; 2] {
    let variances: f64 = steps.iter().map(|step| step * step / 12.0).sum();
    let half = NORMAL_97_5 * variances.sqrt() / steps.len().max(1) as f64;
    [place - (place - low).hypot(half), place + (high - place).hypot(half)]
}

/// Of the values that the report shows.
pub(super) fn correlations(outcome: &Outcome, rig: &Rig) -> Option<Correlations> {
    let c = rig.coordinate;
    let model = &outcome.chosen.model;
    let nominal = [
        ("stiffness", c.stiffness_unit(), index::STIFFNESS),
        ("damping", c.damping_unit(), index::DAMPING),
        ("surface", c.position_unit(), index::SURFACE),
    ];
    let mut shown: Vec<(String, usize)> = nominal.map(|(name, unit, at)| (format!("{name}_{}", slug(unit)), at)).into();
    for (at, term) in model.terms.iter().enumerate() {
        let first = model.first_value_of(at);
        let names = term.parameters().iter().enumerate();
        shown.extend(names.map(|(offset, parameter)| (format!("{}.{}", term.name(), parameter.name), first + offset)));
    }
    let values = |values: &[f64]| shown.iter().map(|(name, at)| (name.clone(), values[*at])).collect();
    correlation::correlations(CHANNEL, &outcome.chosen.values, &outcome.covariance, &values)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four trials by steps of 0.2 mm: one start is known to 0.0577 mm, the mean of four to half of it, 1.96 of which are 0.0566 mm.
    #[test]
    fn a_place_is_known_no_better_than_where_its_encoder_began() {
        let start = NORMAL_97_5 * 0.2 / 12f64.sqrt() / 2.0;
        let [low, high] = beside_the_encoders_start(3.0, [3.0, 3.0], &[0.2; 4]);
        assert!((low - (3.0 - start)).abs() < 1e-12 && (high - (3.0 + start)).abs() < 1e-12, "{low} {high}");
        let [low, high] = beside_the_encoders_start(3.0, [2.9, 3.2], &[0.2; 4]);
        assert!((3.0 - low - 0.1f64.hypot(start)).abs() < 1e-12 && (high - 3.0 - 0.2f64.hypot(start)).abs() < 1e-12);
        assert_eq!(beside_the_encoders_start(3.0, [2.9, 3.2], &[0.0; 2]), [3.0 - (3.0 - 2.9), 3.0 + (3.2 - 3.0)]);
    }
}
