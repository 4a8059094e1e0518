//! Gives the shared library its soname: libstickslip.so.0.MINOR before 1.0, libstickslip.so.MAJOR after (docs/abi.md).

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let env = |name: &str| std::env::var(name).expect("cargo sets it");
    let (major, minor) = (env("CARGO_PKG_VERSION_MAJOR"), env("CARGO_PKG_VERSION_MINOR"));
    let abi = if major == "0" { format!("0.{minor}") } else { major };
    if env("CARGO_CFG_TARGET_OS") == "linux" {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libstickslip.so.{abi}");
    }
}
