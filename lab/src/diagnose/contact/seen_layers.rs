//! Layers, a loop and a play as the force is seen to go, from which a search of all together begins.
//!
//! A switch has a preload, a soft way, a pocket and a stop, and rubs: one such feature after the other takes little beside the rest, and a law
//! without a preload puts its surface far outside of a contact with one.

use rayon::prelude::*;

use super::broken_line::DepthProfile;
use super::criteria::MUCH_MISSING;
use super::fall::Fall;
use super::fit::{Effort, Fit};
use super::model::index;
use super::rest::Rest;
use super::search::Search;
use crate::diagnose::term::Term;
use crate::effects::{self, HYSTERESIS_BETWEEN, HYSTERESIS_SLIP, LAYERS_OF_FORMS};

/// The effects that are put together.
const LAYERS: &str = "layered_stiffness";
const LOOP: &str = "hysteresis";

/// Travel of the slip that a loop starts from, the transition at the ends of one on a stretch of the way, and a play, each of the depth.
const SLIP_PART: f64 = 0.02;
const TRANSITION_PART: f64 = 0.02;
const PLAY_PART: f64 = 0.01;

/// Laws that are fitted on every row.
const POLISHED: usize = 6;

impl Search<'_> {
    /// Layers along the broken line that follows the force best over depth, alone, with a loop and with a play; none where little is missing
    /// or the tool is clamped. More layers than three are layers only where the force falls and rises again: what rises all the way is followed
    /// by as many layers whatever it is.
    pub(super) fn seen_layers(&self) -> Vec<Fit> {
        let nominal = &self.nominal;
        if nominal.model.bilateral || nominal.energy < MUCH_MISSING * self.data.expected() {
            return Vec::new();
        }
        let forces: Vec<Vec<f64>> = self.coarse.trials.iter().map(|trial| trial.force.clone()).collect();
        let profile = DepthProfile::of(self.coarse.trials, &forces, nominal.model.scales.positions);
        let starts: Vec<Fit> = LAYERS_OF_FORMS
            .iter()
            .filter_map(|&(layers, form)| self.layers_along(&profile, layers, form))
            .flat_map(|plain| with_loops(&plain, &profile))
            .flat_map(|fit| [with_play(&fit), Some(fit)].into_iter().flatten())
            .collect();
        let fits = starts.into_par_iter().map(|start| self.coarse.fit(&start.model, &start.values, Effort::FULL));
        let three = LAYERS_OF_FORMS[0].1;
        let is_three = |fit: &Fit| fit.model.terms.iter().any(|term| term.name() == LAYERS && term.form == three);
        let mut fits: Vec<Fit> = fits.collect();
        fits.retain(|fit| {
            self.is_admissible(fit) && (is_three(fit) || fit.model.fall(&fit.values) == Some(Fall::Pocket))
        });
        let Some(least) = fits.iter().min_by(|a, b| a.energy.total_cmp(&b.energy)) else { return Vec::new() };
        let rest = Rest::of(&self.coarse, least);
        fits.sort_by(|a, b| self.price(a, &rest).total_cmp(&self.price(b, &rest)));
        fits.truncate(POLISHED);
        fits.par_iter().map(|fit| self.data.fit(&fit.model, &fit.values, Effort::FULL)).collect()
    }

    /// `layers` layers by form `form`, from the first corner inwards; `None` where the rig file has layers, or the force falls there.
    fn layers_along(&self, profile: &DepthProfile, layers: usize, form: usize) -> Option<Fit> {
        let nominal = &self.nominal;
        let term = absent(nominal, LAYERS, form)?;
        let slopes_along = |corners: &[f64]| -> Vec<f64> {
            corners.windows(2).map(|ends| profile.slope([ends[0], ends[1]])).collect()
        };
        // The free way, and each layer; or each layer, where the tool is in contact from the first row on.
        let mut corners = profile.corners(layers + 2);
        let mut slopes = slopes_along(&corners);
        if slopes[0] > slopes[1] {
            corners = profile.corners(layers + 1);
            corners.insert(0, corners[0]);
            slopes = slopes_along(&corners);
        }
        let mut values = nominal.values.clone();
        values[index::SURFACE] = corners[1];
        values[index::STIFFNESS] = slopes[1];
        values[index::DAMPING] = 0.0;
        let further = corners[2..].iter().zip(slopes[1..].windows(2));
        values.extend(further.flat_map(|(corner, slopes)| [slopes[1] - slopes[0], corner - corners[1]]));
        (slopes[1] > 0.0).then(|| Fit { model: nominal.model.with(term), values, energy: f64::INFINITY })
    }
}

/// `fit` as it is, with a loop as wide as the ways in and out lie apart, and with one where they do most.
fn with_loops(fit: &Fit, profile: &DepthProfile) -> Vec<Fit> {
    let surface = fit.values[index::SURFACE];
    let depth = fit.model.scales.positions[1] - surface;
    let apart = |ends: [f64; 2]| 0.5 * profile.way_apart(ends).max(0.0);
    let slip = [apart([surface, surface + depth]), SLIP_PART * depth];
    let mut fits = vec![fit.clone()];
    fits.extend(absent(fit, LOOP, HYSTERESIS_SLIP).map(|term| with(fit, term, &slip)));
    if let Some(stretch) = profile.widest([surface, surface + depth]) {
        let [begin, end] = stretch.map(|place| place - surface);
        let values = [apart(stretch), slip[1], end, TRANSITION_PART * depth, begin];
        fits.extend(absent(fit, LOOP, HYSTERESIS_BETWEEN).map(|term| with(fit, term, &values)));
    }
    fits
}

/// `fit` with a play; `None` where it has one.
fn with_play(fit: &Fit) -> Option<Fit> {
    let depth = fit.model.scales.positions[1] - fit.values[index::SURFACE];
    absent(fit, "lost_motion", 0).map(|term| with(fit, term, &[PLAY_PART * depth]))
}

/// Form `form` of the effect `name`, unless `fit` has it.
fn absent(fit: &Fit, name: &str, form: usize) -> Option<Term> {
    effects::find(name).filter(|_| fit.model.times(name) == 0).map(|effect| Term { effect, form })
}

/// `fit` with `term` and its `values`.
fn with(fit: &Fit, term: Term, values: &[f64]) -> Fit {
    let values = fit.values.iter().chain(values).copied().collect();
    Fit { model: fit.model.with(term), values, energy: f64::INFINITY }
}
