//! The drive's channel: a stochastic grey box in innovations form.
//!
//! The drive is a continuous-discrete state space model, driven by the recorded effort and contact force and corrected at each encoder
//! row by a Kalman filter; what no law accounts for is a white force whose density is fitted with the values (Madsen, Kristensen,
//! Jorgensen, *Computers and Chemical Engineering* 28, 2004; Ljung, *System Identification*, 1999). Nothing is differentiated and no
//! bandwidth is chosen: quantisation is noise of the measurement, and the smoothed disturbance is the missing force as a signal.
//!
//! [`trial`] and [`input`] are the data, [`denoised`] by a [`wiener_filter`] where noise in them does not drive; [`law`], [`dry_friction`],
//! [`course`], [`curve`], [`presliding`], [`viscous_motion`], [`two_mass_system`] and [`noise`] the equations.
//! [`filter`] gives the [`innovations`] of one body or two. [`model`] and [`term`] are what can be in a law, with the [`range`] of each
//! value in the recordings' [`scales`]; [`likelihood`] judges them, and [`fit`] finds the likeliest by [`levenberg_marquardt`] and
//! [`noise_search`]. [`nominal`] is the law of the rig file; [`candidates`] on a [`sample`] of the rows, by [`growth`], [`links`] and
//! [`selection`] choose what stands beside it by its [`worth`] and the [`criteria`]. [`held_out`] by [`halves`], [`interval`], [`validation`], [`lack_of_fit`], [`tone`],
//! [`noise_at_rest`], [`asymmetric_friction`] and [`alternatives`] are the evidence, of which
//! [`judgement`] makes the [`outcome`]; [`outside_force`] finds stretches in which something else pushes, and [`identification`] is the
//! way from trials to the answer.

pub mod alternatives;
pub mod asymmetric_friction;
pub mod candidates;
pub mod course;
pub mod criteria;
pub mod curve;
pub mod denoised;
pub mod dry_friction;
pub mod effort_limit;
pub mod expected_noise;
pub mod filter;
pub mod fit;
pub mod growth;
pub mod halves;
pub mod held_out;
pub mod identification;
pub mod innovations;
pub mod input;
pub mod interval;
pub mod judgement;
pub mod lack_of_fit;
pub mod law;
pub mod levenberg_marquardt;
pub mod likelihood;
pub mod linearisation;
pub mod links;
pub mod load_share;
pub mod matrix;
pub mod missing_force;
pub mod model;
pub mod named;
pub mod noise;
pub mod noise_at_rest;
pub mod noise_search;
pub mod nominal;
pub mod one_body_filter;
pub mod order_lines;
pub mod order_spectrum;
pub mod outcome;
pub mod outside_force;
mod outside_tone;
pub mod prepare;
pub mod presliding;
pub mod pruning;
pub mod range;
pub mod ripples;
pub mod rival_shapes;
pub mod sample;
pub mod scales;
pub mod selection;
pub mod shapes;
pub mod term;
pub mod tone;
pub mod trial;
pub mod two_body_filter;
pub mod two_body_smoother;
pub mod two_mass_motion;
pub mod two_mass_system;
pub mod validation;
pub mod viscous_motion;
pub mod wiener_filter;
pub mod worth;

#[cfg(test)]
mod testing;
