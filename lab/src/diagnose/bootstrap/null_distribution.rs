//! What chance alone would do: the distribution of a figure over replicates, and how far beyond it an observed one lies.

/// A figure's distribution where nothing is missing, told by replicates.
///
/// Figures here are the greatest of several chances, so their upper tail falls exponentially: Gumbel's law. Its scale is
/// taken from the replicates' spread, and never below that of the energy of one white value, exp(-x/2).
#[derive(Debug, Clone, Copy)]
pub struct NullDistribution {
    place: f64,
    scale: f64,
}

const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

impl NullDistribution {
    /// From the figures of replicates; `least` is the least scale of the tail.
    #[must_use]
    pub fn of(figures: &[f64], least: f64) -> Self {
        let count = figures.len().max(1) as f64;
        let mean = figures.iter().sum::<f64>() / count;
        let variance = figures.iter().map(|figure| (figure - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
        let moments = variance.sqrt() * 6f64.sqrt() / std::f64::consts::PI;
        Self { place: mean - EULER_GAMMA * moments, scale: moments.max(least).max(f64::MIN_POSITIVE) }
    }

    /// How far `figure` lies beyond, in scales of the tail.
    #[must_use]
    pub fn beyond(&self, figure: f64) -> f64 {
        (figure - self.place) / self.scale
    }

    /// The probability of a figure at least as great.
    #[must_use]
    pub fn p_value(&self, figure: f64) -> f64 {
        -(-(-self.beyond(figure)).exp()).exp_m1()
    }
}
