//! Decodes the requests of the host: any bytes end in a request that can be carried out, or in a count.

use crate::cycle::Order;
use crate::framing::{LinkCounters, Receiver};
use crate::input::{INPUT_BYTES, Input};
use crate::link::{Command, FEED, Request, Source, Streams};
use crate::settings::Settings;
use crate::trajectory::POINTS;
use crate::trajectory_config::TrajectoryConfig;

/// What a request comes down to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DecodedRequest {
    /// A sign of life of the host.
    Alive,
    /// The identity.
    Identity,
    /// The calibration.
    Calibration,
    /// The settings.
    Settings,
    /// The counters.
    Counters,
    /// Other settings; whether they can be is seen when they are built.
    Choose(Settings),
    /// An order.
    Order(Order),
    /// Other streams.
    Stream(Streams),
    /// Another source.
    Source(Source),
    /// Inputs, the first so many.
    Feed([Input; FEED], usize),
    /// A trajectory to be prepared; whether it can be is seen then.
    Prepare(TrajectoryConfig),
    /// References, the first so many.
    Points([f32; POINTS], usize),
    /// Begin to follow, or end.
    Follow(bool),
    /// Where the trajectory stands.
    Trajectory,
}

/// Decodes the bytes of the line.
#[derive(Debug, Clone, Default)]
pub struct RequestDecoder {
    receiver: Receiver,
}

impl RequestDecoder {
    /// Before the first byte.
    pub const fn new() -> Self {
        Self { receiver: Receiver::new() }
    }

    /// Takes a byte; returns the number and the content of a request where it completes a valid one.
    pub fn push(&mut self, byte: u8) -> Option<(u16, DecodedRequest)> {
        if !self.receiver.push(byte) {
            return None;
        }
        let request = self
            .receiver
            .message::<Request<'_>>()
            .and_then(|request| Some((request.number, decoded(&request.command)?)));
        if request.is_none() {
            self.receiver.refuse();
        }
        request
    }

    /// Counts a request that could not be carried out.
    pub fn refuse(&mut self) {
        self.receiver.refuse();
    }

    /// The counts.
    pub fn link_counters(&self) -> LinkCounters {
        self.receiver.link_counters()
    }
}

fn decoded(command: &Command<'_>) -> Option<DecodedRequest> {
    Some(match *command {
        Command::Alive => DecodedRequest::Alive,
        Command::Identify => DecodedRequest::Identity,
        Command::Calibration => DecodedRequest::Calibration,
        Command::Settings => DecodedRequest::Settings,
        Command::Counters => DecodedRequest::Counters,
        Command::Choose(settings) => DecodedRequest::Choose(settings),
        Command::Order(order) => DecodedRequest::Order(order),
        Command::Stream(streams) => DecodedRequest::Stream(streams),
        Command::Source(source) => DecodedRequest::Source(source),
        Command::Feed(bytes) => return feed(bytes),
        Command::Prepare(config) => DecodedRequest::Prepare(config),
        Command::Points(bytes) => return points(bytes),
        Command::Follow(begin) => DecodedRequest::Follow(begin),
        Command::Trajectory => DecodedRequest::Trajectory,
    })
}

fn feed(bytes: &[u8]) -> Option<DecodedRequest> {
    let (whole, rest) = bytes.as_chunks::<INPUT_BYTES>();
    let fits = rest.is_empty() && (1..=FEED).contains(&whole.len());
    let mut inputs = [Input::NOTHING; FEED];
    inputs.iter_mut().zip(whole).for_each(|(to, from)| *to = Input::from(*from));
    fits.then_some(DecodedRequest::Feed(inputs, whole.len()))
}

fn points(bytes: &[u8]) -> Option<DecodedRequest> {
    let (whole, rest) = bytes.as_chunks::<4>();
    let fits = rest.is_empty() && (1..=POINTS).contains(&whole.len());
    let mut points = [0.0; POINTS];
    points.iter_mut().zip(whole).for_each(|(to, from)| *to = f32::from_le_bytes(*from));
    fits.then_some(DecodedRequest::Points(points, whole.len()))
}
