//! From sensor readings to rows of a contact law with two or three parameters.

use crate::contact::{Observation, Sample};
use crate::error::ConfigError;
use crate::front_end::contact_model::{ContactModel, MAX_PARAMETERS};
use crate::front_end::low_pass::{LowPass, LowPassState};
use crate::front_end::{FrontEnd, FrontEndConfig, FrontEndState, Rejection};
use crate::math::larger;

/// One row, in internal units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RegressionRow {
    /// The columns; zero beyond those of the model.
    pub regressor: [f32; MAX_PARAMETERS],
    /// The force that they explain.
    pub force: f32,
    /// The tool is in the surface.
    pub contact: bool,
    /// The filters began anew: not a row of the regression.
    pub restarted: bool,
}

impl RegressionRow {
    /// The row of a law of two parameters, for any [`crate::UpdateLaw`]: K stands in the place of the stiffness, B of the damping.
    pub fn observation(&self) -> Observation {
        let [penetration, rate, _] = self.regressor;
        Observation { penetration, rate, force: self.force }
    }

    /// The first `P` columns.
    pub fn first<const P: usize>(&self) -> [f32; P] {
        let mut columns = [0.0; P];
        columns.iter_mut().zip(&self.regressor).for_each(|(to, from)| *to = *from);
        columns
    }
}

/// Settings, filters and gate. All columns and the force pass the same filter, whatever [`FrontEndConfig::velocity`] says: the
/// matched form, for three columns.
#[derive(Debug, Clone)]
pub struct ModelStream {
    front_end: FrontEnd,
    model: ContactModel,
    filter: LowPass,
    to_rate: f32,
    state: FrontEndState,
    columns: [LowPassState; MAX_PARAMETERS],
    force: LowPassState,
    previous: Option<PreviousSample>,
    /// The latest unfiltered row, and the rate of the tool itself, where there are any.
    unfiltered: Option<UnfilteredRow>,
    filters_empty: bool,
}

#[derive(Debug, Clone, Copy)]
struct PreviousSample {
    /// Depth below the surface, negative outside, internal units.
    penetration: f32,
    force: f32,
}

#[derive(Debug, Clone, Copy)]
struct UnfilteredRow {
    columns: [f32; MAX_PARAMETERS],
    force: f32,
    rate: f32,
}

impl ModelStream {
    /// Checks the settings. The filter is that of the nominal period.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: FrontEndConfig, model: ContactModel) -> Result<Self, ConfigError> {
        let front_end = FrontEnd::new(config)?;
        Ok(Self {
            front_end,
            model: model.check()?,
            filter: LowPass::new(config.cutoff * config.period),
            to_rate: config.units.penetration / config.units.rate,
            state: FrontEndState::default(),
            columns: Default::default(),
            force: LowPassState::default(),
            previous: None,
            unfiltered: None,
            filters_empty: true,
        })
    }

    /// The model.
    pub fn model(&self) -> ContactModel {
        self.model
    }

    /// Samples in a row that one independent value of the filtered noise is worth.
    pub fn correlated_samples(&self) -> f32 {
        self.front_end.correlated_samples()
    }

    /// Takes one sample. `sample.elapsed` is that of the nominal period up to a tenth; after a longer gap the filters begin anew.
    ///
    /// # Errors
    /// Why it was rejected; then nothing but the clock has moved.
    pub fn update(&mut self, sample: Sample) -> Result<RegressionRow, Rejection> {
        let reading = self.front_end.update(&mut self.state, sample)?;
        let config = self.front_end.config();
        let gap = (sample.elapsed - config.period).abs() > 0.1 * config.period;
        let now = PreviousSample {
            penetration: (sample.position - config.surface) / config.units.penetration,
            force: sample.force / config.units.force,
        };
        let previous = self.previous.replace(now);
        let (Some(previous), false) = (previous, reading.restarted || gap) else {
            (self.unfiltered, self.filters_empty) = (None, true);
            return Ok(RegressionRow { contact: reading.contact, restarted: true, ..RegressionRow::default() });
        };
        let unfiltered = self.raw_row(&previous, &now, sample.elapsed);
        let last = self.unfiltered.replace(unfiltered);
        let aligned = match (self.model, last) {
            (ContactModel::ToolMass, Some(last)) => Some(with_acceleration(&last, &unfiltered, sample.elapsed)),
            (ContactModel::ToolMass, None) => None,
            _ => Some(unfiltered),
        };
        let Some(aligned) = aligned else {
            return Ok(RegressionRow { contact: reading.contact, restarted: true, ..RegressionRow::default() });
        };
        Ok(self.filtered(&aligned, reading.contact))
    }

    fn raw_row(&self, previous: &PreviousSample, now: &PreviousSample, elapsed: f32) -> UnfilteredRow {
        let inside = |x: f32| if self.front_end.config().bilateral { x } else { larger(x, 0.0) };
        let columns = self.model.columns(inside(previous.penetration), inside(now.penetration), elapsed, self.to_rate);
        let rate = (now.penetration - previous.penetration) / elapsed * self.to_rate;
        UnfilteredRow { columns, force: 0.5 * (previous.force + now.force), rate }
    }

    fn filtered(&mut self, unfiltered: &UnfilteredRow, contact: bool) -> RegressionRow {
        if core::mem::take(&mut self.filters_empty) {
            self.columns = unfiltered.columns.map(LowPassState::at_rest);
            self.force = LowPassState::at_rest(unfiltered.force);
        }
        let mut regressor = unfiltered.columns;
        for (column, state) in regressor.iter_mut().zip(&mut self.columns) {
            *column = self.filter.update(state, *column);
        }
        RegressionRow {
            regressor,
            force: self.filter.update(&mut self.force, unfiltered.force),
            contact,
            restarted: false,
        }
    }
}

/// The mean of two rows and the acceleration between them: all three belong to the instant that they share.
fn with_acceleration(last: &UnfilteredRow, unfiltered: &UnfilteredRow, elapsed: f32) -> UnfilteredRow {
    let ([x0, v0, _], [x1, v1, _]) = (last.columns, unfiltered.columns);
    let columns = [0.5 * (x0 + x1), 0.5 * (v0 + v1), (unfiltered.rate - last.rate) / elapsed];
    UnfilteredRow { columns, force: 0.5 * (last.force + unfiltered.force), rate: unfiltered.rate }
}
