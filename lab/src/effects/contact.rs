//! What happens between tool and environment.

pub mod adhesion;
pub mod environment_mass;
pub mod hunt_crossley_damping;
pub mod hysteresis;
pub mod layered_stiffness;
pub mod learned;
pub mod learned_damping;
pub mod lost_motion;
pub mod nonlinear_stiffness;
pub mod plastic_set;
pub mod quadratic_damping;
pub mod stress_relaxation;
pub mod surface_motion;
pub mod time_varying_stiffness;
