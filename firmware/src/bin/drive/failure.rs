//! Ends: a panic and a hard fault leave a mark where a reset does not clear it, and reset.

use core::mem::MaybeUninit;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};

const CRASHED: u32 = 0x5041_4c50;

// SAFETY: the section is left alone by the start-up code, and every value is one of an `AtomicU32`.
#[unsafe(link_section = ".uninit.palpate")]
static MARK: MaybeUninit<AtomicU32> = MaybeUninit::uninit();

fn mark() -> &'static AtomicU32 {
    // SAFETY: any bits that the memory holds are an `AtomicU32`.
    unsafe { MARK.assume_init_ref() }
}

/// Whether the last reset came from here; asked once.
pub fn crashed() -> bool {
    mark().swap(0, Ordering::Relaxed) == CRASHED
}

fn restart() -> ! {
    mark().store(CRASHED, Ordering::Relaxed);
    cortex_m::asm::dsb();
    SCB::sys_reset()
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    cortex_m::interrupt::disable();
    if let Some(place) = info.location() {
        defmt::error!("panic at {=str}:{=u32}", place.file(), place.line());
    }
    restart()
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    defmt::error!("hard fault at {=u32:#x}", frame.pc());
    restart()
}
