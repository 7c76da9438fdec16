//! When a term is worth having: every number that decides, with its meaning and where it comes from.

use crate::threshold::thresholds;

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
    /// Part of the power of the noise that is recorded with an effort to which that noise is known: to 20 % in root mean square, 1.2 squared less one. 20 % is
    /// what is asked of an expected noise.
    NOISE_POWER_KNOWN_TO = 0.44, "1", derived;
    /// Share of the unexplained power that a term has to take: a quarter, 13 % of its root mean square. Chosen: textbook laws differ
    /// from real friction by less, and at a fifth a drive with nothing missing was alarmed.
    LEAST_SHARE = 0.25, "1", chosen;
    /// What a term takes, over all that was unexplained before any, in root mean square. Chosen: the difference between two laws of one
    /// friction lies below it (LuGre's bristle against Coulomb's law: 0.03).
    LEAST_PART_OF_ALL = 0.1, "1", chosen;
    /// Share of the unexplained power that makes a term worth it however little that was of all: three quarters, half in root mean square. A
    /// link that swings leaves so much that friction beside it, which takes all of the rest, is less than a tenth; grease that thins under
    /// shear is dry friction but for a fifth, of which an exponent takes nine tenths. Chosen.
    MOST_OF_THE_REST = 0.75, "1", chosen;
    /// As [`LEAST_PART_OF_ALL`] for a term whose shape is free, as the pitch of a ripple or the exponent of sub-linear friction: it follows any mismatch
    /// of such a kind. Chosen, on the wrist of an arm whose other axes leave a wavy load of 0.16, on a ball screw whose published law
    /// leaves 0.15 that an exponent takes, and on motors whose cogging is all that is missing. A ripple that is a line of the force over the way needs none.
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
    /// Part of the effort above which a mismatch that nothing explains is called unknown. Chosen: of 38 drives with nothing missing, ours and those of
    /// three other authors, two leave more than [`OVER_NOISE`] times the noise, by a coarse encoder and by rows that jitter, and of the effort 0.0065 and 0.0049; a
    /// magnet that fades and a grease that thins as they warm leave 0.018 and 0.010.
    UNKNOWN_PART_OF_EFFORT = 0.008, "1", chosen;
    /// Part of a mismatch that a free curve over position leaves of what named physics leaves, below which the names are not believed
    /// alone.
    CURVE_PART = 0.5, "1", chosen;
    /// Part of the usual speed below which a motion's direction fades, where halves are judged by what they tell.
    SLOW_PART = 0.1, "1", chosen;
    /// Share of the held-out power that a named term has to take, beside the others: half of what the search asks on its own rows.
    LEAST_HELD_OUT_SHARE = 0.12, "1", chosen;
    /// Times the sensors' own noise from which a missing force is one.
    OVER_NOISE = 1.5, "1", chosen;
    /// Half of the width over which a spectrum of effort and force is averaged, over its frequency: it is smooth on a logarithmic axis. Chosen.
    SPECTRUM_WIDTH = 0.05, "1", chosen;
    /// Fewest frequencies to each side over which it is averaged (P. J. Daniell, *J. R. Stat. Soc. Suppl.* 8, 1946, 88): 33, half a period in the recording
    /// apart, of which one in two is free, tell a density to a quarter. Chosen.
    LEAST_SPECTRUM_WIDTH = 16.0, "count", chosen;
    /// Slowest tone, periods of the longest trial: what comes and goes less often is the course of a trial. Chosen.
    FEWEST_PERIODS = 5.0, "periods", chosen;
    /// Length of a window in which a drive stands still, in periods of the highest frequency at which a missing force is seen: its trend is taken
    /// off, and with it what is slower than about a tenth of that frequency. Chosen.
    STILL_PERIODS = 10.0, "periods", chosen;
    /// How far a drive that stands still is seen to move, in steps of its encoder: a controller's answer to its rounding. Chosen.
    STILL_STEPS = 4.0, "steps", chosen;
    /// The same as a part of its travel.
    STILL_PART = 1e-3, "1", chosen;
    /// Fewest still windows from which their noise is known: a median of eight lies within an eighth of the deviation in two of three cases, as
    /// each window holds some ten independent values. Chosen.
    FEWEST_STILL_WINDOWS = 8.0, "count", chosen;
    /// Factor by which refitted values have to lessen what is missing before they are told as wrong.
    VALUES_MATTER = 1.15, "1", chosen;
    /// Least part of the recorded effort that acts under an effort that changes with time. Chosen: half, as of a motor that loses half of its torque;
    /// an arm that turned at one speed against its weight was explained by less.
    LEAST_ACTING_EFFORT = 0.5, "1", chosen;
    /// Factor between the rig file's inertia and one that is still believed to be this drive's. Chosen: without a bound a law that lacks
    /// a weight explains a pendulum by an inertia that hardly moves.
    INERTIA_FACTOR = 5.0, "1", chosen;
    /// Standard deviation of the factor by which the load of a rigid-body model is wrong; beyond three of them it is another load, which is
    /// physics. Chosen: on the arms whose load was at hand (masses from drawings, a payload that is known to a third) the closest
    /// factors were 0.92 to 0.96. Where the load moves with the acceleration, as that of an arm does, a wider range lets factor and inertia
    /// stand for each other.
    LOAD_DEVIATION = 0.05, "1", chosen;
    /// Latest effort that is a late recording and no lag, in encoder rows: a fieldbus takes some cycles.
    LATEST_ROWS = 20.0, "rows", chosen;
    /// The same at least, s.
    LATEST_S = 0.02, "s", chosen;
    /// Limit of an effort that nears it, over the greatest effort that was commanded, from which it is none: at a third of the limit the drive
    /// gives 3 tanh(1/3) = 0.96 of what is commanded, as far as a motor's constant is known. Chosen.
    GENTLEST_LIMIT = 3.0, "1", chosen;
    /// Share of the time for which an effort may be limited: beyond it that is what usually happens, and the limit takes the friction's
    /// place. Chosen: of drives whose amplifier clips unseen, ours and those of three other authors, the busiest clips a fifth of the time; two
    /// real ones of which such a limit took the place of weight and friction would have clipped 0.44 and 0.81 of it.
    MOST_LIMITED_TIME = 0.25, "1", chosen;
    /// Least limit of an effort that nears it, over the effort that is passed for [`MOST_LIMITED_TIME`]: at half of its limit a drive gives tanh(1/2) 2 = 0.92
    /// of what is commanded. Chosen: a lower one takes the peaks off an effort's noise, which does not drive, and was told of real motors.
    STRONGEST_SMOOTH_LIMIT = 2.0, "1", chosen;
    /// Largest averaging of a recorded effort, rows^2: that of a mean over three rows, 9 / 24, and 1 / 8 for the middle between two rows.
    MOST_AVERAGING = 0.5, "rows^2", derived;
    /// Least exponent of the speed of a friction that is told from dry friction.
    LEAST_EXPONENT = 0.15, "1", chosen;
    /// Greatest exponent of it that is told from viscous friction.
    MOST_EXPONENT = 0.9, "1", chosen;
    /// Longest way over which dry friction can build up, over the travel: what bends a fiftieth of the travel before it slides is a spring.
    LONGEST_PRESLIDING = 0.02, "1", chosen;
    /// Least share of the inertia that a load beyond a link can have.
    LEAST_LOAD_SHARE = 0.2, "1", chosen;
    /// Deviation about a half to which that share is known beforehand where the load alone is seen: nine of ten lie between a sixth and five
    /// sixths. Its stiffness goes with the product of both shares, which is within a tenth of a quarter from 0.35 to 0.65.
    LOAD_SHARE_DEVIATION = 0.2, "1", chosen;
    /// Greatest share of it.
    MOST_LOAD_SHARE = 0.97, "1", chosen;
    /// A link's own swing, under all of the inertia, that a recording can show: from this many a trial, rad.
    SLOWEST_SWING = 30.0, "rad", chosen;
    /// Band in which a missing force is looked for even where the nominal law leaves nothing, Hz.
    LOWEST_BAND_HZ = 5.0, "Hz", chosen;
    /// Deviations from which a block is pushed from outside: the regressors are a rough model, and normal errors reach six once in 10^9.
    FAR_FROM_REGRESSION = 6.0, "deviations", derived;
    /// Share of the squares left by the robust fit that outside stretches have to hold: less is a tail and no event.
    LEAST_OUTSIDE_SHARE = 0.5, "1", chosen;
    /// Share of the time that they may last: beyond it they are what usually happens.
    MOST_OUTSIDE_TIME = 0.4, "1", chosen;
    /// Factor between steps of an encoder that is taken for coarser than it is: the root of ten.
    COARSER = 3.162, "1", chosen;
    /// Coarsest step that is tried, over the travel or a turn: a hundredth leaves a motion to see. Chosen.
    MOST_COARSE = 0.01, "1", chosen;
}

/// Fewest rows of a block.
pub const BLOCK_ROWS: usize = 20;
