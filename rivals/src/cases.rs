//! What is measured.

use core::hint::black_box;
use core::mem::{MaybeUninit, size_of};

use embedded_alloc::LlffHeap;
use palpate::{Impedance, Observation, Recent, Stream};
use palpate_rivals::{Adskalman, Kfilter, NalgebraRls, minikalman, nalgebra_window};

use super::gauge::{Gauge, Work};
use super::input::{Fault, Recording};

/// For the one rival whose buffers stand on a heap; nothing is allocated in an update.
#[global_allocator]
static HEAP: LlffHeap = LlffHeap::empty();

const HEAP_BYTES: usize = 4096;

/// Nothing, for what the counting itself takes.
struct Nothing;

impl Work for Nothing {
    fn work(&mut self) {}
}

/// One update.
struct Update<'a, F> {
    update: &'a mut F,
    recent: Recent<'a>,
    found: Impedance,
}

impl<F: FnMut(Recent<'_>) -> Impedance> Work for Update<'_, F> {
    fn work(&mut self) {
        self.found = (self.update)(self.recent);
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
    let newest = |recent: Recent<'_>| recent.newest().unwrap_or_default();
    let mut nalgebra = NalgebraRls::default();
    rival(recording, &mut gauge, "nalgebra", 0, size_of::<NalgebraRls>(), |recent| nalgebra.update(&newest(recent)))?;
    let mut kfilter = Kfilter::default();
    rival(recording, &mut gauge, "kfilter", 0, size_of::<Kfilter>(), |recent| kfilter.update(&newest(recent)))?;
    let mut ads = Adskalman::default();
    rival(recording, &mut gauge, "adskalman", 0, size_of::<Adskalman>(), |recent| ads.update(&newest(recent)))?;
    let before = HEAP.used();
    let mut mini = minikalman();
    let state = size_of_val(&mini) + (HEAP.used() - before);
    rival(recording, &mut gauge, "minikalman", 0, state, |recent| mini(&newest(recent)))?;
    for window in [50, 300] {
        let bytes = usize::from(window) * size_of::<Observation>();
        let last = usize::from(window);
        rival(recording, &mut gauge, "nalgebra_window", window, bytes, |recent| nalgebra_window(recent.last(last)))?;
    }
    Ok(())
}

/// One rival over the observations in contact; it is not told of a loss, so that its state is that of one long contact.
fn rival(
    recording: &Recording,
    gauge: &mut Gauge,
    name: &str,
    window: u16,
    bytes: usize,
    mut update: impl FnMut(Recent<'_>) -> Impedance,
) -> Result<(), Fault> {
    gauge.case(name, window, bytes, 0)?;
    let mut stream = Stream::<300>::new(recording.config.stream).map_err(|_| "the settings are out of range")?;
    for &sample in recording.samples {
        let event = stream.update(sample).map_err(|_| "a sample was rejected")?;
        if event.reading.contact && !event.reading.restarted {
            let mut pass = Update { update: &mut update, recent: stream.recent(), found: Impedance::ZERO };
            gauge.pass(black_box(&mut pass))?;
            black_box(pass.found);
        }
    }
    Ok(())
}
