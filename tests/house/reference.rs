//! The header's comments as a reference: every function states its errors and its cost and explains every argument,
//! every real number has a unit, and the call sequence at the top names every function. What is said of the cost of an
//! evaluation is compared with what the counters count.

use crate::support::mesh::*;
use std::collections::BTreeSet;
use stickslip::geometry::Vec3;
use stickslip::interface::{Extent, Interface, MultiplierBasis, Options, Piece, Weights};

const HEADER: &str = include_str!("../../include/stickslip.h");
const ALLOCATION_TESTS: &str = include_str!("../memory/calls.rs");

/// A declaration and the comment above it.
struct Item {
    comment: String,
    code: String,
}

impl Item {
    fn says(&self, word: &str) -> bool {
        words(&self.comment).any(|w| w == word)
    }

    /// The paragraph of the comment that begins with `label`.
    fn part(&self, label: &str) -> Option<&str> {
        let rest = &self.comment[self.comment.find(&format!("\n{label}: "))? + label.len() + 3..];
        let end = ["\nCost: ", "\nOwner: "].iter().filter_map(|next| rest.find(next)).min();
        Some(&rest[..end.unwrap_or(rest.len())])
    }

    /// The identifier before the parenthesis of a function, or the last one of a member.
    fn name(&self) -> &str {
        let code = self.code.split(['(', '[', ';']).next().unwrap();
        words(code).last().unwrap()
    }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|w| !w.is_empty())
}

/// Declarations that end in a semicolon: the handle's type, members of structs, functions.
fn items() -> Vec<Item> {
    let (mut items, mut comment, mut code) = (Vec::new(), String::new(), String::new());
    for line in HEADER[HEADER.find("*/").unwrap()..].lines().map(str::trim) {
        if let Some(text) = line.strip_prefix("///") {
            comment += &format!("\n{}", text.trim());
        } else if line.is_empty() || line.starts_with('#') || line.ends_with(['{', '/']) || line.starts_with('}') {
            comment.clear();
        } else {
            code += &format!("{line} ");
            if line.ends_with(';') {
                items.push(Item { comment: std::mem::take(&mut comment), code: std::mem::take(&mut code) });
            }
        }
    }
    items
}

fn functions() -> Vec<Item> {
    items().into_iter().filter(|item| item.code.contains('(') && !item.code.starts_with("typedef")).collect()
}

/// The names of all functions and of all statuses.
fn names() -> (BTreeSet<String>, BTreeSet<&'static str>) {
    let functions: BTreeSet<_> = functions().iter().map(|f| f.name().to_owned()).collect();
    let defines = HEADER.lines().filter_map(|l| l.strip_prefix("#define STICKSLIP_"));
    let status = defines.skip_while(|l| !l.starts_with("OK ")).take_while(|l| !l.starts_with("FORM_"));
    (functions, status.map(|l| l.split(' ').next().unwrap()).collect())
}

#[test]
fn the_parser_finds_everything() {
    let (_, statuses) = names();
    assert_eq!(statuses.len(), stickslip::error::KINDS.len() + 2, "and success and a panic");
    let declared = HEADER.lines().map(str::trim).filter(|l| l.ends_with(';') && !l.starts_with(['}', '/', '*']));
    assert_eq!(items().len(), declared.count());
}

#[test]
fn functions_state_errors_cost_and_every_argument() {
    let (_, statuses) = names();
    for f in functions() {
        let name = f.name();
        if f.code.starts_with("int32_t") {
            let errors = f.part("Errors").unwrap_or_else(|| panic!("{name} does not state its errors"));
            let capitals = words(errors).filter(|w| w.len() > 2 && *w == w.to_uppercase() && *w != "NULL");
            for status in capitals {
                assert!(statuses.contains(status), "{name}: there is no error {status}");
            }
            assert!(words(errors).any(|w| statuses.contains(w)), "{name} names no error");
        }
        let cost = f.part("Cost").unwrap_or_else(|| panic!("{name} does not state its cost"));
        if cost.contains("allocates nothing") {
            assert!(ALLOCATION_TESTS.contains(name), "{name} claims to allocate nothing, which no test confirms");
        }
        let arguments = f.code[f.code.find('(').unwrap()..].split(',').filter_map(|a| words(a).last());
        for argument in arguments.filter(|a| !matches!(*a, "void" | "interface" | "skin")) {
            assert!(f.says(argument), "{name} does not explain {argument}");
        }
    }
}

