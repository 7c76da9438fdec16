//! One pass through the code that is measured: ticks, cycles and stack, and the labels that a plugin counts between.

use core::arch::global_asm;
use core::ffi::c_void;

use cortex_m::Peripherals;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{DWT, SYST};
use semihosting::fs::File;
use semihosting::io::Write;
use stm32f4xx_hal::pac;

use crate::board::start_clock;
use crate::recording::{self, Fault, Recording};

/// What can be measured. It runs between the two labels by a call without inlining, so that the call is the same for all.
pub trait Work {
    /// The work.
    fn work(&mut self);
}

/// What one pass took.
#[repr(C)]
#[derive(Default)]
struct Reading {
    before: u32,
    after: u32,
    cycles_before: u32,
    cycles_after: u32,
    stack: u32,
}

// `palpate_pass(function, argument, reading)`: paints 2 KiB below the stack pointer, reads both counters, calls
// `function(argument)`, reads both again, and looks how far the paint is gone.
global_asm!(
    ".section .text.palpate_pass, \"ax\"",
    ".global palpate_pass, palpate_begin, palpate_end, palpate_case",
    ".thumb_func",
    "palpate_pass:",
    "push {{r4-r10, lr}}",
    "mov r4, r0",
    "mov r8, r2",
    "sub r0, sp, #2048",
    "movw r3, #0xa5a5",
    "movt r3, #0xa5a5",
    "1: str r3, [r0], #4",
    "cmp r0, sp",
    "bne 1b",
    "mov r0, r1",
    "movw r5, #0xe018",
    "movt r5, #0xe000",
    "movw r9, #0x1004",
    "movt r9, #0xe000",
    "ldr r10, [r9]",
    "ldr r6, [r5]",
    "palpate_begin:",
    "blx r4",
    "palpate_end:",
    "ldr r7, [r5]",
    "ldr r4, [r9]",
    "str r6, [r8]",
    "str r7, [r8, #4]",
    "str r10, [r8, #8]",
    "str r4, [r8, #12]",
    "sub r0, sp, #2048",
    "movw r3, #0xa5a5",
    "movt r3, #0xa5a5",
    "2: ldr r2, [r0]",
    "cmp r2, r3",
    "bne 3f",
    "adds r0, #4",
    "cmp r0, sp",
    "bne 2b",
    "3: sub r2, sp, r0",
    "str r2, [r8, #16]",
    "pop {{r4-r10, pc}}",
    ".thumb_func",
    "palpate_case:",
    "bx lr",
);

// SAFETY: both are the functions above, which keep the procedure call standard.
unsafe extern "C" {
    fn palpate_pass(function: extern "C" fn(*mut c_void), argument: *mut c_void, reading: *mut Reading);
    safe fn palpate_case();
}

extern "C" fn call<W: Work>(work: *mut c_void) {
    // SAFETY: `Gauge::pass` passes its exclusive reference to a `W`.
    unsafe { &mut *work.cast::<W>() }.work();
}

/// The counters, and the file that takes what they read.
pub struct Gauge {
    out: File,
    clock: SYST,
}

impl Gauge {
    /// Starts the counters.
    pub fn start() -> Result<Self, Fault> {
        start_clock(pac::Peripherals::take().ok_or("the peripherals are taken")?);
        let mut core = Peripherals::take().ok_or("the core's peripherals are taken")?;
        core.SYST.set_clock_source(SystClkSource::Core);
        core.SYST.set_reload(0x00ff_ffff);
        core.SYST.clear_current();
        core.SYST.enable_counter();
        core.DCB.enable_trace();
        if DWT::has_cycle_counter() {
            core.DWT.enable_cycle_counter();
        }
        let out = File::create(c"profile.out").map_err(|_| "cannot create profile.out in the folder it was run in")?;
        Ok(Self { out, clock: core.SYST })
    }

    /// Tells that another estimator begins: its name, its window (0 where it has none), the bytes of its state and ring.
    pub fn case(&mut self, name: &str, window: u16, state: usize, ring: usize) -> Result<(), Fault> {
        palpate_case();
        let mut line = heapless::String::<96>::new();
        core::fmt::write(&mut line, format_args!("case {name} {window} {state} {ring}\n"))
            .map_err(|_| "a long name")?;
        self.write(&line)
    }

    /// One pass of `work`, and what it took.
    pub fn pass<W: Work>(&mut self, work: &mut W) -> Result<(), Fault> {
        let mut reading = Reading::default();
        // So that it does not run through zero on the way.
        self.clock.clear_current();
        let argument = core::ptr::from_mut(work).cast::<c_void>();
        // SAFETY: `call::<W>` gets back the exclusive reference to a `W` that `argument` was made of, and both references
        // outlive the call. The stack below is nobody's: no interrupt is enabled.
        unsafe { palpate_pass(call::<W>, argument, &raw mut reading) };
        let ticks = reading.before.wrapping_sub(reading.after) & 0x00ff_ffff;
        let cycles = reading.cycles_after.wrapping_sub(reading.cycles_before);
        let mut line = heapless::String::<48>::new();
        let written = core::fmt::write(&mut line, format_args!("{ticks} {cycles} {}\n", reading.stack));
        written.map_err(|_| "a long line")?;
        self.write(&line)
    }

    fn write(&mut self, line: &str) -> Result<(), Fault> {
        self.out.write_all(line.as_bytes()).map_err(|_| "cannot write profile.out")
    }
}

/// All of an image: `cases` over the recording, which the folder it runs in holds.
pub fn measure(cases: fn(&Recording, Gauge) -> Result<(), Fault>) -> ! {
    match recording::read().and_then(|recording| Gauge::start().and_then(|gauge| cases(&recording, gauge))) {
        Ok(()) => semihosting::process::exit(0),
        Err(fault) => {
            semihosting::eprintln!("{fault}");
            semihosting::process::exit(1)
        }
    }
}
