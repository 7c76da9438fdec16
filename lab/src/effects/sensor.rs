//! What happens between force and reading.

pub mod channel_delay;
pub mod force_bias;
pub mod force_drift;
pub mod force_gain;
pub mod force_lag;
pub mod force_saturation;
pub mod mains_hum;
pub mod parasitic_force;
pub mod tool_inertia;
