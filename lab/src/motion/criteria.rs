//! When a velocity counts as one that jumped. Each number with its meaning and origin.

use crate::threshold::thresholds;

thresholds! { "motion";
    /// Probability that a motion whose velocity does not jump is taken for one that does, for all rows of a trial. Chosen: with 0.1 or 0.001 the least jump
    /// that is seen is a tenth smaller or larger.
    FALSE_JUMP = 0.01, "1", chosen;
    /// Rows that the smoother of the motion remembers at the least where its velocity may jump. With fewer the rows themselves tell the velocity, and a change
    /// within one of them is not told from one over two, as of a drive that starts quickly.
    LEAST_JUMP_MEMORY = 2.0, "rows", derived;
}
