//! From a file to a [`Recording`]; CSV row by row, so that errors name the line.

use std::io::{self, Read, Seek};
use std::path::Path;

use csv::{ByteRecord, ReaderBuilder};

use super::columns::{self, Found, Role};
use super::data_file::{self, DataFile};
use super::format::Format;
use super::text::{line_at, survey};
use super::{Recording, Scope, assemble};
use crate::error::InputError;
use crate::rig::Rig;

/// See [`Recording::read`]; what `scope` leaves out is read and checked too.
pub fn recording(path: &Path, rig: &Rig, scope: Scope) -> Result<Recording, InputError> {
    let place = path.display().to_string();
    let fault = |error: io::Error| data_file::unreadable(path, &error);
    let mut source = data_file::open(path)?;
    let mut bytes = Vec::new();
    source.by_ref().take(Format::HEAD_BYTES).read_to_end(&mut bytes).map_err(fault)?;
    let name = path.file_name().map_or_else(|| place.clone(), |name| name.to_string_lossy().into_owned());
    match Format::of(path, &bytes)? {
        Format::Csv => File { place, path, source }.parse(name, rig, scope),
        format => {
            source.read_to_end(&mut bytes).map_err(fault)?;
            assemble::recording(&DataFile::parse(&place, format, &bytes)?.channels, &place, name, rig, scope)
        }
    }
}

/// A file that is gone through several times and never held. The CSV reader skips a byte order mark by itself.
struct File<'a, S> {
    place: String,
    path: &'a Path,
    source: S,
}

/// The columns wanted and what they hold so far; a column that is only checked holds nothing.
struct Channels {
    found: Vec<Found>,
    names: Vec<String>,
    values: Vec<Vec<f64>>,
    scope: Scope,
}

/// What is wrong with a record.
struct Fault {
    /// Where the record begins; `None` where the fault is the file's.
    byte: Option<usize>,
    column: Option<String>,
    found: String,
    expected: String,
}

impl<S: Read + Seek> File<'_, S> {
    fn parse(mut self, name: String, rig: &Rig, scope: Scope) -> Result<Recording, InputError> {
        let lines = self.lines_of_text()?;
        let header = self.records(Self::header)?;
        let names: Vec<_> = header.iter().map(text).collect();
        let found = columns::find(&names, rig, &self.line(start(&header))?, false)?;
        let taken = found.iter().map(|(_, column)| names[*column].to_owned()).collect();
        let room = |(role, _): &Found| Vec::with_capacity(if scope.holds(*role) { lines } else { 0 });
        let mut channels = Channels { values: found.iter().map(room).collect(), found, names: taken, scope };
        self.records(|reader| channels.take_all(reader, header.len()))?;
        Ok(channels.into_recording(name, rig))
    }

    /// Goes through the records, from the header on.
    fn records<T>(&mut self, read: impl FnOnce(&mut csv::Reader<&mut S>) -> Result<T, Fault>) -> Result<T, InputError> {
        self.source.rewind().map_err(|error| data_file::unreadable(self.path, &error))?;
        let mut reader = ReaderBuilder::new().has_headers(false).flexible(true).from_reader(&mut self.source);
        let done = read(&mut reader);
        drop(reader);
        done.map_err(|fault| self.located(fault))
    }

    fn header(reader: &mut csv::Reader<&mut S>) -> Result<ByteRecord, Fault> {
        let mut record = ByteRecord::new();
        match next(reader, &mut record)? {
            true => Ok(record),
            false => Err(Fault::of_file("an empty file", "a header row and at least two rows of numbers")),
        }
    }

    /// How many lines the file has at most.
    fn lines_of_text(&mut self) -> Result<usize, InputError> {
        let unreadable = |error| data_file::unreadable(self.path, &error);
        self.source.rewind().map_err(unreadable)?;
        match survey(&mut self.source).map_err(unreadable)? {
            Ok(lines) => Ok(lines),
            Err(byte) => Err(InputError::new(self.line(byte)?, "bytes that are not UTF-8", "text in UTF-8")),
        }
    }

    fn located(&mut self, fault: Fault) -> InputError {
        let place = match fault.byte.map(|byte| self.line(byte)) {
            None => self.place.clone(),
            Some(Ok(line)) => line,
            Some(Err(error)) => return error,
        };
        let place = fault.column.map_or_else(|| place.clone(), |column| format!("{place}: column {column}"));
        InputError::new(place, fault.found, fault.expected)
    }

    /// File and line of the record at `byte`. Counted only here: the reader's own count is off after CRLF and blank lines.
    fn line(&mut self, byte: usize) -> Result<String, InputError> {
        let unreadable = |error| data_file::unreadable(self.path, &error);
        self.source.rewind().map_err(unreadable)?;
        let line = line_at(&mut self.source, byte).map_err(unreadable)?;
        Ok(format!("{}:{line}", self.place))
    }
}

