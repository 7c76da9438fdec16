//! Every tuned number of the diagnosis that has a name: value, unit, meaning, and where it comes from.
//!
//! "derived" follows from the reason that stands beside it, "cited" is taken from a standard, "chosen" was set by trial on
//! simulated recordings. "1" is a ratio or a share, "count" a number of things.

/// Of `bootstrap/fitted_model`.
pub mod fitted_model {
    /// Share of its scale by which a value may be biased.
    ///
    /// Unit: 1; chosen.
    pub const MAX_BIAS_FRACTION: f64 = 0.5;

    /// Growth of what replicates leave beyond which their origin is astray.
    ///
    /// Unit: 1; chosen.
    pub const DIVERGENCE_RATIO: f64 = 2.0;

    /// Times that replicates follow values that go on.
    ///
    /// Unit: count; chosen.
    pub const MAX_REFITS: usize = 2;

    /// Replicates that tell the expected noise.
    ///
    /// Unit: count; chosen.
    pub const NOISE_REPLICATES: usize = 24;

    /// Power over the noise's from which much is missing.
    ///
    /// Unit: 1; chosen.
    pub const LARGE_MISFIT_RATIO: f64 = 30.0;

    /// Doubt from which a residual within it is not looked into.
    ///
    /// Unit: 1; chosen.
    pub const MIN_QUANTIZATION_POWER: f64 = 1.2;

    /// Part of a rounding's power that is taken for possible.
    ///
    /// Unit: 1; chosen.
    pub const CONTACT_QUANTIZATION_FACTOR: f64 = 1.4;

    /// The same of a rounding's power in the balance of the drive.
    ///
    /// Unit: 1; chosen.
    pub const DRIVE_QUANTIZATION_FACTOR: f64 = 0.02;
}

/// Of `bootstrap/sampler`.
pub mod sampler {
    /// Widths of the filter over which a rest begins and ends.
    ///
    /// Unit: 1; chosen.
    pub const REST_EDGE_WIDTHS: f64 = 3.0;

    /// Replicates from which the noise of the sensors is told.
    ///
    /// Unit: count; chosen.
    pub const SPECTRUM_REPLICATES: usize = 4;
}

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

    /// Rows of all trials below which little can be told, ...
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
    pub const ONE_SPEED: f64 = 1.5;

    /// Share of the usual speed above which the tool moves.
    ///
    /// Unit: 1; chosen.
    pub const MOVES: f64 = 0.1;

    /// Range of depths, over the depth, below which it is one depth.
    ///
    /// Unit: 1; chosen.
    pub const ONE_DEPTH: f64 = 0.2;

    /// ... and rows, as recorded, on that way from which depth shows after all.
    ///
    /// Unit: 1; chosen.
    pub const SHOWN: f64 = 20.0;

    /// Pieces of a contact among which a hold is looked for, ...
    ///
    /// Unit: count; chosen.
    pub const PIECES: usize = 16;

    /// ... how many in a row make one, ...
    ///
    /// Unit: count; chosen.
    pub const HELD: usize = 3;

    /// ... and how far they may differ, over the range of depths.
    ///
    /// Unit: 1; chosen.
    pub const STILL: f64 = 0.03;

    /// Share of moving rows that have to go back for it to count.
    ///
    /// Unit: 1; chosen.
    pub const BACK: f64 = 0.02;

    /// Fewest rows in contact that say anything of the motion.
    ///
    /// Unit: rows; chosen.
    pub const ROWS: usize = 20;
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

/// Of `estimation/levenberg_marquardt`.
pub mod levenberg_marquardt {
    /// Share of its scale by which a value is moved to see what it does.
    ///
    /// Unit: 1; chosen.
    pub const DIFFERENCE_STEP: f64 = 1e-4;

    /// Steps at most.
    ///
    /// Unit: count; chosen.
    pub const MAX_ITERATIONS: usize = 40;

