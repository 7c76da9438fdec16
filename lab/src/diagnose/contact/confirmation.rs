//! Which of the effects that were found rows confirm that no fit saw, and the recordings tell from none.

use super::criteria::{
    COMPARISONS, LEAST_GAIN, LEAST_HELD_OUT_SHARE, LEAST_LINE_POWER, LEAST_TOLD_SHARE, NOISE_POWER_KNOWN_TO,
    NOTABLE_POWER,
};
use super::data::Data;
use super::fit::Fit;
use super::free_motion::left_by_height_and_law;
use super::held_out::{Folds, HeldOut, rms};
use super::interval::intervals;
use super::lines::line_beyond;
use super::model::index;
use super::rest::Rest;
use super::search::Search;
use super::wandering_zero::likelihood_beside_a_wandering_zero;
use super::worth::where_they_differ;
use crate::diagnose::evidence::{NamedTerm, share_beyond_noise};
use crate::diagnose::model_comparison::likelihood_ratio_p;
use crate::effects::ExcitationStats;

/// A law without one of its effects.
struct Without {
    law: Fit,
    /// What it leaves of unseen rows: weighted squares, and N or N m in root mean square.
    energy: f64,
    rms: f64,
    /// Share that the effect takes where the two laws differ, see [`share_where_they_differ`].
    local_share: f64,
}

/// The effects that unseen rows confirm, with what each takes of them.
pub(super) fn believed(search: &Search<'_>, folds: &Folds, mut fit: Fit) -> (Fit, HeldOut, Vec<NamedTerm>) {
    let data = &search.data;
    let expected = data.expected();
    loop {
        let held = folds.held_out(data, &fit);
        let first = search.nominal.model.terms.len();
        let correlated_rows = Rest::of(data, &fit).correlated_rows;
        let without: Vec<Without> = (first..fit.model.terms.len())
            .map(|at| {
                let law = search.without(&fit, at);
                let left = folds.held_out(data, &law);
                let local_share = share_where_they_differ(data, [&left, &held], correlated_rows);
                Without { law, energy: left.energy, rms: rms(data, &left.residual), local_share }
            })
            .collect();
        let share = |left: f64| share_taken(left, held.energy, expected);
        // A line is no part of what a law leaves.
        let is_confirmed = |without: &Without| match line_beyond(&fit, &without.law) {
            Some(_) => without.energy - held.energy > LEAST_LINE_POWER * expected,
            None => {
                share(without.energy).max(without.local_share) >= LEAST_HELD_OUT_SHARE
                    && (!is_within_rounding(data, without.rms)
                        || is_beneath_sensors(data, rms(data, &held.residual))
                        || acts_in_free_motion(data, &fit, &without.law))
            }
        };
        let needless = (0..without.len()).filter(|nth| !is_confirmed(&without[*nth]));
        if let Some(nth) = needless.min_by(|a, b| without[*a].energy.total_cmp(&without[*b].energy)) {
            fit = without[nth].law.clone();
            continue;
        }
        // Beside others alone: what stands for a mismatch by itself is told by the likelihood.
        let is_little = |nth: &usize| without.len() > 1 && share(without[*nth].energy) < LEAST_TOLD_SHARE;
        let mut little: Vec<usize> = (0..without.len()).filter(is_little).collect();
        little.sort_by(|a, b| without[*a].energy.total_cmp(&without[*b].energy));
        if let Some(nth) = undetermined(search, &fit, little.into_iter().map(|nth| first + nth)) {
            fit = without[nth - first].law.clone();
            continue;
        }
        if let Some(at) = unidentified(search, &fit, first) {
            fit = without[at - first].law.clone();
            continue;
        }
        if let Some(nth) = followed(data, &fit, &without) {
            fit = without[nth].law.clone();
            continue;
        }
        let named = without.iter().enumerate().map(|(nth, without)| NamedTerm {
            at: first + nth,
            held_out_share: share(without.energy).clamp(0.0, 1.0),
            p_value: (COMPARISONS * chance(search, &fit, &without.law)).min(1.0).shown(),
            without: without.rms,
        });
        let named = named.collect();
        return (fit, held, named);
    }
}

/// Probability that noise makes `more` as much likelier than `less`, and where that is by a line, that it is as loud as that.
fn chance(search: &Search<'_>, more: &Fit, less: &Fit) -> f64 {
    let of_line = search.chance_of_line(more, less);
    of_line.unwrap_or_else(|| likelihood_ratio_p(search.worth(more, less).gain, added_values(more, less)))
}

