//! An SPI device with bounded waiting, for use in an interrupt.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::{Error, ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_nb::nb;
use embedded_hal_nb::spi::FullDuplex;

/// Why a transaction failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BusFault {
    /// The peripheral did not answer within the polls that it is given.
    Timeout,
    /// The peripheral reported a fault.
    Bus(ErrorKind),
    /// The chip-select pin could not be set.
    Select,
}

impl Error for BusFault {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Timeout => ErrorKind::Other,
            Self::Bus(kind) => *kind,
            Self::Select => ErrorKind::ChipSelectFault,
        }
    }
}

/// One device alone on a bus.
///
/// `SpiBus` blocks until the peripheral answers, for ever where it does not: its clock gone, say, or a register upset. Here
/// every byte is given `polls` looks at the peripheral and no more, so that a transaction takes a bounded time whatever happens.
/// A fault of one transaction leaves nothing behind for the next: what was received late is read and dropped first.
#[derive(Debug)]
pub struct BoundedSpi<BUS, CS, D> {
    bus: BUS,
    select: CS,
    delay: D,
    polls: u16,
}

impl<BUS: FullDuplex<u8>, CS: OutputPin, D: DelayNs> BoundedSpi<BUS, CS, D> {
    /// Takes the bus and the pin, which it sets high. A byte takes 8 clocks of the bus; `polls` should be some ten times
    /// what that is in the core's instructions over ten.
    ///
    /// # Errors
    /// The pin could not be set.
    pub fn new(bus: BUS, mut select: CS, delay: D, polls: u16) -> Result<Self, BusFault> {
        select.set_high().map_err(|_| BusFault::Select)?;
        Ok(Self { bus, select, delay, polls })
    }

    /// The bus and the pin.
    pub fn release(self) -> (BUS, CS, D) {
        (self.bus, self.select, self.delay)
    }

    fn exchange(&mut self, byte: u8) -> Result<u8, BusFault> {
        let Self { bus, polls, .. } = self;
        poll(*polls, || bus.write(byte))?;
        poll(*polls, || bus.read())
    }

    fn operate(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), BusFault> {
        for operation in operations {
            match operation {
                Operation::Read(to) => to.iter_mut().try_for_each(|to| self.exchange(0).map(|got| *to = got))?,
                Operation::Write(from) => from.iter().try_for_each(|&byte| self.exchange(byte).map(drop))?,
                Operation::Transfer(to, from) => {
                    let from = from.iter().copied().chain(core::iter::repeat(0));
                    to.iter_mut().zip(from).try_for_each(|(to, byte)| self.exchange(byte).map(|got| *to = got))?;
                }
                Operation::TransferInPlace(words) => {
                    words.iter_mut().try_for_each(|word| self.exchange(*word).map(|got| *word = got))?;
                }
                Operation::DelayNs(time) => self.delay.delay_ns(*time),
            }
        }
        Ok(())
    }
}

/// Asks at most `polls` times.
fn poll<T, E: Error>(polls: u16, mut ask: impl FnMut() -> nb::Result<T, E>) -> Result<T, BusFault> {
    for _ in 0..polls {
        match ask() {
            Ok(done) => return Ok(done),
            Err(nb::Error::WouldBlock) => {}
            Err(nb::Error::Other(fault)) => return Err(BusFault::Bus(fault.kind())),
        }
    }
    Err(BusFault::Timeout)
}

impl<BUS, CS, D> ErrorType for BoundedSpi<BUS, CS, D> {
    type Error = BusFault;
}

impl<BUS: FullDuplex<u8>, CS: OutputPin, D: DelayNs> SpiDevice<u8> for BoundedSpi<BUS, CS, D> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), BusFault> {
        // A byte left over from a transaction that was given up.
        let _ = self.bus.read();
        self.select.set_low().map_err(|_| BusFault::Select)?;
        let done = self.operate(operations);
        let released = self.select.set_high().map_err(|_| BusFault::Select);
        done.and(released)
    }
}
