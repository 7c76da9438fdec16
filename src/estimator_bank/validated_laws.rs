//! The laws of all methods with settings that are checked, as they are carried to where the laws run.

use crate::block::{AdaptiveWindow, BlockLeastMeanFourth, BlockLeastMeanSquare, BlockLeastSquares};
use crate::recursive::{CusumRls, DirectionalRls, Ewrls, Gradient, ResetRls, Sprls};

/// One law of each kind without its state.
#[derive(Debug, Clone, Copy)]
pub struct ValidatedLaws {
    pub rls: Ewrls,
    pub ewrls: Ewrls,
    pub sprls: Sprls,
    pub reset_rls: ResetRls,
    pub gradient: Gradient,
    pub bls: BlockLeastSquares,
    pub blms: BlockLeastMeanSquare,
    pub blmf: BlockLeastMeanFourth,
    pub newton_blmf: BlockLeastMeanFourth,
    pub cusum_rls: CusumRls,
    pub adaptive_bls: AdaptiveWindow,
    pub directional_rls: DirectionalRls,
}
