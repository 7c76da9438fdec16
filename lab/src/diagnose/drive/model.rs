//! A model of the drive: its terms, and all values in one vector.

use super::criteria::MOST_AVERAGING;
use super::law::DriveLaw;
use super::range::Range;
use super::scales::Scales;
use super::term::Term;
use crate::effects::MOST_DAMPING_RATIO;

/// Terms beyond the nominal ones; the values are inertia, viscous friction, delay and averaging of the effort, then those of each term.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// In the order of their values.
    pub terms: Vec<Term>,
    /// Sizes that ranges are stated in.
    pub scales: Scales,
}

/// Where the nominal values stand.
pub mod index {
    /// kg or kg m^2.
    pub const INERTIA: usize = 0;
    /// N s/m or N m s/rad.
    pub const VISCOUS: usize = 1;
    /// s
    pub const DELAY: usize = 2;
    /// rows^2
    pub const AVERAGING: usize = 3;
}

/// How many values are nominal.
pub const NOMINAL: usize = 4;

impl Model {
    /// The ranges of all values.
    #[must_use]
    pub fn ranges(&self) -> Vec<Range> {
        let scales = &self.scales;
        let viscous = (scales.effort / scales.speed).max(scales.viscous);
        // A lag and a late recording of the same length are hardly told apart: beside a lag the effort acts no later than it is recorded, and no
        // earlier than that of a mean about its own row.
        let (earliest, latest) = if self.has("effort_lag") {
            (-0.5 * scales.recorded_period_s, 0.0)
        } else {
            (-scales.period_s, scales.latest_effort_s)
        };
        let mut ranges = vec![
            Range::relative(scales.inertia / scales.inertia_factor, scales.inertia * scales.inertia_factor),
            Range::absolute(0.0, f64::INFINITY, 0.1 * viscous),
            Range::absolute(earliest, latest, 0.3 * scales.period_s),
            Range::absolute(0.0, MOST_AVERAGING.value(), 0.1 * MOST_AVERAGING.value()),
        ];
        self.terms.iter().for_each(|term| ranges.extend(term.ranges(scales)));
        ranges
    }

    /// ln of the prior density of `values`, but for a constant, nats.
    #[must_use]
    pub fn ln_prior(&self, values: &[f64]) -> f64 {
        self.ranges().iter().zip(values).map(|(range, value)| range.ln_prior(*value)).sum()
    }

    /// Where the values of term `at` stand.
    #[must_use]
    pub fn values_of(&self, at: usize) -> std::ops::Range<usize> {
        let count = |term: &Term| term.ranges(&self.scales).len();
        let start = NOMINAL + self.terms[..at].iter().map(count).sum::<usize>();
        start..start + count(&self.terms[at])
    }

    /// The law with `values`.
    #[must_use]
    pub fn law(&self, values: &[f64]) -> DriveLaw {
        let mut law = DriveLaw {
            effort_averaging: values[index::AVERAGING] * self.part_averaged(values),
            ..DriveLaw::nominal(values[index::INERTIA], values[index::VISCOUS], values[index::DELAY])
        };
        let mut rest = &values[NOMINAL..];
        for term in &self.terms {
            let (own, others) = rest.split_at(term.ranges(&self.scales).len());
            term.apply(own, &self.scales, &mut law);
            rest = others;
        }
        law
    }

    /// How much of the averaging among `values` acts: a mean about its own row is early by half a row, and what is recorded where it begins to act
    /// is none. A mean that is free of that takes, beside a lag, the place of a delay. Zero has no sign.
    #[must_use]
    pub fn part_averaged(&self, values: &[f64]) -> f64 {
        (-2.0 * values[index::DELAY] / self.scales.recorded_period_s).clamp(0.0, 1.0) + 0.0
    }

    /// Whether the inertia lies within what is believed of it, or is not fitted: at an end it stands for something else.
    #[must_use]
    pub fn has_believed_inertia(&self, values: &[f64]) -> bool {
        self.scales.holds_inertia() || !self.ranges()[index::INERTIA].is_at_end(values[index::INERTIA])
    }

    /// Whether a telling value of a term ended where its search did.
    #[must_use]
    pub fn is_at_end(&self, values: &[f64]) -> bool {
        (0..self.terms.len()).any(|at| self.terms[at].is_at_end(&values[self.values_of(at)], &self.scales))
            || self.is_dragged(values)
    }

