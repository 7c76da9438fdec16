//! From the motion that is wanted to the reference that makes the closed loop follow it.

use super::loop_model::LoopModel;
use crate::rig::Rig;

/// The reference, one position a row, under which the loop's error makes the controller push as the path needs:
/// proportional e + derivative de/dt = m a + b v + F, F the rig's nominal contact force. `path` holds position, velocity and
/// acceleration row by row.
#[must_use]
pub fn reference_along(path: &[[f64; 3]], rig: &Rig, closed_loop: &LoopModel) -> Vec<f64> {
    let drive = rig.drive.unwrap_or(closed_loop.drive);
    let control = closed_loop.control;
    // The derivative gain is a lag of the error by derivative / proportional.
    let kept = if control.derivative > 0.0 {
        (-control.proportional / control.derivative / closed_loop.rate_hz).exp()
    } else {
        0.0
    };
    let mut error = None;
    let follow = |&[x, v, a]: &[f64; 3]| {
        let force = rig.contact.map_or(0.0, |contact| {
            let force = contact.stiffness * (x - contact.surface) + contact.damping * v;
            if contact.bilateral || (x > contact.surface && force > 0.0) { force } else { 0.0 }
        });
        let needed = (drive.inertia * a + drive.viscous * v + force) / control.proportional;
        let next = needed + kept * (error.unwrap_or(needed) - needed);
        error = Some(next);
        x + next
    };
    path.iter().map(follow).collect()
}
