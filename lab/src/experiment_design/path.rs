//! The motion that a tool is meant to make, in closed form, piece by piece: position, velocity and acceleration.

/// Rate of a smooth move of one length in one second at its quickest, and its greatest acceleration.
const QUINTIC_PEAKS: (f64, f64) = (1.875, 5.773_502_691_896_258);

/// Turns in which a sine grows from nothing, and fades to it.
const FADE_CYCLES: f64 = 1.0;

/// Instants a turn at which a sine is held against the limits.
const SAMPLES_PER_CYCLE: f64 = 64.0;

/// Share of a trial that one move may take, be it ever so slow.
const MAX_MOVE_FRACTION: f64 = 0.1;

/// The room that a path has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionLimits {
    /// Where every path begins and ends, at rest, m or rad.
    pub start: f64,
    /// Least position.
    pub low: f64,
    /// Greatest position.
    pub high: f64,
    /// Where the contact begins; `None` where nothing is touched.
    pub surface: Option<f64>,
    /// Whether there is free space before the surface, or nothing but free space.
    pub free: bool,
    /// Greatest speed, m/s or rad/s.
    pub speed: f64,
    /// Greatest acceleration.
    pub acceleration: f64,
    /// Length of a trial, s.
    pub seconds: f64,
    /// Highest frequency, Hz.
    pub band: f64,
}

impl MotionLimits {
    /// The same, gone through at `part` of the speed and `part` of the depth.
    #[must_use]
    pub fn eased(self, part: f64) -> Self {
        let from = self.surface.filter(|_| self.free).unwrap_or(self.start);
        Self {
            speed: part * self.speed,
            acceleration: part * part * self.acceleration,
            high: from.max(self.low) + part * (self.high - from.max(self.low)),
            ..self
        }
    }

    /// Position at `part` of the depth, zero at the surface; of the whole way where there is no surface to leave.
    #[must_use]
    pub fn depth(&self, part: f64) -> f64 {
        let from = self.surface.filter(|_| self.free).unwrap_or(self.low);
        from + part * (self.high - from)
    }

    /// Position at `part` of the free way, zero at its far end.
    #[must_use]
    pub fn away(&self, part: f64) -> f64 {
        self.low + part * (self.surface.unwrap_or(self.high) - self.low)
    }

    /// The highest frequency at which a sine of `amplitude` keeps within speed, acceleration and band.
    #[must_use]
    pub fn quickest(&self, amplitude: f64) -> f64 {
        let turn = (self.speed / amplitude).min((self.acceleration / amplitude).sqrt());
        // A few turns have to fit in, and growing from nothing asks for more than swinging on.
        (0.8 * turn / std::f64::consts::TAU).min(self.band).max(8.0 / self.seconds)
    }
}

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
    Sine {
        about: f64,
        amplitude: f64,
        frequency: f64,
    },
}

/// A motion that keeps within the speed and the acceleration of its limits, whatever is asked of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    limits: MotionLimits,
    pieces: Vec<(f64, Segment)>,
    place: f64,
}

impl Path {
    /// At rest at the start.
    #[must_use]
    pub fn new(limits: MotionLimits) -> Self {
        Self { limits, pieces: Vec::new(), place: limits.start }
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
        let place = place.clamp(self.limits.low, self.limits.high);
        let by = place - self.place;
        let by_speed = QUINTIC_PEAKS.0 * by.abs() / self.limits.speed;
        let by_acceleration = (QUINTIC_PEAKS.1 * by.abs() / self.limits.acceleration).sqrt();
        let least = by_speed.max(by_acceleration);
        let seconds = (least / part).min(MAX_MOVE_FRACTION * self.limits.seconds).max(least);
        if seconds > 0.0 {
            self.pieces.push((seconds, Segment::Move { from: self.place, by }));
            self.place = place;
        }
        self
    }

    /// Swings about where it is, by `amplitude` or what the limits leave of it.
    #[must_use]
    pub fn sine(mut self, amplitude: f64, frequency: f64, cycles: f64) -> Self {
        let about = self.place;
        let amplitude = amplitude.min(self.limits.high - about).min(about - self.limits.low).max(0.0);
        let seconds = cycles.max(2.0 * FADE_CYCLES + 1.0) / frequency;
        let unit = Segment::Sine { about: 0.0, amplitude: 1.0, frequency };
        let count = (seconds * frequency * SAMPLES_PER_CYCLE).ceil();
        let (mut speed, mut acceleration) = (f64::MIN_POSITIVE, f64::MIN_POSITIVE);
        for at in 0..count as usize {
            let [_, v, a] = unit.at(at as f64 / count * seconds, seconds);
            (speed, acceleration) = (speed.max(v.abs()), acceleration.max(a.abs()));
        }
        // Between two instants it may be a little quicker than at either.
        let amplitude =
            amplitude.min(0.99 * self.limits.speed / speed).min(0.99 * self.limits.acceleration / acceleration);
        self.pieces.push((seconds, Segment::Sine { about, amplitude, frequency }));
        self
    }

    /// Goes back to the start.
    #[must_use]
    pub fn home(self, part: f64) -> Self {
        let start = self.limits.start;
        self.to(start, part)
    }

    /// This one and then `other`.
    #[must_use]
    pub fn then(mut self, other: &Self) -> Self {
        self.pieces.extend(&other.pieces);
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
                piece.map_or([self.place, 0.0, 0.0], |(seconds, piece)| piece.at(now - begun, *seconds))
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
            Self::Sine { about, amplitude, frequency } => {
                let fade = FADE_CYCLES / frequency;
                let turn = std::f64::consts::TAU * frequency;
                let (sine, cosine) = (turn * since).sin_cos();
                let rising = since < seconds - since;
                let [s, v, a] = smooth((if rising { since } else { seconds - since }) / fade);
                let (v, a) = (if rising { v } else { -v } / fade, a / (fade * fade));
                let second = a * sine + 2.0 * v * turn * cosine - s * turn * turn * sine;
                [about + amplitude * s * sine, amplitude * (v * sine + s * turn * cosine), amplitude * second]
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

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: MotionLimits = MotionLimits {
        start: -0.01,
        low: -0.02,
        high: 0.01,
        surface: Some(0.0),
        free: true,
        speed: 0.2,
        acceleration: 4.0,
        seconds: 20.0,
        band: 25.0,
    };

    #[test]
    fn a_path_keeps_its_limits_and_its_derivatives_are_those_of_its_positions() {
        let path = Path::new(LIMITS)
            .rest(0.2)
            .to(0.05, 1.0)
            .sine(0.5, 12.0, 5.0)
            .to(-0.015, 0.3)
            .sine(0.01, 2.0, 3.0)
            .home(1.0);
        let step = 1e-4;
        let rows = path.rows(step);
        assert!((rows[rows.len() - 1][0] - LIMITS.start).abs() < 1e-12);
        for pair in rows.windows(2) {
            let [x, v, a] = pair[1];
            assert!((LIMITS.low - 1e-9..=LIMITS.high + 1e-9).contains(&x), "{x}");
            assert!(v.abs() <= LIMITS.speed * 1.0001 && a.abs() <= LIMITS.acceleration * 1.001, "{v} {a}");
            assert!((x - pair[0][0] - 0.5 * step * (v + pair[0][1])).abs() < 1e-7, "{x}");
        }
    }
}
