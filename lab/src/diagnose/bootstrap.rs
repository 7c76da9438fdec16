//! Simulated replicas of the recording (parametric bootstrap): the expected noise, bias, spread and null distributions.

pub mod fitted_model;
pub mod null_distribution;
pub mod problem;
pub mod sampler;
