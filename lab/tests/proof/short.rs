//! The cases that run with all other tests: a clear effect each, on coarse and on fine sensors.

use palpate_cases::sensors::Grade;
use palpate_cases::{What, Wish, reference};

/// Of all of them.
pub const SEED: u64 = 2026;

/// Cases that are answered rightly, by index and wish.
pub fn cases() -> Vec<(u64, Wish)> {
    vec![
        single("force_bias", 0, Grade::Coarse),
        single("hunt_crossley_damping", 0, Grade::Fine),
        single("stress_relaxation", 0, Grade::Fine),
        (1, wish(What::single("gravity_load", Some(3.0)), Grade::Fine, true)),
        (1, wish(What::Nothing, Grade::Coarse, false)),
        (0, wish(What::Nothing, Grade::Fine, false)),
        (1, wish(What::Nothing, Grade::Fine, false)),
        single("plastic_set", 0, Grade::Fine),
    ]
}

/// Cases of the same kind that are not: alarms where nothing is missing, an unknown beside the right name, a wrong name.
pub fn open() -> Vec<(u64, Wish)> {
    vec![
        (0, wish(What::Nothing, Grade::Coarse, false)),
        (2, wish(What::Nothing, Grade::Coarse, false)),
        single("adhesion", 0, Grade::Coarse),
        single("nonlinear_stiffness", 0, Grade::Coarse),
        single("force_saturation", 0, Grade::Coarse),
        (0, wish(What::single("gravity_load", Some(3.0)), Grade::Coarse, true)),
    ]
}

fn single(name: &str, index: u64, sensors: Grade) -> (u64, Wish) {
    (index, wish(What::single(name, Some(3.0)), sensors, false))
}

/// At the size of a bench, with trajectories that show everything.
fn wish(what: What, sensors: Grade, effort: bool) -> Wish {
    Wish {
        what: Some(what),
        sensors: Some(sensors),
        reference: Some(reference::Kind::Rich),
        effort: Some(effort),
        rotary: Some(false),
        bilateral: Some(false),
        bench: Some(true),
        exact: None,
    }
}
