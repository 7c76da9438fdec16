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
