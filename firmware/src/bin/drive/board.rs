//! Clocks, pins and peripherals of the board, or of what stands in for it.

use cortex_m::peripheral::scb::SystemHandler;
use cortex_m::peripheral::syst::SystClkSource;
use embedded_hal::spi::MODE_0;
use embedded_hal::spi::MODE_1;
use palpate_drive::ads8681::Ads8681;
use palpate_drive::as5047p::As5047p;
use palpate_drive::link::BAUD;
use palpate_drive::{BoundedSpi, Calibration, Faults};
use stm32f4xx_hal::gpio::Speed;
use stm32f4xx_hal::pac::{self, PWR, USART1};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::qei::Qei;
use stm32f4xx_hal::rcc::{Config, Rcc};
use stm32f4xx_hal::serial::{self, Rx, Serial, Tx};
use stm32f4xx_hal::spi::Spi;
use stm32f4xx_hal::watchdog::IndependentWatchdog;

use super::failure;
use super::sensors::{Delay, POLLS, Sensors, Timer};

/// Core clock, in Hz.
pub const CLOCK_HZ: u32 = 168_000_000;
/// Cycles of the core in a tick.
pub const TICK_CYCLES: u32 = CLOCK_HZ / 1_000;
/// The crystal of the board, in Hz: 8 MHz on an ODrive v3 and a VESC 6.
const CRYSTAL_HZ: u32 = 8_000_000;
/// The priorities of line and tick, of 0 (highest) to 240 in steps of 16. A current loop goes below 0x80; the tick gives way to
/// both, for a byte lost is a frame lost, and taking one in is short.
const LINE_PRIORITY: u8 = 0x80;
const TICK_PRIORITY: u8 = 0xc0;
/// Milliseconds without a sign of the idle loop and the interrupt after which the watchdog resets.
const WATCHDOG_MS: u32 = 250;

/// What the image is made of.
pub struct Board {
    /// The sensors.
    pub sensors: Sensors,
    /// The supply's watch.
    pub supply: PWR,
    /// The watchdog, not yet started.
    pub watchdog: IndependentWatchdog,
    /// The way out.
    pub sender: Tx<USART1>,
    /// The way in.
    pub receiver: Rx<USART1>,
    /// The core's own peripherals.
    pub core: cortex_m::Peripherals,
    /// QEMU, recognised by a debug unit that reads zero.
    pub emulator: bool,
    /// The chip's own number.
    pub chip: [u32; 3],
    /// Bits 24 to 31 of RCC_CSR.
    pub reset: u8,
    /// What was found wrong.
    pub found: Faults,
}

