//! The diagnosis of the contact's channel, from what was identified of it.

use super::channel::{self, Residuals};
use super::contact_findings::findings;
use super::contact_plot;
use super::contact_residual::contact_residual;
use super::contact_values::{correlations, nominal};
use super::contact_wording::{coupling, learned_words, parasitic_words};
use super::diagnosis::{Diagnosis, Evidence, FitQuality, Location, Physics, PlotData};
use super::summary;
use crate::diagnose::contact::data::Data;
use crate::diagnose::contact::held_out::rms;
use crate::diagnose::contact::outcome::Outcome;
use crate::diagnose::evidence::NamedTerm;
use crate::diagnose::phase;
use crate::diagnose::term::Term;
use crate::diagnose::verdict::Verdict;
use crate::effects::{self, Effect as _, PARASITIC_FORCE, Place};
use crate::rig::{Coordinate, Rig};

/// The channel's name in the JSON.
pub const CHANNEL: &str = "force";

/// Diagnosis and plots of the contact alone.
#[must_use]
pub fn contact_report(outcome: &Outcome, rig: &Rig) -> (Diagnosis, PlotData) {
    let coordinate = rig.coordinate;
    let residuals = residuals(outcome);
    let band_hz = 0.5 / outcome.nominal.model.scales.step_s;
    let learned = outcome.left_by_learned().map(|residual| rms(&data(outcome), residual));
    let fit = FitQuality { learned, ..residuals.quality(CHANNEL, coordinate.force_unit(), band_hz) };
    let residual = contact_residual(outcome, coordinate);
    let is_good = outcome.verdict == Verdict::NoMismatch;
    let locations = if is_good { Vec::new() } else { residual.locations() };
    let shown = if is_good { None } else { residual.shortest_stretch() };
    let answer = outcome.chosen.model.names(outcome.known_terms);
    let alternatives: Vec<_> = outcome
        .alternatives
        .iter()
        .map(|other| channel::alternative(CHANNEL, &answer, &other.names, residuals.share_taken(other.left), OTHERWISE))
        .collect();
    let mut diagnosis = Diagnosis {
        schema: "palpate.diagnosis/1",
        verdict: outcome.verdict,
        summary: String::new(),
        physics: physics(outcome, &residuals, coordinate, &locations),
        alternatives,
        locations,
        channels: vec![fit.clone()],
        fit,
        nominal: nominal(outcome, rig),
        correlations: correlations(outcome, rig).into_iter().collect(),
        checked: effects::ALL
            .iter()
            .map(|effect| effect.spec())
            .filter(|spec| spec.place != Place::Drive)
            .map(|spec| spec.name)
            .collect(),
        findings: findings(outcome, coordinate),
    };
    diagnosis.summary = summary::summary(&diagnosis, coordinate);
    let first_effect = diagnosis.physics.first().map(|physics| physics.name.as_str());
    let plots = PlotData {
        rig: rig.name.clone(),
        position_unit: coordinate.position_unit(),
        force_unit: coordinate.force_unit(),
        evidence: contact_plot::evidence(outcome, first_effect, shown, coordinate),
        traces: contact_plot::traces(outcome),
        maps: residual.maps(),
        experiment: None,
        run: None,
    };
    (diagnosis, plots)
}

/// Advice where the list knows no experiment for a pair.
const OTHERWISE: &str = "Contacts to more depths and at more speeds, with holds and slow releases.";

fn residuals(outcome: &Outcome) -> Residuals {
    let data = data(outcome);
    let of_laws = [0, 1, 2].map(|of| rms(&data, &outcome.residuals[of]));
    Residuals { of_laws, expected_noise: outcome.expected_noise }
}

/// The rows of `outcome` with their worth.
#[must_use]
pub fn data(outcome: &Outcome) -> Data<'_> {
    Data { trials: &outcome.trials, noise: outcome.noise.clone(), weights: outcome.weights.clone(), noise_factor: 1.0 }
}

fn physics(outcome: &Outcome, residuals: &Residuals, coordinate: Coordinate, locations: &[Location]) -> Vec<Physics> {
    let evidence = |named: &NamedTerm| residuals.evidence(outcome.named.len(), named.without, named.p_value);
    let named: Vec<Physics> =
        outcome.named.iter().map(|named| described(outcome, named, evidence(named), coordinate)).collect();
    let is_left = matches!(outcome.verdict, Verdict::PartlyExplained | Verdict::Unknown);
    let rest = is_left.then(|| {
        let mut rest = unknown(locations, !named.is_empty());
        if let Some(crosstalk) = outcome.crosstalk {
            rest.acts_in = Place::Sensor.name();
            rest.statement = format!("{} No effect of the list is that.", coupling(crosstalk));
        }
        if let Some(force) = &outcome.parasitic {
            rest.acts_in = Place::Sensor.name();
            rest.statement = format!("{} No effect of the list is that.", parasitic_words(force, outcome, coordinate));
            PARASITIC_FORCE.spec().forms[force.element().0].equation.clone_into(&mut rest.equation);
            if named.is_empty() {
                let [_, refitted, improved] = residuals.of_laws;
                rest.evidence.held_out_gain = residuals.share_of(refitted, improved);
            }
        }
        if let Some(curve) = &outcome.learned {
            // Where nothing is named the reader knows refitted values alone.
            let [_, refitted, improved] = residuals.of_laws;
            let without = if named.is_empty() { refitted } else { improved };
            rest.evidence.held_out_gain = residuals.share_of(without, rms(&data(outcome), curve.residual()));
            rest.statement.push_str(&learned_words(curve, outcome, rest.evidence.held_out_gain, coordinate));
            if let Some(Term { effect, form }) = curve.fit().model.terms.last() {
                effect.spec().forms[*form].equation.clone_into(&mut rest.equation);
            }
        }
        rest
    });
    channel::in_order(named, rest)
}

fn described(outcome: &Outcome, named: &NamedTerm, evidence: Evidence, coordinate: Coordinate) -> Physics {
    let model = &outcome.chosen.model;
    let (term, start) = (model.terms[named.at], model.first_value_of(named.at));
    let spec = term.effect.spec();
    let (values, intervals) = (&outcome.chosen.values[start..], &outcome.intervals[start..]);
    Physics {
        name: spec.name.to_owned(),
        acts_in: spec.place.name(),
        channel: CHANNEL,
        statement: format!("{}.", spec.statement),
        equation: spec.forms[term.form].equation.to_owned(),
        evidence,
        parameters: channel::parameters(term.effect, term.form, coordinate, values, intervals),
        on_drive: term.effect.on_drive().map(str::to_owned),
    }
}

fn unknown(locations: &[Location], beside: bool) -> Physics {
    let place = locations
        .first()
        .filter(|place| place.share >= summary::MAJORITY_SHARE)
        .map(|place| format!(", most of it during {} ({})", phase::word(place.phase), place.states))
        .unwrap_or_default();
    let what = if beside { "Beside that, something" } else { "Something" };
    Physics {
        name: "unknown".to_owned(),
        acts_in: Place::Contact.name(),
        channel: CHANNEL,
        statement: format!("{what} acts in the contact that none of the effects tried explains{place}."),
        equation: String::new(),
        evidence: Evidence { held_out_gain: 0.0, p_value: 0.0 },
        parameters: Vec::new(),
        on_drive: None,
    }
}
