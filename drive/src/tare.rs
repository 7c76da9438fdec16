//! Taring: the zero of the force sensor is measured again.

/// Samples that a tare is the mean of: a fifth of a second, ten periods of the mains.
pub const TARE_SAMPLES: u16 = 200;

/// A tare in progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tare {
    taken: u16,
    sum: i32,
}

impl Tare {
    /// Takes a good reading; the zero where it was the last one.
    pub fn take(&mut self, code: i32) -> Option<f32> {
        self.taken += 1;
        // 200 readings of 16 bits stay far below 2^31, and below 2^24 so that the quotient is exact to a bit.
        self.sum = self.sum.saturating_add(code);
        (self.taken >= TARE_SAMPLES).then(|| self.sum as f32 / f32::from(TARE_SAMPLES))
    }
}
