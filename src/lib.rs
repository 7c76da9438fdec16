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
//! | [`FrontEnd`] | penetration, velocity, contact gate; rejection of bad samples |
//! | [`CusumRls`] | **the law to take**: recursive, begins again where the material changes |
//! | [`Ewrls`], [`Sprls`], [`ResetRls`], [`Gradient`], [`DirectionalRls`] | other recursive laws |
//! | [`BlockLeastSquares`], [`BlockLeastMeanSquare`], [`BlockLeastMeanFourth`] | laws on a window, at the same cost whatever its length |
//! | [`AdaptiveWindow`] | block least squares whose window shrinks where the material changes |
//! | [`ContactModel`], [`ModelStream`], [`ParameterRls`] | Hunt-Crossley, force bias or contact plane, tool mass |
//! | [`direct`] | the same, summed anew at every sample |
//! | [`Estimate`], [`Flags`] | the answer and its quality |
//! | [`Identifier`] | all of it for one law |
//! | [`Bench`] | all laws side by side |
//! | [`drive`] | sensors, faults, calibration and link of a real drive |
//!
//! Equation numbers are those of the paper that compared the laws on a one-degree-of-freedom bench.

#![no_std]
#![forbid(unsafe_code)]

mod adaptive_window;
mod bench;
mod block;
mod block_lmf;
mod block_lms;
mod block_ls;
mod change;
mod confidence;
mod contact;
mod contact_model;
mod covariance;
pub mod cubic;
mod cusum_rls;
pub mod direct;
mod direct_lmf;
mod directional_rls;
pub mod drive;
mod error;
mod estimate;
mod ewrls;
pub mod exchange;
mod filter;
mod flags;
mod fourth;
mod front_end;
mod gate;
mod gradient;
mod identifier;
mod law;
pub mod math;
mod memory;
mod model_stream;
mod parameter_rls;
mod prior;
mod propagation;
mod queue;
mod recursive;
mod reset_rls;
mod running;
mod sprls;
mod step;
mod stream;
mod sums;
mod sym2;
mod units;
mod window;

pub use adaptive_window::{AdaptiveWindow, AdaptiveWindowConfig, AdaptiveWindowState};
pub use bench::{BENCH_WINDOW, Bench, BenchConfig, BenchEstimates, Method, Methods};
pub use block::{BlockConfig, BlockLaw, BlockState};
pub use block_lmf::{BlockLeastMeanFourth, Direction};
pub use block_lms::BlockLeastMeanSquare;
pub use block_ls::BlockLeastSquares;
pub use change::{ChangeConfig, ChangeState};
pub use confidence::Confidence;
pub use contact::{Impedance, Observation, Sample};
pub use contact_model::{ContactModel, MOST_PARAMETERS, contact_plane};
pub use covariance::Covariance;
pub use cusum_rls::{CusumRls, CusumRlsConfig, CusumRlsState};
pub use directional_rls::{DirectionalRls, DirectionalRlsConfig, DirectionalRlsState};
pub use error::ConfigError;
pub use estimate::{Assessor, Estimate, Sensors};
pub use ewrls::{Ewrls, EwrlsConfig};
pub use filter::{LowPass, LowPassState};
pub use flags::Flags;
pub use front_end::{Field, FrontEnd, FrontEndConfig, FrontEndState, Reading, Rejection, Velocity};
pub use gate::{GateConfig, GateState};
pub use gradient::{Gradient, GradientConfig, GradientState};
pub use identifier::Identifier;
pub use law::Law;
pub use model_stream::{ModelStream, Row};
pub use parameter_rls::{ParameterRls, ParameterRlsConfig, ParameterState, ParameterStep};
pub use prior::Prior;
pub use propagation::Propagation;
pub use recursive::RecursiveState;
pub use reset_rls::{ResetRls, ResetRlsConfig, ResetRlsState};
pub use sprls::{Sprls, SprlsConfig, SprlsState};
pub use step::Step;
pub use stream::{ContactLoss, Event, Stream, StreamConfig, Tracker};
pub use sym2::Sym2;
pub use units::Units;
pub use window::{Recent, Window};

/// The README's example is a test, too.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// So is that of the drive's page.
#[cfg(doctest)]
#[doc = include_str!("../docs/drive.md")]
struct DrivePage;
