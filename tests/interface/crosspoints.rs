//! Nodes shared by interfaces.

use crate::support::mesh::*;
use stickslip::geometry::Vec3;
use stickslip::interface::{Crosspoint, InterfaceNodes, crosspoints};

#[test]
fn every_kind_is_found_once_in_order() {
    let point =
        |node, claims, claimed_twice, chain, both_sides| Crosspoint { node, claims, claimed_twice, chain, both_sides };
    let interfaces = [
        // 5 twice in one list: a node on a crease is one node.
        InterfaceNodes { nonmortar: &[9, 5, 5, 1, 3], mortar: &[20, 21, 3] },
        InterfaceNodes { nonmortar: &[9, 7], mortar: &[1, 20, 21] },
        InterfaceNodes { nonmortar: &[30, 9, -4], mortar: &[7, 9, 20] },
    ];
    let expected = [
        point(1, 1, false, true, false),
        point(3, 1, false, false, true),
        point(7, 1, false, true, false),
        point(9, 3, true, true, true),
    ];
    assert_eq!(crosspoints(&interfaces).unwrap(), expected);
    assert_eq!(crosspoints(&interfaces[..1]).unwrap(), [point(3, 1, false, false, true)]);
    assert_eq!(crosspoints(&[]).unwrap(), []);
}

/// Two interfaces that share the nodes of an edge are one that is split along it: the same forces and rows.
#[test]
fn two_interfaces_at_an_edge_add_up_to_one_with_a_crease() {
    let bottom = grid(2, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let upright = |m: Mesh| Mesh { x: m.x.iter().map(|x| Vec3::new(x.z, x.y, x.x)).collect(), ..m };
    let side = upright(grid(2, 3, [0.0, 0.0], [1.0, 1.0], 0.0, true, Cells::Quads));
    let floor = grid(3, 3, [-0.2, -0.2], [1.3, 1.4], 0.0, true, Cells::Quads);
    let wall = upright(grid(3, 3, [-0.2, -0.2], [1.3, 1.4], 0.0, false, Cells::Quads));
    let join = |a: &Mesh, b: &Mesh| {
        let n = a.x.len() as i64;
        let shifted = b.facets.iter().map(|f| f.iter().map(|k| k + n).collect());
        Mesh { x: [&a.x[..], &b.x].concat(), facets: a.facets.iter().cloned().chain(shifted).collect() }
    };
    let (punch, channel) = (join(&bottom, &side), join(&floor, &wall));
    let moved = |m: &Mesh| -> Vec<Vec3> { m.x.iter().map(|x| x + Vec3::new(-0.01, 0.03, -0.02)).collect() };
    let lambda = |m: &Mesh| -> Vec<Vec3> { m.x.iter().map(|x| Vec3::new(0.2 - x.z, 0.1 * x.y, x.x - 0.7)).collect() };
    let run = |one: &Mesh, two: &Mesh| {
        interface(one, two, options()).residual(&moved(one), &two.x, &lambda(one), None).unwrap()
    };
    let whole = run(&punch, &channel);
    let (a, b) = (run(&bottom, &floor), run(&side, &wall));
    assert_eq!(whole.nonmortar, [a.nonmortar, b.nonmortar].concat());
    assert_eq!(whole.mortar, [a.mortar, b.mortar].concat());
    assert_eq!(whole.rows, [a.rows, b.rows].concat());
}
