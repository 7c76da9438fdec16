//! `[effort]`: how a drive's effort arises from what was recorded, where the effort itself was not.

use super::coordinate::Word;
use super::table::{Range, Table};
use super::words;
use crate::error::InputError;

/// The effort at the tool, from other columns. The constants are nominal.
#[derive(Debug, Clone, PartialEq)]
pub enum EffortLaw {
    /// effort = motor constant x current, voltage or duty behind a winding.
    Motor {
        /// What is recorded of the motor.
        input: MotorInput,
        /// Its column.
        column: String,
        /// N/A or N m/A at the tool, through the transmission.
        motor_constant: f64,
    },
    /// effort = proportional (reference - position) + derivative d/dt (reference - position).
    ProportionalDerivative {
        /// N/m or N m/rad.
        proportional: f64,
        /// N s/m or N m s/rad.
        derivative: f64,
    },
}

/// What is recorded of a motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotorInput {
    /// Amperes.
    Current,
    /// Volts at the winding: current = (voltage - back_emf v) / resistance.
    Voltage {
        /// V s/m or V s/rad at the tool.
        back_emf: f64,
        /// Ohm, above zero.
        resistance: f64,
    },
    /// Share of a supply, -1 to 1: voltage = duty x supply.
    Duty {
        /// V s/m or V s/rad at the tool.
        back_emf: f64,
        /// Ohm, above zero.
        resistance: f64,
        /// V, above zero.
        supply: f64,
    },
}

impl EffortLaw {
    /// As the rig file spells the model.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Motor { input: MotorInput::Current, .. } => "current",
            Self::Motor { input: MotorInput::Voltage { .. }, .. } => "voltage",
            Self::Motor { input: MotorInput::Duty { .. }, .. } => "duty",
            Self::ProportionalDerivative { .. } => "pd",
        }
    }

    /// The recorded input of the motor and its column, `None` for a control law.
    #[must_use]
    pub fn input(&self) -> Option<(MotorInput, &str)> {
        match self {
            Self::Motor { input, column, .. } => Some((*input, column)),
            Self::ProportionalDerivative { .. } => None,
        }
    }

    /// Whether the law needs the velocity.
    #[must_use]
    pub fn needs_velocity(&self) -> bool {
        !matches!(self, Self::Motor { input: MotorInput::Current, .. })
    }

    /// The effort of one row: `input` is the motor's input or reference - position, `reference_rate` the reference's velocity.
    #[must_use]
    pub fn effort(&self, input: f64, velocity: f64, reference_rate: f64) -> f64 {
        match self {
            Self::Motor { input: kind, motor_constant, .. } => motor_constant * kind.current(input, velocity),
            Self::ProportionalDerivative { proportional, derivative } => {
                proportional * input + derivative * (reference_rate - velocity)
            }
        }
    }

    /// The keys of the constants with their values.
    pub(super) fn constants(&self) -> [(Word, Option<f64>); 6] {
        let (mut motor, mut emf, mut ohm, mut volt, mut gains) = (None, None, None, None, [None, None]);
        match self {
            Self::Motor { input, motor_constant, .. } => {
                motor = Some(*motor_constant);
                match input {
                    MotorInput::Current => {}
                    MotorInput::Voltage { back_emf, resistance } => (emf, ohm) = (Some(*back_emf), Some(*resistance)),
                    MotorInput::Duty { back_emf, resistance, supply } => {
                        (emf, ohm, volt) = (Some(*back_emf), Some(*resistance), Some(*supply));
                    }
                }
            }
            Self::ProportionalDerivative { proportional, derivative } => {
                gains = [Some(*proportional), Some(*derivative)]
            }
        }
        [
            (words::MOTOR_CONSTANT, motor),
            (words::BACK_EMF, emf),
            (words::RESISTANCE, ohm),
            (words::SUPPLY, volt),
            (words::PROPORTIONAL, gains[0]),
            (words::DERIVATIVE, gains[1]),
        ]
    }
}

impl MotorInput {
    /// Amperes at `velocity`.
    fn current(self, input: f64, velocity: f64) -> f64 {
        match self {
            Self::Current => input,
            Self::Voltage { back_emf, resistance } => (input - back_emf * velocity) / resistance,
            Self::Duty { back_emf, resistance, supply } => (input * supply - back_emf * velocity) / resistance,
        }
    }
}

/// Reads `[effort]`.
///
/// # Errors
/// An unknown model, or a constant that is absent, of another model or out of its range.
pub fn read(table: Table<'_>) -> Result<Option<EffortLaw>, InputError> {
    if !table.is_there() {
        return Ok(None);
    }
    let models = "\"current\", \"voltage\", \"duty\" or \"pd\"";
    let model = table.text(words::MODEL)?.ok_or_else(|| table.missing(words::MODEL, models))?;
    let law = if model == "pd" {
        EffortLaw::ProportionalDerivative {
            proportional: table.needed(words::PROPORTIONAL, Range::NotNegative)?,
            derivative: table.needed(words::DERIVATIVE, Range::NotNegative)?,
        }
    } else {
        let winding = || {
            Ok::<_, InputError>((
                table.needed(words::BACK_EMF, Range::NotNegative)?,
                table.needed(words::RESISTANCE, Range::Positive)?,
            ))
        };
        let (input, default) = match model.as_str() {
            "current" => (MotorInput::Current, "current_A"),
            "voltage" => {
                let (back_emf, resistance) = winding()?;
                (MotorInput::Voltage { back_emf, resistance }, "voltage_V")
            }
            "duty" => {
                let (back_emf, resistance) = winding()?;
                (
                    MotorInput::Duty { back_emf, resistance, supply: table.needed(words::SUPPLY, Range::Positive)? },
                    "duty",
                )
            }
            other => return Err(table.at(words::MODEL, format!("\"{other}\""), models)),
        };
        // Of either sign: a motor may be mounted the other way round.
        let motor_constant = table.needed(words::MOTOR_CONSTANT, Range::Finite)?;
        let column = table.text(words::COLUMN)?.unwrap_or_else(|| default.to_owned());
        EffortLaw::Motor { input, column, motor_constant }
    };
    table.done()?;
    Ok(Some(law))
}