impl Board {
    /// Sets everything up; `None` where somebody has the peripherals already, or the line's speed cannot be.
    pub fn start(calibration: &Calibration) -> Option<Self> {
        let mut core = cortex_m::Peripherals::take()?;
        let chip = pac::Peripherals::take()?;
        let emulator = chip.DBGMCU.idcode().read().bits() == 0;
        let mut found = Faults::empty();
        found.set(Faults::CRASH, failure::crashed());
        let reset = reset_reason(&chip.RCC);
        found.set(Faults::WATCHDOG, reset & (1 << 5 | 1 << 6) != 0);
        let mut rcc = clock(chip.RCC, emulator, &mut found);
        let a = chip.GPIOA.split(&mut rcc);
        let b = chip.GPIOB.split(&mut rcc);
        let c = chip.GPIOC.split(&mut rcc);

        let fast = Speed::High;
        let encoder = Spi::new(
            chip.SPI1,
            (Some(a.pa5.into_alternate().speed(fast)), Some(a.pa6), Some(a.pa7.into_alternate().speed(fast))),
            MODE_1,
            5.MHz(),
            &mut rcc,
        );
        let encoder = BoundedSpi::new(encoder, a.pa4.into_push_pull_output(), Delay, POLLS).ok()?;
        let converter = Spi::new(
            chip.SPI3,
            (Some(c.pc10.into_alternate().speed(fast)), Some(c.pc11), Some(c.pc12.into_alternate().speed(fast))),
            MODE_0,
            10.MHz(),
            &mut rcc,
        );
        let converter = BoundedSpi::new(converter, a.pa15.into_push_pull_output(), Delay, POLLS).ok()?;
        let mut converter = Ads8681::new(converter, Delay);
        // A converter that is not there is reported by every tick.
        let _ = converter.set_up(calibration.range);
        let (timer, _) = Qei::new(chip.TIM4, (b.pb6, b.pb7), &mut rcc).release();

        let speed = serial::Config::default().baudrate(BAUD.bps());
        let (sender, mut receiver) = Serial::new(chip.USART1, (a.pa9, a.pa10), speed, &mut rcc).ok()?.split();
        receiver.listen();

        // The programmable voltage detector, at its highest threshold (2.9 V falling).
        rcc.apb1enr().modify(|_, w| w.pwren().set_bit());
        // SAFETY: 7 is a level that the detector has.
        chip.PWR.cr().modify(|_, w| unsafe { w.pls().bits(7) }.pvde().set_bit());
        core.DCB.enable_trace();
        let cycles = cortex_m::peripheral::DWT::has_cycle_counter() && !emulator;
        if cycles {
            core.DWT.enable_cycle_counter();
        }
        let sensors = Sensors {
            position: calibration.position_sensor,
            encoder: As5047p::new(encoder, Delay),
            timer: Timer(timer),
            converter,
            range: calibration.range,
            failed: 0,
            before: cycles.then(cortex_m::peripheral::DWT::cycle_count),
        };
        Some(Self {
            sensors,
            supply: chip.PWR,
            watchdog: IndependentWatchdog::new(chip.IWDG),
            sender,
            receiver,
            core,
            emulator,
            chip: if emulator { [0; 3] } else { number() },
            reset,
            found,
        })
    }
}

/// Starts the watchdog.
pub fn watch(watchdog: &mut IndependentWatchdog) {
    watchdog.start(WATCHDOG_MS.millis());
}

/// Starts the tick and lets both interrupts in.
pub fn start_ticking(core: &mut cortex_m::Peripherals) {
    // SAFETY: no critical section of this image relies on a priority.
    unsafe {
        core.NVIC.set_priority(pac::Interrupt::USART1, LINE_PRIORITY);
        core.SCB.set_priority(SystemHandler::SysTick, TICK_PRIORITY);
        cortex_m::peripheral::NVIC::unmask(pac::Interrupt::USART1);
    }
    core.SYST.set_clock_source(SystClkSource::Core);
    core.SYST.set_reload(TICK_CYCLES - 1);
    core.SYST.clear_current();
    core.SYST.enable_interrupt();
    core.SYST.enable_counter();
}

/// Why the chip was reset, read once and cleared for the next time.
fn reset_reason(rcc: &pac::RCC) -> u8 {
    let reason = rcc.csr().read().bits();
    rcc.csr().modify(|_, w| w.rmvf().set_bit());
    (reason >> 24) as u8
}

/// The crystal, where it swings within a tenth of a second; else the internal oscillator, and a fault. Under QEMU nothing: the
/// wait for the PLL would never end.
fn clock(rcc: pac::RCC, emulator: bool, found: &mut Faults) -> Rcc {
    if emulator {
        return rcc.constrain();
    }
    rcc.cr().modify(|_, w| w.hseon().set_bit());
    let swings = (0..200_000).any(|_| rcc.cr().read().hserdy().bit_is_set());
    found.set(Faults::CLOCK, !swings);
    let source = if swings { Config::hse(CRYSTAL_HZ.Hz()) } else { Config::hsi() };
    rcc.freeze(source.sysclk(CLOCK_HZ.Hz()))
}

/// The 96 bits of the chip's own number (RM0090, 39.1).
fn number() -> [u32; 3] {
    const NUMBER: *const [u32; 3] = 0x1fff_7a10 as *const [u32; 3];
    // SAFETY: the chip has three words there that never change.
    unsafe { NUMBER.read_volatile() }
}
