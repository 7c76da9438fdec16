//! How far the effects that were found stand for the mismatch.

use super::criteria::{
    LEAST_PART_OF_FORCE, LEAST_TOLD_SHARE, MOST_LEFT, NOTABLE_POWER, TOLD_SHARE, UNKNOWN_PART_OF_FORCE, VALUES_MATTER,
};
use super::fit::Fit;
use super::held_out::{HeldOut, rms};
use super::rest::Rest;
use super::search::Search;
use crate::diagnose::evidence::NamedTerm;
use crate::diagnose::verdict::Verdict;

/// Whether named effects leave something notable and take less of the mismatch than they leave.
pub(super) fn takes_too_little(search: &Search<'_>, fit: &Fit, named: &[NamedTerm]) -> bool {
    let expected = search.data.expected();
    let all = (search.nominal.energy - expected).max(f64::MIN_POSITIVE);
    let left = (fit.energy - expected).max(0.0);
    !named.is_empty() && Rest::of(&search.data, fit).over_sensors > NOTABLE_POWER && 1.0 - left / all < LEAST_TOLD_SHARE
}

/// Whether what `fit` leaves, `rest`, is more than the sensors may leave, by the rows' weights and as it is told, in newtons, and a part
/// of the force that is of interest.
pub(super) fn is_notable(search: &Search<'_>, fit: &Fit, rest: &Rest) -> bool {
    let data = &search.data;
    let left = fit.energy - data.expected();
    rest.over_sensors > NOTABLE_POWER
        && search.part_of_force(left) > UNKNOWN_PART_OF_FORCE.value().max(LEAST_PART_OF_FORCE.value())
        && rms(data, &data.residuals(&fit.model, &fit.values)) > data.expected_noise()
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
