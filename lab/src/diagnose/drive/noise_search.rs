//! The likeliest noise of a model whose values are held.

use super::input::Inputs;
use super::likelihood::Data;
use super::model::Model;
use super::noise::Noise;
use crate::golden_section::LEFT_OUT;

/// Half the distance, in ln of the density, within which its likeliest value is looked for at first, and by how much further where it is not there.
const FIRST_SPAN: f64 = 3.0;
const WIDER: f64 = 4.0;
const MOST_WIDENINGS: usize = 8;

/// Distance of the ends between which the likeliest value is known to lie, and the steps after which it counts as known in any case.
const CLOSE: f64 = 0.08;
const MOST_STEPS: usize = 16;

/// The disturbance's density at its most likely, and both variances scaled to the innovations. Returns ln of the likelihood.
pub fn search_noise(data: &Data<'_>, model: &Model, values: &[f64], noise: &mut Noise) -> f64 {
    let base = *noise;
    let law = model.law(values);
    let inputs = Inputs::of_all(data.trials, &law);
    let of = |ln_disturbance: f64| {
        let noise = Noise { ln_disturbance, ..base };
        let (log_likelihood, ln_scale) = data.profiled(&data.innovations_under(&inputs, &law, &noise), &noise);
        Point { ln_disturbance, log_likelihood, ln_scale }
    };
    let best = Peak::around(base.ln_disturbance, &of).climbed(&of);
    *noise = Noise { ln_disturbance: best.ln_disturbance + best.ln_scale, ln_encoder: base.ln_encoder + best.ln_scale };
    best.log_likelihood + model.ln_prior(values)
}

/// The likelihood at a density.
#[derive(Debug, Clone, Copy)]
struct Point {
    ln_disturbance: f64,
    /// With both variances at their best common scale, nats.
    log_likelihood: f64,
    /// ln of that scale.
    ln_scale: f64,
}

/// Three densities, of which that in the middle is the likeliest.
struct Peak {
    low: Point,
    middle: Point,
    high: Point,
}

impl Peak {
    /// A peak about `start`, of two that of the quieter disturbance: a loud one lets the filter follow every row whatever the law. Where the likelihood
    /// rises for ever, what is reached in so many steps.
    fn around(start: f64, of: &impl Fn(f64) -> Point) -> Self {
        let [low, middle, high] = [start - FIRST_SPAN, start, start + FIRST_SPAN].map(of);
        let mut peak = Self { low, middle, high };
        for _ in 0..MOST_WIDENINGS {
            let Self { low, middle, high } = peak;
            peak = if low.log_likelihood > middle.log_likelihood {
                Self { low: of(low.ln_disturbance - WIDER), middle: low, high: middle }
            } else if high.log_likelihood > middle.log_likelihood {
                Self { low: middle, middle: high, high: of(high.ln_disturbance + WIDER) }
            } else {
                break;
            };
        }
        peak
    }

    /// Its highest point, by the golden section (J. Kiefer, *Proc. Amer. Math. Soc.* 4, 1953, 502).
    fn climbed(mut self, of: &impl Fn(f64) -> Point) -> Point {
        for _ in 0..MOST_STEPS {
            let [low, middle, high] = [self.low, self.middle, self.high].map(|point| point.ln_disturbance);
            if high - low < CLOSE {
                break;
            }
            let is_above = high - middle > middle - low;
            let next = of(middle + LEFT_OUT * if is_above { high - middle } else { low - middle });
            match (next.log_likelihood > self.middle.log_likelihood, is_above) {
                (true, true) => (self.low, self.middle) = (self.middle, next),
                (true, false) => (self.high, self.middle) = (self.middle, next),
                (false, true) => self.high = next,
                (false, false) => self.low = next,
            }
        }
        self.middle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// ln of x exp(-x) with ln x as its variable, greatest at x = 1 wherever the search starts: three evaluations, one for each span that the top is
    /// farther off, and nine or ten sections from 6 or 7 to 0.08.
    #[test]
    fn the_top_is_found_from_near_and_from_far_with_no_evaluation_to_spare() {
        for (start, evaluations) in [(0.3, 12), (-2.0, 14), (-11.0, 16), (9.0, 17)] {
            let calls = Cell::new(0);
            let of = |ln: f64| {
                calls.set(calls.get() + 1);
                Point { ln_disturbance: ln, log_likelihood: ln - ln.exp(), ln_scale: 0.0 }
            };
            let found = Peak::around(start, &of).climbed(&of);
            assert!(found.ln_disturbance.abs() < 0.5 * CLOSE, "{} from {start}", found.ln_disturbance);
            assert_eq!(calls.get(), evaluations, "from {start}");
        }
    }

    /// Two tops, at -3.6 and at 3.2, and the start in the valley between, as of a play: a quiet disturbance lets the law explain the motion and a loud
    /// one the filter follow it.
    #[test]
    fn between_two_tops_the_quieter_is_found() {
        for (quiet, loud) in [(1.0, 3.0), (3.0, 1.0), (1.0, 1.0)] {
            let of = |ln: f64| {
                let hill = |height: f64, top: f64| height * (-0.5 * (ln - top) * (ln - top)).exp();
                Point { ln_disturbance: ln, log_likelihood: hill(quiet, -3.6) + hill(loud, 3.2), ln_scale: 0.0 }
            };
            let found = Peak::around(0.0, &of).climbed(&of);
            assert!((found.ln_disturbance + 3.6).abs() < 0.5 * CLOSE, "{quiet} {loud}: {found:?}");
        }
    }
}