    /// Damping beyond which no step is left to try.
    ///
    /// Unit: 1; chosen.
    pub const MAX_DAMPING: f64 = 1e6;

    /// Energy that a clock's fraction of a sample costs at its bound: it is not to move for nothing, for a damper does nearly
    /// the same.
    ///
    /// Unit: 1; chosen.
    pub const TIMING_PENALTY: f64 = 9.0;
}

/// Of `estimation/periodogram`.
pub mod periodogram {
    /// Frequencies that are tried in full.
    ///
    /// Unit: count; chosen.
    pub const MAX_FREQUENCIES: usize = 3;
}

/// Of `estimation/projection`.
pub mod projection {
    /// Share of a direction that must not be the model's own, for it to be told from it.
    ///
    /// Unit: 1; chosen.
    pub const MIN_ORTHOGONAL_FRACTION: f64 = 1e-5;
}

/// Of `estimation/residual_summary`.
pub mod residual_summary {
    /// Effects that are worth a closer look, on the recording and on its replicates.
    ///
    /// Unit: count; chosen.
    pub const MAX_PROMISING: usize = 16;
}

/// Of `estimation/whitener`.
pub mod whitener {
    /// Order of the predictor.
    ///
    /// Unit: count; chosen.
    pub const AR_ORDER: usize = 8;

    /// Power over the noise's up to which a residual tells its own memory.
    ///
    /// Unit: 1; chosen.
    pub const OWN_AUTOCORRELATION_POWER_RATIO: f64 = 2.0;
}

/// Of `experiment/description`.
pub mod experiment_description {
    /// Rates below this one are not set against that of the recordings: a ratio of two nothings.
    ///
    /// Unit: 1; chosen.
    pub const MIN_RATE: f64 = 1e-3;

    /// Share of the noise below which a residual is not quoted.
    ///
    /// Unit: 1; chosen.
    pub const MIN_RMS_OVER_NOISE: f64 = 0.05;

    /// Share of the greatest force, or effort, below which a noise is that of ideal sensors.
    ///
    /// Unit: 1; chosen.
    pub const IDEAL_SENSOR_RATIO: f64 = 1e-7;
}

/// Of `experiment/motion_limits`.
pub mod experiment_motion_limits {
    /// Deviations of its noise by which a peak is lowered before it counts as reached.
    ///
    /// Unit: 1; chosen.
    pub const PEAK_NOISE_SIGMAS: f64 = 4.0;

    /// Share of the reach of a recording below which a depth, or free space, is none.
    ///
    /// Unit: 1; chosen.
    pub const MIN_RANGE_FRACTION: f64 = 0.02;

    /// Share of the analysis' corner frequency below which a sine passes it nearly whole.
    ///
    /// Unit: 1; chosen.
    pub const PASSBAND_FRACTION: f64 = 0.6;
}

/// Of `experiment/synthetic_rig`.
pub mod experiment_synthetic_rig {
    /// Steps in which the effort is found that a motion takes.
    ///
    /// Unit: count; chosen.
    pub const MAX_EFFORT_ITERATIONS: usize = 30;

    /// Growth of the greatest force, or effort, that is no harm.
    ///
    /// Unit: 1; chosen.
    pub const LOAD_MARGIN: f64 = 1.15;
}

/// Of `experiment/test_motions`.
pub mod experiment_test_motions {
    /// Share of the longest recording that a hold takes.
    ///
    /// Unit: 1; chosen.
    pub const HOLD_FRACTION: f64 = 1.0 / 16.0;

    /// Share of it in which sines of one frequency go on.
    ///
    /// Unit: 1; chosen.
    pub const SINE_FRACTION: f64 = 1.0 / 10.0;
}

/// Of `experiment/trajectory`.
pub mod experiment_trajectory {
    /// Instants a turn at which a wave is held against the limits.
    ///
    /// Unit: count; chosen.
    pub const SAMPLES_PER_CYCLE: usize = 64;

