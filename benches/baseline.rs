//! Compiles and loads the C++ baseline.

use std::ffi::{CString, c_int, c_void};
use std::path::Path;
use std::process::Command;

/// Where its headers are; not part of this project.
const HEADERS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/baseline");
const SOURCE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/baseline.cpp");

/// The baseline's two functions.
pub struct Baseline {
    pairs: unsafe extern "C" fn(c_int, *mut f64),
    pass: unsafe extern "C" fn(c_int, *const f64) -> f64,
}

impl Baseline {
    /// `None`, with a word, where headers or compiler are absent.
    pub fn load() -> Option<Baseline> {
        if !Path::new(HEADERS).exists() {
            println!("No baseline: {HEADERS} is absent. Times without ratios, on pairs made here.");
            return None;
        }
        let library = std::env::temp_dir().join(format!("stickslip_baseline_{}.so", std::process::id()));
        let compiler = std::env::var("CXX").unwrap_or_else(|_| "c++".into());
        let compiled = Command::new(&compiler)
            .args(["-std=c++17", "-O3", "-march=native", "-shared", "-fPIC", "-I", HEADERS, SOURCE, "-o"])
            .arg(&library)
            .status();
        if !compiled.is_ok_and(|s| s.success()) {
            println!("No baseline: {compiler} does not compile it. Times without ratios, on pairs made here.");
            return None;
        }
        let path = CString::new(library.to_str()?).ok()?;
        // SAFETY: the library was made of `SOURCE` just now and has no initialisers; it stays loaded.
        let baseline = unsafe {
            let handle = libc::dlopen(path.as_ptr(), libc::RTLD_NOW);
            assert!(!handle.is_null(), "the baseline does not load");
            Baseline {
                pairs: std::mem::transmute::<*mut c_void, unsafe extern "C" fn(c_int, *mut f64)>(symbol(
                    handle,
                    c"baseline_pairs",
                )),
                pass: std::mem::transmute::<*mut c_void, unsafe extern "C" fn(c_int, *const f64) -> f64>(symbol(
                    handle,
                    c"baseline_pass",
                )),
            }
        };
        let _ = std::fs::remove_file(library);
        Some(baseline)
    }

    /// n pairs of quadrilaterals, 24 coordinates each.
    pub fn pairs(&self, n: usize) -> Vec<f64> {
        let mut x = vec![0.0; 24 * n];
        // SAFETY: writes 24 n doubles.
        unsafe { (self.pairs)(n as c_int, x.as_mut_ptr()) };
        x
    }

    /// Weights of all pairs.
    pub fn pass(&self, x: &[f64]) -> f64 {
        // SAFETY: reads 24 n doubles.
        unsafe { (self.pass)((x.len() / 24) as c_int, x.as_ptr()) }
    }
}

fn symbol(handle: *mut c_void, name: &std::ffi::CStr) -> *mut c_void {
    // SAFETY: an open library and a C string.
    let symbol = unsafe { libc::dlsym(handle, name.as_ptr()) };
    assert!(!symbol.is_null(), "the baseline lacks {name:?}");
    symbol
}
