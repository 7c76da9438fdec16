//! From sensor readings to rows of a contact law with two or three parameters.

use crate::contact::{Observation, Sample};
use crate::error::ConfigError;
use crate::front_end::contact_model::{ContactModel, MOST_PARAMETERS};
use crate::front_end::low_pass::{LowPass, LowPassState};
use crate::front_end::samples::{FrontEnd, FrontEndConfig, FrontEndState, Rejection};
use crate::math::larger;

/// One row, in internal units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Row {
    /// The columns; zero beyond those of the model.
    pub regressor: [f32; MOST_PARAMETERS],
    /// The force that they explain.
    pub force: f32,
    /// The tool is in the surface.
    pub contact: bool,
    /// The filters began anew: not a row of the regression.
    pub restarted: bool,
}

impl Row {
    /// The row of a law of two parameters, for any [`crate::Law`]: K stands in the place of the stiffness, B of the damping.
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
    columns: [LowPassState; MOST_PARAMETERS],
    force: LowPassState,
    before: Option<Before>,
    /// The last row before the filters, and the rate of the tool itself, where there are any.
    raw: Option<Raw>,
    fresh: bool,
}

#[derive(Debug, Clone, Copy)]
struct Before {
    /// Depth below the surface, negative outside, internal units.
    penetration: f32,
    force: f32,
}

#[derive(Debug, Clone, Copy)]
struct Raw {
    columns: [f32; MOST_PARAMETERS],
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
            before: None,
            raw: None,
            fresh: true,
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
    pub fn update(&mut self, sample: Sample) -> Result<Row, Rejection> {
        let reading = self.front_end.update(&mut self.state, sample)?;
        let config = self.front_end.config();
        let gap = (sample.elapsed - config.period).abs() > 0.1 * config.period;
        let now = Before {
            penetration: (sample.position - config.surface) / config.units.penetration,
            force: sample.force / config.units.force,
        };
        let before = self.before.replace(now);
        let (Some(before), false) = (before, reading.restarted || gap) else {
            (self.raw, self.fresh) = (None, true);
            return Ok(Row { contact: reading.contact, restarted: true, ..Row::default() });
        };
        let raw = self.raw_row(&before, &now, sample.elapsed);
        let last = self.raw.replace(raw);
        let aligned = match (self.model, last) {
            (ContactModel::ToolMass, Some(last)) => Some(with_acceleration(&last, &raw, sample.elapsed)),
            (ContactModel::ToolMass, None) => None,
            _ => Some(raw),
        };
        let Some(aligned) = aligned else {
            return Ok(Row { contact: reading.contact, restarted: true, ..Row::default() });
        };
        Ok(self.filtered(&aligned, reading.contact))
    }

    fn raw_row(&self, before: &Before, now: &Before, elapsed: f32) -> Raw {
        let inside = |x: f32| if self.front_end.config().bilateral { x } else { larger(x, 0.0) };
        let columns = self.model.columns(inside(before.penetration), inside(now.penetration), elapsed, self.to_rate);
        let rate = (now.penetration - before.penetration) / elapsed * self.to_rate;
        Raw { columns, force: 0.5 * (before.force + now.force), rate }
    }

    fn filtered(&mut self, raw: &Raw, contact: bool) -> Row {
        if core::mem::take(&mut self.fresh) {
            self.columns = raw.columns.map(LowPassState::at_rest);
            self.force = LowPassState::at_rest(raw.force);
        }
        let mut regressor = raw.columns;
        for (column, state) in regressor.iter_mut().zip(&mut self.columns) {
            *column = self.filter.update(state, *column);
        }
        Row { regressor, force: self.filter.update(&mut self.force, raw.force), contact, restarted: false }
    }
}

/// The mean of two rows and the acceleration between them: all three belong to the instant that they share.
fn with_acceleration(last: &Raw, raw: &Raw, elapsed: f32) -> Raw {
    let ([x0, v0, _], [x1, v1, _]) = (last.columns, raw.columns);
    let columns = [0.5 * (x0 + x1), 0.5 * (v0 + v1), (raw.rate - last.rate) / elapsed];
    Raw { columns, force: 0.5 * (last.force + raw.force), rate: raw.rate }
}
