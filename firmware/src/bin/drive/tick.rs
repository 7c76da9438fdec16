//! The interrupt: read the sensors, one update, publish.

use core::arch::global_asm;
use core::ptr;
use core::sync::atomic::{AtomicBool, AtomicPtr, AtomicU32, Ordering};

use cortex_m::peripheral::{SCB, SYST};
use heapless::spsc::{Consumer, Producer};
use palpate_drive::link::Source;
use palpate_drive::{
    Cycle, Input, InputStatus, Order, Report, StopReason, TrajectoryConfig, TrajectoryFollower, TrajectoryState,
    TrajectoryStatus, ValidatedSettings,
};
use stm32f4xx_hal::pac::PWR;

use super::board::TICK_CYCLES;
use super::sensors::Sensors;

/// Reports that wait for the idle loop.
pub const REPORTS: usize = 65;
/// Inputs of the link that wait for the interrupt.
pub const INPUTS: usize = 129;
/// Jobs that wait for the interrupt.
pub const JOBS: usize = 5;
/// Settings that wait for the interrupt: one.
pub const SETTINGS: usize = 2;
/// References of a trajectory that wait for the interrupt.
pub const REFERENCES: usize = 513;

/// What the idle loop asks for.
pub enum Job {
    /// Of the cycle.
    Order(Order),
    /// Another source.
    Source(Source),
    /// A trajectory, which was checked.
    Prepare(TrajectoryConfig),
    /// Begin to follow it, or end it.
    Follow(bool),
}

/// What the interrupt owns.
pub struct Tick {
    /// From words to reports.
    pub cycle: Cycle<'static>,
    /// The sensors.
    pub sensors: Sensors,
    /// The supply's watch.
    pub supply: PWR,
    /// Where the inputs come from.
    pub source: Source,
    /// Jobs from the idle loop.
    pub jobs: Consumer<'static, Job, JOBS>,
    /// Other settings from the idle loop.
    pub settings: Consumer<'static, ValidatedSettings, SETTINGS>,
    /// Inputs from the link.
    pub inputs: Consumer<'static, Input, INPUTS>,
    /// Reports to the idle loop.
    pub reports: Producer<'static, Report, REPORTS>,
    /// Follows a trajectory.
    pub follower: TrajectoryFollower,
    /// References of it from the link.
    pub references: Consumer<'static, f32, REFERENCES>,
    /// The tick before had not ended when this one was due.
    pub late: bool,
}

static TICK: AtomicPtr<Tick> = AtomicPtr::new(ptr::null_mut());

/// Ticks so far.
pub static TICKS: AtomicU32 = AtomicU32::new(0);
/// Reports that found no room.
pub static DROPPED: AtomicU32 = AtomicU32::new(0);
/// Ticks that waited for an input of the link.
pub static STARVED: AtomicU32 = AtomicU32::new(0);
/// Least and most cycles from the timer's zero to the interrupt's first look at it, most to its end.
pub static LATENCY: [AtomicU32; 2] = [AtomicU32::new(u32::MAX), AtomicU32::new(0)];
/// Most cycles from the timer's zero to the interrupt's end.
pub static LONGEST: AtomicU32 = AtomicU32::new(0);
/// The tick of the last request: set by the idle loop.
pub static REQUEST_AT: AtomicU32 = AtomicU32::new(0);
/// Where the trajectory stands, and how many of its references were followed.
pub static TRAJECTORY: [AtomicU32; 2] = [AtomicU32::new(0), AtomicU32::new(0)];
/// The link is gone: set by the idle loop.
pub static LINK_GONE: AtomicBool = AtomicBool::new(false);
/// The effort for the current loop, as the bits of a number.
pub static EFFORT: AtomicU32 = AtomicU32::new(0);

impl Tick {
    /// Gives `self` to the interrupt for good.
    pub fn hand_over(&'static mut self) {
        TICK.store(self, Ordering::Release);
    }

    fn run(&mut self) {
        self.job();
        // Also where time stands still for want of inputs: a host that is gone feeds none.
        let silence = TICKS.load(Ordering::Relaxed).wrapping_sub(REQUEST_AT.load(Ordering::Relaxed));
        self.follower.check_silence(silence);
        let Some(input) = self.input() else {
            count(&STARVED);
            EFFORT.store(0, Ordering::Relaxed);
            self.tell_trajectory();
            return;
        };
        let mut report = self.cycle.tick(input);
        self.follow(&mut report);
        EFFORT.store(report.effort.to_bits(), Ordering::Relaxed);
        if self.reports.enqueue(report).is_err() {
            count(&DROPPED);
        }
    }

    /// The effort of the trajectory, while one is followed.
    fn follow(&mut self, report: &mut Report) {
        if self.follower.is_running() {
            let reference = self.references.dequeue();
            report.effort = self.follower.update(report, reference);
        }
        self.tell_trajectory();
    }

