//! What limits the answer of a contact, and what beside the effects was found of it.

use super::contact_wording::{coupling, parasitic_words, rival_words};
use super::diagnosis::Finding;
use super::summary;
use crate::diagnose::contact::outcome::Outcome;
use crate::diagnose::contact::trial::ContactTrial;
use crate::rig::Coordinate;

/// All of them, in the order of a report.
pub(super) fn findings(outcome: &Outcome, coordinate: Coordinate) -> Vec<Finding> {
    let mut findings = beside_effects(outcome, coordinate);
    findings.extend(limits(outcome));
    findings.extend(of_each_trial(outcome));
    findings
}

fn finding(code: &'static str, place: &str, text: impl Into<String>) -> Finding {
    Finding { code, grave: false, place: place.to_owned(), text: text.into() }
}

/// What acts that is no effect of the list.
fn beside_effects(outcome: &Outcome, coordinate: Coordinate) -> Vec<Finding> {
    let mut findings = Vec::new();
    if let Some(crosstalk) = outcome.crosstalk {
        let text = format!(
            "{} That beside the plain contact law leaves less than the effects that were fitted in its place. The effort couples into the \
             reading, by its wires, its ground or the frame.",
            coupling(crosstalk)
        );
        findings.push(finding(summary::EFFORT_IN_FORCE, "force", text));
    }
    let of_curve = |rival| finding("curve_in_place_of_effect", "force", rival_words(rival));
    findings.extend(outcome.rivals.iter().map(of_curve));
    if let Some(force) = &outcome.parasitic {
        let text = format!(
            "{} It is the element parasitic_force of the improved rig file, and the contact was judged by the force without it.",
            parasitic_words(force, outcome, coordinate)
        );
        findings.push(finding(summary::PARASITIC_FORCE, "force", text));
    }
    findings
}

/// What these recordings do not show.
fn limits(outcome: &Outcome) -> Vec<Finding> {
    let mut findings = Vec::new();
    if outcome.is_limited_by_rounding {
        findings.push(finding(
            "quantization_limits_residual",
            "position",
            "One step of the position sensor is worth more force in this contact than the force sensor's noise: a residual below the \
             expected noise is not distinguished from rounding. A finer encoder would show what is below.",
        ));
    }
    let model = &outcome.chosen.model;
    let leaves = |trial: &ContactTrial| trial.position.iter().any(|x| *x < model.surface(&outcome.chosen.values, 0));
    let relaxes = outcome.named.iter().any(|named| model.terms[named.at].name() == "stress_relaxation");
    if relaxes && !outcome.trials.iter().any(leaves) {
        findings.push(finding(
            "relaxation_or_force_lag",
            "motion",
            "The tool never leaves the surface: a force sensor that follows slowly (force_lag) would show what is named \
             stress_relaxation here. Record how the force fades after a release.",
        ));
    }
    findings
}

/// What was fitted in each trial for itself.
fn of_each_trial(outcome: &Outcome) -> Vec<Finding> {
    let own = outcome.chosen.model.own;
    let each = [
        (
            own.surface,
            "surface_in_each_trial",
            "surface",
            "The surface lies elsewhere in each trial: it was placed in each for itself.",
        ),
        (
            own.zero,
            "zero_in_each_trial",
            "force",
            "The force sensor's zero is another one in each trial: it was fitted in each for itself.",
        ),
        (
            own.scale,
            "stiffness_in_each_trial",
            "force",
            "All forces of a trial differ from the others' by one factor, as at another spot of the same body: it was fitted in each trial for itself.",
        ),
    ];
    each.into_iter().filter(|(is, ..)| *is).map(|(_, code, place, text)| finding(code, place, text)).collect()
}
