//! The answer and its pictures, put together from what the search and the verdict found.

use super::diagnosis::{
    Alternative, Diagnosis, EffectEvidence, Evidence, Finding, FitQuality, Location, Nominal, Physics, PlotData, Trace,
    Value, Verdict,
};
use super::residual_location::ChannelResiduals;
use super::summary;
use crate::diagnose::bootstrap::fitted_model::FittedModel;
use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::experiment;
use crate::diagnose::model::contact_phase;
use crate::diagnose::model::{Residual, index};
use crate::diagnose::selection::confidence_interval::IntervalEstimate;
use crate::diagnose::selection::cross_validation;
use crate::diagnose::selection::forward_selection::SelectionPath;
use crate::diagnose::selection::verdict::{Assessment, NamedEffect};
use crate::effects::{self, Place};
use crate::rig::{Coordinate, Rig};

/// Everything that an answer is composed from.
pub struct DiagnosisInputs<'a> {
    /// The rig file.
    pub rig: &'a Rig,
    /// The trials.
    pub problem: &'a IdentificationProblem,
    /// What was searched.
    pub search: &'a SelectionPath,
    /// What was judged.
    pub assessment: &'a Assessment,
    /// The values of the answer with their intervals.
    pub estimates: &'a [IntervalEstimate],
    /// Residuals of the user's own simulation, where it was handed over.
    pub handed: Option<Vec<Residual>>,
}

impl DiagnosisInputs<'_> {
    fn coordinate(&self) -> Coordinate {
        self.rig.coordinate
    }

    fn as_given(&self) -> &[Residual] {
        self.handed.as_deref().unwrap_or(&self.assessment.as_given.residuals)
    }

    /// The residual that is located: of given values where those are all that is wrong, else of refitted ones.
    fn before(&self) -> &[Residual] {
        match self.assessment.verdict {
            Verdict::Parameters | Verdict::NoMismatch => self.as_given(),
            _ => &self.assessment.refitted.residuals,
        }
    }
}

/// The answer and its pictures.
#[must_use]
pub fn build_report(parts: DiagnosisInputs<'_>) -> Option<(Diagnosis, PlotData)> {
    let fitted_model = &parts.search.rounds.last()?.fitted_model;
    let replicate = parts.problem.replicate_residuals(fitted_model);
    let channels: Vec<ChannelResiduals<'_>> = [false, true]
        .into_iter()
        .filter_map(|effort| {
            let after = &parts.assessment.improved.residuals;
            ChannelResiduals::of(parts.problem, fitted_model, parts.before(), after, &replicate, effort)
        })
        .collect();
    let goodness: Vec<FitQuality> =
        [false, true].into_iter().filter_map(|effort| goodness(&parts, fitted_model, effort)).collect();
    let main = goodness.iter().max_by(|a, b| excess(a).total_cmp(&excess(b)))?.clone();
    let mut locations: Vec<Location> = if parts.assessment.verdict == Verdict::NoMismatch {
        Vec::new()
    } else {
        located(&parts, &channels, main.channel)
    };
    locations.truncate(8);
    let physics = physics(&parts, fitted_model, &locations, &main);
    let alternatives = alternatives(&parts, fitted_model);
    let mut answer = Diagnosis {
        schema: "palpate.diagnosis/1",
        verdict: parts.assessment.verdict,
        summary: String::new(),
        physics,
        alternatives,
        locations,
        fit: main,
        channels: goodness,
        nominal: nominal(&parts),
        checked: effects::ALL.iter().filter(|e| tried(&parts, e.spec().place)).map(|e| e.spec().name).collect(),
        findings: findings(&parts, fitted_model),
    };
    answer.summary = summary::summary(&answer, parts.coordinate());
    let pictures = PlotData {
        rig: parts.rig.name.clone(),
        position_unit: parts.coordinate().position_unit(),
        force_unit: parts.coordinate().force_unit(),
        traces: traces(&parts, fitted_model),
        maps: channels.iter().flat_map(|channel| channel.maps(parts.coordinate())).collect(),
        scores: effect_evidence(&parts),
        experiment: designed(&parts, fitted_model),
    };
    Some((answer, pictures))
}

