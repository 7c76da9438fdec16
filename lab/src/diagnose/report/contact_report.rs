//! The diagnosis of the contact's channel, from what was identified of it.

use super::channel::{self, Residuals};
use super::contact_plot;
use super::contact_residual::contact_residual;
use super::correlation;
use super::diagnosis::{Correlations, Diagnosis, Evidence, Finding, FitQuality, Location, Nominal, Physics, PlotData};
use super::summary;
use crate::diagnose::contact::crosstalk::Crosstalk;
use crate::diagnose::contact::data::Data;
use crate::diagnose::contact::fit::Fit;
use crate::diagnose::contact::free_curve::Curve;
use crate::diagnose::contact::held_out::rms;
use crate::diagnose::contact::learned::{Learned, LearnedCurve};
use crate::diagnose::contact::learned_damping::DampingCurve;
use crate::diagnose::contact::model::index;
use crate::diagnose::contact::outcome::Outcome;
use crate::diagnose::contact::parasitic_force::{Along, ParasiticForce};
use crate::diagnose::contact::rival_curves::Rival;
use crate::diagnose::contact::trial::ContactTrial;
use crate::diagnose::evidence::NamedTerm;
use crate::diagnose::interval::NORMAL_97_5;
use crate::diagnose::phase;
use crate::diagnose::term::Term;
use crate::diagnose::verdict::Verdict;
use crate::effects::{self, Effect as _, PARASITIC_FORCE, Place, slug};
use crate::page::quantity;
use crate::rig::{Contact, Coordinate, Rig};

/// Part of the force's range from which a feature of a learned curve is reported.
const LEAST_FEATURE: f64 = 0.02;

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

/// The rig `given` with what was found of the contact: refitted values and every effect of the law.
#[must_use]
pub fn refined(given: &Rig, outcome: &Outcome) -> Rig {
    let named = if outcome.named.is_empty() { &outcome.nominal } else { &outcome.chosen };
    let fit = outcome.learned.as_ref().map_or(named, Learned::fit);
    let ends = match &outcome.learned {
        Some(curve) => Some(curve.intervals(&outcome.intervals)),
        None => (!outcome.named.is_empty()).then(|| outcome.intervals.clone()),
    };
    let ends = ends.map(|ends| channel::all_told(&fit.values, &ends));
    let mut rig = with_law(given, fit, outcome, ends.as_deref());
    if outcome.verdict == Verdict::NoMismatch {
        rig.contact = given.contact;
    }
    rig
}

/// The `improved` rig with each law that the recordings do not tell from the answer's in the place of it.
#[must_use]
pub fn alternative_rigs(improved: &Rig, outcome: &Outcome) -> Vec<Rig> {
    outcome.alternatives.iter().map(|other| with_law(improved, &other.fit, outcome, None)).collect()
}

