//! Columns in other units than SI: millimetres, degrees.

use super::checked_trial::{CheckedTrial, range};
use super::ranked_finding::RankedFinding;
use super::wording::{digits, quantity};
use crate::diagnose::quantile::quantile;
use crate::diagnose::thresholds::check_units::FACTOR_TOLERANCE;
use crate::rig::{Coordinate, Rig};

/// Forces that are off the rig's own stiffness by a factor that units make.
pub fn suspicion(rig: &Rig, view: &CheckedTrial<'_>) -> Option<RankedFinding> {
    let contact = rig.contact.filter(|contact| contact.stiffness > 0.0)?;
    let force = range(view.force.as_ref()?);
    let depth = match contact.bilateral {
        true => range(&view.depth),
        false => quantile(view.depth.clone(), 0.99)?,
    };
    let expected = contact.stiffness * depth;
    if depth <= 0.0 || force <= 10.0 * view.noise[2] {
        return None;
    }
    let ratio = force / expected;
    let near = |factor: f64| (ratio / factor).max(factor / ratio) < FACTOR_TOLERANCE;
    let (turn, angle) = (57.295_78, rig.coordinate == Coordinate::Rotary);
    let guess = if near(1e-3) && angle {
        "the position is in thousandths of a radian or the torque in kN m"
    } else if near(1e-3) {
        "the position is in millimetres or the force in kN"
    } else if near(1e3) {
        "the force is in thousandths, or the position in thousands, of what the header says"
    } else if angle && near(1.0 / turn) {
        "the position is in degrees"
    } else {
        return None;
    };
    let text = format!(
        "The force moves by {} where the rig's stiffness times the depth of {} gives {}: {} times. Perhaps {guess}; recordings and rig file are in SI. \
         If the units are right, correct the rig's stiffness or surface.",
        quantity(force, view.push),
        quantity(depth, view.length),
        quantity(expected, view.push),
        digits(ratio),
    );
    Some(RankedFinding::grave("units", view.name(), ratio.ln().abs(), text))
}
