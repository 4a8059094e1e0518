//! The fuzz targets without a fuzzer: every kept input of `fuzz/seeds`, and a fixed number of inputs made from these. The
//! same inputs in every run and on every machine; `make fuzz` is the search without end. See fuzz/README.md.
#![allow(unsafe_code, clippy::undocumented_unsafe_blocks)] // the targets call the C ABI throughout

#[path = "../fuzz/src/lib.rs"]
mod targets;

mod support;

use std::panic::catch_unwind;
use std::path::Path;
use support::random::seed;

/// The longest input, as in `fuzz/run.sh`.
const LONGEST: usize = 1024;

/// Inputs of one target by their names, in the order of these.
fn seeds(target: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds").join(target);
    let mut seeds: Vec<_> = std::fs::read_dir(&folder)
        .unwrap_or_else(|e| panic!("{}: {e}", folder.display()))
        .map(|entry| entry.unwrap().path())
        .map(|path| (path.display().to_string(), std::fs::read(path).unwrap()))
        .collect();
    seeds.sort();
    assert!(seeds.len() >= 10, "{} holds too few inputs to mean anything", folder.display());
    seeds
}

/// xorshift64*.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % n
    }

    fn byte(&mut self) -> u8 {
        self.below(256) as u8
    }

    /// A part of something so long.
    fn part(&mut self, length: usize) -> std::ops::Range<usize> {
        let from = self.below(length + 1);
        from..from + self.below(length - from + 1)
    }

    /// One of the seeds with a few changes of bytes and parts.
    fn changed(&mut self, seeds: &[(String, Vec<u8>)]) -> Vec<u8> {
        let mut input = seeds[self.below(seeds.len())].1.clone();
        for _ in 0..=self.below(6) {
            let at = self.below(input.len() + 1);
            match self.below(8) {
                0 => drop(input.drain(self.part(input.len()))),
                1 => {
                    let other = &seeds[self.below(seeds.len())].1;
                    let part = other[self.part(other.len())].to_vec();
                    drop(input.splice(at..at, part));
                }
                2 => {
                    let part = input[self.part(input.len())].to_vec();
                    drop(input.splice(at..at, part));
                }
                3 => input.insert(at, self.byte()),
                4 => (0..self.below(32)).for_each(|_| input.push(self.byte())),
                _ if at == input.len() => input.push(self.byte()),
                5 => input[at] ^= 1 << self.below(8),
                6 => input[at] = input[at].wrapping_add(self.byte() % 8).wrapping_sub(4),
                _ => input[at] = self.byte(),
            }
            input.truncate(LONGEST);
        }
        input
    }
}

/// `count` inputs besides the kept ones.
fn replay(target: &str, run: fn(&[u8]), count: usize) {
    let seeds = seeds(target);
    let check = |name: &str, input: &[u8]| {
        if catch_unwind(|| run(input)).is_err() {
            let hex: String = input.iter().map(|b| format!("{b:02x}")).collect();
            panic!("{target} fails at {name}; to keep it: echo {hex} | xxd -r -p > fuzz/seeds/{target}/NAME");
        }
    };
    for (name, input) in &seeds {
        check(name, input);
    }
    let mut random = Random(seed());
    for k in 0..count {
        let input = random.changed(&seeds);
        check(&format!("input {k} of seed {}", seed()), &input);
    }
}

#[test]
fn pairs_of_any_bytes() {
    replay("pair", targets::pair::run, 300_000);
}

#[test]
fn interfaces_of_any_bytes() {
    replay("interface", targets::interface::run, 10_000);
}

#[test]
fn effects_of_any_bytes() {
    replay("effects", targets::effects::run, 3_000);
}

#[test]
fn skins_of_any_bytes() {
    replay("skin", targets::skin::run, 3_000);
}

#[test]
fn the_abi_of_any_bytes() {
    replay("abi", targets::abi::run, 100_000);
}
