//! The report of covered nodes, and what it says of surfaces that do not meet.

use crate::support::mesh::*;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Cover, Finding, Friction, Options, Shortcuts, Weights};

/// Rounding of a covered area over a nodal area.
const ROUNDING: f64 = 1e-12;
/// What a tilt of a fiftieth changes of an area, and more: it is of second order.
const TILTED: f64 = 1e-3;

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

/// With weights that keep overlaps, one that is there at the start presses nothing, and is told by its node and size; rounding is not, nor
/// is it with other weights.
#[test]
fn an_overlap_that_counts_as_closed_is_told() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], 0.0, true, Cells::Quads);
    for (depth, weights, told) in [
        (0.01, Weights::Conserving, true),
        (1e-7, Weights::Conserving, false),
        (-0.01, Weights::Conserving, false),
        (0.01, Weights::Committed, false),
    ] {
        let mut one = Mesh { x: one.x.iter().map(|x| x - Vec3::z() * depth).collect(), facets: one.facets.clone() };
        one.x[8].z -= depth;
        let report = interface(&one, &two, Options { weights, ..options() }).report(&one.x, &two.x).unwrap();
        assert_eq!(report.kept.is_some(), told, "{depth} {weights:?}");
        let text = report.text().unwrap();
        assert_eq!(text.contains("Node 8 overlaps by"), told, "{text}");
        if let Some((_, found, of_size)) = report.kept {
            assert!(
                found > depth && found < 2.0 * depth && (of_size * 0.5 / found - 1.0).abs() < TILTED,
                "{found} {of_size}"
            );
        }
    }
}

/// A surface that closes over a node in two layers within a step, before the commit that settles which is the nearer one.
#[test]
fn layers_are_counted_before_a_commit_settles_them() {
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
    i.commit(&one.x, &x2(5.0), &[Vec3::zeros(); 4], None).unwrap();
    let settled = i.report(&one.x, &x2(5.0)).unwrap();
    assert!(settled.nodes.iter().all(|n| n.cover == Cover::Full && n.layers == 1 && n.facets == 1), "{settled:?}");
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

/// Surfaces that look at each other beyond the search distance are apart; those that have passed each other are not.
#[test]
fn in_front_is_not_behind() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    for (height, expected) in [
        (-0.05, None),
        (-0.5, Some(Finding::NoOverlap)),
        (-30.0, Some(Finding::NoOverlap)),
        (0.5, Some(Finding::Behind)),
    ] {
        let two = grid(3, 3, [-1.0, -1.0], [2.0, 2.0], height, true, Cells::Triangles);
        let found =
            interface(&one, &two, Options { search_distance: Some(0.1), ..options() }).report(&one.x, &two.x).unwrap();
        assert_eq!(found.finding, expected, "{height}");
    }
}

/// Plates that are thinner than their facets are long, with all faces on either side: those that face each other are pairs alone.
#[test]
fn far_sides_of_thin_plates_are_no_pairs() {
    let flat = |mesh: Mesh, thick: f64, from: f64| Mesh {
        x: mesh.x.iter().map(|x| Vec3::new(x.x, x.y, from + thick * x.z)).collect(),
        facets: mesh.facets,
    };
    for thick in [0.01, 0.1, 0.2] {
        for distance in [None, Some(1.0)] {
            let upper = flat(cube(3, Vec3::new(0.2, 0.3, 0.0), 1.0), thick, 0.0);
            let lower = flat(cube(4, Vec3::zeros(), 1.6), thick / 1.6, -thick);
            for depth in [0.0, 0.3 * thick] {
                let one =
                    Mesh { x: upper.x.iter().map(|x| x - Vec3::z() * depth).collect(), facets: upper.facets.clone() };
                let mut i = interface(&one, &lower, Options { search_distance: distance, ..options() });
                let report = i.report(&one.x, &lower.x).unwrap();
                for (node, x) in report.nodes.iter().zip(&upper.x) {
                    let is_bottom = x.z < 0.01 * thick;
                    assert_eq!(node.cover != Cover::None, is_bottom, "{thick} {distance:?} {depth}: {x:?}");
                }
                assert!((report.penetration - depth).abs() < ROUNDING, "{} {depth}", report.penetration);
            }
        }
    }
}

