//! Pages have a job each: none is long, a user meets few keys of an interface, and no key that the
//! driver reads is without words.

use crate::links::documents;
use crate::support::files::{below, root};
use std::collections::BTreeSet;
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

/// The keys that a source of the driver asks a scene for: the third argument of `scene_...(scene, map, "key", ...`.
fn keys_read(source: &str) -> BTreeSet<String> {
    let calls = source.match_indices("scene_").map(|(at, _)| &source[at..]);
    let key = |call: &str| {
        let (_, arguments) =
            call.split_once('(').filter(|(name, _)| name.chars().all(|c| c.is_alphanumeric() || c == '_'))?;
        let mut parts = arguments.splitn(4, ',').skip(2);
        let word = parts.next()?.trim().trim_end_matches([')', ';', '\n', ' ']);
        let word = word.strip_prefix('"')?.strip_suffix('"')?;
        word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_').then(|| word.to_owned())
    };
    calls.filter_map(key).collect()
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
fn every_key_that_the_driver_reads_has_words() {
    let mut text: String = pages().into_iter().filter(|(n, _)| n.contains(SCENES)).map(|(_, t)| t).collect();
    text += &fs::read_to_string(root().join("docs/dynamics.md")).unwrap();
    let code: BTreeSet<&str> =
        text.split('`').skip(1).step_by(2).flat_map(|c| c.split(|c: char| !c.is_alphanumeric() && c != '_')).collect();
    let sources = below(&root().join("program"), &["c"], &[]);
    let read: BTreeSet<_> = sources.iter().flat_map(|p| keys_read(&fs::read_to_string(p).unwrap())).collect();
    assert!(read.len() > 100 && read.contains("nonmortar"), "{read:?}");
    let silent: Vec<_> = read.iter().filter(|k| !code.contains(k.as_str())).collect();
    assert!(silent.is_empty(), "{silent:?}");
}

#[test]
fn keys_are_found() {
    let source =
        "scene_real(scene, name, \"friction\", &mu); scene_fail(scene, map, \"law\",\n \"is (not) there\"); f(\"no\")";
    assert_eq!(keys_read(source).into_iter().collect::<Vec<_>>(), ["friction", "law"]);
    assert_eq!(keys_of_tables("| key | what |\n|---|---|\n| `a`, `b` | `c` |\n"), ["a", "b"]);
}
