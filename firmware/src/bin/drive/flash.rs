//! What stands in flash: the calibration, in a sector of its own, and the image itself.

use core::ptr::addr_of;
use core::slice;

use palpate_drive::{CALIBRATION_BYTES, Calibration, CalibrationFault};

/// Sector 11, the last 128 KiB of the megabyte; `memory.x` leaves it out, so flashing an image leaves it alone.
const CALIBRATION: usize = 0x080e_0000;
const IMAGE: usize = 0x0800_0000;

/// The calibration, or why there is none.
pub fn calibration() -> Result<Calibration, CalibrationFault> {
    // SAFETY: the address is in flash, mapped for as long as the chip runs, and nothing writes to it.
    let block = unsafe { slice::from_raw_parts(CALIBRATION as *const u8, 2 * CALIBRATION_BYTES) };
    Calibration::read(block)
}

/// CRC-32 of the image, from the vectors to the last initial value.
pub fn image() -> u32 {
    unsafe extern "C" {
        static __sidata: u32;
        static __sdata: u32;
        static __edata: u32;
    }
    let end = addr_of!(__sidata) as usize + (addr_of!(__edata) as usize - addr_of!(__sdata) as usize);
    // SAFETY: the linker puts the image there without a hole, and nothing writes to flash.
    let image = unsafe { slice::from_raw_parts(IMAGE as *const u8, end.saturating_sub(IMAGE)) };
    crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(image)
}
