//! A text file that is read without being held: whether it is UTF-8, and the line of a byte.

use std::io::{self, BufReader, Read};

/// Bytes that are looked at together.
const CHUNK_BYTES: usize = 1 << 16;

/// Goes through the rest of `source` once: how many lines it has at most, or, as the error within, at which byte it ceases to be UTF-8.
///
/// # Errors
/// It cannot be read.
pub fn survey(mut source: impl Read) -> io::Result<Result<usize, usize>> {
    let (mut buffer, mut before) = (Vec::with_capacity(CHUNK_BYTES), 0);
    let (mut feeds, mut returns) = (0, 0);
    loop {
        let room = (CHUNK_BYTES - buffer.len()) as u64;
        let is_end = source.by_ref().take(room).read_to_end(&mut buffer)? == 0;
        let whole = match std::str::from_utf8(&buffer) {
            Ok(_) => buffer.len(),
            // The rest of the character may be yet to come.
            Err(error) if error.error_len().is_none() && !is_end => error.valid_up_to(),
            Err(error) => return Ok(Err(before + error.valid_up_to())),
        };
        feeds += buffer[..whole].iter().filter(|byte| **byte == b'\n').count();
        returns += buffer[..whole].iter().filter(|byte| **byte == b'\r').count();
        if is_end {
            // The last line may have no end.
            return Ok(Ok(feeds.max(returns) + 1));
        }
        before += whole;
        buffer.drain(..whole);
    }
}

/// Line of byte `at`, counted from one, or of the first byte after it that ends no line; a line ends at LF, CRLF or CR.
///
/// # Errors
/// `source` cannot be read.
pub fn line_at(source: impl Read, at: usize) -> io::Result<usize> {
    let (mut line, mut before) = (1, 0);
    for (place, byte) in BufReader::new(source).bytes().enumerate() {
        let byte = byte?;
        if before == b'\r' && byte != b'\n' {
            line += 1;
        }
        if place >= at && !matches!(byte, b'\r' | b'\n') {
            return Ok(line);
        }
        if byte == b'\n' {
            line += 1;
        }
        before = byte;
    }
    Ok(line + usize::from(before == b'\r'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_across_two_chunks_are_whole_and_a_torn_one_is_told_by_its_byte() {
        for shift in 0..4 {
            let text = "x".repeat(CHUNK_BYTES - shift) + "\u{1f527}\n" + &"y".repeat(CHUNK_BYTES);
            assert_eq!(survey(&mut text.as_bytes()).unwrap(), Ok(2), "{shift} bytes before the chunk's end");
            let torn = &text.as_bytes()[..CHUNK_BYTES - shift + 2];
            assert_eq!(survey(&mut &*torn).unwrap(), Err(CHUNK_BYTES - shift), "{shift} bytes before the chunk's end");
        }
        assert_eq!(survey(&mut &b"a\r\nb\r\n"[..]).unwrap(), Ok(3));
    }

    #[test]
    fn a_line_ends_at_a_feed_a_return_or_both() {
        let text = b"a\nb\r\nc\rd\r\r\ne";
        for (at, line) in [(0, 1), (2, 2), (5, 3), (7, 4), (8, 6), (11, 6), (99, 6)] {
            assert_eq!(line_at(&mut &text[..], at).unwrap(), line, "byte {at}");
        }
    }
}