    /// Share of the longest recording that a move may take, be it ever so slow.
    ///
    /// Unit: 1; chosen.
    pub const MAX_MOVE_FRACTION: f64 = 0.1;

    /// Turns over which a wave grows, and over which it fades.
    ///
    /// Unit: 1; chosen.
    pub const FADE_CYCLES: f64 = 1.0;
}

/// Of `experiment`.
pub mod experiment {
    /// Energy from which two models count as told apart: chance leaves less but once in two thousand times.
    ///
    /// Unit: 1; derived.
    pub const DECISIVE_CHI2: f64 = 12.0;

    /// Parts of the greatest speed at which a motion is tried, until force and effort stay within what they were.
    ///
    /// Unit: 1; chosen.
    pub const SPEED_FRACTIONS: [f64; 5] = [1.0, 0.8, 0.6, 0.4, 0.2];
}

/// Of `model/contact_phase`.
pub mod contact_phase {
    /// Widths of the smoothing filter that an onset and a release last.
    ///
    /// Unit: 1; chosen.
    pub const TRANSITION_WIDTHS: f64 = 8.0;

    /// Widths by which they begin before the surface is reached: the filter sees the touch coming.
    ///
    /// Unit: 1; chosen.
    pub const ANTICIPATION_WIDTHS: f64 = 3.0;

    /// Speed, over that of the motion in contact, below which the tool is held.
    ///
    /// Unit: 1; chosen.
    pub const HOLD_SPEED_FRACTION: f64 = 0.1;
}

/// Of `report/residual_location`.
pub mod residual_location {
    /// Places that are told.
    ///
    /// Unit: count; chosen.
    pub const MAX_LOCATIONS: usize = 6;

    /// Least share of a place that is told.
    ///
    /// Unit: 1; chosen.
    pub const MIN_LOCATION_SHARE: f64 = 0.05;

    /// Bins along a quantity.
    ///
    /// Unit: count; chosen.
    pub const BINS: usize = 8;
}

/// Of `selection/cross_validation`.
pub mod cross_validation {
    /// Stretches a trial is cut into.
    ///
    /// Unit: 1; chosen.
    pub const FOLD_SEGMENTS: f64 = 10.0;
}

/// Of `selection/forward_selection`.
pub mod forward_selection {
    /// Replicates a stand is judged by, and the rows that many of them can have.
    ///
    /// Unit: count; chosen.
    pub const MAX_REPLICATES: usize = 40;

    /// See the doc comment above.
    ///
    /// Unit: rows; chosen.
    pub const REPLICATE_ROW_BUDGET: f64 = 1.2e6;

    /// Effects at most.
    ///
    /// Unit: count; chosen.
    pub const MAX_EFFECTS: usize = 4;

    /// Candidates that are judged on held-out data.
    ///
    /// Unit: count; chosen.
    pub const MAX_CROSS_VALIDATED: usize = 8;

    /// Probability of a false alarm on a stand.
    ///
    /// Unit: 1; chosen.
    pub const FALSE_ALARM_RATE: f64 = 0.002;

    /// Least size of an effect: share of the residual's root mean square, in a channel it reaches, on data that its fit did not
    /// see.
    ///
    /// Unit: 1; chosen.
    pub const MIN_EFFECT_RMS_FRACTION: f64 = 0.2;

    /// Share of the energy from which an effect is believed, whatever the encoder's steps may leave of force and of effort.
    ///
    /// Unit: 1; chosen.
    pub const CONVINCING_FRACTION: [f64; 2] = [0.25, 0.05];

    /// Least share of the energy above the expected noise that a further effect has to take.
    ///
    /// Unit: 1; chosen.
    pub const MIN_GAIN_FRACTION: f64 = 0.12;

    /// Energy, beside the price of its parameters, that a alternative or a finer form has to take to stand in a term's place.
    ///
    /// Unit: 1; chosen.
    pub const REPLACEMENT_CHI2_MARGIN: f64 = 8.0;

