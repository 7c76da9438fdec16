//! `replay.html`: one self-contained page that shows a replay.

mod answer;
pub(crate) mod column;
mod contact;
mod document;
mod drawing;
pub(crate) mod effect_name;
mod embed;
pub(crate) mod neighbour;
pub(crate) mod quantity;
pub(crate) mod shell;
pub(crate) mod table;
pub(crate) mod thin;

use std::io::{self, Write};

pub use contact::ContactSpan;
pub use drawing::{Drawing, Drawn, Row, budget};

/// Everything that the page shows. Pure data: nothing here knows how it was computed.
#[derive(Debug, Clone)]
pub struct Page {
    /// `[rig] name`.
    pub rig: String,
    /// Where the estimators ran: "host" or "Cortex-M4F under QEMU".
    pub ran_on: String,
    /// Settings that held for every trial, as label and value ("window", "300 samples").
    pub settings: Vec<(String, String)>,
    /// The page of a diagnosis beside this one, where there is one.
    pub diagnosis: Option<String>,
    /// One entry a recording, in the order of the command line.
    pub trials: Vec<Trial>,
}

/// One recording and what the estimators made of it.
#[derive(Debug, Clone)]
pub struct Trial {
    /// File name without its folder.
    pub name: String,
    /// Units of the coordinate.
    pub units: Units,
    /// Nominal stiffness of the rig file, drawn as a dashed line.
    pub nominal_stiffness: f64,
    /// Nominal damping of the rig file.
    pub nominal_damping: f64,
    /// One entry a method.
    pub methods: Vec<Method>,
    /// The rows that are drawn, with the estimates of each method.
    pub drawn: Drawn,
    /// What a reader must know of this replay ("cut-off lowered to 2 Hz: the recording has 10 samples a second").
    pub notices: Vec<String>,
}

/// Unit names for the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Units {
    /// "m" or "rad".
    pub position: &'static str,
    /// "N" or "N m".
    pub force: &'static str,
    /// "N/m" or "N m/rad".
    pub stiffness: &'static str,
    /// "N s/m" or "N m s/rad".
    pub damping: &'static str,
}

/// One estimator.
#[derive(Debug, Clone)]
pub struct Method {
    /// Short name as on the command line: "bls".
    pub name: &'static str,
    /// Long name: "block least squares".
    pub title: &'static str,
    /// Summary over the samples in contact whose interval is finite, `None` where there are none.
    pub summary: Option<Summary>,
}

/// Numbers that an estimator gives for each row.
pub const ESTIMATE_COLUMNS: usize = 5;

/// One estimator's trace.
#[derive(Debug, Clone, Default)]
pub struct Estimates {
    /// K.
    pub stiffness: Vec<f32>,
    /// Half-width of the 95 % interval of K; infinite where nothing is known yet.
    pub stiffness_half_width: Vec<f32>,
    /// B.
    pub damping: Vec<f32>,
    /// Half-width of the 95 % interval of B.
    pub damping_half_width: Vec<f32>,
    /// Force minus what the estimate before this sample predicted.
    pub innovation: Vec<f32>,
}

/// The figures of one method over one trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Median of K.
    pub stiffness: f64,
    /// Median half-width of its interval.
    pub stiffness_half_width: f64,
    /// Median of B.
    pub damping: f64,
    /// Median half-width of its interval.
    pub damping_half_width: f64,
    /// 100 rms(innovation) / rms(force) over contact.
    pub rmse_percent: f64,
}

impl Page {
    /// Writes the page. It needs nothing but itself: style, scripts and data are inside, and it forbids the browser
    /// to fetch anything.
    ///
    /// # Errors
    /// Whatever `out` reports; [`io::ErrorKind::InvalidInput`] where the vectors of a trial differ in length.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        for trial in &self.trials {
            trial.check()?;
        }
        document::open(self, out)?;
        for (index, trial) in self.trials.iter().enumerate() {
            out.write_all(document::trial(self, index, trial).into_string().as_bytes())?;
        }
        embed::data(self, out)?;
        document::close(out)
    }
}

impl Trial {
    fn check(&self) -> io::Result<()> {
        let drawn = &self.drawn;
        let rows = drawn.time.len();
        let common = [drawn.penetration.len(), drawn.force.len(), drawn.contact.len()];
        let of_methods = drawn.estimates.iter().flat_map(|estimates| estimates.columns().map(<[f32]>::len));
        let is_complete = drawn.estimates.len() == self.methods.len();
        if is_complete && common.into_iter().chain(of_methods).all(|len| len == rows) {
            return Ok(());
        }
        let message = format!("{}: the columns of a trial must all have the {rows} rows of its time", self.name);
        Err(io::Error::new(io::ErrorKind::InvalidInput, message))
    }

    /// The method that predicted the force best: the one that the page quotes.
    fn best(&self) -> Option<(usize, &Method, Summary)> {
        let summarised = self.methods.iter().enumerate().filter_map(|(i, m)| m.summary.map(|s| (i, m, s)));
        summarised.filter(|(_, _, s)| s.is_finite()).min_by(|a, b| a.2.rmse_percent.total_cmp(&b.2.rmse_percent))
    }
}

impl Estimates {
    /// In the order in which the page's script expects them.
    fn columns(&self) -> [&[f32]; ESTIMATE_COLUMNS] {
        [&self.stiffness, &self.stiffness_half_width, &self.damping, &self.damping_half_width, &self.innovation]
    }

    /// The numbers of one row more, in the order of the fields.
    fn push(&mut self, row: [f32; ESTIMATE_COLUMNS]) {
        let Self { stiffness, stiffness_half_width, damping, damping_half_width, innovation } = self;
        let columns = [stiffness, stiffness_half_width, damping, damping_half_width, innovation];
        columns.into_iter().zip(row).for_each(|(column, value)| column.push(value));
    }
}

impl Summary {
    fn is_finite(&self) -> bool {
        self.stiffness.is_finite() && self.damping.is_finite() && self.rmse_percent.is_finite()
    }
}
