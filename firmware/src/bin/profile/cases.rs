//! What is measured: the update of every law, with windows of 10, 50 and 300, and the whole way from a sample to estimates.

use core::hint::black_box;
use core::mem::size_of;

use palpate::{
    AdaptiveWindow, AdaptiveWindowConfig, BlockConfig, BlockLeastMeanFourth, BlockLeastMeanSquare, BlockLeastSquares,
    ChangeConfig, ConfigError, ContactModel, CusumRls, CusumRlsConfig, Direction, DirectionalRls, DirectionalRlsConfig,
    EstimatorState, Ewrls, Gradient, Identifier, ModelStream, Observation, ParameterRls, ParameterRlsConfig, Prior,
    Recent, ResetRls, Sample, Sprls, Stream, UpdateLaw, direct,
};

use palpate_firmware::measurement::{Gauge, Work};
use palpate_firmware::recording::{Fault, Recording};

/// Capacity of every ring: the longest window that is measured.
const RING: usize = 300;

fn unsound(_: ConfigError) -> Fault {
    "the settings are out of range"
}

/// One update of a law.
struct Update<'a, L: UpdateLaw> {
    law: &'a L,
    state: &'a mut L::State,
    recent: Recent<'a>,
}

impl<L: UpdateLaw> Work for Update<'_, L> {
    fn work(&mut self) {
        // Where the call leaves it: a copy would be counted as well.
        let step = self.law.update(self.state, self.recent);
        black_box(&step);
    }
}

/// One update without what tells of its quality, called plainly: law, state and what it is given are at hand as a caller has them.
struct UpdateEstimate<'a, L, S, I, F> {
    law: &'a L,
    state: &'a mut S,
    given: I,
    update_estimate: F,
}

impl<L, S, I: Copy, F: Fn(&L, &mut S, I) -> f32> Work for UpdateEstimate<'_, L, S, I, F> {
    fn work(&mut self) {
        (self.update_estimate)(self.law, self.state, self.given);
    }
}

/// Nothing, for what the counting itself takes.
struct Nothing;

impl Work for Nothing {
    fn work(&mut self) {}
}

/// One sample through something that takes samples.
struct Take<F>(F, Sample);

impl<F: FnMut(Sample)> Work for Take<F> {
    fn work(&mut self) {
        (self.0)(self.1);
    }
}

/// Measures everything.
pub fn run(recording: &Recording, mut gauge: Gauge) -> Result<(), Fault> {
    gauge.case("nothing", 0, 0, 0)?;
    for _ in 0..8 {
        gauge.pass(&mut Nothing)?;
    }
    let config = &recording.config;
    let mut laws = Laws { recording, gauge: &mut gauge };
    laws.law("rls", 0, Ewrls::new(config.rls))?;
    laws.law("ewrls", 0, Ewrls::new(config.ewrls))?;
    laws.law("sprls", 0, Sprls::new(config.sprls))?;
    laws.law("reset_rls", 0, ResetRls::new(config.reset_rls))?;
    laws.law("gradient", 0, Gradient::new(config.gradient))?;
    laws.law("cusum_rls", 0, CusumRls::new(CusumRlsConfig::default()))?;
    laws.law("directional_rls", 0, DirectionalRls::new(DirectionalRlsConfig::default()))?;
    for window in [10, 50, 300] {
        let block = BlockConfig::of(window);
        laws.law("bls", window, BlockLeastSquares::new(block))?;
        laws.law("blms", window, BlockLeastMeanSquare::new(block))?;
        laws.law("blmf", window, BlockLeastMeanFourth::new(block, Direction::SteepestDescent))?;
        laws.law("newton_blmf", window, BlockLeastMeanFourth::new(block, Direction::Newton))?;
        laws.law("adaptive_bls", window, AdaptiveWindow::new(AdaptiveWindowConfig::of(window)))?;
        let ridge = BlockConfig { minimum_fill: 2, prior: Some(Prior::default()), ..block };
        laws.law("ridge_bls", window, BlockLeastSquares::new(ridge))?;
        laws.law("bls_anew", window, direct::BlockLeastSquares::new(block))?;
        laws.law("blmf_anew", window, direct::BlockLeastMeanFourth::new(block, Direction::SteepestDescent))?;
    }
    laws.estimate_alone()?;
    samples_to_estimates(recording, &mut gauge)?;
    three_parameters(recording, &mut gauge)
}

