//! Phases of contact, row by row.

use schemars::JsonSchema;
use serde::Serialize;

use crate::diagnose::model::Model;
use crate::diagnose::signals::filtered_trial::FilteredTrial;
use crate::diagnose::thresholds::contact_phase::{ANTICIPATION_WIDTHS, HOLD_SPEED_FRACTION, TRANSITION_WIDTHS};

/// Phase of contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Nothing touched.
    Free,
    /// The first moments of a contact.
    Onset,
    /// Going in.
    Loading,
    /// Standing still in contact.
    Hold,
    /// Coming out.
    Unloading,
    /// The last moments of a contact.
    Release,
}

/// The phase of each row of `filtered`, for trial `trial` of `model` with `values`; `speed` is the usual one in contact.
#[must_use]
pub fn phases(model: &Model, values: &[f64], trial: usize, filtered: &FilteredTrial, speed: f64) -> Vec<Phase> {
    let inside = |at: usize| match model.contact {
        None => false,
        Some(bilateral) => bilateral || filtered.position[at] > model.surface(values, trial),
    };
    let moving = |at: usize| {
        let velocity = filtered.velocity[at];
        if velocity.abs() < HOLD_SPEED_FRACTION * speed {
            Phase::Hold
        } else if velocity > 0.0 {
            Phase::Loading
        } else {
            Phase::Unloading
        }
    };
    let mut phases: Vec<Phase> =
        (0..filtered.len()).map(|at| if inside(at) { moving(at) } else { Phase::Free }).collect();
    let (early, late) = (
        (ANTICIPATION_WIDTHS * filtered.filter_width / filtered.step) as usize,
        (TRANSITION_WIDTHS * filtered.filter_width / filtered.step).ceil() as usize,
    );
    let edges: Vec<usize> = (1..filtered.len()).filter(|&at| inside(at) != inside(at - 1)).collect();
    for (nth, &at) in edges.iter().enumerate() {
        let begins = inside(at);
        // An edge ends half-way to the next one: a touch shorter than itself is half onset, half release.
        let next = edges.get(nth + 1).map_or(filtered.len(), |next| (at + next).div_ceil(2));
        let last = if nth == 0 { 0 } else { (edges[nth - 1] + at) / 2 };
        let (from, to) =
            if begins { (at.saturating_sub(early), at + late) } else { (at.saturating_sub(late), at + late) };
        let phase = if begins { Phase::Onset } else { Phase::Release };
        phases[from.max(last)..to.min(next)].fill(phase);
    }
    phases
}

/// Word of a phase.
#[must_use]
pub fn word(phase: Phase) -> &'static str {
    match phase {
        Phase::Free => "free",
        Phase::Onset => "onset",
        Phase::Loading => "loading",
        Phase::Hold => "hold",
        Phase::Unloading => "unloading",
        Phase::Release => "release",
    }
}

/// All of them, in the order in which a contact goes through them.
pub const ALL: [Phase; 6] = [Phase::Free, Phase::Onset, Phase::Loading, Phase::Hold, Phase::Unloading, Phase::Release];

/// Depth of each row, relative to the fitted surface; the position where there is no contact.
#[must_use]
pub fn depths(model: &Model, values: &[f64], trial: usize, filtered: &FilteredTrial) -> Vec<f64> {
    let surface = if model.contact.is_some() { model.surface(values, trial) } else { 0.0 };
    filtered.position.iter().map(|position| position - surface).collect()
}
