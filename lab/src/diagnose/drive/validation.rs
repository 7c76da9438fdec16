//! Which terms stand: those that rows confirm which their values were not fitted to (cross-validation), whose gain is more than what
//! innovations that remember would give to a term that is not there, and whose values the recordings determine.

use super::candidates::simpler;
use super::criteria::{COMPARISONS, LEAST_GAIN, LEAST_GAIN_PER_VALUE, LEAST_HELD_OUT_SHARE, LEAST_PART_OF_EFFORT};
use super::fit::Fit;
use super::held_out::{Folds, HeldOut, rms};
use super::interval::{Uncertainty, intervals};
use super::levenberg_marquardt::search_values;
use super::likelihood::Data;
use super::noise::Noise;
use super::nominal::deviation;
use super::selection::Search;
use super::term::Term;
use super::worth::share_taken;
use crate::diagnose::evidence::NamedTerm;
use crate::diagnose::model_comparison::likelihood_ratio_p;

/// Steps of the search of a smaller law's values by the larger one's noise, from the likeliest by its own.
const STEPS: usize = 5;

/// A fit of which every term stands.
pub struct Validated {
    /// The fit.
    pub fit: Fit,
    /// What it leaves of unseen rows.
    pub held_out: HeldOut,
    /// Its terms that are told, with what each takes of them.
    pub named: Vec<NamedTerm>,
    /// How far its values can be trusted.
    pub uncertainty: Uncertainty,
}

/// `fit` without the terms that do not stand.
#[must_use]
pub fn validated(search: &Search<'_>, folds: &Folds, common: &Noise, mut fit: Fit) -> Validated {
    // With a load that is given, whose model is known no better than that.
    let effort = search.data.trials.iter().map(|trial| deviation(&trial.effort)).fold(0.0, f64::max);
    loop {
        let held = folds.held_out(&search.data, &fit, common);
        let first = search.nominal.model.terms.len();
        let told: Vec<usize> = (first..fit.model.terms.len()).filter(|at| fit.model.terms[*at].is_told()).collect();
        let without: Vec<(Fit, HeldOut)> = told
            .iter()
            .map(|&at| {
                let less = without(search, &fit, at);
                let left = folds.held_out(&search.data, &less, common);
                (less, left)
            })
            .collect();
        let share = |(less, left): &(Fit, HeldOut)| {
            let left = less.force_beside(&fit).powi(2) * left.density;
            share_taken(left, held.density, search.effort_noise_density)
        };
        // Sub-linear friction is what dry friction leaves: the latter cannot go before it.
        let carries = |term: &Term| {
            matches!(term, Term::Coulomb | Term::AsymmetricCoulomb | Term::Stribeck)
                && fit.model.has("sublinear_friction")
        };
        let takes_little = |nth: usize| {
            let ((less, left), term) = (&without[nth], &fit.model.terms[told[nth]]);
            let forces = [less.force_beside(&fit) * rms(&left.missing), rms(&held.missing)];
            share(&without[nth]) < LEAST_HELD_OUT_SHARE && !carries(term)
                || term.is_link() && is_next_to_nothing(forces, effort)
        };
        let needless =
            (0..without.len()).filter(|nth| !without[*nth].0.loses_inertia_of(&fit)).filter(|nth| takes_little(*nth));
        if let Some(nth) = needless.min_by(|a, b| without[*a].1.density.total_cmp(&without[*b].1.density)) {
            fit = without[nth].0.clone();
            continue;
        }
        let uncertainty = intervals(&search.data, &fit);
        let gain = |less: &Fit| fit.log_likelihood - likelihood_by_noise_of(&search.data, less, &fit);
        let comparisons: Vec<RobustRatio> = without
            .iter()
            .zip(&told)
            .map(|((less, _), at)| RobustRatio::of(&fit, less, gain(less), *at, &uncertainty))
            .collect();
        let is_undetermined = |at: usize| {
            let (term, own) = (&fit.model.terms[at], fit.model.values_of(at));
            term.is_undetermined(&uncertainty.ends[own.clone()], &search.scales)
                || term.is_at_end(&fit.values[own], &search.scales)
        };
        let weakest = (0..told.len())
            .filter(|nth| !comparisons[*nth].is_decisive() || is_undetermined(told[*nth]))
            .filter(|nth| !carries(&fit.model.terms[told[*nth]]))
            .min_by(|a, b| comparisons[*a].gain.total_cmp(&comparisons[*b].gain));
        if let Some(nth) = weakest {
            fit = if comparisons[nth].is_decisive() {
                determined(search, &fit, told[nth])
            } else {
                without[nth].0.clone()
            };
            continue;
        }
        let named = without.iter().zip(&comparisons).enumerate().map(|(nth, (without, ratio))| NamedTerm {
            at: told[nth],
            held_out_share: share(without).clamp(0.0, 1.0),
            p_value: (COMPARISONS * ratio.p_value()).min(1.0).shown(),
            without: without.0.force_beside(&fit) * rms(&without.1.missing),
        });
        let named = named.collect();
        return Validated { fit, held_out: held, named, uncertainty };
    }
}

