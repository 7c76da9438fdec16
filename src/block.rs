//! Laws on a sliding window of samples: block least squares, least mean square and least mean fourth.
//!
//! ```text
//! law  ->  criterion (least squares, least mean square, least mean fourth)
//!   |          |
//!   +----------+-->  sums of a window: of second order, of fourth order
//!                      kept in exact sums, in compensated sums, or summed at each sample (`direct`)
//! ```

mod adaptive_window;
mod centre;
mod compensated_sums;
mod config;
pub mod direct;
mod direct_least_mean_fourth;
mod exact_run;
mod exact_sums;
mod fixed_point;
mod fourth_order;
mod integer_sums;
mod law;
mod least_mean_fourth;
mod least_mean_square;
mod least_squares;
mod scale;
mod second_order;
mod second_use;
mod solution;
mod window_sums;

pub use adaptive_window::{AdaptiveWindow, AdaptiveWindowConfig, AdaptiveWindowState};
pub use config::BlockConfig;
pub use law::{BlockLaw, BlockState};
pub use least_mean_fourth::{BlockLeastMeanFourth, Direction};
pub use least_mean_square::BlockLeastMeanSquare;
pub use least_squares::BlockLeastSquares;
