//! The estimate as the user gets it, and how sure it is.

mod confidence;
mod estimate;
mod flags;
mod propagation;
mod step;

pub use confidence::Confidence;
pub use estimate::{Estimate, IntervalEstimator, SensorResolution};
pub use flags::Flags;
pub(crate) use propagation::DEFAULT_FORGETTING;
pub use propagation::UncertaintyPropagation;
pub use step::Step;
