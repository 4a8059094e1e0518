//! The committed header is what cbindgen makes of `src/capi`, and compiles as C99 and C++17 with all
//! warnings as errors. `STICKSLIP_WRITE_HEADER=1 cargo test --test capi header` renews it.

use crate::support::c::*;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn header_is_up_to_date() {
    let config = cbindgen::Config::from_file(root().join("cbindgen.toml")).unwrap();
    let builder = cbindgen::Builder::new().with_config(config).with_src(root().join("src/capi/mod.rs"));
    let mut generated = Vec::new();
    builder.generate().unwrap().write(&mut generated);
    let generated = String::from_utf8(generated).unwrap();
    let path = root().join("include/stickslip.h");
    if std::env::var_os("STICKSLIP_WRITE_HEADER").is_some() {
        std::fs::write(&path, &generated).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == generated, "include/stickslip.h is out of date: `make header` renews it");
}

fn compiles(cpp: bool, flags: &[&str], extension: &str) {
    let source = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("header.{extension}"));
    std::fs::write(&source, "#include <stickslip.h>\n#include <stickslip.h>\nint main(void) { return 0; }\n").unwrap();
    let warnings = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-fsyntax-only", "-I"];
    run(compiler(cpp).args(flags).args(warnings).arg(include()).arg(&source), "the header");
}

#[test]
fn compiles_as_c99() {
    compiles(false, &["-std=c99", "-Wstrict-prototypes"], "c");
}

#[test]
fn compiles_as_cpp17() {
    compiles(true, &["-std=c++17", "-Wold-style-cast"], "cpp");
}
