//! The keys of the rig file whose names carry a unit.

use super::coordinate::Word;

pub const INERTIA: Word = Word::new("mass_kg", "inertia_kg_m2");
pub const VISCOUS: Word = Word::new("viscous_n_s_m", "viscous_n_m_s_rad");
pub const ENCODER: Word = Word::same("encoder");
pub const LOAD_SCALE: Word = Word::same("load_scale");
pub const SURFACE: Word = Word::new("surface_m", "surface_rad");
pub const STIFFNESS: Word = Word::new("stiffness_n_m", "stiffness_n_m_rad");
pub const DAMPING: Word = Word::new("damping_n_s_m", "damping_n_m_s_rad");
pub const POSITION_RESOLUTION: Word = Word::new("position_resolution_m", "position_resolution_rad");
pub const FORCE_RESOLUTION: Word = Word::new("force_resolution_n", "torque_resolution_n_m");
pub const FORCE_NOISE: Word = Word::new("force_noise_n", "torque_noise_n_m");
pub const FORCE_ZERO: Word = Word::new("force_zero_n", "torque_zero_n_m");
pub const PROPORTIONAL: Word = Word::new("proportional_n_m", "proportional_n_m_rad");
pub const DERIVATIVE: Word = Word::new("derivative_n_s_m", "derivative_n_m_s_rad");
pub const DERIVATIVE_FILTER: Word = Word::same("derivative_filter_hz");
pub const EFFORT_SATURATION: Word = Word::new("effort_saturation_n", "effort_saturation_n_m");
pub const RATE: Word = Word::same("rate_hz");
pub const FREE_DEPTH: Word = Word::new("free_depth_m", "free_depth_rad");
pub const CONTACT_DEPTH: Word = Word::new("contact_depth_m", "contact_depth_rad");
pub const PERIOD: Word = Word::same("period_s");
pub const CONTACT_TIME: Word = Word::same("contact_s");
pub const SMOOTHING: Word = Word::same("smoothing_s");
pub const SINE_AMPLITUDE: Word = Word::new("sine_amplitude_m", "sine_amplitude_rad");
pub const SINE_FREQUENCY: Word = Word::same("sine_frequency_hz");
pub const DURATION: Word = Word::same("duration_s");
pub const NAME: Word = Word::same("name");
pub const COORDINATE: Word = Word::same("coordinate");
pub const MODEL: Word = Word::same("model");
pub const BILATERAL: Word = Word::same("bilateral");
pub const COLUMN: Word = Word::same("column");
pub const MOTOR_CONSTANT: Word = Word::new("motor_constant_n_a", "motor_constant_n_m_a");
pub const BACK_EMF: Word = Word::new("back_emf_v_s_m", "back_emf_v_s_rad");
pub const RESISTANCE: Word = Word::same("resistance_ohm");
pub const SUPPLY: Word = Word::same("supply_v");
