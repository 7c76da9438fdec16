//! The ADS8681, an analogue-to-digital converter of 16 bits on SPI for signals of either sign (Texas Instruments, data sheet
//! SBAS633E; the ADS8685 and ADS8689 differ in their speed alone): what a bridge amplifier of a force sensor is wired to.
//!
//! SPI mode 0, most significant bit first, up to 66.67 MHz, 32 bits a frame. A rising select line begins a conversion, which takes
//! at most 665 ns; the next frame brings it. Commands (table 7-5) are a byte of operation, a byte of address and a
//! half-word: 0xD0 writes, 0xC8 reads, all zero does nothing.
//!
//! | register | address | what is written |
//! |---|---|---|
//! | DATAOUT_CTL_REG | 0x10 | 0x7D08: each frame carries device address, range, both alarms of the supply, both of the input, parity |
//! | RANGE_SEL_REG | 0x14 | the range, internal reference of 4.096 V |
//!
//! The word of a frame, with all of that included (table 7-6):
//!
//! | bits 31 to 16 | 15 to 12 | 11 to 8 | 7, 6 | 5, 4 | 3 | 2 | 1, 0 |
//! |---|---|---|---|---|---|---|---|
//! | result, 0x8000 is zero volt | device address, 0 | range | supply alarms | input alarms | even parity of the result | even parity of bits 31 to 4 | 0 |
//!
//! In a frame of Texas Instruments' own (forum, "ADS8689: sampling data") with parity alone the result 0xA686 is followed by `11`:
//! odd in both, and the second does not count the first. A line that hangs low or high fails by its range.

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::SpiDevice;
use serde::{Deserialize, Serialize};

use crate::faults::Faults;

/// Span of the input. The code is the lower four bits of RANGE_SEL_REG.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub enum Range {
    /// 12.288 V to either side.
    Volts12 = 0b0000,
    /// 10.24 V to either side.
    Volts10 = 0b0001,
    /// 6.144 V to either side.
    Volts6 = 0b0010,
    /// 5.12 V to either side.
    Volts5 = 0b0011,
    /// 2.56 V to either side.
    Volts2 = 0b0100,
}

impl Range {
    /// Volts of one count.
    pub const fn volts_per_count(self) -> f32 {
        let span = match self {
            Self::Volts12 => 12.288,
            Self::Volts10 => 10.24,
            Self::Volts6 => 6.144,
            Self::Volts5 => 5.12,
            Self::Volts2 => 2.56,
        };
        span / 32_768.0
    }
}

const WRITE: u8 = 0xd0;
const READ: u8 = 0xc8;
const DATAOUT_CTL: u8 = 0x10;
const RANGE_SEL: u8 = 0x14;
const DATAOUT: u16 = 1 << 14 | 0b11 << 12 | 0b11 << 10 | 1 << 8 | 1 << 3;

/// Nanoseconds of a conversion at most, and some for the acquisition that follows.
const CONVERSION_NS: u32 = 1_000;

/// Counts at either end that are saturation.
const MARGIN: u16 = 8;

/// The word of a frame whose result is `code`, at `range`, without an alarm.
pub const fn word(code: u16, range: Range) -> u32 {
    let body = (code as u32) << 16 | (range as u32) << 8;
    let result = code.count_ones() & 1;
    body | result << 3 | (body.count_ones() & 1) << 2
}

/// The result of `word`, counts from zero volt; or why there is none.
///
/// # Errors
/// [`Faults::FORCE_PARITY`] where parity, address or range are not what they should be, [`Faults::FORCE_ALARM`] where the
/// converter complains of its supply, [`Faults::FORCE_SATURATED`] where of its input, or the code is at an end.
pub fn code(word: u32, range: Range) -> Result<i32, Faults> {
    let parity = |bits: u32, parity_bit: u32| (bits.count_ones() ^ (word >> parity_bit)) & 1 == 0;
    let fixed = word & 0xff03 == (range as u32) << 8;
    if !fixed || !parity(word >> 16, 3) || !parity(word >> 4, 2) {
        return Err(Faults::FORCE_PARITY);
    }
    if word >> 6 & 0b11 != 0 {
        return Err(Faults::FORCE_ALARM);
    }
    let result = (word >> 16) as u16;
    if word >> 4 & 0b11 != 0 || !(MARGIN..=u16::MAX - MARGIN).contains(&result) {
        return Err(Faults::FORCE_SATURATED);
    }
    Ok(i32::from(result) - 0x8000)
}

/// The converter on its bus.
#[derive(Debug)]
pub struct Ads8681<SPI, D> {
    spi: SPI,
    delay: D,
}

/// The converter did not take its settings: what it was sent and what it then read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SetUpFault<E> {
    /// The bus failed.
    Bus(E),
    /// A register reads otherwise than it was written.
    Register {
        /// Its address.
        address: u8,
        /// What was written.
        written: u16,
        /// What it reads.
        read: u16,
    },
}

impl<SPI: SpiDevice<u8>, D: DelayNs> Ads8681<SPI, D> {
    /// Takes the device.
    pub fn new(spi: SPI, delay: D) -> Self {
        Self { spi, delay }
    }

    /// Writes the settings and reads them back. To be called again where the converter lost its supply: it then
    /// answers without a range, which is a fault at every tick until this is done.
    ///
    /// # Errors
    /// The bus failed, or a register does not read what it was written.
    pub fn set_up(&mut self, range: Range) -> Result<(), SetUpFault<SPI::Error>> {
        for (address, written) in [(RANGE_SEL, range as u16), (DATAOUT_CTL, DATAOUT)] {
            let [high, low] = written.to_be_bytes();
            self.exchange([WRITE, address, high, low]).map_err(SetUpFault::Bus)?;
            self.exchange([READ, address, 0, 0]).map_err(SetUpFault::Bus)?;
            let read = (self.exchange([0; 4]).map_err(SetUpFault::Bus)? >> 16) as u16;
            if read != written {
                return Err(SetUpFault::Register { address, written, read });
            }
        }
        Ok(())
    }

    /// Begins a conversion; what the frame brings is the one before, of a millisecond ago, and is dropped.
    ///
    /// # Errors
    /// The bus failed.
    pub fn begin(&mut self) -> Result<(), SPI::Error> {
        self.exchange([0; 4]).map(drop)
    }

    /// The conversion begun before, as the converter sent it.
    ///
    /// # Errors
    /// The bus failed.
    pub fn read(&mut self) -> Result<u32, SPI::Error> {
        self.exchange([0; 4])
    }

    fn exchange(&mut self, mut frame: [u8; 4]) -> Result<u32, SPI::Error> {
        self.delay.delay_ns(CONVERSION_NS);
        self.spi.transfer_in_place(&mut frame)?;
        Ok(u32::from_be_bytes(frame))
    }

    /// The bus.
    pub fn release(self) -> (SPI, D) {
        (self.spi, self.delay)
    }
}
