//! Conditions that limit the validity of an estimate.

bitflags::bitflags! {
    /// Conditions that limit the validity of an estimate; empty on a good one.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct Flags: u16 {
        /// The tool touches nothing: K and B read zero.
        const NO_CONTACT = 1;
        /// The window or memory is not yet full.
        const FILLING = 1 << 1;
        /// Too few samples to solve for two numbers: the estimate is held.
        const TOO_FEW = 1 << 2;
        /// Penetration and rate are in line: K alone was updated and B is held.
        const DAMPING_HELD = 1 << 3;
        /// No direction could be solved for: both are held.
        const HELD = 1 << 4;
        /// The covariance was at its limit: nothing is forgotten while nothing moves.
        const LIMITED = 1 << 5;
        /// The interval of K is wider than 30 % of K.
        const STIFFNESS_UNCERTAIN = 1 << 6;
        /// The interval of B is wider than 30 % of B.
        const DAMPING_UNCERTAIN = 1 << 7;
        /// K or B is negative.
        const NEGATIVE = 1 << 8;
        /// The filters began anew at this sample: the first, or after a gap in time.
        const RESTARTED = 1 << 9;
        /// The tool moved by fewer than four counts of the position sensor within the memory.
        const LITTLE_MOVEMENT = 1 << 10;
        /// The covariance was found unsound and set back to its start.
        const RESET = 1 << 11;
        /// The material was found to have changed at this sample: earlier samples no longer count.
        const CHANGED = 1 << 12;
    }
}