/// The effect that gains least over `without` it, beside a zero that wanders, where that is less than any is told for: what follows such a zero
/// alone gains nothing where rows are taken with the errors that they share.
fn followed(data: &Data<'_>, fit: &Fit, without: &[Without]) -> Option<usize> {
    let whole = likelihood_beside_a_wandering_zero(data, fit)?;
    let gains = without.iter().enumerate().filter_map(|(nth, without)| {
        let gain = whole - likelihood_beside_a_wandering_zero(data, &without.law)?;
        Some((nth, gain))
    });
    let (nth, gain) = gains.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (gain < LEAST_GAIN.value()).then_some(nth)
}

/// The first of the `terms` of `fit` with one size, of either sign, whose 95 % interval holds zero: beside the others the recordings do not
/// determine it (A. Wald, *Trans. Am. Math. Soc.* 54, 1943, 426), however much likelier it makes them. A size that is known by factors has an
/// interval that holds no zero, and several can be certain together where each for itself is not.
fn undetermined(search: &Search<'_>, fit: &Fit, terms: impl Iterator<Item = usize>) -> Option<usize> {
    let mut terms = terms.peekable();
    terms.peek()?;
    let sizes = Sizes::of(search, fit);
    terms.find(|at| sizes.of_term(*at).is_some_and(|[low, high]| low <= 0.0 && high >= 0.0))
}

/// The last term from `first` on with one size whose 95 % interval is all of the range that it is looked for in: the recordings do not show it
/// (practical non-identifiability: A. Raue et al., *Bioinformatics* 25, 2009, 1923), and other values stand for it.
fn unidentified(search: &Search<'_>, fit: &Fit, first: usize) -> Option<usize> {
    let mut terms = (first..fit.model.terms.len()).rev().peekable();
    terms.peek()?;
    let sizes = Sizes::of(search, fit);
    let ranges = fit.model.ranges(&fit.values);
    terms.find(|at| {
        let all = fit.model.size_of(*at, &sizes.excitation).map(|size| &ranges[size]);
        all.zip(sizes.of_term(*at)).is_some_and(|(range, [low, high])| low <= range.low && high >= range.high)
    })
}

/// The 95 % intervals of the values of a fit, and what its sizes are told by.
struct Sizes<'a> {
    fit: &'a Fit,
    ends: Vec<[f64; 2]>,
    excitation: ExcitationStats,
}

impl<'a> Sizes<'a> {
    fn of(search: &Search<'_>, fit: &'a Fit) -> Self {
        let data = &search.data;
        let ends = intervals(data, fit, &Rest::of(data, fit)).ends;
        let [stiffness, surface] = [index::STIFFNESS, index::SURFACE].map(|at| fit.values[at]);
        let excitation = fit.model.scales.excitation(data.trials, stiffness, surface, fit.model.bilateral);
        Self { fit, ends, excitation }
    }

    /// That of the size of term `at`, where it has one.
    fn of_term(&self, at: usize) -> Option<[f64; 2]> {
        self.fit.model.size_of(at, &self.excitation).map(|size| self.ends[size])
    }
}

/// Share of the mismatch that a law takes which brings what is `left` down to `held`, all weighted squares of unseen rows: of what is left beyond
/// those that the sensors are `expected` to leave, which is not known better than these are.
fn share_taken(left: f64, held: f64, expected: f64) -> f64 {
    share_beyond_noise(left, held, expected, NOISE_POWER_KNOWN_TO.value())
}

/// The share of [`share_taken`] on those rows alone in which the predictions of the two laws, the lesser first, differ ([`where_they_differ`]): what acts in a hundredth of
/// the time, as a pull at each release does, is there as large as it is. The predictions are of values that these rows did not give, so that their noise has no part
/// in which of them count.
fn share_where_they_differ(data: &Data<'_>, [left, held]: [&HeldOut; 2], correlated_rows: f64) -> f64 {
    let weights = data.weights.concat();
    let weighted = |law: &HeldOut| -> Vec<f64> {
        law.residual.iter().flatten().zip(&weights).map(|(residual, weight)| residual * weight).collect()
    };
    let (left, held, noise) = (weighted(left), weighted(held), data.noise.concat());
    let Some(rows) = where_they_differ(&left, &held, correlated_rows) else { return 0.0 };
    let sum = |power: &dyn Fn(usize) -> f64| rows.iter().map(|row| power(*row)).sum::<f64>();
    let expected = sum(&|row| noise[row] * weights[row].powi(2));
    share_taken(sum(&|row| left[row].powi(2)), sum(&|row| held[row].powi(2)), expected)
}

/// Whether a law that leaves `without`, N or N m in root mean square, leaves no more than the sensors do, where the encoder's rounding is most of their
/// noise: it repeats with the place, and any law of the place takes some of it.
fn is_within_rounding(data: &Data<'_>, without: f64) -> bool {
    data.is_limited_by_rounding() && without < data.most_noise()
}

