//! The block laws with their window summed anew at every sample, at a cost that grows with it: what the tests hold the
//! laws of constant cost against, and where no more than the window may be remembered.

use crate::block::law::BlockLaw;
use crate::block::least_mean_square::LeastMeanSquare;
use crate::block::least_squares::LeastSquares;
use crate::block::window_sums::DirectSums;

pub use crate::block::direct_least_mean_fourth::{BlockLeastMeanFourth, LineSearch};

/// [`crate::BlockLeastSquares`], summed anew.
pub type BlockLeastSquares = BlockLaw<LeastSquares<DirectSums>>;

/// [`crate::BlockLeastMeanSquare`], summed anew.
pub type BlockLeastMeanSquare = BlockLaw<LeastMeanSquare<DirectSums>>;
