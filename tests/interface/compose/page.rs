//! docs/compose.md and the sentences of the header that say what something does not go with are made from the table: `make compose`
//! renews them, and then `make header` the header.

use crate::support::files::root;
use std::fmt::Write;
use stickslip::interface::compose::{About, FEATURES, Feature, ROWS, Row, Verdict};

/// How its sentences begin in src/capi.
const LABEL: &str = "Not with (UNSUPPORTED):";
/// Columns of a line of the header.
const WIDTH: usize = 125;

/// Where the header says what a feature does not go with: file of src/capi, what the comment stands before.
const PLACES: [(&str, &str, Feature); 21] = [
    ("method.rs", "pub const STICKSLIP_BASIS_STANDARD:", Feature::StandardBasis),
    ("method.rs", "pub const STICKSLIP_BASIS_DUAL:", Feature::DualBasis),
    ("space.rs", "pub const STICKSLIP_SPACE_SUB:", Feature::AllNodes),
    ("method.rs", "pub const STICKSLIP_FORM_AUGMENTED:", Feature::Augmented),
    ("method.rs", "pub const STICKSLIP_NORMALS_CURRENT:", Feature::NormalsNow),
    ("method.rs", "pub const STICKSLIP_WEIGHTS_CONSERVING:", Feature::Conserving),
    ("method.rs", "pub const STICKSLIP_SLIP_PAPER:", Feature::PaperSlip),
    ("options.rs", "pub const STICKSLIP_FRICTION_TIED:", Feature::Tied),
    ("method.rs", "pub const STICKSLIP_DECISION_POINTS:", Feature::Points),
    ("method.rs", "pub const STICKSLIP_INTEGRATION_ELEMENTS:", Feature::ElementPoints),
    ("method.rs", "pub const STICKSLIP_TANGENT_FROZEN_WEIGHTS:", Feature::FrozenTangent),
    ("method.rs", "pub const STICKSLIP_TANGENT_FROZEN_NORMALS:", Feature::FrozenNormals),
    ("options.rs", "pub const STICKSLIP_MORTAR_ANALYTIC:", Feature::Analytic),
    ("law.rs", "pub const STICKSLIP_LAW_ORTHOTROPIC:", Feature::Orthotropic),
    ("law.rs", "pub unsafe extern \"C\" fn stickslip_interface_set_law(", Feature::OwnLaw),
    ("layer.rs", "pub unsafe extern \"C\" fn stickslip_interface_set_layer(", Feature::Layer),
    ("offsets.rs", "pub unsafe extern \"C\" fn stickslip_interface_set_offsets(", Feature::Offsets),
    ("interface.rs", "pub unsafe extern \"C\" fn stickslip_interface_set_committed(", Feature::NodeHistory),
    ("condensed.rs", "pub unsafe extern \"C\" fn stickslip_interface_condensed_multipliers(", Feature::Condensed),
    ("condensed.rs", "pub unsafe extern \"C\" fn stickslip_interface_condensed_csr(", Feature::InPlace),
    ("heat.rs", "pub unsafe extern \"C\" fn stickslip_interface_heat_tangent_coo(", Feature::HeatMotion),
];

fn others(row: &Row, feature: Feature) -> String {
    let others: Vec<_> = row.features.as_slice().iter().filter(|f| **f != feature).map(|f| f.name()).collect();
    others.join(" and ")
}

/// The sentence of a feature, as a comment.
fn not_with(feature: Feature) -> String {
    let rows: Vec<_> =
        ROWS.iter().filter(|row| row.features.as_slice().contains(&feature)).map(|row| others(row, feature)).collect();
    let text = if rows.is_empty() { "nothing.".to_owned() } else { format!("{}.", rows.join("; ")) };
    let (mut lines, mut line) = (String::new(), format!("/// {LABEL}"));
    for word in text.split(' ') {
        if line.len() + 1 + word.len() > WIDTH {
            lines += &format!("{line}\n");
            line = "///".to_owned();
        }
        line += &format!(" {word}");
    }
    format!("{lines}{line}\n")
}

