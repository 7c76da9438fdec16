//! Recorded signals: onto one clock, out of their steps, through one filter.

pub mod dequantize;
pub mod derivative_filter;
pub mod mains_tone;
pub mod outliers;
pub mod pauses;
pub mod prepare;
pub mod uniform_trial;
