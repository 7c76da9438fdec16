//! Faults of a drive.

bitflags::bitflags! {
    /// Faults. One that comes and goes stays set for one to two times [`Faults::LINGER`] ticks after the last time.
    ///
    /// | fault | what the estimate says | how it recovers |
    /// |---|---|---|
    /// | `POSITION_TIMEOUT`, `_PARITY`, `_ALARM`, `_STUCK`, `_RANGE` | held and flagged; after the hold time zero, its interval infinite | with the next good sample; after the hold time from nothing, as at a first contact |
    /// | `POSITION_JUMP` | the same | from nothing: the contact before is not the contact after |
    /// | `FORCE_TIMEOUT`, `_PARITY`, `_ALARM`, `_STUCK`, `_SATURATED`, `_RANGE` | as of the position | the same |
    /// | `SAMPLE_LOST`, `REJECTED` | the same | with the next sample, whose `elapsed` covers the gap |
    /// | `BROWN_OUT` | the same: sensors on a failing supply are not believed | when the supply is back |
    /// | `OVERRUN`, `LINK_GONE` | goes on, flagged | by itself |
    /// | `WATCHDOG`, `CRASH` | goes on, flagged | when acknowledged |
    /// | `CALIBRATION` | goes on by the defaults, in units that mean nothing, flagged | with a sound calibration in flash, at the next start |
    /// | `CLOCK` | goes on, flagged: times and so damping are off by the tolerance of the internal oscillator, up to some percent | with the crystal, at the next start |
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct Faults: u32 {
        /// The encoder's bus did not answer in time.
        const POSITION_TIMEOUT = 1;
        /// A word of the encoder has the wrong parity.
        const POSITION_PARITY = 1 << 1;
        /// The encoder complains: of a command, of its magnet, or that it is not ready.
        const POSITION_ALARM = 1 << 2;
        /// The encoder has said the same for too long.
        const POSITION_STUCK = 1 << 3;
        /// The position is outside the travel.
        const POSITION_RANGE = 1 << 4;
        /// The position moved faster than the machine can.
        const POSITION_JUMP = 1 << 5;
        /// The converter's bus did not answer in time.
        const FORCE_TIMEOUT = 1 << 6;
        /// A word of the converter has the wrong parity, address or range.
        const FORCE_PARITY = 1 << 7;
        /// The converter complains of its supply.
        const FORCE_ALARM = 1 << 8;
        /// The converter has said the same for too long.
        const FORCE_STUCK = 1 << 9;
        /// The force sensor is at its end.
        const FORCE_SATURATED = 1 << 10;
        /// The force is beyond what the sensor is calibrated for.
        const FORCE_RANGE = 1 << 11;
        /// One sample or more was lost.
        const SAMPLE_LOST = 1 << 12;
        /// The interrupt took longer than its millisecond.
        const OVERRUN = 1 << 13;
        /// The link is gone.
        const LINK_GONE = 1 << 14;
        /// The supply is below its threshold.
        const BROWN_OUT = 1 << 15;
        /// The watchdog has reset the drive.
        const WATCHDOG = 1 << 16;
        /// A panic or a hard fault has reset the drive.
        const CRASH = 1 << 17;
        /// The calibration is damaged or absent: defaults are in use.
        const CALIBRATION = 1 << 18;
        /// The estimator rejected the sample.
        const REJECTED = 1 << 19;
        /// The crystal does not swing: the internal oscillator is in use.
        const CLOCK = 1 << 20;
    }
}

impl Faults {
    /// How many there are.
    pub const COUNT: usize = 21;

    /// Ticks that a fault stays set after the last time, at least; twice as many at most.
    pub const LINGER: u8 = 10;

    /// Those that hold as long as their cause and are reported at each of its ticks.
    pub const CONDITIONS: Self = Self::LINK_GONE.union(Self::BROWN_OUT);

    /// Those that stay until they are acknowledged.
    pub const LATCHED: Self = Self::WATCHDOG.union(Self::CRASH);

    /// Those that stay until the next start.
    pub const STANDING: Self = Self::CALIBRATION.union(Self::CLOCK);

    /// Those that do not invalidate the sample of their tick.
    pub const HARMLESS: Self = Self::OVERRUN.union(Self::LINK_GONE).union(Self::LATCHED).union(Self::STANDING);

    /// Its name in a table.
    pub fn name(self) -> &'static str {
        self.iter_names().next().map_or("none", |(name, _)| name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fault_has_the_name_of_its_constant() {
        assert_eq!(Faults::POSITION_TIMEOUT.name(), "POSITION_TIMEOUT");
        assert_eq!((Faults::CLOCK | Faults::CRASH).name(), "CRASH", "the first of several");
        assert_eq!(Faults::empty().name(), "none");
        assert_eq!(Faults::all().iter().count(), Faults::COUNT);
    }
}
