//! What the reports of contact and drive have in common.

use super::diagnosis::{Alternative, Evidence, FitQuality, Physics, Value};
use crate::diagnose::experiment;
use crate::diagnose::term::Term;
use crate::effects::{self, Effect};
use crate::rig::Coordinate;

/// Root mean squares of a channel's residual on rows that no fit saw.
#[derive(Debug, Clone, Copy)]
pub(super) struct Residuals {
    /// By the rig file as given, by refitted values, and with the named effects.
    pub(super) of_laws: [f64; 3],
    /// What the sensors leave.
    pub(super) expected_noise: f64,
}

impl Residuals {
    /// Share of the power above the noise that refitted values leave, which a law that leaves `left` takes away: the one measure of the answer and of
    /// whatever is compared with it. From 0 to 1; 0 where refitted values leave no more than noise. The noise is what is expected, and no more than the
    /// answer leaves: of rows that no fit saw no law takes noise away.
    pub(super) fn share_taken(&self, left: f64) -> f64 {
        let [_, refitted, improved] = self.of_laws;
        let noise = self.expected_noise.min(improved);
        let above = refitted.powi(2) - noise.powi(2);
        if above > 0.0 { ((refitted.powi(2) - left.powi(2)) / above).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Share of the power above the expected noise that a law leaves without an effect, root mean square `without`, which the effect takes.
    pub(super) fn share_of(&self, without: f64, left: f64) -> f64 {
        let of_laws = [self.of_laws[0], without, left];
        Self { of_laws, ..*self }.share_taken(left)
    }

    /// Evidence of a named effect, one of `named`: alone it takes what the answer takes.
    pub(super) fn evidence(&self, named: usize, without: f64, p_value: f64) -> Evidence {
        let [_, refitted, improved] = self.of_laws;
        let without = if named == 1 { refitted } else { without };
        Evidence { held_out_gain: self.share_of(without, improved), p_value }
    }

    /// As the page and the JSON show them.
    pub(super) fn quality(&self, channel: &'static str, unit: &'static str, band_hz: f64) -> FitQuality {
        let [as_given, refitted, improved] = self.of_laws;
        FitQuality {
            channel,
            unit,
            noise_floor: self.expected_noise,
            as_given,
            refitted,
            improved,
            learned: None,
            held_out: true,
            explained_share: self.share_taken(improved),
            band_hz,
        }
    }
}

/// Width of an interval over its value from which it bounds nothing: no parameter of a rig is open over six decades.
const OPEN_WIDTH: f64 = 1e6;

/// The ends of a 95 % interval as they are told: infinite where it bounds nothing.
pub(super) fn told(value: f64, [low, high]: [f64; 2]) -> [f64; 2] {
    let is_open = value != 0.0 && high - low > OPEN_WIDTH * value.abs();
    if is_open { [f64::NEG_INFINITY, f64::INFINITY] } else { [low, high] }
}

/// The same of all values of a fit.
pub(super) fn all_told(values: &[f64], intervals: &[[f64; 2]]) -> Vec<[f64; 2]> {
    values.iter().zip(intervals).map(|(value, ends)| told(*value, *ends)).collect()
}

/// The parameters of a law with their values and 95 % intervals.
pub(super) fn parameters(
    effect: &dyn Effect,
    form: usize,
    coordinate: Coordinate,
    values: &[f64],
    intervals: &[[f64; 2]],
) -> Vec<Value> {
    let each = effect.spec().forms[form].parameters.iter().zip(values).zip(intervals);
    each.map(|((parameter, value), ends)| Value {
        name: parameter.name.to_owned(),
        value: *value,
        unit: coordinate.pick(parameter.unit).to_owned(),
        ci95: told(*value, *ends),
    })
    .collect()
}

/// `named` in order of evidence, and `rest`, what is reported as unknown, after them.
pub(super) fn in_order(mut named: Vec<Physics>, rest: Option<Physics>) -> Vec<Physics> {
    named.sort_by(|a, b| b.evidence.held_out_gain.total_cmp(&a.evidence.held_out_gain));
    named.extend(rest);
    named
}

/// A set of effects `names` that the recordings of `channel` do not tell from `answer`; `otherwise` is the advice where the list knows none.
pub(super) fn alternative(
    channel: &'static str,
    answer: &[&str],
    names: &[&str],
    held_out_gain: f64,
    otherwise: &str,
) -> Alternative {
    // What is new in the alternative comes first: it is what a reader has to weigh.
    let (shared, new): (Vec<&str>, Vec<&str>) = names.iter().partition(|name| answer.contains(name));
    let gone = answer.iter().find(|name| !names.contains(name));
    let law = |name: &&str| Some(Term { effect: effects::find(name)?, form: 0 });
    let separated_by = match (gone.and_then(law), new.first().and_then(law)) {
        (Some(gone), Some(new)) => experiment::separated_by(&gone, &new),
        (None, Some(new)) => {
            let beside = shared.iter().filter_map(law).find_map(|stays| experiment::shown_beside(&stays, &new));
            beside.unwrap_or(otherwise).to_owned()
        }
        _ => otherwise.to_owned(),
    };
    let physics = new.into_iter().chain(shared).map(str::to_owned).collect();
    Alternative { physics, channel, held_out_gain, separated_by }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_of_twenty_decades_is_open() {
        assert_eq!(told(9.4e-9, [0.0, 4.9e13]), [f64::NEG_INFINITY, f64::INFINITY]);
        assert_eq!(told(-0.02, [-0.2, 0.16]), [-0.2, 0.16]);
        assert_eq!(told(0.0, [-1.0, 1.0]), [-1.0, 1.0]);
    }

    /// Friction of two levels, and friction beside a weight, are one force in any motion.
    #[test]
    fn friction_beside_a_weight_is_told_by_turning_the_machine_over() {
        let advice =
            |answer: &[&str], names: &[&str]| alternative("effort", answer, names, 0.9, "more rows").separated_by;
        let both = advice(&["coulomb_friction"], &["coulomb_friction", "gravity_load"]);
        assert!(both.contains("turned over"), "{both}");
        assert_eq!(advice(&["coulomb_friction"], &["coulomb_friction", "cogging"]), "more rows");
    }

    #[test]
    fn one_measure_serves_the_answer_and_what_is_compared_with_it() {
        let residuals = Residuals { of_laws: [7.0, 5.0, 3.5], expected_noise: 3.0 };
        // (25 - 12.25) / (25 - 9)
        assert_eq!(residuals.quality("force", "N", 1.0).explained_share, 0.796_875);
        assert_eq!(residuals.share_taken(3.5), 0.796_875);
        assert_eq!((residuals.share_taken(6.0), residuals.share_taken(1.0)), (0.0, 1.0));
        assert_eq!(Residuals { of_laws: [7.0, 5.0, 5.0], expected_noise: 5.0 }.share_taken(3.0), 0.0);
        // More noise is expected than the answer leaves: there was no more than that, and the answer takes all the rest.
        let louder = Residuals { expected_noise: 6.0, ..residuals };
        assert_eq!((louder.share_taken(3.5), louder.share_of(4.0, 3.5)), (1.0, 1.0));
    }
}
