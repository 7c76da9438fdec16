//! What holds for any data: properties, on generated sequences with a fixed seed.

mod cubic;
mod scale;
mod state;

use proptest::test_runner::{Config, RngAlgorithm, RngSeed, TestRunner};

/// The same cases in every run, and no file of failures left behind.
fn runner(cases: u32) -> TestRunner {
    TestRunner::new(Config {
        cases,
        failure_persistence: None,
        rng_algorithm: RngAlgorithm::ChaCha,
        rng_seed: RngSeed::Fixed(0x0070_a17a_7e00),
        ..Config::default()
    })
}
