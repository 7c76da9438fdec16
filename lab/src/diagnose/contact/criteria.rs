//! When a law counts as told by the recordings. Each number with its meaning and origin.

/// Log likelihood that a larger model has to gain, nats: one in e^10 by chance for one comparison, e^5 for all [`COMPARISONS`].
pub const LEAST_GAIN: f64 = 10.0;

/// Comparisons of a larger model with a smaller one that a search makes, rounded up to a number that all recordings share: some fifty
/// forms of effects in three rounds.
pub const COMPARISONS: f64 = 150.0;

/// Share of what the smaller model leaves above the sensors' noise.
pub const LEAST_SHARE: f64 = 0.2;

/// Part, in root mean square, of all that the nominal law leaves above the noise. Chosen: a circuit's cubic spring takes 0.06 beside its
/// mass; at 0.1 and at 0.05 the answers to our own published cases and to two seeds of another author's are the same.
pub const LEAST_PART_OF_ALL: f64 = 0.05;

/// Power over the sensors' own from which a law is one of a real thing that no textbook law reaches; what an effect has to
/// take there is larger: a third of what is left without it, and a quarter of all in root mean square.
pub const FAR_FROM_NOISE: f64 = 2.0;
/// Shares of what is left, and of all in root mean square, that count there.
pub const FAR_SHARES: [f64; 2] = [0.33, 0.25];

/// Part of the force's deviation below which nothing is told as missing, whatever its significance: no contact is known that well.
pub const LEAST_PART_OF_FORCE: f64 = 0.002;

/// Power of a line of the spectrum over that of the sensors' noise from which it is told: a tone of a seventh of the noise's deviation.
/// The rows of a minute tell one of a hundredth, which nobody would call missing physics.
pub const LEAST_LINE_POWER: f64 = 0.01;

/// Vuong's statistic: 95 % of one side. What shows on a few occasions alone, such as a release, cannot reach more than their root; it is
/// not asked of what takes [`LEAST_TOLD_SHARE`] of a mismatch far above the noise, for which nothing else is there.
pub const LEAST_VUONG: f64 = 1.6;

/// Share of the held-out power above the noise that a named effect has to take beside the others: half of what the search asks on its
/// own rows.
pub const LEAST_HELD_OUT_SHARE: f64 = 0.1;

/// Power of what is left over the sensors' from which something is: the sensors' own noise is known to some 15 %.
pub const NOTABLE_POWER: f64 = 1.32;

/// And part of the force's deviation from which it is called unknown.
pub const UNKNOWN_PART_OF_FORCE: f64 = 0.005;

/// Share of the mismatch that named effects have to take to stand for it: they halve what is left, in root mean square.
pub const TOLD_SHARE: f64 = 0.75;

/// Share below which they are not told at all where something notable is left: most of the mismatch is something else.
pub const LEAST_TOLD_SHARE: f64 = 0.5;

/// Part of the mismatch's power that may be left beside named effects.
pub const MOST_LEFT: f64 = 0.25;

/// Factor by which refitted values have to lessen the residual before they are told as wrong.
pub const VALUES_MATTER: f64 = 1.05;
