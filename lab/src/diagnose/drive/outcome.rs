//! What the recordings say of a drive: the law, its evidence, what else would do, and what is left.

use super::candidates::is_likelier;
use super::criteria::{
    COMPARISONS, CURVE_PART, LEAST_GAIN, LEAST_PART_OF_EFFORT, LEAST_THROUGHOUT, MOST_LEFT, UNKNOWN_PART_OF_EFFORT,
};
use super::expected_noise::{effort_noise, expected_noise};
use super::fit::{Data, Fit};
use super::held_out::{Folds, HeldOut, missing_forces, rms};
use super::interval::intervals;
use super::law::{Along, DriveLaw, Side};
use super::model::index;
use super::noise::Noise;
use super::nominal::{
    LOWEST_BAND_HZ, NominalDrive, encoder_variance, missing_under, nominal_fit, punctual_and_lagged, scales,
};
use super::outside_force::{Stretch, outside_forces};
use super::selection::{Chosen, Search};
use super::term::Term;
use super::trial::DriveTrial;
use crate::diagnose::evidence::NamedTerm;
use crate::diagnose::model_comparison::likelihood_ratio_p;
use crate::diagnose::verdict::Verdict;

/// A set of terms that the recordings do not tell from the answer.
#[derive(Debug, Clone)]
pub struct Alternative {
    /// Its terms.
    pub names: Vec<&'static str>,
    /// Share of the held-out mismatch that it takes.
    pub held_out_share: f64,
    /// What it leaves, N or N m in root mean square on held-out rows.
    pub left: f64,
}

/// Everything found of a drive.
pub struct Outcome {
    /// The trials, as they were looked at.
    pub trials: Vec<DriveTrial>,
    /// How it stands.
    pub verdict: Verdict,
    /// The refitted nominal law.
    pub nominal: Fit,
    /// The law with its terms.
    pub chosen: Fit,
    /// 95 % interval of each of its values.
    pub intervals: Vec<[f64; 2]>,
    /// Covariance of the values by the curvature of the fit; zero for those that were not fitted, empty where it is not known.
    pub covariance: Vec<Vec<f64>>,
    /// The terms that are named.
    pub named: Vec<NamedTerm>,
    /// What else would do.
    pub alternatives: Vec<Alternative>,
    /// Missing force by the rig file as given, by refitted values, and with the named terms, a column a trial.
    pub missing: [Vec<Vec<f64>>; 3],
    /// What the sensors alone would show as missing force, N or N m in root mean square.
    pub expected_noise: f64,
    /// Up to which frequency the missing force is seen, Hz.
    pub band_hz: f64,
    /// Stretches in which something from outside pushes, left out of everything else.
    pub outside_forces: Vec<Stretch>,
}

impl Outcome {
    /// Takes the names off the drive's list that the contact tells already; where none is left, nothing is missing in the drive.
    pub fn leave_to_the_contact(&mut self, is_told: impl Fn(&str) -> bool) {
        let model = &self.chosen.model;
        self.named.retain(|term| !is_told(model.terms[term.at].name()));
        if self.named.is_empty() && self.verdict == Verdict::Explained {
            self.verdict = Verdict::Parameters;
        }
    }
}

