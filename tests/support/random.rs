//! What is drawn at random in tests: the same in every run and on every machine, until PROPTEST_RNG_SEED asks for
//! something else (`make random SEED=n`).
#![allow(dead_code)]

use proptest::test_runner::{Config, RngSeed};

/// That of `cargo test`.
const SEED: u64 = 20_260_101;

/// The seed of this run.
pub fn seed() -> u64 {
    match Config::default().rng_seed {
        RngSeed::Fixed(seed) => seed,
        RngSeed::Random => SEED,
    }
}

/// Property tests of so many cases.
pub fn cases(cases: u32) -> Config {
    Config { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(seed()), ..Config::default() }
}
