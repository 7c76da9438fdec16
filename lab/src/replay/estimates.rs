//! `estimates.csv`: one row a sample, written as the rows pass by.

use anyhow::Result;
use palpate::{Flags, Method};

use super::run::Step;
use crate::error::InputError;
use crate::outfile::OutFile;
use crate::rig::{Coordinate, Word};

/// Set in the column of flags where the sample was rejected and the estimate before it is held.
pub const REJECTED: u16 = 1 << 15;

const STIFFNESS: Word = Word::new("n_m", "n_m_rad");
const DAMPING: Word = Word::new("n_s_m", "n_m_s_rad");
const FORCE: Word = Word::new("n", "n_m");

/// The file: `t_s`, `contact`, three columns a method, then for each method the half-widths of its 95 % intervals and its
/// flags (the bits of [`palpate::Flags`], and [`REJECTED`]).
pub struct EstimatesFile {
    csv: csv::Writer<OutFile>,
    /// Of one row: what is written after the contact, for each method.
    figures: Vec<[f32; 3]>,
    quality: Vec<(f32, f32, u16)>,
}

impl EstimatesFile {
    /// Begins `file` with its header.
    ///
    /// # Errors
    /// The place cannot be written any more.
    pub fn begin(file: OutFile, coordinate: Coordinate, methods: &[Method]) -> Result<Self, InputError> {
        let csv = csv::WriterBuilder::new().has_headers(false).from_writer(file);
        let mut begun = Self { csv, figures: Vec::new(), quality: Vec::new() };
        let written = begun.csv.write_record(header(coordinate, methods));
        written.map_err(|error| begun.fault(error))?;
        Ok(begun)
    }

    /// Writes the next row.
    ///
    /// # Errors
    /// The place cannot be written any more.
    pub fn take(&mut self, step: &Step<'_>) -> Result<(), InputError> {
        let rejected = if step.rejected { REJECTED } else { 0 };
        let estimates = || step.estimates.iter();
        self.figures.clear();
        self.figures.extend(estimates().map(|e| [e.impedance.stiffness, e.impedance.damping, e.innovation]));
        self.quality.clear();
        let quality = estimates().map(|e| (e.half_width.stiffness, e.half_width.damping, e.flags.bits() | rejected));
        self.quality.extend(quality);
        let written = self.csv.serialize((step.time, u8::from(step.contact()), &self.figures, &self.quality));
        written.map_err(|error| self.fault(error))
    }

    /// The whole file, not yet in its place.
    ///
    /// # Errors
    /// The place cannot be written any more.
    pub fn finish(mut self) -> Result<OutFile, InputError> {
        let flushed = self.csv.flush();
        flushed.map_err(|error| self.fault(error))?;
        // What is flushed cannot fail to be.
        self.csv.into_inner().map_err(|error| InputError::new("estimates.csv", error, "a file that can be written"))
    }

    /// A write error inside the CSV writer is one of the file's own, which names the place.
    fn fault(&self, error: impl Into<std::io::Error>) -> InputError {
        self.csv.get_ref().fault(&error.into())
    }
}

fn header(coordinate: Coordinate, methods: &[Method]) -> Vec<String> {
    let (k, b, f) = (coordinate.pick(STIFFNESS), coordinate.pick(DAMPING), coordinate.pick(FORCE));
    let names = || methods.iter().map(|method| method.name());
    let figures = names().flat_map(|name| {
        [format!("{name}_stiffness_{k}"), format!("{name}_damping_{b}"), format!("{name}_innovation_{f}")]
    });
    let quality = names().flat_map(|name| {
        [format!("{name}_stiffness_ci95_{k}"), format!("{name}_damping_ci95_{b}"), format!("{name}_flags")]
    });
    ["t_s".to_owned(), "contact".to_owned()].into_iter().chain(figures).chain(quality).collect()
}

const _: () = assert!(Flags::all().bits() & REJECTED == 0, "the library does not use the bit");
