//! How the effort ends where the drive can give no more.

/// What becomes of a commanded effort. Limits are positive, N or N m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum EffortLimit {
    /// All of it acts.
    #[default]
    None,
    /// Up to the limit all of it, beyond it the limit: a current that is cut off.
    Sharp(f64),
    /// limit tanh(effort / limit): iron that saturates gives less and less.
    Smooth(f64),
}

impl EffortLimit {
    /// What acts of `effort`.
    #[must_use]
    pub fn passed(self, effort: f64) -> f64 {
        match self {
            Self::None => effort,
            Self::Sharp(limit) => effort.clamp(-limit, limit),
            Self::Smooth(limit) => limit * (effort / limit).tanh(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn little_effort_passes_and_no_more_than_the_limit_does() {
        for effort in [-50.0, -3.0, 0.0, 1e-3, 4.0, 80.0] {
            assert_eq!(EffortLimit::None.passed(effort), effort);
            let [sharp, smooth] = [EffortLimit::Sharp(4.0), EffortLimit::Smooth(4.0)].map(|law| law.passed(effort));
            assert_eq!(sharp, effort.signum() * effort.abs().min(4.0) + 0.0);
            // tanh by its exponentials; beyond 18 it is one to the last digit.
            let whole = (2.0 * effort / 4.0).exp();
            let by_hand = if effort > 70.0 { 4.0 } else { 4.0 * (whole - 1.0) / (whole + 1.0) };
            assert!((smooth - by_hand).abs() < 1e-12, "{effort}: {smooth} {by_hand}");
        }
    }
}
