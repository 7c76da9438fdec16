//! What `palpate simulate` needs of a trial that a rig file does not state, taken from a recording: so that every improved rig runs.

use crate::recording::Recording;
use crate::reference::is_bench_sized;
use crate::rig::{Control, Reference, Rig, Simulation};

/// Smoothing of the commanded pulses, as a part of the shorter of their two levels.
const SMOOTHING: f64 = 0.1;

/// Corner of the position loop, rad/s, times the smoothing: the drive follows what is commanded within a tenth of it.
const STIFF_LOOP: f64 = 10.0;

/// Rows of the controller, and of the simulation, for a radian of the loop.
const ROWS_A_RADIAN: f64 = 10.0;

/// `improved`, with control, reference and length of trial where the file `given` has neither and those of the bench do not fit: pulses
/// between the ends of the position of `trial`, as many as it has, and a controller that follows them.
#[must_use]
pub fn runnable(given: &Rig, improved: &Rig, trial: &Recording) -> Rig {
    let mut rig = improved.clone();
    let lacks_control = given.control.is_none() && given.drive.is_some();
    if is_bench_sized(improved) || !(lacks_control || given.reference.is_none()) {
        return rig;
    }
    let Some(motion) = pulses(trial, improved.surface()) else { return rig };
    if given.reference.is_none() {
        rig.reference = Some(motion);
    }
    let smoothing_s = rig.reference.map_or(motion.smoothing_s, |reference| reference.smoothing_s);
    let corner = STIFF_LOOP / smoothing_s;
    let usual = Simulation::default();
    let rate_hz = short((ROWS_A_RADIAN * corner).max(usual.rate_hz));
    if let (true, Some(drive)) = (lacks_control, improved.drive) {
        rig.control = Some(Control {
            proportional: short(drive.inertia * corner * corner),
            derivative: short(2.0 * drive.inertia * corner),
            derivative_filter_hz: None,
            effort_saturation: f64::INFINITY,
            rate_hz,
        });
    }
    if given.simulation == usual {
        // Two periods show what one shows, and that it comes again.
        let periods = 2.0 * rig.reference.map_or(motion.period_s, |reference| reference.period_s);
        rig.simulation = Simulation { duration_s: periods, rate_hz: short(rate_hz.min(MOST_ROWS / periods)) };
    }
    rig
}

/// Rows of a simulated trial that are enough for any picture.
const MOST_ROWS: f64 = 200_000.0;

/// Four significant digits: nothing here is known better.
fn short(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Pulses between the least and the greatest position, depths counted from `surface`; `None` where nothing moves.
fn pulses(trial: &Recording, surface: f64) -> Option<Reference> {
    let low = trial.position.iter().copied().fold(f64::INFINITY, f64::min);
    let high = trial.position.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (first, last) = (trial.time.first()?, trial.time.last()?);
    let duration = last - first;
    if !(high > low && duration > 0.0) {
        return None;
    }
    // A quarter of the travel to both sides of its middle: noise there is no pulse.
    let (lower, upper) = (low + 0.25 * (high - low), high - 0.25 * (high - low));
    let (mut is_up, mut rises, mut above) = (false, 0_u32, 0.0);
    for (step, position) in trial.time.windows(2).zip(&trial.position) {
        if !is_up && *position > upper {
            (is_up, rises) = (true, rises + 1);
        } else if is_up && *position < lower {
            is_up = false;
        }
        above += if is_up { step[1] - step[0] } else { 0.0 };
    }
    let period_s = duration / f64::from(rises.max(1));
    let contact_s = (above / f64::from(rises.max(1))).clamp(0.1 * period_s, 0.9 * period_s);
    Some(Reference {
        free_depth: short(low - surface),
        contact_depth: short(high - surface),
        period_s: short(period_s),
        contact_s: short(contact_s),
        smoothing_s: short(SMOOTHING * contact_s.min(period_s - contact_s)),
        sine_amplitude: 0.0,
        sine_frequency_hz: 0.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn swings() -> Recording {
        let time: Vec<f64> = (0..=4000).map(|row| 1e-3 * f64::from(row)).collect();
        let position = time.iter().map(|t| 0.5 - 1.5 * (std::f64::consts::PI * t).cos()).collect();
        Recording { name: "swings.csv".into(), time, position, ..Recording::default() }
    }

    #[test]
    fn two_swings_are_two_pulses_between_their_ends() {
        let pulses = pulses(&swings(), 0.25).unwrap();
        assert!((pulses.free_depth + 1.25).abs() < 1e-9 && (pulses.contact_depth - 1.75).abs() < 1e-9, "{pulses:?}");
        assert!((pulses.period_s - 2.0).abs() < 1e-9, "{pulses:?}");
        // Up from -cos = 1/2 until it is -1/2 again: half of each period.
        assert!((pulses.contact_s - 1.0).abs() < 2e-3, "{pulses:?}");
        assert!(super::pulses(&Recording { position: vec![1.0; 4001], ..swings() }, 0.0).is_none());
    }

    #[test]
    fn a_rig_that_states_neither_control_nor_reference_runs_with_those_of_the_recording() {
        let text =
            "[rig]\nname = \"arm\"\ncoordinate = \"rotary\"\n[drive]\ninertia_kg_m2 = 0.15\nviscous_n_m_s_rad = 0.05\n";
        let rig = Rig::parse(text, "arm.toml").unwrap();
        assert!(crate::simulate::simulate(&rig, 1, "arm.toml").is_err());
        let trial = crate::simulate::simulate(&runnable(&rig, &rig, &swings()), 1, "arm.toml").unwrap();
        let highest = trial.recording.position.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // The loop is critically damped: it comes to its reference from below, within a per cent after ten time constants.
        assert!((highest - 2.0).abs() < 0.06, "{highest}");
    }

    #[test]
    fn what_the_file_states_stays() {
        let bench = Rig::parse(include_str!("../../../rigs/bench.toml"), "bench.toml").unwrap();
        assert_eq!(runnable(&bench, &bench, &swings()), bench);
    }
}
