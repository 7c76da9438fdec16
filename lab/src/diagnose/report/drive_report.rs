//! The diagnosis of the drive's channel, from what was identified of it.

use super::channel::{self, Residuals};
use super::diagnosis::{Diagnosis, Evidence, Location, Nominal, Phase, Physics, PlotData, Trace};
use super::drive_residual::drive_residual;
use super::summary;
use crate::diagnose::drive::held_out::rms;
use crate::diagnose::drive::input::Inputs;
use crate::diagnose::drive::law::DriveLaw;
use crate::diagnose::drive::model::index;
use crate::diagnose::drive::named::{NamedEffect, named};
use crate::diagnose::drive::outcome::Outcome;
use crate::diagnose::drive::term::Term;
use crate::diagnose::verdict::Verdict;
use crate::effects::{self, Place, slug};
use crate::rig::{Coordinate, Drive, Rig};

/// The channel's name in the JSON.
pub const CHANNEL: &str = "effort";

/// Diagnosis and plots of the drive alone.
#[must_use]
pub fn drive_report(outcome: &Outcome, rig: &Rig) -> (Diagnosis, PlotData) {
    let coordinate = rig.coordinate;
    let residuals = residuals(outcome);
    let fit = residuals.quality(CHANNEL, coordinate.force_unit(), outcome.band_hz);
    let residual = drive_residual(outcome, coordinate);
    let locations = if outcome.verdict == Verdict::NoMismatch { Vec::new() } else { residual.locations() };
    let answer = outcome.chosen.model.names();
    let alternatives: Vec<_> = outcome
        .alternatives
        .iter()
        .map(|other| {
            // The outcome's share is of all that refitted values leave, noise and all.
            let left = fit.refitted * (1.0 - other.held_out_share).sqrt();
            channel::alternative(&answer, &other.names, residuals.share_taken(left), OTHERWISE)
        })
        .collect();
    let singles = outcome.singles.iter();
    let scores = singles
        .map(|tried| channel::evidence(tried.name, tried.share, tried.p_value, &answer, &alternatives))
        .collect();
    let mut diagnosis = Diagnosis {
        schema: "palpate.diagnosis/1",
        verdict: outcome.verdict,
        summary: String::new(),
        physics: physics(outcome, coordinate, &locations),
        alternatives,
        locations,
        channels: vec![fit.clone()],
        fit,
        nominal: nominal(outcome, rig),
        checked: effects::ALL
            .iter()
            .map(|effect| effect.spec())
            .filter(|spec| spec.place == Place::Drive)
            .map(|spec| spec.name)
            .collect(),
        findings: Vec::new(),
    };
    diagnosis.summary = summary::summary(&diagnosis, coordinate);
    let plots = PlotData {
        rig: rig.name.clone(),
        position_unit: coordinate.position_unit(),
        force_unit: coordinate.force_unit(),
        traces: traces(outcome),
        maps: residual.maps(),
        scores,
        experiment: None,
    };
    (diagnosis, plots)
}

/// Advice where the list knows no experiment for a pair.
const OTHERWISE: &str = "A longer recording over more of the travel and at more speeds.";

fn residuals(outcome: &Outcome) -> Residuals {
    let of_laws = [0, 1, 2].map(|of| rms(&outcome.missing[of]));
    Residuals { of_laws, expected_noise: outcome.expected_noise }
}

/// The effects of the answer, in order of evidence.
#[must_use]
pub fn found(outcome: &Outcome) -> Vec<NamedEffect> {
    let terms = outcome.named.iter().filter_map(|term| named(&outcome.chosen, &outcome.intervals, term.at));
    terms.collect()
}

/// The table of a found effect in a rig file.
#[must_use]
pub fn table(found: &NamedEffect, coordinate: Coordinate) -> crate::rig::Effect {
    let ends: Vec<(f64, f64)> = found.intervals.iter().map(|ends| (ends[0], ends[1])).collect();
    effects::to_table(found.effect, found.form, coordinate, &found.values, Some(&ends))
}

