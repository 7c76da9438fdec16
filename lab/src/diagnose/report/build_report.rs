//! The answer and its pictures, put together from what the search and the judge found.

use super::diagnosis::{
    Answer, Bar, Evidence, Finding, Goodness, Location, Nominal, Physics, Pictures, Rival, Trace, Value, Verdict,
};
use super::residual_location::Channel;
use super::summary;
use crate::diagnose::bootstrap::fitted_model::Stand;
use crate::diagnose::bootstrap::problem::Study;
use crate::diagnose::experiment;
use crate::diagnose::model::contact_phase;
use crate::diagnose::model::{Rest, index};
use crate::diagnose::selection::confidence_interval::Estimate;
use crate::diagnose::selection::cross_validation;
use crate::diagnose::selection::forward_selection::Search;
use crate::diagnose::selection::verdict::{Judgement, Named};
use crate::effects::{self, Place};
use crate::rig::{Coordinate, Rig};

/// Everything that an answer is composed from.
pub struct Parts<'a> {
    /// The rig file.
    pub rig: &'a Rig,
    /// The trials.
    pub study: &'a Study,
    /// What was searched.
    pub search: &'a Search,
    /// What was judged.
    pub judgement: &'a Judgement,
    /// The values of the answer with their intervals.
    pub estimates: &'a [Estimate],
    /// Residuals of the user's own simulation, where it was handed over.
    pub handed: Option<Vec<Rest>>,
    /// What the recordings showed before.
    pub findings: Vec<Finding>,
}

impl Parts<'_> {
    fn coordinate(&self) -> Coordinate {
        self.rig.coordinate
    }

    fn as_given(&self) -> &[Rest] {
        self.handed.as_deref().unwrap_or(&self.judgement.as_given.rests)
    }

    /// The residual that is located: of given values where those are all that is wrong, else of refitted ones.
    fn before(&self) -> &[Rest] {
        match self.judgement.verdict {
            Verdict::Parameters | Verdict::NoMismatch => self.as_given(),
            _ => &self.judgement.refitted.rests,
        }
    }
}

/// The answer and its pictures.
#[must_use]
pub fn compose(parts: Parts<'_>) -> Option<(Answer, Pictures)> {
    let stand = &parts.search.rounds.last()?.stand;
    let twin = parts.study.twin_rests(stand);
    let channels: Vec<Channel<'_>> = [false, true]
        .into_iter()
        .filter_map(|effort| {
            let after = &parts.judgement.improved.rests;
            Channel::of(parts.study, stand, parts.before(), after, &twin, effort)
        })
        .collect();
    let goodness: Vec<Goodness> =
        [false, true].into_iter().filter_map(|effort| goodness(&parts, stand, effort)).collect();
    let main = goodness.iter().max_by(|a, b| excess(a).total_cmp(&excess(b)))?.clone();
    let mut locations: Vec<Location> = if parts.judgement.verdict == Verdict::NoMismatch {
        Vec::new()
    } else {
        located(&parts, &channels, main.channel)
    };
    locations.truncate(8);
    let physics = physics(&parts, stand, &locations, &main);
    let rivals = rivals(&parts, stand);
    let mut answer = Answer {
        schema: "palpate.diagnosis/1",
        verdict: parts.judgement.verdict,
        summary: String::new(),
        physics,
        rivals,
        locations,
        fit: main,
        channels: goodness,
        nominal: nominal(&parts),
        checked: effects::ALL.iter().filter(|e| tried(&parts, e.card().place)).map(|e| e.card().name).collect(),
        findings: findings(&parts, stand),
    };
    answer.summary = summary::summary(&answer, parts.coordinate());
    let pictures = Pictures {
        rig: parts.rig.name.clone(),
        position_unit: parts.coordinate().position_unit(),
        force_unit: parts.coordinate().force_unit(),
        traces: traces(&parts, stand),
        maps: channels.iter().flat_map(|channel| channel.maps(parts.coordinate())).collect(),
        scores: bars(&parts),
        experiment: designed(&parts, stand),
    };
    Some((answer, pictures))
}

/// What the recordings showed before, and what limits the answer.
fn findings(parts: &Parts<'_>, stand: &Stand) -> Vec<Finding> {
    let mut findings = parts.findings.clone();
    let [doubt, _] = parts.study.doubts(&stand.values);
    if doubt > 2.0 {
        let text = format!(
            "One step of the position sensor is worth more force in this contact than the force sensor's noise: a residual \
             up to {:.1} times the floor is not told from rounding. A finer encoder would show what is below.",
            doubt.sqrt()
        );
        findings.push(Finding { grave: false, place: "position".to_owned(), text });
    }
    let relaxes = parts.judgement.named.iter().any(|named| named.term.name() == "stress_relaxation");
    if relaxes && stand.scene.releases == 0 && !stand.scene.has_effort {
        let text = "The tool never leaves the surface and no effort was recorded: a force sensor that follows slowly (force_lag) would \
                    show what is named stress_relaxation here. Record how the force fades after a release.";
        findings.push(Finding { grave: false, place: "motion".to_owned(), text: text.to_owned() });
    }
    findings
}

