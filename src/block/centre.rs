//! The centre of a run of samples, the estimate that its residuals are taken about: which may be one, and when another suits better.

use crate::block::exact_run::ExactRun;
use crate::block::second_order::Moments;
use crate::contact::Impedance;
use crate::math::sym2::Sym2;

/// Share of the residual energy about the centre above which the estimate does not become the new centre.
const MAX_REMAINING_FRACTION: f32 = 0.25;

/// Share of the energy of the predicted force above which a move of the centre is no small part.
const MAX_MOVE_FRACTION: f32 = 0.5;

/// Multiple of B's own part of the right side from which on the other parts' rounding matters: 16 last digits are 1e-6 of B.
const MAX_CANCELLATION: f32 = 16.0;

/// Magnitude of a centre beyond which its residuals could leave the finite numbers.
const MAX_CENTRE: f32 = 1e30;

/// Whether the residuals about `centre` stay within the finite numbers.
pub fn is_moderate(centre: Impedance) -> bool {
    centre.stiffness.abs() + centre.damping.abs() <= MAX_CENTRE
}

/// Whether `estimate` is to become the centre of `run`: it leaves much less of the residual, and rounding about the old centre would show.
/// That is so where the move is no small part of the estimate, and where B has to be separated from the much larger part that K has in the
/// right side, or from columns that are nearly in line.
pub fn suits_better(estimate: Impedance, run: &ExactRun) -> bool {
    let sums = run.moments();
    let move_to = estimate.moved(-1.0, run.centre);
    if sums.shifted(move_to).residual_energy > MAX_REMAINING_FRACTION * sums.residual_energy {
        return false;
    }
    let Sym2 { xx, xv, vv } = sums.regressors;
    let parts = (xv * sums.residual.stiffness).abs() + (xx * sums.residual.damping).abs();
    let own = (xx * vv - xv * xv) * estimate.damping;
    let far = sums.regressors.quadratic(move_to) > MAX_MOVE_FRACTION * sums.regressors.quadratic(estimate);
    far || parts > MAX_CANCELLATION * own.abs()
}
