//! The idle loop: hears the link, grants its wishes, tells what the interrupt found, and keeps the watchdog quiet.

use core::mem::MaybeUninit;
use core::sync::atomic::Ordering;

use cortex_m_rt::entry;
use defmt_rtt as _;
use heapless::spsc::{Consumer, Producer, Queue};
use palpate_drive::framing::{LINE_BYTES, encode};
use palpate_drive::link::{Count, Identity, Message, Outcome, Seen, Source, Streams, Told};
use palpate_drive::{
    Bounds, Calibration, Choice, Counters, Cycle, Desk, Estimator, Faults, Input, Report, Scale, Settings, Wish,
};
use stm32f4xx_hal::watchdog::IndependentWatchdog;

use super::board::{self, Board};
use super::flash;
use super::line::{self, Ear, HEARD, Line};
use super::tick::{CHOICES, DROPPED, INPUTS, JOBS, Job, LATENCY, LINK_GONE, LONGEST, REPORTS, STARVED, TICKS, Tick};

static COUNTERS: Counters = Counters::new();

/// What interrupts and idle loop hand each other, without a lock.
struct Queues {
    heard: Queue<u8, HEARD>,
    reports: Queue<Report, REPORTS>,
    inputs: Queue<Input, INPUTS>,
    jobs: Queue<Job, JOBS>,
    choices: Queue<Choice, CHOICES>,
}

#[entry]
fn main() -> ! {
    static mut QUEUES: Queues = Queues {
        heard: Queue::new(),
        reports: Queue::new(),
        inputs: Queue::new(),
        jobs: Queue::new(),
        choices: Queue::new(),
    };
    // Not `Option`s: their `None` is no zero, and would stand in the flash.
    static mut ESTIMATOR: MaybeUninit<Estimator> = MaybeUninit::uninit();
    static mut TICK: MaybeUninit<Tick> = MaybeUninit::uninit();
    static mut EAR: MaybeUninit<Ear> = MaybeUninit::uninit();

    let read = flash::calibration();
    let calibration = read.unwrap_or(Calibration::DEFAULT);
    let settings = Settings::default();
    let mut board = started(Board::start(&calibration));
    board.found.set(Faults::CALIBRATION, read.is_err());
    let identity = identity(&board);
    defmt::info!("drive, image {=u32:x}, found {=u32:#x}", identity.image, identity.found);

    let estimator = build(ESTIMATOR, &settings, &calibration);
    let (heard, bytes) = QUEUES.heard.split();
    let (reports, told) = QUEUES.reports.split();
    let (feed, inputs) = QUEUES.inputs.split();
    let (jobs, todo) = QUEUES.jobs.split();
    let (choose, choices) = QUEUES.choices.split();
    let cycle = Cycle::new(calibration, estimator, &COUNTERS, Bounds::NO_EFFORT, board.found);
    let (sensors, supply, source) = (board.sensors, board.supply, Source::Sensors);
    let tick = Tick { cycle, sensors, supply, source, jobs: todo, choices, inputs, reports, late: false };
    TICK.write(tick).hand_over();
    EAR.write(Ear { receiver: board.receiver, heard }).hand_over();
    board::start_ticking(&mut board.core);
    board::watch(&mut board.watchdog);
    let line = Line { sender: board.sender, heard: bytes };
    let idle = Idle {
        desk: Desk::new(),
        line,
        reports: told,
        feed,
        jobs,
        choose,
        calibration,
        settings,
        revision: 0,
        identity,
        streams: Streams { estimates: 0, samples: false },
        source,
        before: Faults::empty(),
        zero: calibration.force_zero,
        heard_at: 0,
        watchdog: board.watchdog,
        fed_at: 0,
    };
    idle.run()
}

fn identity(board: &Board) -> Identity<'static> {
    Identity {
        version: env!("CARGO_PKG_VERSION"),
        image: flash::image(),
        chip: board.chip,
        emulator: board.emulator,
        reset: board.reset,
        found: board.found.bits(),
    }
}

/// Makes the estimator where it is to be. Apart, for its stack is needed once: an `Option` of it on the way would be 28 kB more.
#[inline(never)]
fn build(
    place: &'static mut MaybeUninit<Estimator>,
    settings: &Settings,
    calibration: &Calibration,
) -> &'static mut Estimator {
    match Estimator::new(settings, calibration, 0) {
        Ok(estimator) => place.write(estimator),
        Err(_) => cortex_m::peripheral::SCB::sys_reset(),
    }
}

/// Without it nothing runs at all: a reset, and another try.
fn started<T>(part: Option<T>) -> T {
    part.unwrap_or_else(|| cortex_m::peripheral::SCB::sys_reset())
}

struct Idle {
    desk: Desk,
    line: Line,
    reports: Consumer<'static, Report, REPORTS>,
    feed: Producer<'static, Input, INPUTS>,
    jobs: Producer<'static, Job, JOBS>,
    choose: Producer<'static, Choice, CHOICES>,
    calibration: Calibration,
    settings: Settings,
    revision: u8,
    identity: Identity<'static>,
    streams: Streams,
    source: Source,
    before: Faults,
    zero: f32,
    heard_at: u32,
    watchdog: IndependentWatchdog,
    fed_at: u32,
}

