//! What all estimators of one contact share: front end, ring of observations, range of movement.

mod config;
mod estimator_state;
mod event;

pub(crate) use config::ValidatedStreamConfig;
pub use config::{ContactLoss, StreamConfig};
pub use estimator_state::EstimatorState;
pub use event::Event;

use crate::contact::{Observation, Sample};
use crate::error::ConfigError;
use crate::front_end::{FrontEnd, FrontEndState, Rejection};
use crate::math::{larger, smaller};
use crate::quality::{Flags, IntervalEstimator};
use crate::window::{Recent, Window};

/// Turns samples into observations and keeps the latest `N`.
#[derive(Debug, Clone)]
pub struct Stream<const N: usize> {
    front_end: FrontEnd,
    assessor: IntervalEstimator,
    contact_loss: ContactLoss,
    four_counts: f32,
    half_movement_decay: f32,
    state: FrontEndState,
    window: Window<N>,
    in_contact: bool,
    low: f32,
    high: f32,
}

impl<const N: usize> Stream<N> {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: StreamConfig) -> Result<Self, ConfigError> {
        Ok(Self::from_validated(ValidatedStreamConfig::new(config)?))
    }

    /// Infallible, so that a large value can be constructed in place.
    pub(crate) fn from_validated(validated: ValidatedStreamConfig) -> Self {
        Self {
            front_end: validated.front_end,
            assessor: validated.assessor,
            contact_loss: validated.contact_loss,
            four_counts: validated.four_counts,
            half_movement_decay: validated.half_movement_decay,
            state: FrontEndState::default(),
            window: Window::new(),
            in_contact: false,
            low: 0.0,
            high: 0.0,
        }
    }

    /// Takes one sample.
    ///
    /// # Errors
    /// Why it was rejected; then nothing but the clock has moved.
    // Inlined: as a call it hands its result over in memory, byte by byte where rejection and reading share a place.
    #[inline(always)]
    pub fn update(&mut self, sample: Sample) -> Result<Event, Rejection> {
        let reading = self.front_end.update(&mut self.state, sample)?;
        let mut flags = Flags::empty();
        flags.set(Flags::RESTARTED, reading.restarted);
        let lost = self.in_contact && !reading.contact;
        if reading.contact && !reading.restarted {
            flags |= self.take(reading.observation);
            self.in_contact = true;
        }
        if lost {
            self.in_contact = false;
            if self.contact_loss != ContactLoss::Nothing {
                self.window.clear();
            }
        }
        Ok(Event { reading, lost, flags })
    }

    /// Takes a usual sample of a contact that goes on, and tells [`Event::flags`]; `None`, and nothing has changed, for all others. For
    /// them [`Self::update`], which does the same with these, too.
    #[inline(always)]
    pub(crate) fn update_in_contact(&mut self, sample: &Sample) -> Option<Flags> {
        if !self.in_contact {
            return None;
        }
        let observation = self.front_end.update_in_contact(&mut self.state, sample)?;
        Some(self.take(observation))
    }

    /// Takes a row of the contact; [`Flags::LITTLE_MOVEMENT`] where it holds.
    #[inline(always)]
    fn take(&mut self, observation: Observation) -> Flags {
        self.window.push(observation);
        let movement = self.movement(observation.penetration);
        if movement < self.four_counts { Flags::LITTLE_MOVEMENT } else { Flags::empty() }
    }

    /// Peak to peak of the penetration, forgotten slowly towards its middle.
    #[inline(always)]
    fn movement(&mut self, penetration: f32) -> f32 {
        if !self.in_contact {
            (self.low, self.high) = (penetration, penetration);
        }
        let fade = self.half_movement_decay * (self.high - self.low);
        self.low = smaller(self.low + fade, penetration);
        self.high = larger(self.high - fade, penetration);
        self.high - self.low
    }

    /// Takes other settings in place, and forgets everything.
    pub(crate) fn configure(&mut self, validated: ValidatedStreamConfig) {
        (self.front_end, self.assessor, self.contact_loss) =
            (validated.front_end, validated.assessor, validated.contact_loss);
        (self.four_counts, self.half_movement_decay) = (validated.four_counts, validated.half_movement_decay);
        self.restart();
    }

    /// Forgets everything but the settings: the next sample is the first.
    pub fn restart(&mut self) {
        self.state = FrontEndState::default();
        self.window.clear();
        self.in_contact = false;
    }

    /// Whether the latest sample that was taken is in contact.
    pub(crate) fn touches(&self) -> bool {
        self.front_end.touches(&self.state)
    }

    /// The latest observations of the contact.
    pub fn recent(&self) -> Recent<'_> {
        self.window.recent()
    }

    /// The front end.
    pub fn front_end(&self) -> &FrontEnd {
        &self.front_end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(config: StreamConfig) -> Stream<8> {
        Stream::new(config).expect("sound settings")
    }

    #[test]
    fn the_movement_is_a_peak_to_peak_that_fades_towards_its_middle() {
        let mut stream = stream(StreamConfig::BENCH);
        stream.half_movement_decay = 0.25;
        (stream.low, stream.high) = (-9.0, 9.0);
        assert_eq!(stream.movement(3.0), 0.0, "a contact begins with no movement");
        stream.in_contact = true;
        // A quarter of the span from either side: 3 to 7, 4 to 6, 4.5 to 5.5, and 1 below.
        assert_eq!([7.0, 5.0, 5.0, 1.0].map(|position| stream.movement(position)), [4.0, 2.0, 1.0, 4.25]);
    }

    fn push(stream: &mut Stream<8>, position: f32, force: f32) -> Event {
        stream.update(Sample { position, force, elapsed: 1e-3 }).expect("a sample")
    }

    #[test]
    fn a_contact_that_is_lost_is_told_once_and_what_it_leaves_is_chosen() {
        for (contact_loss, left) in [(ContactLoss::Everything, 0), (ContactLoss::Memory, 0), (ContactLoss::Nothing, 5)]
        {
            let mut stream = stream(StreamConfig { contact_loss, ..StreamConfig::BENCH });
            let lost: [bool; 6] = core::array::from_fn(|k| push(&mut stream, 0.01 + 1e-4 * k as f32, 3.0).lost);
            // The first sample has no rate and is no row.
            assert_eq!((lost, stream.recent().len()), ([false; 6], 5));
            let lost: [bool; 8] = core::array::from_fn(|_| push(&mut stream, -0.01, 0.0).lost);
            assert_eq!(lost, [false, false, false, false, true, false, false, false], "after five samples away");
            let rows = if contact_loss == ContactLoss::Nothing { stream.recent().len() } else { 5 };
            assert!(stream.recent().len() >= left && rows >= 5, "{contact_loss:?}: {}", stream.recent().len());
            assert_eq!(stream.recent().is_empty(), left == 0, "{contact_loss:?}");
        }
    }

    #[test]
    fn little_movement_is_less_than_four_counts() {
        let little = |four_counts: f32| {
            let mut stream = stream(StreamConfig::BENCH);
            (stream.four_counts, stream.half_movement_decay) = (four_counts, 0.0);
            push(&mut stream, 0.01, 3.0);
            core::array::from_fn(|_| push(&mut stream, 0.01, 3.0).flags.contains(Flags::LITTLE_MOVEMENT))
        };
        // A tool that does not move at all: zero is less than a count, and not less than no count.
        assert_eq!((little(1e-3), little(0.0)), ([true; 3], [false; 3]));
        let mut stream = stream(StreamConfig::BENCH);
        assert_eq!(push(&mut stream, 0.01, 3.0).flags, Flags::RESTARTED, "the first sample is no row");
        let still = push(&mut stream, 0.01, 3.0).flags;
        let mut flags = still;
        for _ in 0..100 {
            flags = push(&mut stream, 0.02, 3.0).flags;
        }
        assert_eq!((still, flags), (Flags::LITTLE_MOVEMENT, Flags::empty()));
    }
}
