//! The likeliest noise of a model whose values are held.

use super::input::Inputs;
use super::likelihood::Data;
use super::model::Model;
use super::noise::Noise;

/// The disturbance's density at its most likely, by golden section on its logarithm, and both variances scaled to the innovations.
/// Returns ln of the likelihood.
pub fn search_noise(data: &Data<'_>, model: &Model, values: &[f64], noise: &mut Noise) -> f64 {
    const GOLDEN: f64 = 0.381_966;
    const FIRST_SPAN: f64 = 3.0;
    const WIDER: f64 = 4.0;
    const CLOSE: f64 = 0.08;
    let base = *noise;
    let law = model.law(values);
    let inputs = Inputs::of_all(data.trials, &law);
    let cost = |ln: f64| {
        let noise = Noise { ln_disturbance: ln, ..base };
        -data.profiled(&data.innovations_under(&inputs, &law, &noise), &noise).0
    };
    let (mut low, mut middle, mut high) =
        (base.ln_disturbance - FIRST_SPAN, base.ln_disturbance, base.ln_disturbance + FIRST_SPAN);
    let (mut at_low, mut at_middle, mut at_high) = (cost(low), cost(middle), cost(high));
    for _ in 0..8 {
        if at_low < at_middle {
            (high, middle, at_middle) = (middle, low, at_low);
            low -= WIDER;
            at_low = cost(low);
        } else if at_high < at_middle {
            (low, middle, at_middle) = (middle, high, at_high);
            high += WIDER;
            at_high = cost(high);
        } else {
            break;
        }
    }
    for _ in 0..16 {
        if high - low < CLOSE {
            break;
        }
        let above = high - middle > middle - low;
        let try_at = middle + GOLDEN * if above { high - middle } else { low - middle };
        let there = cost(try_at);
        match (there < at_middle, above) {
            (true, true) => (low, middle, at_middle) = (middle, try_at, there),
            (true, false) => (high, middle, at_middle) = (middle, try_at, there),
            (false, true) => high = try_at,
            (false, false) => low = try_at,
        }
    }
    *noise = Noise { ln_disturbance: middle, ..base };
    rescale(data, model, values, noise)
}

/// Puts the common scale of the innovations into the noise. Returns ln of the likelihood.
fn rescale(data: &Data<'_>, model: &Model, values: &[f64], noise: &mut Noise) -> f64 {
    let (log_likelihood, ln_scale) = data.log_likelihood(model, values, noise);
    noise.ln_disturbance += ln_scale;
    noise.ln_encoder += ln_scale;
    log_likelihood
}