/// Whether of the force that is `left` without a term next to none is gone with it, both root mean squares, beside the `effort`. A link that follows what the encoder
/// shows row by row takes all of the density of a disturbance, and nothing that moves the drive.
fn is_next_to_nothing([left, held]: [f64; 2], effort: f64) -> bool {
    (left * left - held * held).max(0.0).sqrt() < LEAST_PART_OF_EFFORT * effort
}

/// `fit` without term `at`, refitted; terms that cannot stand without it go with it.
fn without(search: &Search<'_>, fit: &Fit, at: usize) -> Fit {
    let (model, values) = fit.model.without(at, &fit.values);
    search.lessened(fit, model, values)
}

/// `fit` with the simpler law in the place of term `at`, whose values the recordings do not determine, refitted; without it, where none is simpler.
fn determined(search: &Search<'_>, fit: &Fit, at: usize) -> Fit {
    match simpler(fit, at).into_iter().next() {
        Some((model, values)) => search.lessened(fit, model, values),
        None => without(search, fit, at),
    }
}

/// Log likelihood of `less`, its values refitted, by the noise of `more`, nats: the dispersion of a quasi-likelihood is the larger law's (R. W. M.
/// Wedderburn, *Biometrika* 61, 1974, 439; P. McCullagh, *Ann. Stat.* 11, 1983, 59). With noise of its own a law that leaves a hundred times
/// as much is less likely by the logarithm of that alone, however many rows say so.
fn likelihood_by_noise_of(data: &Data<'_>, less: &Fit, more: &Fit) -> f64 {
    let mut values = less.values.clone();
    search_values(data, &less.model, &mut values, &more.noise, STEPS);
    data.log_likelihood(&less.model, &values, &more.noise).0.min(less.log_likelihood)
}

/// Likelihood ratio of a fit with a term and one without it, where innovations remember: its distribution under the smaller law is that of a
/// weighted sum of chi-squares, whose weights are the eigenvalues of the values' covariance over that by the curvature, and divided by their
/// mean it is compared with a chi-square as usual (A. Rotnitzky, N. P. Jewell, *Biometrika* 77, 1990, 485). Of the weights the diagonal is taken.
struct RobustRatio {
    /// Gain of log likelihood over that mean, nats.
    gain: f64,
    /// How many values the larger fit has more.
    values: usize,
}

impl RobustRatio {
    /// That of `more`, with term `at`, and `less` without it, over which it gains `gain` nats.
    fn of(more: &Fit, less: &Fit, gain: f64, at: usize, uncertainty: &Uncertainty) -> Self {
        let own = &uncertainty.inflations[more.model.values_of(at)];
        let mean = own.iter().sum::<f64>() / own.len().max(1) as f64;
        let values = more.values.len().saturating_sub(less.values.len());
        Self { gain: gain / mean, values }
    }

    /// Whether it asks for the term.
    fn is_decisive(&self) -> bool {
        self.gain > LEAST_GAIN + (LEAST_GAIN_PER_VALUE * self.values.max(1) as f64).value()
    }

