//! What a rig file leaves open, filled in or demanded.

use crate::effects::{ActiveEffect, Place, Resolved, resolve_all};
use crate::error::InputError;
use crate::reference::{self, is_bench_sized};
use crate::rig::{Control, Reference, Rig, Simulation};

/// Most rows of a recording: 4 GB of text.
const MAX_ROWS: f64 = 5e7;

/// The paper's controller.
const CONTROL: Control = Control {
    proportional: 775.0,
    derivative: 10.0,
    derivative_filter_hz: None,
    effort_saturation: 25.0,
    rate_hz: 1000.0,
};

/// A step of the paper's encoder at the tool, m; of its force sensor, N; and that sensor's noise, N.
const POSITION_RESOLUTION: f64 = 1e-4;
const FORCE_RESOLUTION: f64 = 0.05;
const FORCE_NOISE: f64 = 0.09;

/// Shortest period of the pulses, over the time that smooths them: as many of them are under way at any moment as it is short.
const MIN_PERIOD_FRACTION: f64 = 0.01;

/// A rig with nothing left open.
pub struct CompletedRig {
    pub rig: Rig,
    pub effects: Vec<Resolved>,
    pub control: Control,
    pub reference: Reference,
    pub simulation: Simulation,
    pub position_resolution: f64,
    pub force_resolution: f64,
    pub force_noise: f64,
    pub force_zero: f64,
    pub notices: Vec<String>,
}

impl CompletedRig {
    /// The effects at work.
    pub fn actives(&self) -> Vec<ActiveEffect<'_>> {
        self.effects.iter().map(Resolved::active).collect()
    }

    /// Whether an effect acts on the motion or on the force behind it, not on its reading alone.
    pub fn has_motion_effects(&self) -> bool {
        self.effects.iter().any(|resolved| resolved.effect.spec().place != Place::Sensor)
    }
}

/// Fills in what `rig` leaves open.
pub fn complete(rig: &Rig, origin: &str) -> Result<CompletedRig, InputError> {
    refuse_unable(rig, origin)?;
    let fits = is_bench_sized(rig);
    let mut notices = Vec::new();
    let demand = |table: &str, keys: &str| {
        let found = "nothing, and the bench's millimetres and newtons do not fit this rig";
        InputError::new(format!("{origin}: [{table}]"), found, format!("a table [{table}] with {keys}"))
    };
    let control = match (rig.control, rig.drive) {
        (Some(control), _) => control,
        (None, Some(_)) if !fits => return Err(demand("control", "the gains of the drive's controller")),
        _ => CONTROL,
    };
    let reference = match rig.reference {
        Some(reference) => reference,
        None if !fits => return Err(demand("reference", "the depths and times of the commanded trajectory")),
        None => reference::BENCH,
    };
    if reference.period_s < MIN_PERIOD_FRACTION * reference.smoothing_s {
        return Err(InputError::new(
            format!("{origin}: [reference] period_s"),
            reference.period_s,
            format!(
                "at least {} s, a hundredth of smoothing_s: shorter pulses are smoothed away",
                MIN_PERIOD_FRACTION * reference.smoothing_s
            ),
        ));
    }
    let sensors = rig.sensors;
    let open =
        sensors.position_resolution.is_none() || sensors.force_resolution.is_none() || sensors.force_noise.is_none();
    if !fits && open {
        notices.push(format!("note: {origin}: what [sensors] leaves out is taken as ideal: no steps, no noise"));
    }
    let or_bench = |given: Option<f64>, bench: f64| given.unwrap_or(if fits { bench } else { 0.0 });
    Ok(CompletedRig {
        rig: rig.clone(),
        effects: resolve_all(rig, origin)?,
        control,
        reference,
        simulation: rig.simulation,
        position_resolution: or_bench(sensors.position_resolution, POSITION_RESOLUTION),
        force_resolution: or_bench(sensors.force_resolution, FORCE_RESOLUTION),
        force_noise: or_bench(sensors.force_noise, FORCE_NOISE),
        force_zero: sensors.force_zero.unwrap_or(0.0),
        notices,
    })
}

fn refuse_unable(rig: &Rig, origin: &str) -> Result<(), InputError> {
    if rig.drive.is_none() && rig.contact.is_none() {
        return Err(InputError::new(origin, "neither [drive] nor [contact]", "at least one of them to simulate"));
    }
    let rows = rig.simulation.duration_s * rig.simulation.rate_hz;
    if !(1.0..=MAX_ROWS).contains(&rows) {
        let place = format!("{origin}: [simulation]");
        return Err(InputError::new(
            place,
            format!("{rows} rows (duration_s times rate_hz)"),
            format!("1 to {MAX_ROWS}"),
        ));
    }
    Ok(())
}
