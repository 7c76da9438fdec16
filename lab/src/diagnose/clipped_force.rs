//! Where the sensor shows less force than there is.

use super::acting_force::{on_clock, sensor_terms};
use super::contact::fit::Fit;
use super::contact::outcome::Outcome;
use super::contact::pruning::without_term;
use crate::recording::Recording;

/// Times of a trial from the first to the last of rows that follow each other, s.
pub type Spans = Vec<[f64; 2]>;

/// When the force of each of `trials` lies beyond the limit of a sensor that `contact` names or the rig file states, by more than its noise. What acts there is known by the
/// contact's law alone, whose values' error is alike along the whole of such a stretch: the drive would take it for a force of its own.
#[must_use]
pub fn clipped_spans(contact: &Outcome, trials: &[Recording]) -> Vec<Spans> {
    let shown = &contact.chosen;
    let is_limit = |at: &usize| shown.model.terms[*at].name() == "force_saturation";
    let Some(at) = sensor_terms(contact).into_iter().find(is_limit) else { return Vec::new() };
    let (model, values) = without_term(shown, at);
    let acted = Fit { model, values, ..shown.clone() };
    let each = trials.iter().zip(&contact.trials).enumerate();
    each.map(|(number, (trial, looked_at))| {
        let [shown, acted] = [shown, &acted].map(|fit| fit.model.predicted(&fit.values, looked_at, number));
        let missed: Vec<f64> = acted.iter().zip(shown).map(|(acted, shown)| acted - shown).collect();
        let missed = on_clock(&trial.time, &missed, looked_at);
        spans(&trial.time, &missed, looked_at.force_variance.sqrt())
    })
    .collect()
}

/// When `missed` is more than `noise` of either sign.
fn spans(time: &[f64], missed: &[f64], noise: f64) -> Spans {
    let mut spans = Spans::new();
    let mut is_open = false;
    for (time, missed) in time.iter().zip(missed) {
        let is_clipped = missed.abs() > noise;
        match spans.last_mut().filter(|_| is_open && is_clipped) {
            Some(span) => span[1] = *time,
            None if is_clipped => spans.push([*time; 2]),
            None => {}
        }
        is_open = is_clipped;
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::contact::circumstances::Circumstances;
    use crate::diagnose::contact::identification::identify;
    use crate::diagnose::contact::nominal::NominalContact;
    use crate::diagnose::contact::testing::{FORCE_NOISE, TestContact};
    use crate::effects::Resolved;

    #[test]
    fn spans_are_of_rows_that_follow_each_other() {
        let time: Vec<f64> = (0..8).map(f64::from).collect();
        assert_eq!(spans(&time, &[0.0, 2.0, -2.0, 1.0, 0.0, 3.0, 0.0, 2.0], 1.0), [[1.0, 2.0], [5.0, 5.0], [7.0, 7.0]]);
        assert!(spans(&time, &[0.0; 8], 1.0).is_empty() && spans(&[], &[], 1.0).is_empty());
    }

    /// A sensor that shows no more than 2 N: the rows in which more acts, and no others, but for those within some deviations of its noise of the limit.
    #[test]
    fn a_force_beyond_the_limit_is_clipped_and_no_other_is() {
        let of = |drawn: TestContact, stated: Vec<Resolved>| {
            let trials = || [1, 2].map(|seed| drawn.trial(seed)).to_vec();
            let rig = NominalContact { effects: stated, ..TestContact::nominal() };
            let contact = identify(trials(), &trials(), &rig, Circumstances::default(), &|_| {}).unwrap();
            clipped_spans(&contact, &[1, 2].map(|seed| drawn.recording(seed)))
        };
        let limit = Resolved { effect: crate::effects::find("force_saturation").unwrap(), form: 0, values: vec![2.0] };
        // The same where the rig file states the limit.
        for stated in [vec![], vec![limit]] {
            let clipped = of(TestContact { limit: 2.0, ..TestContact::PLAIN }, stated);
            let mut beyond = 0;
            for (spans, seed) in clipped.iter().zip([1, 2]) {
                let whole = TestContact::PLAIN.recording(seed);
                for (time, force) in whole.time.iter().zip(whole.force.as_ref().unwrap()) {
                    let is_clipped = spans.iter().any(|[start, end]| (*start..=*end).contains(time));
                    // The noise of the drawn row, five deviations, and one by which the force has to be beyond.
                    assert!(
                        (*force > 2.0 - 6.0 * FORCE_NOISE || !is_clipped)
                            && (*force < 2.0 + 6.0 * FORCE_NOISE || is_clipped),
                        "{time} s, {force} N"
                    );
                    beyond += usize::from(is_clipped);
                }
            }
            assert!(beyond > 200, "{beyond}");
        }
        assert!(of(TestContact::PLAIN, vec![]).iter().all(Vec::is_empty));
    }
}
