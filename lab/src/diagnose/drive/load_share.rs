//! What is known of the load's share of the inertia beyond a link, and of the values that go with it.

use super::criteria::{LEAST_LOAD_SHARE, LOAD_SHARE_DEVIATION, MOST_LOAD_SHARE};
use super::law::Side;
use super::range::{Prior, Range};
use super::scales::Scales;
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

/// Whether the load's share beyond `link` is not told by the recordings, and held.
///
/// Where the load alone is seen, a recorded contact force tells it, which pushes the load and not the motor. Else friction does, or how a motor that
/// nobody sees slows down within a play, if anything: what the effort is late by and strikes within a row, of which an extended Kalman filter knows no
/// instant, count for more there. Free, it went to 0.94 for 0.42 of the arm of an eleventh author, and to 0.28 for 0.5 in the tests of `identification`, a
/// thousand nats from the truth.
fn is_held(link: &Term, scales: &Scales) -> bool {
    match link {
        Term::Play(Side::Load) => true,
        Term::Compliance(Side::Load) => !scales.touches,
        _ => false,
    }
}

/// Range of the load's share of the inertia beyond `link`.
#[must_use]
pub fn range(link: &Term, scales: &Scales) -> Range {
    if is_held(link, scales) {
        return Range::absolute(HALF, HALF, 0.1);
    }
    let share = Range::absolute(LEAST_LOAD_SHARE.value(), MOST_LOAD_SHARE.value(), 0.1);
    match link.encoder() {
        Some(Side::Load) => share.known(Prior { mean: HALF, deviation: LOAD_SHARE_DEVIATION.value() }),
        _ => share,
    }
}

/// Range of the load's part of the viscous friction, over that of [`OfHalves`], where its share of the inertia is within `share`: all of the friction may
/// be the load's.
#[must_use]
pub fn of_friction(side: Side, share: &Range) -> Range {
    Range::absolute(0.0, 1.0 / OfHalves::new(side, share.low).friction, 0.1)
}

/// Shares of the inertia that a load beyond `link` may have, whose share was found between `ends`: where it is held, all that are believed beforehand (95 %).
#[must_use]
pub fn possible(link: &Term, scales: &Scales, ends: [f64; 2]) -> [f64; 2] {
    if !is_held(link, scales) {
        return ends;
    }
    let half = NORMAL_97_5 * LOAD_SHARE_DEVIATION.value();
    [(HALF - half).max(LEAST_LOAD_SHARE.value()), (HALF + half).min(MOST_LOAD_SHARE.value())]
}

#[cfg(test)]
mod tests {
    use super::super::testing::SCALES;
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
        for link in [Term::Compliance(Side::Motor), Term::Compliance(Side::Load), Term::Play(Side::Load)] {
            for touches in [false, true] {
                let (side, share) = (link.encoder().unwrap(), range(&link, &Scales { touches, ..SCALES }));
                let most = of_friction(side, &share).high * OfHalves::new(side, share.low).friction;
                assert!((most - 1.0).abs() < 1e-12, "{link:?}: {most}");
            }
        }
    }

    /// Of a load that alone is seen a contact's force tells the share beyond a link, and nothing that beyond a play.
    #[test]
    fn a_share_that_is_not_told_is_held_and_may_be_any_that_is_believed() {
        let free = [LEAST_LOAD_SHARE.value(), MOST_LOAD_SHARE.value()];
        let believed = [0.2, 0.5 + 1.959_964 * 0.2];
        for (link, touches, ends, told) in [
            (Term::Compliance(Side::Motor), false, free, [0.3, 0.4]),
            (Term::Play(Side::Motor), true, free, [0.3, 0.4]),
            (Term::Compliance(Side::Load), true, free, [0.3, 0.4]),
            (Term::Compliance(Side::Load), false, [0.5, 0.5], believed),
            (Term::Play(Side::Load), true, [0.5, 0.5], believed),
        ] {
            let scales = Scales { touches, ..SCALES };
            let share = range(&link, &scales);
            assert_eq!([share.low, share.high], ends, "{link:?} {touches}");
            let found = possible(&link, &scales, [0.3, 0.4]);
            let apart = found.iter().zip(told).map(|(found, told)| (found - told).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-12, "{link:?} {touches}: {found:?}");
        }
    }
}
