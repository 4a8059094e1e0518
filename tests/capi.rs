//! The C ABI seen from C: every tests/capi/tNN_*.c is compiled with all warnings as errors, linked with the library
//! that this very `cargo test` has built, and run. A test passes when it exits with 0 and nothing was printed.

use std::path::{Path, PathBuf};
use std::process::Command;

/// What `cargo rustc --crate-type staticlib -- --print native-static-libs` lists, and -lm for the tests.
const SYSTEM_LIBRARIES: [&str; 7] = ["-lgcc_s", "-lutil", "-lrt", "-lpthread", "-lm", "-ldl", "-lc"];

fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/capi")
}

/// A library next to this test's executable: cargo puts all crate types of the package there.
fn library(name: &str) -> PathBuf {
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

enum Link {
    Static,
    Dynamic,
}

fn compile(name: &str, link: &Link) -> PathBuf {
    let suffix = if matches!(link, Link::Static) { "" } else { "_dynamic" };
    let executable = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}{suffix}"));
    let mut command = Command::new(std::env::var_os("CC").unwrap_or_else(|| "cc".into()));
    // From the sources' folder with a relative name, so that failures name the file and no machine's paths.
    command.current_dir(sources()).args(["-std=c99", "-O1", "-g", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]);
    command.args(["-I../../include", "-o"]).arg(&executable).arg(format!("{name}.c"));
    match link {
        Link::Static => command.arg(library("libstickslip.a")).args(SYSTEM_LIBRARIES),
        Link::Dynamic => {
            let path = library("libstickslip.so");
            let folder = path.parent().unwrap().display().to_string();
            command.arg(&path).arg(format!("-Wl,-rpath,{folder}")).args(["-lm", "-lpthread"])
        }
    };
    let output = command.output().unwrap_or_else(|e| panic!("the C compiler: {e}"));
    assert!(output.status.success(), "{name} does not compile:\n{}", String::from_utf8_lossy(&output.stderr));
    executable
}

fn run(name: &str, link: Link) {
    let output = Command::new(compile(name, &link)).output().unwrap();
    let printed = [output.stdout, output.stderr].concat();
    let printed = String::from_utf8_lossy(&printed);
    assert!(output.status.success(), "{name}: {}\n{printed}", output.status);
    assert!(printed.is_empty(), "{name} passed, but something was printed:\n{printed}");
}

macro_rules! c_tests {
    ($($(#[$attribute:meta])* $name:ident)*) => {
        $(
            #[test]
            $(#[$attribute])*
            fn $name() {
                run(stringify!($name), Link::Static);
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
    #[ignore = "an imported history is matched by its counts only"]
    t53_foreign_history
    #[ignore = "results that overflow go out as infinities"]
    t54_overflow
}

/// One test through the shared library.
#[test]
fn dynamic_link() {
    run("t31_interface_residual_tangent", Link::Dynamic);
}
