//! The diagnosis of the drive's channel, from what was identified of it.

use super::channel::{self, Residuals};
use super::correlation;
use super::diagnosis::{Correlations, Diagnosis, Evidence, Finding, Location, Nominal, Phase, Physics, PlotData};
use super::drive_plot;
use super::drive_residual::drive_residual;
use super::summary;
use crate::diagnose::contact;
use crate::diagnose::drive::fit::Fit;
use crate::diagnose::drive::held_out::rms;
use crate::diagnose::drive::model::index;
use crate::diagnose::drive::named::{NamedEffect, named};
use crate::diagnose::drive::outcome::Outcome;
use crate::diagnose::drive::outside_force::Stretch;
use crate::diagnose::drive::term::Term;
use crate::diagnose::verdict::Verdict;
use crate::effects::{self, Place, slug};
use crate::page::quantity;
use crate::rig::{Coordinate, Drive, Rig};

/// The channel's name in the JSON.
pub const CHANNEL: &str = "effort";

/// Where the tool of a drive touches, as the contact's channel found it.
pub struct Touched {
    /// Fitted surface of each trial.
    surfaces: Vec<f64>,
    /// Greatest depth and usual speed in contact.
    depth: f64,
    speed: f64,
    bilateral: bool,
}

impl Touched {
    /// By what was found of the contact.
    #[must_use]
    pub fn of(contact: &contact::outcome::Outcome) -> Self {
        let (model, values) = (&contact.chosen.model, &contact.chosen.values);
        Self {
            surfaces: (0..contact.trials.len()).map(|trial| model.surface(values, trial)).collect(),
            depth: model.scales.depth,
            speed: model.scales.speed,
            bilateral: model.bilateral,
        }
    }

    /// The phase of contact of a row of a trial.
    pub(super) fn phase(&self, trial: usize, position: f64, velocity: f64) -> Phase {
        let surface = self.surfaces.get(trial).copied().unwrap_or(f64::INFINITY);
        Phase::of(position - surface, velocity, self.depth, self.speed, self.bilateral)
    }
}

/// Diagnosis and plots of the drive alone; `touched` where a contact was recorded as well.
#[must_use]
pub fn drive_report(outcome: &Outcome, rig: &Rig, touched: Option<&Touched>) -> (Diagnosis, PlotData) {
    let coordinate = rig.coordinate;
    let residuals = residuals(outcome);
    let fit = residuals.quality(CHANNEL, coordinate.force_unit(), outcome.band_hz);
    let residual = drive_residual(outcome, coordinate, touched);
    let is_good = outcome.verdict == Verdict::NoMismatch;
    let locations = if is_good { Vec::new() } else { residual.locations() };
    let shown = if is_good { None } else { residual.shortest_stretch() };
    let answer = outcome.chosen.model.names();
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
            .filter(|spec| spec.place == Place::Drive)
            .map(|spec| spec.name)
            .collect(),
        findings: outside_forces(outcome)
            .into_iter()
            .chain(load_at_its_end(outcome))
            .chain(slower_motion(outcome, coordinate))
            .chain(noise_taken_out(outcome, coordinate))
            .collect(),
    };
    diagnosis.summary = summary::summary(&diagnosis, coordinate);
    let first_effect = diagnosis.physics.first().map(|physics| physics.name.as_str());
    let plots = PlotData {
        rig: rig.name.clone(),
        position_unit: coordinate.position_unit(),
        force_unit: coordinate.force_unit(),
        evidence: drive_plot::friction(outcome, first_effect, shown, coordinate).into_iter().collect(),
        traces: drive_plot::traces(outcome),
        maps: residual.maps(),
        experiment: None,
        run: None,
    };
    (diagnosis, plots)
}

/// Advice where the list knows no experiment for a pair.
const OTHERWISE: &str = "A longer recording over more of the travel and at more speeds.";

/// Stretches in which something else pushes.
fn outside_forces(outcome: &Outcome) -> Vec<Finding> {
    let sentence = |stretch: &Stretch| {
        let trial = &outcome.trials[stretch.trial];
        let [from, to] = [stretch.start_s, stretch.end_s].map(|time| time - trial.source_time[0]);
        Finding {
            code: "outside_force",
            grave: false,
            place: trial.name.clone(),
            text: format!(
                "From {from:.1} to {to:.1} s a force acts that no law of a drive makes and that is not there at other times, as a hand \
                 or a stop: what lies there is left out of everything else."
            ),
        }
    };
    outcome.outside_forces.iter().map(sentence).collect()
}

