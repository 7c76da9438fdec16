//! Recordings without the noise of their effort and force, where that does not drive.

use super::candidates::belongs;
use super::fit::{Effort, Fit, fit};
use super::likelihood::Data;
use super::trial::DriveTrial;

/// Densities of the noise in effort or force that are tried, over that of what changes from row to row: noise that keeps half of itself to the next
/// row has nine times as much at low frequencies as at the highest.
const LEVELS: [f64; 4] = [1.0, 2.0, 4.0, 8.0];

/// The trials of `data` with as much noise taken out of effort and force as makes the encoder's rows likeliest under the law of `nominal`. `None`
/// where nothing does so by as much as a value of a law has to, or takes too small a share of the force that is not explained: what looks like
/// noise drives, too, as where a controller commands it, or it hardly matters, and a law that lacks physics may be likelier by chance behind a
/// smoother input. Both are densities of the same rows.
#[must_use]
pub fn denoised(data: &Data<'_>, nominal: &Fit) -> Option<Vec<DriveTrial>> {
    if data.trials.iter().any(|trial| trial.noise_filter.is_some()) {
        return None;
    }
    let of_effort = LEVELS.iter().fold(None, |best, level| better(data, nominal, best, [*level, 0.0]));
    let touches = data.trials.iter().any(|trial| trial.force.is_some());
    let effort = of_effort.as_ref().map_or(0.0, |best| best.levels[0]);
    let of_force: &[f64] = if touches { &LEVELS } else { &[] };
    let best = of_force.iter().fold(of_effort, |best, level| better(data, nominal, best, [effort, *level]));
    best.map(|best| best.trials)
}

/// Trials without noise, and how the law stands before them.
struct Denoised {
    levels: [f64; 2],
    trials: Vec<DriveTrial>,
    fit: Fit,
}

/// `best`, or the trials of `data` without noise of `levels` in effort and force, where the law is likelier before them.
fn better(data: &Data<'_>, nominal: &Fit, best: Option<Denoised>, levels: [f64; 2]) -> Option<Denoised> {
    let trials: Vec<DriveTrial> = data.trials.iter().map(|trial| trial.denoised(levels)).collect();
    let fit = fit(&Data { trials: &trials, ..*data }, &nominal.model, &nominal.values, nominal.noise, Effort::FULL);
    let is_better = match &best {
        Some(best) => fit.log_likelihood > best.fit.log_likelihood,
        None => belongs(data, &fit, nominal),
    };
    if is_better { Some(Denoised { levels, trials, fit }) } else { best }
}

#[cfg(test)]
mod tests {
    use super::super::model::{Model, index};
    use super::super::noise::Noise;
    use super::super::testing::{SCALES, TestDrive};
    use super::*;

    fn fitted(trials: &[DriveTrial]) -> Fit {
        let data = Data { trials, least_encoder_variance: 7.5e-12 };
        let noise = Noise { ln_disturbance: -8.0, ln_encoder: (25e-12f64).ln() };
        fit(&data, &Model { terms: Vec::new(), scales: SCALES }, &[0.8, 4.0, 0.0, 0.0], noise, Effort::FULL)
    }

    /// Noise of 1 N: a law that is driven by it finds an inertia that is more than a twentieth too large. Its own likelihood finds the noise's level.
    #[test]
    fn an_inertia_is_not_made_larger_by_noise_of_the_effort() {
        for memory in [0.0, 0.5] {
            let drive = TestDrive { effort_noise: 1.0, effort_memory: memory, ..TestDrive::PLAIN };
            let trials = [drive.trial(6.0, 11), drive.trial(6.0, 12)];
            let data = Data { trials: &trials, least_encoder_variance: 7.5e-12 };
            let nominal = fitted(&trials);
            let inertia = |fit: &Fit| fit.values[index::INERTIA] / drive.mass - 1.0;
            let without = denoised(&data, &nominal).expect("noise that does not drive");
            let (before, after) = (inertia(&nominal), inertia(&fitted(&without)));
            assert!(before > 0.05 && after.abs() < 0.3 * before, "{memory}: {before} {after}");
        }
    }

    /// The encoder's noise, fed back: the drive moves by it.
    #[test]
    fn noise_that_a_controller_commands_stays() {
        let drive = TestDrive { encoder: 5e-5, ..TestDrive::PLAIN };
        let trials = [drive.trial(6.0, 13)];
        let data = Data { trials: &trials, least_encoder_variance: 7.5e-10 };
        assert!(denoised(&data, &fitted(&trials)).is_none());
    }
}
