//! The program's table of keys (program/scene/keys) and what reads them: each key that a source reads has a row, and each row,
//! and each word that a row allows, stands in a source that reads it.

use crate::support::files::{below, root};
use std::collections::BTreeSet;
use std::fs;

/// Row of the table: key, kind, and what it holds.
fn rows() -> Vec<(String, String, String)> {
    let text: String = below(&root().join("program/scene/keys"), &["c"], &[])
        .iter()
        .map(|path| fs::read_to_string(path).unwrap())
        .collect();
    text.lines().filter_map(row).collect()
}

fn row(line: &str) -> Option<(String, String, String)> {
    let (key, rest) = line.strip_prefix("  {\"")?.split_once("\", ")?;
    let (kind, rest) = rest.strip_prefix("KEY_")?.split_once(", \"")?;
    Some((key.to_owned(), kind.to_owned(), rest.split_once('"')?.0.to_owned()))
}

/// The sources that may read keys: all but the table.
fn sources() -> String {
    let files = below(&root().join("program"), &["c"], &["keys", "tests"]);
    files.iter().map(|path| fs::read_to_string(path).unwrap()).collect()
}

/// The keys that a source asks a scene for: the third argument of `scene_...(scene, map, "key", ...`.
fn keys_read(source: &str) -> BTreeSet<String> {
    let calls = source.match_indices("scene_").map(|(at, _)| &source[at..]);
    let key = |call: &str| {
        let is_reader =
            |name: &str| !name.starts_with("scene_fail") && name.chars().all(|c| c.is_alphanumeric() || c == '_');
        let (_, arguments) = call.split_once('(').filter(|(name, _)| is_reader(name))?;
        let mut parts = arguments.splitn(4, ',').skip(2);
        let word = parts.next()?.trim().trim_end_matches([')', ';', '\n', ' ']);
        let word = word.strip_prefix('"')?.strip_suffix('"')?;
        word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_').then(|| word.to_owned())
    };
    calls.filter_map(key).collect()
}

/// All texts that are one word.
fn texts(source: &str) -> BTreeSet<&str> {
    source.split('"').filter(|t| !t.is_empty() && t.chars().all(|c| c.is_alphanumeric() || c == '_')).collect()
}

#[test]
fn every_key_that_is_read_has_a_row() {
    let (rows, read) = (rows(), keys_read(&sources()));
    let keys: BTreeSet<_> = rows.iter().map(|r| r.0.as_str()).collect();
    assert!(read.len() > 100 && read.contains("mortar_side"), "{read:?}");
    let without: Vec<_> = read.iter().filter(|k| !keys.contains(k.as_str())).collect();
    assert!(without.is_empty(), "{without:?}");
}

#[test]
fn every_row_and_every_word_is_read() {
    let (rows, sources) = (rows(), sources());
    let texts = texts(&sources);
    assert!(rows.len() > 150, "{}", rows.len());
    let mut unread: Vec<_> = rows.iter().map(|r| r.0.as_str()).filter(|key| !texts.contains(key)).collect();
    let words = rows.iter().filter(|r| r.1 == "WORD").flat_map(|r| r.2.split(' ').map(|w| (r.0.as_str(), w)));
    unread.extend(words.filter(|(_, word)| !texts.contains(word)).map(|(_, word)| word));
    assert!(unread.is_empty(), "{unread:?}");
}

#[test]
fn rows_and_reads_are_found() {
    let source =
        "scene_real(scene, name, \"friction\", &mu); scene_fail(scene, map, \"law\",\n \"is (not) there\"); f(\"no\")";
    assert_eq!(keys_read(source).into_iter().collect::<Vec<_>>(), ["friction"]);
    assert!(texts(source).contains("no") && !texts(source).contains("there"));
    let line = "  {\"law\", KEY_WORD, \"coulomb none\", ANY, \"coulomb\", \"what holds\"},";
    assert_eq!(row(line).unwrap(), ("law".into(), "WORD".into(), "coulomb none".into()));
    assert!(row("  KEY_TABLE(\"laws\", \"interfaces\", LAWS),").is_none());
}
