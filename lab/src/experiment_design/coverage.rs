//! The states that motions visited: where something unknown could still hide.

use std::collections::BTreeSet;

use super::limits::Limits;
use crate::recording::Recording;

/// Bins of the position between the limits.
const POSITION_BINS: f64 = 12.0;

/// Shares of the greatest speed between which speeds are distinguished.
const SPEED_EDGES: [f64; 3] = [0.01, 0.08, 0.3];

/// Lengths of a rest, s, between which rests are distinguished: what relaxes shows in time.
const REST_EDGES_S: [f64; 3] = [0.3, 1.0, 2.5];

/// Frequencies, Hz, between which reversals of the motion are distinguished.
const FREQUENCY_EDGES_HZ: [f64; 4] = [0.5, 2.0, 6.0, 14.0];

/// Span over which a velocity is taken, s.
const SPAN_S: f64 = 0.02;

/// Visits that make a state visited.
const LEAST_VISITS: usize = 10;

/// A state in bins: which kind of bin, and which.
type State = (u8, i32, i32);

/// States in bins of position and velocity, of rests, and of frequencies, each by depth.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Coverage(BTreeSet<State>);

impl Coverage {
    /// The states of one motion within `limits`.
    #[must_use]
    pub fn of(recording: &Recording, limits: &Limits) -> Self {
        let rows = Rows::new(recording, limits);
        let mut counts = std::collections::BTreeMap::<State, usize>::new();
        let (mut rest_s, mut last_turn) = (0.0, 0.0);
        let mut direction = 0.0;
        let mut single = BTreeSet::new();
        for at in 0..rows.time.len() {
            let (place, velocity) = (rows.bin(at), rows.velocity[at]);
            let class = SPEED_EDGES.iter().filter(|edge| velocity.abs() > **edge * limits.speed).count() as i32;
            *counts.entry((0, place, class * velocity.signum() as i32)).or_default() += 1;
            let step = if at > 0 { rows.time[at] - rows.time[at - 1] } else { 0.0 };
            rest_s = if class == 0 { rest_s + step } else { 0.0 };
            let rests = REST_EDGES_S.iter().filter(|edge| rest_s > **edge).count() as i32;
            if rests > 0 {
                single.insert((1, place / 3, rests));
            }
            if class > 0 && velocity.signum() != direction {
                let frequency = 0.5 / (rows.time[at] - last_turn).max(1e-3);
                let band = FREQUENCY_EDGES_HZ.iter().filter(|edge| frequency > **edge).count() as i32;
                single.insert((2, place / 3, band));
                (direction, last_turn) = (velocity.signum(), rows.time[at]);
            }
        }
        let often = counts.into_iter().filter(|(_, count)| *count >= LEAST_VISITS).map(|(state, _)| state);
        Self(often.chain(single).collect())
    }

    /// Of several motions.
    #[must_use]
    pub fn of_all<'a>(recordings: impl IntoIterator<Item = &'a Recording>, limits: &Limits) -> Self {
        let mut all = Self::default();
        recordings.into_iter().for_each(|recording| all.add(&Self::of(recording, limits)));
        all
    }

    /// Adds the states of `other`.
    pub fn add(&mut self, other: &Self) {
        self.0.extend(&other.0);
    }

    /// How many states of `other` are new.
    #[must_use]
    pub fn added_by(&self, other: &Self) -> usize {
        other.0.difference(&self.0).count()
    }

    /// How many states.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether nothing was visited.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Time, position and velocity of a recording.
struct Rows<'a> {
    time: &'a [f64],
    position: &'a [f64],
    velocity: Vec<f64>,
    low: f64,
    width: f64,
}

impl<'a> Rows<'a> {
    fn new(recording: &'a Recording, limits: &Limits) -> Self {
        let (time, position) = (recording.time.as_slice(), recording.position.as_slice());
        let mut from = 0;
        let velocity = (0..time.len()).map(|to| {
            while time[to] - time[from] > SPAN_S {
                from += 1;
            }
            if to > from { (position[to] - position[from]) / (time[to] - time[from]) } else { 0.0 }
        });
        let [low, high] = limits.position;
        Self { time, position, velocity: velocity.collect(), low, width: (high - low) / POSITION_BINS }
    }

    fn bin(&self, at: usize) -> i32 {
        ((self.position[at] - self.low) / self.width).floor().clamp(0.0, POSITION_BINS - 1.0) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn swing(frequency: f64, amplitude: f64) -> Recording {
        let time: Vec<f64> = (0..4000).map(|row| f64::from(row) * 1e-3).collect();
        let position = time.iter().map(|t| amplitude * (std::f64::consts::TAU * frequency * t).sin()).collect();
        Recording { time, position, ..Recording::default() }
    }

    #[test]
    fn the_same_motion_adds_nothing_and_a_quicker_or_wider_one_does() {
        let limits = Limits {
            position: [-0.01, 0.01],
            speed: 0.2,
            effort: None,
            force: None,
            duration_s: 10.0,
            frequency_hz: 20.0,
        };
        let slow = Coverage::of(&swing(1.0, 0.004), &limits);
        assert_eq!(slow.added_by(&slow.clone()), 0);
        assert!(slow.added_by(&Coverage::of(&swing(4.0, 0.004), &limits)) > 2);
        assert!(slow.added_by(&Coverage::of(&swing(1.0, 0.009), &limits)) > 2);
    }
}
