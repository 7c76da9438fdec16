//! How what was chosen stands before unseen rows and the sensors' noise.

use super::alternatives::{Alternative, MOST_ALTERNATIVES, alternatives};
use super::asymmetric_friction::as_asymmetric;
use super::candidates::is_likelier;
use super::criteria::{LEAST_PART_OF_EFFORT, MOST_LEFT, OVER_NOISE, UNKNOWN_PART_OF_EFFORT, VALUES_MATTER};
use super::expected_noise::{effort_noise, expected_noise};
use super::fit::Fit;
use super::held_out::{Folds, missing_forces, rms};
use super::lack_of_fit::{a_shape_does_better, has_a_shape, is_beyond};
use super::model::index;
use super::noise::Noise;
use super::noise_at_rest::noise_at_rest;
use super::outcome::Outcome;
use super::ripples::as_one_cogging;
use super::selection::{Chosen, Search, is_believed};
use super::term::Term;
use super::validation::{Validated, validated};
use crate::diagnose::verdict::Verdict;

/// What is told of `chosen`; noise is drawn from `seed`.
#[must_use]
pub fn judged(search: &Search<'_>, chosen: Chosen, seed: u64) -> Outcome {
    let data = &search.data;
    let folds = Folds::of(data.trials);
    let common = search.nominal.noise.with_crossing(
        search.band_hz,
        search.scales.period_s,
        search.nominal.values[index::INERTIA],
    );
    let given = missing_forces(data, &as_given(search), &common);
    let refitted = folds.held_out(data, &search.nominal, &common);
    let mut stands = standing(search, &folds, &common, &chosen);
    if let Some(one) = as_one_cogging(&stands.fit, search.nominal.model.terms.len()) {
        stands = validated(search, &folds, &common, one);
    }
    let mut alternatives = alternatives(search, &folds, &common, &stands.fit, &chosen, &refitted);
    let one = as_asymmetric(&stands.fit, search.nominal.model.terms.len())
        .map(|one| validated(search, &folds, &common, one))
        .filter(|one| one.fit.model.terms.contains(&Term::AsymmetricCoulomb));
    if let Some(one) = &one {
        alternatives.retain(|other| other.names != one.fit.model.names());
        alternatives.insert(0, Alternative::of(&stands.fit, &stands.held_out, &refitted));
        alternatives.truncate(MOST_ALTERNATIVES);
    }
    let stands = one.unwrap_or(stands);
    let chosen_names = stands.fit.model.names();
    let (Validated { fit, held_out, named, uncertainty }, noise) = unrivalled(search, &folds, &common, stands, seed);
    let told = fit.model.names();
    let rivalled = chosen_names.into_iter().filter(|name| !told.contains(name)).collect();
    let missing = [given, refitted.missing.clone(), held_out.missing];
    let verdict = verdict(search, &fit, &missing, noise.recorded);
    Outcome {
        trials: Vec::new(),
        verdict,
        intervals: uncertainty.ends,
        covariance: uncertainty.covariance,
        named,
        rivalled,
        alternatives,
        missing,
        expected_noise: noise.expected,
        band_hz: search.band_hz,
        nominal: search.nominal.clone(),
        outside_forces: Vec::new(),
        coarser_step: None,
        beyond_the_sensor: None,
        chosen: fit,
    }
}

/// What stands of what was chosen; or, where a term of that falls, of the likeliest set without it that is worth its terms beside what stands: a link that
/// follows any rows is the likeliest of all, and what it took the place of was never asked.
fn standing(search: &Search<'_>, folds: &Folds, common: &Noise, chosen: &Chosen) -> Validated {
    let first = validated(search, folds, common, chosen.fit.clone());
    let told = first.fit.model.names();
    let fallen: Vec<&str> = chosen.fit.model.names().into_iter().filter(|name| !told.contains(name)).collect();
    let is_more = |fit: &Fit| is_likelier(fit, &first.fit) && search.is_worth(fit, &first.fit);
    let is_open = |fit: &&Fit| !fallen.iter().any(|name| fit.model.has(name)) && is_believed(fit) && is_more(fit);
    let others = if fallen.is_empty() { &[][..] } else { &chosen.sets };
    let likeliest = others.iter().filter(is_open).max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood));
    let second = likeliest.map(|fit| validated(search, folds, common, search.pruned(fit.clone())));
    second.filter(|second| is_more(&second.fit)).unwrap_or(first)
}

/// What the sensors alone would leave, root mean squares in N or N m.
struct SensorNoise {
    /// Of the encoder's noise.
    expected: f64,
    /// With the noise that is recorded with the effort, or as loud as where the drive stands still.
    recorded: f64,
}

