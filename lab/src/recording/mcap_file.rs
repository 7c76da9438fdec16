//! MCAP: topics of ROS 2, each with a clock of its own.

use std::collections::BTreeMap;
use std::io::Read as _;

use mcap::read::{LinearReader, Options};
use mcap::records::Record;

use super::data_file::{Channel, Content};
use super::ros_message::MessageType;
use crate::error::InputError;

/// No chunk of a recording is as large; a forged header is.
const MAX_CHUNK_BYTES: u64 = 1 << 30;

/// The channels of the topics in `bytes`: `/joint_states:elbow.position`, `/wrench:force.z`.
///
/// A value's instant is the stamp of its message's header, or the time of logging where that is zero; seconds since the earliest in
/// the file. A file that ends early, as that of a recorder that was killed does, is read as far as it goes.
///
/// # Errors
/// A damaged file, or a message that cannot be decoded.
pub fn channels(place: &str, bytes: &[u8]) -> Result<Vec<Channel>, InputError> {
    let mut topics = Topics {
        place,
        types: BTreeMap::new(),
        series: BTreeMap::new(),
        other: BTreeMap::new(),
        schemas: BTreeMap::new(),
    };
    let reader = LinearReader::new_with_options(bytes, Options::IgnoreEndMagic.into());
    for record in reader.map_err(|error| topics.fault("", error))? {
        match record {
            Ok(Record::Chunk { header, data }) => {
                let chunk = decompressed(&header.compression, header.uncompressed_size, &data)
                    .map_err(|what| topics.fault("", what))?;
                for record in LinearReader::sans_magic(&chunk) {
                    topics.take(record.map_err(|error| topics.fault("", error))?)?;
                }
            }
            Ok(Record::DataEnd(_)) => break,
            Ok(record) => topics.take(record)?,
            Err(mcap::McapError::UnexpectedEof) => break,
            Err(error) => return Err(topics.fault("", error)),
        }
    }
    Ok(topics.into_channels())
}

struct Topics<'a> {
    place: &'a str,
    schemas: BTreeMap<u16, String>,
    /// Topic, and the type of its messages where that is known, by the file's number of it.
    types: BTreeMap<u16, (String, Option<MessageType>)>,
    /// Instant in nanoseconds and value, by the channel's name.
    series: BTreeMap<String, Vec<(i64, f64)>>,
    /// What a topic holds whose messages are not read, by its name.
    other: BTreeMap<String, String>,
}

impl Topics<'_> {
    fn fault(&self, topic: &str, found: impl std::fmt::Display) -> InputError {
        let place = if topic.is_empty() { self.place.to_owned() } else { format!("{}: {topic}", self.place) };
        InputError::new(place, found, "MCAP with messages of ROS 2 in CDR")
    }

    fn take(&mut self, record: Record<'_>) -> Result<(), InputError> {
        match record {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id).map_or("no schema", String::as_str);
                let is_cdr = channel.message_encoding == "cdr";
                let message = MessageType::of(schema).filter(|_| is_cdr);
                if message.is_none() {
                    let what = format!("messages of {schema} in {}, which are not read", channel.message_encoding);
                    self.other.insert(channel.topic.clone(), what);
                }
                self.types.insert(channel.id, (channel.topic, message));
            }
            Record::Message { header, data } => {
                let Some((topic, Some(message))) = self.types.get(&header.channel_id) else { return Ok(()) };
                let fields =
                    message.decode(&data).map_err(|what| self.fault(topic, format!("a message with {what}")))?;
                let instant = fields.stamp_ns.unwrap_or(i64::try_from(header.log_time).unwrap_or(i64::MAX));
                for (field, value) in fields.values {
                    self.series.entry(format!("{topic}:{field}")).or_default().push((instant, value));
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn into_channels(self) -> Vec<Channel> {
        let start = self.series.values().flatten().map(|(instant, _)| *instant).min().unwrap_or(0);
        let channel = |(name, mut samples): (String, Vec<(i64, f64)>)| {
            // Messages may be logged out of order; of two with one stamp the later stands.
            samples.sort_by_key(|(instant, _)| *instant);
            samples.dedup_by(|later, earlier| {
                let is_same = later.0 == earlier.0;
                if is_same {
                    earlier.1 = later.1;
                }
                is_same
            });
            let clock = samples.iter().map(|(instant, _)| (instant - start) as f64 * 1e-9).collect();
            let values = samples.into_iter().map(|(_, value)| value).collect();
            Channel { name, content: Content::Numbers(values), clock: Some(clock) }
        };
        let other = self.other.into_iter().map(|(name, what)| Channel::other(name, what));
        self.series.into_iter().map(channel).chain(other).collect()
    }
}

fn decompressed(compression: &str, size: u64, data: &[u8]) -> Result<Vec<u8>, String> {
    let size = usize::try_from(size.min(MAX_CHUNK_BYTES)).unwrap_or(usize::MAX);
    let mut chunk = Vec::with_capacity(size.min(1 << 24));
    match compression {
        "" => return Ok(data.to_vec()),
        "zstd" => {
            let mut decoder =
                ruzstd::decoding::StreamingDecoder::new(data).map_err(|error| format!("a damaged chunk ({error})"))?;
            decoder.by_ref().take(size as u64).read_to_end(&mut chunk)
        }
        "lz4" => lz4_flex::frame::FrameDecoder::new(data).take(size as u64).read_to_end(&mut chunk),
        other => return Err(format!("compression {other}, where zstd, lz4 and none are read")),
    }
    .map_err(|error| format!("a damaged chunk ({error})"))?;
    Ok(chunk)
}
