//! How the values of a contact's law may move: bounds, sizes, and what is expected of them beforehand.

use super::criteria::{
    LEAST_CYCLES, LEAST_PART_PASSED, LEAST_REACHED_FORCE, LEAST_TIME_ROWS, SCALE_PRIOR, SURFACE_PRIOR, ZERO_PRIOR,
};
use super::model::{ContactModel, index};
use crate::effects::{Limit, Parameter};

/// How one value may move.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// A change that matters; of a value that moves by factors, none.
    pub size: f64,
    /// Whether it moves by factors: a size above zero that may be of any order.
    pub by_factors: bool,
    /// Whether it moves at all.
    pub free: bool,
    /// Value and deviation that are expected before anything was seen.
    pub prior: Option<(f64, f64)>,
}

impl Range {
    const fn linear(low: f64, high: f64, size: f64) -> Self {
        Self { low, high, size, by_factors: false, free: true, prior: None }
    }

    /// `value` moved by `steps` of its size.
    #[must_use]
    pub fn moved(&self, value: f64, steps: f64) -> f64 {
        if self.by_factors { value * steps.exp() } else { value + steps * self.size }
    }
}

impl ContactModel {
    /// Values that are fitted and no trial's own place within an encoder's step.
    #[must_use]
    pub fn free_count(&self) -> usize {
        self.ranges(&vec![1.0; self.count()]).iter().filter(|range| range.free).count()
    }

    /// How each value may move.
    #[must_use]
    pub fn ranges(&self, values: &[f64]) -> Vec<Range> {
        let scales = &self.scales;
        let stiff = scales.stiffness();
        let late = 0.5 * scales.source_step_s;
        let place = 0.05 * scales.depth;
        let mut ranges = vec![
            Range::linear(0.0, 1e3 * stiff, values[index::STIFFNESS].abs().max(1e-3 * stiff)),
            Range::linear(0.0, f64::INFINITY, values[index::DAMPING].abs().max(0.02 * scales.force / scales.speed)),
            Range::linear(f64::NEG_INFINITY, f64::INFINITY, place),
            Range::linear(-late, late, late),
        ];
        let others = self.trials - 1;
        let within_step = 0.5 * scales.resolution;
        for _ in 0..others {
            ranges.push(if self.own.surface {
                let prior = Some((0.0, (SURFACE_PRIOR * scales.depth).value()));
                Range { prior, ..Range::linear(f64::NEG_INFINITY, f64::INFINITY, place) }
            } else {
                let prior = Some((0.0, within_step.max(f64::MIN_POSITIVE)));
                Range { free: within_step > 0.0, prior, ..Range::linear(-within_step, within_step, within_step) }
            });
        }
        let mut each = |is_there: bool, deviation: f64| {
            let range = Range {
                prior: Some((0.0, deviation)),
                ..Range::linear(f64::NEG_INFINITY, f64::INFINITY, 0.1 * deviation)
            };
            ranges.extend(std::iter::repeat_n(range, if is_there { others } else { 0 }));
        };
        each(self.own.zero, (ZERO_PRIOR * scales.force).value());
        each(self.own.scale, SCALE_PRIOR.value());
        for (at, term) in self.terms.iter().enumerate() {
            let start = self.first_value_of(at);
            for (offset, parameter) in term.all_parameters(self.trials).iter().enumerate() {
                ranges.push(self.term_range(parameter, values[start + offset]));
            }
        }
        ranges
    }

    fn term_range(&self, parameter: &Parameter, value: f64) -> Range {
        let scales = &self.scales;
        let (mut low, mut high) = (parameter.low, parameter.high);
        match parameter.limit {
            Limit::ResolvableTime => {
                low = (LEAST_TIME_ROWS * scales.step_s).max(low).value();
                high = high.min(scales.duration_s / LEAST_PART_PASSED);
            }
            Limit::ReachedRange => {
                low = (LEAST_REACHED_FORCE * scales.force)
                    .max(low)
                    .max(scales.reached_force - self.force_zero.abs())
                    .value();
            }
            Limit::RepeatedCycles => low = (LEAST_CYCLES / scales.duration_s).max(low).value(),
            Limit::ResolvableLength => low = low.max(scales.resolution),
            Limit::VisitedDepth => high = high.min(self.longest_way()),
            Limit::InstantOfJump => high = high.min(scales.duration_s),
            Limit::HeightOfJump => high = high.min(scales.positions[1] - scales.positions[0]),
            Limit::BoundsOnly => {}
        }
        let by_factors = parameter.low >= 0.0 && parameter.high.is_infinite() && value > 0.0;
        let size = if value == 0.0 { 1e-3 } else { value.abs() };
        let prior = None;
        Range { low, high, size, by_factors, free: !parameter.fixed, prior }
    }

    /// Longest way between two reversals that the recordings can hold, m or rad: a clamped tool goes to and fro on both sides of the
    /// surface, another one from there inwards.
    fn longest_way(&self) -> f64 {
        if self.bilateral { self.scales.travel() } else { self.scales.depth }
    }

    /// Whether a value of an effect ended at an end of what the recordings can show.
    #[must_use]
    pub fn is_at_end(&self, values: &[f64]) -> bool {
        let ranges = self.ranges(values);
        self.terms.iter().enumerate().any(|(nth, term)| {
            let start = self.first_value_of(nth);
            term.all_parameters(self.trials).iter().enumerate().any(|(offset, parameter)| {
                let (range, value) = (&ranges[start + offset], values[start + offset]);
                let near = |end: f64| end.is_finite() && end != 0.0 && (value - end).abs() <= 1e-6 * end.abs();
                // Of what never lets go in a recording the height is known to be beyond all that it shows.
                let is_bound = !matches!(parameter.limit, Limit::BoundsOnly | Limit::HeightOfJump);
                is_bound && (near(range.low) || near(range.high))
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::TestContact;
    use super::*;

    #[test]
    fn a_loop_yields_within_the_depth_that_was_visited() {
        let (model, values) = TestContact::PLAIN.law_with("hysteresis", 3, &[1.0, 1e-3]);
        let yields = model.first_value_of(0) + 1;
        let deepest = model.ranges(&values)[yields].high;
        // Ten millimetres deep at the most.
        assert!((deepest - model.scales.depth).abs() < 1e-12 && (5e-3..11e-3).contains(&deepest), "{deepest}");
        let with = |value: f64| {
            let mut values = values.clone();
            values[yields] = value;
            model.is_at_end(&values)
        };
        assert!(!with(0.5 * deepest) && with(deepest), "a search that ends at the bound is refused");
        // A clamped tool goes to and fro on both sides: its longest way is the whole travel, however far away its preload lies.
        let clamped = ContactModel { bilateral: true, ..model };
        assert_eq!(clamped.ranges(&values)[yields].high, clamped.scales.travel());
    }

    #[test]
    fn a_time_in_which_less_than_a_tenth_passes_is_refused_as_a_constant() {
        // Twelve seconds: with 120 s a branch loses 9.5 % of its force in them.
        let (model, mut values) = TestContact::PLAIN.law_with("stress_relaxation", 0, &[50.0, 0.4]);
        let time = model.first_value_of(0) + 1;
        let longest = model.ranges(&values)[time].high;
        assert!((115.0..121.0).contains(&longest), "{longest}");
        assert!(!model.is_at_end(&values));
        values[time] = longest;
        assert!(model.is_at_end(&values));
    }
}
