//! MAT-files of level 5: numeric arrays. The longer side of a matrix is time.

use matfile::{MatFile, NumericData};

use super::data_file::Channel;
use crate::error::InputError;

/// The channels of the numeric arrays in `bytes`. Structures, cells and text are not read.
///
/// # Errors
/// A damaged file, or one that holds no numeric array.
pub fn channels(place: &str, bytes: &[u8]) -> Result<Vec<Channel>, InputError> {
    let file = MatFile::parse(bytes)
        .map_err(|error| InputError::new(place, format!("a damaged MAT-file ({})", shown(&error)), "MAT version 5"))?;
    if file.arrays().is_empty() {
        let found = "no numeric array: structures, cells and text are not read";
        return Err(InputError::new(place, found, "numeric arrays at the top of the file"));
    }
    Ok(file.arrays().iter().flat_map(array_channels).collect())
}

fn shown(error: &matfile::Error) -> String {
    match error {
        matfile::Error::IOError(error) => error.to_string(),
        matfile::Error::ParseError(_) => "its elements cannot be followed".to_owned(),
        matfile::Error::ConversionError => "a value is out of its type's range".to_owned(),
        _ => "an internal inconsistency".to_owned(),
    }
}

fn array_channels(array: &matfile::Array) -> Vec<Channel> {
    let Some(values) = numbers(array.data()) else {
        return vec![Channel::other(array.name(), "complex numbers")];
    };
    match array.size()[..] {
        [1, 1] => vec![Channel::other(array.name(), format!("a single number, {}", values[0]))],
        // Stored column by column.
        [rows, columns] if rows >= columns => {
            Channel::columns(array.name(), rows, columns, |row, at| values[at * rows + row])
        }
        [rows, columns] => Channel::columns(array.name(), columns, rows, |row, at| values[row * rows + at]),
        _ => vec![Channel::other(array.name(), format!("an array of {} dimensions", array.ndims()))],
    }
}

/// `None`: complex.
fn numbers(data: &NumericData) -> Option<Vec<f64>> {
    macro_rules! real {
        ($real:expr, $imag:expr) => {
            $imag.is_none().then(|| $real.iter().map(|value| *value as f64).collect())
        };
    }
    match data {
        NumericData::Int8 { real, imag } => real!(real, imag),
        NumericData::UInt8 { real, imag } => real!(real, imag),
        NumericData::Int16 { real, imag } => real!(real, imag),
        NumericData::UInt16 { real, imag } => real!(real, imag),
        NumericData::Int32 { real, imag } => real!(real, imag),
        NumericData::UInt32 { real, imag } => real!(real, imag),
        NumericData::Int64 { real, imag } => real!(real, imag),
        NumericData::UInt64 { real, imag } => real!(real, imag),
        NumericData::Single { real, imag } => real!(real, imag),
        NumericData::Double { real, imag } => real!(real, imag),
    }
}
