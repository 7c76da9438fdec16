//! From recordings and a rig file to the contact's trials and nominal law.

use super::nominal::NominalContact;
use super::trial::ContactTrial;
use crate::effects::Resolved;
use crate::recording::Recording;
use crate::rig::{Coordinate, Rig};
use crate::sensors::Figures;

/// Rows that a law is fitted to, of all trials together: more are taken together in means.
const MOST_ROWS: usize = 45_000;

/// Rows that effects are looked for in.
const COARSE_ROWS: usize = 8_000;

/// Rows of a recording that become one.
fn thinning(rows: usize) -> usize {
    rows.div_ceil(MOST_ROWS).max(1)
}

/// The same for the search.
fn coarse_thinning(rows: usize) -> usize {
    let fine = thinning(rows);
    (rows / fine).div_ceil(COARSE_ROWS).max(1) * fine
}

/// Whether the rig has a contact whose force every trial holds.
#[must_use]
pub fn is_recorded(rig: &Rig, trials: &[Recording]) -> bool {
    rig.contact.is_some() && !trials.is_empty() && trials.iter().all(|trial| trial.force.is_some())
}

/// The trials as laws are fitted to them, and as effects are looked for in them; `figures` are what the sensors leave of each.
#[must_use]
pub fn trials(recordings: &[Recording], figures: &[Figures]) -> [Vec<ContactTrial>; 2] {
    let rows: usize = recordings.iter().map(|trial| trial.time.len()).sum();
    [thinning(rows), coarse_thinning(rows)].map(|every| {
        let pairs = recordings.iter().zip(figures);
        pairs.filter_map(|(recording, figures)| ContactTrial::new(recording, *figures, every)).collect()
    })
}

/// What `rig` says of its contact, with the effects that it already holds.
#[must_use]
pub fn nominal(rig: &Rig, effects: Vec<Resolved>) -> Option<NominalContact> {
    Some(NominalContact {
        contact: rig.contact?,
        force_zero: rig.sensors.force_zero.unwrap_or(0.0),
        is_rotary: rig.coordinate == Coordinate::Rotary,
        effects,
    })
}
