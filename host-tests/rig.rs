//! All nine laws on one stream, with the settings of the paper.

use palpate::{
    Bench, BenchConfig, BenchEstimates, BlockConfig, Estimate, EwrlsConfig, GradientConfig, Method, Methods, Rejection,
    ResetRlsConfig, Sample, SprlsConfig, StreamConfig,
};

/// Everything runs.
pub fn bench(stream: StreamConfig) -> Bench {
    Bench::new(&BenchConfig {
        stream,
        methods: Method::ALL.into_iter().fold(Methods::default(), Methods::with),
        rls: EwrlsConfig::rls(),
        ewrls: EwrlsConfig::default(),
        sprls: SprlsConfig::default(),
        reset_rls: ResetRlsConfig::default(),
        gradient: GradientConfig::default(),
        block: BlockConfig::default(),
    })
    .expect("sound settings")
}

/// What came of each sample.
pub fn run(bench: &mut Bench, samples: &[Sample]) -> Vec<Result<BenchEstimates, Rejection>> {
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
pub fn same(what: &str, got: &Result<BenchEstimates, Rejection>, want: &Result<BenchEstimates, Rejection>) {
    match (got, want) {
        (Ok(got), Ok(want)) => {
            for (method, (got, want)) in Method::ALL.iter().zip(got.iter().zip(want)) {
                assert_eq!(bits(got), bits(want), "{what}: {} got {got:?}, want {want:?}", method.name());
            }
        }
        _ => assert_eq!(got.err(), want.err(), "{what}"),
    }
}
