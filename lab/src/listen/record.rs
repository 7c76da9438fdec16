//! What was heard, as a recording of our format and the rig file that belongs to it.

use std::io::Write as _;

use anyhow::{Context as _, Result, ensure};
use palpate_drive::link::SampleMessage;
use palpate_drive::{Calibration, Settings, TICK_HZ};

use crate::outfile::OutFile;
use crate::recording::Recording;
use crate::rig::{Contact, Coordinate, Rig, Sensors};

/// Samples as the drive took them.
#[derive(Debug, Clone, Default)]
pub struct Taken {
    ticks: Vec<u32>,
    position: Vec<f64>,
    force: Vec<f64>,
    begun: bool,
    restarts: usize,
    last: Option<u32>,
    unheard: u32,
}

impl Taken {
    /// Takes a sample. Those before the estimator began anew are no part of the recording.
    pub fn take(&mut self, seen: &SampleMessage) {
        let steps = u32::from(seen.input.elapsed.max(1));
        if let Some(last) = self.last.replace(seen.tick) {
            self.unheard += seen.tick.wrapping_sub(last).saturating_sub(steps);
        }
        if seen.restarted && !self.begun {
            self.begun = true;
        } else if seen.restarted {
            self.restarts += 1;
        }
        let Some([position, force]) = seen.taken.filter(|_| self.begun) else { return };
        self.ticks.push(seen.tick);
        self.position.push(position.into());
        self.force.push(force.into());
    }

    /// Samples so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ticks.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ticks.is_empty()
    }

    /// The recording: time from the first sample, depth below the surface, force above its zero.
    #[must_use]
    pub fn recording(&self) -> Recording {
        let first = self.ticks.first().copied().unwrap_or(0);
        let seconds = |tick: &u32| f64::from(tick.wrapping_sub(first)) / f64::from(TICK_HZ);
        Recording {
            time: self.ticks.iter().map(seconds).collect(),
            position: self.position.clone(),
            force: Some(self.force.clone()),
            ..Recording::default()
        }
    }

    /// Warnings for who replays it.
    #[must_use]
    pub fn notices(&self) -> Vec<String> {
        let mut notices = Vec::new();
        if self.unheard > 0 {
            notices.push(format!("{} samples were lost on the way: a replay will differ from there on", self.unheard));
        }
        if self.restarts > 0 {
            notices.push(format!("the drive's estimator began anew {} times: a replay does not", self.restarts));
        }
        notices
    }

    /// Writes the recording and its rig file.
    ///
    /// # Errors
    /// There are fewer than two samples, or a file cannot be written.
    pub fn write(
        &self,
        file: OutFile,
        mut rig_file: OutFile,
        calibration: &Calibration,
        settings: &Settings,
    ) -> Result<()> {
        let recording = self.recording();
        ensure!(recording.time.len() > 1, "the drive took {} samples: nothing was recorded", recording.time.len());
        for notice in self.notices() {
            eprintln!("{notice}");
        }
        let rig = rig(calibration);
        let text = format!(
            "# Of a recording by `palpate listen`. Replay it as the drive did: --method {} --window {} --velocity-cutoff {}\n\
             # --forgetting {}. Stiffness and damping are placeholders: write down what you expect.\n{}",
            settings.method.name(),
            settings.window,
            settings.cutoff,
            settings.forgetting,
            rig.to_toml()
        );
        rig_file.write_all(text.as_bytes()).context("cannot write the rig file")?;
        recording.write_to(file, &rig)?;
        rig_file.commit()?;
        Ok(())
    }
}

/// The rig that a recording of this drive belongs to.
#[must_use]
pub fn rig(calibration: &Calibration) -> Rig {
    Rig {
        name: "drive".to_owned(),
        coordinate: Coordinate::Linear,
        contact: Some(Contact { surface: 0.0, stiffness: 300.0, damping: 5.0, bilateral: false }),
        sensors: Sensors {
            position_resolution: Some(f64::from(calibration.position_per_count().abs())),
            // The drive's noise has the rounding in it already.
            force_resolution: Some(0.0),
            force_noise: Some(f64::from(calibration.force_noise)),
            force_zero: Some(0.0),
        },
        ..Rig::default()
    }
}
