//! Dry friction that differs by direction, and dry friction beside a constant load: the same force, moving and at rest.

use super::fit::Fit;
use super::term::Term;

/// `fit` with one dry friction of two levels in the place of its dry friction of one and its constant load, each from term `first` on: as one effect says the
/// same, two are not named. `None` where it has not both, or where the load is more than friction could differ by: no level is negative.
#[must_use]
pub fn as_asymmetric(fit: &Fit, first: usize) -> Option<Fit> {
    let position = |of: Term| fit.model.terms.iter().skip(first).position(|term| *term == of).map(|at| at + first);
    let (rub, load) = (position(Term::Coulomb)?, position(Term::ConstantLoad)?);
    let value = |at: usize| fit.values[fit.model.values_of(at).start];
    let (level, constant) = (value(rub), value(load));
    if constant.abs() >= level {
        return None;
    }
    let mut one = fit.clone();
    one.values.splice(fit.model.values_of(rub), [level + constant, level - constant]);
    one.model.terms[rub] = Term::AsymmetricCoulomb;
    (one.model, one.values) = one.model.without(load, &one.values);
    Some(one)
}

#[cfg(test)]
mod tests {
    use super::super::testing::fit_of;
    use super::*;

    #[test]
    fn one_friction_of_two_levels_is_the_same_law() {
        for (terms, own) in [
            (&[Term::Coulomb, Term::EffortLag, Term::ConstantLoad], [0.5, 0.01, -0.2]),
            (&[Term::ConstantLoad, Term::EffortLag, Term::Coulomb], [-0.2, 0.01, 0.5]),
        ] {
            let two = fit_of(terms, &own);
            let one = as_asymmetric(&two, 0).expect("less load than friction");
            assert_eq!(one.model.names(), ["coulomb_friction", "effort_lag"]);
            let (one, two) = (one.model.law(&one.values), two.model.law(&two.values));
            assert!((one.friction.coulomb - two.friction.coulomb).abs() < 1e-15);
            assert!((one.load(0.3) - two.load(0.3)).abs() < 1e-15);
            assert_eq!(one.effort_lag_s, two.effort_lag_s);
        }
    }

    /// No friction pushes along the motion; and what the rig file holds stays as it is.
    #[test]
    fn a_load_beyond_the_friction_or_of_the_rig_file_is_a_load() {
        let terms = [Term::Coulomb, Term::ConstantLoad];
        assert!(as_asymmetric(&fit_of(&terms, &[0.2, -0.2]), 0).is_none());
        assert!(as_asymmetric(&fit_of(&terms, &[0.2, 0.1]), 1).is_none());
        assert!(as_asymmetric(&fit_of(&terms[..1], &[0.2]), 0).is_none());
    }
}
