//! The serial line: bytes in by an interrupt, bytes out by the idle loop.

use core::ptr;
use core::sync::atomic::{AtomicPtr, AtomicU32, Ordering};

use embedded_hal_nb::nb;
use embedded_hal_nb::serial::{Read as _, Write as _};
use heapless::spsc::{Consumer, Producer};
use stm32f4xx_hal::pac::{USART1, interrupt};
use stm32f4xx_hal::serial::{Rx, Tx};

/// Bytes that wait for the idle loop: 11 ms of the line.
pub const RX_QUEUE: usize = 1_024;

/// What the interrupt of the line owns.
pub struct UartReceiver {
    /// The receiver.
    pub receiver: Rx<USART1>,
    /// Bytes to the idle loop.
    pub received: Producer<'static, u8, RX_QUEUE>,
}

static UART_RECEIVER: AtomicPtr<UartReceiver> = AtomicPtr::new(ptr::null_mut());
static RX_OVERRUNS: AtomicU32 = AtomicU32::new(0);

impl UartReceiver {
    /// Gives `self` to the interrupt for good.
    pub fn hand_over(&'static mut self) {
        UART_RECEIVER.store(self, Ordering::Release);
    }

    /// One byte, or one fault: never a loop.
    fn receive_byte(&mut self) {
        let lost = match self.receiver.read() {
            Ok(byte) => self.received.enqueue(byte).is_err(),
            Err(nb::Error::WouldBlock) => false,
            Err(nb::Error::Other(_)) => true,
        };
        if lost {
            RX_OVERRUNS.store(RX_OVERRUNS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
        }
    }
}

/// Bytes that were lost on the way in.
pub fn rx_overruns() -> u32 {
    RX_OVERRUNS.load(Ordering::Relaxed)
}

#[interrupt]
fn USART1() {
    // SAFETY: the pointer is null or comes from the `&'static mut` that `hand_over` took and nobody else holds; an interrupt
    // does not preempt itself, so this is the only reference while it lives.
    if let Some(receiver) = unsafe { UART_RECEIVER.load(Ordering::Acquire).as_mut() } {
        receiver.receive_byte();
    }
}

/// The way out, and the queue of the way in.
pub struct Line {
    /// The sender.
    pub sender: Tx<USART1>,
    /// Bytes from the interrupt.
    pub received: Consumer<'static, u8, RX_QUEUE>,
}

impl Line {
    /// Sends `bytes`; a byte that the sender does not take within a millisecond is dropped, and the frame with it.
    pub fn send(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            let mut patience = 20_000_u16;
            while self.sender.write(byte).is_err() {
                patience -= 1;
                if patience == 0 {
                    return;
                }
            }
        }
    }
}
