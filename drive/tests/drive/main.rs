//! The drive crate on a host: what a sensor, a link or a fault does, without hardware.

mod calibration;
mod effort;
mod faults;
mod limits;
mod link;
mod sensors;
mod weather;

use palpate_drive::{
    Bounds, Calibration, Counters, Cycle, Estimator, Faults, Input, InputStatus, Report, Settings, ads8681, as5047p,
};
use std::f64::consts::TAU;

const K: f64 = 300.0;
const B: f64 = 5.0;

/// A machine that goes 30 mm either way.
const CALIBRATION: Calibration = Calibration { travel: [-0.03, 0.03], ..Calibration::DEFAULT };

/// A sound answer to DIAAGC: loops ready, gain in the middle.
const SOUND: u16 = 1 << 8 | 0x80;

/// The words of a tool at `depth`, pushing with `force`.
fn words(depth: f64, force: f64) -> Input {
    let c = CALIBRATION;
    let counts = (depth / f64::from(c.position_per_count())).round() as i32;
    let code = (force / f64::from(c.force_gain)).round() as i32 + 0x8000;
    Input {
        angle: as5047p::with_parity(c.angle_of(counts)),
        diagnostics: as5047p::with_parity(SOUND),
        force: ads8681::word(u16::try_from(code).expect("a code"), c.range),
        elapsed: 1,
        status: InputStatus::empty(),
    }
}

/// A dithered contact at tick `k`: 10 to 17 mm deep, with a count or two of noise as sensors have it.
fn dithered(k: u32) -> Input {
    let t = f64::from(k) * 1e-3;
    let (x, v) = (13.5e-3 + 3.3e-3 * (TAU * 10.0 * t).sin(), 3.3e-3 * TAU * 10.0 * (TAU * 10.0 * t).cos());
    let noise = f64::from(k.wrapping_mul(2_654_435_761) >> 24) / 255.0 - 0.5;
    words(x + 5e-6 * noise, K * x + B * v + 5e-3 * noise)
}

/// Runs `work` with a cycle that begins with `found`.
fn with_cycle<T>(settings: Settings, found: Faults, work: impl FnOnce(&mut Cycle<'_>, &Counters) -> T) -> T {
    with_calibrated_cycle(CALIBRATION, settings, found, work)
}

/// As [`with_cycle`], with a calibration of its own.
fn with_calibrated_cycle<T>(
    calibration: Calibration,
    settings: Settings,
    found: Faults,
    work: impl FnOnce(&mut Cycle<'_>, &Counters) -> T,
) -> T {
    let mut estimator = Estimator::new(&settings, &calibration, 0).expect("sound settings");
    let counters = Counters::new();
    let mut cycle = Cycle::new(calibration, &mut estimator, &counters, Bounds::NO_EFFORT, found);
    work(&mut cycle, &counters)
}

/// Numbers that a user may read, and a flag on every one that is not this tick's.
#[track_caller]
fn assert_honest(report: &Report) {
    use palpate::Flags;
    use palpate_drive::Validity;
    let e = &report.estimate;
    let sound = e.impedance.is_finite() && e.half_width.stiffness >= 0.0 && e.half_width.damping >= 0.0;
    assert!(sound && report.effort == 0.0, "{report:?}");
    if report.validity == Validity::Live {
        assert!(report.sample.is_some(), "{report:?}");
    } else {
        assert!(!report.faults.is_empty() && e.flags.contains(Flags::HELD) && report.sample.is_none(), "{report:?}");
    }
    if report.validity == Validity::Void {
        let nothing = e.impedance.stiffness == 0.0 && e.half_width.stiffness == f32::INFINITY;
        assert!(nothing, "{report:?}");
    }
}
