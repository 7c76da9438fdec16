//! The estimate as the user gets it, and how sure it is.

mod confidence;
mod estimate;
mod flags;
mod propagation;
mod step;

pub use confidence::Confidence;
pub use estimate::{Assessor, Estimate, Sensors};
pub use flags::Flags;
pub(crate) use propagation::MEMORY;
pub use propagation::Propagation;
pub use step::Step;
