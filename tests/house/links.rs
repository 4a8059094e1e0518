//! Links of the documents: each leads to a file of the repository and, where it names a heading, to one that is there. The site
//! of `make docs` has the same links; it is looked at once more when it is built (docs/site/check_links.py).

use crate::support::files::{below, root};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

const FOLDERS: [&str; 10] =
    ["docs", "hosts", "python", "packaging", "program", "c_examples", "studies", "benches", "fuzz", "tests"];
/// What is not in the repository.
const WITHOUT: [&str; 4] = ["target", "corpus", "artifacts", "build"];

/// All documents of the repository.
pub fn documents() -> Vec<PathBuf> {
    let mut found: Vec<_> = fs::read_dir(root())
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "md"))
        .collect();
    found.extend(FOLDERS.iter().flat_map(|f| below(&root().join(f), &["md"], &WITHOUT)));
    found
}

/// The lines outside of code blocks.
fn prose(text: &str) -> Vec<&str> {
    let mut fenced = false;
    let outside = |line: &&str| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        !fenced && !fence
    };
    text.lines().filter(outside).collect()
}

/// Targets of links and pictures. A link's text may have begun in the line before.
fn targets(text: &str) -> Vec<String> {
    let joined = prose(text).join("\n");
    joined.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0.to_owned())).collect()
}

/// The labels that hosting sites derive from headings.
fn labels(text: &str) -> BTreeSet<String> {
    let headings = prose(text).into_iter().filter(|l| l.starts_with('#'));
    let label = |heading: &str| -> String {
        let words = heading.trim_start_matches('#').trim().to_lowercase();
        words
            .chars()
            .filter(|c| c.is_alphanumeric() || " _-".contains(*c))
            .map(|c| if c == ' ' { '-' } else { c })
            .collect()
    };
    headings.map(label).collect()
}

/// What of a document's links leads nowhere.
fn broken(document: &Path, text: &str) -> Vec<String> {
    let leads_nowhere = |target: &String| {
        let (path, label) = target.split_once('#').unwrap_or((target, ""));
        let to = if path.is_empty() { document.to_owned() } else { document.parent().unwrap().join(path) };
        if !path.is_empty() && !to.exists() {
            return true;
        }
        let marked = to.extension().is_some_and(|e| e == "md") && !label.is_empty();
        let own = path.is_empty();
        marked && !labels(&if own { text.to_owned() } else { fs::read_to_string(&to).unwrap() }).contains(label)
    };
    targets(text).into_iter().filter(|t| !t.contains("://")).filter(leads_nowhere).collect()
}

#[test]
fn every_link_of_a_document_leads_somewhere() {
    let mut seen = 0;
    for document in documents() {
        let text = fs::read_to_string(&document).unwrap();
        seen += targets(&text).len();
        let broken = broken(&document, &text);
        assert!(broken.is_empty(), "{}: {broken:?}", document.display());
    }
    assert!(seen > 60, "{seen} links");
}

#[test]
fn links_that_lead_nowhere_are_noticed() {
    let document = root().join("docs/planted.md");
    let text = "# A `b`, c\n[x](gone.md) [y](plug_in.md#no-such-heading) [z](#a-b) [good](#a-b-c), ![p](figures/block.png)\n\
                ```\n[code](is.not)\n```\n[web](https://example.org) [good](host_refusals.md#statuses)";
    assert_eq!(broken(&document, text), ["gone.md", "plug_in.md#no-such-heading", "#a-b"]);
}
