//! The force that a law lacks along a trial, in one measure for every law.

use super::filter::innovations;
use super::law::DriveLaw;
use super::noise::Noise;
use super::trial::DriveTrial;

/// Smoothed force that `law` lacks, N or N m, row by row, smoothed with the `common` noise of all laws that are compared.
///
/// Of two bodies only one is measured, and the louder the disturbance the less the other is known: with `common` noise a link could
/// explain nothing. So such a law is followed with its `own` noise, and what that leaves of the encoder's rows is told as the force that
/// would move the rigid body so. For a rigid law, which is linear in both, the sum is the same force.
#[must_use]
pub fn missing_force(trial: &DriveTrial, law: &DriveLaw, own: &Noise, common: &Noise) -> Vec<f64> {
    if law.link.is_none() {
        return innovations(trial, law, common, true).disturbance;
    }
    let pass = innovations(trial, law, own, true);
    let left = DriveTrial { position: pass.residual, force: None, ..trial.clone().without_effort() };
    let viscous = law.viscous + law.link.map_or(0.0, |link| link.load_viscous);
    let rigid = DriveLaw::nominal(law.inertia, viscous, 0.0);
    let beside = innovations(&left, &rigid, common, true).disturbance;
    pass.disturbance.iter().zip(beside).map(|(own, beside)| own + beside).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::law::{Link, Side};
    use crate::diagnose::drive::testing::TestDrive;

    #[test]
    fn behind_a_stiff_link_the_force_that_is_missing_is_that_of_the_rigid_body() {
        let drive = TestDrive { load: 0.3, ..TestDrive::PLAIN };
        let trial = drive.trial(4.0, 5);
        let own = Noise { ln_disturbance: (1e-12f64).ln(), ln_encoder: drive.encoder.powi(2).ln() };
        let common = own.with_crossing(20.0, 1e-3, 0.8);
        let rigid = DriveLaw::nominal(0.8, 4.0, 0.0);
        let seen_from = |encoder: Side| {
            let link = Link { stiffness: 4e5, damping: 200.0, play: 0.0, load_share: 0.4, load_viscous: 0.0, encoder };
            DriveLaw { link: Some(link), ..rigid.clone() }
        };
        for law in [rigid.clone(), seen_from(Side::Motor), seen_from(Side::Load)] {
            let missing = missing_force(&trial, &law, &own, &common);
            let inner = &missing[500..3500];
            let mean = inner.iter().sum::<f64>() / inner.len() as f64;
            // As of the smoother alone: the mean over 3 s of a band of 20 Hz is known to a hundredth of the noise in it, 15 mN.
            assert!((mean + 0.3).abs() < 2e-3, "{mean}");
        }
    }
}