/// Reads the next record; whether there is one.
fn next(reader: &mut csv::Reader<impl Read>, record: &mut ByteRecord) -> Result<bool, Fault> {
    reader.read_byte_record(record).map_err(|error| Fault::of_file(error, "CSV"))
}

fn start(record: &ByteRecord) -> usize {
    record.position().map_or(0, |position| usize::try_from(position.byte()).unwrap_or(0))
}

impl Fault {
    fn of_file(found: impl ToString, expected: &str) -> Self {
        Self { byte: None, column: None, found: found.to_string(), expected: expected.to_owned() }
    }
}

impl Channels {
    /// Takes every record after the header, which has `width` fields.
    fn take_all(&mut self, reader: &mut csv::Reader<impl Read>, width: usize) -> Result<(), Fault> {
        let mut record = ByteRecord::new();
        next(reader, &mut record)?;
        while next(reader, &mut record)? {
            if record.len() != width {
                let (found, expected) = (format!("{} fields", record.len()), format!("{width}, as in the header"));
                return Err(Fault { byte: Some(start(&record)), column: None, found, expected });
            }
            self.take(&record)?;
        }
        // Time comes first, and is always held.
        match self.values[0].len() {
            0 => Err(Fault::of_file("a header and no rows", "at least two rows of numbers")),
            1 => Err(Fault::of_file("a header and a single row", "at least two rows of numbers")),
            _ => Ok(()),
        }
    }

    fn take(&mut self, record: &ByteRecord) -> Result<(), Fault> {
        for (at, (role, column)) in self.found.iter().enumerate() {
            let values = &mut self.values[at];
            let fault = |found: String, expected: &str| {
                let column = Some(self.names[at].clone());
                Err(Fault { byte: Some(start(record)), column, found, expected: expected.to_owned() })
            };
            let field = text(&record[*column]);
            let value = match field.parse::<f64>() {
                Ok(value) if value.is_finite() => value,
                Ok(_) => return fault(format!("\"{field}\""), "a finite number"),
                Err(_) if field.is_empty() => return fault("an empty field".to_owned(), "a number"),
                Err(_) => return fault(format!("the text \"{field}\""), "a number"),
            };
            if let (Role::Time, Some(&before)) = (role, values.last())
                && value <= before
            {
                return fault(format!("{value} after {before}"), "time that strictly increases");
            }
            if self.scope.holds(*role) {
                values.push(value);
            }
        }
        Ok(())
    }

    fn into_recording(self, name: String, rig: &Rig) -> Recording {
        let channels = self.found.into_iter().zip(self.values).map(|((role, _), values)| (role, values)).collect();
        Recording { name, ..assemble::into_recording(channels, rig, self.scope) }
    }
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
        let (path, source) = (Path::new("trial.csv"), io::Cursor::new(text.as_bytes()));
        let file = File { place: "trial.csv".to_owned(), path, source };
        file.parse("trial.csv".to_owned(), &rig.unwrap(), Scope::All)
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
