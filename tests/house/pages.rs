//! Pages have a job each: none is long, and a user meets few keys of an interface.

use crate::links::documents;
use crate::support::files::root;
use std::fs;

const MOST_LINES: usize = 400;
/// What a user can know of an interface.
const MOST_KEYS: usize = 12;
const SCENES: &str = "c_examples/scenes";

/// All pages of the repository but the list of what changed, with their names.
fn pages() -> Vec<(String, String)> {
    let found = documents().into_iter().filter(|p| !p.ends_with("CHANGELOG.md"));
    found.map(|p| (p.display().to_string(), fs::read_to_string(p).unwrap())).collect()
}

/// Words in code letters in the first column of a table.
fn keys_of_tables(text: &str) -> Vec<&str> {
    let columns = text.lines().filter_map(|l| l.strip_prefix("| `")?.split(" | ").next());
    columns.flat_map(|c| c.split([',', '`', ' ']).filter(|w| !w.is_empty())).collect()
}

#[test]
fn pages_are_short() {
    let pages = pages();
    assert!(pages.len() > 20, "{}", pages.len());
    for (name, text) in pages {
        assert!(text.lines().count() <= MOST_LINES, "{name} has {} lines", text.lines().count());
    }
}

#[test]
fn a_user_meets_few_keys_of_an_interface() {
    let text = fs::read_to_string(root().join(SCENES).join("README.md")).unwrap();
    let section = text.split("### An interface").nth(1).unwrap().split("\n## ").next().unwrap();
    let keys = keys_of_tables(section);
    assert!(keys.contains(&"nonmortar") && keys.len() <= MOST_KEYS, "{keys:?}");
}

#[test]
fn keys_are_found() {
    assert_eq!(keys_of_tables("| key | what |\n|---|---|\n| `a`, `b` | `c` |\n"), ["a", "b"]);
}
