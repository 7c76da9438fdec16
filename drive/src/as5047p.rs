//! The AS5047P, a magnetic encoder of 14 bits on SPI (ams OSRAM, data sheet DS000324 "AS5047P", version 1-09 and later).
//!
//! SPI mode 1, most significant bit first, up to 10 MHz, 16 bits a frame, with the select line high for
//! 350 ns between two and low for as long before the first clock.
//! A command is executed when the line rises, and answered in the next frame:
//!
//! | frame | bit 15 | bit 14 | bits 13 to 0 |
//! |---|---|---|---|
//! | command | even parity of the rest | 1 to read, 0 to write | address |
//! | answer | even parity of the rest | error flag: a command before was faulty | data |
//!
//! | register | address | what |
//! |---|---|---|
//! | NOP | 0x0000 | nothing |
//! | ERRFL | 0x0001 | frame (0), command (1) and parity (2) error; cleared by reading, which clears the error flag, too |
//! | DIAAGC | 0x3FFC | gain 0 to 255 (7 to 0), offset loops ready LF (8), CORDIC overflow COF (9), field too strong MAGH (10), too weak MAGL (11) |
//! | ANGLECOM | 0x3FFF | angle, compensated for the speed |
//!
//! A line that hangs low answers 0x0000, which has even parity and no error flag and would pass for an angle of zero; its DIAAGC,
//! however, says that the loops are not ready. A line that hangs high answers 0xFFFF: its error flag is set. So both are told
//! by the pair of words that [`As5047p::read`] brings at each tick.

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{Operation, SpiDevice};

use crate::faults::Faults;

/// Reads ANGLECOM: 0x3FFF with the read bit is fifteen ones, so parity makes it sixteen.
pub const READ_ANGLE: u16 = read_command(0x3fff);
/// Reads DIAAGC.
pub const READ_DIAGNOSTICS: u16 = read_command(0x3ffc);
/// Reads ERRFL, which clears it.
pub const READ_ERRORS: u16 = read_command(0x0001);

/// Counts of a turn.
pub const COUNTS: u16 = 1 << 14;

const DATA: u16 = COUNTS - 1;
const ERROR_FLAG: u16 = 1 << 14;
const LOOPS_READY: u16 = 1 << 8;
const OVERFLOW: u16 = 1 << 9;
const TOO_STRONG: u16 = 1 << 10;
const TOO_WEAK: u16 = 1 << 11;

/// Nanoseconds that the select line is high between two frames, tCSn, and low before the first clock, tL.
const PAUSE_NS: u32 = 350;

/// The command that reads `address`, with its parity.
pub const fn read_command(address: u16) -> u16 {
    with_parity(1 << 14 | address & DATA)
}

/// `word` with bit 15 such that the number of ones is even.
pub const fn with_parity(word: u16) -> u16 {
    let word = word & 0x7fff;
    if word.count_ones().is_multiple_of(2) { word } else { word | 1 << 15 }
}

/// What the two words of a tick say: the angle in counts, or why there is none.
///
/// # Errors
/// [`Faults::POSITION_PARITY`] where a word has odd parity; [`Faults::POSITION_ALARM`] where the error flag is set, the offset
/// loops are not ready, the CORDIC overflows, or the magnet is too near or too far.
pub fn angle(angle: u16, diagnostics: u16) -> Result<u16, Faults> {
    const SOUND: u16 = LOOPS_READY;
    if !angle.count_ones().is_multiple_of(2) || !diagnostics.count_ones().is_multiple_of(2) {
        return Err(Faults::POSITION_PARITY);
    }
    let state = diagnostics & (LOOPS_READY | OVERFLOW | TOO_STRONG | TOO_WEAK);
    if (angle | diagnostics) & ERROR_FLAG != 0 || state != SOUND {
        return Err(Faults::POSITION_ALARM);
    }
    Ok(angle & DATA)
}

/// The encoder on its bus.
#[derive(Debug)]
pub struct As5047p<SPI, D> {
    spi: SPI,
    delay: D,
    /// The error flag was set: the next spare frame clears it.
    complained: bool,
}

impl<SPI: SpiDevice<u8>, D: DelayNs> As5047p<SPI, D> {
    /// Takes the device. Nothing is sent: the encoder needs no setting up.
    pub fn new(spi: SPI, delay: D) -> Self {
        Self { spi, delay, complained: false }
    }

    /// The angle and the diagnostics, as the encoder sent them: two frames, whatever they hold.
    ///
    /// The first asks for the angle, and brings what the last tick's second frame asked for; the second brings the angle
    /// as it was when the first one ended, and asks for the diagnostics, or after a complaint for the errors, so that the
    /// encoder forgets them. What ERRFL answers is no diagnostics, and tells as such: its loops are not ready.
    ///
    /// # Errors
    /// The bus failed.
    pub fn read(&mut self) -> Result<(u16, u16), SPI::Error> {
        let spare = if self.complained { READ_ERRORS } else { READ_DIAGNOSTICS };
        let diagnostics = self.exchange(READ_ANGLE)?;
        let angle = self.exchange(spare)?;
        self.complained = (angle | diagnostics) & ERROR_FLAG != 0;
        Ok((angle, diagnostics))
    }

    fn exchange(&mut self, command: u16) -> Result<u16, SPI::Error> {
        self.delay.delay_ns(PAUSE_NS);
        let mut frame = command.to_be_bytes();
        self.spi.transaction(&mut [Operation::DelayNs(PAUSE_NS), Operation::TransferInPlace(&mut frame)])?;
        Ok(u16::from_be_bytes(frame))
    }

    /// The bus.
    pub fn release(self) -> (SPI, D) {
        (self.spi, self.delay)
    }
}
