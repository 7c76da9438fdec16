//! What a motion may do to the rig.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::InputError;
use crate::recording::Recording;
use crate::rig::{Coordinate, Rig};

/// Share of each limit that a planned motion leaves free, under every explanation.
pub const MARGIN: f64 = 0.15;

/// Where a file of limits names no frequency: the highest that a motion holds, Hz.
const DEFAULT_FREQUENCY_HZ: f64 = 25.0;

/// Where a file of limits names no length: that of one trial, s.
const DEFAULT_DURATION_S: f64 = 25.0;

/// Shortest trial that is worth its approach, s.
const MIN_DURATION_S: f64 = 5.0;

/// Limits of a trial, in the units of the rig's coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Least and greatest position, m or rad.
    pub position: [f64; 2],
    /// Greatest speed, m/s or rad/s.
    pub speed: f64,
    /// Greatest effort either way, N or N m; `None`: only what the recordings show.
    pub effort: Option<f64>,
    /// Greatest contact force either way, N or N m; `None`: only what the recordings show.
    pub force: Option<f64>,
    /// Length of a trial, s.
    pub duration_s: f64,
    /// Highest frequency of a motion, Hz.
    pub frequency_hz: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    limits: Table,
}

/// The keys of both coordinates; which of them a rig takes is checked afterwards, so that the error can say it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    position_min_m: Option<f64>,
    position_max_m: Option<f64>,
    speed_m_s: Option<f64>,
    effort_n: Option<f64>,
    force_n: Option<f64>,
    position_min_rad: Option<f64>,
    position_max_rad: Option<f64>,
    speed_rad_s: Option<f64>,
    effort_n_m: Option<f64>,
    torque_n_m: Option<f64>,
    duration_s: Option<f64>,
    frequency_hz: Option<f64>,
}

impl Limits {
    /// Reads a file of limits for `rig`.
    ///
    /// # Errors
    /// No such file, no TOML, an unknown key, one of the other coordinate, a needed one that is absent, or a value that cannot be.
    pub fn read(path: &Path, rig: &Rig) -> Result<Self, InputError> {
        let place = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|error| InputError::new(&place, error, "a file with a table [limits]"))?;
        Self::parse(&text, &place, rig)
    }

    /// Reads the text of a file of limits; `origin` names it in errors.
    ///
    /// # Errors
    /// As [`Limits::read`].
    pub fn parse(text: &str, origin: &str, rig: &Rig) -> Result<Self, InputError> {
        let file: File = toml::from_str(text)
            .map_err(|error| InputError::new(origin, error.to_string().trim_end(), "a table [limits]"))?;
        let table = file.limits;
        let of_coordinate = |linear: Option<f64>, rotary: Option<f64>, keys: [&'static str; 2]| {
            let (own, other, keys) = match rig.coordinate {
                Coordinate::Linear => (linear, rotary, keys),
                Coordinate::Rotary => (rotary, linear, [keys[1], keys[0]]),
            };
            match other {
                Some(_) => Err(InputError::new(
                    format!("{origin}: [limits] {}", keys[1]),
                    "a key of the other coordinate",
                    keys[0],
                )),
                None => Ok((own, keys[0])),
            }
        };
        let needed = |(value, key): (Option<f64>, &str)| {
            let absent = || InputError::new(format!("{origin}: [limits]"), format!("no {key}"), "a number");
            value.ok_or_else(absent)
        };
        let low = needed(of_coordinate(
            table.position_min_m,
            table.position_min_rad,
            ["position_min_m", "position_min_rad"],
        )?)?;
        let high = needed(of_coordinate(
            table.position_max_m,
            table.position_max_rad,
            ["position_max_m", "position_max_rad"],
        )?)?;
        let limits = Self {
            position: [low, high],
            speed: needed(of_coordinate(table.speed_m_s, table.speed_rad_s, ["speed_m_s", "speed_rad_s"])?)?,
            effort: of_coordinate(table.effort_n, table.effort_n_m, ["effort_n", "effort_n_m"])?.0,
            force: of_coordinate(table.force_n, table.torque_n_m, ["force_n", "torque_n_m"])?.0,
            duration_s: table.duration_s.unwrap_or(DEFAULT_DURATION_S),
            frequency_hz: table.frequency_hz.unwrap_or(DEFAULT_FREQUENCY_HZ),
        };
        limits.refuse_impossible(origin).map(|()| limits)
    }

    fn refuse_impossible(&self, origin: &str) -> Result<(), InputError> {
        let wrong = |key: &str, found: f64, expected: &str| {
            Err(InputError::new(format!("{origin}: [limits] {key}"), found, expected))
        };
        let [low, high] = self.position;
        if !(low.is_finite() && high.is_finite() && low < high) {
            return wrong("position_max", high, "a number above position_min");
        }
        let above_zero = [
            ("speed", Some(self.speed)),
            ("effort", self.effort),
            ("force", self.force),
            ("frequency_hz", Some(self.frequency_hz)),
        ];
        for (key, value) in above_zero {
            if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
                return wrong(key, value, "a number above zero");
            }
        }
        if !(MIN_DURATION_S..=3600.0).contains(&self.duration_s) {
            return wrong("duration_s", self.duration_s, "5 to 3600 s");
        }
        Ok(())
    }

    /// The limits that the recordings themselves kept: what the rig has borne already. `None` where nothing moved.
    #[must_use]
    pub fn of_recordings(trials: &[Recording]) -> Option<Self> {
        let all = |pick: fn(&Recording) -> Option<&Vec<f64>>| {
            let peak = trials.iter().filter_map(pick).flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
            (peak > 0.0).then_some(peak)
        };
        let positions = || trials.iter().flat_map(|trial| trial.position.iter().copied());
        let (low, high) = positions().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let speed = trials.iter().map(|trial| greatest_speed(&trial.time, &trial.position)).fold(0.0, f64::max);
        let duration = trials.iter().map(|trial| trial.time[trial.time.len() - 1] - trial.time[0]).fold(0.0, f64::max);
        // A planned motion leaves the margin: widened by it, it may do again what was done.
        let wide = (1.0 - MARGIN).recip();
        let around = 0.5 * (wide - 1.0) * (high - low);
        (high > low && speed > 0.0).then_some(Self {
            position: [low - around, high + around],
            speed: wide * speed,
            effort: all(|trial| trial.effort.as_ref()).map(|peak| wide * peak),
            force: all(|trial| trial.force.as_ref()).map(|peak| wide * peak),
            duration_s: duration.max(MIN_DURATION_S),
            frequency_hz: DEFAULT_FREQUENCY_HZ,
        })
    }

    /// The limits of a planned motion: less the margin.
    #[must_use]
    pub fn with_margin(&self) -> Self {
        let [low, high] = self.position;
        let inset = 0.5 * MARGIN * (high - low);
        let kept = 1.0 - MARGIN;
        Self {
            position: [low + inset, high - inset],
            speed: kept * self.speed,
            effort: self.effort.map(|effort| kept * effort),
            force: self.force.map(|force| kept * force),
            ..*self
        }
    }
}

