//! An arm: each joint's diagnosis, and one report of all.

use pyo3::prelude::*;

use palpate_lab::joints::{self, Joint};

use crate::{Answer, answer, arguments, cancellable};

/// A joint's name, its rig, and its recordings: of the machine, and of the simulation.
type GivenJoint<'py> = (String, Bound<'py, PyAny>, Vec<Bound<'py, PyAny>>, Vec<Bound<'py, PyAny>>);

/// The JSON and the page of all joints, and each joint's own answer; see `palpate.diagnose_joints`.
#[pyfunction]
pub fn diagnose_joints(
    py: Python<'_>,
    given: Vec<GivenJoint<'_>>,
    seed: u64,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, String, Vec<Answer>)> {
    let joint = |(name, rig, trials, simulation): &GivenJoint<'_>| -> PyResult<Joint> {
        let (rig, origin) = arguments::rig(rig)?;
        let trials = arguments::recordings(trials, &rig)?;
        let simulation = arguments::recordings(simulation, &rig)?;
        Ok(Joint { name: name.clone(), rig, origin, trials, simulation })
    };
    let arm: Vec<Joint> = given.iter().map(joint).collect::<PyResult<_>>()?;
    cancellable::run(py, progress, move |say| {
        let diagnosed = joints::diagnose(&arm, seed, say)?;
        let answers = diagnosed.iter().map(|joint| answer(&joint.found)).collect::<anyhow::Result<_>>()?;
        Ok((joints::json(&diagnosed)?, joints::page(&diagnosed)?, answers))
    })
}
