//! What speaks for a term of a law.

/// A term that is named, beside the others of its law.
#[derive(Debug, Clone)]
pub struct NamedTerm {
    /// Its place among the terms of the model.
    pub at: usize,
    /// Share of what is missing on held-out rows that it takes, beside the other terms: of the power above the noise, in a drive above
    /// that of the recorded effort.
    pub held_out_share: f64,
    /// Likelihood-ratio test of it, Bonferroni over all terms tried.
    pub p_value: f64,
    /// What the law leaves without it, N or N m in root mean square on held-out rows.
    pub without: f64,
}

/// What a law takes, `left - held`, over what is left beyond the `noise`, all of one unit of power: of no less than `known_to` of that noise, which is
/// not known better.
#[must_use]
pub fn share_beyond_noise(left: f64, held: f64, noise: f64, known_to: f64) -> f64 {
    let taken = left - held;
    if taken > 0.0 { taken / (left - noise).max(taken).max(known_to * noise) } else { 0.0 }
}
