//! A trial as it was recorded, and its file.

use std::path::Path;

use anyhow::{Context, Result};

use crate::case_spec::CaseSpec;
use crate::closed_loop::{SAMPLE_PERIOD_S, SimulatedTrial};
use crate::rng::CaseRng;
use crate::scale::Unit;
use crate::sensors::Sensors;

/// The columns of one trial in the units of the case.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedTrial {
    /// Name, digits behind the decimal point and values of each.
    pub columns: Vec<(&'static str, usize, Vec<f64>)>,
}

/// The channels that a case records besides time.
#[must_use]
pub fn channels(plan: &CaseSpec) -> Vec<&'static str> {
    let rotary = plan.scale.rotary;
    let pick = |linear, turned| if rotary { turned } else { linear };
    let mut names = vec![pick("position_m", "position_rad"), pick("force_N", "torque_Nm")];
    if plan.effort {
        names.push(pick("effort_N", "effort_Nm"));
    }
    names.push(pick("reference_m", "reference_rad"));
    names
}

impl RecordedTrial {
    /// Reads `track` with the sensors' noise.
    #[must_use]
    pub fn new(
        track: &SimulatedTrial,
        reference: &[f64],
        plan: &CaseSpec,
        sensors: &Sensors,
        rng: &mut CaseRng,
    ) -> Self {
        let (length, force) = (plan.scale.apply(1.0, Unit::Length), plan.scale.apply(1.0, Unit::Force));
        let scaled = |values: &[f64], by: f64| values.iter().map(|value| value * by).collect::<Vec<_>>();
        let readings: Vec<_> = track.force.iter().map(|value| sensors.read_force(*value, rng)).collect();
        let places = (digits(sensors.position_step * length), digits(sensors.force_step * force));
        let mut values = vec![(places.0, scaled(&track.reading, length)), (places.1, scaled(&readings, force))];
        if plan.effort {
            values.push((places.1 + 2, scaled(&track.effort, force)));
        }
        values.push((places.0 + 2, scaled(reference, length)));
        let time = (0..track.force.len()).map(|row| row as f64 * SAMPLE_PERIOD_S).collect();
        let others = channels(plan).into_iter().zip(values).map(|(name, (digits, values))| (name, digits, values));
        Self { columns: std::iter::once(("t_s", 3, time)).chain(others).collect() }
    }

    /// Writes the file at `path`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        let file = || format!("cannot write {}", path.display());
        let mut writer = csv::Writer::from_path(path).with_context(file)?;
        writer.write_record(self.columns.iter().map(|(name, ..)| name)).with_context(file)?;
        let rows = self.columns.first().map_or(0, |(.., values)| values.len());
        for row in 0..rows {
            let cells = self.columns.iter().map(|(_, digits, values)| format!("{:.digits$}", values[row]));
            writer.write_record(cells).with_context(file)?;
        }
        writer.flush().with_context(file)
    }
}

/// Digits behind the point that keep a multiple of `step` within a hundredth of it.
fn digits(step: f64) -> usize {
    (2.0 - step.log10().floor()).max(0.0) as usize
}