/// What the recordings showed before, and what limits the answer.
fn findings(parts: &DiagnosisInputs<'_>, fitted_model: &FittedModel) -> Vec<Finding> {
    let mut findings: Vec<Finding> = Vec::new();
    let [doubt, _] = parts.problem.quantization_power(&fitted_model.values);
    if doubt > 2.0 {
        let text = format!(
            "One step of the position sensor is worth more force in this contact than the force sensor's noise: a residual \
             up to {:.1} times the floor is not told from rounding. A finer encoder would show what is below.",
            doubt.sqrt()
        );
        findings.push(Finding {
            code: "quantization_limits_residual",
            grave: false,
            place: "position".to_owned(),
            text,
        });
    }
    let relaxes = parts.assessment.named.iter().any(|named| named.term.name() == "stress_relaxation");
    if relaxes && fitted_model.excitation.releases == 0 && !fitted_model.excitation.has_effort {
        let text = "The tool never leaves the surface and no effort was recorded: a force sensor that follows slowly (force_lag) would \
                    show what is named stress_relaxation here. Record how the force fades after a release.";
        findings.push(Finding {
            code: "relaxation_or_force_lag",
            grave: false,
            place: "motion".to_owned(),
            text: text.to_owned(),
        });
    }
    findings
}

/// An effect was tried where its channel is there and the forms have a place to start.
fn tried(parts: &DiagnosisInputs<'_>, place: Place) -> bool {
    parts.problem.nominal.takes(place)
}

fn excess(goodness: &FitQuality) -> f64 {
    (goodness.refitted.max(goodness.improved) / goodness.noise_floor.max(f64::MIN_POSITIVE)).powi(2)
}

fn located(parts: &DiagnosisInputs<'_>, channels: &[ChannelResiduals<'_>], main: &str) -> Vec<Location> {
    let mut ordered: Vec<&ChannelResiduals<'_>> = channels.iter().collect();
    ordered.sort_by_key(|channel| channel.name != main);
    ordered.iter().flat_map(|channel| channel.locations(parts.coordinate())).collect()
}

fn goodness(parts: &DiagnosisInputs<'_>, fitted_model: &FittedModel, effort: bool) -> Option<FitQuality> {
    let noise_floor = cross_validation::expected_noise_rms(parts.problem, &fitted_model.whitener, effort)?;
    let of = |residuals: &[Residual]| cross_validation::rms(parts.problem, residuals, effort);
    let refitted = of(&parts.assessment.refitted.residuals);
    let improved = of(&parts.assessment.improved.residuals);
    let above = refitted.powi(2) - noise_floor.powi(2);
    let taken = refitted.powi(2) - improved.powi(2);
    let filter = if effort { &parts.problem.sampler.drive_filter } else { &parts.problem.sampler.contact_filter };
    Some(FitQuality {
        channel: if effort { "effort" } else { "force" },
        unit: parts.coordinate().force_unit(),
        noise_floor,
        as_given: of(parts.as_given()),
        refitted,
        improved,
        held_out: true,
        explained_share: if above > 0.0 { (taken / above).clamp(0.0, 1.0) } else { 0.0 },
        band_hz: filter.cutoff_hz(),
    })
}

fn physics(
    parts: &DiagnosisInputs<'_>,
    fitted_model: &FittedModel,
    locations: &[Location],
    main: &FitQuality,
) -> Vec<Physics> {
    let named = parts.assessment.named.iter().map(|named| effect(parts, fitted_model, named));
    let mut all: Vec<Physics> = named.collect();
    if parts.assessment.left {
        all.push(unknown(parts, locations, main, !all.is_empty()));
    }
    all
}

