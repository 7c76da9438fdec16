//! Friction that is larger when creeping.

use crate::effects::{Card, Effect, Form, Limit, Memory, Parameter, Place, Push, Scene, Stage, Start, geometric};
use crate::rig::Word;

/// See [`CARD`].
pub struct StribeckFriction;

const NEWTON: Word = Word::new("N", "N m");

static CARD: Card = Card {
    name: "stribeck_friction",
    place: Place::Drive,
    stage: Stage::Friction,
    most: 1,
    statement: "The drive rubs, and it rubs more when it creeps than when it runs",
    forms: &[Form {
        name: "gaussian",
        equation: "friction = (level + breakaway_excess exp(-(v / stribeck_speed)^2)) sign(v); at rest it holds the sum",
        parameters: &[
            Parameter::new("level", NEWTON, "dry friction at speed", 0.0, f64::INFINITY),
            Parameter::new("breakaway_excess", NEWTON, "what creeping adds to it", 0.0, f64::INFINITY),
            Parameter::new(
                "stribeck_speed",
                Word::new("m/s", "rad/s"),
                "speed at which the excess is gone",
                0.0,
                f64::INFINITY,
            )
            .within(Limit::Pace),
        ],
    }],
    excited_by: "slow reversals, beside quick ones",
    resembles: &["coulomb_friction", "load_dependent_friction"],
    source: "R. Stribeck (1902); B. Armstrong-Helouvry et al., Automatica 30 (1994) 1083",
};

impl Effect for StribeckFriction {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        let level = 0.03 * scene.effort;
        let slowest = (0.03 * scene.speed).max(scene.slowest());
        let speeds = geometric(slowest, (1.5 * scene.speed).max(slowest), 6);
        speeds.iter().map(|speed| Start::sized(&[level, level, *speed], &[0, 1])).collect()
    }

    fn push(&self, _form: usize, values: &[f64], _memory: &mut Memory, push: &mut Push) {
        let speed = values[2].max(f64::MIN_POSITIVE);
        // Within the blur the speed is spread by the acceleration: the mean of a Gaussian over a Gaussian.
        let spread = ((push.acceleration * push.blur).powi(2) + push.speed_noise.powi(2)).sqrt();
        let wide = (speed * speed + 2.0 * spread * spread).sqrt();
        let excess = values[1] * speed / wide * (-(push.velocity / wide).powi(2)).exp();
        push.rub((values[0] + excess) * push.direction(), values[0] + values[1]);
    }
}
