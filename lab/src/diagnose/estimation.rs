//! Estimation of a model's values, and what is left of the residual.

pub mod levenberg_marquardt;
pub mod periodogram;
pub mod projection;
pub mod residual_summary;
pub mod residual_tests;
pub mod whitener;
