//! Where a number lies between two ends of a picture.

/// Ratios beyond this hide what is small, unless the scale is logarithmic.
const WIDEST_LINEAR: f64 = 20.0;

/// A scale from 0 to 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    low: f64,
    high: f64,
    /// Whether equal steps are equal factors.
    pub(super) logarithmic: bool,
}

impl Axis {
    /// One that shows `values`; those that are no numbers or not positive do not count.
    pub(super) fn over(values: impl Iterator<Item = f64>) -> Self {
        let positive = values.filter(|value| value.is_finite() && *value > 0.0);
        let (least, most) = positive.fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        if most <= 0.0 {
            return Self { low: 0.0, high: 1.0, logarithmic: false };
        }
        let logarithmic = most / least > WIDEST_LINEAR;
        // Under the least value some length is left, or its bar would be none.
        let low = if logarithmic { 0.4 * least } else { 0.0 };
        Self { low, high: most, logarithmic }
    }

    /// The share of the length up to `value`; `None` where it is no number.
    pub(super) fn at(&self, value: f64) -> Option<f64> {
        let along = match (self.logarithmic, value > 0.0) {
            (true, true) => (value / self.low).ln() / (self.high / self.low).ln(),
            (true, false) => 0.0,
            (false, _) => (value - self.low) / (self.high - self.low),
        };
        value.is_finite().then(|| along.clamp(0.0, 1.0))
    }

    /// The powers of ten within.
    pub(super) fn decades(&self) -> Vec<f64> {
        if !self.logarithmic {
            return Vec::new();
        }
        let (first, last) = (self.low.log10().ceil() as i32, self.high.log10().floor() as i32);
        // Over very many of them every line would be one among neighbours.
        let step = ((last - first) / 6 + 1).max(1) as usize;
        (first..=last).step_by(step).map(|power| 10f64.powi(power)).collect()
    }
}

/// A coordinate as an attribute: a share of the width.
pub(super) fn across(share: f64) -> String {
    format!("{:.2}%", 100.0 * share)
}
