//! `estimates.csv`: one row a sample.

use anyhow::Result;
use palpate::{Estimate, Flags};

use super::Replayed;
use crate::outfile::OutFile;
use crate::rig::{Coordinate, Word};

/// Set in the column of flags where the sample was rejected and the estimate before it is held.
pub const REJECTED: u16 = 1 << 15;

const STIFFNESS: Word = Word::new("n_m", "n_m_rad");
const DAMPING: Word = Word::new("n_s_m", "n_m_s_rad");
const FORCE: Word = Word::new("n", "n_m");

/// Writes `t_s`, `contact`, three columns a method, then for each method the half-widths of its 95 % intervals and its
/// flags (the bits of [`palpate::Flags`], and [`REJECTED`]).
///
/// # Errors
/// The place cannot be written any more.
pub fn write(mut file: OutFile, coordinate: Coordinate, replayed: &Replayed) -> Result<()> {
    // A write error inside the CSV writer is one of the file's own; `fault` names the place.
    let written = rows(&mut file, coordinate, replayed);
    written.map_err(|error| file.fault(&error))?;
    Ok(file.commit()?)
}

fn rows(file: &mut OutFile, coordinate: Coordinate, replayed: &Replayed) -> std::io::Result<()> {
    let mut csv = csv::WriterBuilder::new().has_headers(false).from_writer(file);
    csv.write_record(header(coordinate, replayed))?;
    let columns = replayed.trace.columns();
    for (k, (t, contact)) in replayed.recording.time.iter().zip(replayed.trace.contact()).enumerate() {
        let row: Vec<&Estimate> = columns.iter().filter_map(|(_, estimates)| estimates.get(k)).collect();
        let rejected = replayed.trace.rejection(k).map_or(0, |_| REJECTED);
        let figures: Vec<f32> =
            row.iter().flat_map(|e| [e.impedance.stiffness, e.impedance.damping, e.innovation]).collect();
        let quality: Vec<(f32, f32, u16)> =
            row.iter().map(|e| (e.half_width.stiffness, e.half_width.damping, e.flags.bits() | rejected)).collect();
        csv.serialize((t, u8::from(contact), figures, quality))?;
    }
    csv.flush()
}

fn header(coordinate: Coordinate, replayed: &Replayed) -> Vec<String> {
    let (k, b, f) = (coordinate.pick(STIFFNESS), coordinate.pick(DAMPING), coordinate.pick(FORCE));
    let names = || replayed.trace.columns().iter().map(|(method, _)| method.name());
    let figures = names().flat_map(|name| {
        [format!("{name}_stiffness_{k}"), format!("{name}_damping_{b}"), format!("{name}_innovation_{f}")]
    });
    let quality = names().flat_map(|name| {
        [format!("{name}_stiffness_ci95_{k}"), format!("{name}_damping_ci95_{b}"), format!("{name}_flags")]
    });
    ["t_s".to_owned(), "contact".to_owned()].into_iter().chain(figures).chain(quality).collect()
}

const _: () = assert!(Flags::all().bits() & REJECTED == 0, "the library does not use the bit");