/// Identifies the drive of `trials`; `None` where they show no motion or are too short. Where no law does and a force from outside comes
/// and goes, the law of the rest is looked for.
#[must_use]
pub fn identify(trials: Vec<DriveTrial>, rig: &NominalDrive, seed: u64, say: &dyn Fn(&str)) -> Option<Outcome> {
    let first = identify_as_they_are(trials, rig, seed, say)?;
    if !matches!(first.verdict, Verdict::Unknown | Verdict::PartlyExplained) {
        return Some(first);
    }
    let law = DriveLaw::nominal(rig.inertia, rig.viscous, first.chosen.values[index::DELAY]);
    let missing = missing_under(&first.trials, rig)?;
    let stretches = outside_forces(&first.trials, &missing, &law, &first.chosen.model.scales);
    if stretches.is_empty() {
        return Some(first);
    }
    say("the drive: without the stretches in which something else pushes");
    let quiet = first.trials.iter().enumerate().map(|(number, trial)| {
        let own = stretches.iter().filter(|stretch| stretch.trial == number);
        trial.without(&own.map(|stretch| [stretch.start_s, stretch.end_s]).collect::<Vec<_>>())
    });
    match identify_as_they_are(quiet.collect(), rig, seed, say) {
        Some(second) if !second.named.is_empty() => {
            Some(Outcome { verdict: Verdict::PartlyExplained, outside_forces: stretches, ..second })
        }
        _ => Some(first),
    }
}

/// ln of the likelihood of `trials` under the refitted nominal law, nats; `None` where they show no motion.
#[must_use]
pub fn nominal_likelihood(trials: &[DriveTrial], rig: &NominalDrive) -> Option<f64> {
    let scales = scales(trials, rig)?;
    let variance = encoder_variance(trials, &scales);
    let data = Data { trials, least_encoder_variance: 0.3 * variance };
    Some(nominal_fit(&data, rig, scales, variance)?.log_likelihood)
}

fn identify_as_they_are(trials: Vec<DriveTrial>, rig: &NominalDrive, seed: u64, say: &dyn Fn(&str)) -> Option<Outcome> {
    let scales = scales(&trials, rig)?;
    let encoder_variance = encoder_variance(&trials, &scales);
    let data = Data { trials: &trials, least_encoder_variance: 0.3 * encoder_variance };
    say("the drive: nominal values");
    let nominal = nominal_fit(&data, rig, scales, encoder_variance)?;
    // A recording may be late by some rows. Where a lag of the drive is worth its value beside a punctual recording, it is the lag.
    let lag = punctual_and_lagged(&data, rig, &nominal, encoder_variance).and_then(|[punctual, lagged]| {
        // It was found already: however little of the effort it is, it is looked for.
        let search = Search { is_asked: true, ..search_from(data, rig, punctual) };
        search.is_worth(&lagged, &search.nominal).then_some(search)
    });
    let search = lag.unwrap_or_else(|| search_from(data, rig, nominal));
    let chosen = search.run(say);
    say("the drive: what is left");
    let mut outcome = judged(&search, chosen, seed);
    outcome.trials.clone_from(&trials);
    Some(outcome)
}

fn search_from<'a>(data: Data<'a>, rig: &NominalDrive, nominal: Fit) -> Search<'a> {
    let scales = nominal.model.scales;
    let crossing = nominal.noise.crossing_hz(scales.period_s, nominal.values[index::INERTIA]);
    let band_hz = crossing.clamp(LOWEST_BAND_HZ.min(0.1 / scales.period_s), 0.4 / scales.period_s);
    let sides = rig.encoder.map_or(vec![Side::Motor, Side::Load], |side| vec![side]);
    Search { data, scales, nominal, band_hz, sides, is_asked: false }
}

/// Share of the held-out power that a named term has to take, beside the others: half of what the search asks on its own rows.
const LEAST_HELD_OUT_SHARE: f64 = 0.12;

fn judged(search: &Search<'_>, chosen: Chosen, seed: u64) -> Outcome {
    let data = &search.data;
    let folds = Folds::of(data.trials);
    let common = search.nominal.noise.with_crossing(
        search.band_hz,
        search.scales.period_s,
        search.nominal.values[index::INERTIA],
    );
    let given = missing_forces(data, &as_given(search), &common);
    let refitted = folds.held_out(data, &search.nominal, &common);
    let (fit, improved, named) = believed(search, &folds, &common, chosen.fit.clone());
    let expected_noise = expected_noise(data, &fit, &common, seed);
    let spread = intervals(data, &fit);
    let recorded_noise = expected_noise.hypot(effort_noise(data, &fit, &common, seed));
    let verdict = verdict(search, &fit, [rms(&given), rms(&refitted.missing), rms(&improved.missing)], recorded_noise);
    let alternatives = alternatives(search, &folds, &common, &fit, &chosen, &refitted);
    Outcome {
        trials: Vec::new(),
        verdict,
        intervals: spread.ends,
        covariance: spread.covariance,
        named,
        alternatives,
        missing: [given, refitted.missing, improved.missing],
        expected_noise,
        band_hz: search.band_hz,
        nominal: search.nominal.clone(),
        outside_forces: Vec::new(),
        chosen: fit,
    }
}

