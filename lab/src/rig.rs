//! The rig: the user's simulation of the test bed, as values with one name each whatever the coordinate.

mod coordinate;
mod effort_law;
mod read;
mod table;
mod words;
mod write;

use std::path::Path;

use crate::error::InputError;
use crate::outfile::OutFile;
pub use coordinate::{Coordinate, Word};
pub use effort_law::{EffortLaw, MotorInput};
pub use table::nearest;

/// A rig file. SI units; in a rotary rig read torque for force, inertia for mass, radian for metre.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rig {
    /// `[rig] name`.
    pub name: String,
    /// `[rig] coordinate`.
    pub coordinate: Coordinate,
    /// `[columns]`: names of a recording's columns where they are not the default ones.
    pub columns: Columns,
    /// `[drive]`, `None` where there is no effort.
    pub drive: Option<Drive>,
    /// `[effort]`: how the effort arises, for recordings that hold none.
    pub effort: Option<EffortLaw>,
    /// `[contact]`, `None` where there is no force.
    pub contact: Option<Contact>,
    /// `[sensors]`.
    pub sensors: Sensors,
    /// `[control]`, `None` where the file leaves it to the bench's values.
    pub control: Option<Control>,
    /// `[reference]`, `None` where the file leaves it to the bench's values.
    pub reference: Option<Reference>,
    /// `[simulation]`.
    pub simulation: Simulation,
    /// `[[effect]]`, in the file's order.
    pub effects: Vec<Effect>,
}

/// Column names that differ from the defaults.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Columns {
    /// Time.
    pub time: Option<String>,
    /// Tool position.
    pub position: Option<String>,
    /// Measured velocity.
    pub velocity: Option<String>,
    /// Contact force.
    pub force: Option<String>,
    /// Drive effort.
    pub effort: Option<String>,
    /// Commanded position.
    pub reference: Option<String>,
    /// Load that the user's rigid-body model explains of the effort.
    pub load: Option<String>,
}

/// What moves the tool: inertia a + viscous v = effort - force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Mass in kg or inertia in kg m^2, above zero.
    pub inertia: f64,
    /// N s/m or N m s/rad, zero or above.
    pub viscous: f64,
    /// On which side of the transmission the position is measured; `None`: not known.
    pub encoder: Option<TransmissionSide>,
    /// What the column of the load is multiplied by before it is taken off the effort, above zero; 1 where the rig file says nothing.
    pub load_scale: f64,
}

/// A side of the transmission.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TransmissionSide {
    /// Where the effort acts.
    Motor,
    /// Where the contact force acts.
    Load,
}

impl TransmissionSide {
    /// As a rig file spells it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Motor => "motor",
            Self::Load => "load",
        }
    }
}

/// What the tool touches: force = stiffness x + damping v, x = position - surface. The model is `kelvin_voigt`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Position at which the tool begins to touch.
    pub surface: f64,
    /// K in N/m or N m/rad, zero or above.
    pub stiffness: f64,
    /// B in N s/m or N m s/rad, zero or above.
    pub damping: f64,
    /// Glued or clamped: force both ways, on both sides of the surface. Else the contact ends at x = 0 and never pulls.
    pub bilateral: bool,
}

/// `[sensors]`: what the file says of them. What it leaves out is estimated from a recording ([`crate::sensors`]).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sensors {
    /// Step of the position sensor; 0: continuous.
    pub position_resolution: Option<f64>,
    /// Step of the force sensor; 0: continuous.
    pub force_resolution: Option<f64>,
    /// Standard deviation of the force sensor's white noise, before it rounds.
    pub force_noise: Option<f64>,
    /// What the force sensor reads when nothing touches; 0 where absent.
    pub force_zero: Option<f64>,
}

/// `[control]`: effort = proportional e + derivative de/dt, e = reference - position reading, held between two updates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Control {
    /// N/m or N m/rad, above zero.
    pub proportional: f64,
    /// N s/m or N m s/rad, zero or above.
    pub derivative: f64,
    /// Corner of the low-pass on de/dt in Hz; `None`: a tenth of the rate.
    pub derivative_filter_hz: Option<f64>,
    /// Largest effort either way, N or N m; infinite where the drive has no limit worth a name.
    pub effort_saturation: f64,
    /// Updates a second.
    pub rate_hz: f64,
}

/// `[reference]`: the paper's trajectory (eq. 15), depths counted from the surface, positive inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// Depth between two contacts, usually negative.
    pub free_depth: f64,
    /// Depth in contact.
    pub contact_depth: f64,
    /// Seconds from one contact to the next.
    pub period_s: f64,
    /// Seconds of a period at the contact depth, at its end; at most `period_s`.
    pub contact_s: f64,
    /// Time constant of each of the two lags that smooth the square wave.
    pub smoothing_s: f64,
    /// Amplitude of the sine on top; 0: none.
    pub sine_amplitude: f64,
    /// Frequency of the sine on top.
    pub sine_frequency_hz: f64,
}

/// `[simulation]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Simulation {
    /// Length of the recording, 60 s where absent.
    pub duration_s: f64,
    /// Rows a second, 1000 where absent.
    pub rate_hz: f64,
}

impl Default for Simulation {
    fn default() -> Self {
        Self { duration_s: 60.0, rate_hz: 1000.0 }
    }
}

/// An `[[effect]]`: physics beyond the nominal model. What its parameters mean is not known here.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// "coulomb_friction".
    pub name: String,
    /// Everything else of the table; every number in it is finite.
    pub parameters: toml::Table,
}

impl Rig {
    /// Reads a rig file.
    ///
    /// # Errors
    /// The file is absent or not UTF-8, or as [`Rig::parse`].
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let place = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|error| {
            let found = match error.kind() {
                std::io::ErrorKind::NotFound => "no such file".to_owned(),
                _ => error.to_string(),
            };
            InputError::new(&place, found, "a rig file that can be read")
        })?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
            InputError::new(format!("{place}:{line}"), "bytes that are not UTF-8", "a rig file in UTF-8")
        })?;
        Self::parse(text.strip_prefix('\u{feff}').unwrap_or(&text), &place)
    }

    /// Reads the text of a rig file; `origin` names it in messages.
    ///
    /// # Errors
    /// Not TOML, an unknown key or one of the other coordinate, a needed key that is absent, a wrong type, a value that
    /// cannot be; each with line, key, what was found and what was expected.
    pub fn parse(text: &str, origin: &str) -> Result<Self, InputError> {
        read::rig(text, origin)
    }

    /// Writes a rig file that reads back as this very rig.
    ///
    /// # Errors
    /// The place cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), InputError> {
        use std::io::Write as _;
        let mut file = OutFile::create(path)?;
        file.write_all(self.to_toml().as_bytes()).map_err(|error| file.fault(&error))?;
        file.commit()
    }

    /// The text of the rig file.
    #[must_use]
    pub fn to_toml(&self) -> String {
        write::text(self)
    }

    /// The position where contact begins; zero in a rig without contact.
    #[must_use]
    pub fn surface(&self) -> f64 {
        self.contact.map_or(0.0, |contact| contact.surface)
    }
}
