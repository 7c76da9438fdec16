//! The extension module of the Python package `palpate`. Everything that a person sees is in `palpate/__init__.py`.

mod arguments;
mod cancellable;
mod contact_law;
mod joints;

use std::ffi::OsString;
use std::path::PathBuf;

use clap::ValueEnum as _;
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use palpate_lab::diagnose::report::html;
use palpate_lab::diagnose::{Diagnosis, Found, diagnose as run_diagnosis};
use palpate_lab::error::InputError;
use palpate_lab::export::{ExportArgs, Target, export as write_model};
use palpate_lab::fleet::rig_folder::{ANSWER, RigFolder};
use palpate_lab::fleet::source::{self, FleetRig};
use palpate_lab::fleet::worker::Worker;
use palpate_lab::own_program::{self, OwnProgram};

create_exception!(_palpate, NativeInputError, PyValueError, "Place, finding and expectation of an input at fault.");

/// An input at fault as its three parts, anything else as text.
fn python_error(error: anyhow::Error) -> PyErr {
    match error.downcast::<InputError>() {
        Ok(error) => input_error(error),
        Err(error) => PyRuntimeError::new_err(format!("{error:#}")),
    }
}

fn input_error(error: InputError) -> PyErr {
    NativeInputError::new_err((error.place, error.found, error.expected))
}

/// The JSON of the command, the report's page and the improved rig file.
type Answer = (String, String, String);

/// Diagnoses recordings; see `palpate.diagnose`.
#[pyfunction]
fn diagnose(
    py: Python<'_>,
    rig: &Bound<'_, PyAny>,
    recordings: Vec<Bound<'_, PyAny>>,
    simulation: Vec<Bound<'_, PyAny>>,
    seed: u64,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let (rig, origin) = arguments::rig(rig)?;
    let (trials, simulation) = (arguments::recordings(&recordings, &rig)?, arguments::recordings(&simulation, &rig)?);
    cancellable::run(py, progress, move |say| {
        let found = run_diagnosis(&rig, &origin, &trials, &simulation, seed, say)?;
        answer(&found)
    })
}

/// What Python gets of a diagnosis.
fn answer(found: &Found) -> anyhow::Result<Answer> {
    let mut page = Vec::new();
    html::write(&found.answer, &found.pictures, &mut page)?;
    Ok((json(&found.answer)?, String::from_utf8(page)?, found.improved.to_toml()))
}

/// As `palpate diagnose --json` writes it.
fn json(answer: &Diagnosis) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(answer)? + "\n")
}

/// A recording's channels by name, as the bytes of doubles; see `palpate.read`.
#[pyfunction]
fn read<'py>(
    py: Python<'py>,
    recording: &Bound<'py, PyAny>,
    rig: &Bound<'py, PyAny>,
) -> PyResult<Vec<(&'static str, Bound<'py, PyBytes>)>> {
    let (rig, _) = arguments::rig(rig)?;
    let recording = arguments::recording(recording, 0, &rig)?;
    let channels = [
        ("time", Some(recording.time)),
        ("position", Some(recording.position)),
        ("velocity", recording.velocity),
        ("force", recording.force),
        ("effort", recording.effort),
        ("reference", recording.reference),
        ("load", recording.load),
    ];
    let bytes = |values: Vec<f64>| {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_ne_bytes()).collect();
        PyBytes::new(py, &bytes)
    };
    Ok(channels.into_iter().filter_map(|(name, values)| Some((name, bytes(values?)))).collect())
}

/// The model's text, what the user has to know, and what was left out; see `palpate.export`. `to` is a target as the command spells it.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "as many as the Python function has, in its order")]
fn export(
    to: &str,
    improved: PathBuf,
    into: PathBuf,
    joint: String,
    actuator: Option<String>,
    sensor: Option<String>,
    nominal: Option<PathBuf>,
    partial: bool,
) -> PyResult<(String, Vec<String>, Vec<String>)> {
    let names: Vec<String> = Target::value_variants()
        .iter()
        .filter_map(|target| Some(target.to_possible_value()?.get_name().to_owned()))
        .collect();
    let to = Target::from_str(to, false).map_err(|_| input_error(InputError::new("to", to, names.join(", "))))?;
    let args = ExportArgs { to, improved, into, joint, actuator, sensor, nominal, partial, out: None };
    let exported = write_model(&args).map_err(input_error)?;
    let left_out = exported.refused.iter().map(ToString::to_string).collect();
    Ok((exported.text, exported.notes, left_out))
}

/// Name, rig file and recordings of a rig of a fleet.
type ListedRig = (String, PathBuf, Vec<PathBuf>);

/// The rigs of a fleet; see `palpate.fleet`.
#[pyfunction]
fn fleet(source: PathBuf, out: PathBuf) -> PyResult<Vec<ListedRig>> {
    let fleet = source::read(&source, &out).map_err(input_error)?;
    Ok(fleet.rigs.into_iter().map(|rig| (rig.name, rig.rig, rig.recordings)).collect())
}

/// Diagnoses one rig of a fleet into its folder below `out`; see `palpate.diagnose_rig`. Its JSON, or why there is none.
#[pyfunction]
fn diagnose_rig(
    py: Python<'_>,
    rig: ListedRig,
    out: PathBuf,
    seed: u64,
    threads: usize,
) -> PyResult<(Option<String>, Option<String>)> {
    let (name, file, recordings) = rig;
    let rig = FleetRig { name, rig: file, recordings };
    let result = py.detach(|| Worker::new(seed, threads).map(|worker| worker.diagnose(&rig, &out)));
    let result = result.map_err(python_error)?;
    match result.diagnosis {
        Ok(_) => Ok((Some(std::fs::read_to_string(RigFolder::new(&out, &rig.name).file(ANSWER))?), None)),
        Err(error) => Ok((None, Some(error))),
    }
}

/// Declares the command that starts this package in a process of its own, and the file of this module.
#[pyfunction]
fn declare_program(command: Vec<OsString>, file: PathBuf) {
    own_program::declare(OwnProgram { command, file });
}

/// The command with its arguments, the program's name first; its exit status.
#[pyfunction]
fn command(py: Python<'_>, arguments: Vec<String>) -> u8 {
    py.detach(|| palpate_lab::cli::run_with(arguments))
}

#[pymodule]
fn _palpate(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("NativeInputError", module.py().get_type::<NativeInputError>())?;
    module.add_class::<contact_law::ContactLaw>()?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(diagnose, module)?)?;
    module.add_function(wrap_pyfunction!(joints::diagnose_joints, module)?)?;
    module.add_function(wrap_pyfunction!(read, module)?)?;
    module.add_function(wrap_pyfunction!(export, module)?)?;
    module.add_function(wrap_pyfunction!(fleet, module)?)?;
    module.add_function(wrap_pyfunction!(diagnose_rig, module)?)?;
    module.add_function(wrap_pyfunction!(declare_program, module)?)?;
    module.add_function(wrap_pyfunction!(command, module)?)
}