/// Whether a law that leaves `held` of unseen rows, N or N m in root mean square, leaves notably less than the sensors are said to: then they leave no more
/// than that (the variance of unit weight a posteriori: E. M. Mikhail, *Observations and Least Squares*, 1976), and what is beyond it is no rounding.
fn is_beneath_sensors(data: &Data<'_>, held: f64) -> bool {
    NOTABLE_POWER * held.powi(2) < data.expected_noise().powi(2)
}

/// Whether `less` leaves notably more in the free motion before the surface of `more` than that does, over what is stated: there the encoder's rounding
/// makes no force.
fn acts_in_free_motion(data: &Data<'_>, more: &Fit, less: &Fit) -> bool {
    let left = |law: &Fit| {
        let residual = data.residuals(&law.model, &law.values);
        left_by_height_and_law(data.trials, more, &data.noise, &residual).map(|[_, by_law]| by_law)
    };
    left(less).zip(left(more)).is_some_and(|(less, more)| less > NOTABLE_POWER * more.max(1.0))
}

/// Values that are fitted in `more` and not in `less`.
fn added_values(more: &Fit, less: &Fit) -> usize {
    more.model.free_count().saturating_sub(less.model.free_count())
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::fit::Effort;
    use super::super::nominal::nominal_fit;
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;
    use crate::diagnose::term::Term;

    /// By hand, of a thousand squares that the sensors are expected to leave.
    #[test]
    fn a_law_takes_its_share_of_no_smaller_mismatch_than_the_noise_is_known_to() {
        // Of 500 beyond the noise it takes 400.
        assert!((share_taken(1500.0, 1100.0, 1000.0) - 0.8).abs() < 1e-12);
        // All of what is left beyond the noise, 20, is no tenth of the 320 to which that is known; nor is it where less is left than expected.
        assert!((share_taken(1020.0, 1000.0, 1000.0) - 20.0 / 320.0).abs() < 1e-12);
        assert!(share_taken(950.0, 930.0, 1000.0) < LEAST_HELD_OUT_SHARE.value());
        // More than that is a law's, however little is left.
        assert!((share_taken(1010.0, 610.0, 1000.0) - 1.0).abs() < 1e-12);
        assert_eq!(share_taken(1000.0, 1001.0, 1000.0), 0.0);
    }

    /// A surface that pulls with 32 mN and lets go after a quarter of a millimetre: in a hundredth of the time, of which it is most.
    #[test]
    fn what_acts_in_a_hundredth_of_the_time_is_told_by_its_size_there() {
        const SIZES: [f64; 2] = [0.032, 2.5e-4];
        let trials = [1, 2, 3, 4].map(|seed| TestContact::PLAIN.trial_under(seed, ("adhesion", 3, &SIZES)));
        let nominal = nominal_fit(&Data::new(&trials), &TestContact::nominal());
        let [data, coarse] = [(), ()].map(|()| Data::new(&trials).weighed(&nominal));
        // What belongs to a trial alone has a value in each.
        let start: Vec<f64> = nominal.values.iter().copied().chain(SIZES).collect();
        let fit = data.fit(
            &nominal.model.with(Term { effect: crate::effects::find("adhesion").unwrap(), form: 3 }),
            &start,
            Effort::FULL,
        );
        let search = Search { nominal: data.again(&nominal), data, coarse, circumstances: Circumstances::default() };
        let (_, _, named) = believed(&search, &Folds::of(&search.data), fit);
        assert_eq!(named.len(), 1);
        // On the whole it is too little to be told from noise that is known to a third.
        let share = named[0].held_out_share;
        assert!(share > 0.0 && share < LEAST_HELD_OUT_SHARE.value(), "{share}");
    }

    /// By hand: of sixty rows in which two laws differ, the one leaves four times the noise and the other the noise.
    #[test]
    fn the_share_where_laws_differ_is_that_of_rows_enough() {
        let trials = [TestContact::PLAIN.trial(1)];
        let data = Data::new(&trials);
        let rows = trials[0].len();
        let leaves = |differing: usize| {
            let residual = (0..rows).map(|row| if row < differing { 2.0 } else { 0.5 } * FORCE_NOISE).collect();
            HeldOut { residual: vec![residual], energy: 0.0 }
        };
        let share = |differing: usize, correlated_rows: f64| {
            let held = HeldOut { residual: vec![vec![0.9 * FORCE_NOISE; rows]], energy: 0.0 };
            share_where_they_differ(&data, [&leaves(differing), &held], correlated_rows)
        };
        // 4 - 0.81 of 4 - 1, which is less: all.
        assert!((share(60, 1.0) - 1.0).abs() < 1e-9);
        // So few say nothing, and those in which the laws say the same are none.
        assert_eq!([share(39, 1.0), share(60, 2.0), share(0, 1.0)], [0.0; 3]);
    }

    /// An encoder whose step is worth ten times the force sensor's noise: below what both leave, nothing is told from rounding.
    #[test]
    fn below_the_rounding_of_an_encoder_that_is_most_of_the_noise_nothing_is_told() {
        let trials = [TestContact::PLAIN.trial(1)];
        let plain = Data::new(&trials);
        assert!(!is_within_rounding(&plain, 0.5 * FORCE_NOISE));
        let rounded = Data { noise: vec![vec![(10.0 * FORCE_NOISE).powi(2); trials[0].len()]], ..plain };
        assert!(is_within_rounding(&rounded, 9.9 * FORCE_NOISE) && !is_within_rounding(&rounded, 10.1 * FORCE_NOISE));
        // A law that leaves three quarters of the power shows that the rounding leaves no more: 8.7 squared is 76 of 100.
        assert!(is_beneath_sensors(&rounded, 8.6 * FORCE_NOISE) && !is_beneath_sensors(&rounded, 8.8 * FORCE_NOISE));
    }

    /// A zero is off by one and a half of the noise, and a spring stiffens: rounding in contact can be the one and not the other.
    #[test]
    fn rounding_makes_no_force_where_nothing_is_touched() {
        let acts = |contact: TestContact, name: &str, form: usize, start: &[f64]| {
            let trials = [contact.trial(1)];
            let data = Data::new(&trials);
            let less = nominal_fit(&data, &TestContact::nominal());
            let model = less.model.with(Term { effect: crate::effects::find(name).unwrap(), form });
            let values: Vec<f64> = less.values.iter().chain(start).copied().collect();
            let more = data.fit(&model, &values, Effort::FULL);
            assert!(more.energy < 0.9 * less.energy, "{name}: {} of {}", more.energy, less.energy);
            acts_in_free_motion(&data, &more, &less)
        };
        assert!(acts(TestContact { zero: 1.5 * FORCE_NOISE, ..TestContact::PLAIN }, "force_bias", 0, &[0.01]));
        assert!(!acts(TestContact { exponent: 1.5, ..TestContact::PLAIN }, "nonlinear_stiffness", 0, &[1.4, 4e-3]));
    }

    /// A memory with a bias beside it that is there or is not.
    #[test]
    fn an_effect_whose_size_may_be_nothing_is_not_determined() {
        let undetermined_beside = |zero: f64| {
            let trials = [1, 2].map(|seed| TestContact { branch: 60.0, zero, ..TestContact::PLAIN }.trial(seed));
            let nominal = nominal_fit(&Data::new(&trials), &TestContact::nominal());
            let term = |name: &str| Term { effect: crate::effects::find(name).unwrap(), form: 0 };
            let model = nominal.model.with(term("stress_relaxation")).with(term("force_bias"));
            let start: Vec<f64> = nominal.values.iter().copied().chain([60.0, 0.4, 0.01]).collect();
            let [data, coarse] = [(), ()].map(|()| Data::new(&trials).weighed(&nominal));
            let fit = data.fit(&model, &start, Effort::FULL);
            let search =
                Search { nominal: data.again(&nominal), data, coarse, circumstances: Circumstances::default() };
            undetermined(&search, &fit, 0..2)
        };
        assert_eq!([0.0, 0.4].map(undetermined_beside), [Some(1), None]);
    }

    /// A stiffness that settles, on a contact as stiff as it is, and on one that is all but gone, where any part of it is as good as none.
    #[test]
    fn an_effect_whose_size_may_be_anything_is_not_shown() {
        let trials = [1, 2].map(|seed| TestContact::PLAIN.trial(seed));
        let [data, coarse] = [(), ()].map(|()| Data::new(&trials));
        let nominal = nominal_fit(&data, &TestContact::nominal());
        let settles = Term { effect: crate::effects::find("time_varying_stiffness").unwrap(), form: 4 };
        let search = Search { nominal: nominal.clone(), data, coarse, circumstances: Circumstances::default() };
        let model = nominal.model.with(settles);
        let of_stiffness = |stiffness: f64| {
            let mut values: Vec<f64> = nominal.values.iter().copied().chain([0.1, 3.0]).collect();
            values[index::STIFFNESS] = stiffness;
            let energy = crate::diagnose::linalg::energy(&search.data.weighted_residual(&model, &values));
            unidentified(&search, &Fit { model: model.clone(), values, energy }, 0)
        };
        assert_eq!([300.0, 1e-9].map(of_stiffness), [None, Some(0)]);
    }
}
