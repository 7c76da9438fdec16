//! Loads that repeat along the way: when two of them are two, and how they are told as one effect.

use std::f64::consts::TAU;

use super::fit::Fit;
use super::term::Term;

/// Wavenumbers of the ripples of `fit`, rad/m or periods a turn.
#[must_use]
pub fn ripples(fit: &Fit) -> Vec<f64> {
    let of_term = |at: usize| {
        let own = &fit.values[fit.model.values_of(at)];
        match fit.model.terms[at] {
            Term::Cogging => vec![own[2]],
            Term::Ripples(_) => own.chunks_exact(3).map(|one| one[2]).collect(),
            _ => Vec::new(),
        }
    };
    (0..fit.model.terms.len()).flat_map(of_term).collect()
}

/// Whether the travel tells every two ripples of `fit` apart: they differ by a period over it, or more (Lord Rayleigh's criterion). Closer ones
/// beat, and two large ones that nearly cancel stand for any slow course along the way.
#[must_use]
pub fn are_resolved(fit: &Fit) -> bool {
    let all = ripples(fit);
    let finest = TAU / fit.model.scales.travel;
    all.iter().enumerate().all(|(at, one)| all[..at].iter().all(|other| (one - other).abs() >= finest))
}

/// `fit` with its ripples, each of term `first` or later, as one term, the longest first: one drive has one cogging, of whatever shape.
/// `None` where it has no two.
#[must_use]
pub fn as_one_cogging(fit: &Fit, first: usize) -> Option<Fit> {
    let own: Vec<usize> = (first..fit.model.terms.len()).filter(|at| fit.model.terms[*at] == Term::Cogging).collect();
    let (one, others) = own.split_first()?;
    if others.is_empty() {
        return None;
    }
    let mut waves: Vec<Vec<f64>> = own.iter().map(|at| fit.values[fit.model.values_of(*at)].to_vec()).collect();
    waves.sort_by(|a, b| a[2].total_cmp(&b[2]));
    let mut whole = fit.clone();
    // The last of them goes first, so that the earlier keep their places; nothing builds on a ripple.
    for other in others.iter().rev() {
        whole.values.drain(whole.model.values_of(*other));
        whole.model.terms.remove(*other);
    }
    whole.values.splice(fit.model.values_of(*one), waves.concat());
    whole.model.terms[*one] = Term::Ripples(waves.len());
    Some(whole)
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SCALES, fit_of};
    use super::*;

    #[test]
    fn two_ripples_are_one_cogging_of_the_same_load() {
        let terms = [Term::Cogging, Term::Coulomb, Term::Cogging];
        let two = fit_of(&terms, &[0.1, 0.2, 900.0, 0.5, 0.3, -0.1, 300.0]);
        let one = as_one_cogging(&two, 0).expect("two of them");
        assert_eq!(one.model.terms, [Term::Ripples(2), Term::Coulomb]);
        assert_eq!((ripples(&one), one.model.names()), (vec![300.0, 900.0], two.model.names()));
        let laws = [&one, &two].map(|fit| fit.model.law(&fit.values));
        for position in [0.0, 1.1e-3, -0.4] {
            assert!((laws[0].load(position) - laws[1].load(position)).abs() < 1e-15);
        }
        assert_eq!(laws[0].friction, laws[1].friction);
        let three = fit_of(&[&terms[..], &[Term::Cogging]].concat(), &[&two.values[4..], &[0.4, 0.0, 500.0]].concat());
        let one = as_one_cogging(&three, 0).expect("three of them");
        assert_eq!(
            (&one.model.terms[..], ripples(&one)),
            (&[Term::Ripples(3), Term::Coulomb][..], vec![300.0, 500.0, 900.0])
        );
        assert_eq!(one.values[one.model.values_of(1)], [0.5]);
        // What the rig file holds stays as it is, and one is one.
        assert!(
            as_one_cogging(&two, 1).is_none()
                && as_one_cogging(&fit_of(&terms[1..], &[0.5, 0.3, 0.1, 9.0]), 0).is_none()
        );
    }

    #[test]
    fn ripples_that_beat_once_over_the_travel_are_not_two() {
        let finest = TAU / SCALES.travel;
        let apart =
            |by: f64| are_resolved(&fit_of(&[Term::Cogging, Term::Cogging], &[1.0, 0.0, 400.0, 1.0, 0.0, 400.0 + by]));
        assert!(apart(1.01 * finest) && apart(-1.01 * finest) && !apart(0.99 * finest) && !apart(0.0));
        assert!(are_resolved(&fit_of(&[Term::Cogging], &[1.0, 0.0, 400.0])));
        assert!(!are_resolved(&fit_of(&[Term::Ripples(2)], &[1.0, 0.0, 400.0, 1.0, 0.0, 400.0])));
    }
}
