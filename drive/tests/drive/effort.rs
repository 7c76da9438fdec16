//! The effort that leaves the drive.

use palpate::{Estimate, Flags, Impedance, Sample};
use palpate_drive::{Bounds, Faults, Validity, effort, trusted};

const BOUNDS: Bounds = Bounds {
    least: Impedance { stiffness: 50.0, damping: 0.5 },
    most: Impedance { stiffness: 5_000.0, damping: 100.0 },
    effort: 10.0,
};
const SAMPLE: Sample = Sample { position: 0.01, force: 3.0, elapsed: 1e-3 };

fn estimate(stiffness: f32, damping: f32) -> Estimate {
    Estimate { impedance: Impedance { stiffness, damping }, flags: Flags::empty(), ..Estimate::NO_CONTACT }
}

/// A controller that pushes by all it has.
fn strong(contact: Option<Impedance>) -> f32 {
    effort(contact, Some(SAMPLE), &BOUNDS, |contact, _| 1e3 * contact.stiffness)
}

#[test]
fn what_is_trusted_stays_within_what_the_controller_was_designed_for() {
    let of = |k, b| trusted(&estimate(k, b), Validity::Live, Faults::empty(), &BOUNDS);
    assert_eq!(of(300.0, 5.0), Some(Impedance { stiffness: 300.0, damping: 5.0 }));
    assert_eq!(of(1e9, -3.0), Some(Impedance { stiffness: 5_000.0, damping: 0.5 }));
    assert_eq!(of(f32::NAN, 5.0), None);
    assert_eq!(strong(of(300.0, 5.0)), 10.0, "and the effort within its own bound");
    assert_eq!(effort(of(300.0, 5.0), Some(SAMPLE), &BOUNDS, |_, _| f32::NAN), 0.0);
    assert_eq!(effort(of(300.0, 5.0), Some(SAMPLE), &BOUNDS, |_, _| f32::NEG_INFINITY), 0.0);
}

#[test]
fn any_single_fault_and_any_doubt_makes_the_effort_zero() {
    let sound = estimate(300.0, 5.0);
    for fault in Faults::all() {
        assert_eq!(strong(trusted(&sound, Validity::Live, fault, &BOUNDS)), 0.0, "{}", fault.name());
    }
    for validity in [Validity::Held, Validity::Void] {
        assert_eq!(strong(trusted(&sound, validity, Faults::empty(), &BOUNDS)), 0.0, "{validity:?}");
    }
    for flags in [Flags::NO_CONTACT, Flags::HELD, Flags::TOO_FEW, Flags::STIFFNESS_UNCERTAIN] {
        let doubtful = Estimate { flags, ..sound };
        assert_eq!(strong(trusted(&doubtful, Validity::Live, Faults::empty(), &BOUNDS)), 0.0, "{flags:?}");
    }
    assert_eq!(effort(Some(Impedance { stiffness: 300.0, damping: 5.0 }), None, &BOUNDS, |_, _| 5.0), 0.0);
}