/// The rig file's values with the effort's delay as it was found: nobody states a part of a row.
fn as_given(search: &Search<'_>) -> Fit {
    let mut given = search.nominal.clone();
    given.values[index::INERTIA] = search.scales.inertia;
    given.values[index::VISCOUS] = search.scales.viscous;
    if let Some(at) = given.model.load_scale() {
        given.values[at] = 1.0;
    }
    given
}

/// The terms that unseen rows confirm, with what each takes of them.
fn believed(search: &Search<'_>, folds: &Folds, common: &Noise, mut fit: Fit) -> (Fit, HeldOut, Vec<NamedTerm>) {
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
        let share = |left: &HeldOut| 1.0 - held.density / left.density.max(f64::MIN_POSITIVE);
        // Sub-linear friction is what dry friction leaves: the latter cannot go before it.
        let carries =
            |term: &Term| matches!(term, Term::Coulomb | Term::Stribeck) && fit.model.has("sublinear_friction");
        let needless = (0..without.len())
            .filter(|nth| share(&without[*nth].1) < LEAST_HELD_OUT_SHARE && !carries(&fit.model.terms[told[*nth]]));
        if let Some(nth) = needless.min_by(|a, b| without[*a].1.density.total_cmp(&without[*b].1.density)) {
            fit = without[nth].0.clone();
            continue;
        }
        let named = without.iter().enumerate().map(|(nth, (less, left))| NamedTerm {
            at: told[nth],
            held_out_share: share(left).clamp(0.0, 1.0),
            p_value: (COMPARISONS * p_value(&fit, less)).min(1.0),
            without: rms(&left.missing),
        });
        let named = named.collect();
        return (fit, held, named);
    }
}

/// `fit` without term `at`, refitted; terms that cannot stand without it go with it.
fn without(search: &Search<'_>, fit: &Fit, at: usize) -> Fit {
    let (model, values) = fit.model.without(at, &fit.values);
    search.lessened(fit, model, values)
}

/// Likelihood-ratio test of `more` against `less`.
fn p_value(more: &Fit, less: &Fit) -> f64 {
    likelihood_ratio_p(more.log_likelihood - less.log_likelihood, more.values.len().saturating_sub(less.values.len()))
}

/// Alternatives that are told.
const MOST_ALTERNATIVES: usize = 3;

/// Sets that were fitted in full and are neither refused by the likelihood nor told like the answer.
fn alternatives(
    search: &Search<'_>,
    folds: &Folds,
    common: &Noise,
    fit: &Fit,
    chosen: &Chosen,
    refitted: &HeldOut,
) -> Vec<Alternative> {
    if fit.model == search.nominal.model {
        return Vec::new();
    }
    let before = rms(&refitted.missing);
    let is_open = |other: &&Fit| {
        other.model.names() != fit.model.names()
            && other.model.told_terms() <= fit.model.told_terms()
            && (fit.log_likelihood - other.log_likelihood < LEAST_GAIN
                || search.worth(fit, other).throughout < LEAST_THROUGHOUT)
    };
    let open = chosen.sets.iter().filter(is_open).take(MOST_ALTERNATIVES);
    open.map(|other| {
        let left = rms(&folds.held_out(&search.data, other, common).missing);
        let share = 1.0 - (left / before.max(f64::MIN_POSITIVE)).powi(2);
        Alternative { names: other.model.names(), held_out_share: share.clamp(0.0, 1.0), left }
    })
    .collect()
}

