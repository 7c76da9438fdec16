//! Which format a file is in: detected by its first bytes, and compared with its ending.

use std::path::Path;

use crate::error::InputError;

/// A format that recordings are read from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated text with a header row.
    Csv,
    /// NumPy's archive of arrays.
    Npz,
    /// MATLAB's MAT-file, level 5 (`save -v7` and older).
    Mat,
    /// Apache Parquet.
    Parquet,
    /// MCAP, as ROS 2 records it.
    Mcap,
}

impl Format {
    /// As a person calls it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Csv => "CSV",
            Self::Npz => "NPZ",
            Self::Mat => "MAT version 5",
            Self::Parquet => "Parquet",
            Self::Mcap => "MCAP",
        }
    }

    fn of_ending(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "npz" => Some(Self::Npz),
            "mat" => Some(Self::Mat),
            "parquet" | "pq" => Some(Self::Parquet),
            "mcap" => Some(Self::Mcap),
            _ => None,
        }
    }

    /// Bytes at the beginning of a file by which its format is known.
    pub const HEAD_BYTES: u64 = 4096;

    /// The format of `path`, whose content begins with `bytes`. A file without an ending of its own may hold any of them.
    ///
    /// # Errors
    /// The content is of another format than the ending says, or of one that is not read.
    pub fn of(path: &Path, bytes: &[u8]) -> Result<Self, InputError> {
        let ending = Self::of_ending(path);
        let expected = match ending {
            Some(format) => format!("{}, as the file's ending says", format.name()),
            None => "CSV, NPZ, MAT version 5, Parquet or MCAP".to_owned(),
        };
        match Content::of(bytes) {
            Content::Known(format) if ending.is_none_or(|ending| ending == format) => Ok(format),
            Content::Known(format) => {
                Err(InputError::new(path.display(), format!("a {} file", format.name()), expected))
            }
            Content::Foreign(name, advice) => Err(InputError::new(path.display(), name, advice)),
            Content::Text if ending.is_none_or(|ending| ending == Self::Csv) => Ok(Self::Csv),
            Content::Text => Err(InputError::new(path.display(), text_shown(bytes), expected)),
        }
    }
}

enum Content {
    Known(Format),
    /// What it is, and what to do.
    Foreign(&'static str, &'static str),
    /// None of the others: text, or nothing that has a mark.
    Text,
}

/// The mark of MAT-files of level 5, and where their version stands.
const MAT_VERSION: std::ops::Range<usize> = 124..128;

impl Content {
    fn of(bytes: &[u8]) -> Self {
        let foreign: [(&[u8], &str, &str); 6] = [
            (
                b"\x93NUMPY",
                "a single NumPy array (.npy), which has no names",
                "an archive of named arrays (numpy.savez)",
            ),
            (b"MATLAB 7.3", "a MAT-file of version 7.3, which is HDF5", "MAT version 5 (in MATLAB: save -v7)"),
            (b"\x89HDF\r\n", "an HDF5 file", "CSV, NPZ, MAT version 5, Parquet or MCAP"),
            (
                b"SQLite format 3",
                "a SQLite database, a ROS 2 bag perhaps",
                "MCAP (ros2 bag convert, or ros2 bag record -s mcap)",
            ),
            (b"#ROSBAG", "a bag of ROS 1", "MCAP (mcap convert)"),
            (b"\x1f\x8b", "a gzip archive", "the file that is in it"),
        ];
        let known: [(&[u8], Format); 4] = [
            (b"PK\x03\x04", Format::Npz),
            (b"PK\x05\x06", Format::Npz),
            (b"PAR1", Format::Parquet),
            (mcap::MAGIC, Format::Mcap),
        ];
        if let Some((_, name, advice)) = foreign.iter().find(|(mark, ..)| bytes.starts_with(mark)) {
            return Self::Foreign(name, advice);
        }
        if let Some((_, format)) = known.iter().find(|(mark, _)| bytes.starts_with(mark)) {
            return Self::Known(*format);
        }
        // Version 1.0 and a mark of the byte order.
        match bytes.get(MAT_VERSION) {
            Some([0x00, 0x01, b'I', b'M'] | [0x01, 0x00, b'M', b'I']) => Self::Known(Format::Mat),
            _ => Self::Text,
        }
    }
}

fn text_shown(bytes: &[u8]) -> String {
    if bytes.is_empty() {
        return "an empty file".to_owned();
    }
    let start = &bytes[..bytes.len().min(256)];
    let is_text = std::str::from_utf8(start).is_ok_and(|text| !text.contains('\0'));
    if is_text { "text".to_owned() } else { "bytes of no format that is known".to_owned() }
}
