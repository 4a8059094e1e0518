//! The report of covered nodes, and what it says of surfaces that do not meet.

mod support;

use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Cover, Finding, Friction, Options, Shortcuts, Weights};
use support::mesh::*;

/// Rounding of a covered area over a nodal area.
const ROUNDING: f64 = 1e-12;

fn covers(report: &stickslip::interface::Report) -> Vec<Cover> {
    report.nodes.iter().map(|n| n.cover).collect()
}

/// Three facets in a row, the plate ends within the second one: covered in full, in part and not at all.
#[test]
fn full_part_and_none_at_an_edge() {
    let one = grid(3, 1, [0.0, 0.0], [3.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(4, 2, [-1.0, -1.0], [1.25, 2.0], -0.25, true, Cells::Quads);
    let expected = [Cover::Full, Cover::Part, Cover::Part, Cover::None];
    for weights in [Weights::Current, Weights::Committed, Weights::Reference] {
        let mut i = interface(&one, &two, Options { weights, ..options() });
        let report = i.report(&one.x, &two.x).unwrap();
        assert_eq!(covers(&report), [expected, expected].concat(), "{weights:?}");
        // N of the third node over a quarter of the second facet: 1/2 (1/4)^2 of an area of 1, of a nodal area of 1.
        let fractions = [1.0, 1.0 - 0.75 * 0.75 / 2.0, 1.0 / 32.0, 0.0];
        for (n, expected) in report.nodes.iter().zip(fractions.iter().cycle()) {
            assert!((n.fraction - expected).abs() < ROUNDING, "{} {expected}", n.fraction);
        }
        let layers: Vec<_> = report.nodes[..4].iter().map(|n| n.layers).collect();
        assert_eq!(layers, [1, 1, 1, 0]);
        assert_eq!((report.penetration, report.finding), (0.0, None), "it is open by 0.25");
        let text = report.text().unwrap();
        assert!(text.starts_with("Of 8 non-mortar nodes 2 are covered in full, 4 in part, 2 not at all"), "{text}");
        assert!(text.contains(", to 3.1"), "{text}");
    }
    // The mortar facets that claim a node, each once though several facets around it meet it.
    let mut i = interface(&one, &two, options());
    let claims: Vec<_> = i.report(&one.x, &two.x).unwrap().nodes.iter().map(|n| n.facets).collect();
    let columns = |a: f64, b: f64| {
        (0..4).filter(|c| f64::from(*c) * 0.5625 - 1.0 < b && (f64::from(*c) + 1.0) * 0.5625 - 1.0 > a).count() as i64
    };
    // The plate's rows meet at y = 0.5: both rows claim every node.
    let expected = [2 * columns(0.0, 1.0), 2 * columns(0.0, 2.0), 2 * columns(1.0, 3.0), 0];
    assert_eq!(claims, [expected, expected].concat());
}

/// Covered by less than what several layers are told apart by.
#[test]
fn a_hardly_covered_node_has_one_layer() {
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [-1.0, -1.0], [0.004, 2.0], 0.0, true, Cells::Quads);
    let report = interface(&one, &two, options()).report(&one.x, &two.x).unwrap();
    assert!(report.nodes.iter().all(|n| n.cover == Cover::Part && n.layers == 1), "{report:?}");
}

#[test]
fn penetration_is_the_deepest_nodes() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], 0.0, true, Cells::Quads);
    let mut i = interface(&one, &two, options());
    let x1: Vec<_> = one.x.iter().map(|x| x - Vec3::z() * 0.01).collect();
    let report = i.report(&x1, &two.x).unwrap();
    assert!((report.penetration - 0.01).abs() < ROUNDING);
    assert_eq!(report.count(Cover::Full), 9);
}

/// A surface that closes over a node in two layers within a step, before the commit that would refuse it.
#[test]
fn layers_are_counted_before_a_commit_refuses_them() {
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let mut two = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], -0.1, true, Cells::Quads);
    let aside = grid(1, 1, [4.0, -1.0], [7.0, 2.0], -0.2, true, Cells::Quads);
    two.x.extend(aside.x);
    two.facets.push(vec![4, 5, 7, 6]);
    let mut i = interface(&one, &two, options());
    let x2 = |by: f64| -> Vec<Vec3> {
        let shift = |(k, x): (usize, &Vec3)| x - Vec3::x() * if k < 4 { 0.0 } else { by };
        two.x.iter().enumerate().map(shift).collect()
    };
    let below = i.report(&one.x, &x2(5.0)).unwrap();
    assert!(below.nodes.iter().all(|n| n.cover == Cover::Several && n.layers == 2 && n.facets == 2));
    assert!((below.nodes[0].fraction - 2.0).abs() < ROUNDING);
    // A strip of a quarter: the facet as a whole is covered more than once.
    let strip = i.report(&one.x, &x2(3.25)).unwrap();
    assert!(strip.nodes.iter().all(|n| n.cover == Cover::Several && n.layers == 2), "{strip:?}");
    assert!(i.commit(&one.x, &x2(5.0), &[Vec3::zeros(); 4], None).unwrap_err().message.contains("layers"));
}

fn reversed(mesh: &Mesh) -> Mesh {
    Mesh { x: mesh.x.clone(), facets: mesh.facets.iter().map(|f| f.iter().rev().copied().collect()).collect() }
}

/// One side from inside, both, none, bodies beside each other: as close and far apart, with the shortcut and without.
#[test]
fn surfaces_that_do_not_meet_are_told_why() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    for gap in [0.1, 2.0, 30.0] {
        let two = grid(3, 3, [-1.0, -1.0], [2.0, 2.0], -gap, true, Cells::Triangles);
        let beside = grid(3, 3, [5.0, -1.0], [8.0, 2.0], -gap, true, Cells::Triangles);
        for apart in [true, false] {
            let options = Options { shortcuts: Shortcuts { apart, ..Shortcuts::default() }, ..options() };
            let finding = |one: &Mesh, two: &Mesh| {
                let report = interface(one, two, options).report(&one.x, &two.x).unwrap();
                (report.finding, report.text().unwrap())
            };
            let (two_r, one_r) = (reversed(&two), reversed(&one));
            for (a, b) in [(&one, &two_r), (&one_r, &two)] {
                let (found, text) = finding(a, b);
                assert_eq!(found, Some(Finding::SameWay));
                assert!(text.contains("node order of one side is reversed"), "{text}");
            }
            // An open gap then reads as a penetration; a shallow one is a pair.
            let (found, text) = finding(&one_r, &two_r);
            if gap > 1.0 {
                assert_eq!(found, Some(Finding::Behind), "{gap} {text}");
                assert!(text.contains("node orders of both sides are reversed"), "{text}");
            }
            let (found, text) = finding(&one, &beside);
            assert_eq!(found, Some(Finding::NoOverlap));
            assert!(text.contains("No facets lie over each other"), "{text}");
        }
    }
}

/// What the shortcut leaves out is looked at all the same: an open gap, however wide, is no finding.
#[test]
fn an_open_gap_is_no_finding() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(3, 3, [-1.0, -1.0], [2.0, 2.0], -30.0, true, Cells::Quads);
    let mut i: Contact<1> = contact(&one, &two, false, Options { mu: 0.0, friction: Friction::None, ..options() });
    let report = i.report(&one.x, &two.x).unwrap();
    assert_eq!(i.counters().commits_apart, 1);
    assert_eq!((report.finding, report.penetration), (None, 0.0));
    assert_eq!(report.count(Cover::Full), 9);
}
