//! Frames on a serial line: version, message, CRC, without a zero within (COBS), a zero behind.
//!
//! ```text
//! cobs( VERSION | message by postcard | CRC-32 of both, little-endian ) 0x00
//! ```
//!
//! Whoever begins to listen in the middle of a stream loses one frame and is in step from the next zero on.

use serde::{Deserialize, Serialize};

use crate::CRC;

/// The version of the messages: the first byte of every frame.
pub const VERSION: u8 = 1;

/// Bytes of a frame at most, before it is stuffed.
pub const FRAME_BYTES: usize = 250;

/// Bytes of a frame on the line at most: a byte of overhead in front, the zero behind.
pub const LINE_BYTES: usize = FRAME_BYTES + 2;

const CHECK: usize = 4;

/// The frame of `message`; `None` where it does not fit.
pub fn encode<'a, T: Serialize>(message: &T, line: &'a mut [u8; LINE_BYTES]) -> Option<&'a [u8]> {
    let mut frame = [0; FRAME_BYTES];
    let (version, rest) = frame.split_first_mut()?;
    *version = VERSION;
    let room = rest.get_mut(..FRAME_BYTES - 1 - CHECK)?;
    let end = 1 + postcard::to_slice(message, room).ok()?.len();
    let check = CRC.checksum(frame.get(..end)?).to_le_bytes();
    frame.get_mut(end..end + CHECK)?.copy_from_slice(&check);
    let used = cobs::try_encode(frame.get(..end + CHECK)?, line).ok()?;
    *line.get_mut(used)? = 0;
    line.get(..=used)
}

/// Counters of the frames received.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct LinkCounters {
    /// Whole frames of this version.
    pub frames: u32,
    /// Longer than any frame.
    pub oversized: u32,
    /// Not stuffed as a frame is, or too short.
    pub malformed: u32,
    /// Of a wrong CRC.
    pub checksum: u32,
    /// Of another version.
    pub version: u32,
    /// Valid frames with an unknown or inadmissible message.
    pub refused: u32,
}

impl LinkCounters {
    /// All frames that were not accepted.
    pub fn lost(&self) -> u32 {
        [self.oversized, self.malformed, self.checksum, self.version, self.refused]
            .into_iter()
            .fold(0, u32::saturating_add)
    }
}

/// Takes a line byte by byte.
#[derive(Debug, Clone)]
pub struct Receiver {
    line: [u8; LINE_BYTES],
    used: usize,
    /// Bytes of the message behind the version, once a frame is whole.
    ready: Option<usize>,
    link_counters: LinkCounters,
}

impl Default for Receiver {
    fn default() -> Self {
        Self::new()
    }
}

impl Receiver {
    /// Before the first byte.
    pub const fn new() -> Self {
        let link_counters = LinkCounters { frames: 0, oversized: 0, malformed: 0, checksum: 0, version: 0, refused: 0 };
        Self { line: [0; LINE_BYTES], used: 0, ready: None, link_counters }
    }

    /// Takes a byte; whether a frame is whole with it, for [`Self::message`] until the next byte.
    pub fn push(&mut self, byte: u8) -> bool {
        self.ready = None;
        if byte != 0 {
            // Beyond the end only the count goes on, by one, so that the frame is known to be too long.
            if let Some(place) = self.line.get_mut(self.used) {
                *place = byte;
                self.used += 1;
            }
            return false;
        }
        let used = core::mem::take(&mut self.used);
        // A zero behind a zero is a line at rest.
        if used > 0 {
            self.ready = self.unpack(used);
        }
        self.ready.is_some()
    }

    fn unpack(&mut self, used: usize) -> Option<usize> {
        let link_counters = &mut self.link_counters;
        if used >= LINE_BYTES {
            link_counters.oversized = link_counters.oversized.saturating_add(1);
            return None;
        }
        let frame = self.line.get_mut(..used).and_then(|line| {
            let length = cobs::decode_in_place(line).ok()?;
            line.get(..length)
        });
        let Some((body, check)) = frame.and_then(|frame| frame.split_last_chunk::<CHECK>()) else {
            link_counters.malformed = link_counters.malformed.saturating_add(1);
            return None;
        };
        if CRC.checksum(body) != u32::from_le_bytes(*check) {
            link_counters.checksum = link_counters.checksum.saturating_add(1);
            return None;
        }
        if body.first() != Some(&VERSION) {
            link_counters.version = link_counters.version.saturating_add(1);
            return None;
        }
        link_counters.frames = link_counters.frames.saturating_add(1);
        body.len().checked_sub(1)
    }

    /// The message of the frame that is whole; `None` where there is none, or it is none.
    pub fn message<'a, T: Deserialize<'a>>(&'a self) -> Option<T> {
        let length = self.ready?;
        let (message, left) = postcard::take_from_bytes(self.line.get(1..=length)?).ok()?;
        left.is_empty().then_some(message)
    }

    /// Counts the complete frame as inadmissible.
    pub fn refuse(&mut self) {
        self.link_counters.refused = self.link_counters.refused.saturating_add(1);
    }

    /// The counts.
    pub fn link_counters(&self) -> LinkCounters {
        self.link_counters
    }
}