    /// Share of what lies above the expected noise that a finer form has to take.
    ///
    /// Unit: 1; chosen.
    pub const MIN_REFINED_FORM_GAIN: f64 = 0.25;

    /// Power over the expected noise's that is left once something is named, below which nothing further is looked for: a residual five
    /// per cent above what the sensors leave.
    ///
    /// Unit: 1; chosen.
    pub const SUFFICIENT_POWER_RATIO: f64 = 1.1;

    /// Share of the power that the first effects took, below which what is left is the difference between a law and nature.
    ///
    /// Unit: 1; chosen.
    pub const MIN_REMAINING_FRACTION: f64 = 0.005;

    /// Energy over that of the stand's own values below which they were not the best.
    ///
    /// Unit: 1; chosen.
    pub const RECONVERGENCE_RATIO: f64 = 0.97;
}

/// Of `selection/verdict`.
pub mod verdict {
    /// Share of the energy above the expected noise that named effects have to take where something is left beside them.
    ///
    /// Unit: 1; chosen.
    pub const MIN_EXPLAINED_FRACTION: f64 = 0.7;

    /// Least excess of energy, over what replicates leave, that is called structure.
    ///
    /// Unit: 1; chosen.
    pub const MIN_EXCESS_FRACTION: f64 = 0.015;

    /// Least power over the expected noise's that is called structure: a residual a seventh above what the sensors leave. What a contact
    /// begins and ends with is only known to about a tenth.
    ///
    /// Unit: 1; chosen.
    pub const STRUCTURE_POWER_RATIO: f64 = 1.3;

    /// Root mean square over the expected noise's beyond which something is left, whatever its pattern.
    ///
    /// Unit: 1; chosen.
    pub const MAX_RMS_OVER_NOISE: f64 = 2.0;

    /// Growth of the root mean square from refitted to given values that is called a wrong value.
    ///
    /// Unit: 1; chosen.
    pub const WRONG_VALUE_RMS_RATIO: f64 = 1.05;

    /// Growth of the root mean square on unseen data in either channel that no explanation may bring.
    ///
    /// Unit: 1; chosen.
    pub const WORSE_RMS_RATIO: f64 = 1.05;

    /// Share of what is left without it on unseen data, of its power or of its whitened energy above what replicates leave, that an effect
    /// beside others has to take where structure is left.
    ///
    /// Unit: 1; chosen.
    pub const MIN_SUPPORT: f64 = 0.25;

    /// The same of its power where much is left: it has to halve it.
    ///
    /// Unit: 1; chosen.
    pub const MIN_SUPPORT_FAR_FROM_NOISE: f64 = 0.5;

    /// Energy by which a alternative may stand behind, for chance: 12 of a white energy is a probability of 5e-4 for one value.
    ///
    /// Unit: 1; derived.
    pub const ALTERNATIVE_CHI2_MARGIN: f64 = 12.0;

    /// Share of an effect's own energy by which a alternative may stand behind: laws are never quite those of nature.
    ///
    /// Unit: 1; chosen.
    pub const ALTERNATIVE_REL_MARGIN: f64 = 0.06;

    /// Rivals that are fitted in full.
    ///
    /// Unit: count; chosen.
    pub const MAX_FITTED_ALTERNATIVES: usize = 10;
}

/// Of `signals/bandwidth`.
pub mod bandwidth {
    /// How much less sharply the drive is looked at once more, and the share by which its inertia may differ then.
    ///
    /// Unit: 1; chosen.
    pub const BANDWIDTH_STEP: f64 = 1.4;

    /// See the doc comment above.
    ///
    /// Unit: 1; chosen.
    pub const INERTIA_TOLERANCE: f64 = 0.05;

    /// Periods of the -3 dB frequency that all trials together have at the least: fewer tell no inertia.
    ///
    /// Unit: 1; chosen.
    pub const MIN_CUTOFF_PERIODS: f64 = 10.0;
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
    /// Greatest share of the rate that is looked at.
    ///
    /// Unit: 1; chosen.
    pub const MAX_CUTOFF_OVER_RATE: f64 = 0.2;

