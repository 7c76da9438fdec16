//! The way of a motion between two samples.

/// Hermite's cubic `c0 + c1 s + c2 s^2 + c3 s^3`, s running from zero at one sample to one at the next.
///
/// Five samples a period, a straight piece loses an eighth of a wave's height between its samples; a cubic with the rates at
/// both loses a hundredth.
#[derive(Debug, Clone, Copy)]
pub struct CubicSegment {
    parts: [f64; 4],
}

impl CubicSegment {
    /// By value and rate at both samples, `step` seconds apart.
    #[must_use]
    pub fn hermite(first: [f64; 2], last: [f64; 2], step: f64) -> Self {
        let (rise, begin, end) = (last[0] - first[0], step * first[1], step * last[1]);
        Self { parts: [first[0], begin, 3.0 * rise - 2.0 * begin - end, begin + end - 2.0 * rise] }
    }

    /// The value at `part` of the way.
    #[must_use]
    pub fn at(&self, part: f64) -> f64 {
        let [level, slope, square, cube] = self.parts;
        level + part * (slope + part * (square + part * cube))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_of_five_samples_is_followed_to_a_hundredth() {
        let (step, turn): (f64, f64) = (1e-3, std::f64::consts::TAU / 5.0);
        let at = |row: f64| (turn * row).sin();
        let rate = |row: f64| turn / step * (turn * row).cos();
        let mut worst = 0.0f64;
        for row in 0..5 {
            let (a, b) = (f64::from(row), f64::from(row + 1));
            let segment = CubicSegment::hermite([at(a), rate(a)], [at(b), rate(b)], step);
            for part in 1..10 {
                let part = f64::from(part) / 10.0;
                worst = worst.max((segment.at(part) - at(a + part)).abs());
            }
        }
        // Hermite's error is at most (turn)^4 / 384.
        assert!(worst < turn.powi(4) / 384.0 && worst < 0.01, "{worst}");
    }
}
