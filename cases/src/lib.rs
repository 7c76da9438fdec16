//! Recordings of simulated rigs with concealed physics, to test a diagnosis. Nothing is shared with the tool under
//! test: another integrator, and the effects in equations of their own.
//!
//! [`draw()`] makes a [`Case`] from a seed: a rig file with nominal values, two closed-loop trials, and apart from them the
//! [`Truth`]. The strength of an effect is the RMS residual of the refitted nominal model over the RMS error of the force
//! sensor. [`draw_in`] makes the same with another simulator: an [`ExternalSimulator`] is MuJoCo, Drake or Exudyn.
//!
//! Modules depend on one another in one direction: `physics` (equations and state) knows no random numbers, `effect` (how the
//! parameters of an effect are drawn) knows `physics`, and `simulator` knows both.

pub mod baselines;
pub mod case;
pub mod case_request;
pub mod case_spec;
pub mod closed_loop;
pub mod concealed_rig;
pub mod effect;
pub mod excitation;
pub mod external_simulators;
pub mod nominal;
pub mod physics;
pub mod python;
pub mod recorded_trial;
pub mod rig_file;
pub mod rng;
pub mod scale;
pub mod sensors;
pub mod simulator;
pub mod size_search;
pub mod strength;
pub mod test_rig;
pub mod truth;

pub use case::{Case, draw, draw_in};
pub use case_request::{CaseRequest, EffectSelection};
pub use concealed_rig::{ConcealedRig, Excursion};
pub use external_simulators::ExternalSimulator;
pub use simulator::{Simulator, SimulatorKind};
pub use truth::Truth;
