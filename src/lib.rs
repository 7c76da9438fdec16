//! How stiff and how damped is what a tool touches? `F = K x + B v`, identified sample by sample.
//!
//! `no_std`, no allocation, no panic, bounded work: made to run in the 1 kHz interrupt of a motor drive (Cortex-M4F), and
//! bit for bit the same on a host.
//!
//! ```
//! use palpate::{Identifier, Sample, StreamConfig};
//!
//! let mut identifier = Identifier::recommended(StreamConfig::BENCH)?;
//! # let mut last = None;
//! for k in 0..400 {
//!     // In the interrupt: read the sensors (SI, penetration positive into the surface), then
//!     let t = k as f32 * 1e-3;
//!     let (x, v) = (0.010 + 0.003 * (63.0 * t).sin(), 0.189 * (63.0 * t).cos());
//!     let sample = Sample { position: x, force: 300.0 * x + 5.0 * v, elapsed: 1e-3 };
//!     match identifier.update(sample) {
//!         Ok(estimate) => { /* estimate.impedance, .half_width, .flags */
//! #           last = Some(estimate);
//!         }
//!         Err(rejection) => { /* a bad sample, and why: nothing has changed */
//! #           panic!("{rejection:?}");
//!         }
//!     }
//! }
//! # let K = last.unwrap().impedance.stiffness;
//! # assert!((K / 300.0 - 1.0).abs() < 0.01, "{K}");
//! # Ok::<(), palpate::ConfigError>(())
//! ```
//!
//! # Map
//!
//! | module | what |
//! |---|---|
//! | [`Sample`], [`Impedance`] | the model, its units and signs |
//! | [`FrontEnd`] | penetration, velocity, contact detection; rejection of bad samples |
//! | [`CusumRls`] | **recommended**: recursive, reset where the material changes |
//! | [`Ewrls`], [`Sprls`], [`ResetRls`], [`Gradient`], [`DirectionalRls`] | other recursive laws |
//! | [`BlockLeastSquares`], [`BlockLeastMeanSquare`], [`BlockLeastMeanFourth`] | laws on a window, at the same cost whatever its length |
//! | [`AdaptiveWindow`] | block least squares whose window shrinks where the material changes |
//! | [`ContactModel`], [`ModelStream`], [`ParameterRls`] | Hunt-Crossley, force bias or contact plane, tool mass |
//! | [`direct`] | the same, summed over the window at every sample |
//! | [`Estimate`], [`Flags`] | the estimate and its quality |
//! | [`Identifier`] | front end, window and one law |
//! | [`EstimatorBank`] | all laws side by side |
//!
//! Sensors, faults, calibration and link of a drive are in the crate `palpate-drive`.
//!
//! Equation numbers are those of the paper that compared the laws on a one-degree-of-freedom bench.

#![no_std]
#![forbid(unsafe_code)]

pub mod block;
mod change_detector;
mod contact;
pub mod error;
mod estimator_bank;
pub mod front_end;
mod identifier;
pub mod math;
mod prior;
pub mod quality;
pub mod recursive;
mod stream;
mod update_law;
mod window;

pub use block::direct;
pub use block::{
    AdaptiveWindow, AdaptiveWindowConfig, AdaptiveWindowState, BlockConfig, BlockLaw, BlockLeastMeanFourth,
    BlockLeastMeanSquare, BlockLeastSquares, BlockState, Direction,
};
pub use change_detector::{ChangeConfig, ChangeState};
pub use contact::{Impedance, Observation, Sample};
pub use error::ConfigError;
pub use estimator_bank::{
    BANK_WINDOW, BankEstimates, EstimatorBank, EstimatorBankConfig, Method, Methods, ValidatedBankConfig,
};
pub use front_end::{
    ContactDetectorConfig, ContactDetectorState, ContactModel, Field, FrontEnd, FrontEndConfig, FrontEndState, LowPass,
    LowPassState, MAX_PARAMETERS, ModelStream, Reading, RegressionRow, Rejection, Units, Velocity, contact_plane,
};
pub use identifier::Identifier;
pub use math::sym2::Sym2;
pub use prior::Prior;
pub use quality::{Confidence, Estimate, Flags, IntervalEstimator, SensorResolution, Step, UncertaintyPropagation};
pub use recursive::{
    Covariance, CusumRls, CusumRlsConfig, CusumRlsState, DirectionalRls, DirectionalRlsConfig, DirectionalRlsState,
    Ewrls, EwrlsConfig, Gradient, GradientConfig, GradientState, ParameterRls, ParameterRlsConfig, ParameterState,
    ParameterStep, RecursiveState, ResetRls, ResetRlsConfig, ResetRlsState, Sprls, SprlsConfig, SprlsState,
};
pub use stream::{ContactLoss, EstimatorState, Event, Stream, StreamConfig};
pub use update_law::UpdateLaw;
pub use window::{Recent, Window};

/// The README's example is a test, too.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
