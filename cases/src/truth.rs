//! The true answers of a case, in the units of the case. They are never written among its files.

use serde::{Deserialize, Serialize};

use crate::effect::registry::ActsIn;
use crate::excitation::Excitation;
use crate::nominal::NominalParameters;
use crate::scale::Scale;
use crate::sensors::{SensorGrade, Sensors};
use crate::simulator::SimulatorKind;

/// How many effects a case conceals, and of which list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseKind {
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
pub struct TrueParameter {
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
    pub acts_in: ActsIn,
    /// Whether the list holds it.
    pub listed: bool,
    /// The form of its equation.
    pub form: &'static str,
    /// Its values.
    pub parameters: Vec<TrueParameter>,
    /// The strength that was asked for.
    pub strength_asked: f64,
    /// The strength that it has, alone: the larger of the two below where the effort is recorded.
    pub strength: f64,
    /// RMS residual of the refitted nominal model in the force, over the RMS error of a force reading.
    pub in_force: f64,
    /// The same in the force balance of the drive.
    pub in_effort: f64,
}

/// The answers to one case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Truth {
    /// The simulator that made it.
    pub source: SimulatorKind,
    /// Seed of the run.
    pub seed: u64,
    /// Index of the case within the run.
    pub index: u64,
    /// How many effects, and of which list.
    pub kind: CaseKind,
    /// What it conceals.
    pub effects: Vec<TrueEffect>,
    /// Strength of all effects together.
    pub strength: f64,
    /// RMS error of a force reading.
    pub floor: f64,
    /// Its unit.
    pub floor_unit: &'static str,
    /// The columns besides time.
    pub channels: Vec<&'static str>,
    /// Coarse or fine.
    pub grade: SensorGrade,
    /// Resolution and noise of the sensors.
    pub sensors: Sensors,
    /// Whether the rig file states them.
    pub sensors_stated: bool,
    /// The true values of the nominal physics.
    pub nominal: NominalParameters,
    /// The values that the rig file states.
    pub stated: NominalParameters,
    /// Rich or poor excitation.
    #[serde(rename = "reference")]
    pub excitation: Excitation,
    /// Size and coordinate.
    pub scale: Scale,
}
