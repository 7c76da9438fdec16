//! Names in whose place a force of no law does far better.
//!
//! A name says on what a force depends. A force that is missing for another reason can look like it: a spring that returns a slide makes its effort
//! look limited, a damper that brakes one way makes a weight of its mean. Where a free curve along another quantity ([`super::shapes`]), in the place
//! of the name, leaves far less than the name does, it is not told: the data say that the force depends on something else. This is the comparison of a
//! parametric law with a nonparametric one (W. Haerdle, E. Mammen, *Ann. Stat.* 21, 1993, 1926), by likelihood with a price for each value.

use super::candidates::is_likelier;
use super::course::Varying;
use super::criteria::LEAST_ACTING_EFFORT;
use super::fit::{self, Effort, Fit};
use super::likelihood::Data;
use super::sample::sample;
use super::selection::Search;
use super::shapes::{courses, load_by_place, shaped};
use super::term::Term;
use super::trial::DriveTrial;

impl Search<'_> {
    /// `fit` without a name in whose place a tone in time or a shape does far better, and that is not worth having beside it; `None` where all stand. Shapes
    /// of a rigid drive alone: what a link moves can look like any.
    #[must_use]
    pub fn without_rivalled(&self, fit: &Fit) -> Option<Fit> {
        if fit.model == self.nominal.model {
            return None;
        }
        let own = self.nominal.model.terms.len();
        let told = || (own..fit.model.terms.len()).filter(|at| fit.model.terms[*at].is_told());
        let at =
            told().find(|at| self.is_rivalled_by_a_tone(fit, *at)).or_else(|| self.rivalled_by_a_shape(fit, told()))?;
        let (model, values) = fit.model.without(at, &fit.values);
        Some(self.lessened(fit, model, values))
    }

    /// The first of the terms `told` of `fit`, of a rigid drive, in whose place a shape does far better.
    fn rivalled_by_a_shape(&self, fit: &Fit, mut told: impl Iterator<Item = usize>) -> Option<usize> {
        if fit.model.has_link() {
            return None;
        }
        let sampled = sample(&self.data, &self.disturbance(fit));
        let data = Data { trials: sampled.as_deref().unwrap_or(self.data.trials), ..self.data };
        let base = quickly_fitted(&data, fit);
        let is_rivalled = |at: &usize| {
            let mut promising = self.with_shapes(&data, fit, *at).filter(|rival| self.does_far_better(rival, &base));
            promising.any(|rival| self.is_rival(&rival, fit, *at))
        };
        told.find(is_rivalled)
    }

    /// `fit` with each shape of another kind in the place of term `at`, fitted quickly to `data`.
    fn with_shapes(&self, data: &Data<'_>, fit: &Fit, at: usize) -> impl Iterator<Item = Fit> {
        let (model, values) = fit.model.without(at, &fit.values);
        let less = quickly_fitted(data, &Fit { model, values, ..fit.clone() });
        let shapes = courses(&self.scales, &less.model).chain([load_by_place(&self.scales)]);
        let others = shapes.filter(move |shape| !is_of_one_kind(shape, &fit.model.terms[at]));
        others.map(move |shape| quickly_fitted(data, &shaped(&less, shape)))
    }

    /// Whether `rival`, fitted in full, does far better than `fit`, and term `at` of this is not worth having beside it.
    fn is_rival(&self, rival: &Fit, fit: &Fit, at: usize) -> bool {
        let rival = self.polished(rival);
        if !self.does_far_better(&rival, fit) {
            return false;
        }
        let mut both = rival.clone();
        both.model.terms.push(fit.model.terms[at].clone());
        both.values.extend_from_slice(&fit.values[fit.model.values_of(at)]);
        !self.is_worth(&self.polished(&both), &rival)
    }

    fn does_far_better(&self, rival: &Fit, fit: &Fit) -> bool {
        let drives = self.acting_part_of_effort(rival) >= LEAST_ACTING_EFFORT.value();
        drives && is_likelier(rival, fit) && self.leaves_far_more(fit, rival)
    }

    /// Root mean square of the effort that acts under a `course` over that of the effort that was recorded. Where next to none acts, nothing is
    /// left of motion at one speed, whatever the effort was.
    fn acting_part_of_effort(&self, fit: &Fit) -> f64 {
        let course = fit.model.law(&fit.values).course;
        let power = |factor: &dyn Fn(f64) -> f64| {
            let of = |trial: &DriveTrial| {
                let rows = trial.effort.iter().zip(&trial.source_time);
                rows.map(|(effort, time)| (factor(time - trial.time[0]) * effort).powi(2)).sum::<f64>()
            };
            self.data.trials.iter().map(of).sum::<f64>()
        };
        let acting = power(&|time| course.factor(Varying::Effort, time, [0.0; 2]));
        (acting / power(&|_| 1.0).max(f64::MIN_POSITIVE)).sqrt()
    }
}

