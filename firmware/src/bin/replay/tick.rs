//! The interrupt: one sample in, one update, one record out.

use core::ptr;
use core::sync::atomic::{AtomicPtr, AtomicU32, Ordering};

use cortex_m::peripheral::SCB;
use cortex_m_rt::exception;
use heapless::spsc::{Consumer, Producer};
use palpate::{EstimatorBank, Sample};
use palpate_drive::replay_format::{ReplayCounters, UpdateResult};

/// Samples that wait for the interrupt. One place of a queue stays empty, so this holds two blocks of the idle loop.
pub const QUEUE: usize = 129;
/// Outcomes that wait for the idle loop, each 292 bytes.
pub const OUTCOMES: usize = 65;

/// What the interrupt owns.
pub struct Tick {
    /// The estimators.
    pub bench: EstimatorBank,
    /// Samples from the idle loop.
    pub input: Consumer<'static, Sample, QUEUE>,
    /// Outcomes to the idle loop.
    pub output: Producer<'static, UpdateResult, OUTCOMES>,
}

static TICK: AtomicPtr<Tick> = AtomicPtr::new(ptr::null_mut());

static SAMPLES: AtomicU32 = AtomicU32::new(0);
static TICKS: AtomicU32 = AtomicU32::new(0);
static OVERRUNS: AtomicU32 = AtomicU32::new(0);
static STARVED: AtomicU32 = AtomicU32::new(0);

impl Tick {
    /// Gives `self` to the interrupt for good.
    pub fn hand_over(&'static mut self) {
        TICK.store(self, Ordering::Release);
    }

    fn run(&mut self) {
        // Room is made sure of before the sample is taken, so that no outcome is ever dropped.
        let sample = if self.output.ready() { self.input.dequeue() } else { None };
        let Some(sample) = sample else {
            count(&STARVED);
            return;
        };
        let outcome = self.bench.update(sample);
        if self.output.enqueue(outcome).is_ok() {
            count(&SAMPLES);
        }
    }
}

/// Only the interrupt writes the counters, so a load and a store are as good as a read-modify-write.
fn count(counter: &AtomicU32) {
    counter.store(counter.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// The counters so far.
pub fn counters() -> ReplayCounters {
    ReplayCounters {
        samples: SAMPLES.load(Ordering::Relaxed),
        ticks: TICKS.load(Ordering::Relaxed),
        overruns: OVERRUNS.load(Ordering::Relaxed),
        starved: STARVED.load(Ordering::Relaxed),
    }
}

#[exception]
fn SysTick() {
    // SAFETY: the pointer is null or comes from the `&'static mut` that `hand_over` took and nobody else holds; SysTick
    // does not preempt itself, so this is the only reference while it lives.
    let tick = unsafe { TICK.load(Ordering::Acquire).as_mut() };
    if let Some(tick) = tick {
        count(&TICKS);
        tick.run();
        if SCB::is_pendst_pending() {
            count(&OVERRUNS);
        }
    }
}
