//! Where requests are taken in: whatever the bytes, a wish that can be granted, or a count.

use crate::cycle::Order;
use crate::framing::{Receiver, Tally};
use crate::input::{INPUT_BYTES, Input};
use crate::link::{Command, FEED, Request, Source, Streams};
use crate::settings::Settings;

/// What a request comes down to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wish {
    /// To be known of.
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
}

/// Takes the bytes of the line.
#[derive(Debug, Clone, Default)]
pub struct Desk {
    receiver: Receiver,
}

impl Desk {
    /// Nothing was heard yet.
    pub const fn new() -> Self {
        Self { receiver: Receiver::new() }
    }

    /// Takes a byte; the wish and the number of its request where one is whole and can be.
    pub fn hear(&mut self, byte: u8) -> Option<(u16, Wish)> {
        if !self.receiver.push(byte) {
            return None;
        }
        let wish =
            self.receiver.message::<Request<'_>>().and_then(|request| Some((request.number, wish(&request.command)?)));
        if wish.is_none() {
            self.receiver.refuse();
        }
        wish
    }

    /// Counts a wish that could not be granted.
    pub fn refuse(&mut self) {
        self.receiver.refuse();
    }

    /// The counts.
    pub fn tally(&self) -> Tally {
        self.receiver.tally()
    }
}

fn wish(command: &Command<'_>) -> Option<Wish> {
    Some(match *command {
        Command::Alive => Wish::Alive,
        Command::Identify => Wish::Identity,
        Command::Calibration => Wish::Calibration,
        Command::Settings => Wish::Settings,
        Command::Counters => Wish::Counters,
        Command::Choose(settings) => Wish::Choose(settings),
        Command::Order(order) => Wish::Order(order),
        Command::Stream(streams) => Wish::Stream(streams),
        Command::Source(source) => Wish::Source(source),
        Command::Feed(bytes) => return feed(bytes),
    })
}

fn feed(bytes: &[u8]) -> Option<Wish> {
    let (whole, rest) = bytes.as_chunks::<INPUT_BYTES>();
    let fits = rest.is_empty() && (1..=FEED).contains(&whole.len());
    let mut inputs = [Input::NOTHING; FEED];
    inputs.iter_mut().zip(whole).for_each(|(to, from)| *to = Input::from(*from));
    fits.then_some(Wish::Feed(inputs, whole.len()))
}