/// `base`, the rig `given` as far as the contact improved it, with what was found of the drive: refitted values, the effects that the
/// rig already held, refitted, and the named ones.
#[must_use]
pub fn refined(given: &Rig, base: &Rig, outcome: &Outcome) -> Rig {
    let values = &outcome.chosen.values;
    let is_wrong = outcome.verdict != Verdict::NoMismatch;
    let mut rig = base.clone();
    rig.drive = given.drive.map(|drive| Drive {
        inertia: if is_wrong { values[index::INERTIA] } else { drive.inertia },
        viscous: if is_wrong { values[index::VISCOUS] } else { drive.viscous },
        encoder: outcome.chosen.model.terms.iter().find_map(Term::encoder).or(drive.encoder),
    });
    let terms = (0..outcome.chosen.model.terms.len())
        .filter_map(|at| named(&outcome.chosen, &outcome.intervals, at))
        .map(|found| table(&found, given.coordinate));
    rig.effects.retain(|table| !outcome.chosen.model.has(&table.name));
    rig.effects.extend(terms);
    rig
}

fn physics(outcome: &Outcome, coordinate: Coordinate, locations: &[Location]) -> Vec<Physics> {
    let named: Vec<Physics> = outcome
        .named
        .iter()
        .filter_map(|term| {
            let effect = named(&outcome.chosen, &outcome.intervals, term.at)?;
            Some(described(&effect, coordinate, Evidence { held_out_gain: term.held_out_share, p_value: term.p_value }))
        })
        .collect();
    let is_left = matches!(outcome.verdict, Verdict::PartlyExplained | Verdict::Unknown);
    let rest = is_left.then(|| unknown(locations, !named.is_empty()));
    channel::in_order(named, rest)
}

fn described(named: &NamedEffect, coordinate: Coordinate, evidence: Evidence) -> Physics {
    let spec = named.effect.spec();
    let form = &spec.forms[named.form];
    Physics {
        name: spec.name.to_owned(),
        acts_in: spec.place.name(),
        statement: format!("{}.", spec.statement),
        equation: form.equation.to_owned(),
        evidence,
        parameters: channel::parameters(named.effect, named.form, coordinate, &named.values, &named.intervals),
        on_drive: named.effect.on_drive().map(str::to_owned),
    }
}

fn unknown(locations: &[Location], beside: bool) -> Physics {
    let place = locations.first().map(|place| format!(", most of it at {}", place.states)).unwrap_or_default();
    let what = if beside { "Beside that, a force" } else { "A force" };
    Physics {
        name: "unknown".to_owned(),
        acts_in: Place::Drive.name(),
        statement: format!("{what} acts on the drive that none of the effects tried explains{place}."),
        equation: String::new(),
        evidence: Evidence { held_out_gain: 0.0, p_value: 0.0 },
        parameters: Vec::new(),
        on_drive: None,
    }
}

fn nominal(outcome: &Outcome, rig: &Rig) -> Vec<Nominal> {
    let c = rig.coordinate;
    let Some(drive) = rig.drive else { return Vec::new() };
    let inertia = if c == Coordinate::Rotary { "inertia" } else { "mass" };
    let (values, ends) = (&outcome.chosen.values, &outcome.intervals);
    let row = |name: &str, unit: &str, given: f64, at: usize| Nominal {
        name: format!("{name}_{}", slug(unit)),
        unit: unit.to_owned(),
        given,
        fitted: values[at],
        ci95: ends[at],
    };
    vec![
        row(inertia, c.inertia_unit(), drive.inertia, index::INERTIA),
        row("viscous", c.damping_unit(), drive.viscous, index::VISCOUS),
        row("effort_delay", "s", 0.0, index::DELAY),
    ]
}

fn traces(outcome: &Outcome) -> Vec<Trace> {
    let law = DriveLaw::nominal(1.0, 0.0, outcome.chosen.values[index::DELAY]);
    let each = outcome.trials.iter().enumerate().map(|(at, trial)| {
        let effort = Inputs::of(trial, &law).effort;
        let by = |which: usize| -> Vec<f32> {
            effort.iter().zip(&outcome.missing[which][at]).map(|(effort, missing)| (effort - missing) as f32).collect()
        };
        Trace {
            trial: trial.name.clone(),
            channel: CHANNEL,
            time: trial.time.clone(),
            depth: trial.position.iter().map(|position| *position as f32).collect(),
            as_given: by(0),
            refitted: by(1),
            improved: by(2),
            measured: effort.iter().map(|effort| *effort as f32).collect(),
            expected_noise: vec![outcome.expected_noise as f32; trial.len()],
            valid: trial.restart.iter().map(|restart| !restart).collect(),
        }
    });
    each.collect()
}

/// The phase of a row of a drive, which knows only free motion.
pub const PHASE: Phase = Phase::Free;