#[test]
fn members_have_comments_and_reals_units() {
    for member in items().iter().filter(|item| !item.code.contains('(')) {
        let name = member.name();
        assert!(!member.comment.trim().is_empty(), "{} has no comment", member.code);
        if member.code.contains("double") {
            let unit = |w: &str| ["[-]", "[s]"].contains(&w) || w.starts_with("[F") || w.starts_with("[L");
            let unit = |w: &str| unit(w) || w.starts_with("[K") || w.starts_with("[T");
            let has_unit = member.comment.split([' ', '\n']).any(|w| unit(w.trim_end_matches(['.', ':', ';', ','])));
            assert!(has_unit, "{name} has no unit: {}", member.comment);
        }
    }
}

#[test]
fn the_call_sequence_names_every_function_and_no_other() {
    let head = &HEADER[..HEADER.find("*/").unwrap()];
    let sequence = &head[head.find("A host with an assembled interface:").unwrap()..];
    let (functions, _) = names();
    for name in &functions {
        let short = name.strip_prefix("stickslip_").unwrap();
        assert!(words(sequence).any(|w| w == short), "the header's first page does not mention {name}");
    }
    for word in words(sequence).filter(|w| w.contains('_') && !["nu_A", "M_A"].contains(w)) {
        assert!(functions.contains(&format!("stickslip_{word}")), "there is no function stickslip_{word}");
    }
}

/// What one call adds to the counters: searches, each with its integration, and pairs differentiated.
fn cost<T>(interface: &mut Interface, call: impl FnOnce(&mut Interface) -> T) -> (i64, bool) {
    let before = interface.counters();
    call(interface);
    let after = interface.counters();
    let searches = after.searches - before.searches;
    assert_eq!(after.pairs_integrated > before.pairs_integrated, searches > 0);
    (searches, after.pairs_linearised > before.pairs_linearised)
}

#[test]
fn evaluations_cost_what_the_header_says() {
    for (weights, search) in [(Weights::Current, 1), (Weights::Committed, 0), (Weights::Reference, 0)] {
        let differentiated = weights == Weights::Current;
        let Moved { mut interface, x1, x2, lambda } =
            moved(&Options { weights, ..options() }, [Cells::Quads; 2], FLAT, 1);
        assert_eq!(interface.counters().searches, 1, "creation");
        let i = &mut interface;
        assert_eq!(cost(i, |i| i.residual(&x1, &x2, &lambda, None).unwrap()), (search, false), "new positions");
        assert_eq!(cost(i, |i| i.residual(&x1, &x2, &lambda, None).unwrap()), (0, false), "the same again");
        assert_eq!(cost(i, |i| i.sums(&x1, &x2).unwrap()), (0, false));
        let sink = &mut |_: i64, _: i64, _: f64| ();
        assert_eq!(cost(i, |i| i.tangent(&x1, &x2, &lambda, None, sink).unwrap()), (0, differentiated));
        assert_eq!(cost(i, |i| i.pattern(&x1, &x2, Extent::Whole, sink).unwrap()), (0, false), "counting");
        let commit = i64::from(weights == Weights::Committed);
        assert_eq!(cost(i, |i| i.commit(&x1, &x2, &lambda, None).unwrap()), (commit, false));
        assert_eq!(cost(i, |i| i.residual(&x1, &x2, &lambda, None).unwrap()), (search, false), "first after a commit");
        assert_eq!(cost(i, |i| i.roll_back().unwrap()), (0, false));
        assert_eq!(cost(i, |i| i.set_previous(&x1, &x2).unwrap()), (1, false));
    }
}

#[test]
fn systems_without_multipliers_cost_what_the_header_says() {
    for (weights, search) in [(Weights::Current, 1), (Weights::Committed, 0), (Weights::Reference, 0)] {
        let differentiated = weights == Weights::Current;
        let of = Options { weights, basis: MultiplierBasis::Dual, ..options() };
        let Moved { mut interface, x1, x2, lambda } = moved(&of, [Cells::Quads; 2], FLAT, 1);
        let (i, x, host) = (&mut interface, (&x1[..], &x2[..]), vec![Vec3::z(); x1.len()]);
        let piece = |i: &mut Interface, piece| {
            let sink = &mut |_: i64, _: i64, _: f64| ();
            cost(i, |i| i.condensed_tangent(x, &lambda, piece, sink).unwrap())
        };
        assert_eq!(cost(i, |i| i.condensed_multipliers(x.0, x.1, &host).unwrap()), (search, false), "new positions");
        assert_eq!(cost(i, |i| i.condensed_residual(x.0, x.1, &lambda, &host).unwrap()), (0, false));
        assert_eq!(piece(i, Piece::Elimination), (0, false));
        assert_eq!(piece(i, Piece::Forces), (0, differentiated));
        assert_eq!(piece(i, Piece::Constraints), (0, differentiated));
    }
}
