//! The improved simulation, as a rig file.

use crate::diagnose::bootstrap::fitted_model::FittedModel;
use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::model::{Model, index};
use crate::diagnose::selection::confidence_interval::IntervalEstimate;
use crate::diagnose::selection::verdict::Assessment;
use crate::effects;
use crate::rig::Rig;

/// The rig file with refitted values and the named effects.
#[must_use]
pub fn refined_rig(
    rig: &Rig,
    problem: &IdentificationProblem,
    fitted_model: &FittedModel,
    assessment: &Assessment,
    estimates: &[IntervalEstimate],
) -> Rig {
    let named = !assessment.named.is_empty();
    let value = |at: usize| if named { estimates[at].value } else { assessment.nominal.values[at] };
    let mut fresh = rig.clone();
    if let Some(contact) = fresh.contact.as_mut().filter(|_| problem.nominal.contact.is_some()) {
        contact.stiffness = value(index::STIFFNESS);
        contact.damping = value(index::DAMPING);
        contact.surface = value(index::SURFACE);
    }
    if let Some(drive) = fresh.drive.as_mut().filter(|_| problem.nominal.drive) {
        drive.inertia = value(index::INERTIA);
        drive.viscous = value(index::VISCOUS);
    }
    if named {
        fresh.effects = terms(rig, &fitted_model.model, estimates);
    }
    fresh
}

fn terms(rig: &Rig, model: &Model, estimates: &[IntervalEstimate]) -> Vec<crate::rig::Effect> {
    let tables = model.terms.iter().enumerate().map(|(at, term)| {
        let start = model.first_value_of(at);
        let own = &estimates[start..start + term.parameters().len()];
        let values: Vec<f64> = own.iter().map(|estimate| estimate.value).collect();
        let ends: Vec<(f64, f64)> = own.iter().map(|estimate| (estimate.ends[0], estimate.ends[1])).collect();
        effects::to_table(term.effect, term.form, rig.coordinate, &values, Some(&ends))
    });
    tables.collect()
}