/// An effect was tried where its channel is there and the forms have a place to start.
fn tried(parts: &Parts<'_>, place: Place) -> bool {
    parts.study.nominal.takes(place)
}

fn excess(goodness: &Goodness) -> f64 {
    (goodness.refitted.max(goodness.improved) / goodness.noise_floor.max(f64::MIN_POSITIVE)).powi(2)
}

fn located(parts: &Parts<'_>, channels: &[Channel<'_>], main: &str) -> Vec<Location> {
    let mut ordered: Vec<&Channel<'_>> = channels.iter().collect();
    ordered.sort_by_key(|channel| channel.name != main);
    ordered.iter().flat_map(|channel| channel.locations(parts.coordinate())).collect()
}

fn goodness(parts: &Parts<'_>, stand: &Stand, effort: bool) -> Option<Goodness> {
    let noise_floor = cross_validation::floor(parts.study, &stand.whitener, effort)?;
    let of = |rests: &[Rest]| cross_validation::rms(parts.study, rests, effort);
    let refitted = of(&parts.judgement.refitted.rests);
    let improved = of(&parts.judgement.improved.rests);
    let above = refitted.powi(2) - noise_floor.powi(2);
    let taken = refitted.powi(2) - improved.powi(2);
    let lens = if effort { &parts.study.studio.drive_lens } else { &parts.study.studio.lens };
    Some(Goodness {
        channel: if effort { "effort" } else { "force" },
        unit: parts.coordinate().force_unit(),
        noise_floor,
        as_given: of(parts.as_given()),
        refitted,
        improved,
        held_out: true,
        explained_share: if above > 0.0 { (taken / above).clamp(0.0, 1.0) } else { 0.0 },
        band_hz: lens.corner(),
    })
}

fn physics(parts: &Parts<'_>, stand: &Stand, locations: &[Location], main: &Goodness) -> Vec<Physics> {
    let named = parts.judgement.named.iter().map(|named| effect(parts, stand, named));
    let mut all: Vec<Physics> = named.collect();
    if parts.judgement.left {
        all.push(unknown(parts, locations, main, !all.is_empty()));
    }
    all
}

fn effect(parts: &Parts<'_>, stand: &Stand, named: &Named) -> Physics {
    let card = named.term.effect.card();
    let form = &card.forms[named.term.form];
    let start = stand.model.start_of(named.at);
    let parameters = form.parameters.iter().enumerate().map(|(at, parameter)| Value {
        name: parameter.name.to_owned(),
        value: parts.estimates[start + at].value,
        unit: parts.coordinate().pick(parameter.unit).to_owned(),
        ci95: parts.estimates[start + at].ends,
    });
    Physics {
        name: card.name.to_owned(),
        acts_in: card.place.name(),
        statement: format!("{}.", card.statement),
        equation: form.equation.to_owned(),
        evidence: Evidence {
            held_out_gain: cross_validation::gone(parts.study, &named.without, &parts.judgement.improved, card.place),
            p_value: named.p_value,
        },
        parameters: parameters.collect(),
        on_drive: summary::on_drive(card.name).map(str::to_owned),
    }
}

