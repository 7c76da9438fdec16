//! Ripples that are lines of the spectrum over the way: told by the spectrum around them, whatever the law leaves elsewhere.

use super::candidates::{Candidate, tried};
use super::criteria::LEAST_GAIN;
use super::fit::Fit;
use super::order_spectrum::OrderSpectrum;
use super::ripples::{are_resolved, as_one_cogging, ripples};
use super::selection::{Search, is_at_end};
use super::term::Term;
use crate::effects::MOST_PATTERNS;

/// Pitches of what is left that are looked at, the strongest: between the lines lies what no line is.
const PITCHES: usize = 8;

impl Search<'_> {
    /// `fit` with each ripple that it lacks and whose line stands out of what it leaves over the way, the likeliest first; with any, all its ripples are one cogging.
    #[must_use]
    pub fn with_order_lines(&self, mut fit: Fit, sets: &mut Vec<Fit>) -> Fit {
        let mut is_found = false;
        while ripples(&fit).len() < MOST_PATTERNS {
            let lines = self.order_spectrum(&fit).lines(PITCHES, LEAST_GAIN.value());
            let starts: Vec<Vec<f64>> = lines.into_iter().map(|at| vec![0.0, 0.0, at]).collect();
            if starts.is_empty() {
                break;
            }
            let quick = tried(&self.data, &fit, vec![Candidate { term: Term::Cogging, starts }]);
            let Some(more) = quick.first().map(|quick| self.polished(quick)) else { break };
            if is_at_end(&more) || !are_resolved(&more) || !self.is_worth(&more, &fit) {
                break;
            }
            sets.push(more.clone());
            (fit, is_found) = (more, true);
        }
        if is_found { as_one_cogging(&fit, self.nominal.model.terms.len()).unwrap_or(fit) } else { fit }
    }

    /// Whether a ripple is all that `more` has beyond `less`, and is a line of what that leaves.
    #[must_use]
    pub fn is_worth_as_a_line(&self, more: &Fit, less: &Fit) -> bool {
        let nats = ripple_beyond(more, less).and_then(|own| self.order_spectrum(less).line_nats(own));
        nats.is_some_and(|nats| nats > LEAST_GAIN.value())
    }

    fn order_spectrum(&self, fit: &Fit) -> OrderSpectrum {
        OrderSpectrum::of(&self.data, &self.scales, &self.disturbance(fit))
    }
}

/// Wavenumber of the ripple that `more` has beyond `less`, where that is all it has: the one that lies farthest from each of those.
fn ripple_beyond(more: &Fit, less: &Fit) -> Option<f64> {
    let others =
        |fit: &Fit| -> Vec<Term> { fit.model.terms.iter().filter(|term| !term.is_ripple()).cloned().collect() };
    let (all, known) = (ripples(more), ripples(less));
    if others(more) != others(less) || all.len() != known.len() + 1 {
        return None;
    }
    let nearest = |one: &f64| known.iter().map(|other| (one - other).abs()).fold(f64::INFINITY, f64::min);
    all.into_iter().max_by(|a, b| nearest(a).total_cmp(&nearest(b)))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::testing::{TestDrive, search_over};
    use super::*;

    /// Of a white force of 6 mN over 20 Hz; there are 30 and 50 of them to the travel.
    #[test]
    fn every_ripple_that_is_a_line_is_told_and_they_are_one_cogging() {
        let drive = TestDrive { third_ripple: 0.1, fifth_ripple: 0.1, disturbance: 1e-6, ..TestDrive::PLAIN };
        let trials = [drive.trial(5.0, 8), drive.trial(5.0, 9)];
        let search = search_over(&trials, &drive);
        let mut sets = Vec::new();
        let found = search.with_order_lines(search.nominal.clone(), &mut sets);
        assert_eq!((found.model.terms.as_slice(), sets.len()), (&[Term::Ripples(2)][..], 2));
        let own = &found.values[found.model.values_of(0)];
        for (wave, (pitch, size)) in own.chunks(3).zip([(5e-3 / 3.0, 0.1), (1e-3, 0.1)]) {
            // Ten seconds tell a size to a twentieth, and a pitch to a twentieth of a period over the travel.
            assert!((TAU / wave[2] / pitch - 1.0).abs() < 1e-3, "{own:?}");
            assert!((wave[0].hypot(wave[1]) - size).abs() < 0.005, "{own:?}");
        }
        // Where they are known there is nothing more.
        assert_eq!(search.with_order_lines(found.clone(), &mut sets).model, found.model);
        assert_eq!(sets.len(), 2);
    }

    #[test]
    fn a_ripple_beyond_is_the_one_that_the_smaller_law_lacks() {
        let of = |waves: &[f64]| {
            let own: Vec<f64> = waves.iter().flat_map(|wave| [1.0, 0.0, *wave]).collect();
            super::super::testing::fit_of(&vec![Term::Cogging; waves.len()], &own)
        };
        assert_eq!(ripple_beyond(&of(&[300.0, 500.0, 900.0]), &of(&[301.0, 899.0])), Some(500.0));
        assert_eq!(ripple_beyond(&of(&[300.0]), &of(&[])), Some(300.0));
        assert_eq!(ripple_beyond(&of(&[300.0, 500.0]), &of(&[])), None);
        let rubs = super::super::testing::fit_of(&[Term::Coulomb, Term::Cogging], &[0.1, 1.0, 0.0, 300.0]);
        assert_eq!(ripple_beyond(&rubs, &of(&[])), None);
    }
}
