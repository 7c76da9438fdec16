//! Recorded signals: onto one clock, out of their steps, through one filter.

pub mod bandwidth;
pub mod dequantize;
pub mod derivative_filter;
pub mod filtered_trial;
pub mod mains_tone;
pub mod prepare;
pub mod uniform_trial;