fn unknown(parts: &Parts<'_>, locations: &[Location], main: &Goodness, beside: bool) -> Physics {
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

fn rivals(parts: &Parts<'_>, stand: &Stand) -> Vec<Rival> {
    let before = &parts.judgement.refitted;
    parts
        .judgement
        .rivals
        .iter()
        .map(|rival| {
            let held =
                cross_validation::held_out(parts.study, &stand.whitener, &rival.model, &rival.fit.values, &stand.scene);
            let others = parts.judgement.named.iter().map(|named| named.term.name());
            let others = others.filter(|name| *name != rival.instead_of.name());
            let place = rival.term.effect.card().place;
            Rival {
                physics: std::iter::once(rival.term.name()).chain(others).map(str::to_owned).collect(),
                held_out_gain: cross_validation::gone(parts.study, before, &held, place),
                separated_by: experiment::separated_by(&rival.instead_of, &rival.term),
            }
        })
        .collect()
}

fn nominal(parts: &Parts<'_>) -> Vec<Nominal> {
    let c = parts.coordinate();
    let suffix = |unit: &str| effects::slug(unit);
    let rows = [
        ("stiffness", c.stiffness_unit(), index::STIFFNESS, parts.study.nominal.contact.is_some()),
        ("damping", c.damping_unit(), index::DAMPING, parts.study.nominal.contact.is_some()),
        ("surface", c.position_unit(), index::SURFACE, parts.study.nominal.contact.is_some()),
        (
            if c == Coordinate::Rotary { "inertia" } else { "mass" },
            c.inertia_unit(),
            index::INERTIA,
            parts.study.nominal.drive,
        ),
        ("viscous", c.damping_unit(), index::VISCOUS, parts.study.nominal.drive),
    ];
    rows.into_iter()
        .filter(|(_, _, _, there)| *there)
        .map(|(name, unit, at, _)| Nominal {
            name: format!("{name}_{}", suffix(unit)),
            unit: unit.to_owned(),
            given: parts.study.given[at],
            fitted: parts.estimates[at].value,
            ci95: parts.estimates[at].ends,
        })
        .collect()
}

fn traces(parts: &Parts<'_>, stand: &Stand) -> Vec<Trace> {
    let mut traces = Vec::new();
    for (at, trial) in parts.study.studio.trials.iter().enumerate() {
        for effort in [false, true] {
            let floor = if effort { &stand.whitener.effort } else { &stand.whitener.force };
            let track = trial.track(effort);
            let measured = if effort { &track.effort } else { &track.force };
            let (Some(floor), Some(measured)) = (floor, measured) else { continue };
            let by = |rests: &[Rest]| -> Vec<f32> {
                let rest = if effort { &rests[at].effort } else { &rests[at].force };
                measured.iter().zip(rest).map(|(measured, rest)| (measured - rest) as f32).collect()
            };
            let raw = &parts.study.studio.raws[at];
            traces.push(Trace {
                trial: raw.name.clone(),
                channel: if effort { "effort" } else { "force" },
                time: (0..track.len()).map(|row| raw.origin + row as f64 * track.step).collect(),
                depth: contact_phase::depths(&stand.model, &stand.values, at, track)
                    .iter()
                    .map(|x| *x as f32)
                    .collect(),
                measured: measured.iter().map(|value| *value as f32).collect(),
                as_given: by(parts.as_given()),
                refitted: by(&parts.judgement.refitted.rests),
                improved: by(&parts.judgement.improved.rests),
                floor: floor.deviation[at].iter().map(|value| *value as f32).collect(),
                seen: track.seen.clone(),
            });
        }
    }
    traces
}

/// What each effect does alone, from the first round, by the best of its forms.
fn bars(parts: &Parts<'_>) -> Vec<Bar> {
    let Some(first) = parts.search.rounds.first() else { return Vec::new() };
    let above =
        (first.held_out - crate::diagnose::selection::forward_selection::mean(&first.stand)).max(f64::MIN_POSITIVE);
    let mut bars: Vec<Bar> = Vec::new();
    for candidate in first.candidates.iter().filter(|candidate| candidate.held_out.is_finite()) {
        let name = candidate.term.name();
        if bars.iter().any(|bar| bar.name == name) {
            continue;
        }
        let role = if parts.judgement.named.iter().any(|named| named.term.name() == name) {
            "answer"
        } else if parts.judgement.rivals.iter().any(|rival| rival.term.name() == name) {
            "rival"
        } else {
            ""
        };
        let gain = (first.held_out - candidate.held_out) / above;
        bars.push(Bar { name, held_out_gain: gain.clamp(-1.0, 1.0), p_value: candidate.p_any, role });
    }
    bars.sort_by(|a, b| b.held_out_gain.total_cmp(&a.held_out_gain));
    bars
}

fn designed(parts: &Parts<'_>, stand: &Stand) -> Option<super::diagnosis::Experiment> {
    let rivals = parts.judgement.rivals.iter().map(|rival| (&rival.model, rival.fit.values.as_slice()));
    let answer = (&stand.model, stand.values.as_slice());
    let designed = experiment::design(parts.study, &stand.whitener, answer, &rivals.collect::<Vec<_>>());
    designed.map(|(experiment, _)| experiment)
}

/// Residuals of a simulation that was handed over, given its force and effort at the trials' own rows.
#[must_use]
pub fn handed_rests(study: &Study, simulated: &[crate::diagnose::signals::uniform_trial::Raw]) -> Vec<Rest> {
    let trials = study.studio.trials.iter().zip(simulated);
    let less = |measured: &Option<Vec<f64>>, simulated: Option<Vec<f64>>| match (measured, simulated) {
        (Some(measured), Some(simulated)) => {
            let last = simulated.len().saturating_sub(1);
            measured.iter().enumerate().map(|(at, value)| value - simulated[at.min(last)]).collect()
        }
        (Some(measured), None) => vec![0.0; measured.len()],
        (None, _) => Vec::new(),
    };
    trials
        .map(|(trial, raw)| Rest {
            force: less(&trial.contact.force, raw.force.as_ref().map(|force| study.studio.lens.level(force))),
            effort: less(&trial.drive.effort, raw.effort.as_ref().map(|effort| study.studio.drive_lens.held(effort))),
        })
        .collect()
}
