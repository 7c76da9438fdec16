//! The law driven along a trial and corrected at each encoder row: innovations, their variance, and the smoothed disturbance.

use super::innovations::Innovations;
use super::input::Inputs;
use super::law::DriveLaw;
use super::noise::Noise;
use super::one_body_filter::{Gains, one_body};
use super::trial::DriveTrial;
use super::two_body_filter::two_bodies;

/// Drives `law` along `trial`; with `smooth` the disturbance is smoothed, too.
#[must_use]
pub fn innovations(trial: &DriveTrial, law: &DriveLaw, noise: &Noise, smooth: bool) -> Innovations {
    innovations_under(trial, &Inputs::of(trial, law), law, noise, smooth)
}

/// The same under `inputs`, which are those of `law`.
#[must_use]
pub fn innovations_under(
    trial: &DriveTrial,
    inputs: &Inputs,
    law: &DriveLaw,
    noise: &Noise,
    smooth: bool,
) -> Innovations {
    match law.link {
        None => one_body(trial, inputs, law, noise, &Gains::of(trial, law, noise), smooth),
        Some(link) => two_bodies(trial, inputs, law, link, noise, smooth),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::law::{Link, Side};
    use crate::diagnose::drive::testing::TestDrive;

    fn noise(drive: &TestDrive) -> Noise {
        Noise { ln_disturbance: drive.disturbance.max(1e-12).ln(), ln_encoder: drive.encoder.powi(2).ln() }
    }

    #[test]
    fn innovations_of_the_true_law_are_white_and_as_large_as_they_say() {
        let drive = TestDrive { disturbance: 1e-4, ..TestDrive::PLAIN };
        let trial = drive.trial(8.0, 3);
        let pass = innovations(&trial, &DriveLaw::nominal(0.8, 4.0, 0.0), &noise(&drive), false);
        let white: Vec<f64> =
            pass.innovation.iter().zip(pass.variance.iter()).skip(20).map(|(e, s)| e / s.sqrt()).collect();
        let count = white.len() as f64;
        let power = white.iter().map(|w| w * w).sum::<f64>() / count;
        let next = white.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / count;
        // A mean of squares has a deviation of sqrt(2 / n), a product of neighbours one of 1 / sqrt(n); four of each.
        assert!((power - 1.0).abs() < 4.0 * (2.0 / count).sqrt(), "{power}");
        assert!(next.abs() < 4.0 / count.sqrt(), "{next}");
    }

    #[test]
    fn a_constant_force_that_the_law_lacks_is_what_the_smoother_shows() {
        let drive = TestDrive { load: 0.3, ..TestDrive::PLAIN };
        let trial = drive.trial(4.0, 5);
        let noise = noise(&drive).with_crossing(20.0, 1e-3, 0.8);
        let missing = innovations(&trial, &DriveLaw::nominal(0.8, 4.0, 0.0), &noise, true).disturbance;
        let inner = &missing[500..3500];
        let mean = inner.iter().sum::<f64>() / inner.len() as f64;
        // A load takes from the effort: the missing force is its negative. The mean over 3 s of a band of 20 Hz is known to a
        // hundredth of the noise in it, which is 15 mN.
        assert!((mean + 0.3).abs() < 2e-3, "{mean}");
    }

    #[test]
    fn two_bodies_on_a_stiff_link_are_one() {
        let trial = TestDrive::PLAIN.trial(2.0, 7);
        let noise = Noise { ln_disturbance: (1e-6f64).ln(), ln_encoder: (25e-12f64).ln() };
        let one = DriveLaw::nominal(0.8, 4.0, 0.0);
        let link = Link {
            stiffness: 4e5,
            damping: 200.0,
            play: 0.0,
            load_share: 0.4,
            load_viscous: 0.0,
            encoder: Side::Motor,
        };
        let both = DriveLaw { link: Some(link), ..one.clone() };
        let [rigid, linked] = [one, both].map(|law| innovations(&trial, &law, &noise, true));
        let power = |x: &[f64]| x[100..].iter().map(|x| x * x).sum::<f64>();
        let apart: Vec<f64> = rigid.innovation.iter().zip(&linked.innovation).map(|(a, b)| a - b).collect();
        // The link gives by force over stiffness, 5 um a newton for 2 N at most, and a tenth of the encoder's noise in the mean.
        assert!(power(&apart) < 0.05 * power(&rigid.innovation), "{}", power(&apart) / power(&rigid.innovation));
        let rms = |x: &[f64]| (power(x) / (x.len() - 100) as f64).sqrt();
        assert!((rms(&linked.disturbance) / rms(&rigid.disturbance) - 1.0).abs() < 0.2);
    }
}
