//! The block laws with their window summed anew at every sample, at a cost that grows with it: what the tests hold the
//! laws of constant cost against, and where no more than the window may be remembered.

use crate::block::BlockLaw;
use crate::block_lms::LeastMeanSquare;
use crate::block_ls::LeastSquares;
use crate::memory::Anew;

pub use crate::direct_lmf::{BlockLeastMeanFourth, LineSearch};

/// [`crate::BlockLeastSquares`], summed anew.
pub type BlockLeastSquares = BlockLaw<LeastSquares<Anew>>;

/// [`crate::BlockLeastMeanSquare`], summed anew.
pub type BlockLeastMeanSquare = BlockLaw<LeastMeanSquare<Anew>>;