    /// Rows of the analysis a period of the -3 dB frequency. The Gaussian is down to a ninth where they alias.
    ///
    /// Unit: 1; derived.
    pub const ROWS_PER_CUTOFF_PERIOD: f64 = 5.0;

    /// Deviation that position noise may add to the predicted force, over that of the force noise. A coarse encoder hides
    /// true motion below its step, which the drive's answer to its own steps makes: what cannot be seen is smoothed away.
    ///
    /// Unit: 1; chosen.
    pub const MAX_POSITION_NOISE_RATIO: f64 = 0.6;

    /// Part of the drive's inertia that may be carried beyond the force sensor or with the surface, and the deviation that
    /// noise of its acceleration may add, over that of the force noise. The drive shakes the tool by less than a step of the
    /// encoder; a mass feels that, and seen through the steps it seems lighter than it is.
    ///
    /// Unit: 1; chosen.
    pub const CARRIED_MASS_FRACTION: f64 = 0.05;

    /// See the doc comment above.
    ///
    /// Unit: 1; chosen.
    pub const MAX_ACCELERATION_NOISE_RATIO: f64 = 0.05;

    /// Share of the sharpest filter that noise allows where nobody says how heavy the drive is.
    ///
    /// Unit: 1; chosen.
    pub const CUTOFF_FRACTION_UNKNOWN_INERTIA: f64 = 0.3;

    /// Widths after which the Gaussian ends: 3e-4 of its peak.
    ///
    /// Unit: 1; derived.
    pub const HALF_WIDTH_SIGMAS: f64 = 4.0;

    /// Rows of the analysis that all trials together should have, unless that would blind it.
    ///
    /// Unit: rows; chosen.
    pub const ROW_BUDGET: f64 = 9_000.0;

    /// Rows of all trials together beyond which a quicker clock tells nothing of how sharp the least filter may be.
    ///
    /// Unit: rows; chosen.
    pub const AMPLE_ROWS: f64 = 60_000.0;

    /// Rows below which none are given up for a law to act between two filters.
    ///
    /// Unit: rows; chosen.
    pub const MIN_ROWS_FOR_CASCADE: f64 = 1_000.0;

    /// How much sharper laws may look than the rows that are kept of what they leave.
    ///
    /// Unit: 1; chosen.
    pub const MAX_CASCADE_RATIO: f64 = 3.0;

    /// Share of a tone's frequency at which the filter that has to show it ends: a third of it passes.
    ///
    /// Unit: 1; chosen.
    pub const CUTOFF_OVER_TONE: f64 = 0.6;
}

/// Of `signals/filtered_trial`.
pub mod filtered_trial {
    /// Deviations of noise within which a velocity counts as none.
    ///
    /// Unit: 1; chosen.
    pub const AT_REST_SIGMAS: f64 = 3.0;
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

/// Of `signals/prepare`.
pub mod prepare {
    /// Rows that are looked at, a period of the sharpest filter's -3 dB frequency: their mean takes 0.4 % there, of all channels
    /// alike.
    ///
    /// Unit: 1; derived.
    pub const ROWS_PER_CUTOFF_PERIOD: f64 = 20.0;

    /// Fewest rows of a trial: below them no filter has settled.
    ///
    /// Unit: rows; chosen.
    pub const MIN_TRIAL_ROWS: usize = 32;
}

/// Of `signals/uniform_trial`.
pub mod uniform_trial {
    /// Lengths of a gap until its end is trusted again: what happened in it nobody saw, and a contact remembers.
    ///
    /// Unit: 1; chosen.
    pub const GAP_RECOVERY_LENGTHS: f64 = 3.0;

    /// Periods without a row that make a gap.
    ///
    /// Unit: 1; chosen.
    pub const GAP_PERIODS: f64 = 3.5;
}