/// `start`, fitted to `data` as far as a comparison needs.
fn quickly_fitted(data: &Data<'_>, start: &Fit) -> Fit {
    fit::fit(data, &start.model, &start.values, start.noise, Effort::QUICK)
}

/// Whether `term` is of what `shape` is the free form of: beside it, it says more and no other.
fn is_of_one_kind(shape: &Term, term: &Term) -> bool {
    match shape {
        Term::Curve { .. } => {
            matches!(term, Term::ConstantLoad | Term::AngleLoad | Term::Cogging | Term::Ripples(_))
        }
        _ => term.is_friction(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SCALES, TestDrive, search_over};
    use super::*;

    /// A damper of 4 N s/m forward and 8 N s/m backward: a load takes the mean of what is missing, and the rest shows that it is none.
    #[test]
    fn a_name_goes_that_a_force_of_another_quantity_does_far_better_than() {
        let stands = |drive: &TestDrive, terms: &[Term], own: &[f64]| {
            let trials = [drive.trial(6.0, 6)];
            let search = search_over(&trials, drive);
            let mut start = search.nominal.clone();
            terms.iter().for_each(|term| start.model.terms.push(term.clone()));
            start.values.extend_from_slice(own);
            let fit = search.polished(&start);
            assert!(search.is_worth(&fit, &search.nominal), "{terms:?}");
            search.without_rivalled(&fit).map_or(fit.model.terms, |less| less.model.terms)
        };
        let damper = TestDrive { one_way: 1.0, ..TestDrive::PLAIN };
        assert_eq!(stands(&damper, &[Term::ConstantLoad], &[-0.1]), []);
        let rubs = TestDrive { coulomb: 0.4, ..damper };
        assert_eq!(stands(&rubs, &[Term::Coulomb, Term::ConstantLoad], &[0.4, -0.1]), [Term::Coulomb]);
        // What is there stands, alone and beside what has no name.
        for one_way in [0.0, 1.0] {
            let weight = TestDrive { load: 0.5, one_way, ..TestDrive::PLAIN };
            assert_eq!(stands(&weight, &[Term::ConstantLoad], &[0.4]), [Term::ConstantLoad]);
        }
    }

    /// An effort that fades to nothing leaves nothing of motion that accelerates little, and is no answer to what it was.
    #[test]
    fn an_effort_that_hardly_acts_is_no_rival() {
        let drive = TestDrive { load: 0.5, ..TestDrive::PLAIN };
        let trials = [drive.trial(4.0, 6)];
        let search = search_over(&trials, &drive);
        let by_time = courses(&SCALES, &search.nominal.model)
            .find(|shape| matches!(shape, Term::Course { of: Varying::Effort, .. }))
            .expect("effort by time");
        let fading = |by: f64| {
            let mut fit = shaped(&search.nominal, by_time.clone());
            fit.values[search.nominal.values.len()..].fill(-by);
            fit
        };
        for by in [0.0, 0.4, 0.6, 1.0] {
            assert!((search.acting_part_of_effort(&fading(by)) - (1.0 - by)).abs() < 1e-12, "{by}");
        }
        // However much likelier, and however little it leaves.
        let quiet = |by: f64| {
            let mut fit = Fit { log_likelihood: search.nominal.log_likelihood + 1e6, ..fading(by) };
            fit.noise.ln_disturbance -= 10.0;
            fit
        };
        assert!(search.does_far_better(&quiet(0.4), &search.nominal));
        assert!(!search.does_far_better(&quiet(0.6), &search.nominal));
    }

    /// Dry friction of 0.4 N beside a spring of 60 N/m that returns the slide: a load by place does far better in its place, and friction is there beside it.
    #[test]
    fn a_name_stands_that_is_worth_having_beside_the_shape() {
        let drive = TestDrive { coulomb: 0.4, spring: 60.0, ..TestDrive::PLAIN };
        let trials = [drive.trial(6.0, 6)];
        let search = search_over(&trials, &drive);
        let mut start = search.nominal.clone();
        start.model.terms.push(Term::Coulomb);
        start.values.push(0.4);
        let rubs = search.polished(&start);
        let mut rivals = search.with_shapes(&search.data, &rubs, 0);
        assert!(rivals.any(|rival| search.does_far_better(&search.polished(&rival), &rubs)));
        assert!(search.without_rivalled(&rubs).is_none());
    }
}
