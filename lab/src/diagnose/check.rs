//! What the recordings themselves show before anything is fitted: faults of clock and sensors, and what the motion
//! leaves undecided.
//!
//! Nothing here compares against an absolute size: every threshold is a share of the trial's own range, noise or clock,
//! or of what the rig file leads one to expect.

mod channel;
mod clock;
mod drive;
mod finding;
mod motion;
mod note;
mod step;
mod still;
mod touch;
mod unit;
mod view;
mod words;

use crate::diagnose::signals::uniform_trial::Raw;
use crate::recording::Recording;
use crate::rig::Rig;
pub use finding::Finding;
use note::gather;
use view::View;

/// Looks at `recordings`, and at `raws` made of them in the same order, as measurements of `rig`.
///
/// There is at most one finding of a kind and channel: the worst trial is named and the others are counted. The grave ones
/// come first.
#[must_use]
pub fn check(rig: &Rig, recordings: &[Recording], raws: &[Raw]) -> Vec<Finding> {
    let views: Vec<View<'_>> =
        recordings.iter().zip(raws).map(|(recording, raw)| View::new(rig, recording, raw)).collect();
    let mut notes = Vec::new();
    for view in &views {
        notes.extend(still::dead(view));
        notes.extend(touch::wrong_sign(rig, view));
        notes.extend(drive::wrong_sign(rig, view));
        notes.extend(unit::suspicion(rig, view));
        notes.extend(still::stuck(view));
        notes.extend(clock::faults(view));
        notes.extend(step::jumps(view));
        notes.extend(step::coarse(rig, view));
    }
    notes.extend(touch::reached(rig, &views));
    notes.extend(clock::together(rig, &views));
    notes.extend(motion::lacking(rig, &views));
    notes.extend(channel::missing(rig, &views));
    gather(notes, recordings)
}
