//! Every tuned number of the diagnosis that has a name: value, unit, meaning, and where it comes from.
//!
//! "derived" follows from the reason that stands beside it, "cited" is taken from a standard, "chosen" was set by trial on
//! simulated recordings. "1" is a ratio or a share, "count" a number of things.

/// Of `check/checked_trial`.
pub mod check_checked_trial {
    /// Share of the usual speed that noise may leave in it.
    ///
    /// Unit: 1; chosen.
    pub const MAX_SPEED_NOISE_FRACTION: f64 = 0.03;

    /// Narrowest blur, in periods.
    ///
    /// Unit: 1; chosen.
    pub const MIN_WIDTH_PERIODS: f64 = 1.5;

    /// Widest blur, as a share of the trial.
    ///
    /// Unit: 1; chosen.
    pub const MAX_WIDTH_FRACTION: f64 = 0.004;
}

/// Of `check/clock`.
pub mod check_clock {
    /// Stretches that a trial is cut into to see its rate change.
    ///
    /// Unit: count; chosen.
    pub const RATE_SEGMENTS: usize = 20;

    /// Ratio of two periods that makes two rates.
    ///
    /// Unit: 1; chosen.
    pub const RATE_CHANGE_RATIO: f64 = 1.5;

    /// Deviation of nine in ten intervals, over the period, from which a clock is uneven.
    ///
    /// Unit: 1; chosen.
    pub const MAX_JITTER: f64 = 0.25;

    /// Ratio of periods of two trials that makes a difference.
    ///
    /// Unit: 1; chosen.
    pub const PERIOD_RATIO: f64 = 1.05;

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
    /// Correlation of force and depth that speaks for itself.
    ///
    /// Unit: 1; chosen.
    pub const MIN_CORRELATION: f64 = 0.6;

    /// Deviations of the smoothed noise from which a force is there.
    ///
    /// Unit: 1; chosen.
    pub const FORCE_RISE_SIGMAS: f64 = 10.0;

    /// Slices of the depth in which a rise is looked for.
    ///
    /// Unit: count; chosen.
    pub const DEPTH_SLICES: usize = 50;

    /// Rows, as recorded, that a state has to last to be known.
    ///
    /// Unit: rows; chosen.
    pub const MIN_STATE_ROWS: f64 = 5.0;
}

/// Of `check/drive`.
pub mod check_drive {
    /// Correlation of what is left of effort and acceleration that speaks for itself.
    ///
    /// Unit: 1; chosen.
    pub const MIN_CORRELATION: f64 = 0.65;

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
    /// Ratio of speeds below which they are one speed.
    ///
    /// Unit: 1; chosen.
    pub const MAX_SINGLE_SPEED_RATIO: f64 = 1.5;

    /// Share of the usual speed above which the tool moves.
    ///
    /// Unit: 1; chosen.
    pub const MIN_MOVING_SPEED_FRACTION: f64 = 0.1;

    /// Range of depths, over the depth, below which it is one depth.
    ///
    /// Unit: 1; chosen.
    pub const MAX_SINGLE_DEPTH_FRACTION: f64 = 0.2;

    /// ... and rows, as recorded, on that way from which depth shows after all.
    ///
    /// Unit: 1; chosen.
    pub const MIN_DEPTH_ROWS: f64 = 20.0;

    /// Pieces of a contact among which a hold is looked for, ...
    ///
    /// Unit: count; chosen.
    pub const HOLD_SEGMENTS: usize = 16;

    /// ... how many in a row make one, ...
    ///
    /// Unit: count; chosen.
    pub const MIN_HOLD_SEGMENTS: usize = 3;

    /// ... and how far they may differ, over the range of depths.
    ///
    /// Unit: 1; chosen.
    pub const MAX_HOLD_DEPTH_FRACTION: f64 = 0.03;

    /// Share of moving rows that have to go back for it to count.
    ///
    /// Unit: 1; chosen.
    pub const MIN_RETURN_FRACTION: f64 = 0.02;

    /// Fewest rows in contact that say anything of the motion.
    ///
    /// Unit: rows; chosen.
    pub const MIN_CONTACT_ROWS: usize = 20;
}

