//! A quadrature encoder on a timer: the other way to a position.

/// A timer that counts both edges of both channels and wraps at 16 bits. (embedded-hal 1.0 has no trait for it.)
pub trait EncoderCounter {
    /// The count.
    fn count(&mut self) -> u16;
}

impl<F: FnMut() -> u16> EncoderCounter for F {
    fn count(&mut self) -> u16 {
        self()
    }
}

/// Carries a count of 16 bits on beyond its wraps, as long as two readings lie within 32 767 counts of each other.
///
/// It is relative: zero is where the tool stood at power-on. A cable that is cut leaves the count where it is, without a parity or
/// a flag to tell, so a stuck reading is all that shows it; prefer the absolute encoder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Quadrature {
    last: Option<u16>,
    position: i32,
}

impl Quadrature {
    /// Takes a count, returns the counts since the first one.
    pub fn update(&mut self, count: u16) -> i32 {
        let step = self.last.map_or(0, |last| count.wrapping_sub(last).cast_signed());
        self.last = Some(count);
        self.position = self.position.wrapping_add(i32::from(step));
        self.position
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closure_that_reads_a_timer_is_a_counter() {
        let mut timer = 40_000_u16;
        let mut read = || {
            timer = timer.wrapping_add(30_000);
            timer
        };
        assert_eq!([read.count(), read.count()], [4_464, 34_464]);
    }
}
