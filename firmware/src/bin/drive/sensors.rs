//! The sensors on their pins.

use cortex_m::peripheral::DWT;
use embedded_hal::delay::DelayNs;
use palpate_drive::ads8681::{Ads8681, Range};
use palpate_drive::as5047p::As5047p;
use palpate_drive::{BoundedSpi, EncoderCounter, Input, InputStatus, PositionSensor};
use stm32f4xx_hal::gpio::{Output, Pin};
use stm32f4xx_hal::pac::{SPI1, SPI3, TIM4};
use stm32f4xx_hal::spi::Spi;

use super::board::CLOCK_HZ;

/// Looks at the SPI for each byte: one takes 1.5 us (256 cycles) at 5.25 MHz, a look some 10 cycles.
pub const POLLS: u16 = 200;

/// Waits by counting instructions.
#[derive(Debug, Clone, Copy)]
pub struct Delay;

impl DelayNs for Delay {
    fn delay_ns(&mut self, ns: u32) {
        // At least so long; at 168 MHz a nanosecond is 0.168 cycles. Bounded, for callers ask for a microsecond at most.
        cortex_m::asm::delay((ns.min(1_000_000) * (CLOCK_HZ / 1_000_000)) / 1_000 + 1);
    }
}

/// The encoder, alone on SPI1.
pub type Encoder = As5047p<BoundedSpi<Spi<SPI1>, Pin<'A', 4, Output>, Delay>, Delay>;
/// The converter, alone on SPI3.
pub type Converter = Ads8681<BoundedSpi<Spi<SPI3>, Pin<'A', 15, Output>, Delay>, Delay>;

/// A timer that counts a quadrature encoder.
pub struct Timer(pub TIM4);

impl EncoderCounter for Timer {
    fn count(&mut self) -> u16 {
        self.0.cnt().read().cnt().bits()
    }
}

/// All sensors.
pub struct Sensors {
    /// Which of the two encoders counts.
    pub position: PositionSensor,
    /// The magnetic encoder.
    pub encoder: Encoder,
    /// The quadrature encoder.
    pub timer: Timer,
    /// The converter of the force.
    pub converter: Converter,
    /// Span of the converter.
    pub range: Range,
    /// Readings of the converter in a row that were none.
    pub failed: u8,
    /// Cycles of the core at the reading before; the counter that QEMU does not have.
    pub before: Option<u32>,
}

impl Sensors {
    /// Failed readings after which the converter is set up anew: it may have lost its supply meanwhile.
    const PATIENCE: u8 = 100;

    /// One reading of all: four frames of SPI, and six more once in a hundred ticks while the converter fails.
    pub fn read(&mut self) -> Input {
        let mut status = InputStatus::empty();
        // The force is held from here on, the angle some microseconds later.
        let begun = self.converter.begin().is_ok();
        let (angle, diagnostics) = match self.position {
            PositionSensor::Quadrature => (self.timer.count(), 0),
            PositionSensor::As5047p => self.encoder.read().unwrap_or_else(|_| {
                status |= InputStatus::NO_POSITION;
                (0, 0)
            }),
        };
        let force = self.converter.read().ok().filter(|_| begun).unwrap_or_else(|| {
            status |= InputStatus::NO_FORCE;
            0
        });
        self.look_after_the_converter(force);
        Input { angle, diagnostics, force, elapsed: self.elapsed(), status }
    }

    fn look_after_the_converter(&mut self, force: u32) {
        use palpate_drive::Faults;
        let sound =
            !matches!(palpate_drive::ads8681::code(force, self.range), Err(fault) if fault == Faults::FORCE_PARITY);
        self.failed = if sound { 0 } else { self.failed + 1 };
        if self.failed >= Self::PATIENCE {
            self.failed = 0;
            let _ = self.converter.set_up(self.range);
        }
    }

    /// Ticks since the reading before, by the cycle counter; 1 without one.
    fn elapsed(&mut self) -> u8 {
        const TICK: u32 = CLOCK_HZ / 1_000;
        let now = DWT::cycle_count();
        let Some(before) = self.before.as_mut() else { return 1 };
        let ticks = (now.wrapping_sub(*before) + TICK / 2) / TICK;
        *before = now;
        ticks.clamp(1, 255) as u8
    }
}
