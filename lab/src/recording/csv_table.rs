//! A CSV file as channels, for looking at it. A recording is read more strictly, by [`super::read`].

use csv::ReaderBuilder;

use super::data_file::Channel;
use crate::error::InputError;

/// Every column of a CSV file; a column with a field that is no number is none of numbers.
///
/// # Errors
/// Rows of unequal length, or no header.
pub fn channels(place: &str, bytes: &[u8]) -> Result<Vec<Channel>, InputError> {
    let mut reader = ReaderBuilder::new().has_headers(true).from_reader(bytes);
    let fault = |error: csv::Error| InputError::new(place, error, "CSV: one header row, rows of equal length");
    let names: Vec<String> =
        reader.byte_headers().map_err(fault)?.iter().map(|name| String::from_utf8_lossy(name).into_owned()).collect();
    let mut values: Vec<Result<Vec<f64>, String>> = names.iter().map(|_| Ok(Vec::new())).collect();
    for (row, record) in reader.byte_records().enumerate() {
        let record = record.map_err(fault)?;
        for (values, field) in values.iter_mut().zip(&record) {
            let Ok(numbers) = values else { continue };
            let text = String::from_utf8_lossy(field);
            match text.trim().parse() {
                Ok(number) => numbers.push(number),
                Err(_) if text.trim().is_empty() => numbers.push(f64::NAN),
                Err(_) => *values = Err(format!("text: \"{}\" in row {}", text.trim(), row + 1)),
            }
        }
    }
    let channel = |(name, values): (String, Result<Vec<f64>, String>)| match values {
        Ok(numbers) => Channel::numbers(name, numbers),
        Err(what) => Channel::other(name, what),
    };
    Ok(names.into_iter().zip(values).map(channel).collect())
}
