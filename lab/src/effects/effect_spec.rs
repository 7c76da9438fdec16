//! What is known of an effect, apart from what it does.

use crate::rig::{Coordinate, Word};

/// Where an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// Between tool and environment.
    Contact,
    /// Between command and tool.
    Drive,
    /// Between force and reading.
    Sensor,
}

impl Place {
    /// As the diagnosis spells it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::Drive => "drive",
            Self::Sensor => "sensor",
        }
    }
}

/// When an effect acts among others of its place: in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Moves tool or surface before anything touches.
    Geometry,
    /// Changes the depth that is borne elastically, or the stiffness.
    Depth,
    /// Adds to the force of spring and damper.
    Law,
    /// Remembers what the spring bore, whatever its law.
    Memory,
    /// Changes where the force ends.
    Limit,
    /// Between command and the force on the tool.
    Transmission,
    /// A load that does not ask for the other forces.
    Load,
    /// Friction, which holds whatever is left where the tool stands still.
    Friction,
    /// The force that reaches the sensor.
    Mount,
    /// Gain, lag and delay of the sensor.
    Response,
    /// What is added to the reading.
    Zero,
    /// Where the reading ends.
    Range,
}

/// A parameter of an effect.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// "alpha".
    pub name: &'static str,
    /// Its unit; "1" where it has none.
    pub unit: Word,
    /// What it is.
    pub meaning: &'static str,
    /// Least value that is physical.
    pub low: f64,
    /// Greatest value that is physical.
    pub high: f64,
    /// A convention that is chosen and not fitted, a depth at which something is stated, say.
    pub fixed: bool,
    /// Whether each trial has a value of its own, as a phase has: nobody starts a recording in step with the mains.
    pub each_trial: bool,
    /// What the recording has to show of it.
    pub limit: Limit,
}

/// What a recording has to show of a parameter, beyond the bounds of its card.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// Nothing more.
    BoundsOnly,
    /// A time that is longer than the step of the analysis, below which there is nothing to tell it from, and so short that a part of what
    /// passes with it passes within a recording: else it is a constant.
    ResolvableTime,
    /// The end of a channel's range, which the channel has to have reached.
    ReachedRange,
    /// A frequency that comes round twice within a trial, or it is a drift.
    RepeatedCycles,
    /// A length of at least a step of the encoder, or it is the encoder's rounding.
    ResolvableLength,
    /// A way in the contact that is no longer than the deepest one, or the recording shows its beginning alone.
    VisitedDepth,
    /// An instant of the trial at which the law jumps: between two rows nothing tells one from another.
    InstantOfJump,
    /// A height above the surface at which the law jumps once the tool is that far away from it: between two rows nothing tells one from another.
    HeightOfJump,
}

impl Parameter {
    /// A parameter that is fitted.
    #[must_use]
    pub const fn new(name: &'static str, unit: Word, meaning: &'static str, low: f64, high: f64) -> Self {
        Self { name, unit, meaning, low, high, fixed: false, each_trial: false, limit: Limit::BoundsOnly }
    }

    /// The same within what a recording can show of it.
    #[must_use]
    pub const fn within(self, limit: Limit) -> Self {
        Self { limit, ..self }
    }

    /// A value that each trial has for itself.
    #[must_use]
    pub const fn each_trial(self) -> Self {
        Self { each_trial: true, ..self }
    }

    /// A convention.
    #[must_use]
    pub const fn fixed(name: &'static str, unit: Word, meaning: &'static str) -> Self {
        Self {
            name,
            unit,
            meaning,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
            fixed: true,
            each_trial: false,
            limit: Limit::BoundsOnly,
        }
    }
}

/// One of the laws that an effect can follow.
#[derive(Debug)]
pub struct Form {
    /// "power_law".
    pub name: &'static str,
    /// In the symbols of the parameters.
    pub equation: &'static str,
    /// In the order in which the effect takes them.
    pub parameters: &'static [Parameter],
}

/// What is known of an effect.
#[derive(Debug)]
pub struct EffectSpec {
    /// As the contract spells it.
    pub name: &'static str,
    /// Where it acts.
    pub place: Place,
    /// When it acts there.
    pub stage: Stage,
    /// How often it can be there.
    pub max_instances: usize,
    /// One plain sentence: what a person who has it on the bench would say of it.
    pub statement: &'static str,
    /// Its laws, the simplest first.
    pub forms: &'static [Form],
    /// The motion that makes it show.
    pub excited_by: &'static str,
    /// What it is taken for where the motion is poor.
    pub resembles: &'static [&'static str],
    /// Where the law is from.
    pub source: &'static str,
}

/// A unit as a suffix of a key: "N s/m^2" is `n_s_m2`; empty where there is none.
#[must_use]
pub fn slug(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    unit.chars()
        .filter(|letter| *letter != '^' && *letter != '(' && *letter != ')')
        .map(|letter| if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '_' })
        .collect()
}

/// The key of a parameter in a rig file: `alpha_n_s_m2`.
#[must_use]
pub fn key_of(parameter: &Parameter, coordinate: Coordinate) -> String {
    match slug(coordinate.pick(parameter.unit)).as_str() {
        "" => parameter.name.to_owned(),
        suffix => format!("{}_{suffix}", parameter.name),
    }
}