/// Times the sensors' own noise from which a missing force is one.
const OVER_NOISE: f64 = 1.5;

/// Factor by which refitted values have to lessen what is missing before they are told as wrong.
const VALUES_MATTER: f64 = 1.15;

fn verdict(search: &Search<'_>, fit: &Fit, [given, refitted, improved]: [f64; 3], noise: f64) -> Verdict {
    let above = |rms: f64| (rms * rms - noise * noise).max(0.0).sqrt();
    let effort = search.scales.effort;
    if fit.model == search.nominal.model {
        let is_unknown = refitted > OVER_NOISE * noise && above(refitted) > UNKNOWN_PART_OF_EFFORT * effort;
        return match (is_unknown, given > VALUES_MATTER * refitted && above(given) > LEAST_PART_OF_EFFORT * effort) {
            (true, _) => Verdict::Unknown,
            (false, true) => Verdict::Parameters,
            (false, false) => Verdict::NoMismatch,
        };
    }
    let is_left = improved > OVER_NOISE * noise
        && (above(improved) > MOST_LEFT * above(refitted) || a_curve_does_better(search, fit))
        || a_friction_that_changes_does_better(search, fit);
    if is_left { Verdict::PartlyExplained } else { Verdict::Explained }
}

/// Knots of the free curve over position.
const CURVE_KNOTS: usize = 24;

/// Whether a load by position of no law takes most of what the terms of `fit` leave, where that is much: then they are not all of it.
fn a_curve_does_better(search: &Search<'_>, fit: &Fit) -> bool {
    let scales = &search.scales;
    let spacing = scales.travel / (CURVE_KNOTS - 1) as f64;
    leaves_much(search, fit)
        && is_halved_by(search, fit, Term::Curve { origin: scales.lowest, spacing, count: CURVE_KNOTS }, CURVE_KNOTS)
}

/// Knots of a course of friction over the time of a trial: what warms up or wears does so slowly.
const TIME_KNOTS: usize = 6;

