//! The device against the host: the same sources, the same samples, the same bits.

use palpate::exchange::Outcome;
use palpate::{
    Bench, BenchConfig, BlockConfig, EwrlsConfig, GradientConfig, Method, Methods, ResetRlsConfig, Sample, SprlsConfig,
    StreamConfig,
};
use palpate_lab::device::Device;

fn everything() -> BenchConfig {
    BenchConfig {
        stream: StreamConfig::BENCH,
        methods: Method::ALL.into_iter().fold(Methods::default(), Methods::with),
        rls: EwrlsConfig::rls(),
        ewrls: EwrlsConfig::default(),
        sprls: SprlsConfig::default(),
        reset_rls: ResetRlsConfig::default(),
        gradient: GradientConfig::default(),
        block: BlockConfig::of(120),
    }
}

#[test]
fn smoke() {
    let samples: Vec<Sample> = (0..3000)
        .map(|k| {
            let t = k as f32 * 1e-3;
            let x = 0.010 * (2.0 * t).sin() + 0.003 * (63.0 * t).sin();
            Sample {
                position: x,
                force: (300.0 * x).max(0.0) + if k % 700 == 3 { f32::NAN } else { 0.0 },
                elapsed: 1e-3,
            }
        })
        .collect();
    let config = everything();
    let mut bench = Bench::new(&config).unwrap();
    let host: Vec<Outcome> = samples.iter().map(|s| bench.update(*s)).collect();
    let device = Device::prepare().unwrap();
    let mut out = vec![];
    let t = std::time::Instant::now();
    let counters = device.run(&config, &samples, |o| out.push(o)).unwrap();
    eprintln!("{counters:?} in {:?}", t.elapsed());
    for (k, (a, b)) in host.iter().zip(&out).enumerate() {
        assert_eq!(a, b, "{k}");
    }
    assert_eq!(host.len(), out.len());
}
