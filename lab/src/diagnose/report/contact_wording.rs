//! Sentences of what acts in a contact beside the effects of the list.

use super::contact_report::data;
use crate::diagnose::contact::crosstalk::Crosstalk;
use crate::diagnose::contact::free_curve::Curve;
use crate::diagnose::contact::held_out::rms;
use crate::diagnose::contact::learned::{Learned, LearnedCurve};
use crate::diagnose::contact::learned_damping::DampingCurve;
use crate::diagnose::contact::outcome::Outcome;
use crate::diagnose::contact::parasitic_force::{Along, ParasiticForce};
use crate::diagnose::contact::rival_curves::Rival;
use crate::page::quantity;
use crate::rig::Coordinate;

/// Part of the force's range from which a feature of a learned curve is reported.
const LEAST_FEATURE: f64 = 0.02;

/// How the force reading goes with the effort, in a sentence.
pub(super) fn coupling(Crosstalk { part, memory_s }: Crosstalk) -> String {
    let what = if memory_s.is_finite() {
        format!("follows the steps of the drive's effort, forgotten within {},", quantity::rounded(memory_s, "s", 2))
    } else {
        "follows the drive's effort".to_owned()
    };
    format!("The force reading {what} by a factor of {}.", quantity::short(part))
}

/// That a free curve does better than a name, or than the nominal law alone.
pub(super) fn rival_words(rival: &Rival) -> String {
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
pub(super) fn parasitic_words(force: &ParasiticForce, outcome: &Outcome, coordinate: Coordinate) -> String {
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
pub(super) fn learned_words(learned: &Learned, outcome: &Outcome, share: f64, coordinate: Coordinate) -> String {
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
