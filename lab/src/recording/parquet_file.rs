//! Parquet: columns of numbers.

use bytes::Bytes;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::record::Field;

use super::data_file::Channel;
use crate::error::InputError;

/// The channels of the columns in `bytes`. A missing value is not a number.
///
/// # Errors
/// A damaged file, or one whose compression is neither none nor Snappy.
pub fn channels(place: &str, bytes: &[u8]) -> Result<Vec<Channel>, InputError> {
    let fault = |error: parquet::errors::ParquetError| {
        InputError::new(place, error, "Parquet without compression or with Snappy, as pandas writes it")
    };
    let reader = SerializedFileReader::new(Bytes::copy_from_slice(bytes)).map_err(fault)?;
    let schema = reader.metadata().file_metadata().schema().clone();
    let names: Vec<String> = schema.get_fields().iter().map(|field| field.name().to_owned()).collect();
    let mut values: Vec<Result<Vec<f64>, String>> = names.iter().map(|_| Ok(Vec::new())).collect();
    for row in reader.get_row_iter(None).map_err(fault)? {
        let row = row.map_err(fault)?;
        for (values, (_, field)) in values.iter_mut().zip(row.get_column_iter()) {
            let Ok(numbers) = values else { continue };
            match number(field) {
                Ok(number) => numbers.push(number),
                Err(what) => *values = Err(what.to_owned()),
            }
        }
    }
    let channel = |(name, values): (String, Result<Vec<f64>, String>)| match values {
        Ok(numbers) => Channel::numbers(name, numbers),
        Err(what) => Channel::other(name, what),
    };
    Ok(names.into_iter().zip(values).map(channel).collect())
}

/// Time stamps in seconds.
fn number(field: &Field) -> Result<f64, &'static str> {
    Ok(match field {
        Field::Null => f64::NAN,
        Field::Byte(value) => f64::from(*value),
        Field::Short(value) => f64::from(*value),
        Field::Int(value) => f64::from(*value),
        Field::Long(value) => *value as f64,
        Field::UByte(value) => f64::from(*value),
        Field::UShort(value) => f64::from(*value),
        Field::UInt(value) => f64::from(*value),
        Field::ULong(value) => *value as f64,
        Field::Float16(value) => f64::from(*value),
        Field::Float(value) => f64::from(*value),
        Field::Double(value) => *value,
        Field::TimeMillis(value) => f64::from(*value) * 1e-3,
        Field::TimestampMillis(value) => *value as f64 * 1e-3,
        Field::TimeMicros(value) | Field::TimestampMicros(value) => *value as f64 * 1e-6,
        Field::Bool(_) => return Err("yes or no"),
        Field::Str(_) => return Err("text"),
        _ => return Err("neither numbers nor text"),
    })
}
