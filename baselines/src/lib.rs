//! The job of `palpate::Ewrls`, and of least squares over a window, done with other libraries.
//!
//! All of them run `s = lambda + phi'P phi, L = P phi / s, theta += L e, P = (P - L phi'P) / lambda`, as a Kalman filter of a
//! state that stands still and a measurement of variance lambda, its covariance divided by lambda afterwards.

#![no_std]

mod ads;
mod kf;
mod mini;
mod plain;

pub use ads::Adskalman;
pub use kf::Kfilter;
pub use mini::minikalman;
pub use plain::{NalgebraRls, nalgebra_window};

/// Forgetting factor of all.
pub const FORGETTING: f32 = 0.9967;

/// Initial covariance of all.
pub const COVARIANCE: f32 = 10.0;
