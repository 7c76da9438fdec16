//! The idle loop: hears the link, grants its wishes, tells what the interrupt found, and keeps the watchdog quiet.

use core::mem::MaybeUninit;
use core::sync::atomic::Ordering;

use cortex_m_rt::entry;
use defmt_rtt as _;
use heapless::spsc::{Consumer, Producer, Queue};
use palpate_drive::framing::{LINE_BYTES, encode};
use palpate_drive::link::{
    CountersMessage, EstimateMessage, Identity, Message, RequestOutcome, SampleMessage, Source, Streams,
};
use palpate_drive::{
    Bounds, Calibration, Counters, Cycle, DecodedRequest, Estimator, Faults, Input, Report, RequestDecoder, Scale,
    Settings, TrajectoryConfig, TrajectoryFollower, TrajectoryState, ValidatedSettings,
};
use stm32f4xx_hal::watchdog::IndependentWatchdog;

use super::board::{self, Board};
use super::flash;
use super::line::{self, Line, RX_QUEUE, UartReceiver};
use super::tick::{
    DROPPED, INPUTS, JOBS, Job, LATENCY, LINK_GONE, LONGEST, REFERENCES, REPORTS, REQUEST_AT, SETTINGS, STARVED, TICKS,
    Tick, trajectory_status,
};

static COUNTERS: Counters = Counters::new();

/// What interrupts and idle loop hand each other, without a lock.
struct Queues {
    received: Queue<u8, RX_QUEUE>,
    reports: Queue<Report, REPORTS>,
    inputs: Queue<Input, INPUTS>,
    jobs: Queue<Job, JOBS>,
    new_settings: Queue<ValidatedSettings, SETTINGS>,
    references: Queue<f32, REFERENCES>,
}

