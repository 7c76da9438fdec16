//! A motion in closed form, piece by piece: position, velocity and acceleration without a filter between.

use super::motion_limits::MotionLimits;
use crate::diagnose::thresholds::experiment_trajectory::{FADE_CYCLES, MAX_MOVE_FRACTION, SAMPLES_PER_CYCLE};

/// Rate of a smooth move of one length in one second at its quickest, and its greatest acceleration.
const QUINTIC_PEAKS: (f64, f64) = (1.875, 5.773_502_691_896_258);

/// A stretch of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Segment {
    Dwell {
        at: f64,
    },
    /// The quintic that leaves and arrives at rest, without a jump of the acceleration.
    Move {
        from: f64,
        by: f64,
    },
    /// A sine that grows from nothing and fades to it.
    Wave {
        about: f64,
        amplitude: f64,
        frequency: f64,
    },
}

/// A motion that begins and ends at rest where the recordings began. It keeps within the speed and the acceleration of its
/// room, whatever is asked of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    room: MotionLimits,
    pieces: Vec<(f64, Segment)>,
    place: f64,
}

impl Trajectory {
    /// At rest where the recordings began.
    #[must_use]
    pub fn new(room: MotionLimits) -> Self {
        Self { room, pieces: Vec::new(), place: room.start }
    }

    /// Stays for `seconds`.
    #[must_use]
    pub fn rest(mut self, seconds: f64) -> Self {
        self.pieces.push((seconds, Segment::Dwell { at: self.place }));
        self
    }

    /// Moves to `place` within `part` of the greatest speed, or of the acceleration by its square: half as quick all over.
    #[must_use]
    pub fn to(mut self, place: f64, part: f64) -> Self {
        let place = place.clamp(self.room.low, self.room.high);
        let by = place - self.place;
        let by_speed = QUINTIC_PEAKS.0 * by.abs() / self.room.speed;
        let by_acceleration = (QUINTIC_PEAKS.1 * by.abs() / self.room.acceleration).sqrt();
        let least = by_speed.max(by_acceleration);
        let seconds = (least / part).min(MAX_MOVE_FRACTION * self.room.seconds).max(least);
        if seconds > 0.0 {
            self.pieces.push((seconds, Segment::Move { from: self.place, by }));
            self.place = place;
        }
        self
    }

    /// Swings about where it is, by `amplitude` or what the limits leave of it.
    #[must_use]
    pub fn wave(mut self, amplitude: f64, frequency: f64, turns: f64) -> Self {
        let about = self.place;
        let amplitude = amplitude.min(self.room.high - about).min(about - self.room.low).max(0.0);
        let seconds = turns.max(2.0 * FADE_CYCLES + 1.0) / frequency;
        let unit = Segment::Wave { about: 0.0, amplitude: 1.0, frequency };
        let looks = (seconds * frequency * SAMPLES_PER_CYCLE as f64).ceil();
        let (mut speed, mut acceleration) = (f64::MIN_POSITIVE, f64::MIN_POSITIVE);
        for look in 0..looks as usize {
            let [_, v, a] = unit.at(look as f64 / looks * seconds, seconds);
            (speed, acceleration) = (speed.max(v.abs()), acceleration.max(a.abs()));
        }
        // Between two looks it may be a little quicker than at either.
        let amplitude = amplitude.min(0.99 * self.room.speed / speed).min(0.99 * self.room.acceleration / acceleration);
        self.pieces.push((seconds, Segment::Wave { about, amplitude, frequency }));
        self
    }

    /// Goes back to where the recordings began.
    #[must_use]
    pub fn home(self, part: f64) -> Self {
        let start = self.room.start;
        self.to(start, part)
    }

    /// This one and then `other`.
    #[must_use]
    pub fn then(mut self, other: &Self) -> Self {
        self.pieces.extend(&other.pieces);
        self
    }

    /// This one `count` times over.
    #[must_use]
    pub fn times(mut self, count: usize) -> Self {
        self.pieces = self.pieces.repeat(count);
        self
    }

    /// Length in seconds.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.pieces.iter().map(|(seconds, _)| seconds).sum()
    }

    /// Position, velocity and acceleration at rows `step` seconds apart, from the first instant to the last.
    #[must_use]
    pub fn rows(&self, step: f64) -> Vec<[f64; 3]> {
        let mut pieces = self.pieces.iter();
        let (mut begun, mut piece) = (0.0, pieces.next());
        let count = (self.seconds() / step).ceil() as usize + 1;
        (0..count)
            .map(|row| {
                let now = row as f64 * step;
                while let Some((seconds, _)) = piece.filter(|(seconds, _)| now > begun + seconds) {
                    begun += seconds;
                    piece = pieces.next();
                }
                piece.map_or([self.room.start, 0.0, 0.0], |(seconds, piece)| piece.at(now - begun, *seconds))
            })
            .collect()
    }
}

impl Segment {
    /// Position, velocity and acceleration `since` its beginning; it takes `seconds`.
    fn at(&self, since: f64, seconds: f64) -> [f64; 3] {
        match *self {
            Self::Dwell { at } => [at, 0.0, 0.0],
            Self::Move { from, by } => {
                let [s, v, a] = smooth(since / seconds);
                [from + by * s, by * v / seconds, by * a / (seconds * seconds)]
            }
            Self::Wave { about, amplitude, frequency } => {
                let fade = FADE_CYCLES / frequency;
                let turn = std::f64::consts::TAU * frequency;
                let (sine, cosine) = (turn * since).sin_cos();
                let rising = since < seconds - since;
                let [s, v, a] = smooth((if rising { since } else { seconds - since }) / fade);
                let (v, a) = (if rising { v } else { -v } / fade, a / (fade * fade));
                let bend = a * sine + 2.0 * v * turn * cosine - s * turn * turn * sine;
                [about + amplitude * s * sine, amplitude * (v * sine + s * turn * cosine), amplitude * bend]
            }
        }
    }
}

/// From zero to one: value, rate and acceleration of the quintic that is at rest at both ends.
fn smooth(part: f64) -> [f64; 3] {
    let u = part.clamp(0.0, 1.0);
    let rest = 1.0 - u;
    [u * u * u * (10.0 - 15.0 * u + 6.0 * u * u), 30.0 * u * u * rest * rest, 60.0 * u * rest * (rest - u)]
}
