//! From recordings and a rig file to the drive's trials and nominal law.

use super::criteria::INERTIA_FACTOR;
use super::nominal::NominalDrive;
use super::trial::DriveTrial;
use crate::effects::Resolved;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;

/// Rows that are looked at of all trials together: more are thinned, with the effort's mean over each interval exact.
const MOST_ROWS: usize = 45_000;

/// Recorded rows that become one encoder row.
fn thinning(rows: usize) -> usize {
    rows.div_ceil(MOST_ROWS).max(1)
}

/// Whether the rig has a drive whose effort every trial holds.
#[must_use]
pub fn is_recorded(rig: &Rig, trials: &[Recording]) -> bool {
    rig.drive.is_some() && !trials.is_empty() && trials.iter().all(|trial| trial.effort.is_some())
}

/// The trials as the drive's model sees them. The contact force counts where the rig has a contact and every trial holds it: else a
/// force column is none that the rig speaks of.
#[must_use]
pub fn trials(rig: &Rig, recordings: &[Recording]) -> Vec<DriveTrial> {
    let every = thinning(recordings.iter().map(|trial| trial.time.len()).sum());
    let touches = rig.contact.is_some() && recordings.iter().all(|trial| trial.force.is_some());
    let trial = |recording: &Recording| {
        let effort = recording.effort.clone().unwrap_or_default();
        let force = recording.force.clone().filter(|_| touches);
        let noise = Figures::of(rig, recording).force.filter(|_| touches).map_or(0.0, |channel| channel.noise);
        let trial =
            DriveTrial::new(recording.name.clone(), recording.time.clone(), &recording.position, effort, force, every);
        let scale = rig.drive.map_or(1.0, |drive| drive.load_scale);
        let load = recording.load.as_ref().map(|load| load.iter().map(|load| scale * load).collect());
        DriveTrial { load, force_density: noise * noise * trial.recorded_period_s, ..trial }
    };
    recordings.iter().map(trial).collect()
}

/// What `rig` says of its drive, with the effects that it already holds.
#[must_use]
pub fn nominal(rig: &Rig, recordings: &[Recording], effects: Vec<Resolved>) -> Option<NominalDrive> {
    let drive = rig.drive?;
    let steps = recordings.iter().map(|trial| Figures::of(rig, trial).position.resolution);
    Some(NominalDrive {
        inertia_factor: INERTIA_FACTOR.value(),
        inertia: drive.inertia,
        viscous: drive.viscous,
        is_rotary: rig.coordinate == crate::rig::Coordinate::Rotary,
        encoder: drive.encoder,
        resolution: steps.fold(0.0, f64::max),
        effects,
    })
}
