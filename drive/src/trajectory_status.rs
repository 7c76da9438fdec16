//! Where a trajectory stands, and why it ended.

use serde::{Deserialize, Serialize};

/// Where a run stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum TrajectoryState {
    /// Nothing was prepared.
    #[default]
    Idle,
    /// Prepared, not started: no effort.
    Prepared,
    /// Being followed.
    Running,
    /// The last reference was reached.
    Finished,
    /// Ended before.
    Stopped(StopReason),
}

/// Why a run ended before its last reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StopReason {
    /// The host asked for it.
    Requested,
    /// The depth left its range.
    Depth,
    /// The speed passed its limit.
    Speed,
    /// The force passed its limit.
    Force,
    /// A fault of the drive, or a tick without a good sample.
    Fault,
    /// No request of the host for longer than the timeout.
    Silence,
    /// The queue of references ran dry.
    Underrun,
    /// A reference that is no number.
    Reference,
}

/// Where a run stands, and how far it came.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct TrajectoryStatus {
    /// Where it stands.
    pub state: TrajectoryState,
    /// References that were followed.
    pub played: u32,
}
