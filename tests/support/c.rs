//! Compiling and running C programs against the library that this very `cargo test` has built.
#![allow(dead_code)]

use std::path::{Path, PathBuf};
use std::process::Command;

/// What `cargo rustc --crate-type staticlib -- --print native-static-libs` lists, and -lm for the tests.
pub const SYSTEM_LIBRARIES: [&str; 7] = ["-lgcc_s", "-lutil", "-lrt", "-lpthread", "-lm", "-ldl", "-lc"];

/// The C or C++ compiler, $CC or $CXX first.
pub fn compiler(cpp: bool) -> Command {
    let host = format!("{}-unknown-linux-gnu", std::env::consts::ARCH);
    let mut build = cc::Build::new();
    build.cpp(cpp).host(&host).target(&host).opt_level(1).debug(true).cargo_metadata(false);
    build.get_compiler().to_command()
}

/// The folder of the header.
pub fn include() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("include")
}

/// A library next to this test's executable: cargo puts all crate types of the package there.
pub fn library(name: &str) -> PathBuf {
    let executable = std::env::current_exe().unwrap();
    let deps = executable.parent().unwrap();
    let places = [deps.join(name), deps.parent().unwrap().join(name)];
    let found = places.iter().find(|p| p.exists()).cloned();
    found.unwrap_or_else(|| {
        panic!(
            "cargo should have built {name} for this test; it is neither at {} nor {}",
            places[0].display(),
            places[1].display()
        )
    })
}

/// Runs a compiler or program that must succeed; what it printed.
pub fn run(command: &mut Command, what: &str) -> String {
    let output = command.output().unwrap_or_else(|e| panic!("{what}: {e}"));
    let printed = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    assert!(output.status.success(), "{what}: {}\n{printed}", output.status);
    printed
}