/// Whether dry friction that changes with time or place takes most of what the same friction leaves where it is always the same, where that
/// is much: then it is not the physics of this drive.
fn a_friction_that_changes_does_better(search: &Search<'_>, fit: &Fit) -> bool {
    if !fit.model.terms.iter().any(Term::is_friction) || !leaves_much(search, fit) {
        return false;
    }
    let scales = &search.scales;
    let over = |along: Along, origin: f64, length: f64, count: usize| {
        let course = Term::FrictionCourse { along, origin, spacing: length / (count - 1) as f64, count };
        is_halved_by(search, fit, course, count)
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

/// Whether `term` of no law, with `count` knots, takes half of what `fit` leaves, in root mean square.
fn is_halved_by(search: &Search<'_>, fit: &Fit, term: Term, count: usize) -> bool {
    let mut start = fit.clone();
    start.model.terms.push(term);
    start.values.extend(vec![0.0; count]);
    let better = search.polished(&start);
    is_likelier(&better, fit) && search.unexplained(&better) < CURVE_PART * search.unexplained(fit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::testing::{TestDrive, TestLink};

    fn nominal(inertia: f64, viscous: f64) -> NominalDrive {
        NominalDrive { inertia, viscous, is_rotary: false, encoder: None, resolution: 1e-5, effects: Vec::new() }
    }

    fn identified(drive: &TestDrive, inertia: f64, viscous: f64, seed: u64) -> Outcome {
        let trials = vec![drive.trial(6.0, seed), drive.trial(6.0, seed + 1)];
        identify(trials, &nominal(inertia, viscous), 1, &|_| {}).expect("a drive that moves")
    }

    #[test]
    fn a_drive_with_nothing_missing_is_left_alone_and_its_noise_is_known() {
        let outcome = identified(&TestDrive::PLAIN, 0.8, 4.0, 11);
        assert_eq!(outcome.verdict, Verdict::NoMismatch);
        assert!(outcome.named.is_empty() && outcome.alternatives.is_empty());
        let left = rms(&outcome.missing[1]);
        // Both are root mean squares of 12 000 rows in a band of some hertz: a tenth is three deviations.
        assert!((left / outcome.expected_noise - 1.0).abs() < 0.2, "{left} {}", outcome.expected_noise);
    }

    #[test]
    fn noise_of_the_recorded_effort_is_no_physics() {
        let outcome = identified(&TestDrive { effort_noise: 0.3, ..TestDrive::PLAIN }, 0.8, 4.0, 51);
        assert_eq!(outcome.verdict, Verdict::NoMismatch);
        // It is there: more than encoder and force sensor leave.
        assert!(rms(&outcome.missing[1]) > 1.5 * outcome.expected_noise);
    }

    #[test]
    fn a_lag_of_two_rows_is_no_late_recording() {
        let outcome = identified(&TestDrive { effort_lag_s: 2e-3, ..TestDrive::PLAIN }, 0.75, 5.0, 81);
        assert_eq!(outcome.chosen.model.names(), ["effort_lag"]);
        let lag = outcome.chosen.values[outcome.chosen.model.values_of(0).start];
        assert!((lag / 2e-3 - 1.0).abs() < 0.02, "{lag}");
    }

    #[test]
    fn a_recording_that_is_late_by_part_of_a_row_is_no_lag() {
        let outcome = identified(&TestDrive { effort_late_s: 0.6e-3, ..TestDrive::PLAIN }, 0.8, 4.0, 91);
        assert_eq!(outcome.verdict, Verdict::NoMismatch);
        // Half a step of the test's own simulation, which updates the velocity first, is 20 us.
        assert!((outcome.chosen.values[index::DELAY] - 0.6e-3).abs() < 0.025e-3);
    }

    #[test]
    fn a_play_of_two_hundred_encoder_steps_is_named_with_its_gap() {
        let link = TestLink { stiffness: 4e4, damping: 30.0, play: 2e-3, load_share: 0.5, friction_share: 0.0 };
        let outcome = identified(&TestDrive { link: Some(link), ..TestDrive::PLAIN }, 0.75, 5.0, 61);
        assert_eq!(outcome.chosen.model.names(), ["backlash"]);
        let gap = outcome.chosen.values[outcome.chosen.model.values_of(0).start + 3];
        // A tenth of the gap is twenty steps of the encoder.
        assert!((gap / 2e-3 - 1.0).abs() < 0.1, "{gap}");
        // What it leaves is what the encoder leaves: a link is measured as a rigid law is.
        let left = rms(&outcome.missing[2]);
        assert!((left / outcome.expected_noise - 1.0).abs() < 0.3, "{left} {}", outcome.expected_noise);
    }

    /// A gear that swings at 25 Hz on its flanks: a search with a louder disturbance ends at another gap, or in a lag of the effort.
    #[test]
    fn a_play_with_soft_flanks_is_named_with_its_gap_and_its_stiffness() {
        let link = TestLink { stiffness: 4700.0, damping: 2.2, play: 3e-3, load_share: 0.55, friction_share: 0.4 };
        let outcome = identified(&TestDrive { link: Some(link), ..TestDrive::PLAIN }, 0.82, 4.3, 63);
        assert_eq!(outcome.chosen.model.names(), ["backlash"]);
        let own = outcome.chosen.model.values_of(0);
        let values = &outcome.chosen.values[own];
        // Three hundred times the encoder's step, seen some forty times: a hundredth is far beyond its noise.
        assert!((values[3] / 3e-3 - 1.0).abs() < 0.01 && (values[0] / 4700.0 - 1.0).abs() < 0.02, "{values:?}");
    }

    #[test]
    fn a_weak_link_is_told_with_the_friction_of_its_load() {
        let link = TestLink { stiffness: 1200.0, damping: 1.3, play: 0.0, load_share: 0.4, friction_share: 0.7 };
        let outcome = identified(&TestDrive { link: Some(link), ..TestDrive::PLAIN }, 0.75, 5.0, 62);
        assert_eq!(outcome.chosen.model.names(), ["transmission_compliance"]);
        let own = outcome.chosen.model.values_of(0);
        let (values, ends) = (&outcome.chosen.values[own.clone()], &outcome.intervals[own]);
        for (at, truth) in [(0, 1200.0), (2, 0.4), (3, 0.7)] {
            // The test's own simulation, in 25 steps a row that update the velocity first, is late by half of one: a thousandth.
            let [low, high] = ends[at];
            assert!(low < 1.002 * truth && truth < 1.002 * high, "{at}: {values:?} {ends:?}");
            assert!((values[at] / truth - 1.0).abs() < 0.05, "{at}: {values:?}");
        }
    }

    #[test]
    fn friction_and_a_link_that_hide_each_other_are_named_together() {
        let link = TestLink { stiffness: 1200.0, damping: 1.3, play: 0.0, load_share: 0.5, friction_share: 0.0 };
        let outcome = identified(&TestDrive { coulomb: 0.4, link: Some(link), ..TestDrive::PLAIN }, 0.75, 5.0, 71);
        assert_eq!(outcome.chosen.model.names(), ["coulomb_friction", "transmission_compliance"]);
    }

    #[test]
    fn wrong_values_are_no_physics() {
        let outcome = identified(&TestDrive::PLAIN, 1.0, 7.0, 21);
        assert_eq!(outcome.verdict, Verdict::Parameters);
        assert!(outcome.named.is_empty());
        assert!((outcome.chosen.values[index::INERTIA] - 0.8).abs() < 2e-3);
        assert!((outcome.chosen.values[index::VISCOUS] - 4.0).abs() < 2e-2);
    }

    /// What a rigid-body model explains, of which the effort has to bear `factor`.
    fn loaded(drive: &TestDrive, factor: f64, seed: u64) -> DriveTrial {
        let mut trial = drive.trial(6.0, seed);
        let load: Vec<f64> = trial.source_time.iter().map(|time| 2.0 * (3.0 * time + seed as f64).sin()).collect();
        trial.effort.iter_mut().zip(&load).for_each(|(effort, load)| *effort += factor * load);
        DriveTrial { load: Some(load), ..trial }
    }

    #[test]
    fn a_load_that_is_off_by_some_hundredths_is_a_value_and_no_physics() {
        let identified = |drive: &TestDrive, factor: f64| {
            identify(vec![loaded(drive, factor, 1), loaded(drive, factor, 2)], &nominal(0.8, 4.0), 1, &|_| {})
                .expect("it moves")
        };
        let scale = |outcome: &Outcome| outcome.chosen.values[outcome.chosen.model.load_scale().expect("a load")];
        let off = identified(&TestDrive::PLAIN, 1.06);
        assert_eq!((off.verdict, off.named.len()), (Verdict::Parameters, 0));
        // The load of the test is held from row to row and the model's is straight: half a row of 3 rad/s, 3e-3 N of 2 N.
        assert!((scale(&off) - 1.06).abs() < 3e-3, "{}", scale(&off));
        let right = identified(&TestDrive { coulomb: 0.4, ..TestDrive::PLAIN }, 1.0);
        assert_eq!(right.chosen.model.names(), ["coulomb_friction"]);
        assert!((scale(&right) - 1.0).abs() < 3e-3, "{}", scale(&right));
    }

    #[test]
    fn a_load_that_never_acts_leaves_its_factor_where_it_is_believed() {
        let still = |trial: DriveTrial| DriveTrial { load: Some(vec![0.0; trial.effort.len()]), ..trial };
        let trials = [1, 2].map(|seed| still(TestDrive::PLAIN.trial(6.0, seed)));
        let outcome = identify(trials.to_vec(), &nominal(0.8, 4.0), 1, &|_| {}).expect("it moves");
        let at = outcome.chosen.model.load_scale().expect("a load");
        assert_eq!((outcome.verdict, outcome.chosen.values[at]), (Verdict::NoMismatch, 1.0));
        // Nothing was seen of it: all that is believed of it stays possible.
        assert_eq!(outcome.intervals[at], [0.85, 1.15]);
    }

    #[test]
    fn dry_friction_is_named_alone_with_its_level_and_an_interval_that_holds_it() {
        let outcome = identified(&TestDrive { coulomb: 0.4, ..TestDrive::PLAIN }, 0.75, 5.0, 31);
        assert_eq!(outcome.verdict, Verdict::Explained);
        assert_eq!(outcome.chosen.model.names(), ["coulomb_friction"]);
        let at = outcome.chosen.model.values_of(0).start;
        let (level, [low, high]) = (outcome.chosen.values[at], outcome.intervals[at]);
        assert!((level - 0.4).abs() < 0.01, "{level}");
        // The interval is widened by what the halves disagree about: it holds the truth and is no wider than a twentieth.
        assert!(low - 0.004 <= 0.4 && 0.4 <= high + 0.004 && high - low < 0.04, "{low} {high}");
        let [_, refitted, improved] = [0, 1, 2].map(|of| rms(&outcome.missing[of]));
        assert!(improved < 1.3 * outcome.expected_noise && refitted > 1.5 * improved, "{refitted} {improved}");
    }

    /// A bristle of thirty encoder steps: with friction that is there at once three times what the encoder leaves is left.
    #[test]
    fn friction_that_builds_up_over_a_way_is_dry_friction_and_nothing_else() {
        let outcome = identified(&TestDrive { coulomb: 0.4, presliding: 1.5e-4, ..TestDrive::PLAIN }, 0.75, 5.0, 33);
        assert_eq!((outcome.verdict, outcome.chosen.model.names()), (Verdict::Explained, vec!["coulomb_friction"]));
        let level = outcome.chosen.values[outcome.chosen.model.values_of(0).start];
        // Four chords follow the exponential to a thirtieth of the friction, on the way of a turn alone.
        assert!((level - 0.4).abs() < 0.01, "{level}");
        let left = rms(&outcome.missing[2]);
        assert!(left < 1.3 * outcome.expected_noise, "{left} {}", outcome.expected_noise);
    }

    #[test]
    fn friction_by_the_root_of_the_speed_stands_for_itself() {
        let outcome = identified(&TestDrive { root: 0.4, ..TestDrive::PLAIN }, 0.75, 5.0, 34);
        assert_eq!(outcome.chosen.model.names(), ["sublinear_friction"]);
        let own = outcome.chosen.model.values_of(0);
        assert!((outcome.chosen.values[own.start + 1] - 0.5).abs() < 0.03, "{:?}", outcome.chosen.values);
    }

    #[test]
    fn a_white_force_is_unknown_and_nothing_is_named_for_it() {
        let outcome = identified(&TestDrive { disturbance: 0.05, ..TestDrive::PLAIN }, 0.8, 4.0, 41);
        assert!(outcome.named.is_empty(), "{:?}", outcome.chosen.model.names());
        assert_eq!(outcome.verdict, Verdict::Unknown);
    }

    #[test]
    fn recordings_that_do_not_move_say_nothing() {
        let still = DriveTrial::new(
            "still.csv".to_owned(),
            (0..500).map(|row| 1e-3 * f64::from(row)).collect(),
            &[0.1; 500],
            vec![1.0; 500],
            None,
            1,
        );
        assert!(identify(vec![still], &nominal(0.8, 4.0), 1, &|_| {}).is_none());
    }
}
