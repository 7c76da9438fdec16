//! A file that is there in whole or not at all.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::error::InputError;
use crate::interrupt::Temporary;

/// An output file: written beside its place, moved there by [`OutFile::commit`]. Dropped before that, it leaves nothing.
///
/// Opening it before a long run shows at once whether the place can be written.
pub struct OutFile {
    path: PathBuf,
    sink: Sink,
}

enum Sink {
    Beside(BufWriter<NamedTempFile>, Temporary),
    /// A pipe or a device: nothing can be moved over it.
    Straight(BufWriter<File>),
}

impl OutFile {
    /// Opens `path` for writing.
    ///
    /// # Errors
    /// The folder is missing or may not be written, or `path` is a folder.
    pub fn create(path: &Path) -> Result<Self, InputError> {
        let fault = |error: io::Error| unwritable(path, &error);
        let sink = match std::fs::metadata(path) {
            Ok(found) if found.is_dir() => {
                return Err(InputError::new(path.display(), "a folder", "a file to write to"));
            }
            Ok(found) if !found.is_file() => {
                let file = File::options().write(true).open(path).map_err(fault)?;
                Sink::Straight(BufWriter::new(file))
            }
            // A file that may not be written is not replaced behind its owner's back.
            Ok(_) => {
                File::options().append(true).open(path).map_err(fault)?;
                sink_beside(path).map_err(fault)?
            }
            Err(_) => sink_beside(path).map_err(fault)?,
        };
        Ok(Self { path: path.to_owned(), sink })
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// The disk is full, or the place was taken away meanwhile.
    pub fn commit(self) -> Result<(), InputError> {
        let fault = |error: io::Error| unwritable(&self.path, &error);
        match self.sink {
            Sink::Straight(mut file) => file.flush().map_err(fault),
            Sink::Beside(file, _removed_by_a_signal) => {
                let file = file.into_inner().map_err(|error| fault(error.into_error()))?;
                // A symbolic link keeps pointing where it did: its target is replaced, not the link.
                let place = std::fs::canonicalize(&self.path).unwrap_or_else(|_| self.path.clone());
                file.persist(place).map_err(|error| fault(error.error))?;
                Ok(())
            }
        }
    }

    /// The error of a write to this file.
    #[must_use]
    pub fn fault(&self, error: &io::Error) -> InputError {
        unwritable(&self.path, error)
    }
}

impl Write for OutFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            Sink::Beside(file, _) => file.write(bytes),
            Sink::Straight(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Beside(file, _) => file.flush(),
            Sink::Straight(file) => file.flush(),
        }
    }
}

fn sink_beside(path: &Path) -> io::Result<Sink> {
    let file = beside(path)?;
    let removed = Temporary::new(file.path());
    Ok(Sink::Beside(BufWriter::new(file), removed))
}

fn beside(path: &Path) -> io::Result<NamedTempFile> {
    let place = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let folder = match place.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".palpate-");
    // The temporary file of the library is private to its owner; a result is an ordinary file.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

fn unwritable(path: &Path, error: &io::Error) -> InputError {
    // The library appends the temporary file's own name, which tells a user nothing.
    let reason =
        error.get_ref().and_then(|inner| inner.source()).map_or_else(|| error.to_string(), ToString::to_string);
    InputError::new(
        path.display(),
        format!("it cannot be written: {reason}"),
        "a file in a folder that exists and may be written",
    )
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    fn write(path: &Path, text: &str) -> Result<(), InputError> {
        let mut file = OutFile::create(path)?;
        file.write_all(text.as_bytes()).map_err(|error| file.fault(&error))?;
        file.commit()
    }

    #[test]
    fn a_file_is_there_in_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.csv");
        write(&path, "old").unwrap();
        let mut file = OutFile::create(&path).unwrap();
        file.write_all(b"half").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        drop(file);
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "a temporary file is left");
        write(&path, "new").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    }

    #[test]
    fn a_symbolic_link_stays_one_and_what_it_points_at_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target.csv"), folder.path().join("link.csv"));
        fs::write(&target, "old").unwrap();
        symlink(&target, &link).unwrap();
        write(&link, "new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&target).unwrap(), "new");
    }

    #[test]
    fn a_file_that_may_not_be_written_is_refused_and_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.csv");
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
        // Root may write what is marked as read-only: then there is nothing to refuse.
        if File::options().append(true).open(&path).is_ok() {
            eprintln!("left out: this user may write any file");
            return;
        }
        assert!(write(&path, "new").is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    }

    #[test]
    fn a_folder_is_no_file_to_write_to() {
        let folder = tempfile::tempdir().unwrap();
        assert!(write(folder.path(), "new").unwrap_err().to_string().contains("a folder"));
    }
}
