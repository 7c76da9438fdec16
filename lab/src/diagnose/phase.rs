//! Phases of contact, row by row.

use schemars::JsonSchema;
use serde::Serialize;

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

/// Part of the greatest depth, to either side of the surface, that a contact begins and ends in.
const ONSET_DEPTH_FRACTION: f64 = 0.05;

/// Part of the usual speed in contact below which a tool stands still.
const MAX_HOLD_SPEED_FRACTION: f64 = 0.1;

impl Phase {
    /// Of a row `depth` below the surface at speed `velocity`; `greatest` is the greatest depth, `usual` the usual speed in contact. A
    /// contact that pulls as well has no beginning and no end.
    #[must_use]
    pub fn of(depth: f64, velocity: f64, greatest: f64, usual: f64, bilateral: bool) -> Self {
        let stands = velocity.abs() < MAX_HOLD_SPEED_FRACTION * usual;
        if !bilateral && depth.abs() < ONSET_DEPTH_FRACTION * greatest && !stands {
            return if velocity > 0.0 { Self::Onset } else { Self::Release };
        }
        if !bilateral && depth <= 0.0 {
            return Self::Free;
        }
        match (stands, velocity > 0.0) {
            (true, _) => Self::Hold,
            (false, true) => Self::Loading,
            (false, false) => Self::Unloading,
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_goes_through_its_phases_and_a_clamped_one_is_never_free() {
        let of = |depth, velocity| Phase::of(depth, velocity, 1.0, 1.0, false);
        let way =
            [(-0.5, 0.5), (-0.01, 0.5), (0.01, 0.5), (0.5, 0.5), (1.0, 0.01), (0.5, -0.5), (0.02, -0.5), (-0.5, -0.5)];
        let seen: Vec<Phase> = way.iter().map(|(depth, velocity)| of(*depth, *velocity)).collect();
        let wanted = [
            Phase::Free,
            Phase::Onset,
            Phase::Onset,
            Phase::Loading,
            Phase::Hold,
            Phase::Unloading,
            Phase::Release,
            Phase::Free,
        ];
        assert_eq!(seen, wanted);
        assert_eq!(Phase::of(-0.5, -0.5, 1.0, 1.0, true), Phase::Unloading);
        assert_eq!(Phase::of(0.0, 0.0, 1.0, 1.0, true), Phase::Hold);
    }
}