#[entry]
fn main() -> ! {
    static mut QUEUES: Queues = Queues {
        received: Queue::new(),
        reports: Queue::new(),
        inputs: Queue::new(),
        jobs: Queue::new(),
        new_settings: Queue::new(),
        references: Queue::new(),
    };
    // Not `Option`s: their `None` is no zero, and would stand in the flash.
    static mut ESTIMATOR: MaybeUninit<Estimator> = MaybeUninit::uninit();
    static mut TICK: MaybeUninit<Tick> = MaybeUninit::uninit();
    static mut UART_RECEIVER: MaybeUninit<UartReceiver> = MaybeUninit::uninit();

    let read = flash::calibration();
    let calibration = read.unwrap_or(Calibration::DEFAULT);
    let settings = Settings::default();
    let mut board = started(Board::start(&calibration));
    board.found.set(Faults::CALIBRATION, read.is_err());
    let identity = identity(&board);
    defmt::info!("drive, image {=u32:x}, found {=u32:#x}", identity.image, identity.found);

    let estimator = build(ESTIMATOR, &settings, &calibration);
    let (received, bytes) = QUEUES.received.split();
    let (reports, reader) = QUEUES.reports.split();
    let (feed, inputs) = QUEUES.inputs.split();
    let (jobs, todo) = QUEUES.jobs.split();
    let (new_settings, settings_to_apply) = QUEUES.new_settings.split();
    let (points, references) = QUEUES.references.split();
    let cycle = Cycle::new(calibration, estimator, &COUNTERS, Bounds::NO_EFFORT, board.found);
    let (sensors, supply, source) = (board.sensors, board.supply, Source::Sensors);
    let tick = Tick {
        cycle,
        sensors,
        supply,
        source,
        jobs: todo,
        settings: settings_to_apply,
        inputs,
        reports,
        follower: TrajectoryFollower::new(),
        references,
        late: false,
    };
    TICK.write(tick).hand_over();
    UART_RECEIVER.write(UartReceiver { receiver: board.receiver, received }).hand_over();
    board::start_ticking(&mut board.core);
    board::watch(&mut board.watchdog);
    let line = Line { sender: board.sender, received: bytes };
    let idle = Idle {
        decoder: RequestDecoder::new(),
        line,
        reports: reader,
        feed,
        jobs,
        new_settings,
        points,
        calibration,
        settings,
        revision: 0,
        identity,
        streams: Streams { estimates: 0, samples: false },
        source,
        before: Faults::empty(),
        zero: calibration.force_zero,
        received_at: 0,
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
    decoder: RequestDecoder,
    line: Line,
    reports: Consumer<'static, Report, REPORTS>,
    feed: Producer<'static, Input, INPUTS>,
    jobs: Producer<'static, Job, JOBS>,
    new_settings: Producer<'static, ValidatedSettings, SETTINGS>,
    points: Producer<'static, f32, REFERENCES>,
    calibration: Calibration,
    settings: Settings,
    revision: u8,
    identity: Identity<'static>,
    streams: Streams,
    source: Source,
    before: Faults,
    zero: f32,
    received_at: u32,
    watchdog: IndependentWatchdog,
    fed_at: u32,
}

impl Idle {
    fn run(mut self) -> ! {
        loop {
            while let Some(byte) = self.line.received.dequeue() {
                if let Some((number, request)) = self.decoder.push(byte) {
                    self.received_at = TICKS.load(Ordering::Relaxed);
                    REQUEST_AT.store(self.received_at, Ordering::Relaxed);
                    let outcome = self.execute(request);
                    if outcome != RequestOutcome::Done {
                        self.decoder.refuse();
                    }
                    self.send(&Message::Answer { number, outcome });
                }
            }
            if let Some(report) = self.reports.dequeue() {
                self.publish(&report);
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
        let silence = now.wrapping_sub(self.received_at);
        let timeout = u32::from(self.settings.link_timeout);
        LINK_GONE.store(timeout > 0 && silence > timeout, Ordering::Relaxed);
    }

    fn send(&mut self, message: &Message<'_>) {
        let mut line = [0; LINE_BYTES];
        if let Some(frame) = encode(message, &mut line) {
            self.line.send(frame);
        }
    }

    /// What was requested of a report; a fault that begins is reported whenever estimates are.
    fn publish(&mut self, report: &Report) {
        let begun = !self.before.contains(report.faults);
        (self.before, self.zero) = (report.faults, report.zero);
        let Streams { estimates, samples } = self.streams;
        if samples {
            self.send(&Message::Sample(SampleMessage::of(report)));
        }
        if estimates > 0 && (begun || report.tick.is_multiple_of(u32::from(estimates))) {
            self.send(&Message::Estimate(EstimateMessage::of(report)));
        }
        if begun {
            defmt::warn!("tick {=u32}: faults {=u32:#x}", report.tick, report.faults.bits());
        }
    }

    fn execute(&mut self, request: DecodedRequest) -> RequestOutcome {
        match request {
            DecodedRequest::Alive => RequestOutcome::Done,
            DecodedRequest::Identity => self.answer(&Message::Identity(self.identity)),
            DecodedRequest::Calibration => {
                let scale = Scale { zero: self.zero, ..self.calibration.scale() };
                self.answer(&Message::Calibration { calibration: self.calibration, scale })
            }
            DecodedRequest::Settings => {
                self.answer(&Message::Settings { settings: self.settings, revision: self.revision })
            }
            DecodedRequest::Counters => self.answer(&Message::Counters(self.count())),
            DecodedRequest::Choose(settings) => self.apply_settings(settings),
            DecodedRequest::Order(order) => self.job(Job::Order(order)),
            DecodedRequest::Stream(streams) => {
                self.streams = streams;
                RequestOutcome::Done
            }
            DecodedRequest::Source(source) => {
                let outcome = self.job(Job::Source(source));
                if outcome == RequestOutcome::Done {
                    self.source = source;
                }
                outcome
            }
            DecodedRequest::Prepare(config) => self.prepare(config),
            DecodedRequest::Points(points, used) => self.add_points(points.get(..used).unwrap_or_default()),
            DecodedRequest::Follow(begin) => self.job(Job::Follow(begin)),
            DecodedRequest::Trajectory => self.answer(&Message::Trajectory(trajectory_status())),
            DecodedRequest::Feed(inputs, used) => self.feed(inputs.get(..used).unwrap_or_default()),
        }
    }

    fn answer(&mut self, message: &Message<'_>) -> RequestOutcome {
        self.send(message);
        RequestOutcome::Done
    }

    fn job(&mut self, job: Job) -> RequestOutcome {
        self.jobs.enqueue(job).map_or(RequestOutcome::NoRoom, |()| RequestOutcome::Done)
    }

    /// Checks the settings and hands over what follows from them; nothing is changed where one is out of range.
    fn apply_settings(&mut self, settings: Settings) -> RequestOutcome {
        if !self.new_settings.ready() {
            return RequestOutcome::NoRoom;
        }
        let revision = self.revision.wrapping_add(1);
        let Ok(validated) = ValidatedSettings::new(&settings, &self.calibration, revision) else {
            return RequestOutcome::OutOfRange;
        };
        if self.new_settings.enqueue(validated).is_err() {
            return RequestOutcome::NoRoom;
        }
        (self.settings, self.revision) = (settings, revision);
        RequestOutcome::Done
    }

    /// All of the inputs or none.
    fn feed(&mut self, inputs: &[Input]) -> RequestOutcome {
        if self.source != Source::Link {
            return RequestOutcome::NotNow;
        }
        if self.feed.capacity() - self.feed.len() < inputs.len() {
            return RequestOutcome::NoRoom;
        }
        let taken = inputs.iter().all(|&input| self.feed.enqueue(input).is_ok());
        if taken { RequestOutcome::Done } else { RequestOutcome::NoRoom }
    }

    /// A run goes on until it ends: another one is prepared only then.
    fn prepare(&mut self, config: TrajectoryConfig) -> RequestOutcome {
        if trajectory_status().state == TrajectoryState::Running {
            return RequestOutcome::NotNow;
        }
        if config.check().is_err() {
            return RequestOutcome::OutOfRange;
        }
        self.job(Job::Prepare(config))
    }

    /// All of the references or none, and only for a run that is prepared or goes on.
    fn add_points(&mut self, points: &[f32]) -> RequestOutcome {
        if !matches!(trajectory_status().state, TrajectoryState::Prepared | TrajectoryState::Running) {
            return RequestOutcome::NotNow;
        }
        if self.points.capacity() - self.points.len() < points.len() {
            return RequestOutcome::NoRoom;
        }
        let taken = points.iter().all(|&point| self.points.enqueue(point).is_ok());
        if taken { RequestOutcome::Done } else { RequestOutcome::NoRoom }
    }

    fn count(&self) -> CountersMessage {
        CountersMessage {
            faults: COUNTERS.faults(),
            others: COUNTERS.others(),
            dropped: DROPPED.load(Ordering::Relaxed),
            rx_overruns: line::rx_overruns(),
            starved: STARVED.load(Ordering::Relaxed),
            latency: [LATENCY[0].load(Ordering::Relaxed), LATENCY[1].load(Ordering::Relaxed)],
            longest: LONGEST.load(Ordering::Relaxed),
            link_counters: self.decoder.link_counters(),
        }
    }
}