    fn tell_trajectory(&self) {
        let TrajectoryStatus { state, played } = self.follower.status();
        TRAJECTORY[0].store(code(state), Ordering::Relaxed);
        TRAJECTORY[1].store(played, Ordering::Relaxed);
    }

    /// Forgets the references of an earlier trajectory.
    fn prepare(&mut self, config: TrajectoryConfig) {
        // Bounded by the queue: nothing is put into it while a preparation waits.
        while self.references.dequeue().is_some() {}
        // It was checked by the idle loop; what cannot be prepares nothing.
        let _ = self.follower.prepare(config);
    }

    /// One job a tick, so that the work is bounded.
    fn job(&mut self) {
        if let Some(settings) = self.settings.peek() {
            self.cycle.apply(settings);
            // It was copied where it stands; the place is free from here on.
            let _ = self.settings.dequeue();
            return;
        }
        match self.jobs.dequeue() {
            None => {}
            Some(Job::Order(order)) => self.cycle.order(order),
            Some(Job::Prepare(config)) => self.prepare(config),
            Some(Job::Follow(true)) => self.follower.start(),
            Some(Job::Follow(false)) => self.follower.stop(StopReason::Requested),
            Some(Job::Source(source)) => {
                self.source = source;
                self.cycle.order(Order::Restart);
            }
        }
    }

    /// What this tick sees. A fed input is taken as it is: its status are the sender's, so that all faults can be fed.
    fn input(&mut self) -> Option<Input> {
        let late = core::mem::take(&mut self.late);
        if self.source == Source::Link {
            return self.inputs.dequeue();
        }
        let mut input = self.sensors.read();
        input.status.set(InputStatus::OVERRUN, late);
        input.status.set(InputStatus::LINK_GONE, LINK_GONE.load(Ordering::Relaxed));
        input.status.set(InputStatus::BROWN_OUT, self.supply.csr().read().pvdo().bit_is_set());
        Some(input)
    }
}

/// A state as a number, for an atomic.
fn code(state: TrajectoryState) -> u32 {
    match state {
        TrajectoryState::Idle => 0,
        TrajectoryState::Prepared => 1,
        TrajectoryState::Running => 2,
        TrajectoryState::Finished => 3,
        TrajectoryState::Stopped(reason) => 4 + reason as u32,
    }
}

/// Where the trajectory stands, as the interrupt reported it last.
pub fn trajectory_status() -> TrajectoryStatus {
    let state = match TRAJECTORY[0].load(Ordering::Relaxed) {
        0 => TrajectoryState::Idle,
        1 => TrajectoryState::Prepared,
        2 => TrajectoryState::Running,
        3 => TrajectoryState::Finished,
        code => TrajectoryState::Stopped(REASONS.get(code as usize - 4).copied().unwrap_or(StopReason::Fault)),
    };
    TrajectoryStatus { state, played: TRAJECTORY[1].load(Ordering::Relaxed) }
}

/// In the order of their numbers.
const REASONS: [StopReason; 8] = [
    StopReason::Requested,
    StopReason::Depth,
    StopReason::Speed,
    StopReason::Force,
    StopReason::Fault,
    StopReason::Silence,
    StopReason::Underrun,
    StopReason::Reference,
];

/// Only the interrupt writes these, so a load and a store are as good as a read-modify-write.
fn count(counter: &AtomicU32) {
    counter.store(counter.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

fn extend(place: &AtomicU32, value: u32, beyond: impl Fn(u32, u32) -> bool) {
    if beyond(value, place.load(Ordering::Relaxed)) {
        place.store(value, Ordering::Relaxed);
    }
}

/// Cycles of the core since the timer's zero.
fn since_zero() -> u32 {
    (TICK_CYCLES - 1).saturating_sub(SYST::get_current())
}

// The vector itself, with labels that a plugin of the emulator counts between; r3 keeps the stack aligned.
global_asm!(
    ".section .text.SysTick, \"ax\"",
    ".global SysTick, palpate_begin, palpate_end",
    ".type SysTick, %function",
    ".thumb_func",
    "SysTick:",
    "push {{r3, lr}}",
    "palpate_begin:",
    "bl palpate_tick",
    "palpate_end:",
    "pop {{r3, pc}}",
    ".size SysTick, . - SysTick",
);

// SAFETY: the name is called by the vector above and by nobody else.
#[unsafe(no_mangle)]
extern "C" fn palpate_tick() {
    let latency = since_zero();
    // SAFETY: the pointer is null or comes from the `&'static mut` that `hand_over` took and nobody else holds; SysTick
    // does not preempt itself, so this is the only reference while it lives.
    let Some(tick) = (unsafe { TICK.load(Ordering::Acquire).as_mut() }) else { return };
    count(&TICKS);
    let [least, most] = &LATENCY;
    extend(least, latency, |now, before| now < before);
    extend(most, latency, |now, before| now > before);
    tick.run();
    let mut length = since_zero();
    if SCB::is_pendst_pending() {
        tick.late = true;
        length += TICK_CYCLES;
    }
    extend(&LONGEST, length, |now, before| now > before);
}
