//! Clocks of the board, or of what stands in for it.

use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Config;

/// Core clock of the image, in Hz.
pub const CLOCK_HZ: u32 = 168_000_000;

/// Brings the core to [`CLOCK_HZ`] from the internal oscillator. Under QEMU there is nothing to do, and the wait for the
/// PLL would never end; QEMU is recognised by a debug unit that reads zero.
pub fn start_clock(peripherals: pac::Peripherals) -> &'static str {
    if peripherals.DBGMCU.idcode().read().bits() == 0 {
        return "QEMU";
    }
    let _ = peripherals.RCC.freeze(Config::hsi().sysclk(CLOCK_HZ.Hz()));
    "STM32F405"
}
