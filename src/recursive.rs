//! Recursive laws: each sample moves the estimate, and no window is kept.

mod covariance;
mod cusum_rls;
mod directional_rls;
mod ewrls;
mod gradient;
mod parameter_rls;
mod reset_rls;
mod sprls;
mod state;

pub use covariance::Covariance;
pub use cusum_rls::{CusumRls, CusumRlsConfig, CusumRlsState};
pub use directional_rls::{DirectionalRls, DirectionalRlsConfig, DirectionalRlsState};
pub use ewrls::{Ewrls, EwrlsConfig};
pub use gradient::{Gradient, GradientConfig, GradientState};
pub use parameter_rls::{ParameterRls, ParameterRlsConfig, ParameterState, ParameterStep};
pub use reset_rls::{ResetRls, ResetRlsConfig, ResetRlsState};
pub use sprls::{Sprls, SprlsConfig, SprlsState};
pub use state::RecursiveState;
