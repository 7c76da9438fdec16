//! The host's end of the link.

use std::io::ErrorKind;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, bail};
use palpate_drive::Faults;
use palpate_drive::framing::{LINE_BYTES, LinkCounters, Receiver, encode};
use palpate_drive::link::{Command, CountersMessage, FEED, Message, Request, RequestOutcome, Streams};
use palpate_drive::{INPUT_BYTES, Input};

use super::port::Port;
use super::{DriveInfo, in_words};

/// How long an answer may take, and how often a request is sent. A drive answers within milliseconds; an emulator on a busy host
/// may take seconds.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(5);
const MAX_ATTEMPTS: u32 = 3;

/// How often a drive that may just have been started is called, and for how long.
const WAKE_INTERVAL: Duration = Duration::from_millis(200);
const MAX_WAKE_ATTEMPTS: u32 = 50;

/// What a drive without room is given: some ticks.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// A drive on a port.
pub struct Client {
    port: Box<dyn Port>,
    receiver: Receiver,
    number: u16,
    bytes: Vec<u8>,
}

impl Client {
    /// Speaks through `port`.
    #[must_use]
    pub fn new(port: Box<dyn Port>) -> Self {
        Self { port, receiver: Receiver::new(), number: 0, bytes: vec![0; 4_096] }
    }

    /// Sends a command without waiting for its answer; its number.
    ///
    /// # Errors
    /// The port is gone.
    pub fn send(&mut self, command: Command<'_>) -> Result<u16> {
        self.number = self.number.wrapping_add(1);
        let mut line = [0; LINE_BYTES];
        let frame = encode(&Request { number: self.number, command }, &mut line).context("the request is too long")?;
        self.write(frame)?;
        Ok(self.number)
    }

    /// Calls until the drive answers: one that has just been started hears nothing yet.
    ///
    /// # Errors
    /// The port is gone, or nobody answers.
    pub fn wake(&mut self) -> Result<()> {
        for _ in 0..MAX_WAKE_ATTEMPTS {
            let (sent, since) = (self.send(Command::Alive)?, Instant::now());
            let mut awake = false;
            while !awake && since.elapsed() < WAKE_INTERVAL {
                self.poll(|message| awake |= matches!(message, Message::Answer { number, .. } if number == sent))?;
            }
            if awake {
                return Ok(());
            }
        }
        bail!("nobody answers: is it a drive, and is this its speed?")
    }

    /// Sends bytes as they are.
    ///
    /// # Errors
    /// The port is gone.
    pub fn write(&mut self, bytes: &[u8]) -> Result<()> {
        self.port.write_all(bytes).and_then(|()| self.port.flush()).context("the drive's port is gone")
    }

    /// Takes what has come, or waits a little where nothing has.
    ///
    /// # Errors
    /// The port is gone.
    pub fn poll(&mut self, mut take: impl FnMut(Message<'_>)) -> Result<()> {
        let Self { port, receiver, bytes, .. } = self;
        let read = match port.read(bytes) {
            Ok(0) => bail!("the drive's port is closed"),
            Ok(read) => read,
            Err(error)
                if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted) =>
            {
                0
            }
            Err(error) => return Err(error).context("the drive's port is gone"),
        };
        for &byte in &bytes[..read] {
            if !receiver.push(byte) {
                continue;
            }
            match receiver.message() {
                Some(message) => take(message),
                None => receiver.refuse(),
            }
        }
        Ok(())
    }

