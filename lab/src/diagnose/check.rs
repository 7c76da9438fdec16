//! What the recordings themselves show before anything is fitted: faults of clock and sensors, and what the motion
//! leaves undecided.
//!
//! Nothing here compares against an absolute size: every threshold is a share of the trial's own range, noise or clock,
//! or of what the rig file leads one to expect.

mod channel;
mod checked_trial;
mod clock;
mod contact;
mod drive;
mod excitation;
mod finding;
mod held_force;
mod position_steps;
mod ranked_finding;
mod stuck_channel;
mod units;
mod wording;

use crate::diagnose::signals::uniform_trial::UniformTrial;
use crate::recording::Recording;
use crate::rig::Rig;
use checked_trial::CheckedTrial;
pub use finding::Finding;
use ranked_finding::merge_findings;

/// Looks at `recordings`, and at `raws` made of them in the same order, as measurements of `rig`.
///
/// There is at most one finding of a kind and channel: the worst trial is named and the others are counted. The grave ones
/// come first.
#[must_use]
pub fn check(rig: &Rig, recordings: &[Recording], raws: &[UniformTrial]) -> Vec<Finding> {
    let views: Vec<CheckedTrial<'_>> =
        recordings.iter().zip(raws).map(|(recording, raw)| CheckedTrial::new(rig, recording, raw)).collect();
    let mut notes = Vec::new();
    for view in &views {
        notes.extend(stuck_channel::dead(view));
        notes.extend(contact::wrong_sign(rig, view));
        notes.extend(drive::wrong_sign(rig, view));
        notes.extend(units::suspicion(rig, view));
        notes.extend(stuck_channel::stuck(view));
        notes.extend(clock::faults(view));
        notes.extend(position_steps::jumps(view));
        notes.extend(position_steps::coarse(rig, view));
        notes.extend(held_force::held(rig, view));
    }
    notes.extend(contact::reached(rig, &views));
    notes.extend(clock::together(rig, &views));
    notes.extend(excitation::lacking(rig, &views));
    notes.extend(channel::missing(rig, &views));
    merge_findings(notes, recordings)
}
