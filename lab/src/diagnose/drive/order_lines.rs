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