fn effect(parts: &DiagnosisInputs<'_>, fitted_model: &FittedModel, named: &NamedEffect) -> Physics {
    let spec = named.term.effect.spec();
    let form = &spec.forms[named.term.form];
    let start = fitted_model.model.first_value_of(named.at);
    let parameters = form.parameters.iter().enumerate().map(|(at, parameter)| Value {
        name: parameter.name.to_owned(),
        value: parts.estimates[start + at].value,
        unit: parts.coordinate().pick(parameter.unit).to_owned(),
        ci95: parts.estimates[start + at].ends,
    });
    Physics {
        name: spec.name.to_owned(),
        acts_in: spec.place.name(),
        statement: format!("{}.", spec.statement),
        equation: form.equation.to_owned(),
        evidence: Evidence {
            held_out_gain: cross_validation::explained_variance(
                parts.problem,
                &named.without,
                &parts.assessment.improved,
                spec.place,
            ),
            p_value: named.p_value,
        },
        parameters: parameters.collect(),
        on_drive: named.term.effect.on_drive().map(str::to_owned),
    }
}

fn unknown(parts: &DiagnosisInputs<'_>, locations: &[Location], main: &FitQuality, beside: bool) -> Physics {
    let found = parts.search.rounds.last().map(|round| round.structure);
    let place =
        locations.first().map(|l| format!(", most of it during {} ({})", contact_phase::word(l.phase), l.states));
    let what = if beside { "Beside that, something" } else { "Something" };
    let by = found.map_or("", |structure| structure.found_by);
    Physics {
        name: "unknown".to_owned(),
        acts_in: if main.channel == "effort" { "drive" } else { "contact" },
        statement: format!(
            "{what} is there that none of the effects tried explains{}; it shows along {by}.",
            place.unwrap_or_default()
        ),
        equation: String::new(),
        evidence: Evidence { held_out_gain: 0.0, p_value: found.map_or(1.0, |structure| structure.p_value) },
        parameters: Vec::new(),
        on_drive: None,
    }
}

fn alternatives(parts: &DiagnosisInputs<'_>, fitted_model: &FittedModel) -> Vec<Alternative> {
    let before = &parts.assessment.refitted;
    parts
        .assessment
        .alternatives
        .iter()
        .map(|alternative| {
            let held = cross_validation::cross_validate(
                parts.problem,
                &fitted_model.whitener,
                &alternative.model,
                &alternative.fit.values,
                &fitted_model.excitation,
            );
            let others = parts.assessment.named.iter().map(|named| named.term.name());
            let others = others.filter(|name| *name != alternative.instead_of.name());
            let place = alternative.term.effect.spec().place;
            Alternative {
                physics: std::iter::once(alternative.term.name()).chain(others).map(str::to_owned).collect(),
                held_out_gain: cross_validation::explained_variance(parts.problem, before, &held, place),
                separated_by: experiment::separated_by(&alternative.instead_of, &alternative.term),
            }
        })
        .collect()
}

fn nominal(parts: &DiagnosisInputs<'_>) -> Vec<Nominal> {
    let c = parts.coordinate();
    let suffix = |unit: &str| effects::slug(unit);
    let rows = [
        ("stiffness", c.stiffness_unit(), index::STIFFNESS, parts.problem.nominal.contact.is_some()),
        ("damping", c.damping_unit(), index::DAMPING, parts.problem.nominal.contact.is_some()),
        ("surface", c.position_unit(), index::SURFACE, parts.problem.nominal.contact.is_some()),
        (
            if c == Coordinate::Rotary { "inertia" } else { "mass" },
            c.inertia_unit(),
            index::INERTIA,
            parts.problem.nominal.drive,
        ),
        ("viscous", c.damping_unit(), index::VISCOUS, parts.problem.nominal.drive),
    ];
    rows.into_iter()
        .filter(|(_, _, _, there)| *there)
        .map(|(name, unit, at, _)| Nominal {
            name: format!("{name}_{}", suffix(unit)),
            unit: unit.to_owned(),
            given: parts.problem.given[at],
            fitted: parts.estimates[at].value,
            ci95: parts.estimates[at].ends,
        })
        .collect()
}

