//! `palpate diagnose-joints`: an arm, one diagnosis a joint, in one report.
//!
//! A joint is a rig of its own: its file names the columns of the common recordings that are its own, and `load` among them is what the
//! rest of the arm asks of it.

mod command;
mod page;

use anyhow::{Context as _, Result};
use serde::Serialize;

pub use command::{DiagnoseJointsArgs, run};

use crate::diagnose::{self, Diagnosis, Found};
use crate::recording::Recording;
use crate::rig::Rig;

/// A joint before its diagnosis.
pub struct Joint {
    /// Its name in the report.
    pub name: String,
    /// Its drive and contact.
    pub rig: Rig,
    /// Names the rig in errors.
    pub origin: String,
    /// One a trial.
    pub trials: Vec<Recording>,
    /// What the simulation gave for each, or none.
    pub simulation: Vec<Recording>,
}

/// A joint and what was found at it.
pub struct DiagnosedJoint {
    /// Its name.
    pub name: String,
    /// What was found.
    pub found: Found,
}

/// Diagnoses each joint of `arm` by itself; `say` receives messages of progress.
///
/// # Errors
/// As [`diagnose::diagnose`], of the first joint that has one, with its name.
pub fn diagnose(arm: &[Joint], seed: u64, say: &dyn Fn(&str)) -> Result<Vec<DiagnosedJoint>> {
    let one = |joint: &Joint| {
        let say = |step: &str| say(&format!("joint {}: {step}", joint.name));
        // An input at fault names its file; wrapped in the joint's name it would no longer be told from a fault of the program.
        let found = diagnose::diagnose(&joint.rig, &joint.origin, &joint.trials, &joint.simulation, seed, &say)?;
        Ok(DiagnosedJoint { name: joint.name.clone(), found })
    };
    arm.iter().map(one).collect()
}

/// The layout of the JSON.
const SCHEMA: &str = "palpate.joints/1";

#[derive(Serialize)]
struct Joints<'a> {
    schema: &'static str,
    joints: Vec<OneJoint<'a>>,
}

#[derive(Serialize)]
struct OneJoint<'a> {
    joint: &'a str,
    diagnosis: &'a Diagnosis,
}

/// All joints as JSON: `joints`, each with its name `joint` and its `diagnosis` as `palpate diagnose --json` writes it.
///
/// # Errors
/// Never with a diagnosis that [`diagnose()`] made.
pub fn json(arm: &[DiagnosedJoint]) -> Result<String> {
    let joints = arm.iter().map(|joint| OneJoint { joint: &joint.name, diagnosis: &joint.found.answer }).collect();
    let text = serde_json::to_string_pretty(&Joints { schema: SCHEMA, joints });
    Ok(text.context("the diagnosis cannot be written as JSON")? + "\n")
}

/// The page of all joints.
///
/// # Errors
/// Never with a diagnosis that [`diagnose()`] made.
pub fn page(arm: &[DiagnosedJoint]) -> Result<String> {
    let mut page = Vec::new();
    page::write(arm, &mut page)?;
    Ok(String::from_utf8(page)?)
}