    /// Whether motor and load are held together by a damper and no spring, as a wheel that slips.
    fn is_dragged(&self, values: &[f64]) -> bool {
        let Some(link) = self.law(values).link.filter(|link| link.play == 0.0) else { return false };
        let motor = (1.0 - link.load_share) * values[index::INERTIA];
        link.damping >= 2.0 * MOST_DAMPING_RATIO * (link.stiffness * motor).sqrt()
    }

    /// Where the factor of the given load stands among the values; `None` where no load is given.
    #[must_use]
    pub fn load_scale(&self) -> Option<usize> {
        let at = self.terms.iter().position(|term| *term == Term::LoadScale)?;
        Some(self.values_of(at).start)
    }

    /// The same with one term more.
    #[must_use]
    pub fn with(&self, term: Term) -> Self {
        let mut more = self.clone();
        more.terms.push(term);
        more
    }

    /// The same, with `values`, without term `at`, and without what no term is left for: friction builds up only where there is some.
    #[must_use]
    pub fn without(&self, at: usize, values: &[f64]) -> (Self, Vec<f64>) {
        let (mut less, mut rest) = (self.clone(), values.to_vec());
        rest.drain(self.values_of(at));
        less.terms.remove(at);
        let presliding = less.terms.iter().position(|term| *term == Term::Presliding);
        match presliding.filter(|_| !less.terms.iter().any(Term::is_friction)) {
            Some(at) => less.without(at, &rest),
            None => (less, rest),
        }
    }

    /// How many of its terms are told as physics.
    #[must_use]
    pub fn told_terms(&self) -> usize {
        self.terms.iter().filter(|term| term.is_told()).count()
    }

    /// The names of its terms that are told as physics, sorted, each once: the same for sets of terms that are told alike.
    #[must_use]
    pub fn names(&self) -> Vec<&'static str> {
        let mut names: Vec<&'static str> = self.terms.iter().filter(|term| term.is_told()).map(Term::name).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// Whether it has two bodies.
    #[must_use]
    pub fn has_link(&self) -> bool {
        self.terms.iter().any(Term::is_link)
    }

    /// Whether a term of that name is in it.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.terms.iter().any(|term| term.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::Side;
    use super::super::testing::SCALES;
    use super::*;

    /// Half a row early it is a mean about its row, punctual or late it is none; beside a lag it is no earlier than that.
    #[test]
    fn an_effort_counts_as_averaged_as_far_as_it_is_recorded_early() {
        let model = Model { terms: vec![], scales: SCALES };
        let averaging = |rows: f64| model.law(&[0.8, 4.0, rows * SCALES.recorded_period_s, 0.2]).effort_averaging;
        let found = [-1.0, -0.5, -0.25, 0.0, 3.0].map(averaging);
        assert!(found.iter().zip([0.2, 0.2, 0.1, 0.0, 0.0]).all(|(found, by_hand)| (found - by_hand).abs() < 1e-15));
        let delay = model.with(Term::EffortLag).ranges()[index::DELAY];
        assert_eq!((delay.low, delay.high), (-0.5 * SCALES.recorded_period_s, 0.0));
    }

    /// Of 0.8 kg with halves of 0.4 kg and 5 kN/m the damper of a ratio of 5 is 10 sqrt(5000 x 0.4) = 447.2 N s/m, as the effect has it.
    #[test]
    fn a_link_that_is_damped_more_than_its_effect_says_is_none() {
        let is_link = |damping: f64, term: Term| {
            let model = Model { terms: vec![term], scales: SCALES };
            let own = if model.has("backlash") {
                vec![5000.0, damping, 0.5, 1e-4, 0.5]
            } else {
                vec![5000.0, damping, 0.5, 0.5]
            };
            !model.is_at_end(&[vec![0.8, 4.0, 0.0, 0.0], own].concat())
        };
        assert!(is_link(447.0, Term::Compliance(Side::Motor)) && !is_link(447.5, Term::Compliance(Side::Motor)));
        // Within a play the damper of its flanks is no value of the effect.
        assert!(is_link(447.5, Term::Play(Side::Motor)));
    }
}
