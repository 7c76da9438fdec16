//! The response of a first-order lag to what is straight between two samples.

/// Steps a time constant below which the response is summed as a series: the closed form loses a digit for each power of it.
const SERIES_RATIO: f64 = 0.5;

/// What a first-order lag of `state` has come to at the end of a step over which it is driven along a straight line between the two
/// values of `input`; `ratio` is the step over its time constant, above zero. Exact.
#[must_use]
pub fn lagged(state: f64, input: [f64; 2], ratio: f64) -> f64 {
    // The integrals over the step of r exp(-r (1 - s)) and of the same times s, s running from zero to one.
    let (level, slope) = if ratio < SERIES_RATIO {
        (series(0.0, ratio), series(1.0, ratio))
    } else {
        let level = -(-ratio).exp_m1();
        (level, 1.0 - 1.0 / ratio * level)
    };
    state * (-ratio).exp() + input[0] * level + (input[1] - input[0]) * slope
}

/// `r sum_k (-r)^k n! / (n + k + 1)!`
fn series(power: f64, ratio: f64) -> f64 {
    let mut term = ratio / (power + 1.0);
    let mut sum = term;
    for k in 1..14 {
        term *= -ratio / (power + 1.0 + f64::from(k));
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lag by many small steps of a constant input.
    fn crept([first, last]: [f64; 2], mut state: f64, ratio: f64) -> f64 {
        let steps = 20_000;
        let span = ratio / f64::from(steps);
        for step in 0..steps {
            let middle = first + (last - first) * (f64::from(step) + 0.5) / f64::from(steps);
            state += (middle - state) * -(-span).exp_m1();
        }
        state
    }

    #[test]
    fn a_lag_along_a_line_is_what_small_steps_come_to() {
        let input = [0.3, -0.2];
        for ratio in [1e-6, 0.03, 0.49, 0.51, 3.0, 40.0] {
            let (exact, crept) = (lagged(1.7, input, ratio), crept(input, 1.7, ratio));
            // The steps leave the square of one of them, of a line of size one.
            assert!((exact - crept).abs() < 1e-6, "{ratio}: {exact} for {crept}");
        }
    }
}