    fn p_value(&self) -> f64 {
        likelihood_ratio_p(self.gain, self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::super::levenberg_marquardt::Ended;
    use super::super::model::Model;
    use super::super::term::Term;
    use super::super::testing::{SCALES, TestDrive, search_over, with_dry_friction};
    use super::*;

    /// By hand: of 5 mN there are 3 mN gone where 4 mN are left, a thousandth of an effort of 3 N and a hundredth of 0.3 N.
    #[test]
    fn what_is_gone_is_told_beside_the_effort() {
        assert!(is_next_to_nothing([5e-3, 4e-3], 3.0) && is_next_to_nothing([5e-3, 4e-3], 1.001));
        assert!(!is_next_to_nothing([5e-3, 4e-3], 0.999) && !is_next_to_nothing([5e-3, 4e-3], 0.3));
        // What leaves more takes nothing.
        assert!(is_next_to_nothing([4e-3, 5e-3], 1e-3));
    }

    /// Dry friction of 0.4 N leaves a law without it so much that by its own noise it is less likely by the logarithm of that alone; by the noise of
    /// the larger law by all that it leaves. Friction that is not there is worth the same by both.
    #[test]
    fn a_law_that_leaves_far_more_is_judged_by_the_noise_of_the_one_that_does_not() {
        let gains = |coulomb: f64| {
            let drive = TestDrive { coulomb, ..TestDrive::PLAIN };
            let trials = [drive.trial(6.0, 6)];
            let search = search_over(&trials, &drive);
            let rubs = with_dry_friction(&search);
            let own = rubs.log_likelihood - search.nominal.log_likelihood;
            (own, rubs.log_likelihood - likelihood_by_noise_of(&search.data, &search.nominal, &rubs))
        };
        let (own, by_noise) = gains(0.4);
        assert!(own > 100.0 && by_noise > 10.0 * own, "{own} {by_noise}");
        // Of nothing the maxima of both likelihoods differ by less than a nat.
        let (own, by_noise) = gains(0.0);
        assert!((by_noise - own).abs() < 1.0, "{own} {by_noise}");
    }

    /// Dry friction of 0.3 N and no more: an exponent that may be any does not take it along.
    #[test]
    fn in_the_place_of_a_law_that_is_not_determined_a_simpler_one_stands() {
        let drive = TestDrive { coulomb: 0.3, ..TestDrive::PLAIN };
        let trials = [drive.trial(4.0, 6)];
        let search = search_over(&trials, &drive);
        let sublinear = Fit {
            model: search.nominal.model.with(Term::Sublinear),
            values: [search.nominal.values.as_slice(), &[0.3, 0.2]].concat(),
            ..search.nominal.clone()
        };
        assert_eq!(determined(&search, &sublinear, 0).model.terms, [Term::Coulomb]);
        let rubs = with_dry_friction(&search);
        assert_eq!(determined(&search, &rubs, 0).model.terms, []);
    }

    /// Forty nats for one value, where twenty rows say the same and where each says its own: two nats are chance.
    #[test]
    fn a_gain_that_rows_repeat_is_counted_once() {
        let fit = |terms: Vec<Term>, values: Vec<f64>, log_likelihood: f64| Fit {
            model: Model { terms, scales: SCALES },
            values,
            noise: Noise { ln_disturbance: 0.0, ln_encoder: 0.0 },
            log_likelihood,
            ended: Ended::Converged,
        };
        let less = fit(vec![], vec![0.8, 4.0, 0.0, 0.0], 100.0);
        let more = fit(vec![Term::Coulomb], vec![0.8, 4.0, 0.0, 0.0, 0.1], 140.0);
        let ratio = |inflation: f64| {
            let inflations = vec![1.0, 1.0, 1.0, 1.0, inflation];
            RobustRatio::of(
                &more,
                &less,
                40.0,
                0,
                &Uncertainty { ends: Vec::new(), covariance: Vec::new(), inflations },
            )
        };
        assert!(ratio(1.0).is_decisive() && ratio(1.0).p_value() < 1e-15);
        assert!(!ratio(20.0).is_decisive());
        // Twice two nats under a chi-square of one degree: two deviations, 0.0455.
        assert!((ratio(20.0).p_value() - 0.0455).abs() < 1e-4, "{}", ratio(20.0).p_value());
    }
}
