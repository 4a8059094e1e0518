//! The C ABI seen from C: every tests/capi/tNN_*.c is compiled with all warnings as errors, linked with the library
//! that this very `cargo test` has built, and run. A test passes when it exits with 0 and nothing was printed.

mod support;

use std::path::{Path, PathBuf};
use std::process::Command;
use support::c::*;

fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/capi")
}

enum Link {
    Static,
    Dynamic,
}

fn build(name: &str, link: &Link) -> PathBuf {
    let suffix = if matches!(link, Link::Static) { "" } else { "_dynamic" };
    let executable = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}{suffix}"));
    let mut command = compiler(false);
    // From the sources' folder with a relative name, so that failures name the file and no machine's paths.
    command.current_dir(sources()).args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]);
    command.args(["-I../../include", "-o"]).arg(&executable).arg(format!("{name}.c"));
    match link {
        Link::Static => command.arg(library("libstickslip.a")).args(SYSTEM_LIBRARIES),
        Link::Dynamic => {
            let path = library("libstickslip.so");
            let folder = path.parent().unwrap().display().to_string();
            command.arg(&path).arg(format!("-Wl,-rpath,{folder}")).args(["-lm", "-lpthread"])
        }
    };
    run(&mut command, name);
    executable
}

fn check(name: &str, link: Link) {
    let printed = run(&mut Command::new(build(name, &link)), name);
    assert!(printed.is_empty(), "{name} passed, but something was printed:\n{printed}");
}

macro_rules! c_tests {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                check(stringify!($name), Link::Static);
            }
        )*

        #[test]
        fn every_c_file_is_run() {
            let mut listed = vec![$(concat!(stringify!($name), ".c").to_owned()),*];
            listed.sort();
            let files = std::fs::read_dir(sources()).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap());
            let mut files: Vec<_> = files.filter(|f| f.ends_with(".c")).collect();
            files.sort();
            assert_eq!(files, listed);
        }
    };
}

c_tests! {
    t01_version_status
    t10_pair_weights
    t11_pair_gap
    t12_pair_residual_balance
    t13_pair_tangent
    t20_node
    t21_node_block
    t22_facet_geometry
    t30_interface_lifecycle
    t31_interface_residual_tangent
    t32_commit_rollback_restart
    t33_overrides
    t34_sums
    t35_aba
    t36_pattern
    t37_drop_off
    t40_bad_input_null
    t41_bad_input_misaligned
    t42_bad_input_struct_size
    t43_bad_input_not_finite
    t44_bad_input_value
    t45_bad_input_facet
    t46_bad_input_index
    t47_bad_input_counts
    t48_bad_input_buffers
    t49_bad_input_history
    t50_threads
    t51_extremes
    t52_random_calls
    t53_foreign_history
    t54_overflow
}

/// One test through the shared library.
#[test]
fn dynamic_link() {
    check("t31_interface_residual_tangent", Link::Dynamic);
}
