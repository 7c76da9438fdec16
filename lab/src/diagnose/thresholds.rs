//! Every tuned number that the input checks and the preparation of signals decide by: value, unit, meaning, and where it comes from.
//!
//! "derived" follows from the reason that stands beside it, "cited" is taken from the literature or a standard, "chosen" was set by trial on
//! simulated recordings. "1" is a ratio or a share, "count" a number of things. Those of the two channels stand in `contact/criteria.rs` and
//! `drive/criteria.rs`.

use crate::threshold::Threshold;

/// Those of them that are numbers on a scale.
pub fn all() -> impl Iterator<Item = Threshold> {
    let files: &[&[Threshold]] = &[
        check_checked_trial::ALL,
        check_clock::ALL,
        check_contact::ALL,
        check_drive::ALL,
        check_excitation::ALL,
        check_held_force::ALL,
        check_position_steps::ALL,
        check_stuck_channel::ALL,
        check_units::ALL,
        derivative_filter::ALL,
        mains_tone::ALL,
        pauses::ALL,
        uniform_trial::ALL,
    ];
    files.iter().copied().flatten().copied()
}

/// Of `check/checked_trial`.
pub mod check_checked_trial {
    use crate::threshold::thresholds;

    thresholds! { "check_checked_trial";
        /// Share of the usual speed that noise may leave in it.
        MAX_SPEED_NOISE_FRACTION = 0.03, "1", chosen;
        /// Narrowest blur, in periods.
        MIN_WIDTH_PERIODS = 1.5, "1", chosen;
        /// Widest blur, as a share of the trial.
        MAX_WIDTH_FRACTION = 0.004, "1", chosen;
    }
}

/// Of `check/clock`.
pub mod check_clock {
    use crate::threshold::thresholds;

    thresholds! { "check_clock";
        /// Ratio of two periods that makes two rates.
        RATE_CHANGE_RATIO = 1.5, "1", chosen;
        /// Deviation of nine in ten intervals, over the period, from which a clock is uneven.
        MAX_JITTER = 0.25, "1", chosen;
        /// Ratio of periods of two trials that makes a difference.
        PERIOD_RATIO = 1.05, "1", chosen;
    }

    /// Stretches that a trial is cut into to see its rate change.
    ///
    /// Unit: count; chosen.
    pub const RATE_SEGMENTS: usize = 20;

    /// Rows of all trials below which little can be concluded, ...
    ///
    /// Unit: rows; chosen.
    pub const FEW_ROWS: usize = 200;

    /// ... and below which nothing can.
    ///
    /// Unit: rows; chosen.
    pub const TOO_FEW_ROWS: usize = 50;
}

/// Of `check/contact`.
pub mod check_contact {
    use crate::threshold::thresholds;

    thresholds! { "check_contact";
        /// Correlation of force and depth that speaks for itself.
        MIN_CORRELATION = 0.6, "1", chosen;
        /// Deviations of the smoothed noise from which a force is there.
        FORCE_RISE_SIGMAS = 10.0, "1", chosen;
        /// Rows, as recorded, that a state has to last to be known.
        MIN_STATE_ROWS = 5.0, "rows", chosen;
    }

    /// Slices of the depth in which a rise is looked for.
    ///
    /// Unit: count; chosen.
    pub const DEPTH_SLICES: usize = 50;
}

/// Of `check/drive`.
pub mod check_drive {
    use crate::threshold::thresholds;

    thresholds! { "check_drive";
        /// Correlation of what is left of effort and acceleration that speaks for itself.
        MIN_CORRELATION = 0.65, "1", chosen;
    }

    /// Rows that are put together, in turn.
    ///
    /// Unit: rows; chosen.
    pub const AVERAGED_ROWS: [usize; 4] = [1, 4, 16, 64];

    /// Fewest rows, or means of them.
    ///
    /// Unit: rows; chosen.
    pub const MIN_ROWS: usize = 50;
}

/// Of `check/excitation`.
pub mod check_excitation {
    use crate::threshold::thresholds;

    thresholds! { "check_excitation";
        /// Ratio of speeds below which they are one speed.
        MAX_SINGLE_SPEED_RATIO = 1.5, "1", chosen;
        /// Share of the usual speed above which the tool moves.
        MIN_MOVING_SPEED_FRACTION = 0.1, "1", chosen;
        /// Range of depths, over the depth, below which it is one depth.
        MAX_SINGLE_DEPTH_FRACTION = 0.2, "1", chosen;
        /// ... and rows, as recorded, on that way from which depth shows after all.
        MIN_DEPTH_ROWS = 20.0, "1", chosen;
        /// ... and how far they may differ, over the range of depths.
        MAX_HOLD_DEPTH_FRACTION = 0.03, "1", chosen;
        /// Share of moving rows that have to go back for it to count.
        MIN_RETURN_FRACTION = 0.02, "1", chosen;
    }

    /// Pieces of a contact among which a hold is looked for, ...
    ///
    /// Unit: count; chosen.
    pub const HOLD_SEGMENTS: usize = 16;

    /// ... how many in a row make one, ...
    ///
    /// Unit: count; chosen.
    pub const MIN_HOLD_SEGMENTS: usize = 3;

    /// Fewest rows in contact that say anything of the motion.
    ///
    /// Unit: rows; chosen.
    pub const MIN_CONTACT_ROWS: usize = 20;
}

