//! Channels that are not there, and what cannot be seen without them.

use super::checked_trial::CheckedTrial;
use super::ranked_finding::RankedFinding;
use crate::recording::Recording;
use crate::rig::Rig;

/// What is missing over all trials.
pub fn missing(rig: &Rig, views: &[CheckedTrial<'_>]) -> Vec<RankedFinding> {
    let lacks = |has: fn(&Recording) -> bool| views.iter().filter(|view| !has(view.recording)).collect::<Vec<_>>();
    let force = lacks(|recording| recording.force.is_some());
    let effort = lacks(|recording| recording.effort.is_some());
    let velocity = views.iter().find(|view| view.recording.velocity.is_some());
    let force = absent(
        &force,
        views.len(),
        ("missing_force", "force"),
        rig.contact.is_some(),
        "[contact]",
        "the contact and the force sensor cannot be seen",
    );
    let effort = absent(
        &effort,
        views.len(),
        ("missing_effort", "effort"),
        rig.drive.is_some(),
        "[drive]",
        "the gain of the force sensor and what acts in the drive cannot be seen",
    );
    let unused = velocity.map(|view| {
        let text = "The measured velocity is not used: speed is taken from the position, through the same filter as every other channel.";
        RankedFinding::mild("unused_velocity", format!("{}, velocity", view.name()), 0.0, text)
    });
    [force, effort, unused].into_iter().flatten().collect()
}

fn absent(
    lacking: &[&CheckedTrial<'_>],
    trials: usize,
    (code, name): (&'static str, &str),
    is_known: bool,
    table: &str,
    lost: &str,
) -> Option<RankedFinding> {
    match (lacking.first(), is_known) {
        (Some(_), _) if lacking.len() == trials => {
            Some(RankedFinding::mild(code, "", 0.0, format!("No {name} was recorded: {lost}.")))
        }
        (Some(view), _) => {
            let text = format!(
                "This trial has no {name} while others have: {lost} unless every trial has it. Diagnose such trials by themselves."
            );
            Some(RankedFinding::mild(code, view.name(), 0.0, text))
        }
        (None, false) => {
            let text = format!(
                "The {name} was recorded, but the rig file has no {table} table: {lost}. Add the table with nominal values."
            );
            Some(RankedFinding::mild(code, "", 0.0, text))
        }
        (None, true) => None,
    }
}