struct Laws<'a> {
    recording: &'a Recording,
    gauge: &'a mut Gauge,
}

impl Laws<'_> {
    /// Every update of one law.
    fn law<L: UpdateLaw>(&mut self, name: &str, window: u16, law: Result<L, ConfigError>) -> Result<(), Fault> {
        let law = law.map_err(unsound)?;
        self.walk(name, window, &law, |gauge, state, recent| {
            gauge.pass(&mut Update { law: black_box(&law), state, recent })
        })
    }

    /// One pass for each sample of the recording that is in contact, as a `EstimatorState` would call `law`.
    fn walk<L: UpdateLaw>(
        &mut self,
        name: &str,
        window: u16,
        law: &L,
        mut pass: impl FnMut(&mut Gauge, &mut L::State, Recent<'_>) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let ring = usize::from(window) * size_of::<Observation>();
        self.gauge.case(name, window, size_of::<L::State>(), ring)?;
        let mut stream = Stream::<RING>::new(self.recording.config.stream).map_err(unsound)?;
        let mut state = law.initial_state();
        for &sample in self.recording.samples {
            let event = stream.update(sample).map_err(|_| "a sample was rejected")?;
            if event.lost {
                state = law.initial_state();
            }
            if event.reading.contact && !event.reading.restarted {
                pass(self.gauge, &mut state, stream.recent())?;
            }
        }
        Ok(())
    }

    /// What moves the estimate, without the interval and the rest that tells of its quality: the job that others do, too.
    fn estimate_alone(&mut self) -> Result<(), Fault> {
        let config = &self.recording.config;
        let ewrls = Ewrls::new(config.ewrls).map_err(unsound)?;
        self.observe("ewrls_alone", &ewrls, Ewrls::update_estimate)?;
        let sprls = Sprls::new(config.sprls).map_err(unsound)?;
        self.observe("sprls_alone", &sprls, Sprls::update_estimate)?;
        let cusum = CusumRls::new(CusumRlsConfig::default()).map_err(unsound)?;
        self.observe("cusum_rls_alone", &cusum, CusumRls::update_estimate)?;
        let block = BlockConfig::of(300);
        let bls = BlockLeastSquares::new(block).map_err(unsound)?;
        self.update_estimate("bls_alone", 300, &bls, |law, state, recent| law.update_estimate(state, recent))?;
        let blmf = BlockLeastMeanFourth::new(block, Direction::SteepestDescent).map_err(unsound)?;
        self.update_estimate("blmf_alone", 300, &blmf, |law, state, recent| law.update_estimate(state, recent))
    }

    /// A recursive law, with the newest observation at hand.
    fn observe<L: UpdateLaw>(
        &mut self,
        name: &str,
        law: &L,
        observe: impl Fn(&L, &mut L::State, &Observation) -> f32,
    ) -> Result<(), Fault> {
        self.walk(name, 0, law, |gauge, state, recent| {
            let o = &recent.newest().ok_or("a ring without an observation")?;
            let update_estimate = |law: &L, state: &mut L::State, o: &Observation| observe(law, state, o);
            gauge.pass(&mut UpdateEstimate { law, state, given: o, update_estimate })
        })
    }

    fn update_estimate<L: UpdateLaw>(
        &mut self,
        name: &str,
        window: u16,
        law: &L,
        update_estimate: impl Fn(&L, &mut L::State, Recent<'_>) -> f32,
    ) -> Result<(), Fault> {
        self.walk(name, window, law, |gauge, state, recent| {
            let update_estimate =
                |law: &L, state: &mut L::State, recent: Recent<'_>| update_estimate(law, state, recent);
            gauge.pass(&mut UpdateEstimate { law, state, given: recent, update_estimate })
        })
    }
}

/// The whole way: filter, contact detection, law, interval.
fn samples_to_estimates(recording: &Recording, gauge: &mut Gauge) -> Result<(), Fault> {
    let config = &recording.config;
    let stream = config.stream;
    let block = BlockConfig::of(300);
    let fourth = || BlockLeastMeanFourth::new(block, Direction::SteepestDescent).map_err(unsound);
    let mut front = Stream::<1>::new(stream).map_err(unsound)?;
    whole(recording, gauge, "front_end", 0, size_of::<Stream<1>>(), |sample| {
        black_box(front.update(sample).is_ok());
    })?;
    let mut ewrls = Identifier::<_, 1>::new(stream, Ewrls::new(config.ewrls).map_err(unsound)?).map_err(unsound)?;
    whole(recording, gauge, "identify_ewrls", 0, size_of_val(&ewrls), |sample| {
        black_box(ewrls.update(sample).is_ok());
    })?;
    let bls = BlockLeastSquares::new(block).map_err(unsound)?;
    let mut bls = Identifier::<_, RING>::new(stream, bls).map_err(unsound)?;
    whole(recording, gauge, "identify_bls", 300, size_of_val(&bls), |sample| {
        black_box(bls.update(sample).is_ok());
    })?;
    let mut blmf = Identifier::<_, RING>::new(stream, fourth()?).map_err(unsound)?;
    whole(recording, gauge, "identify_blmf", 300, size_of_val(&blmf), |sample| {
        black_box(blmf.update(sample).is_ok());
    })?;
    let mut four = (
        Stream::<RING>::new(stream).map_err(unsound)?,
        EstimatorState::new(Ewrls::new(config.ewrls).map_err(unsound)?),
        EstimatorState::new(Sprls::new(config.sprls).map_err(unsound)?),
        EstimatorState::new(BlockLeastSquares::new(block).map_err(unsound)?),
        EstimatorState::new(fourth()?),
    );
    whole(recording, gauge, "identify_all_four", 300, size_of_val(&four), |sample| {
        let (stream, ewrls, sprls, bls, blmf) = &mut four;
        if let Ok(event) = stream.update(sample) {
            black_box(ewrls.update(stream, &event));
            black_box(sprls.update(stream, &event));
            black_box(bls.update(stream, &event));
            black_box(blmf.update(stream, &event));
        }
    })
}

/// The whole way with a law of three parameters, and with one that takes a power of the depth.
fn three_parameters(recording: &Recording, gauge: &mut Gauge) -> Result<(), Fault> {
    let front_end = recording.config.stream.front_end;
    for (name, model) in [
        ("model_bias", ContactModel::BiasedKelvinVoigt),
        ("model_tool_mass", ContactModel::ToolMass),
        ("model_hunt_crossley", ContactModel::HuntCrossley { exponent: 1.5 }),
    ] {
        let mut stream = ModelStream::new(front_end, model).map_err(unsound)?;
        let config = ParameterRlsConfig {
            forgetting_factor: 0.998,
            noise: 0.1,
            spreads: [1e3, 1e3, 10.0],
            change: Some(ChangeConfig::default()),
            correlated_samples: stream.correlated_samples(),
        };
        let law = ParameterRls::new(config).map_err(unsound)?;
        let mut state = law.initial_state();
        let bytes = size_of::<ModelStream>() + size_of_val(&state);
        whole(recording, gauge, name, 0, bytes, |sample| {
            if let Ok(row) = stream.update(sample)
                && row.contact
                && !row.restarted
            {
                black_box(law.update(&mut state, row.first(), row.force));
                black_box(law.half_widths(&state));
            }
        })?;
    }
    let cusum = CusumRls::new(CusumRlsConfig::default()).map_err(unsound)?;
    let mut cusum = Identifier::<_, 1>::new(recording.config.stream, cusum).map_err(unsound)?;
    whole(recording, gauge, "identify_cusum_rls", 0, size_of_val(&cusum), |sample| {
        black_box(cusum.update(sample).is_ok());
    })?;
    // The same where nobody asks for the interval.
    let mut cusum = Identifier::recommended(recording.config.stream).map_err(unsound)?;
    whole(recording, gauge, "identify_cusum_rls_alone", 0, size_of_val(&cusum), |sample| {
        let _ = black_box(cusum.update_estimate(sample));
    })
}

fn whole(
    recording: &Recording,
    gauge: &mut Gauge,
    name: &str,
    window: u16,
    state: usize,
    mut take: impl FnMut(Sample),
) -> Result<(), Fault> {
    gauge.case(name, window, state, 0)?;
    for &sample in recording.samples {
        gauge.pass(&mut Take(&mut take, sample))?;
    }
    Ok(())
}
