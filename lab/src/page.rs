//! `replay.html`: one self-contained page that shows a replay.

mod answer;
pub(crate) mod column;
mod document;
pub(crate) mod effect_name;
mod embed;
pub(crate) mod neighbour;
pub(crate) mod quantity;
pub(crate) mod shell;
pub(crate) mod table;
pub(crate) mod thin;

use std::io::{self, Write};

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

/// One recording and what the estimators made of it. All vectors are of equal length.
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
    /// Seconds.
    pub time: Vec<f64>,
    /// Depth below the rig's surface, positive into the environment.
    pub penetration: Vec<f32>,
    /// Measured contact force, positive when the tool pushes.
    pub force: Vec<f32>,
    /// The contact detection.
    pub contact: Vec<bool>,
    /// One entry a method.
    pub methods: Vec<Method>,
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

/// One estimator's trace.
#[derive(Debug, Clone)]
pub struct Method {
    /// Short name as on the command line: "bls".
    pub name: &'static str,
    /// Long name: "block least squares".
    pub title: &'static str,
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
    /// Summary over the samples in contact whose interval is finite, `None` where there are none.
    pub summary: Option<Summary>,
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
    /// to fetch anything. A long trial is thinned to the rows that a screen can resolve.
    ///
    /// # Errors
    /// Whatever `out` reports; [`io::ErrorKind::InvalidInput`] where the vectors of a trial differ in length.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        for trial in &self.trials {
            trial.check()?;
        }
        let budget = thin::budget(self.trials.iter().map(|trial| 5 + 5 * trial.methods.len()).sum());
        let shown: Vec<Vec<usize>> = self.trials.iter().map(|trial| trial.shown(budget)).collect();
        document::open(self, out)?;
        for (index, (trial, rows)) in self.trials.iter().zip(&shown).enumerate() {
            let section = document::trial(self, index, trial, rows.len());
            out.write_all(section.into_string().as_bytes())?;
        }
        embed::data(self, &shown, out)?;
        document::close(out)
    }
}

impl Trial {
    fn check(&self) -> io::Result<()> {
        let rows = self.time.len();
        let common = [self.penetration.len(), self.force.len(), self.contact.len()];
        let of_methods = self.methods.iter().flat_map(|method| method.columns().map(<[f32]>::len));
        if common.into_iter().chain(of_methods).all(|len| len == rows) {
            return Ok(());
        }
        let message = format!("{}: the columns of a trial must all have the {rows} rows of its time", self.name);
        Err(io::Error::new(io::ErrorKind::InvalidInput, message))
    }

    /// At most `budget` rows that look like all of them.
    fn shown(&self, budget: usize) -> Vec<usize> {
        let edges = thin::edges(&self.contact, budget / 2);
        let innovations = self.methods.iter().map(|method| method.innovation.as_slice());
        let signals: Vec<&[f32]> = [self.penetration.as_slice(), &self.force].into_iter().chain(innovations).collect();
        thin::rows(self.time.len(), &edges, &signals, budget)
    }

    /// The method that predicted the force best: the one that the page quotes.
    fn best(&self) -> Option<(usize, &Method, Summary)> {
        let summarised = self.methods.iter().enumerate().filter_map(|(i, m)| m.summary.map(|s| (i, m, s)));
        summarised.filter(|(_, _, s)| s.is_finite()).min_by(|a, b| a.2.rmse_percent.total_cmp(&b.2.rmse_percent))
    }
}

impl Method {
    /// In the order in which the page's script expects them.
    fn columns(&self) -> [&[f32]; 5] {
        [&self.stiffness, &self.stiffness_half_width, &self.damping, &self.damping_half_width, &self.innovation]
    }
}

impl Summary {
    fn is_finite(&self) -> bool {
        self.stiffness.is_finite() && self.damping.is_finite() && self.rmse_percent.is_finite()
    }
}
