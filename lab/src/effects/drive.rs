//! What happens between command and tool.

pub mod backlash;
pub mod cogging;
pub mod coulomb_friction;
pub mod effort_lag;
pub mod effort_saturation;
pub mod gravity_load;
pub mod load_dependent_friction;
pub mod stribeck_friction;
pub mod sublinear_friction;
pub mod transmission_compliance;
mod two_mass_link;
