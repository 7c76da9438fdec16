//! What is known of the load's share of the inertia beyond a link, and of the values that go with it.

use super::criteria::{LEAST_LOAD_SHARE, LOAD_SHARE_DEVIATION, MOST_LOAD_SHARE};
use super::law::Side;
use super::range::{Prior, Range};
use super::term::Term;
use crate::diagnose::interval::NORMAL_97_5;

/// What the values of a link are to be multiplied by, one whose encoder sits on the load: they are those of two halves that move the load
/// alike.
///
/// From the effort to the load's position a link is (c s + k) / (m1 m2 s^4 + (m1 + m2) (c s + k) s^2): without the motor's position the motion tells
/// the sum of the inertias, and stiffness and damping over their product. And a motor that nobody sees crosses a play in the time that its
/// inertia times the gap takes, while the load slows down by its friction over its inertia. None of them is told without the share, and
/// with these values the share is a direction of its own. What is told of them has the width of all shares that are possible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OfHalves {
    /// Of stiffness and damping.
    pub stiffness: f64,
    /// Of the gap.
    pub play: f64,
    /// Of the load's share of the viscous friction.
    pub friction: f64,
}

impl OfHalves {
    /// For a load of `load_share` of the inertia; one where the encoder is on the motor.
    #[must_use]
    pub fn new(encoder: Side, load_share: f64) -> Self {
        match encoder {
            Side::Motor => Self { stiffness: 1.0, play: 1.0, friction: 1.0 },
            Side::Load => Self {
                stiffness: 4.0 * load_share * (1.0 - load_share),
                play: 0.5 / (1.0 - load_share),
                friction: 2.0 * load_share,
            },
        }
    }
}

/// Share of the inertia that a load is taken to have where it alone is seen (see [`OfHalves`]): half, as where both sides are matched for the greatest
/// acceleration.
pub const HALF: f64 = 0.5;

/// Range of the load's share of the inertia, of a link without play whose encoder sits on `side`. Of a load that alone is seen a contact's force or friction can
/// tell it, and it is believed beforehand.
#[must_use]
pub fn of_link(side: Side) -> Range {
    let share = Range::absolute(LEAST_LOAD_SHARE.value(), MOST_LOAD_SHARE.value(), 0.1);
    match side {
        Side::Motor => share,
        Side::Load => share.known(Prior { mean: HALF, deviation: LOAD_SHARE_DEVIATION.value() }),
    }
}

/// The same of a play; that of a load that alone is seen is held (see [`possible`]).
#[must_use]
pub fn beyond_play(side: Side) -> Range {
    match side {
        Side::Motor => of_link(side),
        Side::Load => Range::absolute(HALF, HALF, 0.1),
    }
}

/// Range of the load's part of the viscous friction, over that of [`OfHalves`], where its share of the inertia is within `share`: all of the friction may
/// be the load's.
#[must_use]
pub fn of_friction(side: Side, share: &Range) -> Range {
    Range::absolute(0.0, 1.0 / OfHalves::new(side, share.low).friction, 0.1)
}

/// Shares of the inertia that a load may have whose share was found between `ends`, by `term`: beyond a play, where the load alone is seen, all that are believed
/// beforehand (95 %).
/// There the share would be told by how a motor that nobody sees slows down within the play, if at all, and an extended Kalman filter, which knows no
/// instant of a strike within a row, puts its maximum a thousand nats from the truth (0.28 for 0.5 in the tests of `identification`).
#[must_use]
pub fn possible(term: &Term, ends: [f64; 2]) -> [f64; 2] {
    match term {
        Term::Play(Side::Load) => {
            let half = NORMAL_97_5 * LOAD_SHARE_DEVIATION.value();
            let least = (HALF - half).max(LEAST_LOAD_SHARE.value());
            [least, (HALF + half).min(MOST_LOAD_SHARE.value())]
        }
        _ => ends,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (c s + k) / (m1 m2 s^4 + m (c s + k) s^2) at 3 rad/s and one at the resonance, of 0.8 kg with a load of 0.7 of it and of two halves.
    #[test]
    fn two_halves_move_their_load_as_the_link_that_they_stand_for() {
        let of = OfHalves::new(Side::Load, 0.7);
        let response = |share: f64, [k, c]: [f64; 2], w: f64| {
            let (mass, pair) = (0.8, 0.8 * 0.8 * share * (1.0 - share));
            let (real, imaginary) = (pair * w.powi(4) - mass * k * w * w, -mass * c * w.powi(3));
            k.hypot(c * w) / real.hypot(imaginary)
        };
        let [k, c]: [f64; 2] = [900.0, 0.7];
        for w in [3.0, (k / (0.8 * 0.25)).sqrt()] {
            let [halves, link] = [response(0.5, [k, c], w), response(0.7, [of.stiffness * k, of.stiffness * c], w)];
            assert!((halves / link - 1.0).abs() < 1e-12, "{w}: {halves} {link}");
        }
        // The motor's inertia times the gap, and the load's friction over its inertia.
        assert!((0.3 * of.play - 0.5).abs() < 1e-12 && (of.friction / 0.7 - 1.0 / 0.5).abs() < 1e-12);
    }

    #[test]
    fn all_of_the_friction_may_be_the_loads() {
        for (side, range) in [
            (Side::Motor, of_link(Side::Motor)),
            (Side::Load, of_link(Side::Load)),
            (Side::Load, beyond_play(Side::Load)),
        ] {
            let most = of_friction(side, &range).high * OfHalves::new(side, range.low).friction;
            assert!((most - 1.0).abs() < 1e-12, "{side:?}: {most}");
        }
    }
}