    /// Sends a command and waits for how it went; what comes meanwhile goes to `take`.
    ///
    /// # Errors
    /// The port is gone, or no answer comes.
    pub fn request(&mut self, command: Command<'_>, mut take: impl FnMut(Message<'_>)) -> Result<RequestOutcome> {
        let sent = self.send(command)?;
        let since = Instant::now();
        let mut answer = None;
        while answer.is_none() {
            self.poll(|message| match message {
                Message::Answer { number, outcome } if number == sent => answer = Some(outcome),
                other => take(other),
            })?;
            if since.elapsed() > ANSWER_TIMEOUT {
                bail!("the drive does not answer");
            }
        }
        answer.context("the drive does not answer")
    }

    /// As [`Self::request`], a few times where there is no answer or no room: for what may be done twice.
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn ask(&mut self, command: Command<'_>, mut take: impl FnMut(Message<'_>)) -> Result<RequestOutcome> {
        let mut last = self.request(command, &mut take);
        for _ in 1..MAX_ATTEMPTS {
            if !matches!(last, Ok(RequestOutcome::NoRoom) | Err(_)) {
                break;
            }
            std::thread::sleep(POLL_INTERVAL);
            last = self.request(command, &mut take);
        }
        last
    }

    /// As [`Self::ask`], and nothing but done will do.
    ///
    /// # Errors
    /// As [`Self::request`], or the drive refuses `what`.
    pub fn demand(&mut self, command: Command<'_>, what: &str) -> Result<()> {
        match self.ask(command, |_| ())? {
            RequestOutcome::Done => Ok(()),
            other => bail!("the drive refuses {what}: {}", in_words(other)),
        }
    }

    /// Asks for silence, and drops what was under way.
    ///
    /// # Errors
    /// As [`Self::demand`].
    pub fn quiet(&mut self) -> Result<()> {
        self.demand(Command::Stream(Streams { estimates: 0, samples: false }), "silence")
    }

    /// Identity, calibration and settings of the drive.
    ///
    /// # Errors
    /// As [`Self::demand`].
    pub fn about(&mut self) -> Result<DriveInfo> {
        let (mut identity, mut calibrated, mut chosen) = (None, None, None);
        for command in [Command::Identify, Command::Calibration, Command::Settings] {
            self.ask(command, |message| match message {
                Message::Identity(i) => {
                    identity = Some((i.version.to_owned(), i.image, i.chip, i.emulator, i.reset, i.found));
                }
                Message::Calibration { calibration, scale } => calibrated = Some((calibration, scale)),
                Message::Settings { settings, revision } => chosen = Some((settings, revision)),
                _ => {}
            })?;
        }
        let (version, image, chip, emulator, reset, found) = identity.context("the drive does not tell what it is")?;
        let (calibration, scale) = calibrated.context("the drive does not tell its calibration")?;
        let (settings, revision) = chosen.context("the drive does not tell its settings")?;
        let found = Faults::from_bits_retain(found);
        Ok(DriveInfo { version, image, chip, emulator, reset, found, calibration, scale, settings, revision })
    }

    /// The drive's counters.
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn counters(&mut self) -> Result<CountersMessage> {
        let mut counters = None;
        self.ask(Command::Counters, |message| {
            if let Message::Counters(found) = message {
                counters = Some(found);
            }
        })?;
        counters.context("the drive does not tell its counters")
    }

    /// Ticks since the drive started; what comes meanwhile goes to `take`.
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn ticks(&mut self, mut take: impl FnMut(Message<'_>)) -> Result<u32> {
        let mut ticks = None;
        self.ask(Command::Counters, |message| match message {
            Message::Counters(found) => ticks = Some(found.others[0]),
            other => take(other),
        })?;
        ticks.context("the drive does not tell its ticks")
    }

    /// Feeds the first of `inputs` and returns the rest; all of them where the drive has no room.
    ///
    /// # Errors
    /// As [`Self::request`], or the drive is not in test mode.
    pub fn feed<'i>(&mut self, inputs: &'i [Input], take: impl FnMut(Message<'_>)) -> Result<&'i [Input]> {
        let (now, later) = inputs.split_at(inputs.len().min(FEED));
        let bytes: Vec<u8> = now.iter().flat_map(|input| <[u8; INPUT_BYTES]>::from(*input)).collect();
        match self.request(Command::Feed(&bytes), take)? {
            RequestOutcome::Done => Ok(later),
            RequestOutcome::NoRoom => {
                std::thread::sleep(POLL_INTERVAL);
                Ok(inputs)
            }
            other => bail!("the drive refuses what it is fed: {}", in_words(other)),
        }
    }

    /// What came that was no message.
    #[must_use]
    pub fn link_counters(&self) -> LinkCounters {
        self.receiver.link_counters()
    }
}
