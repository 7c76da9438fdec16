//! Effects that are a line of the spectrum, as a tone of the mains is: told by the spectrum around it, whatever the law of the contact
//! leaves elsewhere.

use super::criteria::{LEAST_GAIN, LEAST_LINE_POWER, LINE_TOLERANCE};
use super::fit::{Effort, Fit};
use super::model::index;
use super::projection::Projection;
use super::search::Search;
use super::tones::{is_on_a_line, line_nats};
use super::trial::ContactTrial;
use crate::diagnose::term::Term;

impl Search<'_> {
    /// `fit` with each line that it lacks and that the recordings hold: beside a law that is told they are looked for on every row, because
    /// means of more rows hide them, and to the end, because they are no part of what a law leaves.
    pub(super) fn with_lines(&mut self, fit: Fit, sets: &mut Vec<Fit>) -> Fit {
        let lacking = |term: &Term| {
            !term.effect.lines().is_empty()
                && fit.model.times(term.name()) == 0
                && self.circumstances.allow(term.name())
        };
        let excitation = fit.model.scales.excitation(
            self.data.trials,
            fit.values[index::STIFFNESS],
            fit.values[index::SURFACE],
            fit.model.bilateral,
        );
        let promises = Projection::of(&self.data, &fit).promises(&excitation, &lacking);
        let mut best = fit.clone();
        for promise in promises {
            let model = best.model.with(promise.term);
            let start: Vec<f64> = best.values.iter().chain(&promise.values[..]).copied().collect();
            let more = self.data.fit(&model, &start, Effort::FULL);
            if self.is_admissible(&more) && self.is_worth(&more, &best) {
                best = more;
            }
        }
        if best.model == fit.model {
            return fit;
        }
        sets.push(best.clone());
        self.weigh_by(best)
    }

    /// Whether a line is all that `more` has beyond `less`, and is one by the spectrum around it; `None` where it has something else.
    pub(super) fn is_worth_as_a_line(&self, more: &Fit, less: &Fit) -> Option<bool> {
        let nats = self.nats_of_line(more, less)?;
        Some(nats > LEAST_GAIN.value() && self.is_loud_enough(more, less))
    }

    /// Probability that noise is somewhere about the line as loud as the line is that `more` has beyond `less`; `None` where it has something else.
    pub(super) fn chance_of_line(&self, more: &Fit, less: &Fit) -> Option<f64> {
        self.nats_of_line(more, less).map(|nats| (-nats).exp().min(1.0))
    }

    /// Logarithm of one over that probability.
    fn nats_of_line(&self, more: &Fit, less: &Fit) -> Option<f64> {
        let frequency = line_beyond(more, less)?;
        let rest = self.data.weighted_residual(&less.model, &less.values);
        Some(line_nats(&self.data, &rest, frequency) - self.line_trials(frequency).ln())
    }

    /// Whether what `more` takes of `less` is a part of the noise that matters.
    pub(super) fn is_loud_enough(&self, more: &Fit, less: &Fit) -> bool {
        less.energy - more.energy > LEAST_LINE_POWER * self.data.expected()
    }

    /// Frequencies that noise has near a line, each of which could be the loudest.
    fn line_trials(&self, frequency: f64) -> f64 {
        let longest = self.data.trials.iter().map(ContactTrial::duration_s).fold(0.0, f64::max);
        (LINE_TOLERANCE * frequency * longest).max(1.0).value()
    }
}

/// Frequency, Hz, of the line that `more` has beyond `less`, where that is all it has.
pub(super) fn line_beyond(more: &Fit, less: &Fit) -> Option<f64> {
    let at = more.model.terms.iter().position(|term| !term.effect.lines().is_empty())?;
    let mut without = more.model.clone();
    let line = without.terms.remove(at);
    let frequency = more.model.line(&more.values, at)?;
    (without == less.model && is_on_a_line(line.effect.lines(), frequency)).then_some(frequency)
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::identification::identify;
    use super::super::testing::{FORCE_NOISE, RATE, TestContact};
    use super::super::trial::ContactTrial;

    /// `contact` with a tone of `size` of the sensor's noise.
    fn humming(contact: &TestContact, frequency: f64, size: f64) -> Vec<ContactTrial> {
        let trials = [1u64, 2].map(|seed| {
            let mut recording = contact.recording(seed);
            for (row, force) in recording.force.as_mut().unwrap().iter_mut().enumerate() {
                *force +=
                    size * FORCE_NOISE * (std::f64::consts::TAU * frequency * row as f64 / RATE + seed as f64).sin();
            }
            TestContact::seen(&recording)
        });
        trials.to_vec()
    }

    fn names(contact: &TestContact, frequency: f64, size: f64) -> Vec<&'static str> {
        let trials = || humming(contact, frequency, size);
        let outcome =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        // However little of the force it is, it is told by how it stands out of the spectrum.
        assert!(outcome.named.iter().all(|named| named.p_value < 1e-3), "{:?}", outcome.named);
        outcome.chosen.model.names(outcome.known_terms)
    }

    /// A spring ten times stiffer than that of the rig file: a tone of a third of the noise is a thousandth of the force's deviation.
    #[test]
    fn a_tone_of_the_mains_is_told_however_small_beside_the_force() {
        let stiff = TestContact { stiffness: 3000.0, ..TestContact::PLAIN };
        assert_eq!(names(&stiff, 50.02, 0.35), ["mains_hum"]);
        assert_eq!(names(&stiff, 49.4, 0.35), ["mains_hum"], "of a network that stands alone");
        assert_eq!(names(&stiff, 50.02, 0.05), Vec::<&str>::new());
        // No line of the mains.
        assert_eq!(names(&stiff, 53.0, 0.35), Vec::<&str>::new());
    }

    #[test]
    fn a_tone_is_told_beside_a_law() {
        let relaxing = TestContact { fading: 1.5, ..TestContact::PLAIN };
        assert_eq!(names(&relaxing, 60.0, 0.4), ["mains_hum", "stress_relaxation"]);
    }
}
