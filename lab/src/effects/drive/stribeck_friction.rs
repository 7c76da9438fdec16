//! Friction that is larger when creeping.

use std::f64::consts::FRAC_1_SQRT_2;

use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Limit, Parameter, Place, Stage, Start,
    geometric,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct StribeckFriction;

const NEWTON: Word = Word::new("N", "N m");

const PARAMETERS: &[Parameter] = &[
    Parameter::new("level", NEWTON, "dry friction at speed", 0.0, f64::INFINITY),
    Parameter::new("breakaway_excess", NEWTON, "what creeping adds to it", 0.0, f64::INFINITY),
    Parameter::new(
        "stribeck_speed",
        Word::new("m/s", "rad/s"),
        "speed at which the excess is gone",
        0.0,
        f64::INFINITY,
    )
    .within(Limit::MinSpeed),
];

static SPEC: EffectSpec = EffectSpec {
    name: "stribeck_friction",
    place: Place::Drive,
    stage: Stage::Friction,
    max_instances: 1,
    statement: "The drive rubs, and it rubs more when it creeps than when it runs",
    forms: &[
        Form {
            name: "gaussian",
            equation: "friction = (level + breakaway_excess exp(-(v / stribeck_speed)^2)) sign(v); at rest it holds the sum",
            parameters: PARAMETERS,
        },
        Form {
            name: "exponential",
            equation: "friction = (level + breakaway_excess exp(-|v| / stribeck_speed)) sign(v); at rest it holds the sum",
            parameters: PARAMETERS,
        },
    ],
    excited_by: "slow reversals, beside quick ones",
    resembles: &["coulomb_friction", "load_dependent_friction"],
    source: "R. Stribeck (1902); the exponential: A. Tustin, J. IEE 94 (1947) 143; both: B. Armstrong-Helouvry et al., Automatica 30 (1994) 1083",
};

impl Effect for StribeckFriction {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let level = 0.03 * scene.effort;
        let slowest = (0.03 * scene.speed).max(scene.slowest());
        let speeds = geometric(slowest, (1.5 * scene.speed).max(slowest), 6);
        speeds.iter().map(|speed| Start::sized(&[level, level, *speed], &[0, 1])).collect()
    }

    fn act_on_drive(&self, form: usize, values: &[f64], _state: &mut EffectState, push: &mut DriveState) {
        let speed = values[2].max(f64::MIN_POSITIVE);
        // Within the blur the speed is spread by the acceleration: what is felt is the mean over a Gaussian.
        let spread = ((push.acceleration * push.filter_width).powi(2) + push.velocity_noise.powi(2)).sqrt();
        let left = if form == 0 {
            let wide = (speed * speed + 2.0 * spread * spread).sqrt();
            speed / wide * (-(push.velocity / wide).powi(2)).exp()
        } else {
            decayed(push.velocity.abs() / speed, spread / speed)
        };
        push.apply_dry_friction((values[0] + values[1] * left) * push.direction(), values[0] + values[1]);
    }
}

/// E exp(-|v + spread n|) for a standard normal n.
fn decayed(v: f64, spread: f64) -> f64 {
    if v >= 6.0 * spread {
        return (0.5 * spread * spread - v).exp();
    }
    // Beyond, the products below are zero times infinity; what they tend to is the density at v times the area, 2.
    if spread > MAX_SPREAD {
        return (-0.5 * (v / spread).powi(2)).exp() * 2.0 / (spread * std::f64::consts::TAU.sqrt());
    }
    let side = |v: f64| (0.5 * spread * spread + v).exp() * libm::erfc((spread + v / spread) * FRAC_1_SQRT_2);
    0.5 * (side(v) + side(-v))
}

/// Spread over the Stribeck speed from which the exponential is a spike.
const MAX_SPREAD: f64 = 20.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_of_the_excess_is_its_mean_over_the_spread() {
        for v in [0.0, 0.3, 1.0, 2.5, 8.0, 30.0] {
            for spread in [1e-3, 0.05, 0.4, 1.0, 3.0, 19.0, 21.0] {
                // Simpson's rule over twelve deviations, 12000 steps of 0.001 deviations.
                let at = |n: f64| (-(v + spread * n).abs() - 0.5 * n * n).exp();
                let mean: f64 = (0..12_000)
                    .map(|i| -6.0 + 0.001 * f64::from(i))
                    .map(|n| (at(n) + 4.0 * at(n + 0.0005) + at(n + 0.001)) * 0.001 / 6.0)
                    .sum::<f64>()
                    / std::f64::consts::TAU.sqrt();
                let found = decayed(v, spread);
                // The spike leaves out the curvature of the density over its width: a share of one over the spread squared.
                let within = if spread > MAX_SPREAD { 2.0 / (spread * spread) } else { 1e-5 };
                // Six deviations leave out 2e-9; a spread that narrow has corners between the steps of the rule.
                assert!((found - mean).abs() <= within * mean + 4e-9, "{v} {spread}: {found} for {mean}");
            }
        }
    }
}
