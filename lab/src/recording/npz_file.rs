//! NPZ: a zip archive of NumPy arrays. Rows of an array are instants.

use std::collections::BTreeMap;
use std::io::{Cursor, Read as _};

use zip::ZipArchive;

use super::data_file::{Channel, Content};
use super::npy_array::{self, NpyArray};
use crate::error::InputError;

/// No array of a recording is as large; a forged header is.
const MAX_ARRAY_BYTES: u64 = 4 << 30;

/// The channels of an archive of arrays.
///
/// An archive of MuJoCo's system identification (`times`, `data`, `signal_mapping`) has its signals by their names, with
/// `times` as their clock.
///
/// # Errors
/// A damaged archive, or a signal mapping that speaks of columns that are not there.
pub fn channels(place: &str, bytes: &[u8]) -> Result<Vec<Channel>, InputError> {
    let fault = |found: String| InputError::new(place, found, "an archive of arrays, as numpy.savez writes it");
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| fault(error.to_string()))?;
    let mut arrays = Vec::new();
    for at in 0..archive.len() {
        let member = archive.by_index(at).map_err(|error| fault(error.to_string()))?;
        let name = member.name().map_err(|error| fault(error.to_string()))?.trim_end_matches(".npy").to_owned();
        let mut data = Vec::new();
        member.take(MAX_ARRAY_BYTES).read_to_end(&mut data).map_err(|error| fault(format!("{name}: {error}")))?;
        arrays.push((name, npy_array::parse(&data)));
    }
    if let Some(channels) = signals(place, &arrays)? {
        return Ok(channels);
    }
    Ok(arrays.into_iter().flat_map(|(name, array)| array_channels(&name, array)).collect())
}

fn array_channels(name: &str, array: Result<NpyArray, String>) -> Vec<Channel> {
    match array {
        Ok(NpyArray::Numbers { shape, values }) => match shape[..] {
            [_] => vec![Channel::numbers(name, values)],
            [rows, columns] => Channel::columns(name, rows, columns, |row, column| values[row * columns + column]),
            [] => vec![Channel::other(name, format!("a single number, {}", values[0]))],
            _ => vec![Channel::other(name, format!("an array of {} dimensions", shape.len()))],
        },
        Ok(NpyArray::Text(text)) => vec![Channel::other(name, format!("text, {} letters", text.chars().count()))],
        Err(what) => vec![Channel::other(name, what)],
    }
}

/// A name's kind of signal and its columns in `data`, as `mujoco.sysid` writes them.
type SignalMapping = BTreeMap<String, (i64, Vec<usize>)>;

/// The signals of MuJoCo's system identification, `None` where the archive is another.
fn signals(place: &str, arrays: &[(String, Result<NpyArray, String>)]) -> Result<Option<Vec<Channel>>, InputError> {
    let array = |name: &str| arrays.iter().find(|(found, _)| found == name).map(|(_, array)| array);
    let (Some(times), Some(data), Some(mapping)) = (array("times"), array("data"), array("signal_mapping")) else {
        return Ok(None);
    };
    let fault =
        |key: &str, found: String, expected: &str| Err(InputError::new(format!("{place}: {key}"), found, expected));
    let NpyArray::Text(text) = (match mapping {
        Ok(mapping) => mapping,
        Err(what) => {
            return fault(
                "signal_mapping",
                what.clone(),
                "the text that MuJoCo 3.6 and later write, TimeSeries.save_to_disk",
            );
        }
    }) else {
        return fault("signal_mapping", "numbers".to_owned(), "names and columns, as JSON in a text");
    };
    let mapping: SignalMapping = match serde_json::from_str(text) {
        Ok(mapping) => mapping,
        Err(error) => return fault("signal_mapping", error.to_string(), "names and columns, as JSON"),
    };
    let (Ok(NpyArray::Numbers { shape: time_shape, values: times }), Ok(NpyArray::Numbers { shape, values })) =
        (times, data)
    else {
        return fault("times, data", "something else than numbers".to_owned(), "arrays of numbers");
    };
    let (&[rows], &[data_rows, columns]) = (&time_shape[..], &shape[..]) else {
        return fault("times, data", format!("shapes {time_shape:?} and {shape:?}"), "one time a row of data");
    };
    if rows != data_rows {
        return fault("times, data", format!("{rows} times and {data_rows} rows"), "arrays of equal length");
    }
    let mut channels = Vec::new();
    for (name, (_, indices)) in mapping {
        if let Some(beyond) = indices.iter().find(|index| **index >= columns) {
            return fault(
                &format!("signal_mapping {name}"),
                format!("column {beyond} of {columns}"),
                "columns that data has",
            );
        }
        channels.extend(Channel::columns(&name, rows, indices.len(), |row, at| values[row * columns + indices[at]]));
    }
    for channel in &mut channels {
        if matches!(channel.content, Content::Numbers(_)) {
            channel.clock = Some(times.clone());
        }
    }
    Ok(Some(channels))
}