impl SensorNoise {
    /// That of a law that `stands`, drawn from `seed`.
    fn beside(search: &Search<'_>, stands: &Validated, common: &Noise, seed: u64) -> Self {
        let (data, scales) = (&search.data, &search.scales);
        let expected = expected_noise(data, &stands.fit, common, scales.resolution, seed);
        let missing = &stands.held_out.missing;
        let at_rest = noise_at_rest(data.trials, missing, search.band_hz, scales.resolution, scales.travel);
        let recorded = expected.hypot(effort_noise(data, &stands.fit, common, seed)).max(at_rest.unwrap_or(0.0));
        Self { expected, recorded }
    }
}

/// `stands` without names in whose place a shape of no law does far better, where more is left than the sensors' noise is known to.
fn unrivalled(
    search: &Search<'_>,
    folds: &Folds,
    common: &Noise,
    mut stands: Validated,
    seed: u64,
) -> (Validated, SensorNoise) {
    loop {
        let noise = SensorNoise::beside(search, &stands, common, seed);
        let is_left = is_beyond(rms(&stands.held_out.missing), noise.recorded);
        match is_left.then(|| search.without_rivalled(&stands.fit)).flatten() {
            Some(fit) => stands = validated(search, folds, common, fit),
            None => return (stands, noise),
        }
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

fn verdict(search: &Search<'_>, fit: &Fit, missing: &[Vec<Vec<f64>>; 3], noise: f64) -> Verdict {
    let [given, refitted, improved] = missing.each_ref().map(|columns| rms(columns));
    let above = |rms: f64| (rms * rms - noise * noise).max(0.0).sqrt();
    let effort = search.scales.effort;
    if fit.model == search.nominal.model {
        // What has a shape is there, however little it is; of what has none a part is the model's own.
        let is_unknown = refitted > OVER_NOISE * noise && above(refitted) > UNKNOWN_PART_OF_EFFORT * effort
            || has_a_shape(search, &missing[1]);
        return match (is_unknown, given > VALUES_MATTER * refitted && above(given) > LEAST_PART_OF_EFFORT * effort) {
            (true, _) => Verdict::Unknown,
            (false, true) => Verdict::Parameters,
            (false, false) => Verdict::NoMismatch,
        };
    }
    let is_left = improved > OVER_NOISE * noise && above(improved) > MOST_LEFT * above(refitted)
        || a_shape_does_better(search, fit, &missing[2], noise);
    if is_left { Verdict::PartlyExplained } else { Verdict::Explained }
}

#[cfg(test)]
mod tests {
    use super::super::identification::identify;
    use super::super::law::Side;
    use super::super::testing::{TestDrive, nominal, search_over, with_dry_friction};
    use super::*;
    use crate::diagnose::drive::named::named;

    /// Dry friction, and a link in its place that is no stiffer than the rows show and is not told by them: the link falls, and the friction, which was not
    /// chosen, stands. Where nothing else was tried nothing does.
    #[test]
    fn where_what_was_chosen_falls_the_likeliest_of_the_other_sets_is_asked() {
        let drive = TestDrive { coulomb: 0.3, ..TestDrive::PLAIN };
        let trials = [drive.trial(4.0, 6)];
        let search = search_over(&trials, &drive);
        let linked = search.polished(&Fit {
            model: search.nominal.model.with(Term::Compliance(Side::Motor)),
            values: [search.nominal.values.as_slice(), &[1e6, 100.0, 0.1, 0.5]].concat(),
            ..search.nominal.clone()
        });
        let (folds, common) = (Folds::of(search.data.trials), search.nominal.noise);
        let stands = |sets: Vec<Fit>| {
            let chosen = Chosen { fit: linked.clone(), sets };
            standing(&search, &folds, &common, &chosen).fit.model.names()
        };
        assert_eq!(stands(vec![linked.clone()]), [""; 0]);
        assert_eq!(stands(vec![linked.clone(), with_dry_friction(&search)]), ["coulomb_friction"]);
    }

    /// Friction of 0.4 N beside a load of 0.15 N is one of 0.55 N forward and 0.25 N backward; two effects say no more.
    #[test]
    fn friction_beside_a_smaller_load_is_one_friction_of_two_levels_and_both_are_an_alternative() {
        let rig = nominal(0.75, 5.0);
        let drive = TestDrive { coulomb: 0.4, load: 0.15, ..TestDrive::PLAIN };
        let outcome = identify(vec![drive.trial(6.0, 81), drive.trial(6.0, 82)], &rig, 1, &|_| {}).expect("it moves");
        assert_eq!((outcome.verdict, outcome.chosen.model.names()), (Verdict::Explained, vec!["coulomb_friction"]));
        let found = named(&outcome.chosen, &outcome.intervals, outcome.named[0].at).expect("an effect");
        for ((value, ends), truth) in found.values.iter().zip(&found.intervals).zip([0.55, 0.25]) {
            // As of a friction alone: to some hundredths of its level.
            assert!(
                (value - truth).abs() < 0.015 && ends[0] < truth + 0.006 && ends[1] > truth - 0.006,
                "{value} {ends:?}"
            );
        }
        assert_eq!(outcome.alternatives[0].names, ["coulomb_friction", "gravity_load"]);
    }
}
