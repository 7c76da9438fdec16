//! The way to a drive: a serial port, or the socket of an emulator.

use std::io::{Read, Write};
use std::path::Path;
use std::time::Duration;

use crate::error::InputError;

/// Bytes both ways; a read gives up after a few milliseconds.
pub trait Port: Read + Write + Send {}

impl<T: Read + Write + Send> Port for T {}

/// How long a read waits for a byte.
pub const READ_TIMEOUT: Duration = Duration::from_millis(5);

/// Opens the serial port, or the Unix socket, at `path`.
///
/// # Errors
/// There is none, or it may not be opened.
pub fn open(path: &Path, baud: u32) -> Result<Box<dyn Port>, InputError> {
    let fault =
        |found: String| InputError::new(path.display(), found, "the serial port of a drive, or an emulator's socket");
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt as _;
        if std::fs::metadata(path).is_ok_and(|found| found.file_type().is_socket()) {
            let socket = std::os::unix::net::UnixStream::connect(path).map_err(|error| fault(error.to_string()))?;
            socket.set_read_timeout(Some(READ_TIMEOUT)).map_err(|error| fault(error.to_string()))?;
            return Ok(Box::new(socket));
        }
    }
    let name = path.to_string_lossy();
    let port = serialport::new(name.as_ref(), baud).timeout(READ_TIMEOUT).open();
    Ok(Box::new(port.map_err(|error| fault(error.to_string()))?))
}