/// Span over which a speed is taken: an encoder's step within it stays small beside what moves, s.
const SPEED_SPAN_S: f64 = 0.02;

/// The greatest mean speed over [`SPEED_SPAN_S`].
fn greatest_speed(time: &[f64], position: &[f64]) -> f64 {
    let (mut from, mut most) = (0, 0.0f64);
    for to in 0..time.len() {
        while time[to] - time[from] > SPEED_SPAN_S {
            from += 1;
        }
        // A span that a gap in the clock cut short says nothing.
        if time[to] - time[from] > 0.5 * SPEED_SPAN_S {
            most = most.max(((position[to] - position[from]) / (time[to] - time[from])).abs());
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "[limits]\nposition_min_m = -0.02\nposition_max_m = 0.02\nspeed_m_s = 0.3\nforce_n = 6.0\n";

    #[test]
    fn a_file_of_limits_is_read_and_the_margin_is_inside_of_it() {
        let limits = Limits::parse(TEXT, "limits.toml", &Rig::default()).unwrap();
        assert_eq!((limits.position, limits.speed, limits.force, limits.effort), ([-0.02, 0.02], 0.3, Some(6.0), None));
        let inner = limits.with_margin();
        assert!(inner.position[0] > -0.02 && inner.position[1] < 0.02 && inner.force < limits.force);
    }

    #[test]
    fn what_cannot_be_is_refused_by_its_key() {
        let refused = |from: &str, to: &str, expected: &str| {
            let error = Limits::parse(&TEXT.replace(from, to), "limits.toml", &Rig::default()).unwrap_err().to_string();
            assert!(error.contains("limits.toml") && error.contains(expected), "{expected}: {error}");
        };
        refused("0.3", "-0.3", "speed");
        refused("position_max_m = 0.02", "position_max_m = -0.03", "position_max");
        refused("speed_m_s", "speed_rad_s", "speed_rad_s");
        refused("force_n", "forse_n", "forse_n");
        refused("speed_m_s = 0.3\n", "", "speed_m_s");
    }
}
