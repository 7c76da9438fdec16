//! When a law counts as told by the recordings. Each number with its meaning and origin.

use crate::effects::MAINS_TOLERANCE;
use crate::threshold::thresholds;

thresholds! { "contact";
    /// Log likelihood that a larger model has to gain, nats: one in e^10 by chance for one comparison, e^5 for all [`COMPARISONS`].
    LEAST_GAIN = 10.0, "nats", derived;
    /// Comparisons of a larger model with a smaller one that a search makes, rounded up to a number that all recordings share: some fifty
    /// forms of effects in three rounds.
    COMPARISONS = 150.0, "count", derived;
    /// Share of what the smaller model leaves above the sensors' noise.
    LEAST_SHARE = 0.2, "1", chosen;
    /// Part, in root mean square, of all that the nominal law leaves above the noise. Chosen: a circuit's cubic spring takes 0.06 beside its
    /// mass; at 0.1 and at 0.05 the answers to our own published cases and to two seeds of another author's are the same.
    LEAST_PART_OF_ALL = 0.05, "1", chosen;
    /// Power over the sensors' own from which a law is one of a real thing that no textbook law reaches; what an effect has to
    /// take there is larger: a third of what is left without it, and a quarter of all in root mean square.
    FAR_FROM_NOISE = 2.0, "1", chosen;
    /// Share of what is left that counts there.
    FAR_LEAST_SHARE = 0.33, "1", chosen;
    /// Part of all, in root mean square, that counts there.
    FAR_LEAST_PART_OF_ALL = 0.25, "1", chosen;
    /// Part of the force's deviation below which nothing is told as missing, whatever its significance: no contact is known that well.
    LEAST_PART_OF_FORCE = 0.002, "1", chosen;
    /// Power of a line of the spectrum over that of the sensors' noise from which it is told: a tone of a seventh of the noise's deviation.
    /// The rows of a minute tell one of a hundredth, which nobody would call missing physics.
    LEAST_LINE_POWER = 0.01, "1", chosen;
    /// Vuong's statistic: 95 % of one side. What shows on a few occasions alone, such as a release, cannot reach more than their root; it is
    /// not asked of what takes [`LEAST_TOLD_SHARE`] of a mismatch far above the noise, for which nothing else is there.
    LEAST_VUONG = 1.6, "deviations", cited;
    /// Share of the held-out power above the noise that a named effect has to take beside the others: half of what the search asks on its
    /// own rows.
    LEAST_HELD_OUT_SHARE = 0.1, "1", chosen;
    /// Part of the sensors' power to which that is known: they are known to some 15 % in root mean square, and 1.15 squared is 1.32. A law takes
    /// its share of no smaller mismatch. Chosen.
    NOISE_POWER_KNOWN_TO = 0.32, "1", chosen;
    /// Times the force sensor's noise from which all that the sensors leave is mostly rounding of the position: twice in power. Chosen.
    ROUNDING_LIMITS = 1.5, "1", chosen;
    /// Power of what is left over the sensors' from which something is: the sensors' own noise is known to some 15 %.
    NOTABLE_POWER = 1.32, "1", derived;
    /// Power of noise that remembers, over what its rows' differences show, from which it is believed: of white noise it is found as up to
    /// that by the scatter of medians.
    LEAST_COLOUR = 1.1, "1", chosen;
    /// And part of the force's deviation from which it is called unknown.
    UNKNOWN_PART_OF_FORCE = 0.005, "1", chosen;
    /// Share of the mismatch that named effects have to take to stand for it: they halve what is left, in root mean square.
    TOLD_SHARE = 0.75, "1", derived;
    /// Share below which they are not told at all where something notable is left: most of the mismatch is something else.
    LEAST_TOLD_SHARE = 0.5, "1", derived;
    /// Part of the mismatch's power that may be left beside named effects.
    MOST_LEFT = 0.25, "1", derived;
    /// Factor by which refitted values have to lessen the residual before they are told as wrong.
    VALUES_MATTER = 1.05, "1", chosen;
    /// Integrated autocorrelation times that a block of Vuong's statistic is long at the least: what two blocks share is a tenth then.
    VUONG_BLOCK_TIMES = 3.0, "1", derived;
    /// Squares a row, over the sensors' own, from which effects are looked for from other surfaces and along a broken line: twice the
    /// noise's deviation, from which what is missing may have moved the surface.
    MUCH_MISSING = 4.0, "1", chosen;
    /// Deviation of a trial's own surface where it lies elsewhere, of the greatest depth.
    SURFACE_PRIOR = 0.3, "1", chosen;
    /// Deviation of a trial's own zero, of the greatest force.
    ZERO_PRIOR = 0.1, "1", chosen;
    /// Deviation of the logarithm of a trial's own factor: spots of one body differ by factors of 1.2 to 1.7.
    SCALE_PRIOR = 0.4, "1", chosen;
    /// Part of the greatest force that a limit of the sensor lies at, at the least.
    LEAST_REACHED_FORCE = 0.15, "1", chosen;
    /// Periods of a wave that the recordings hold at the least: two, less what a fit may be off by.
    LEAST_CYCLES = 1.8, "1", chosen;
    /// Shortest time of a memory or a lag, rows: what is quicker lies between two of them.
    LEAST_TIME_ROWS = 2.0, "rows", derived;
    /// Longest memory of the steps of an effort that couples into the force's reading: an amplifier forgets within milliseconds, and what remembers for
    /// longer is the body that is touched.
    LONGEST_COUPLING = 0.02, "s", chosen;
    /// Part of what passes with a time constant that has to pass within the longest recording: with less it is a constant to all that was seen.
    LEAST_PART_PASSED = 0.1, "1", derived;
    /// Part of the force's range from which a spring's force is said to fall on the way in.
    LEAST_FALL = 0.02, "1", chosen;
    /// Part of the force's range that either half of blocks has to see: a stop that lies within one block is known to one half alone.
    SEEN_BY_BOTH = 0.8, "1", chosen;
    /// The same of halves of trials: with less of it a law is asked for more than twice what it was taught.
    SEEN_BY_EITHER_TRIALS = 0.5, "1", derived;
    /// Share of all wavelet coefficients that what the tool does has to have to be asked for the noise's power.
    LEAST_PART_OF_COEFFICIENTS = 0.05, "1", chosen;
    /// Stretches of free motion whose means are taken off a noise's power: it is known to a quarter by as many, the root of two over 32.
    LEAST_STRETCHES = 32.0, "count", derived;
    /// Part of the noise's power that is believed to have gone with those means: beyond half of it a stretch is no longer than the memory.
    MOST_TAKEN = 0.5, "1", derived;
    /// Share of the force's variance before the surface that the position may explain: with more than half of it the tool is not free there.
    LARGEST_SHARE_BY_PLACE = 0.5, "1", derived;
    /// Part of what a law leaves in free motion beyond the sensors' noise that a force of the height alone leaves, in power, below which something
    /// acts at a distance that no law of the contact says, and its names are not believed: half, as beside a drive's curve over position.
    HEIGHT_PART = 0.5, "1", chosen;
    /// Share of a wave's variance that place and direction of the tool have from which the wave is not told from a law of the motion: half.
    LARGEST_SHARE_IN_STEP = 0.5, "1", derived;
    /// Size of a wave of the surface over that of the tool's own line of its frequency, below which it is not told from a law that is wrong there: the force
    /// of a spring that is stiffer or later by that part at one frequency is the same. Chosen: a bush in which a loop is all that is missing has waves of 0.04
    /// and 0.03, and a tool that is held softly goes with a surface by less than all of it.
    LEAST_PART_OF_OWN_WAVE = 0.25, "1", chosen;
    /// Size of a line of the tool's motion over that of what lies beside it, in root mean square: of noise one in e^9, 8000, is larger.
    OWN_LINE = 3.0, "1", derived;
    /// Part by which a line of the spectrum may be off the frequency that it is known by: that of the mains.
    LINE_TOLERANCE = MAINS_TOLERANCE, "1", cited;
}
