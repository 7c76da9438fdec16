//! What any file holds: named channels of numbers, before the rig file gives them roles.

use std::fs::File;
use std::io::{self, Cursor, Read, Seek};
use std::path::Path;

use super::format::Format;
use super::{csv_table, mat_file, mcap_file, npz_file, parquet_file};
use crate::error::InputError;

/// A file, channel by channel.
#[derive(Debug, Clone)]
pub struct DataFile {
    /// Its format.
    pub format: Format,
    /// In the file's order.
    pub channels: Vec<Channel>,
}

/// A column, an array or a field of a topic.
#[derive(Debug, Clone)]
pub struct Channel {
    /// As a rig file's `[columns]` names it: `position_m`, `data[2]`, `/joint_states:elbow.position`.
    pub name: String,
    /// What it holds.
    pub content: Content,
    /// Seconds of each value, where the channel has a clock of its own; else a column of the file holds the time.
    pub clock: Option<Vec<f64>>,
}

/// What a channel holds.
#[derive(Debug, Clone)]
pub enum Content {
    /// Numbers; not a number where the file leaves one out.
    Numbers(Vec<f64>),
    /// Something else, in words: "text", "an array of 3 dimensions".
    Other(String),
}

impl Channel {
    /// Numbers without a clock.
    pub fn numbers(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self { name: name.into(), content: Content::Numbers(values), clock: None }
    }

    /// Something that is no series of numbers.
    pub fn other(name: impl Into<String>, what: impl Into<String>) -> Self {
        Self { name: name.into(), content: Content::Other(what.into()), clock: None }
    }

    /// The columns of an array of two dimensions with time along `rows`: one channel where it has one column, else
    /// `name[0]`, `name[1]` and so on. `value(row, column)`.
    pub fn columns(name: &str, rows: usize, columns: usize, value: impl Fn(usize, usize) -> f64) -> Vec<Self> {
        let column = |at: usize| (0..rows).map(|row| value(row, at)).collect();
        match columns {
            1 => vec![Self::numbers(name, column(0))],
            _ => (0..columns).map(|at| Self::numbers(format!("{name}[{at}]"), column(at))).collect(),
        }
    }
}

impl DataFile {
    /// Reads `path`, whatever its format.
    ///
    /// # Errors
    /// It cannot be read, is of a format that is not read or of another one than its ending says, or is damaged.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let bytes = read_bytes(path)?;
        let format = Format::of(path, &bytes)?;
        Self::parse(&path.display().to_string(), format, &bytes)
    }

    /// The content of a file of `format`; `place` names it in errors.
    ///
    /// # Errors
    /// It is damaged.
    pub fn parse(place: &str, format: Format, bytes: &[u8]) -> Result<Self, InputError> {
        let channels = match format {
            Format::Csv => csv_table::channels(place, bytes),
            Format::Npz => npz_file::channels(place, bytes),
            Format::Mat => mat_file::channels(place, bytes),
            Format::Parquet => parquet_file::channels(place, bytes),
            Format::Mcap => mcap_file::channels(place, bytes),
        }?;
        if channels.is_empty() {
            return Err(InputError::new(
                place,
                format!("a {} file without any channel", format.name()),
                "channels of numbers",
            ));
        }
        Ok(Self { format, channels })
    }
}

/// A file that can be read more than once.
pub trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// Opens a recording. What comes through a pipe, which can be read only once, is taken into memory.
///
/// # Errors
/// There is no such file, or it cannot be read.
pub fn open(path: &Path) -> Result<Box<dyn Source>, InputError> {
    let mut file = File::open(path).map_err(|error| unreadable(path, &error))?;
    if file.metadata().is_ok_and(|found| found.is_file()) {
        return Ok(Box::new(file));
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(|error| unreadable(path, &error))?;
    Ok(Box::new(Cursor::new(bytes)))
}

/// The bytes of a recording.
///
/// # Errors
/// There is no such file, or it cannot be read.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, InputError> {
    std::fs::read(path).map_err(|error| unreadable(path, &error))
}

/// The error of reading `path`.
pub fn unreadable(path: &Path, error: &io::Error) -> InputError {
    let found = match error.kind() {
        io::ErrorKind::NotFound => "no such file".to_owned(),
        io::ErrorKind::IsADirectory => "a folder".to_owned(),
        _ => error.to_string(),
    };
    InputError::new(path.display(), found, "a recording that can be read")
}