/// A file's text with the sentence before an item in place of what stands there: from the label to the line that ends with a full stop.
fn renewed(text: &str, item: &str, feature: Feature) -> String {
    let end = text.find(&format!("\n{item}")).unwrap_or_else(|| panic!("there is no {item}"));
    let comment = text[..end].rfind("\n\n").map_or(0, |k| k + 1);
    let label = format!("/// {LABEL}");
    let first = text[comment..end].rfind(&label).map(|k| comment + k);
    let first = first.unwrap_or_else(|| panic!("the comment of {item} lacks `{label}`"));
    let mut last = first;
    for line in text[first..].split_inclusive('\n') {
        last += line.len();
        if line.ends_with(".\n") {
            break;
        }
    }
    format!("{}{}{}", &text[..first], not_with(feature), &text[last..])
}

fn mark(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Meaningless => "-",
        Verdict::NotBuilt => "x",
    }
}

/// What the table says of two features, with others or alone.
fn cell(one: Feature, two: Feature) -> String {
    let both = |row: &&Row| row.features.as_slice().contains(&one) && row.features.as_slice().contains(&two);
    match ROWS.iter().filter(both).min_by_key(|row| row.features.as_slice().len()) {
        None => String::new(),
        Some(row) if row.features.as_slice().len() == 2 => mark(row.verdict).to_owned(),
        Some(row) => format!("({})", mark(row.verdict)),
    }
}

fn page() -> String {
    let mut page = String::from(PREFACE);
    let named: Vec<&About> = FEATURES
        .iter()
        .filter(|about| ROWS.iter().any(|row| row.features.as_slice().contains(&about.feature)))
        .collect();
    let numbers: Vec<String> = (1..named.len()).map(|k| k.to_string()).collect();
    writeln!(page, "| | | {} |", numbers.join(" | ")).unwrap();
    writeln!(page, "|---|---|{}", "---|".repeat(numbers.len())).unwrap();
    for (k, about) in named.iter().enumerate() {
        let cells: Vec<String> = named[..k].iter().map(|other| cell(other.feature, about.feature)).collect();
        let rest = numbers.len() - k.min(numbers.len());
        writeln!(
            page,
            "| {} | {} | {}{}",
            k + 1,
            about.name,
            cells.iter().fold(String::new(), |all, c| all + c + " | "),
            " |".repeat(rest)
        )
        .unwrap();
    }
    page += LIST;
    for row in &ROWS {
        let together: Vec<_> = row.features.as_slice().iter().map(|f| f.name()).collect();
        let ways: Vec<_> = row.without.as_slice().iter().map(|f| f.without()).collect();
        let why = row.why();
        let verdict = if row.verdict == Verdict::Meaningless { "meaningless" } else { "not built" };
        writeln!(page, "| {} | {verdict} | {why} | {} |", together.join(" with "), ways.join(", or ")).unwrap();
    }
    page
}

const PREFACE: &str = "# What goes with what

A choice goes with every other one, unless this page says that it does not. `make compose` makes the page from the table of the library
(`src/interface/compose/table.rs`), and the library's refusals are sentences of the same table. A refusal has the status
`STICKSLIP_UNSUPPORTED`. It comes at the creation of an interface where options and surfaces do not go together, else from the call that
brings what does not go. Numbers that are out of their range are refused elsewhere, with other statuses.

`tests/interface/compose` tries every pair of choices and random combinations: what the page does not name works. Paths that begin with `src` or
`tests` are those of the source tree.

In the first table an empty place says that two things go together. `-` says that they do not by what they mean, `x` that this version has
not built it, and brackets that a third one belongs to it. The second table says which.

";

const LIST: &str = "
| together | verdict | why | way out |
|---|---|---|---|
";

/// Writes where it is asked to, and says what is out of date.
fn is_up_to_date(path: &str, expected: &str) {
    let file = root().join(path);
    if std::env::var_os("STICKSLIP_WRITE_COMPOSE").is_some() {
        std::fs::write(&file, expected).unwrap();
    }
    let committed = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(committed == expected, "{path} is out of date: `make compose` renews it");
}

#[test]
fn the_page_is_up_to_date() {
    is_up_to_date("docs/compose.md", &page());
}

#[test]
fn sentences_of_the_header_are_up_to_date() {
    for (file, item, feature) in PLACES {
        let path = format!("src/capi/{file}");
        let text = std::fs::read_to_string(root().join(&path)).unwrap();
        is_up_to_date(&path, &renewed(&text, item, feature));
    }
}
