//! Recordings of simulated rigs with concealed physics, to prove a diagnosis on. Nothing is shared with the tool that
//! is proved: another integrator, and the effects in forms of their own.
//!
//! [`draw()`] makes a [`Case`] from a seed: a rig file with nominal values, two trials in a
//! closed loop, and apart from them the [`Truth`]. How large an effect is, is told by its strength: the
//! RMS of what the nominal physics cannot take up, over the floor of the sensor. [`draw_in`] makes the same from the
//! simulations of others: a [`Simulator`] is MuJoCo, Drake or Exudyn.

pub mod bench;
pub mod case;
pub mod chance;
pub mod contact;
pub mod drive;
pub mod effect;
pub mod elsewhere;
pub mod gauge;
pub mod nominal;
pub mod physics;
pub mod plan;
pub mod python;
pub mod recording;
pub mod reference;
pub mod rig;
pub mod rivals;
pub mod scale;
pub mod search;
pub mod sensors;
pub mod simulate;
pub mod strength;
pub mod truth;
pub mod wish;
pub mod world;

pub use case::{Case, draw, draw_in};
pub use elsewhere::Simulator;
pub use truth::Truth;
pub use wish::{What, Wish};
pub use world::{Source, World};
