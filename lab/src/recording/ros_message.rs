//! The two messages of ROS 2 that hold motion and force, in CDR (OMG DDS-XTypes, version 1), and their fields as channels.

use byteorder::{BigEndian, LittleEndian};
use serde::Deserialize;

/// Seconds and nanoseconds since 1970, or of a simulation's clock.
#[derive(Debug, Clone, Copy, Deserialize)]
struct Stamp {
    sec: i32,
    nanosec: u32,
}

#[derive(Debug, Clone, Deserialize)]
struct Header {
    stamp: Stamp,
    #[serde(rename = "frame_id")]
    _frame_id: String,
}

#[derive(Debug, Clone, Deserialize)]
struct JointState {
    header: Header,
    name: Vec<String>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    effort: Vec<f64>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
struct Vector3 {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Debug, Clone, Deserialize)]
struct WrenchStamped {
    header: Header,
    force: Vector3,
    torque: Vector3,
}

/// A message's own instant and its numbers by name.
pub struct Fields {
    /// Nanoseconds; `None` where nobody set it.
    pub stamp_ns: Option<i64>,
    /// `elbow.position`, `force.z`.
    pub values: Vec<(String, f64)>,
}

/// A message type whose fields are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MessageType {
    /// `sensor_msgs/msg/JointState`
    JointState,
    /// `geometry_msgs/msg/WrenchStamped`
    WrenchStamped,
}

impl MessageType {
    /// By the name of its schema.
    pub fn of(schema: &str) -> Option<Self> {
        match schema {
            "sensor_msgs/msg/JointState" | "sensor_msgs/JointState" => Some(Self::JointState),
            "geometry_msgs/msg/WrenchStamped" | "geometry_msgs/WrenchStamped" => Some(Self::WrenchStamped),
            _ => None,
        }
    }

    /// The fields of a message.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn decode(self, message: &[u8]) -> Result<Fields, String> {
        match self {
            Self::JointState => joint_state(&from_cdr(message)?),
            Self::WrenchStamped => Ok(wrench(&from_cdr(message)?)),
        }
    }
}

fn from_cdr<T: for<'de> Deserialize<'de>>(message: &[u8]) -> Result<T, String> {
    let (head, body) = message.split_first_chunk::<4>().ok_or("fewer bytes than the head of a message has")?;
    // The second byte of the head tells encoding and byte order.
    let decoded = match head[1] {
        0 => cdr_encoding::from_bytes::<T, BigEndian>(body),
        1 => cdr_encoding::from_bytes::<T, LittleEndian>(body),
        other => return Err(format!("encoding {other} of CDR, where plain CDR is 0 or 1")),
    };
    decoded.map(|(value, _)| value).map_err(|error| error.to_string())
}

fn stamp_ns(header: &Header) -> Option<i64> {
    let stamp = header.stamp;
    (stamp.sec != 0 || stamp.nanosec != 0).then(|| i64::from(stamp.sec) * 1_000_000_000 + i64::from(stamp.nanosec))
}

fn joint_state(message: &JointState) -> Result<Fields, String> {
    let columns = [("position", &message.position), ("velocity", &message.velocity), ("effort", &message.effort)];
    let mut values = Vec::new();
    for (field, numbers) in columns {
        // An empty list is how a message leaves a field out.
        if !numbers.is_empty() && numbers.len() != message.name.len() {
            return Err(format!("{} names and {} values of {field}", message.name.len(), numbers.len()));
        }
        values.extend(message.name.iter().zip(numbers).map(|(name, value)| (format!("{name}.{field}"), *value)));
    }
    Ok(Fields { stamp_ns: stamp_ns(&message.header), values })
}

fn wrench(message: &WrenchStamped) -> Fields {
    let (force, torque) = (message.force, message.torque);
    let values = [
        ("force.x", force.x),
        ("force.y", force.y),
        ("force.z", force.z),
        ("torque.x", torque.x),
        ("torque.y", torque.y),
        ("torque.z", torque.z),
    ];
    let values = values.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    Fields { stamp_ns: stamp_ns(&message.header), values }
}
