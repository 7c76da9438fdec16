//! From a file to a [`Recording`]; CSV row by row, so that errors name the line.

use std::path::Path;

use csv::{ByteRecord, ReaderBuilder};

use super::columns::{self, Found, Role};
use super::data_file::{self, DataFile};
use super::format::Format;
use super::{Recording, assemble};
use crate::error::InputError;
use crate::rig::Rig;

/// See [`Recording::read`].
pub fn recording(path: &Path, rig: &Rig) -> Result<Recording, InputError> {
    let place = path.display().to_string();
    let bytes = data_file::read_bytes(path)?;
    let name = path.file_name().map_or_else(|| place.clone(), |name| name.to_string_lossy().into_owned());
    match Format::of(path, &bytes)? {
        Format::Csv => File { place, bytes: &bytes }.parse(name, rig),
        format => assemble::recording(&DataFile::parse(&place, format, &bytes)?.channels, &place, name, rig),
    }
}

/// A file in memory. The CSV reader skips a byte order mark by itself.
struct File<'a> {
    place: String,
    bytes: &'a [u8],
}

/// The columns wanted and what they hold so far.
struct Channels {
    found: Vec<Found>,
    names: Vec<String>,
    values: Vec<Vec<f64>>,
}

impl File<'_> {
    fn parse(&self, name: String, rig: &Rig) -> Result<Recording, InputError> {
        self.refuse_other_text()?;
        let mut reader = ReaderBuilder::new().has_headers(false).flexible(true).from_reader(self.bytes);
        let mut record = ByteRecord::new();
        let read = |reader: &mut csv::Reader<&[u8]>, record: &mut ByteRecord| {
            reader.read_byte_record(record).map_err(|error| InputError::new(&self.place, error, "CSV"))
        };
        if !read(&mut reader, &mut record)? {
            return Err(InputError::new(&self.place, "an empty file", "a header row and at least two rows of numbers"));
        }
        let width = record.len();
        let mut channels = self.channels(&record, rig)?;
        while read(&mut reader, &mut record)? {
            if record.len() != width {
                let found = format!("{} fields", record.len());
                return Err(InputError::new(self.line(&record), found, format!("{width}, as in the header")));
            }
            self.take(&record, &mut channels)?;
        }
        let rows = channels.values[0].len();
        if rows < 2 {
            let found = if rows == 0 { "a header and no rows" } else { "a header and a single row" };
            return Err(InputError::new(&self.place, found, "at least two rows of numbers"));
        }
        Ok(channels.into_recording(name, rig))
    }

    fn refuse_other_text(&self) -> Result<(), InputError> {
        match std::str::from_utf8(self.bytes) {
            Ok(_) => Ok(()),
            Err(error) => {
                let place = format!("{}:{}", self.place, line_at(self.bytes, error.valid_up_to()));
                Err(InputError::new(place, "bytes that are not UTF-8", "text in UTF-8"))
            }
        }
    }

    fn channels(&self, header: &ByteRecord, rig: &Rig) -> Result<Channels, InputError> {
        let names: Vec<_> = header.iter().map(text).collect();
        let found = columns::find(&names, rig, &self.line(header), false)?;
        let taken = found.iter().map(|(_, column)| names[*column].to_owned()).collect();
        let rows = self.bytes.len() / (8 * names.len()).max(1);
        let values = found.iter().map(|_| Vec::with_capacity(rows)).collect();
        Ok(Channels { found, names: taken, values })
    }

    fn take(&self, record: &ByteRecord, channels: &mut Channels) -> Result<(), InputError> {
        for (at, (role, column)) in channels.found.iter().enumerate() {
            let field = text(&record[*column]);
            let value = field.parse::<f64>().ok().filter(|value| value.is_finite());
            let values = &mut channels.values[at];
            let fault = |found: String, expected: String| {
                let place = format!("{}: column {}", self.line(record), channels.names[at]);
                Err(InputError::new(place, found, expected))
            };
            let Some(value) = value else {
                return match field.parse::<f64>() {
                    Ok(_) => fault(format!("\"{field}\""), "a finite number".to_owned()),
                    Err(_) if field.is_empty() => fault("an empty field".to_owned(), "a number".to_owned()),
                    Err(_) => fault(format!("the text \"{field}\""), "a number".to_owned()),
                };
            };
            if let (Role::Time, Some(&before)) = (role, values.last())
                && value <= before
            {
                return fault(format!("{value} after {before}"), "time that strictly increases".to_owned());
            }
            values.push(value);
        }
        Ok(())
    }

    /// File and line of `record`. Counted only here: the reader's own count is off after CRLF and blank lines.
    fn line(&self, record: &ByteRecord) -> String {
        let start = record.position().map_or(0, |position| usize::try_from(position.byte()).unwrap_or(0));
        let rest = self.bytes.get(start..).unwrap_or_default();
        let skipped = rest.iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        format!("{}:{}", self.place, line_at(self.bytes, start + skipped))
    }
}

impl Channels {
    fn into_recording(self, name: String, rig: &Rig) -> Recording {
        let channels = self.found.into_iter().zip(self.values).map(|((role, _), values)| (role, values)).collect();
        Recording { name, ..assemble::into_recording(channels, rig) }
    }
}

/// Line of byte `at`, counted from one; a line ends at LF, CRLF or CR.
fn line_at(bytes: &[u8], at: usize) -> usize {
    let ends = |i: usize| bytes[i] == b'\n' || (bytes[i] == b'\r' && bytes.get(i + 1) != Some(&b'\n'));
    1 + (0..at.min(bytes.len())).filter(|&i| ends(i)).count()
}

/// The file was found to be UTF-8; a quoted field cannot cut a character either.
fn text(field: &[u8]) -> &str {
    std::str::from_utf8(field).unwrap_or_default().trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Recording, InputError> {
        let rig = Rig::parse(
            "[rig]\nname = \"bench\"\n[contact]\nsurface_m = 0.0\nstiffness_n_m = 300.0\ndamping_n_s_m = 5.0\n",
            "rig.toml",
        );
        let file = File { place: "trial.csv".to_owned(), bytes: text.as_bytes() };
        file.parse("trial.csv".to_owned(), &rig.unwrap())
    }

    #[test]
    fn a_row_longer_or_shorter_than_the_header_is_refused_by_its_line() {
        let header = "t_s,position_m,force_N\n0.000,0.001,1.0\n";
        assert_eq!(parse(&format!("{header}0.001,0.002,2.0\n")).unwrap().force.unwrap(), [1.0, 2.0]);
        for row in ["0.001,0.002,2.0,7.0", "0.001,0.002,2.0,", "0.001,0.002"] {
            let error = parse(&format!("{header}{row}\n")).unwrap_err().to_string();
            assert!(error.contains("trial.csv:3"), "{row}: {error}");
        }
    }
}
