//! Whether a force that can be anything along one quantity does much better than the law that was found: then that is not all of it.

use super::candidates::is_likelier;
use super::criteria::{CURVE_PART, LEAST_PART_OF_EFFORT, MOST_LEFT, NOISE_POWER_KNOWN_TO, OVER_NOISE};
use super::fit::Fit;
use super::held_out::rms;
use super::selection::Search;
use super::shapes::{courses, load_by_place, shaped};
use super::term::Term;
use super::tone::loudest_tone;

/// A force in root mean square before and after something takes a part of it, N or N m.
type Lessened = [f64; 2];

/// Whether a force that has a shape, but no law, takes half of the power that the nominal law leaves, and more than a negligible part of the effort: a
/// mismatch that is there, however little it is beside the effort. `missing` is what that law leaves, a column a trial.
#[must_use]
pub fn has_a_shape(search: &Search<'_>, missing: &[Vec<f64>]) -> bool {
    let nominal = &search.nominal;
    let takes_half = |[left, after]: Lessened| {
        let taken = left * left - after * after;
        taken > after * after && taken.sqrt() > LEAST_PART_OF_EFFORT * search.scales.effort
    };
    leaves_much(search, nominal)
        && (takes_half(by_a_tone(missing))
            || takes_half(by(search, nominal, load_by_place(&search.scales)))
            || courses(&search.scales, &nominal.model).any(|course| takes_half(by(search, nominal, course))))
}

/// Whether a shape of no law does much better than the names of `fit`, which leave the force `missing`, a column a trial: a load by position or a
/// tone, where that is more than the sensors' `noise` is known to, or friction, or an effort, that changes with time, place or velocity, where that is
/// notable. Then they are not all of it.
#[must_use]
pub fn a_shape_does_better(search: &Search<'_>, fit: &Fit, missing: &[Vec<f64>], noise: f64) -> bool {
    let doubts = |[left, after]: Lessened| is_notable(left, after, noise) && is_halved(left, after, noise);
    let doubts_what_is_there = |[left, after]: Lessened| {
        (is_beyond(left, noise) || is_notable(left, after, noise)) && is_halved(left, after, noise)
    };
    let by_place = || by(search, fit, load_by_place(&search.scales));
    let is_there = is_beyond(rms(missing), noise);
    leaves_much(search, fit)
        && (is_there && (doubts_what_is_there(by_a_tone(missing)) || doubts_what_is_there(by_place()))
            || courses(&search.scales, &fit.model).any(|course| doubts(by(search, fit, course))))
}

/// Whether `fit`, of a rigid drive, leaves so much of what the nominal law lacks, and of the effort, that its names are doubted.
fn leaves_much(search: &Search<'_>, fit: &Fit) -> bool {
    let left = search.unexplained(fit);
    !fit.model.has_link()
        && left > MOST_LEFT * 0.5 * search.unexplained(&search.nominal)
        && left > LEAST_PART_OF_EFFORT * search.scales.effort
}

/// What `term` of no law takes of what `fit` leaves unexplained; nothing where it is not likelier.
fn by(search: &Search<'_>, fit: &Fit, term: Term) -> Lessened {
    let better = search.polished(&shaped(fit, term));
    let left = search.unexplained(fit);
    [left, if is_likelier(&better, fit) { search.unexplained(&better) } else { left }]
}

/// What a single tone in time, of no law of a motion, takes of the force `missing`, a column a trial.
fn by_a_tone(missing: &[Vec<f64>]) -> Lessened {
    let left = rms(missing);
    [left, (left * left - loudest_tone(missing).power).max(0.0).sqrt()]
}

/// Whether of `left` beyond `noise` half is gone in what is left `after`, all root mean squares: no term takes that noise. It is no more than what
/// any law leaves.
fn is_halved(left: f64, after: f64, noise: f64) -> bool {
    let noise = noise.min(after);
    let beyond = |all: f64| (all * all - noise * noise).sqrt();
    beyond(after) < CURVE_PART * beyond(left)
}

/// Whether there is notably more `left` than `noise`, which is no more than what is left `after`.
fn is_notable(left: f64, after: f64, noise: f64) -> bool {
    left > OVER_NOISE * noise.min(after)
}

/// Whether a force `left` is more than the sensors' `noise`, both root mean squares, whose power is known to [`NOISE_POWER_KNOWN_TO`].
#[must_use]
pub fn is_beyond(left: f64, noise: f64) -> bool {
    left * left > (1.0 + NOISE_POWER_KNOWN_TO.value()) * noise * noise
}

#[cfg(test)]
mod tests {
    use super::super::criteria::UNKNOWN_PART_OF_EFFORT;
    use super::super::identification::identify;
    use super::super::testing::{TestDrive, nominal};
    use super::{is_beyond, is_halved, is_notable, rms};
    use crate::diagnose::verdict::Verdict;

    /// Less than the part of the effort from which a white force is unknown, and half of what is left: a force with a shape is there.
    #[test]
    fn a_friction_that_warms_up_and_a_tone_are_unknown_however_little_of_the_effort() {
        let rig = nominal(0.8, 4.0);
        for drive in [
            TestDrive { cold: 0.06, encoder: 1e-6, ..TestDrive::PLAIN },
            TestDrive { tone: 0.012, encoder: 1e-6, ..TestDrive::PLAIN },
        ] {
            let trials = vec![drive.trial(6.0, 57), drive.trial(6.0, 58)];
            let outcome = identify(trials, &rig, 1, &|_| {}).expect("a drive that moves");
            assert_eq!((outcome.verdict, outcome.named.len()), (Verdict::Unknown, 0), "{} {}", drive.cold, drive.tone);
            let part = rms(&outcome.missing[1]) / outcome.chosen.model.scales.effort;
            assert!(part < UNKNOWN_PART_OF_EFFORT.value(), "{part} {}", drive.cold);
        }
    }

    /// By hand: of 5 beside a noise of 3 there are 4, of which 2 are left where all is sqrt(13) = 3.606.
    #[test]
    fn what_is_halved_is_counted_beyond_the_noise() {
        assert!(is_halved(5.0, 3.6, 3.0) && !is_halved(5.0, 3.61, 3.0));
        // A law that leaves less than the noise shows that the noise is less: five thirds of what it leaves are notable, 1.4 times are not.
        assert!(is_notable(5.0, 3.0, 4.0) && !is_notable(4.2, 3.0, 4.0));
        // A noise is known to a fifth.
        assert!(is_beyond(3.61, 3.0) && !is_beyond(3.59, 3.0) && !is_beyond(f64::NAN, 3.0));
        assert!(!is_halved(f64::NAN, 3.0, 3.0) && !is_halved(5.0, f64::NAN, 3.0));
    }
}
