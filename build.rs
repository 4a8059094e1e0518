//! Gives the shared library its soname: libstickslip.so.0.MINOR before 1.0, libstickslip.so.MAJOR after (docs/abi.md).
//! Gives `stickslip_build` what only the build knows: commit, target, profile, compiler. None of it is a path or a time,
//! so that two builds of one commit have equal bytes.

use std::path::Path;
use std::process::Command;

/// What is not in the repository of the commit, or not known, goes by this name.
const UNKNOWN: &str = "unknown";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let (major, minor) = (variable("CARGO_PKG_VERSION_MAJOR"), variable("CARGO_PKG_VERSION_MINOR"));
    let abi = if major == "0" { format!("0.{minor}") } else { major };
    if variable("CARGO_CFG_TARGET_OS") == "linux" {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libstickslip.so.{abi}");
        by_its_soname(&format!("libstickslip.so.{abi}"));
    }
    let compiler = said(Command::new(variable("RUSTC")).arg("--version")).unwrap_or(UNKNOWN.into());
    println!("cargo::rustc-env=STICKSLIP_BUILD_COMMIT={}", commit());
    println!("cargo::rustc-env=STICKSLIP_BUILD_TARGET={}", variable("TARGET"));
    println!("cargo::rustc-env=STICKSLIP_BUILD_PROFILE={}-O{}", variable("PROFILE"), variable("OPT_LEVEL"));
    println!("cargo::rustc-env=STICKSLIP_BUILD_FEATURES={}", features());
    println!("cargo::rustc-env=STICKSLIP_BUILD_COMPILER={}", compiler.replace(' ', "-"));
}

/// A link of this name beside the shared library that cargo leaves, so that a program which was linked with it finds it there.
/// It may be there already, and where links cannot be made nothing is lost: hence no error.
fn by_its_soname(name: &str) {
    // OUT_DIR is PROFILE/build/stickslip-HASH/out.
    if let Some(profile) = Path::new(&variable("OUT_DIR")).ancestors().nth(3) {
        #[cfg(unix)]
        let _ = std::os::unix::fs::symlink("libstickslip.so", profile.join(name));
    }
}

fn variable(name: &str) -> String {
    std::env::var(name).expect("cargo sets it")
}

/// The features that are built, with commas, or "none". cargo gives their names in capitals.
fn features() -> String {
    const NAMES: [&str; 11] = [
        "analytic",
        "condensed",
        "heat",
        "laws",
        "lines",
        "offsets",
        "points",
        "quadratic",
        "rigid",
        "sensitivity",
        "skin",
    ];
    let built = |name: &str| std::env::var_os(format!("CARGO_FEATURE_{}", name.to_uppercase())).is_some();
    let built: Vec<&str> = NAMES.into_iter().filter(|name| built(name)).collect();
    if built.is_empty() { "none".into() } else { built.join(",") }
}

/// What a command writes, if it succeeds.
fn said(command: &mut Command) -> Option<String> {
    let done = command.output().ok().filter(|done| done.status.success())?;
    Some(String::from_utf8(done.stdout).ok()?.trim().to_string())
}

/// The commit: what the packager says (`STICKSLIP_COMMIT`), what `cargo package` wrote into the package, or what git says of
/// the checkout. Builds for tests do not ask git: otherwise each commit would have everything compiled again.
fn commit() -> String {
    println!("cargo::rerun-if-env-changed=STICKSLIP_COMMIT");
    if let Some(given) = std::env::var("STICKSLIP_COMMIT").ok().filter(|given| is_name(given)) {
        return given;
    }
    packaged().or_else(|| if variable("PROFILE") == "release" { checked_out() } else { None }).unwrap_or(UNKNOWN.into())
}

/// Neither a path nor blanks: the text of `stickslip_build` is words of the form name=value.
fn is_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || "+-._~".contains(c))
}

fn packaged() -> Option<String> {
    let text = std::fs::read_to_string(".cargo_vcs_info.json").ok()?;
    let (_, rest) = text.split_once("\"sha1\": \"")?;
    let commit = rest.split('"').next().filter(|commit| is_name(commit))?.to_string();
    Some(if text.contains("\"dirty\": true") { commit + "+changes" } else { commit })
}

/// Of this folder's own repository: a package may be unpacked inside another one.
fn checked_out() -> Option<String> {
    let git = |words: &[&str]| said(Command::new("git").args(words));
    let top = git(&["rev-parse", "--show-toplevel"])?;
    if Path::new(&top).canonicalize().ok()? != Path::new(".").canonicalize().ok()? {
        return None;
    }
    // Each commit and each change of a file below makes this run again.
    let log = git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|log| Path::new(log).exists());
    let sources = ["src", "Cargo.toml", "Cargo.lock", "build.rs"];
    log.iter().map(String::as_str).chain(sources).for_each(|file| println!("cargo::rerun-if-changed={file}"));
    let changed = git(&[&["status", "--porcelain", "--"][..], &sources].concat())?;
    Some(git(&["rev-parse", "HEAD"])? + if changed.is_empty() { "" } else { "+changes" })
}
