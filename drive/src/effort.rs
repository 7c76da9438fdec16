//! From an estimate to the input of a force controller, and the limits of its effort.

use crate::cycle::Validity;
use crate::faults::Faults;
use palpate::Estimate;
use palpate::Flags;
use palpate::math::{larger, smaller};
use palpate::{Impedance, Sample};

/// Range of estimates accepted for control, and the largest effort.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Least K and B that a controller is designed for.
    pub least: Impedance,
    /// Most K and B.
    pub most: Impedance,
    /// Largest effort to either side [N or N m].
    pub effort: f32,
}

impl Bounds {
    /// The paper's bench, and no effort at all.
    pub const NO_EFFORT: Self = Self {
        least: Impedance { stiffness: 50.0, damping: 0.5 },
        most: Impedance { stiffness: 5_000.0, damping: 100.0 },
        effort: 0.0,
    };
}

/// Flags that exclude an estimate from control.
const DOUBTS: Flags = Flags::NO_CONTACT
    .union(Flags::TOO_FEW)
    .union(Flags::HELD)
    .union(Flags::STIFFNESS_UNCERTAIN)
    .union(Flags::RESTARTED)
    .union(Flags::RESET);

/// K and B for a controller, within `bounds`; `None` on any fault, with a held or void estimate, and where its flags say that
/// nothing is known.
pub fn trusted(estimate: &Estimate, validity: Validity, faults: Faults, bounds: &Bounds) -> Option<Impedance> {
    let sound = validity == Validity::Live && faults.is_empty() && !estimate.flags.intersects(DOUBTS);
    let within = |value: f32, least: f32, most: f32| larger(smaller(value, most), least);
    (sound && estimate.impedance.is_finite()).then(|| Impedance {
        stiffness: within(estimate.impedance.stiffness, bounds.least.stiffness, bounds.most.stiffness),
        damping: within(estimate.impedance.damping, bounds.least.damping, bounds.most.damping),
    })
}

/// The effort for the current loop: the output of `controller` for the estimated impedance and the sample, within the bounds. Zero on any
/// fault, zero where it is not a number, and zero without a trusted impedance.
pub fn effort(
    trusted: Option<Impedance>,
    sample: Option<Sample>,
    bounds: &Bounds,
    controller: impl FnOnce(Impedance, Sample) -> f32,
) -> f32 {
    let wanted = trusted.zip(sample).map_or(0.0, |(contact, sample)| controller(contact, sample));
    if wanted.is_finite() { smaller(larger(wanted, -bounds.effort), bounds.effort) } else { 0.0 }
}
