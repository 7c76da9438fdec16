//! When a term is worth having: every number that decides, with its meaning and where it comes from.

use crate::diagnose::threshold::thresholds;

thresholds! { "drive";
    /// Gain of log likelihood that a term needs, nats, and more for each value: Schwarz's criterion asks (ln rows) / 2 a value, 5.3 at
    /// 40 000 rows; the rest is for the choice among some fifteen terms (ln 15 = 2.7) and their starts.
    LEAST_GAIN = 10.0, "nats", derived;
    /// See [`LEAST_GAIN`].
    LEAST_GAIN_PER_VALUE = 5.0, "nats", cited;
    /// Vuong's or Clarke's statistic over blocks, in deviations: the gain has to be there throughout, not in one place. Three deviations are
    /// one chance in 700 (Vuong, *Econometrica* 57, 1989; Clarke, *Political Analysis* 15, 2007).
    LEAST_THROUGHOUT = 3.0, "deviations", cited;
    /// Length of a block over which row likelihoods are taken together, s: longer than innovations of a wrong model remember.
    BLOCK_S = 0.5, "s", chosen;
    /// Comparisons of a larger model with a smaller one that a search makes, rounded up to a number that all recordings share: some fifteen
    /// terms for each of four places. Levels of tests are multiplied by it (Bonferroni).
    COMPARISONS = 60.0, "count", derived;
    /// Share of the unexplained power that a term has to take: a quarter, 13 % of its root mean square. Chosen: textbook laws differ
    /// from real friction by less, and at a fifth a drive with nothing missing was alarmed.
    LEAST_SHARE = 0.25, "1", chosen;
    /// What a term takes, over all that was unexplained before any, in root mean square. Chosen: the difference between two laws of one
    /// friction lies below it (LuGre's bristle against Coulomb's law: 0.03).
    LEAST_PART_OF_ALL = 0.1, "1", chosen;
    /// Share of the unexplained power that makes a term worth it however little that was of all: three quarters, half in root mean square. A
    /// link that swings leaves so much that friction beside it, which takes all of the rest, is less than a tenth. Chosen.
    MOST_OF_THE_REST = 0.75, "1", chosen;
    /// As [`LEAST_PART_OF_ALL`] for a term whose shape is free, as the pitch of a ripple or the exponent of sub-linear friction: it follows any mismatch
    /// of such a kind. Chosen, on the wrist of an arm whose other axes leave a wavy load of 0.16, on a ball screw whose published law
    /// leaves 0.15 that an exponent takes, and on motors whose cogging is all that is missing.
    LEAST_FREE_SHAPE_PART = 0.2, "1", chosen;
    /// Part of the unexplained force that is left, below which nothing further is looked for.
    NEGLIGIBLE_PART = 0.05, "1", chosen;
    /// Part of the unexplained force that is left by one body, from which a link or a play is looked for: it takes the longest.
    LINK_PART = 0.3, "1", chosen;
    /// Part of the effort's standard deviation below which a force is not told as missing, whatever its significance: no drive is known
    /// that well.
    LEAST_PART_OF_EFFORT = 0.003, "1", chosen;
    /// Part of what the smaller law leaves that a rigid one may leave where that is more than the whole effort: half in root mean square,
    /// a quarter of the power. Chosen.
    MOST_LEFT_OF_MOVED = 0.5, "1", chosen;
    /// Part of the mismatch that may be left beside named physics before `unknown` is told beside it.
    MOST_LEFT = 0.6, "1", chosen;
    /// Part of the effort above which a mismatch that nothing explains is called unknown.
    UNKNOWN_PART_OF_EFFORT = 0.02, "1", chosen;
    /// Part of a mismatch that a free curve over position leaves of what named physics leaves, below which the names are not believed
    /// alone.
    CURVE_PART = 0.5, "1", chosen;
}

/// Fewest rows of a block.
pub const BLOCK_ROWS: usize = 20;
