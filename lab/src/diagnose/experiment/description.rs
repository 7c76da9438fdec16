//! What an experiment is and what it would show, in plain words.

use super::discrepancy::Discrepancy;
use super::separating_experiment::{is_equivalent, separated_by};
use super::synthetic_rig::SyntheticRig;
use super::{DECISIVE_CHI2, InformationRate, TriedMotion};
use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::model::{Model, Term};
use crate::diagnose::thresholds::experiment_description::{IDEAL_SENSOR_RATIO, MIN_RATE, MIN_RMS_OVER_NOISE};
use crate::page::quantity::{rounded, seconds};

/// The text of an experiment.
pub(super) fn text(
    problem: &IdentificationProblem,
    bench: &SyntheticRig<'_>,
    best: &TriedMotion,
    wider: &[bool],
    worth: InformationRate,
    answer: &Model,
    rivals: &[(&Model, &[f64])],
) -> String {
    let unit = if problem.is_rotary { "N m" } else { "N" };
    let length = seconds(best.motion.course.seconds());
    let terms = rivals.iter().map(|(rival, _)| differ(answer, rival));
    let mut text = if best.least(wider) < DECISIVE_CHI2 {
        format!(
            "No motion within what the recordings did tells them apart for certain. The best found: {}, {length} in all.",
            best.motion.what
        )
    } else {
        format!(
            "Run {}: {length} in all, never deeper, farther, quicker or harder accelerated than the recordings were.",
            best.motion.what
        )
    };
    for (pair, (left, reverse)) in terms.zip(best.left.iter().zip(&best.reverse)) {
        text.push(' ');
        text.push_str(&sentence(bench, pair, left, reverse, unit));
    }
    if best.least(wider) >= DECISIVE_CHI2 && worth.recorded > MIN_RATE && worth.designed > 1.5 * worth.recorded {
        let times = rounded(worth.designed / worth.recorded, "1", 2);
        text.push_str(&format!(" A second of it tells {times} times as much as one of the recordings."));
    }
    text
}

/// What would be seen of one pair, under either truth.
fn sentence(
    bench: &SyntheticRig<'_>,
    pair: (Option<Term>, Option<Term>),
    left: &Discrepancy,
    reverse: &Discrepancy,
    unit: &str,
) -> String {
    let name = |term: Option<Term>| term.map_or("the answer", |term| term.name());
    let (answer, rival) = (name(pair.0), name(pair.1));
    // The channel in which either fails by more of its expected noise.
    let over = |effort: bool| {
        let worse = if effort { left.effort.max(reverse.effort) } else { left.force.max(reverse.force) };
        bench.noise_model(effort).map_or(0.0, |noise_model| worse / noise_model)
    };
    let effort = over(true) > over(false);
    let channel = if effort { "drive's balance" } else { "force" };
    let noise_model = bench.noise_model(effort).unwrap_or(0.0);
    let size = |rest: &Discrepancy| match if effort { rest.effort } else { rest.force } {
        rest if rest < MIN_RMS_OVER_NOISE * noise_model => "too little to see".into(),
        rest => format!("{} rms", rounded(rest, unit, 2)),
    };
    let noise = match noise_model {
        noise_model if noise_model < IDEAL_SENSOR_RATIO * bench.greatest(effort) => "next to none".into(),
        noise_model => rounded(noise_model, unit, 2),
    };
    let observed = format!(
        "If it is {answer}, a refitted {rival} misses the {channel} by {}; if it is {rival}, a refitted {answer} misses it \
         by {} (the noise is {noise}).",
        size(left),
        size(reverse)
    );
    if left.energy.max(reverse.energy) >= DECISIVE_CHI2 {
        return observed;
    }
    match pair {
        (Some(answer), Some(rival)) if is_equivalent(&answer, &rival) => {
            format!("{observed} {}", separated_by(&answer, &rival))
        }
        _ => format!("{observed} That is too little: {}.", bench.wanted()),
    }
}

/// The effect of `answer` that `rival` lacks, and the one that it has instead.
fn differ(answer: &Model, rival: &Model) -> (Option<Term>, Option<Term>) {
    let lacks = |model: &Model, term: &Term| {
        model.terms.iter().all(|other| (other.name(), other.form) != (term.name(), term.form))
    };
    let only = |of: &Model, other: &Model| of.terms.iter().copied().find(|term| lacks(other, term));
    (only(answer, rival), only(rival, answer))
}
