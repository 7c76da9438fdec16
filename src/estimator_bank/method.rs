//! The estimators by name.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// An estimator by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[repr(u8)]
pub enum Method {
    /// Recursive least squares.
    Rls,
    /// Exponentially weighted recursive least squares.
    Ewrls,
    /// Self-perturbing recursive least squares.
    Sprls,
    /// Recursive least squares with covariance resetting.
    ResetRls,
    /// Constant-gain gradient law.
    Gradient,
    /// Block least squares.
    Bls,
    /// Block least mean square.
    Blms,
    /// Block least mean fourth along the steepest descent.
    Blmf,
    /// Block least mean fourth along the Newton direction.
    NewtonBlmf,
    /// Recursive least squares that begins again at a change.
    CusumRls,
    /// Block least squares over a window that shrinks at a change.
    AdaptiveBls,
    /// Recursive least squares with directional forgetting.
    DirectionalRls,
}

impl Method {
    /// All of them, in the order of [`BankEstimates`](crate::BankEstimates).
    pub const ALL: [Self; 12] = [
        Self::Rls,
        Self::Ewrls,
        Self::Sprls,
        Self::ResetRls,
        Self::Gradient,
        Self::Bls,
        Self::Blms,
        Self::Blmf,
        Self::NewtonBlmf,
        Self::CusumRls,
        Self::AdaptiveBls,
        Self::DirectionalRls,
    ];

    /// The name on the command line and in file columns.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rls => "rls",
            Self::Ewrls => "ewrls",
            Self::Sprls => "sprls",
            Self::ResetRls => "reset_rls",
            Self::Gradient => "gradient",
            Self::Bls => "bls",
            Self::Blms => "blms",
            Self::Blmf => "blmf",
            Self::NewtonBlmf => "newton_blmf",
            Self::CusumRls => "cusum_rls",
            Self::AdaptiveBls => "adaptive_bls",
            Self::DirectionalRls => "directional_rls",
        }
    }

    /// The full name.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Rls => "recursive least squares",
            Self::Ewrls => "exponentially weighted recursive least squares",
            Self::Sprls => "self-perturbing recursive least squares",
            Self::ResetRls => "recursive least squares with covariance resetting",
            Self::Gradient => "constant-gain gradient law",
            Self::Bls => "block least squares",
            Self::Blms => "block least mean square",
            Self::Blmf => "block least mean fourth",
            Self::NewtonBlmf => "block least mean fourth, Newton direction",
            Self::CusumRls => "recursive least squares that begins again at a change",
            Self::AdaptiveBls => "block least squares, window shrinking at a change",
            Self::DirectionalRls => "recursive least squares with directional forgetting",
        }
    }

    pub(super) const fn bit(self) -> u16 {
        1 << self as u8
    }
}
