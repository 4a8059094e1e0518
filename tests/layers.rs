//! The direction of dependencies (ARCHITECTURE.md): leaf mathematics knows no contact, the law knows no
//! integration, only `capi` and `simd` are unsafe.

mod support;

use std::path::PathBuf;
use support::files::{below, root};

/// Modules and what each may import, lowest first.
const ALLOWED: [(&str, &[&str]); 12] = [
    ("error", &[]),
    ("memory", &["error"]),
    ("adjacency", &["error", "memory"]),
    ("simd", &[]),
    ("shape", &["error", "simd"]),
    ("quadrature", &["error"]),
    ("geometry", &["error", "shape", "simd"]),
    ("normal", &["error", "geometry"]),
    ("mortar", &["error", "geometry", "quadrature", "shape", "simd"]),
    ("law", &["error", "geometry"]),
    ("element", &["error", "geometry", "law", "mortar", "shape", "simd"]),
    (
        "interface",
        &[
            "adjacency",
            "element",
            "error",
            "geometry",
            "law",
            "memory",
            "mortar",
            "normal",
            "quadrature",
            "shape",
            "simd",
        ],
    ),
];

fn sources(module: &str) -> Vec<PathBuf> {
    let file = root().join(format!("src/{module}.rs"));
    if file.exists() { vec![file] } else { below(&root().join("src").join(module), &["rs"], &[]) }
}

/// Top-level modules named after `crate::` in a file.
fn imports(text: &str) -> impl Iterator<Item = &str> {
    text.split("crate::")
        .skip(1)
        .map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or(""))
}

#[test]
fn imports_point_downward() {
    for (module, allowed) in ALLOWED {
        for file in sources(module) {
            let text = std::fs::read_to_string(&file).unwrap();
            for import in imports(&text) {
                let fine = import == module || allowed.contains(&import);
                assert!(fine, "{}: crate::{import} is not below {module}", file.display());
            }
        }
    }
}

#[test]
fn only_the_abi_and_the_processors_instructions_are_unsafe() {
    for (module, _) in ALLOWED {
        for file in sources(module) {
            let text = std::fs::read_to_string(&file).unwrap();
            for word in ["unsafe ", "libc::", "*const ", "*mut "] {
                if module == "simd" && word == "unsafe " {
                    continue;
                }
                assert!(!text.contains(word), "{} contains '{word}'", file.display());
            }
        }
    }
}