/// The rig `given` with the law `fit` of the contact of `outcome`, the `intervals` of its values, and the force of free motion where there is one.
fn with_law(given: &Rig, Fit { model, values, .. }: &Fit, outcome: &Outcome, intervals: Option<&[[f64; 2]]>) -> Rig {
    let mut rig = given.clone();
    rig.contact = given.contact.map(|contact| Contact {
        stiffness: values[index::STIFFNESS],
        damping: values[index::DAMPING],
        surface: values[index::SURFACE],
        ..contact
    });
    rig.effects.retain(|table| effects::find(&table.name).is_some_and(|e| e.spec().place == Place::Drive));
    let mut next = model.nominal_count();
    for term in &model.terms {
        let own = next..next + term.parameters().len();
        next += term.all_parameters(outcome.trials.len()).len();
        let ends: Option<Vec<(f64, f64)>> =
            intervals.map(|all| all[own.clone()].iter().map(|ends| (ends[0], ends[1])).collect());
        rig.effects.push(effects::to_table(term.effect, term.form, given.coordinate, &values[own], ends.as_deref()));
    }
    if let Some(force) = &outcome.parasitic {
        let (form, values) = force.element();
        rig.effects.push(effects::to_table(PARASITIC_FORCE, form, given.coordinate, &values, None));
    }
    rig
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

/// How the force reading goes with the effort, in a sentence.
fn coupling(Crosstalk { part, memory_s }: Crosstalk) -> String {
    let what = if memory_s.is_finite() {
        format!("follows the steps of the drive's effort, forgotten within {},", quantity::rounded(memory_s, "s", 2))
    } else {
        "follows the drive's effort".to_owned()
    };
    format!("The force reading {what} by a factor of {}.", quantity::short(part))
}

/// That a free curve does better than a name, or than the nominal law alone.
fn rival_words(rival: &Rival) -> String {
    let along = match rival.curve {
        Curve::Place => "the depth",
        Curve::PlaceAndDirection => "the depth, one on the way in and one on the way out",
        Curve::Speed => "the speed in contact",
        Curve::SpeedTimesDepth => "the speed in contact, in proportion to the depth",
    };
    let likelier = format!("is likelier, by {:.0} nats beyond the price of its values", rival.gain);
    match (rival.name, rival.is_refuted) {
        (Some(name), true) => format!(
            "{name} was found and is not told: in its place a free curve over {along} {likelier}. The force goes with that otherwise than by the effect's law."
        ),
        (Some(name), false) => format!(
            "{name} takes the most of what is missing, but in its place a free curve over {along} {likelier}: its law is not quite what acts."
        ),
        (None, _) => format!(
            "Beside the refitted law a free curve over {along} {likelier}: something small is missing that no effect of the list explains."
        ),
    }
}

/// On what a parasitic force depends, and how large it is in these recordings.
fn parasitic_words(force: &ParasiticForce, outcome: &Outcome, coordinate: Coordinate) -> String {
    let added: Vec<f64> = outcome.trials.iter().flat_map(|trial| force.of(trial)).collect();
    let [low, high] =
        [added.iter().copied().fold(f64::INFINITY, f64::min), added.iter().copied().fold(f64::NEG_INFINITY, f64::max)];
    let along = match force.along {
        Along::Place => "place, as of a cable or a hose that is bent along the way",
        Along::Velocity => "speed, as of water or air around the tool",
    };
    format!(
        "The force sensor shows a force before anything is touched that goes with the {along}: it changes by {} in these recordings.",
        quantity::rounded(high - low, coordinate.force_unit(), 2)
    )
}

/// What a learned curve takes, a `share`, and what it looks like.
fn learned_words(learned: &Learned, outcome: &Outcome, share: f64, coordinate: Coordinate) -> String {
    // No rounding shall make "all" of nearly all.
    let share =
        if share > 0.99 { format!("{:.1}\u{a0}%", 100.0 * share.min(0.999)) } else { quantity::percent(100.0 * share) };
    let left = quantity::rounded(rms(&data(outcome), learned.residual()), coordinate.force_unit(), 3);
    let (along, shape) = match learned {
        Learned::OverDepth(curve) => ("depth and direction", depth_words(curve, outcome, coordinate)),
        Learned::OverSpeed(curve) => ("the speed in contact", speed_words(curve, coordinate)),
    };
    format!(
        " A curve over {along} that is learned from the recordings takes {share} of it on held-out rows and leaves {left}{shape}"
    )
}

/// What a curve over depth and direction looks like: only what stands out of the noise.
fn depth_words(curve: &LearnedCurve, outcome: &Outcome, coordinate: Coordinate) -> String {
    let (force, length) = (coordinate.force_unit(), coordinate.position_unit());
    let shape = curve.shape();
    let notable = (3.0 * outcome.expected_noise).max(LEAST_FEATURE * shape.range);
    let mut text = String::new();
    if let Some(softening) = shape.softening.filter(|softening| softening.fall > notable) {
        let [from, to] = softening.between;
        let (fall, between) = (quantity::rounded(softening.fall, force, 2), quantity::between(from, to, length));
        text.push_str(&format!(": the force falls by {fall} between {between}, as in a click"));
    }
    if let Some(lower) = shape.loop_force.filter(|lower| lower.abs() > notable) {
        let side = if lower > 0.0 { "below" } else { "above" };
        let (joint, by) = (if text.is_empty() { ":" } else { ";" }, quantity::rounded(lower.abs(), force, 2));
        text.push_str(&format!("{joint} the way out lies {by} {side} the way in, in the mean, however slow"));
    }
    let [usual, most] = curve.half_widths().map(|half| quantity::rounded(half, force, 2));
    text + &format!(
        ". The force on the way in is known to ±{usual} at half of the depths and to ±{most} at all (95 %)."
    )
}

/// What a curve over the speed adds at its ends.
fn speed_words(curve: &DampingCurve, coordinate: Coordinate) -> String {
    let force = |value: f64| quantity::rounded(value, coordinate.force_unit(), 2);
    let (fastest, [[inwards, in_half], [outwards, out_half]]) = curve.ends();
    let speed = quantity::rounded(fastest, coordinate.velocity_unit(), 2);
    let depth = if curve.grows_with_depth { " at the greatest depth" } else { "" };
    format!(
        ": beside the refitted damping {} (±{}, 95 %) at {speed} inwards and {} (±{}) outwards{depth}.",
        force(inwards),
        force(in_half),
        force(outwards),
        force(out_half)
    )
}

fn nominal(outcome: &Outcome, rig: &Rig) -> Vec<Nominal> {
    let c = rig.coordinate;
    let Some(contact) = rig.contact else { return Vec::new() };
    let row = |name: &str, unit: &str, given: f64, at: usize| {
        let fitted = outcome.chosen.values[at];
        let ends = if at == index::SURFACE { ends_of_the_surface(outcome) } else { outcome.intervals[at] };
        let ci95 = channel::told(fitted, ends);
        Nominal { name: format!("{name}_{}", slug(unit)), unit: unit.to_owned(), given, fitted, ci95 }
    };
    vec![
        row("stiffness", c.stiffness_unit(), contact.stiffness, index::STIFFNESS),
        row("damping", c.damping_unit(), contact.damping, index::DAMPING),
        row("surface", c.position_unit(), contact.surface, index::SURFACE),
    ]
}

/// The 95 % interval of the surface's place as others measure it. To the force of the law where an encoder began is nothing: that goes by the
/// encoder's own places.
fn ends_of_the_surface(outcome: &Outcome) -> [f64; 2] {
    let steps: Vec<f64> = outcome.trials.iter().map(|trial| trial.figures.position.resolution).collect();
    beside_the_encoders_start(outcome.chosen.values[index::SURFACE], outcome.intervals[index::SURFACE], &steps)
}

/// The `ends` of the interval of a `place` that is fitted to trials whose encoders have these `steps`, with where they began: anywhere within
/// a step, which moves all places of a trial by one error, uniform over it.
fn beside_the_encoders_start(place: f64, [low, high]: [f64; 2], steps: &[f64]) -> [f64; 2] {
    let variances: f64 = steps.iter().map(|step| step * step / 12.0).sum();
    let half = NORMAL_97_5 * variances.sqrt() / steps.len().max(1) as f64;
    [place - (place - low).hypot(half), place + (high - place).hypot(half)]
}

/// Of the values that the report shows.
fn correlations(outcome: &Outcome, rig: &Rig) -> Option<Correlations> {
    let c = rig.coordinate;
    let model = &outcome.chosen.model;
    let nominal = [
        ("stiffness", c.stiffness_unit(), index::STIFFNESS),
        ("damping", c.damping_unit(), index::DAMPING),
        ("surface", c.position_unit(), index::SURFACE),
    ];
    let mut shown: Vec<(String, usize)> = nominal.map(|(name, unit, at)| (format!("{name}_{}", slug(unit)), at)).into();
    for (at, term) in model.terms.iter().enumerate() {
        let first = model.first_value_of(at);
        let names = term.parameters().iter().enumerate();
        shown.extend(names.map(|(offset, parameter)| (format!("{}.{}", term.name(), parameter.name), first + offset)));
    }
    let values = |values: &[f64]| shown.iter().map(|(name, at)| (name.clone(), values[*at])).collect();
    correlation::correlations(CHANNEL, &outcome.chosen.values, &outcome.covariance, &values)
}

/// What limits the answer.
fn findings(outcome: &Outcome, coordinate: Coordinate) -> Vec<Finding> {
    let mut findings = Vec::new();
    let model = &outcome.chosen.model;
    let mut tell = |code: &'static str, place: &str, text: &str| {
        findings.push(Finding { code, grave: false, place: place.to_owned(), text: text.to_owned() });
    };
    if let Some(crosstalk) = outcome.crosstalk {
        let text = format!(
            "{} That beside the plain contact law leaves less than the effects that were fitted in its place. The effort couples into the \
             reading, by its wires, its ground or the frame.",
            coupling(crosstalk)
        );
        tell(summary::EFFORT_IN_FORCE, "force", &text);
    }
    for rival in &outcome.rivals {
        tell("curve_in_place_of_effect", "force", &rival_words(rival));
    }
    if let Some(force) = &outcome.parasitic {
        let text = format!(
            "{} It is the element parasitic_force of the improved rig file, and the contact was judged by the force without it.",
            parasitic_words(force, outcome, coordinate)
        );
        tell(summary::PARASITIC_FORCE, "force", &text);
    }
    if outcome.is_limited_by_rounding {
        tell(
            "quantization_limits_residual",
            "position",
            "One step of the position sensor is worth more force in this contact than the force sensor's noise: a residual below the \
             expected noise is not distinguished from rounding. A finer encoder would show what is below.",
        );
    }
    let leaves = |trial: &ContactTrial| trial.position.iter().any(|x| *x < model.surface(&outcome.chosen.values, 0));
    let relaxes = outcome.named.iter().any(|named| model.terms[named.at].name() == "stress_relaxation");
    if relaxes && !outcome.trials.iter().any(leaves) {
        tell(
            "relaxation_or_force_lag",
            "motion",
            "The tool never leaves the surface: a force sensor that follows slowly (force_lag) would show what is named \
             stress_relaxation here. Record how the force fades after a release.",
        );
    }
    if model.own.surface {
        tell(
            "surface_in_each_trial",
            "surface",
            "The surface lies elsewhere in each trial: it was placed in each for itself.",
        );
    }
    if model.own.zero {
        tell(
            "zero_in_each_trial",
            "force",
            "The force sensor's zero is another one in each trial: it was fitted in each for itself.",
        );
    }
    if model.own.scale {
        tell(
            "stiffness_in_each_trial",
            "force",
            "All forces of a trial differ from the others' by one factor, as at another spot of the same body: it was fitted in each trial for itself.",
        );
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four trials by steps of 0.2 mm: one start is known to 0.0577 mm, the mean of four to half of it, 1.96 of which are 0.0566 mm.
    #[test]
    fn a_place_is_known_no_better_than_where_its_encoder_began() {
        let start = NORMAL_97_5 * 0.2 / 12f64.sqrt() / 2.0;
        let [low, high] = beside_the_encoders_start(3.0, [3.0, 3.0], &[0.2; 4]);
        assert!((low - (3.0 - start)).abs() < 1e-12 && (high - (3.0 + start)).abs() < 1e-12, "{low} {high}");
        let [low, high] = beside_the_encoders_start(3.0, [2.9, 3.2], &[0.2; 4]);
        assert!((3.0 - low - 0.1f64.hypot(start)).abs() < 1e-12 && (high - 3.0 - 0.2f64.hypot(start)).abs() < 1e-12);
        assert_eq!(beside_the_encoders_start(3.0, [2.9, 3.2], &[0.0; 2]), [3.0 - (3.0 - 2.9), 3.0 + (3.2 - 3.0)]);
    }
}
