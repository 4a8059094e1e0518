//! Shared by the integration tests: the golden vectors and a few ways to compare.
#![allow(dead_code)]

pub mod c;
pub mod differences;
pub mod exact;
pub mod files;
pub mod host;
pub mod lines;
pub mod mesh;
pub mod parents;
pub mod parts;
pub mod press;
pub mod random;
pub mod rigid;
pub mod solid;

use nalgebra::{DMatrix, DVector, Vector3};
use serde_json::Value;
use std::path::{Path, PathBuf};
use stickslip::geometry::{Facet, Vec3};

/// The cases of a golden file: the full set where it is present, else the project's own small copy.
pub fn golden(file: &str) -> Vec<Value> {
    golden_part(file, "cases")
}

/// The cases of one part of it.
pub fn golden_part(file: &str, part: &str) -> Vec<Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let full: PathBuf = root.join("../shared/golden").join(file);
    let path = if full.exists() {
        full
    } else {
        println!("../shared/golden/{file} is absent: using the essential vectors in tests/data");
        root.join("tests/data").join(file)
    };
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let value: Value = serde_json::from_str(&text).unwrap();
    let cases = value[part].as_array().unwrap().clone();
    assert!(cases.len() >= 3, "{} holds too few cases to mean anything", path.display());
    cases
}

/// The host of the golden condensed systems: the derivative and the value of the residual of n equations.
pub fn golden_host(n: usize) -> (DMatrix<f64>, DVector<f64>) {
    let entry = |i: usize, j: usize| ((7 * i + 13 * j) % 17) as f64 / 16.0 - 0.5 + if i == j { 20.0 } else { 0.0 };
    (DMatrix::from_fn(n, n, entry), DVector::from_fn(n, |i, _| ((5 * i) % 11) as f64 / 8.0 - 0.625))
}

pub fn numbers(v: &Value) -> Vec<f64> {
    v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

pub fn table(v: &Value) -> Vec<Vec<f64>> {
    v.as_array().unwrap().iter().map(numbers).collect()
}

pub fn points(v: &Value) -> Vec<Vec3> {
    table(v).iter().map(|p| Vector3::new(p[0], p[1], p[2])).collect()
}

pub fn facet(v: &Value) -> Facet {
    Facet::new(&points(v)).unwrap()
}

pub fn name(case: &Value) -> &str {
    case["name"].as_str().unwrap()
}

pub fn max_abs(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |m, v| m.max(v.abs()))
}