/// Of `check/held_force`.
pub mod check_held_force {
    use crate::threshold::thresholds;

    thresholds! { "check_held_force";
        /// Part of a force's range within which it is held.
        HELD_BAND = 0.01, "1", chosen;
        /// Deviations of the smoothed noise from peak to valley of many rows, by which the band is wider.
        NOISE_RANGE = 8.0, "1", chosen;
        /// Part of a force's range over which the way to it is looked at.
        WAY_THERE = 0.2, "1", chosen;
        /// Bands by which the force would have risen over the way that the tool creeps on.
        HELD_RISE = 3.0, "1", chosen;
        /// Part of the speed with which the tool came, above which it does not creep.
        MOST_CREEP_SPEED = 0.3, "1", chosen;
    }
}

/// Of `check/position_steps`.
pub mod check_position_steps {
    use crate::threshold::thresholds;

    thresholds! { "check_position_steps";
        /// A leap is so many times what a row moves at most, ...
        JUMP_RATE_RATIO = 10.0, "1", chosen;
        /// ... such a share of the whole range, ...
        JUMP_RANGE_FRACTION = 0.1, "1", chosen;
        /// (from which it spoils the trial), ...
        GRAVE_JUMP_FRACTION = 0.5, "1", chosen;
        /// ... and so many steps of the sensor.
        JUMP_RESOLUTION_STEPS = 5.0, "1", chosen;
        /// Steps over the whole motion below which a sensor is coarse, ...
        COARSE_STEPS = 20.0, "1", chosen;
        /// ... and below which it shows next to nothing.
        BLIND_STEPS = 5.0, "1", chosen;
        /// Deviations over which pure noise ranges: a hundredth left out at either end leaves 4.7.
        NOISE_RANGE_SIGMAS = 5.5, "1", derived;
    }
}

/// Of `check/stuck_channel`.
pub mod check_stuck_channel {
    use crate::threshold::thresholds;

    thresholds! { "check_stuck_channel";
        /// White noise over the sensor's step from which neighbouring rows differ.
        NOISE_OVER_STEP = 0.7, "1", chosen;
        /// Share of its range that a channel should have moved by, or that another moves by, while it stands.
        MIN_MOVED_FRACTION = 0.05, "1", chosen;
        /// The same away from the channel's own ends, where a standing reading is less suspicious.
        MOVED_FRACTION_INSIDE_RANGE = 0.25, "1", chosen;
    }

    /// Equal rows that are worth a look.
    ///
    /// Unit: rows; chosen.
    pub const MIN_EQUAL_ROWS: usize = 8;

    /// Equal rows that noise of a step or more never gives.
    ///
    /// Unit: rows; derived.
    pub const FROZEN_ROWS: usize = 64;
}

/// Of `check/units`.
pub mod check_units {
    use crate::threshold::thresholds;

    thresholds! { "check_units";
        /// By how much a nominal stiffness may be off before a factor is no longer that factor.
        FACTOR_TOLERANCE = 2.5, "1", chosen;
    }
}

/// Of `signals/dequantize`.
pub mod dequantize {
    /// Rows on one count from which its ends tell more than its height.
    ///
    /// Unit: rows; chosen.
    pub const MIN_ROWS_ON_COUNT: usize = 3;
}

/// Of `signals/derivative_filter`.
pub mod derivative_filter {
    use crate::threshold::thresholds;

    thresholds! { "derivative_filter";
        /// Widths after which the Gaussian ends: 3e-4 of its peak.
        HALF_WIDTH_SIGMAS = 4.0, "1", derived;
    }
}

/// Of `signals/mains_tone`.
pub mod mains_tone {
    use crate::threshold::thresholds;

    thresholds! { "mains_tone";
        /// Share by which mains may be off their frequency.
        MAINS_FREQUENCY_TOLERANCE = 0.004, "1", chosen;
        /// Share within which the rest of the spectrum is what the tone is held against.
        BACKGROUND_FRACTION = 0.06, "1", chosen;
        /// Power of a tone over the mean around it. Noise comes to it once in e^40 frequencies.
        TONE_POWER_RATIO = 40.0, "1", derived;
        /// Fewest turns of the mains that tell a tone.
        MIN_CYCLES = 40.0, "1", chosen;
    }

    /// Frequencies of mains, Hz.
    ///
    /// Unit: Hz; cited.
    pub const MAINS_HZ: [f64; 2] = [50.0, 60.0];
}

/// Of `signals/pauses`.
pub mod pauses {
    use crate::threshold::thresholds;

    thresholds! { "pauses";
        /// Time in gaps, over the time that rows hold, from which a trial is divided: the even clock has eleven times the rows at the most.
        MAX_GAP_RATIO = 10.0, "1", chosen;
    }
}

/// Of `signals/prepare`.
pub mod prepare {
    /// Fewest rows of a trial: below them no filter has settled.
    ///
    /// Unit: rows; chosen.
    pub const MIN_TRIAL_ROWS: usize = 32;
}

/// Of `signals/uniform_trial`.
pub mod uniform_trial {
    use crate::threshold::thresholds;

    thresholds! { "uniform_trial";
        /// Periods without a row that make a gap.
        GAP_PERIODS = 3.5, "1", chosen;
    }
}
