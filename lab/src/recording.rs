//! A trial as it was recorded: one column a channel, SI units.

pub(crate) mod assemble;
mod columns;
mod computed_effort;
mod csv_table;
pub mod data_file;
pub mod format;
mod mat_file;
mod mcap_file;
mod npy_array;
mod npz_file;
mod parquet_file;
mod read;
mod ros_message;
mod text;

use std::io::Write as _;
use std::path::Path;

use crate::error::InputError;
use crate::outfile::OutFile;
use crate::rig::Rig;
use columns::Role;
use data_file::{Channel, DataFile};

/// A trial. All columns are of equal length, at least two rows, every number finite, time strictly increasing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recording {
    /// File name without its folder.
    pub name: String,
    /// Seconds.
    pub time: Vec<f64>,
    /// Tool position, positive into the environment.
    pub position: Vec<f64>,
    /// Measured velocity.
    pub velocity: Option<Vec<f64>>,
    /// Contact force, positive when the tool pushes.
    pub force: Option<Vec<f64>>,
    /// Drive effort at the tool: recorded, or computed as the rig's `[effort]` says.
    pub effort: Option<Vec<f64>>,
    /// Commanded position.
    pub reference: Option<Vec<f64>>,
    /// What the user's rigid-body model explains of the effort: gravity, coupling.
    pub load: Option<Vec<f64>>,
}

/// What is kept of a recording. All of it is checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scope {
    All,
    /// What the estimators are fed.
    Contact,
}

impl Scope {
    fn holds(self, role: Role) -> bool {
        self == Self::All || matches!(role, Role::Time | Role::Position | Role::Force)
    }
}

impl Recording {
    /// Reads a recording by the column names of `rig`: CSV, NPZ, MAT version 5, Parquet or MCAP.
    ///
    /// Time, position and at least one of force and effort have to be there; columns without a role are skipped.
    ///
    /// # Errors
    /// The file cannot be read, is of another format than its ending says or is damaged, a column is absent or of the other coordinate, a
    /// field is no finite number, a row is ragged, time does not increase, or there are fewer than two rows; with the true line in the
    /// file.
    pub fn read(path: &Path, rig: &Rig) -> Result<Self, InputError> {
        read::recording(path, rig, Scope::All)
    }

    /// As [`Recording::read`], and as strict, but only time, position and force are kept.
    ///
    /// # Errors
    /// As [`Recording::read`].
    pub fn read_contact(path: &Path, rig: &Rig) -> Result<Self, InputError> {
        read::recording(path, rig, Scope::Contact)
    }

    /// The recording in `channels`, by the column names of `rig`; `name` is the trial's, also in errors.
    ///
    /// # Errors
    /// A column is absent, of another length than the time, or of the other coordinate, a value is no finite number, or time does not
    /// increase.
    pub fn from_channels(name: String, channels: Vec<Channel>, rig: &Rig) -> Result<Self, InputError> {
        assemble::recording(&channels, &name.clone(), name, rig, Scope::All)
    }

    /// As [`Recording::read`], with `added` in place of the file's columns of the same names.
    ///
    /// # Errors
    /// As [`Recording::read`], without the line in a CSV file.
    pub fn read_with(path: &Path, added: Vec<Channel>, rig: &Rig) -> Result<Self, InputError> {
        let mut channels = DataFile::read(path)?.channels;
        channels.retain(|channel| added.iter().all(|added| added.name != channel.name));
        channels.extend(added);
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        assemble::recording(&channels, &path.display().to_string(), name, rig, Scope::All)
    }

    /// Writes the recording under the column names of `rig`, so that the same rig reads it; whole or not at all.
    ///
    /// Numbers are written so that they read back to the bit.
    ///
    /// # Errors
    /// The place cannot be written.
    pub fn write(&self, path: &Path, rig: &Rig) -> Result<(), InputError> {
        self.write_to(OutFile::create(path)?, rig)
    }

    /// As [`Recording::write`], into a file opened before.
    ///
    /// # Errors
    /// The place cannot be written any more.
    pub fn write_to(&self, mut file: OutFile, rig: &Rig) -> Result<(), InputError> {
        let channels = self.channels();
        // A name of the rig file may hold a comma, which the CSV writer puts in quotes.
        let mut header = csv::Writer::from_writer(&mut file);
        let written = header.write_record(channels.iter().map(|(role, _)| role.name(rig)));
        let written = written.map_err(std::io::Error::from).and_then(|()| header.flush());
        drop(header);
        written.map_err(|error| file.fault(&error))?;
        let mut text = String::new();
        for row in 0..self.time.len() {
            for (at, (_, values)) in channels.iter().enumerate() {
                if at > 0 {
                    text.push(',');
                }
                push_number(&mut text, values[row]);
            }
            text.push('\n');
            if text.len() > 1 << 16 {
                file.write_all(text.as_bytes()).map_err(|error| file.fault(&error))?;
                text.clear();
            }
        }
        file.write_all(text.as_bytes()).map_err(|error| file.fault(&error))?;
        file.commit()
    }

    /// Median sample period in seconds.
    #[must_use]
    pub fn period(&self) -> f64 {
        let mut steps: Vec<_> = self.time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if steps.is_empty() {
            return f64::NAN;
        }
        let middle = steps.len() / 2;
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// Samples a second, from the median period.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.period().recip()
    }

    fn channels(&self) -> Vec<(Role, &[f64])> {
        [
            (Role::Time, Some(&self.time)),
            (Role::Position, Some(&self.position)),
            (Role::Velocity, self.velocity.as_ref()),
            (Role::Force, self.force.as_ref()),
            (Role::Effort, self.effort.as_ref()),
            (Role::Reference, self.reference.as_ref()),
            (Role::Load, self.load.as_ref()),
        ]
        .into_iter()
        .filter_map(|(role, values)| Some((role, values?.as_slice())))
        .collect()
    }
}

/// The shortest text that reads back to the bit, without the zeros of a nanonewton.
fn push_number(text: &mut String, value: f64) {
    use std::fmt::Write as _;
    let plain = value == 0.0 || (1e-4..1e15).contains(&value.abs());
    // Writing to a String cannot fail.
    let _ = if plain { write!(text, "{value}") } else { write!(text, "{value:e}") };
}