impl Idle {
    fn run(mut self) -> ! {
        loop {
            while let Some(byte) = self.line.heard.dequeue() {
                if let Some((number, wish)) = self.desk.hear(byte) {
                    self.heard_at = TICKS.load(Ordering::Relaxed);
                    let outcome = self.grant(wish);
                    if outcome != Outcome::Done {
                        self.desk.refuse();
                    }
                    self.say(&Message::Answer { number, outcome });
                }
            }
            if let Some(report) = self.reports.dequeue() {
                self.tell(&report);
                continue;
            }
            self.watch();
            cortex_m::asm::wfi();
        }
    }

    /// The watchdog stays quiet only while both this loop and the interrupt go on.
    fn watch(&mut self) {
        let now = TICKS.load(Ordering::Relaxed);
        if now != self.fed_at {
            self.fed_at = now;
            self.watchdog.feed();
        }
        let silence = now.wrapping_sub(self.heard_at);
        let timeout = u32::from(self.settings.link_timeout);
        LINK_GONE.store(timeout > 0 && silence > timeout, Ordering::Relaxed);
    }

    fn say(&mut self, message: &Message<'_>) {
        let mut line = [0; LINE_BYTES];
        if let Some(frame) = encode(message, &mut line) {
            self.line.send(frame);
        }
    }

    /// What was asked to be told of a report; a fault that begins is told in any case that estimates are.
    fn tell(&mut self, report: &Report) {
        let begun = !self.before.contains(report.faults);
        (self.before, self.zero) = (report.faults, report.zero);
        let Streams { estimates, samples } = self.streams;
        if samples {
            self.say(&Message::Sample(Seen::of(report)));
        }
        if estimates > 0 && (begun || report.tick.is_multiple_of(u32::from(estimates))) {
            self.say(&Message::Estimate(Told::of(report)));
        }
        if begun {
            defmt::warn!("tick {=u32}: faults {=u32:#x}", report.tick, report.faults.bits());
        }
    }

    fn grant(&mut self, wish: Wish) -> Outcome {
        match wish {
            Wish::Alive => Outcome::Done,
            Wish::Identity => self.answer(&Message::Identity(self.identity)),
            Wish::Calibration => {
                let scale = Scale { zero: self.zero, ..self.calibration.scale() };
                self.answer(&Message::Calibration { calibration: self.calibration, scale })
            }
            Wish::Settings => self.answer(&Message::Settings { settings: self.settings, revision: self.revision }),
            Wish::Counters => self.answer(&Message::Counters(self.count())),
            Wish::Choose(settings) => self.choose(settings),
            Wish::Order(order) => self.job(Job::Order(order)),
            Wish::Stream(streams) => {
                self.streams = streams;
                Outcome::Done
            }
            Wish::Source(source) => {
                let outcome = self.job(Job::Source(source));
                if outcome == Outcome::Done {
                    self.source = source;
                }
                outcome
            }
            Wish::Feed(inputs, used) => self.feed(inputs.get(..used).unwrap_or_default()),
        }
    }

    fn answer(&mut self, message: &Message<'_>) -> Outcome {
        self.say(message);
        Outcome::Done
    }

    fn job(&mut self, job: Job) -> Outcome {
        self.jobs.enqueue(job).map_or(Outcome::NoRoom, |()| Outcome::Done)
    }

    /// Checks the settings and hands over what follows from them; nothing is changed where one is out of range.
    fn choose(&mut self, settings: Settings) -> Outcome {
        if !self.choose.ready() {
            return Outcome::NoRoom;
        }
        let revision = self.revision.wrapping_add(1);
        let Ok(choice) = Choice::of(&settings, &self.calibration, revision) else { return Outcome::OutOfRange };
        if self.choose.enqueue(choice).is_err() {
            return Outcome::NoRoom;
        }
        (self.settings, self.revision) = (settings, revision);
        Outcome::Done
    }

    /// All of the inputs or none.
    fn feed(&mut self, inputs: &[Input]) -> Outcome {
        if self.source != Source::Link {
            return Outcome::NotNow;
        }
        if self.feed.capacity() - self.feed.len() < inputs.len() {
            return Outcome::NoRoom;
        }
        let taken = inputs.iter().all(|&input| self.feed.enqueue(input).is_ok());
        if taken { Outcome::Done } else { Outcome::NoRoom }
    }

    fn count(&self) -> Count {
        Count {
            faults: COUNTERS.faults(),
            others: COUNTERS.others(),
            dropped: DROPPED.load(Ordering::Relaxed),
            deaf: line::deaf(),
            starved: STARVED.load(Ordering::Relaxed),
            latency: [LATENCY[0].load(Ordering::Relaxed), LATENCY[1].load(Ordering::Relaxed)],
            longest: LONGEST.load(Ordering::Relaxed),
            tally: self.desk.tally(),
        }
    }
}
