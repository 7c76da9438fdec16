//! `palpate reproduce`: the paper's study on a simulated bench, beside the paper's own figures, and what does better.

pub mod bench;
pub mod better;
pub mod estimator;
pub mod force;
pub mod measure;
pub mod models;
pub mod paper;
pub mod rates;
pub mod study;
