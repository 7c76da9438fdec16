//! Whether a law that can be anything along one quantity does much better than the one that is named: then that is not all of it.

use super::candidates::is_likelier;
use super::criteria::{CURVE_PART, LEAST_PART_OF_EFFORT, MOST_LEFT, OVER_NOISE};
use super::fit::Fit;
use super::law::Along;
use super::selection::Search;
use super::term::Term;

/// Knots of the free curve over position.
const CURVE_KNOTS: usize = 24;

/// Whether a load by position of no law takes most of what the terms of `fit` leave, where that is much: then they are not all of it.
#[must_use]
pub fn a_curve_does_better(search: &Search<'_>, fit: &Fit, noise: f64) -> bool {
    let scales = &search.scales;
    let spacing = scales.travel / (CURVE_KNOTS - 1) as f64;
    let curve = Term::Curve { origin: scales.lowest, spacing, count: CURVE_KNOTS };
    leaves_much(search, fit) && is_halved_by(search, fit, curve, CURVE_KNOTS, noise)
}

/// Knots of a course of friction over the time of a trial: what warms up or wears does so slowly.
const TIME_KNOTS: usize = 6;

/// Whether dry friction that changes with time or place takes most of what the same friction leaves where it is always the same, where that
/// is much: then it is not the physics of this drive.
#[must_use]
pub fn a_friction_that_changes_does_better(search: &Search<'_>, fit: &Fit, noise: f64) -> bool {
    if !fit.model.terms.iter().any(Term::is_friction) || !leaves_much(search, fit) {
        return false;
    }
    let scales = &search.scales;
    let over = |along: Along, origin: f64, length: f64, count: usize| {
        let course = Term::FrictionCourse { along, origin, spacing: length / (count - 1) as f64, count };
        is_halved_by(search, fit, course, count, noise)
    };
    over(Along::Time, 0.0, scales.duration_s, TIME_KNOTS)
        || over(Along::Place, scales.lowest, scales.travel, CURVE_KNOTS)
}

/// Whether `fit`, of a rigid drive, leaves so much of what the nominal law lacks, and of the effort, that its names are doubted.
fn leaves_much(search: &Search<'_>, fit: &Fit) -> bool {
    let left = search.unexplained(fit);
    !fit.model.has_link()
        && left > MOST_LEFT * 0.5 * search.unexplained(&search.nominal)
        && left > LEAST_PART_OF_EFFORT * search.scales.effort
}

/// Whether `term` of no law, with `count` knots, takes half of what `fit` leaves beyond the sensors' `noise`, in root mean square: no term
/// takes that noise. It is no more than what any law leaves, and where that is all, `fit` has to leave notably more.
fn is_halved_by(search: &Search<'_>, fit: &Fit, term: Term, count: usize, noise: f64) -> bool {
    let mut start = fit.clone();
    start.model.terms.push(term);
    start.values.extend(vec![0.0; count]);
    let better = search.polished(&start);
    is_likelier(&better, fit) && is_halved(search.unexplained(fit), search.unexplained(&better), noise)
}

/// Whether of `left` beyond `noise` half is gone in what is left `after`, all root mean squares.
fn is_halved(left: f64, after: f64, noise: f64) -> bool {
    let noise = noise.min(after);
    let beyond = |all: f64| (all * all - noise * noise).sqrt();
    left > OVER_NOISE * noise && beyond(after) < CURVE_PART * beyond(left)
}

#[cfg(test)]
mod tests {
    use super::is_halved;

    /// By hand: of 5 beside a noise of 3 there are 4, of which 2 are left where all is sqrt(13) = 3.606.
    #[test]
    fn what_is_halved_is_counted_beyond_the_noise() {
        assert!(is_halved(5.0, 3.6, 3.0) && !is_halved(5.0, 3.61, 3.0));
        // A law that leaves less than the noise shows that the noise is less: five thirds of what it leaves are notable, 1.4 times are not.
        assert!(is_halved(5.0, 3.0, 4.0) && !is_halved(4.2, 3.0, 4.0));
        assert!(!is_halved(f64::NAN, 3.0, 3.0) && !is_halved(5.0, f64::NAN, 3.0));
    }
}
