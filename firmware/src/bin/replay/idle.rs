//! The idle loop of the bench image: files in and out by semihosting, the work itself in the interrupt.

use core::mem::MaybeUninit;

use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::entry;
use defmt_rtt as _;
use heapless::spsc::{Consumer, Producer, Queue};
use palpate::{EstimatorBank, EstimatorBankConfig, Methods, Sample};
use palpate_drive::replay_format::{
    CONFIG_BYTES, INPUT_FILE, OUTPUT_FILE, RECORD_BYTES, SAMPLE_BYTES, UpdateResult, decode_config, decode_sample,
    encode_counters, encode_record, record_bytes,
};
use semihosting::fs::File;
use semihosting::io::{self, Read, Write};
use stm32f4xx_hal::pac;

use super::tick::{OUTCOMES, QUEUE, Tick, counters};
use palpate_firmware::board::{CLOCK_HZ, start_clock};

/// Ticks of the interrupt in a second.
const TICK_HZ: u32 = 1_000;
/// Samples a block: one semihosting call stops the core for about as long whatever it carries.
const BLOCK: usize = 64;

/// Why the image gave up, written to the host's standard error.
type Fault = &'static str;

#[entry]
fn main() -> ! {
    static mut INPUT: Queue<Sample, QUEUE> = Queue::new();
    static mut OUTPUT: Queue<UpdateResult, OUTCOMES> = Queue::new();
    // Not an `Option`: its `None` is no zero, and 25 kB of it would stand in the flash.
    static mut TICK: MaybeUninit<Tick> = MaybeUninit::uninit();

    let (to_tick, input) = INPUT.split();
    let (output, from_tick) = OUTPUT.split();
    let result = prepare().and_then(|(file, config)| {
        let bench = EstimatorBank::new(&config).map_err(|_| "the settings are out of range")?;
        TICK.write(Tick { bench, input, output }).hand_over();
        start_timer()?;
        let samples = Source { file, to_tick, ended: false };
        let records = Sink { file: create()?, from_tick, methods: config.methods, written: 0 };
        replay(samples, records)
    });
    match result {
        Ok(()) => semihosting::process::exit(0),
        Err(fault) => {
            semihosting::eprintln!("replay: {fault}");
            semihosting::process::exit(1)
        }
    }
}

fn prepare() -> Result<(File, EstimatorBankConfig), Fault> {
    let mut file = File::open(INPUT_FILE).map_err(|_| "cannot open replay.in in the folder it was run in")?;
    let mut length = [0; 4];
    file.read_exact(&mut length).map_err(|_| "replay.in is shorter than its header")?;
    let mut bytes = [0; CONFIG_BYTES];
    let length = usize::try_from(u32::from_le_bytes(length)).unwrap_or(usize::MAX);
    let bytes = bytes.get_mut(..length).ok_or("replay.in: the header is longer than any settings")?;
    file.read_exact(bytes).map_err(|_| "replay.in is shorter than its settings")?;
    let config = decode_config(bytes).ok_or("replay.in: the settings are not those of this image")?;
    Ok((file, config))
}

fn create() -> Result<File, Fault> {
    File::create(OUTPUT_FILE).map_err(|_| "cannot create replay.out in the folder it was run in")
}

fn start_timer() -> Result<(), Fault> {
    let machine = start_clock(pac::Peripherals::take().ok_or("the peripherals are taken")?);
    defmt::info!("replay on {=str}, {=u32} Hz", machine, CLOCK_HZ);
    let mut timer = cortex_m::Peripherals::take().ok_or("the core's peripherals are taken")?.SYST;
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(CLOCK_HZ / TICK_HZ - 1);
    timer.clear_current();
    timer.enable_interrupt();
    timer.enable_counter();
    Ok(())
}

/// Feeds and drains the interrupt until the recording is through.
fn replay(mut samples: Source, mut records: Sink) -> Result<(), Fault> {
    let mut sent = 0;
    loop {
        sent += samples.fill()?;
        records.drain()?;
        if samples.ended && records.written == sent {
            break;
        }
        cortex_m::asm::wfi();
    }
    let counters = counters();
    defmt::info!("{=u32} samples, {=u32} overruns", counters.samples, counters.overruns);
    records.file.write_all(&encode_counters(&counters)).map_err(|_| "cannot write replay.out")
}

struct Source {
    file: File,
    to_tick: Producer<'static, Sample, QUEUE>,
    ended: bool,
}

impl Source {
    /// Reads a block where the queue has room for one; the samples sent.
    fn fill(&mut self) -> Result<u32, Fault> {
        if self.ended || self.to_tick.capacity() - self.to_tick.len() < BLOCK {
            return Ok(0);
        }
        let mut bytes = [0; BLOCK * SAMPLE_BYTES];
        let read = read_up_to(&mut self.file, &mut bytes).map_err(|_| "cannot read replay.in")?;
        self.ended = read < bytes.len();
        let (whole, rest) = bytes.get(..read).unwrap_or_default().as_chunks::<SAMPLE_BYTES>();
        if !rest.is_empty() {
            return Err("replay.in ends within a sample");
        }
        let mut sent = 0;
        for sample in whole {
            self.to_tick.enqueue(decode_sample(sample)).map_err(|_| "the queue of samples is full")?;
            sent += 1;
        }
        Ok(sent)
    }
}

/// Reads until `bytes` is full or the file ends.
fn read_up_to(file: &mut File, bytes: &mut [u8]) -> io::Result<usize> {
    let mut read = 0;
    while let Some(rest) = bytes.get_mut(read..).filter(|rest| !rest.is_empty()) {
        match file.read(rest)? {
            0 => break,
            more => read += more,
        }
    }
    Ok(read)
}

struct Sink {
    file: File,
    from_tick: Consumer<'static, UpdateResult, OUTCOMES>,
    methods: Methods,
    written: u32,
}

impl Sink {
    /// Writes what the interrupt has finished.
    fn drain(&mut self) -> Result<(), Fault> {
        /// Records a call: a few, so that the buffer fits the stack.
        const BATCH: usize = 16;
        let size = record_bytes(self.methods);
        loop {
            let mut bytes = [0; BATCH * RECORD_BYTES];
            let mut used = 0;
            for to in bytes.chunks_exact_mut(size).take(BATCH) {
                let Some(outcome) = self.from_tick.dequeue() else { break };
                encode_record(&outcome, self.methods, to);
                used += size;
                self.written += 1;
            }
            if used == 0 {
                return Ok(());
            }
            let bytes = bytes.get(..used).unwrap_or_default();
            self.file.write_all(bytes).map_err(|_| "cannot write replay.out")?;
        }
    }
}
