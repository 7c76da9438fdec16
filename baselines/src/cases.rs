//! What is measured.

use core::hint::black_box;
use core::mem::{MaybeUninit, size_of};

use embedded_alloc::LlffHeap;
use palpate::{Impedance, Observation, Recent, Stream};
use palpate_baselines::{Adskalman, Kfilter, NalgebraRls, minikalman, nalgebra_window};

use palpate_firmware::measurement::{Gauge, Work};
use palpate_firmware::recording::{Fault, Recording};

/// For the one baseline whose buffers stand on a heap; nothing is allocated in an update.
#[global_allocator]
static HEAP: LlffHeap = LlffHeap::empty();

const HEAP_BYTES: usize = 4096;

/// Nothing, for what the counting itself takes.
struct Nothing;

impl Work for Nothing {
    fn work(&mut self) {}
}

/// One update with what it is given: the newest observation, or the latest of them.
struct Update<'a, F, I> {
    update: &'a mut F,
    given: I,
    found: Impedance,
}

impl<F: FnMut(I) -> Impedance, I: Copy> Work for Update<'_, F, I> {
    fn work(&mut self) {
        self.found = (self.update)(self.given);
    }
}

/// Measures all.
pub fn run(recording: &Recording, mut gauge: Gauge) -> Result<(), Fault> {
    let room = cortex_m::singleton!(: [MaybeUninit<u8>; HEAP_BYTES] = [MaybeUninit::uninit(); HEAP_BYTES]);
    let room = room.ok_or("the heap is made once")?;
    // SAFETY: the memory is the heap's alone, and it is told of it once, before anything is allocated.
    unsafe { HEAP.init(room.as_mut_ptr() as usize, HEAP_BYTES) };
    gauge.case("nothing", 0, 0, 0)?;
    for _ in 0..8 {
        gauge.pass(&mut Nothing)?;
    }
    let mut nalgebra = NalgebraRls::default();
    recursive(recording, &mut gauge, "nalgebra", size_of::<NalgebraRls>(), |o| nalgebra.update(o))?;
    let mut kfilter = Kfilter::default();
    recursive(recording, &mut gauge, "kfilter", size_of::<Kfilter>(), |o| kfilter.update(o))?;
    let mut ads = Adskalman::default();
    recursive(recording, &mut gauge, "adskalman", size_of::<Adskalman>(), |o| ads.update(o))?;
    let before = HEAP.used();
    let mut mini = minikalman();
    let state = size_of_val(&mini) + (HEAP.used() - before);
    recursive(recording, &mut gauge, "minikalman", state, |o| mini(o))?;
    for window in [50, 300] {
        let bytes = usize::from(window) * size_of::<Observation>();
        let last = usize::from(window);
        gauge.case("nalgebra_window", window, bytes, 0)?;
        each(recording, |recent| {
            pass(&mut gauge, &mut |recent: Recent<'_>| nalgebra_window(recent.last(last)), recent)
        })?;
    }
    Ok(())
}

/// One recursive baseline over the observations in contact, with the newest at hand; it is not told of a loss, so that its state is
/// that of one long contact.
fn recursive(
    recording: &Recording,
    gauge: &mut Gauge,
    name: &str,
    bytes: usize,
    mut update: impl FnMut(&Observation) -> Impedance,
) -> Result<(), Fault> {
    gauge.case(name, 0, bytes, 0)?;
    each(recording, |recent| {
        let o = recent.newest().ok_or("a ring without an observation")?;
        pass(gauge, &mut update, &o)
    })
}

/// One pass of `update`.
fn pass<I: Copy>(gauge: &mut Gauge, update: &mut impl FnMut(I) -> Impedance, given: I) -> Result<(), Fault> {
    let mut pass = Update { update, given, found: Impedance::ZERO };
    gauge.pass(black_box(&mut pass))?;
    black_box(pass.found);
    Ok(())
}

/// Calls `visit` with the ring at each observation in contact.
fn each(recording: &Recording, mut visit: impl FnMut(Recent<'_>) -> Result<(), Fault>) -> Result<(), Fault> {
    let mut stream = Stream::<300>::new(recording.config.stream).map_err(|_| "the settings are out of range")?;
    for &sample in recording.samples {
        let event = stream.update(sample).map_err(|_| "a sample was rejected")?;
        if event.reading.contact && !event.reading.restarted {
            visit(stream.recent())?;
        }
    }
    Ok(())
}
