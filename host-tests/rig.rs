//! All laws on one stream, with the settings of the paper.

use palpate::{
    AdaptiveWindow, AdaptiveWindowConfig, BankEstimates, BlockConfig, BlockLeastMeanFourth, BlockLeastMeanSquare,
    BlockLeastSquares, CusumRls, CusumRlsConfig, Direction, DirectionalRls, DirectionalRlsConfig, Estimate,
    EstimatorBank, EstimatorBankConfig, Ewrls, EwrlsConfig, Gradient, GradientConfig, Method, Observation, Rejection,
    ResetRls, ResetRlsConfig, Sample, Sprls, SprlsConfig, Step, StreamConfig, UpdateLaw, Window,
};

/// Everything runs, the block laws on 300 samples.
pub fn bench(stream: StreamConfig) -> EstimatorBank {
    bench_with(stream, BlockConfig::default())
}

/// Everything runs, the block laws as `block` says.
pub fn bench_with(stream: StreamConfig, block: BlockConfig) -> EstimatorBank {
    EstimatorBank::new(&EstimatorBankConfig { block, ..EstimatorBankConfig::all_methods(stream) })
        .expect("sound settings")
}

/// What came of each sample.
pub fn run(bench: &mut EstimatorBank, samples: &[Sample]) -> Vec<Result<BankEstimates, Rejection>> {
    samples.iter().map(|sample| bench.update(*sample)).collect()
}

/// All numbers of an estimate as bits.
pub fn bits(estimate: &Estimate) -> [u32; 8] {
    let (i, w) = (estimate.impedance, estimate.half_width);
    let numbers =
        [i.stiffness, i.damping, w.stiffness, w.damping, estimate.innovation, estimate.fill, estimate.excitation];
    let [a, b, c, d, e, f, g] = numbers.map(f32::to_bits);
    [a, b, c, d, e, f, g, estimate.flags.bits().into()]
}

/// Fails where two outcomes differ in any bit of any method.
#[track_caller]
pub fn same(what: &str, got: &Result<BankEstimates, Rejection>, want: &Result<BankEstimates, Rejection>) {
    match (got, want) {
        (Ok(got), Ok(want)) => {
            for (method, (got, want)) in Method::ALL.iter().zip(got.iter().zip(want)) {
                assert_eq!(bits(got), bits(want), "{what}: {} got {got:?}, want {want:?}", method.name());
            }
        }
        _ => assert_eq!(got.err(), want.err(), "{what}"),
    }
}

/// One law without front end, fed with rows.
pub struct Bare {
    pub method: Method,
    pub update: Box<dyn FnMut(Observation) -> Step>,
}

impl Bare {
    fn new<L: UpdateLaw + 'static>(method: Method, law: L) -> Self {
        let (mut state, mut window) = (law.initial_state(), Window::<300>::new());
        let update = move |o| {
            window.push(o);
            law.update(&mut state, window.recent())
        };
        Self { method, update: Box::new(update) }
    }

    /// All of them, with the settings of the paper where it has any.
    pub fn all() -> [Self; 12] {
        const SOUND: &str = "sound settings";
        let block = BlockConfig::default();
        let fourth = |direction| BlockLeastMeanFourth::new(block, direction).expect(SOUND);
        [
            Self::new(Method::Rls, Ewrls::new(EwrlsConfig::rls()).expect(SOUND)),
            Self::new(Method::Ewrls, Ewrls::new(EwrlsConfig::default()).expect(SOUND)),
            Self::new(Method::Sprls, Sprls::new(SprlsConfig::default()).expect(SOUND)),
            Self::new(Method::ResetRls, ResetRls::new(ResetRlsConfig::default()).expect(SOUND)),
            Self::new(Method::Gradient, Gradient::new(GradientConfig::default()).expect(SOUND)),
            Self::new(Method::Bls, BlockLeastSquares::new(block).expect(SOUND)),
            Self::new(Method::Blms, BlockLeastMeanSquare::new(block).expect(SOUND)),
            Self::new(Method::Blmf, fourth(Direction::SteepestDescent)),
            Self::new(Method::NewtonBlmf, fourth(Direction::Newton)),
            Self::new(Method::CusumRls, CusumRls::new(CusumRlsConfig::default()).expect(SOUND)),
            Self::new(Method::AdaptiveBls, AdaptiveWindow::new(AdaptiveWindowConfig::default()).expect(SOUND)),
            Self::new(Method::DirectionalRls, DirectionalRls::new(DirectionalRlsConfig::default()).expect(SOUND)),
        ]
    }
}