/// Of `check/position_steps`.
pub mod check_position_steps {
    /// A leap is so many times what a row moves at most, ...
    ///
    /// Unit: 1; chosen.
    pub const JUMP_RATE_RATIO: f64 = 10.0;

    /// ... such a share of the whole range, ...
    ///
    /// Unit: 1; chosen.
    pub const JUMP_RANGE_FRACTION: f64 = 0.1;

    /// (from which it spoils the trial), ...
    ///
    /// Unit: 1; chosen.
    pub const GRAVE_JUMP_FRACTION: f64 = 0.5;

    /// ... and so many steps of the sensor.
    ///
    /// Unit: 1; chosen.
    pub const JUMP_RESOLUTION_STEPS: f64 = 5.0;

    /// Steps over the whole motion below which a sensor is coarse, ...
    ///
    /// Unit: 1; chosen.
    pub const COARSE_STEPS: f64 = 20.0;

    /// ... and below which it shows next to nothing.
    ///
    /// Unit: 1; chosen.
    pub const BLIND_STEPS: f64 = 5.0;

    /// Deviations over which pure noise ranges: a hundredth left out at either end leaves 4.7.
    ///
    /// Unit: 1; derived.
    pub const NOISE_RANGE_SIGMAS: f64 = 5.5;
}

/// Of `check/stuck_channel`.
pub mod check_stuck_channel {
    /// Equal rows that are worth a look.
    ///
    /// Unit: rows; chosen.
    pub const MIN_EQUAL_ROWS: usize = 8;

    /// Equal rows that noise of a step or more never gives.
    ///
    /// Unit: rows; derived.
    pub const FROZEN_ROWS: usize = 64;

    /// White noise over the sensor's step from which neighbouring rows differ.
    ///
    /// Unit: 1; chosen.
    pub const NOISE_OVER_STEP: f64 = 0.7;

    /// Share of its range that a channel should have moved by, or that another moves by, while it stands.
    ///
    /// Unit: 1; chosen.
    pub const MIN_MOVED_FRACTION: f64 = 0.05;

    /// The same away from the channel's own ends, where a standing reading is less suspicious.
    ///
    /// Unit: 1; chosen.
    pub const MOVED_FRACTION_INSIDE_RANGE: f64 = 0.25;
}

/// Of `check/units`.
pub mod check_units {
    /// By how much a nominal stiffness may be off before a factor is no longer that factor.
    ///
    /// Unit: 1; chosen.
    pub const FACTOR_TOLERANCE: f64 = 2.5;
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
    /// Widths after which the Gaussian ends: 3e-4 of its peak.
    ///
    /// Unit: 1; derived.
    pub const HALF_WIDTH_SIGMAS: f64 = 4.0;
}

/// Of `signals/mains_tone`.
pub mod mains_tone {
    /// Frequencies of mains, Hz.
    ///
    /// Unit: Hz; cited.
    pub const MAINS_HZ: [f64; 2] = [50.0, 60.0];

    /// Share by which mains may be off their frequency.
    ///
    /// Unit: 1; chosen.
    pub const MAINS_FREQUENCY_TOLERANCE: f64 = 0.004;

    /// Share within which the rest of the spectrum is what the tone is held against.
    ///
    /// Unit: 1; chosen.
    pub const BACKGROUND_FRACTION: f64 = 0.06;

    /// Power of a tone over the mean around it. Noise comes to it once in e^40 frequencies.
    ///
    /// Unit: 1; derived.
    pub const TONE_POWER_RATIO: f64 = 40.0;

    /// Fewest turns of the mains that tell a tone.
    ///
    /// Unit: 1; chosen.
    pub const MIN_CYCLES: f64 = 40.0;
}

/// Of `signals/pauses`.
pub mod pauses {
    /// Time in gaps, over the time that rows hold, from which a trial is divided: the even clock has eleven times the rows at the most.
    ///
    /// Unit: 1; chosen.
    pub const MAX_GAP_RATIO: f64 = 10.0;
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
    /// Periods without a row that make a gap.
    ///
    /// Unit: 1; chosen.
    pub const GAP_PERIODS: f64 = 3.5;
}