/// Sides with as many nodes, far and near, also where the surfaces have moved since; never what is given in its place.
#[test]
fn swapped_positions_are_noticed() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    for (gap, aside) in [(0.02, 0.0), (0.02, 0.3), (5.0, 0.0), (0.0, 4.0)] {
        let two = grid(2, 2, [aside - 0.2, -0.1], [aside + 1.3, 1.2], -gap, true, Cells::Triangles);
        let mut i = interface(&one, &two, options());
        for moved in [0.0, 0.003] {
            let at = |x: &[Vec3]| x.iter().map(|x| x + Vec3::new(moved, -moved, 0.0)).collect::<Vec<_>>();
            let (x1, x2) = (at(&one.x), at(&two.x));
            let swapped = i.report(&x2, &x1).unwrap();
            assert_eq!(swapped.finding, Some(Finding::Swapped), "{gap} {aside} {moved}");
            assert!(swapped.text().unwrap().contains("x1 and x2 are swapped"));
            assert_ne!(i.report(&x1, &x2).unwrap().finding, Some(Finding::Swapped));
        }
        // A body that goes where the other one was: the nodes do not.
        let away = i.report(&two.x.iter().rev().copied().collect::<Vec<_>>(), &two.x).unwrap();
        assert_ne!(away.finding, Some(Finding::Swapped));
    }
}

/// The surface of a cube of n x n quads a face, its lower corner at `from`, seen from outside.
fn cube(n: usize, from: Vec3, size: f64) -> Mesh {
    let mut mesh = Mesh { x: Vec::new(), facets: Vec::new() };
    let mut node = |x: Vec3| {
        let found = mesh.x.iter().position(|y| (x - y).norm() < 1e-9 * size);
        found.unwrap_or_else(|| {
            mesh.x.push(x);
            mesh.x.len() - 1
        }) as i64
    };
    for (axis, high) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
        let at = |i: usize, j: usize| {
            let mut x = Vec3::zeros();
            (x[axis], x[(axis + 1) % 3], x[(axis + 2) % 3]) =
                (if high { size } else { 0.0 }, size * i as f64 / n as f64, size * j as f64 / n as f64);
            x + from
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)].map(&mut node).to_vec();
            if !high {
                quad.reverse();
            }
            mesh.facets.push(quad);
        }
    }
    mesh
}

/// Reversed node orders of both sides: open gaps of a tenth of a facet and more, and closed surfaces at any distance. The
/// right orders, cavities with something in them, and penetrations that interference fits have are no findings.
#[test]
fn both_node_orders_reversed_are_noticed() {
    let one = grid(4, 4, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let finding = |one: &Mesh, two: &Mesh| interface(one, two, options()).report(&one.x, &two.x).unwrap().finding;
    for (gap, noticed) in [(0.001, false), (0.03, true), (0.1, true), (0.2, true), (0.4, true), (3.0, true)] {
        let two = grid(3, 3, [-0.5, -0.5], [1.5, 1.5], -gap, true, Cells::Quads);
        assert_eq!(finding(&one, &two), None);
        let found = finding(&reversed(&one), &reversed(&two));
        assert_eq!(found.is_some(), noticed, "{gap}: {found:?}");
        let fit = grid(3, 3, [-0.5, -0.5], [1.5, 1.5], 0.02, true, Cells::Quads);
        assert_eq!(finding(&one, &fit), None, "an interference of 2 % of the size");
    }
    let ball = cube(2, Vec3::zeros(), 1.0);
    for gap in [0.0, 1e-6, 0.1, 5.0] {
        let beside = cube(3, Vec3::new(0.1, 0.1, -1.5 - gap), 1.5);
        assert_ne!(finding(&ball, &beside), Some(Finding::InsideOut), "{gap}");
        let found = finding(&reversed(&ball), &reversed(&beside));
        assert!(matches!(found, Some(Finding::InsideOut | Finding::Behind)), "{gap}: {found:?}");
    }
    let room = reversed(&cube(3, Vec3::new(-0.5, -0.5, -0.01), 2.0));
    assert_ne!(finding(&ball, &room), Some(Finding::InsideOut), "a cavity with the body in it");
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
