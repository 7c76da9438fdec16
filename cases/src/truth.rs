//! The answers: what a case conceals. In the units of the case, and never among its files.

use serde::{Deserialize, Serialize};

use crate::effect::name::Acts;
use crate::nominal::Nominal;
use crate::reference;
use crate::scale::Scale;
use crate::sensors::{Grade, Sensors};
use crate::world::Source;

/// What a case is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Nothing is concealed.
    None,
    /// One effect of the list.
    Single,
    /// Two effects of the list.
    Pair,
    /// One effect that the list does not hold.
    Outside,
}

/// A true value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrueValue {
    /// What it is.
    pub name: &'static str,
    /// In the units of the case.
    pub value: f64,
    /// Such as "N s/m^2".
    pub unit: &'static str,
}

/// A concealed effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrueEffect {
    /// By the list, or a name of its own outside of it.
    pub name: &'static str,
    /// Where it acts.
    pub acts_in: Acts,
    /// Whether the list holds it.
    pub listed: bool,
    /// The form of its equation.
    pub form: &'static str,
    /// Its values.
    pub parameters: Vec<TrueValue>,
    /// The strength that was asked for.
    pub strength_asked: f64,
    /// The strength that it has, alone: the larger of the two below where the effort is recorded.
    pub strength: f64,
    /// Its residual in the force over the floor.
    pub in_force: f64,
    /// Its residual in the balance of the drive over the floor.
    pub in_effort: f64,
}

/// The answers to one case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Truth {
    /// Whose simulation made it.
    pub source: Source,
    /// Of all cases.
    pub seed: u64,
    /// Of this one.
    pub index: u64,
    /// What it is about.
    pub kind: Kind,
    /// What it conceals.
    pub effects: Vec<TrueEffect>,
    /// The strength of all effects together.
    pub strength: f64,
    /// Error of a reading of the force, RMS.
    pub floor: f64,
    /// Its unit.
    pub floor_unit: &'static str,
    /// The columns besides time.
    pub channels: Vec<&'static str>,
    /// Coarse or fine.
    pub grade: Grade,
    /// The sensors' figures.
    pub sensors: Sensors,
    /// Whether the rig file states them.
    pub sensors_stated: bool,
    /// The true values of the nominal physics.
    pub nominal: Nominal,
    /// The values that the rig file states.
    pub stated: Nominal,
    /// Rich or poor.
    pub reference: reference::Kind,
    /// Size and coordinate.
    pub scale: Scale,
}
