//! The drive's channel: a stochastic grey box in innovations form.
//!
//! The drive is a continuous-discrete state space model, driven by the recorded effort and contact force and corrected at each encoder
//! row by a Kalman filter; what no law accounts for is a white force whose density is fitted with the values (Madsen, Kristensen,
//! Jorgensen, *Computers and Chemical Engineering* 28, 2004; Ljung, *System Identification*, 1999). Nothing is differentiated and no
//! bandwidth is chosen: quantisation is noise of the measurement, and the smoothed disturbance is the missing force as a signal.
//!
//! [`trial`] and [`input`] are the data, [`law`], [`presliding`] and [`noise`] the equations, [`filter`] gives the [`innovations`] of one body or two,
//! [`model`] and [`term`] are what can be in a law, [`fit`] the likelihood, [`nominal`] the law of the rig file, [`candidates`],
//! [`links`] and [`selection`] the choice with its [`criteria`], [`held_out`] and [`interval`] the evidence, [`outside_force`] the
//! stretches in which something else pushes, and [`outcome`] the answer.

pub mod candidates;
pub mod criteria;
pub mod expected_noise;
pub mod filter;
pub mod fit;
pub mod held_out;
pub mod innovations;
pub mod input;
pub mod interval;
pub mod law;
pub mod links;
pub mod matrix;
pub mod median;
pub mod missing_force;
pub mod model;
pub mod named;
pub mod noise;
pub mod nominal;
pub mod one_body_filter;
pub mod outcome;
pub mod outside_force;
pub mod prepare;
pub mod presliding;
pub mod selection;
pub mod term;
pub mod trial;
pub mod two_body_filter;

#[cfg(test)]
mod testing;