/// A load whose factor ends where the search does: the recordings would have it further off than a rigid-body model is.
fn load_at_its_end(outcome: &Outcome) -> Option<Finding> {
    let at = outcome.chosen.model.load_scale()?;
    let factor = outcome.chosen.values[at];
    outcome.chosen.model.ranges()[at].is_at_end(factor).then(|| Finding {
        code: "load_scale_at_end",
        grave: false,
        place: "load".to_owned(),
        text: format!(
            "The given load fits best times {factor:.2}, the furthest that is tried: either it is wrong by more, or this motion hardly \
             tells it from the inertia. Check its masses, or record slow motion, in which a load acts and an inertia does not."
        ),
    })
}

/// That a law was found of the slower motion alone.
fn slower_motion(outcome: &Outcome, coordinate: Coordinate) -> Option<Finding> {
    let step = quantity::rounded(outcome.coarser_step?, coordinate.position_unit(), 2);
    Some(Finding {
        code: "slower_motion_alone",
        grave: false,
        place: "drive".to_owned(),
        text: format!(
            "From row to row the position moves faster than any force on the inertia could move it, as where a gear rattles or an arm \
             bends between the motor and the load. The law is that of the slower motion, seen as by an encoder with steps of {step}; what \
             happens faster is unknown."
        ),
    })
}

/// That noise was taken out of effort or force.
fn noise_taken_out(outcome: &Outcome, coordinate: Coordinate) -> Option<Finding> {
    let largest = |of: usize| {
        let filters = outcome.trials.iter().filter_map(|trial| trial.noise_filter.as_ref());
        filters.map(|filter| filter.noise[of].sqrt()).fold(0.0, f64::max)
    };
    let told = |name: &str, deviation: f64| {
        let size = quantity::rounded(deviation, coordinate.force_unit(), 2);
        (deviation > 0.0).then(|| format!("of the recorded {name} as much as white noise of {size}"))
    };
    let all: Vec<String> = [told("effort", largest(0)), told("force", largest(1))].into_iter().flatten().collect();
    (!all.is_empty()).then(|| Finding {
        code: "noise_taken_out",
        grave: false,
        place: "drive".to_owned(),
        text: format!(
            "Noise that does not move the drive was taken out before a law was fitted, where it drowns the signal: {}. A law that is driven by it finds \
             an inertia that is too large.",
            all.join(", ")
        ),
    })
}

fn residuals(outcome: &Outcome) -> Residuals {
    let of_laws = [0, 1, 2].map(|of| rms(&outcome.missing[of]));
    Residuals { of_laws, expected_noise: outcome.expected_noise }
}

/// The effects of the answer, in order of evidence.
#[must_use]
pub fn found(outcome: &Outcome) -> Vec<NamedEffect> {
    outcome.named.iter().filter_map(|term| effect_at(outcome, term.at)).collect()
}

/// The effect that term `at` is. The motor's share of the inertia is of the whole, which the law may lack a part of.
fn effect_at(outcome: &Outcome, at: usize) -> Option<NamedEffect> {
    let mut effect = named(&outcome.chosen, &outcome.intervals, at)?;
    let of_whole = outcome.chosen.values[index::INERTIA] / outcome.inertia().0;
    let parameters = effect.effect.spec().forms[effect.form].parameters;
    if let Some(share) = parameters.iter().position(|parameter| parameter.name == "motor_share") {
        effect.values[share] *= of_whole;
        effect.intervals[share].iter_mut().for_each(|end| *end *= of_whole);
    }
    Some(effect)
}

/// The table of a found effect in a rig file.
#[must_use]
pub fn table(found: &NamedEffect, coordinate: Coordinate) -> crate::rig::Effect {
    let ends = channel::all_told(&found.values, &found.intervals);
    let ends: Vec<(f64, f64)> = ends.iter().map(|ends| (ends[0], ends[1])).collect();
    effects::to_table(found.effect, found.form, coordinate, &found.values, Some(&ends))
}

/// `base`, the rig `given` as far as the contact improved it, with what was found of the drive: refitted values, the effects that the
/// rig already held, refitted, and the named ones.
#[must_use]
pub fn refined(given: &Rig, base: &Rig, outcome: &Outcome) -> Rig {
    let values = &outcome.chosen.values;
    // What hangs beyond the sensor is part of the mass, whether it was known to the file or not.
    let is_wrong = outcome.verdict != Verdict::NoMismatch || outcome.beyond_the_sensor.is_some();
    let mut rig = base.clone();
    rig.drive = given.drive.map(|drive| Drive {
        inertia: if is_wrong { outcome.inertia().0 } else { drive.inertia },
        viscous: if is_wrong { values[index::VISCOUS] } else { drive.viscous },
        encoder: outcome.chosen.model.terms.iter().find_map(Term::encoder).or(drive.encoder),
        load_scale: drive.load_scale
            * outcome.chosen.model.load_scale().filter(|_| is_wrong).map_or(1.0, |at| values[at]),
    });
    let terms = (0..outcome.chosen.model.terms.len())
        .filter_map(|at| effect_at(outcome, at))
        .map(|found| table(&found, given.coordinate));
    rig.effects.retain(|table| !outcome.chosen.model.has(&table.name));
    rig.effects.extend(terms);
    rig
}

