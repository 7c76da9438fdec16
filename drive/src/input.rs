//! The input of one tick.

use serde::{Deserialize, Serialize};

use crate::faults::Faults;

bitflags::bitflags! {
    /// Conditions reported with the sensor words of a tick.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct InputStatus: u8 {
        /// The encoder's bus did not answer.
        const NO_POSITION = 1;
        /// The converter's bus did not answer.
        const NO_FORCE = 1 << 1;
        /// There is no sample at all: nothing was read, or nothing was fed.
        const NO_SAMPLE = 1 << 2;
        /// The supply is below its threshold.
        const BROWN_OUT = 1 << 3;
        /// Nothing was heard on the link for its time-out.
        const LINK_GONE = 1 << 4;
        /// The tick before had not ended when this one was due.
        const OVERRUN = 1 << 5;
    }
}

/// Bytes of an [`Input`] on the link.
pub const INPUT_BYTES: usize = 10;

/// The raw words of the sensors, with the conditions of the tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "[u8; INPUT_BYTES]", into = "[u8; INPUT_BYTES]")]
pub struct Input {
    /// The encoder's answer to ANGLECOM, or the count of the quadrature timer.
    pub angle: u16,
    /// The encoder's answer to DIAAGC.
    pub diagnostics: u16,
    /// The converter's word.
    pub force: u32,
    /// Ticks since the input before: 1, or more where ticks were lost.
    pub elapsed: u8,
    /// Conditions of the tick.
    pub status: InputStatus,
}

impl Input {
    /// Nothing was read.
    pub const NOTHING: Self = Self { angle: 0, diagnostics: 0, force: 0, elapsed: 1, status: InputStatus::NO_SAMPLE };

    /// The faults that the status reports.
    pub fn faults(&self) -> Faults {
        let mut faults = Faults::empty();
        // The usual tick.
        if self.status.is_empty() && self.elapsed <= 1 {
            return faults;
        }
        for (note, fault) in [
            (InputStatus::NO_POSITION, Faults::POSITION_TIMEOUT),
            (InputStatus::NO_FORCE, Faults::FORCE_TIMEOUT),
            (InputStatus::NO_SAMPLE, Faults::SAMPLE_LOST),
            (InputStatus::BROWN_OUT, Faults::BROWN_OUT),
            (InputStatus::LINK_GONE, Faults::LINK_GONE),
            (InputStatus::OVERRUN, Faults::OVERRUN),
        ] {
            faults.set(fault, self.status.contains(note));
        }
        if self.elapsed > 1 { faults | Faults::SAMPLE_LOST } else { faults }
    }
}

impl From<[u8; INPUT_BYTES]> for Input {
    fn from(bytes: [u8; INPUT_BYTES]) -> Self {
        let [a0, a1, d0, d1, f0, f1, f2, f3, elapsed, status] = bytes;
        Self {
            angle: u16::from_le_bytes([a0, a1]),
            diagnostics: u16::from_le_bytes([d0, d1]),
            force: u32::from_le_bytes([f0, f1, f2, f3]),
            elapsed,
            status: InputStatus::from_bits_truncate(status),
        }
    }
}

impl From<Input> for [u8; INPUT_BYTES] {
    fn from(input: Input) -> Self {
        let ([a0, a1], [d0, d1]) = (input.angle.to_le_bytes(), input.diagnostics.to_le_bytes());
        let [f0, f1, f2, f3] = input.force.to_le_bytes();
        [a0, a1, d0, d1, f0, f1, f2, f3, input.elapsed, input.status.bits()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_condition_of_a_tick_is_its_fault() {
        let sound = Input { status: InputStatus::empty(), ..Input::NOTHING };
        assert_eq!(sound.faults(), Faults::empty());
        for (status, fault) in [
            (InputStatus::NO_POSITION, Faults::POSITION_TIMEOUT),
            (InputStatus::NO_FORCE, Faults::FORCE_TIMEOUT),
            (InputStatus::NO_SAMPLE, Faults::SAMPLE_LOST),
            (InputStatus::BROWN_OUT, Faults::BROWN_OUT),
            (InputStatus::LINK_GONE, Faults::LINK_GONE),
            (InputStatus::OVERRUN, Faults::OVERRUN),
        ] {
            assert_eq!(Input { status, ..sound }.faults(), fault);
            // A tick that was lost before it is a lost sample beside whatever else is wrong.
            assert_eq!(Input { status, elapsed: 2, ..sound }.faults(), fault | Faults::SAMPLE_LOST);
        }
    }
}
