//! Citations lead somewhere: every "docs/formulation 3.2" in the repository names a section that is there, every row of
//! the hard tests stands in its table, and nothing cites what is not in the repository.

use crate::support::files::{below, root};
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

const FOLDERS: [&str; 10] =
    ["src", "include", "program", "c_examples", "studies", "tests", "benches", "fuzz", "docs", "cmake"];
const ENDINGS: [&str; 10] = ["rs", "c", "h", "f90", "py", "md", "yaml", "toml", "cmake", "sh"];
/// Folders of data, and what is not in the repository.
const WITHOUT: [&str; 5] = ["target", "corpus", "seeds", "artifacts", "data"];
/// A page a chapter, whose name begins with its number.
const DOCUMENT: &str = "docs/formulation";
/// Beginnings of what was cited once and is elsewhere.
const OUTSIDE: [&str; 4] = ["kernel notes ", "design section ", "touch notes ", "formulation "];

/// Every text of the repository, line breaks within comments taken out, so that a citation over two lines is one.
fn texts() -> Vec<(String, String)> {
    let mut found = vec![root().join("README.md"), root().join("ARCHITECTURE.md"), root().join("CHANGELOG.md")];
    let folders = FOLDERS.iter().map(|f| root().join(f)).filter(|f| f.is_dir());
    let files = folders.flat_map(|f| below(&f, &ENDINGS, &WITHOUT));
    found.extend(files.filter(|f| !f.ends_with("citations.rs")));
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).ok()?;
        let line = |l: &str| l.trim_start().trim_start_matches(['/', '!', '#', '*']).trim().to_owned();
        let joined = text.lines().map(line).collect::<Vec<_>>().join(" ");
        Some((path.strip_prefix(root()).unwrap().to_string_lossy().into_owned(), joined))
    };
    found.into_iter().filter_map(read).collect()
}

fn pages() -> String {
    below(&root().join(DOCUMENT), &["md"], &[]).iter().map(|page| fs::read_to_string(page).unwrap()).collect()
}

/// "3.2" and "3" of the headings "## 3.2 Projected nodes"; in section 7, a list, its items "2." as "7.2".
fn sections() -> BTreeSet<String> {
    let (mut found, mut chapter) = (BTreeSet::new(), String::new());
    for line in pages().lines() {
        if let Some(heading) = line.strip_prefix("# ").or_else(|| line.strip_prefix("## ")) {
            let number = heading.split(' ').next().unwrap().to_owned();
            chapter = if line.starts_with("# ") { number.clone() } else { chapter };
            found.insert(number);
        } else if let Some((number, _)) = line.split_once(". ")
            && number.parse::<u32>().is_ok()
        {
            found.insert(format!("{chapter}.{number}"));
        }
    }
    found
}

/// The numbers behind a citation: "3.3", or "2, 3".
fn numbers(behind: &str) -> Vec<String> {
    let end = behind.find(|c: char| !(c.is_ascii_digit() || ". ,".contains(c))).unwrap_or(behind.len());
    let parts = behind[..end].split(',').map(|n| n.trim().trim_end_matches('.').to_owned());
    parts.filter(|n| !n.is_empty()).collect()
}

#[test]
fn every_section_that_is_cited_exists() {
    let (sections, mut cited) = (sections(), 0);
    assert!(sections.contains("3.5") && sections.contains("7.4"), "{sections:?}");
    for (path, text) in texts() {
        for (at, _) in text.match_indices(&format!("{DOCUMENT} ")) {
            let behind: String = text[at + DOCUMENT.len() + 1..].chars().take(40).take_while(|c| *c != ')').collect();
            for number in numbers(&behind) {
                assert!(sections.contains(&number), "{path} cites section {number}, which {DOCUMENT} has not");
                cited += 1;
            }
        }
    }
    assert!(cited > 30, "{cited}");
}

#[test]
fn nothing_that_is_cited_lies_outside() {
    for (path, text) in texts() {
        for outside in OUTSIDE {
            for (at, _) in text.match_indices(outside) {
                // Words of a sentence are no citation: one names a section by a letter and a number, or by a capital.
                let behind: Vec<char> = text[at + outside.len()..].chars().take(3).collect();
                let is_section = match behind[..] {
                    [a, b, _] if outside == "formulation " => {
                        a.is_ascii_lowercase() && (b == '.' || b == ';' || b == ',' || b == ')')
                    }
                    [a, ..] => a.is_ascii_uppercase() || a.is_ascii_digit(),
                    [] => false,
                };
                let is_section = is_section && !text[..at].ends_with("docs/");
                let here: String = text[at..].chars().take(outside.len() + 20).collect();
                assert!(!is_section, "{path} cites what is not in the repository: {here}");
            }
        }
    }
}

#[test]
fn every_row_of_the_hard_tests_stands_in_the_table() {
    let text = pages();
    let rows: BTreeSet<_> = text.lines().filter_map(|l| l.strip_prefix("| ")?.split(' ').next()).collect();
    let table = fs::read_to_string(root().join("tests/properties/main.rs")).unwrap();
    let mut named = 0;
    for line in table.lines().filter(|l| l.starts_with("//! | ")) {
        for word in line[6..].split('|').next().unwrap().split([' ', ',']) {
            let is_row = word.len() == 2 && "WSKI".contains(&word[..1]) && word[1..].parse::<u32>().is_ok();
            assert!(!is_row || rows.contains(word), "{word}");
            named += usize::from(is_row);
        }
    }
    assert!(named > 20, "{named}");
}