fn physics(outcome: &Outcome, residuals: &Residuals, coordinate: Coordinate, locations: &[Location]) -> Vec<Physics> {
    let named: Vec<Physics> = outcome
        .named
        .iter()
        .filter_map(|term| {
            let effect = effect_at(outcome, term.at)?;
            let evidence = residuals.evidence(outcome.named.len(), term.without, term.p_value);
            Some(described(&effect, coordinate, evidence))
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
        channel: CHANNEL,
        statement: format!("{}.", spec.statement),
        equation: form.equation.to_owned(),
        evidence,
        parameters: channel::parameters(named.effect, named.form, coordinate, &named.values, &named.intervals),
        on_drive: named.effect.on_drive().map(str::to_owned),
    }
}

fn unknown(locations: &[Location], beside: bool) -> Physics {
    let place = locations
        .first()
        .filter(|place| place.share >= summary::MAJORITY_SHARE)
        .map(|place| format!(", most of it at {}", place.states))
        .unwrap_or_default();
    let what = if beside { "Beside that, a force" } else { "A force" };
    Physics {
        name: "unknown".to_owned(),
        acts_in: Place::Drive.name(),
        channel: CHANNEL,
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
    let row = |name: &str, unit: &str, given: f64, (fitted, ends): (f64, [f64; 2])| Nominal {
        name: format!("{name}_{}", slug(unit)),
        unit: unit.to_owned(),
        given,
        fitted,
        ci95: channel::told(fitted, ends),
    };
    let value = |at: usize| (values[at], ends[at]);
    let part = outcome.chosen.model.part_averaged(values);
    let averaging_ends = channel::told(values[index::AVERAGING], ends[index::AVERAGING]).map(|end| part * end);
    let mut rows = vec![
        row(inertia, c.inertia_unit(), drive.inertia, outcome.inertia()),
        row("viscous", c.damping_unit(), drive.viscous, value(index::VISCOUS)),
        row("effort_delay", "s", 0.0, value(index::DELAY)),
        Nominal {
            name: "effort_averaging".to_owned(),
            unit: "1".to_owned(),
            given: 0.0,
            fitted: averaging(&outcome.chosen),
            ci95: averaging_ends,
        },
    ];
    rows.extend(outcome.chosen.model.load_scale().map(|at| Nominal {
        name: "load_scale".to_owned(),
        unit: "1".to_owned(),
        given: drive.load_scale,
        fitted: drive.load_scale * values[at],
        ci95: channel::told(values[at], ends[at]).map(|end| drive.load_scale * end),
    }));
    rows
}

/// The averaging of the effort that acts in the law of `fit`.
fn averaging(fit: &Fit) -> f64 {
    fit.model.law(&fit.values).effort_averaging
}

/// Of the values that the report shows, of which some are not those of the fit: a pitch is one over a frequency.
fn correlations(outcome: &Outcome, rig: &Rig) -> Option<Correlations> {
    let names: Vec<String> = nominal(outcome, rig).into_iter().map(|row| row.name).collect();
    let fit = &outcome.chosen;
    let shown = |values: &[f64]| {
        let moved = Fit { values: values.to_vec(), ..fit.clone() };
        let ends = vec![[0.0; 2]; values.len()];
        let of_law = [values[index::INERTIA], values[index::VISCOUS], values[index::DELAY], averaging(&moved)];
        let nominal = of_law.into_iter().chain(fit.model.load_scale().map(|at| values[at]));
        let mut shown: Vec<(String, f64)> = names.iter().cloned().zip(nominal).collect();
        for effect in (0..fit.model.terms.len()).filter_map(|at| named(&moved, &ends, at)) {
            let parameters = effect.effect.spec().forms[effect.form].parameters.iter().zip(&effect.values);
            shown
                .extend(parameters.map(|(parameter, value)| (format!("{}.{}", effect.name(), parameter.name), *value)));
        }
        shown
    };
    correlation::correlations(CHANNEL, &fit.values, &outcome.covariance, &shown)
}
