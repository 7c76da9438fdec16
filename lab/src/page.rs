//! `replay.html`: one self-contained page that shows a replay.

use std::io::{self, Write};

/// Everything that the page shows. Pure data: nothing here knows how it was computed.
#[derive(Debug, Clone)]
pub struct Page {
    /// `[rig] name`.
    pub rig: String,
    /// Where the estimators ran: "host" or "Cortex-M4F under QEMU".
    pub ran_on: String,
    /// Settings that held for every trial, as label and value ("window", "300 samples").
    pub settings: Vec<(String, String)>,
    /// One entry a recording, in the order of the command line.
    pub trials: Vec<Trial>,
}

/// One recording and what the estimators made of it. All vectors are of equal length.
#[derive(Debug, Clone)]
pub struct Trial {
    /// File name without its folder.
    pub name: String,
    /// Units of the coordinate.
    pub units: Units,
    /// Nominal stiffness of the rig file, drawn as a dashed line.
    pub nominal_stiffness: f64,
    /// Nominal damping of the rig file.
    pub nominal_damping: f64,
    /// Seconds.
    pub time: Vec<f64>,
    /// Depth below the rig's surface, positive into the environment.
    pub penetration: Vec<f32>,
    /// Measured contact force, positive when the tool pushes.
    pub force: Vec<f32>,
    /// The contact gate.
    pub contact: Vec<bool>,
    /// One entry a method.
    pub methods: Vec<Method>,
    /// What a reader must know of this replay ("cut-off lowered to 2 Hz: the recording has 10 samples a second").
    pub notices: Vec<String>,
}

/// Unit names for the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Units {
    /// "m" or "rad".
    pub position: &'static str,
    /// "N" or "N m".
    pub force: &'static str,
    /// "N/m" or "N m/rad".
    pub stiffness: &'static str,
    /// "N s/m" or "N m s/rad".
    pub damping: &'static str,
}

/// One estimator's trace.
#[derive(Debug, Clone)]
pub struct Method {
    /// Short name as on the command line: "bls".
    pub name: &'static str,
    /// Long name: "block least squares".
    pub title: &'static str,
    /// K.
    pub stiffness: Vec<f32>,
    /// Half-width of the 95 % interval of K; infinite where nothing is known yet.
    pub stiffness_half_width: Vec<f32>,
    /// B.
    pub damping: Vec<f32>,
    /// Half-width of the 95 % interval of B.
    pub damping_half_width: Vec<f32>,
    /// Force minus what the estimate before this sample predicted.
    pub innovation: Vec<f32>,
    /// Summary over the samples in contact whose interval is finite, `None` where there are none.
    pub summary: Option<Summary>,
}

/// The figures of one method over one trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Median of K.
    pub stiffness: f64,
    /// Median half-width of its interval.
    pub stiffness_half_width: f64,
    /// Median of B.
    pub damping: f64,
    /// Median half-width of its interval.
    pub damping_half_width: f64,
    /// 100 rms(innovation) / rms(force) over contact.
    pub rmse_percent: f64,
}

impl Page {
    /// Writes the page.
    ///
    /// # Errors
    /// Whatever `out` reports.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let _ = out;
        Ok(())
    }
}
