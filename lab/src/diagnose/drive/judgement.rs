//! How what was chosen stands before unseen rows and the sensors' noise.

use super::alternatives::alternatives;
use super::criteria::{LEAST_PART_OF_EFFORT, MOST_LEFT, OVER_NOISE, UNKNOWN_PART_OF_EFFORT, VALUES_MATTER};
use super::expected_noise::{effort_noise, expected_noise};
use super::fit::Fit;
use super::held_out::{Folds, missing_forces, rms};
use super::lack_of_fit::{a_shape_does_better, has_a_shape};
use super::model::index;
use super::noise_at_rest::noise_at_rest;
use super::outcome::Outcome;
use super::selection::{Chosen, Search};
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
    let Validated { fit, held_out, named, uncertainty } = validated(search, &folds, &common, chosen.fit.clone());
    let expected_noise = expected_noise(data, &fit, &common, seed);
    let missing = [given, refitted.missing.clone(), held_out.missing];
    let at_rest =
        noise_at_rest(data.trials, &missing[2], search.band_hz, search.scales.resolution, search.scales.travel);
    let recorded_noise = expected_noise.hypot(effort_noise(data, &fit, &common, seed)).max(at_rest.unwrap_or(0.0));
    let verdict = verdict(search, &fit, &missing, recorded_noise);
    let alternatives = alternatives(search, &folds, &common, &fit, &chosen, &refitted);
    Outcome {
        trials: Vec::new(),
        verdict,
        intervals: uncertainty.ends,
        covariance: uncertainty.covariance,
        named,
        alternatives,
        missing,
        expected_noise,
        band_hz: search.band_hz,
        nominal: search.nominal.clone(),
        outside_forces: Vec::new(),
        coarser_step: None,
        beyond_the_sensor: None,
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
    let is_notable = improved > OVER_NOISE * noise;
    let is_left = is_notable && above(improved) > MOST_LEFT * above(refitted)
        || a_shape_does_better(search, fit, &missing[2], is_notable, noise);
    if is_left { Verdict::PartlyExplained } else { Verdict::Explained }
}