fn traces(parts: &DiagnosisInputs<'_>, fitted_model: &FittedModel) -> Vec<Trace> {
    let mut traces = Vec::new();
    for (at, trial) in parts.problem.sampler.trials.iter().enumerate() {
        for effort in [false, true] {
            let noise_model = if effort { &fitted_model.whitener.effort } else { &fitted_model.whitener.force };
            let filtered = trial.filtered(effort);
            let measured = if effort { &filtered.effort } else { &filtered.force };
            let (Some(noise_model), Some(measured)) = (noise_model, measured) else { continue };
            let by = |residuals: &[Residual]| -> Vec<f32> {
                let residual = if effort { &residuals[at].effort } else { &residuals[at].force };
                measured.iter().zip(residual).map(|(measured, residual)| (measured - residual) as f32).collect()
            };
            let raw = &parts.problem.sampler.uniform_trials[at];
            traces.push(Trace {
                trial: raw.name.clone(),
                channel: if effort { "effort" } else { "force" },
                time: (0..filtered.len()).map(|row| raw.origin + row as f64 * filtered.step).collect(),
                depth: contact_phase::depths(&fitted_model.model, &fitted_model.values, at, filtered)
                    .iter()
                    .map(|x| *x as f32)
                    .collect(),
                measured: measured.iter().map(|value| *value as f32).collect(),
                as_given: by(parts.as_given()),
                refitted: by(&parts.assessment.refitted.residuals),
                improved: by(&parts.assessment.improved.residuals),
                expected_noise: noise_model.deviation[at].iter().map(|value| *value as f32).collect(),
                valid: filtered.valid.clone(),
            });
        }
    }
    traces
}

/// What each effect does alone, from the first round, by the best of its forms.
fn effect_evidence(parts: &DiagnosisInputs<'_>) -> Vec<EffectEvidence> {
    let Some(first) = parts.search.rounds.first() else { return Vec::new() };
    let above = (first.held_out
        - crate::diagnose::selection::forward_selection::mean_replicate_energy(&first.fitted_model))
    .max(f64::MIN_POSITIVE);
    let mut bars: Vec<EffectEvidence> = Vec::new();
    for candidate in first.candidates.iter().filter(|candidate| candidate.held_out.is_finite()) {
        let name = candidate.term.name();
        if bars.iter().any(|bar| bar.name == name) {
            continue;
        }
        let role = if parts.assessment.named.iter().any(|named| named.term.name() == name) {
            "answer"
        } else if parts.assessment.alternatives.iter().any(|alternative| alternative.term.name() == name) {
            "rival"
        } else {
            ""
        };
        let gain = (first.held_out - candidate.held_out) / above;
        bars.push(EffectEvidence { name, held_out_gain: gain.clamp(-1.0, 1.0), p_value: candidate.p_any, role });
    }
    bars.sort_by(|a, b| b.held_out_gain.total_cmp(&a.held_out_gain));
    bars
}

fn designed(parts: &DiagnosisInputs<'_>, fitted_model: &FittedModel) -> Option<super::diagnosis::Experiment> {
    let alternatives =
        parts.assessment.alternatives.iter().map(|alternative| (&alternative.model, alternative.fit.values.as_slice()));
    let answer = (&fitted_model.model, fitted_model.values.as_slice());
    let designed = experiment::design(parts.problem, &fitted_model.whitener, answer, &alternatives.collect::<Vec<_>>());
    designed.map(|(experiment, _)| experiment)
}

/// Residuals of a simulation that was handed over, given its force and effort at the trials' own rows.
#[must_use]
pub fn residuals_of_simulation(
    problem: &IdentificationProblem,
    simulated: &[crate::diagnose::signals::uniform_trial::UniformTrial],
) -> Vec<Residual> {
    let trials = problem.sampler.trials.iter().zip(simulated);
    let less = |measured: &Option<Vec<f64>>, simulated: Option<Vec<f64>>| match (measured, simulated) {
        (Some(measured), Some(simulated)) => {
            let last = simulated.len().saturating_sub(1);
            measured.iter().enumerate().map(|(at, value)| value - simulated[at.min(last)]).collect()
        }
        (Some(measured), None) => vec![0.0; measured.len()],
        (None, _) => Vec::new(),
    };
    trials
        .map(|(trial, raw)| Residual {
            force: less(
                &trial.contact.force,
                raw.force.as_ref().map(|force| problem.sampler.contact_filter.smooth(force)),
            ),
            effort: less(
                &trial.drive.effort,
                raw.effort.as_ref().map(|effort| problem.sampler.drive_filter.smooth_held(effort)),
            ),
        })
        .collect()
}
