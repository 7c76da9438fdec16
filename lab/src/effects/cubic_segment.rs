//! What becomes of a quantity between two samples.

/// A cubic `c0 + c1 s + c2 s^2 + c3 s^3`, s running from zero at one sample to one at the next.
///
/// Five rows a period, as many as the analysis has at the end of its band, a straight piece loses an eighth of a wave's
/// height between its samples; a cubic with the rates at both loses a hundredth.
#[derive(Debug, Clone, Copy)]
pub struct CubicSegment {
    parts: [f64; 4],
}

/// Steps a time constant below which the response is summed as a series: the recursion loses a digit for each power of it.
const SERIES_RATIO: f64 = 0.5;

impl CubicSegment {
    /// A straight line.
    #[must_use]
    pub fn straight(first: f64, last: f64) -> Self {
        Self { parts: [first, last - first, 0.0, 0.0] }
    }

    /// By value and rate at both samples, `step` seconds apart (Hermite's cubic).
    #[must_use]
    pub fn smooth(first: [f64; 2], last: [f64; 2], step: f64) -> Self {
        let (rise, begin, end) = (last[0] - first[0], step * first[1], step * last[1]);
        Self { parts: [first[0], begin, 3.0 * rise - 2.0 * begin - end, begin + end - 2.0 * rise] }
    }

    /// The value at `part` of the way.
    #[must_use]
    pub fn at(&self, part: f64) -> f64 {
        let [level, slope, square, cube] = self.parts;
        level + part * (slope + part * (square + part * cube))
    }

    /// What a first-order lag of `state`, driven along the course, has come to at its end; `ratio` is the time between the
    /// samples over its time constant, above zero. Exact.
    #[must_use]
    pub fn lagged(&self, state: f64, ratio: f64) -> f64 {
        let mut sum = state * (-ratio).exp();
        let mut before = 0.0;
        for (power, part) in self.parts.iter().enumerate() {
            let power = power as f64;
            // The integral of r exp(-r (1 - s)) s^n over the course.
            let response = if ratio < SERIES_RATIO {
                series(power, ratio)
            } else if power == 0.0 {
                -(-ratio).exp_m1()
            } else {
                1.0 - power / ratio * before
            };
            sum += part * response;
            before = response;
        }
        sum
    }
}

/// `r sum_k (-r)^k n! / (n + k + 1)!`
fn series(power: f64, ratio: f64) -> f64 {
    let mut term = ratio / (power + 1.0);
    let mut sum = term;
    for k in 1..14 {
        term *= -ratio / (power + 1.0 + f64::from(k));
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lag by many small straight pieces.
    fn crept(course: &CubicSegment, mut state: f64, ratio: f64) -> f64 {
        let steps = 20_000;
        let span = ratio / f64::from(steps);
        for step in 0..steps {
            let (a, b) =
                (course.at(f64::from(step) / f64::from(steps)), course.at(f64::from(step + 1) / f64::from(steps)));
            state += (0.5 * (a + b) - state) * -(-span).exp_m1();
        }
        state
    }

    #[test]
    fn a_lag_along_a_cubic_is_what_small_steps_come_to() {
        let course = CubicSegment::smooth([0.3, 40.0], [-0.2, 70.0], 0.02);
        for ratio in [1e-6, 0.03, 0.49, 0.51, 3.0, 40.0] {
            let (exact, crept) = (course.lagged(1.7, ratio), crept(&course, 1.7, ratio));
            // The pieces leave the square of one of them, of a course of size one.
            assert!((exact - crept).abs() < 1e-6, "{ratio}: {exact} for {crept}");
        }
    }

    #[test]
    fn a_wave_of_five_samples_is_followed_to_a_hundredth() {
        let (step, turn): (f64, f64) = (1e-3, std::f64::consts::TAU / 5.0);
        let at = |row: f64| (turn * row).sin();
        let rate = |row: f64| turn / step * (turn * row).cos();
        let (mut worst, mut chord) = (0.0f64, 0.0f64);
        for row in 0..5 {
            let (a, b) = (f64::from(row), f64::from(row + 1));
            let smooth = CubicSegment::smooth([at(a), rate(a)], [at(b), rate(b)], step);
            let straight = CubicSegment::straight(at(a), at(b));
            for part in 1..10 {
                let (part, row) = (f64::from(part) / 10.0, a + f64::from(part) / 10.0);
                worst = worst.max((smooth.at(part) - at(row)).abs());
                chord = chord.max((straight.at(part) - at(row)).abs());
            }
        }
        // Hermite's error is at most (turn)^4 / 384, the chord's turn^2 / 8.
        assert!(worst < turn.powi(4) / 384.0 && worst < 0.01, "{worst}");
        assert!(chord > 0.12, "{chord}");
    }
}
