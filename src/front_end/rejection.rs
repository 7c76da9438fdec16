//! Why a sample is rejected.

use crate::contact::Sample;
use crate::front_end::FrontEnd;

/// Which field of a sample was at fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    /// [`Sample::position`].
    Position,
    /// [`Sample::force`].
    Force,
    /// [`Sample::elapsed`].
    Elapsed,
}

/// Why a sample was rejected as a whole. Nothing but the clock has moved: the next sample's `elapsed` is added to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rejection {
    /// NaN or infinite.
    NotFinite(Field),
    /// Beyond [`FrontEnd::MAX_MAGNITUDE`] internal units, or a time that does not advance.
    OutOfRange(Field),
}

impl Rejection {
    /// Rejects by the first field that is NaN or infinite.
    pub(super) fn unless_finite(sample: &Sample) -> Result<(), Self> {
        let fields =
            [(sample.position, Field::Position), (sample.force, Field::Force), (sample.elapsed, Field::Elapsed)];
        match fields.into_iter().find(|(value, _)| !value.is_finite()) {
            Some((_, field)) => Err(Self::NotFinite(field)),
            None => Ok(()),
        }
    }

    /// Rejects by the first field beyond its range: penetration and force in internal units, `elapsed` in seconds.
    pub(super) fn unless_in_range(penetration: f32, force: f32, elapsed: f32) -> Result<(), Self> {
        if penetration.abs() > FrontEnd::MAX_MAGNITUDE {
            Err(Self::OutOfRange(Field::Position))
        } else if force.abs() > FrontEnd::MAX_MAGNITUDE {
            Err(Self::OutOfRange(Field::Force))
        } else if elapsed <= 0.0 {
            Err(Self::OutOfRange(Field::Elapsed))
        } else {
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::front_end::{FrontEndConfig, FrontEndState};

    #[test]
    fn a_sample_is_accepted_up_to_the_largest_magnitude() {
        let most = FrontEnd::MAX_MAGNITUDE;
        // Its internal units are SI, and its surface is at zero.
        let front_end = FrontEnd::new(FrontEndConfig::BENCH).expect("sound settings");
        let fault = |position, force, elapsed| {
            front_end.update(&mut FrontEndState::default(), Sample { position, force, elapsed }).err()
        };
        for value in [most, -most] {
            assert_eq!(fault(value, 0.0, 1e-3), None);
            assert_eq!(fault(0.0, value, 1e-3), None);
            assert_eq!(fault(value * 1.001, 0.0, 1e-3), Some(Rejection::OutOfRange(Field::Position)));
            assert_eq!(fault(0.0, value * 1.001, 1e-3), Some(Rejection::OutOfRange(Field::Force)));
        }
        for elapsed in [0.0, -1e-3] {
            assert_eq!(fault(0.0, 0.0, elapsed), Some(Rejection::OutOfRange(Field::Elapsed)));
        }
        assert_eq!(fault(f32::NAN, 0.0, 1e-3), Some(Rejection::NotFinite(Field::Position)));
        assert_eq!(fault(0.0, f32::INFINITY, 1e-3), Some(Rejection::NotFinite(Field::Force)));
        assert_eq!(fault(0.0, 0.0, f32::NAN), Some(Rejection::NotFinite(Field::Elapsed)));
    }
}
