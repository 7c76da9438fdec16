//! The trial that tells the answer of a diagnosis from its alternatives.

use super::questions::questions;
use crate::diagnose::Found;
use crate::diagnose::report::diagnosis::{Experiment, Physics};
use crate::experiment_design::discrimination::Noise;
use crate::experiment_design::explanation::{UNKNOWN, explanations};
use crate::experiment_design::loop_model::LoopModel;
use crate::experiment_design::planner::{DECISIVE_ENERGY, Situation};
use crate::experiment_design::{Explanation, Limits, Question, plan};
use crate::recording::Recording;
use crate::rig::Rig;

/// The answer of `found` and its alternatives as rigs.
#[must_use]
pub fn explanations_of(
    found: &Found,
    trials: &[Recording],
    closed_loop: &LoopModel,
    noise: &Noise,
) -> Vec<Explanation> {
    let names = found.answer.physics.iter().map(|physics| physics.name.clone()).filter(|name| name != UNKNOWN);
    let answer = Explanation { physics: names.collect(), rig: found.improved.clone() };
    let names = |of: &[String]| of.iter().cloned().collect::<std::collections::BTreeSet<String>>();
    let known = |rig: &Rig| names(&rig.effects.iter().map(|table| table.name.clone()).collect::<Vec<_>>());
    // The contact's alternatives come with fitted rigs of their own.
    let (mut fitted, mut open) = (Vec::new(), Vec::new());
    for alternative in
        found.answer.alternatives.iter().filter(|other| !is_the_same_law(&found.answer.physics, &other.physics))
    {
        let wanted = names(&alternative.physics);
        let own = found.alternatives.iter().find(|rig| wanted.is_subset(&known(rig)));
        match own {
            Some(rig) => fitted.push(Explanation { physics: alternative.physics.clone(), rig: rig.clone() }),
            None => open.push(alternative.physics.clone()),
        }
    }
    let mut all = explanations(answer, &open, trials, closed_loop, noise);
    all.extend(fitted);
    all
}

/// Whether `alternative` is dry friction of one level beside a constant load where the `answer` is friction of two levels: the same force in every motion.
fn is_the_same_law(answer: &[Physics], alternative: &[String]) -> bool {
    let has_two_levels = |physics: &Physics| physics.parameters.iter().any(|value| value.name == "forward_level");
    let has = |name: &str| alternative.iter().any(|other| other == name);
    answer.iter().any(|physics| physics.name == "coulomb_friction" && has_two_levels(physics))
        && answer.iter().all(|physics| physics.name != "gravity_load")
        && has("coulomb_friction")
        && has("gravity_load")
}

/// Expected noise of each channel, no less than what `found` leaves in it.
#[must_use]
pub fn noise(rig: &Rig, trials: &[Recording], found: &Found) -> Noise {
    let residual = |channel: &str| {
        let of = found.answer.channels.iter().find(|fit| fit.channel == channel);
        of.map_or(0.0, |fit| if fit.improved.is_finite() { fit.improved } else { 0.0 })
    };
    Noise::of(rig, trials, [residual("force"), residual("effort")])
}

/// The trial that best tells the answer of `found` from its alternatives, within what `trials` did; `None` where there is no alternative,
/// or no motion tells anything.
#[must_use]
pub fn separating_trial(rig: &Rig, found: &Found, trials: &[Recording]) -> Option<Experiment> {
    let limits = Limits::of_recordings(trials)?;
    let closed_loop = LoopModel::new(rig, trials);
    let noise = noise(rig, trials, found);
    let explanations = explanations_of(found, trials, &closed_loop, &noise);
    let open = questions(found, &explanations)
        .into_iter()
        .filter(|(question, _)| matches!(question, Question::Alternative(_)));
    let (questions, words): (Vec<Question>, Vec<String>) = open.unzip();
    if questions.is_empty() {
        return None;
    }
    let (explanations, questions) = (&explanations, &questions);
    let situation =
        Situation { explanations, questions, trials, limits: &limits, noise, closed_loop, ease: 1.0, searches: false };
    let plan = plan(&situation)?;
    let answered = words.iter().zip(&plan.expected).map(|(words, energy)| {
        let enough = if *energy >= DECISIVE_ENERGY { "it decides" } else { "too little to decide for certain" };
        format!("{words}: {enough}")
    });
    let text = format!(
        "{}. It goes no farther, quicker or harder than the recordings did. What it is expected to tell: {}.",
        capitalized(&plan.motions.join("; then ")),
        answered.collect::<Vec<_>>().join("; "),
    );
    let time = (0..plan.reference.len()).map(|row| row as f64 / closed_loop.rate_hz).collect();
    Some(Experiment { text, time, reference: plan.reference })
}

/// `text` with its first letter in upper case.
#[must_use]
pub fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::report::diagnosis::{Evidence, Value};

    fn physics(name: &str, parameters: &[&str]) -> Physics {
        let value =
            |name: &&str| Value { name: (*name).to_owned(), value: 1.0, unit: "N".to_owned(), ci95: [0.9, 1.1] };
        Physics {
            name: name.to_owned(),
            acts_in: "drive",
            channel: "effort",
            statement: String::new(),
            equation: String::new(),
            evidence: Evidence { held_out_gain: 0.9, p_value: 1e-9 },
            parameters: parameters.iter().map(value).collect(),
            on_drive: None,
        }
    }

    /// No trial is designed to tell apart what responds alike under every motion.
    #[test]
    fn friction_of_two_levels_is_friction_beside_a_load_and_no_other_alternative_is() {
        let two = [physics("coulomb_friction", &["forward_level", "backward_level"])];
        let one = [physics("coulomb_friction", &["level"])];
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let both = names(&["gravity_load", "coulomb_friction"]);
        assert!(is_the_same_law(&two, &both));
        assert!(!is_the_same_law(&one, &both));
        assert!(!is_the_same_law(&two, &names(&["cogging", "coulomb_friction"])));
        assert!(!is_the_same_law(&two, &names(&["gravity_load", "stribeck_friction"])));
    }
}
