//! A monitor of the limits, independent of the controller and of the design: it sees what the sensors show and nothing else.

use std::collections::VecDeque;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::experiment_design::Limits;
use crate::recording::Recording;

/// Span over which a speed is taken: an encoder's steps within it stay small beside what moves, s.
const SPEED_SPAN_S: f64 = 0.02;

/// A quantity that has a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Position.
    Position,
    /// Speed.
    Speed,
    /// Contact force.
    Force,
    /// Drive effort.
    Effort,
}

impl Quantity {
    /// As a sentence names it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Speed => "speed",
            Self::Force => "force",
            Self::Effort => "effort",
        }
    }
}

/// A limit that was passed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Violation {
    /// Of what.
    pub quantity: Quantity,
    /// When, s.
    pub time_s: f64,
    /// What was read.
    pub value: f64,
    /// What is allowed.
    pub limit: f64,
}

impl fmt::Display for Violation {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, time_s, value, limit } = self;
        write!(out, "{} {value:.4e} at {time_s:.3} s, limit {limit:.4e}", quantity.name())
    }
}

/// What the sensors show at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Readings {
    /// Seconds.
    pub time: f64,
    /// m or rad.
    pub position: f64,
    /// N or N m.
    pub force: Option<f64>,
    /// N or N m.
    pub effort: Option<f64>,
}

/// Holds readings against limits, one instant after the other.
#[derive(Debug, Clone)]
pub struct LimitMonitor {
    limits: Limits,
    recent: VecDeque<(f64, f64)>,
    /// Greatest share of each limit that was used: position, speed, force, effort.
    used: [f64; 4],
}

impl LimitMonitor {
    /// Of `limits`.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self { limits, recent: VecDeque::new(), used: [0.0; 4] }
    }

    /// Takes `readings`; the first limit that they pass.
    pub fn check(&mut self, readings: &Readings) -> Option<Violation> {
        let Readings { time, position, force, effort } = *readings;
        let [low, high] = self.limits.position;
        let middle = 0.5 * (low + high);
        let speed = self.speed(time, position);
        let size = |value: Option<f64>| value.map_or(0.0, f64::abs);
        let open = |limit: Option<f64>| limit.unwrap_or(f64::INFINITY);
        let all = [
            (Quantity::Position, (position - middle).abs(), 0.5 * (high - low), position),
            (Quantity::Speed, speed, self.limits.speed, speed),
            (Quantity::Force, size(force), open(self.limits.force), force.unwrap_or(0.0)),
            (Quantity::Effort, size(effort), open(self.limits.effort), effort.unwrap_or(0.0)),
        ];
        for (used, (_, size, limit, _)) in self.used.iter_mut().zip(&all) {
            *used = used.max(size / limit);
        }
        // A reading that is no number is no reading within a limit.
        let passed = all.iter().find(|(_, size, limit, _)| size.is_nan() || size > limit)?;
        let limit = match passed.0 {
            Quantity::Position if position < middle => low,
            Quantity::Position => high,
            _ => passed.2,
        };
        Some(Violation { quantity: passed.0, time_s: time, value: passed.3, limit })
    }

    /// Greatest share of each limit that was used so far: position, speed, force, effort; above one, it was passed.
    #[must_use]
    pub fn used(&self) -> [f64; 4] {
        self.used
    }

    /// Mean speed over the span.
    fn speed(&mut self, time: f64, position: f64) -> f64 {
        while self.recent.front().is_some_and(|(then, _)| time - then > 1.001 * SPEED_SPAN_S) {
            self.recent.pop_front();
        }
        let first = self.recent.front().copied();
        self.recent.push_back((time, position));
        // A span that has only begun would make a speed of a step of the encoder.
        let whole = first.filter(|(then, _)| time - then >= 0.9 * SPEED_SPAN_S);
        whole.map_or(0.0, |(then, place)| ((position - place) / (time - then)).abs())
    }
}

/// The first limit that `recording` passes, and the greatest shares that it uses.
#[must_use]
pub fn hold_against(recording: &Recording, limits: &Limits) -> (Option<Violation>, [f64; 4]) {
    let mut monitor = LimitMonitor::new(*limits);
    let mut first = None;
    for row in 0..recording.time.len() {
        let at = |values: &Option<Vec<f64>>| values.as_ref().map(|values| values[row]);
        let readings = Readings {
            time: recording.time[row],
            position: recording.position[row],
            force: at(&recording.force),
            effort: at(&recording.effort),
        };
        let passed = monitor.check(&readings);
        first = first.or(passed);
    }
    (first, monitor.used())
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits {
        position: [-0.01, 0.02],
        speed: 0.1,
        effort: Some(5.0),
        force: None,
        duration_s: 10.0,
        frequency_hz: 20.0,
    };

    fn trial(change: impl Fn(usize, &mut Readings)) -> Option<Violation> {
        let mut monitor = LimitMonitor::new(LIMITS);
        (0..200).find_map(|row| {
            let mut readings =
                Readings { time: row as f64 * 1e-3, position: 0.005, force: Some(100.0), effort: Some(1.0) };
            change(row, &mut readings);
            monitor.check(&readings)
        })
    }

    #[test]
    fn every_limit_is_watched_and_what_has_none_is_not() {
        assert_eq!(trial(|_, _| {}), None);
        let position = trial(|row, readings| readings.position = if row == 50 { -0.011 } else { -0.0099 });
        assert_eq!(position.map(|found| (found.quantity, found.limit)), Some((Quantity::Position, -0.01)));
        let effort = trial(|row, readings| readings.effort = (row == 60).then_some(-5.1));
        assert_eq!(effort.map(|found| (found.quantity, found.time_s)), Some((Quantity::Effort, 0.06)));
        let speed = trial(|row, readings| readings.position = 0.12e-3 * row as f64 - 5e-3);
        assert_eq!(speed.map(|found| found.quantity), Some(Quantity::Speed));
        assert_eq!(trial(|row, readings| readings.position = 0.09e-3 * row as f64 - 5e-3), None);
    }

    #[test]
    fn a_reading_that_is_no_number_passes_its_limit() {
        assert!(
            trial(|row, readings| if row == 9 {
                readings.effort = Some(f64::NAN)
            })
            .is_some()
        );
    }
}
