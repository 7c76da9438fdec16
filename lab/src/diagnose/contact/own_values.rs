//! Values that each trial may have for itself: which to try, and how values move into another layout.

use super::fit::Fit;
use super::model::{ContactModel, OwnValues, index};

/// What each trial may have for itself beside what it has.
#[must_use]
pub fn own_values(model: &ContactModel) -> Vec<OwnValues> {
    if model.trials < 2 {
        return Vec::new();
    }
    let own = model.own;
    let more = [
        OwnValues { surface: true, ..own },
        OwnValues { zero: true, ..own },
        OwnValues { scale: true, ..own },
        OwnValues { surface: true, zero: true, ..own },
        OwnValues { surface: true, scale: true, ..own },
    ];
    more.into_iter().filter(|more| *more != own).collect()
}

/// The same with one of them less.
#[must_use]
pub fn fewer_own_values(model: &ContactModel) -> Vec<OwnValues> {
    let own = model.own;
    let fewer =
        [OwnValues { surface: false, ..own }, OwnValues { zero: false, ..own }, OwnValues { scale: false, ..own }];
    fewer.into_iter().filter(|fewer| *fewer != own).collect()
}

/// Values of `fit` in the layout of `model`, which differs in what each trial has for itself.
#[must_use]
pub fn moved_values(fit: &Fit, model: &ContactModel) -> Vec<f64> {
    let others = model.trials - 1;
    let column = |nth: Option<usize>| -> Vec<f64> {
        nth.map_or(vec![0.0; others], |nth| {
            let start = index::SHARED + nth * others;
            fit.values[start..start + others].to_vec()
        })
    };
    let (own, old) = (model.own, fit.model.own);
    let mut values = fit.values[..index::SHARED + others].to_vec();
    if own.zero {
        values.extend(column(old.zero.then_some(1)));
    }
    if own.scale {
        values.extend(column(old.scale.then_some(1 + usize::from(old.zero))));
    }
    values.extend(&fit.values[fit.model.nominal_count()..]);
    values
}
