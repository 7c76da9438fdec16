//! From Python's objects to rigs and recordings.

use std::path::{Path, PathBuf};

use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;

use palpate_lab::error::InputError;
use palpate_lab::recording::Recording;
use palpate_lab::recording::data_file::Channel;
use palpate_lab::rig::Rig;

use crate::input_error;

/// A rig file by its path, or its tables as JSON in a tuple of one; and its name in errors.
pub fn rig(rig: &Bound<'_, PyAny>) -> PyResult<(Rig, String)> {
    if let Ok((json,)) = rig.extract::<(String,)>() {
        let fault = |found: String| input_error(InputError::new("rig", found, "the tables of a rig file"));
        let tables: toml::Table = serde_json::from_str(&json).map_err(|error| fault(error.to_string()))?;
        let text = toml::to_string(&tables).map_err(|error| fault(error.to_string()))?;
        return Ok((Rig::parse(&text, "rig").map_err(input_error)?, "rig".to_owned()));
    }
    let path: PathBuf = rig.extract()?;
    let origin = path.display().to_string();
    Ok((Rig::read(&path).map_err(input_error)?, origin))
}

/// A recording: a path, or a list of columns with names, with columns added to either as the second of a pair. `at` is its place among
/// the others.
pub fn recording(given: &Bound<'_, PyAny>, at: usize, rig: &Rig) -> PyResult<Recording> {
    let (file, added): (Bound<'_, PyAny>, Vec<(String, Bound<'_, PyAny>)>) = given.extract()?;
    let added: Vec<Channel> = added.iter().map(channel).collect::<PyResult<_>>()?;
    if let Ok(columns) = file.extract::<Vec<(String, Bound<'_, PyAny>)>>() {
        let name = format!("recording {}", at + 1);
        let channels = columns.iter().map(channel).collect::<PyResult<Vec<_>>>()?;
        return Recording::from_channels(name, [channels, added].concat(), rig).map_err(input_error);
    }
    let path: PathBuf = file.extract()?;
    read(&path, added, rig).map_err(input_error)
}

/// All of `given`, each as [`recording`].
pub fn recordings(given: &[Bound<'_, PyAny>], rig: &Rig) -> PyResult<Vec<Recording>> {
    given.iter().enumerate().map(|(at, one)| recording(one, at, rig)).collect()
}

fn read(path: &Path, added: Vec<Channel>, rig: &Rig) -> Result<Recording, InputError> {
    match added.is_empty() {
        true => Recording::read(path, rig),
        false => Recording::read_with(path, added, rig),
    }
}

/// A column of doubles. Python has made a contiguous array of it.
fn channel((name, values): &(String, Bound<'_, PyAny>)) -> PyResult<Channel> {
    let values = PyBuffer::<f64>::get(values)?.to_vec(values.py())?;
    Ok(Channel::numbers(name.clone(), values))
}
