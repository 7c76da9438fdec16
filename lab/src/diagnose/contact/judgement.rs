//! How far the effects that were found stand for the mismatch.

use super::criteria::{
    HEIGHT_PART, LEAST_PART_OF_FORCE, LEAST_TOLD_SHARE, MOST_LEFT, NOISE_POWER_KNOWN_TO, NOTABLE_POWER, TOLD_SHARE,
    UNKNOWN_PART_OF_FORCE, VALUES_MATTER,
};
use super::fit::Fit;
use super::free_motion::left_by_height_and_law;
use super::held_out::{HeldOut, rms};
use super::rest::Rest;
use super::search::Search;
use crate::diagnose::evidence::{NamedTerm, share_beyond_noise};
use crate::diagnose::verdict::Verdict;

/// Whether named effects leave something notable and take less of the mismatch than they leave.
pub(super) fn takes_too_little(search: &Search<'_>, fit: &Fit, named: &[NamedTerm]) -> bool {
    let expected = search.data.expected();
    let all = (search.nominal.energy - expected).max(f64::MIN_POSITIVE);
    let left = (fit.energy - expected).max(0.0);
    !named.is_empty() && Rest::of(&search.data, fit).over_sensors > NOTABLE_POWER && 1.0 - left / all < LEAST_TOLD_SHARE
}

/// Whether a force that depends on the height alone stands for free motion far better than `fit` with adhesion among its `named` effects, which
/// leaves something notable there: a magnet or a charge pulls on the way in as on the way out, and adhesion on the way out alone.
pub(super) fn acts_at_a_distance(search: &Search<'_>, fit: &Fit, named: &[NamedTerm]) -> bool {
    let is_adhesion = |named: &NamedTerm| fit.model.terms[named.at].name() == "adhesion";
    if !named.iter().any(is_adhesion) {
        return false;
    }
    let data = &search.data;
    let residual = data.residuals(&fit.model, &fit.values);
    let left = left_by_height_and_law(data.trials, fit, &data.noise, &residual);
    left.is_some_and(|[by_height, by_law]| by_law > NOTABLE_POWER.value() && leaves_little(by_height, by_law))
}

/// Whether a force of the height alone, which leaves `by_height` in free motion, leaves less than [`HEIGHT_PART`] of what a law leaves there, `by_law`, beyond
/// the sensors' noise; both are multiples of that noise's power.
fn leaves_little(by_height: f64, by_law: f64) -> bool {
    share_beyond_noise(by_law, by_height, 1.0, NOISE_POWER_KNOWN_TO.value()) > 1.0 - HEIGHT_PART.value()
}

/// Whether what `fit` leaves, `rest`, is more than the sensors may leave, by the rows' weights and as it is told, in newtons, and a part
/// of the force that is of interest.
pub(super) fn is_notable(search: &Search<'_>, fit: &Fit, rest: &Rest) -> bool {
    let data = &search.data;
    let left = fit.energy - data.expected();
    let least = if data.is_limited_by_rounding() { data.most_noise() } else { data.expected_noise() };
    rest.over_sensors > NOTABLE_POWER
        && search.part_of_force(left) > UNKNOWN_PART_OF_FORCE.value().max(LEAST_PART_OF_FORCE.value())
        && rms(data, &data.residuals(&fit.model, &fit.values)) > least
}

pub(super) fn verdict(search: &Search<'_>, fit: &Fit, named: &[NamedTerm], given: f64, held: [&HeldOut; 2]) -> Verdict {
    let data = &search.data;
    let expected = data.expected();
    let rest = Rest::of(data, fit);
    let left = (fit.energy - expected).max(0.0);
    let all = (search.nominal.energy - expected).max(f64::MIN_POSITIVE);
    let is_notable = is_notable(search, fit, &rest);
    if named.is_empty() {
        let refitted = rms(data, &held[0].residual);
        return if is_notable {
            Verdict::Unknown
        } else if given > VALUES_MATTER * refitted {
            Verdict::Parameters
        } else {
            Verdict::NoMismatch
        };
    }
    let is_told = 1.0 - left / all > TOLD_SHARE;
    // Layers say where a force falls, and not what lets it fall: a column that buckles, a leaf, a magnet.
    let falls = fit.model.fall(&fit.values).is_some() && search.nominal.model.fall(&search.nominal.values).is_none();
    if falls || is_notable && (!is_told || rest.over_sensors > MOST_LEFT * search.nominal.energy / expected) {
        Verdict::PartlyExplained
    } else {
        Verdict::Explained
    }
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::identification::identify;
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::super::trial::ContactTrial;
    use super::leaves_little;
    use crate::diagnose::verdict::Verdict;

    fn judged(trials: &dyn Fn() -> Vec<ContactTrial>) -> (Vec<&'static str>, Verdict, f64) {
        let outcome =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        (outcome.chosen.model.names(outcome.known_terms), outcome.verdict, outcome.expected_noise)
    }

    /// A magnet pulls before anything is touched, and adhesion would not.
    #[test]
    fn what_pulls_at_a_distance_is_no_adhesion() {
        let pull = |x: f64| -0.4 / (1.0 + (-x).max(0.0) / 8e-4).powi(2);
        let pulled = || [1, 2].map(|seed| TestContact::PLAIN.trial_with(seed, pull)).to_vec();
        let (names, verdict, _) = judged(&pulled);
        assert_eq!((names, verdict), (vec![], Verdict::Unknown));
    }

    /// By hand, in multiples of the noise's power.
    #[test]
    fn a_force_of_the_height_leaves_little_of_what_is_beyond_the_noise() {
        // All of the 0.7 beyond the noise; a third of it; two thirds of nine.
        assert!(leaves_little(1.0, 1.7) && !leaves_little(1.4667, 1.7) && leaves_little(4.0, 10.0));
        // Noise is known to a third: what is taken of less is no part of it.
        assert!(!leaves_little(0.9, 1.05));
    }

    /// Noise that remembers for six rows, in free motion whose pieces are too short for the wavelets of that memory: by these alone the noise is a
    /// third too small, and what is left is called unknown.
    #[test]
    fn noise_that_remembers_is_nothing_unknown() {
        let trials = || [3, 4].map(|seed| TestContact::PLAIN.remembering(6.0, 3.0 * FORCE_NOISE, seed)).to_vec();
        let (names, verdict, noise) = judged(&trials);
        assert_eq!((names, verdict), (vec![], Verdict::Parameters));
        // The root of one and nine, of some 500 independent squares: 3 %. A tenth is three of these.
        assert!((noise / (10.0f64.sqrt() * FORCE_NOISE) - 1.0).abs() < 0.1, "{noise}");
    }
}
