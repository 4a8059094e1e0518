//! Who may touch whom, and which side each facet is on.

use crate::bodies::*;
use stickslip::geometry::Vec3;
use stickslip::skin::{Between, Role, Skin};

/// Facets of the host with this side, by what their centres have.
fn count(skin: &Skin, x: &[Vec3], role: Role, is: impl Fn(Vec3) -> bool) -> usize {
    let whole = skin.whole();
    let centre = |f: usize| {
        let nodes = whole.surface.host_nodes(f);
        nodes.iter().map(|&a| x[whole.originals[a]]).sum::<Vec3>() / nodes.len() as f64
    };
    (0..whole.facets()).filter(|&f| skin.roles()[f] == role && is(centre(f))).count()
}

/// Of a small block on a large one the small one's face has the multipliers: it stays covered. Nothing else has a side.
#[test]
fn of_two_faces_the_one_that_is_covered_in_full_has_the_multipliers() {
    for triangles in [false, true] {
        let mesh = stack(1e-3, triangles);
        let skin = skin(&mesh, options(0.3));
        let lower_face = |c: Vec3| (c.z - 0.499).abs() < 1e-9;
        let all = mesh.facets.len();
        assert_eq!(count(&skin, &mesh.x, Role::Nonmortar, lower_face), if triangles { 18 } else { 9 });
        assert_eq!(count(&skin, &mesh.x, Role::Nonmortar, |_| true), if triangles { 18 } else { 9 });
        let mortar = count(&skin, &mesh.x, Role::Mortar, |_| true);
        assert_eq!(count(&skin, &mesh.x, Role::Mortar, |c| (c.z - 0.5).abs() < 1e-9), mortar);
        assert_eq!(count(&skin, &mesh.x, Role::None, |_| true), all - mortar - if triangles { 18 } else { 9 });
        assert_eq!((skin.pieces(), skin.contradictions()), (1, 0));
    }
}

/// A plate of thickness 0.05 between two blocks, with a reach of eight times that: neither block sees the other one, nor a far side.
#[test]
fn nothing_is_seen_through_a_wall() {
    let gap = 1e-4;
    let plate = brick([4, 4, 1], [0.0, 0.0, 0.0], [1.0, 1.0, 0.05], false);
    let below = brick([3, 3, 1], [-0.2, -0.2, -0.5 - gap], [1.4, 1.4, 0.5], false);
    let above = brick([3, 3, 1], [0.1, 0.1, 0.05 + gap], [0.8, 0.8, 0.5], false);
    let mesh = together(&[plate, below, above]);
    let skin = skin(&mesh, stickslip::interface::Options { search_distance: Some(0.4), ..options(0.0) });
    let bodies = |f: usize| skin.whole().bodies[f];
    let mut met: Vec<_> = skin.near().iter().map(|pair| pair.facets.map(bodies)).collect();
    met.sort();
    met.dedup();
    assert_eq!(met, [[0, 1], [0, 2]]);
    assert!(skin.near().iter().all(|pair| (pair.distance - gap).abs() < 1e-9), "each sees the nearer side alone");
    assert_eq!(skin.pieces(), 2);
}

/// The flanks of a slot touch each other: one body, its own partner.
#[test]
fn a_body_sees_itself() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.52, 1.0], [0.52, 0.3], [0.48, 0.3], [0.48, 1.0], [0.0, 1.0]];
    let mesh = outline(&corners, 7);
    let skin = skin(&mesh, options(0.0));
    assert!(!skin.near().is_empty() && skin.whole().bodies.iter().all(|&body| body == 0));
    let flank = |x: f64| move |c: Vec3| (c.x - x).abs() < 1e-9 && c.y > 0.3;
    let with = |role: Role| [0.48, 0.52].map(|x| count(&skin, &mesh.x, role, flank(x)));
    let (mut own, mut other) = (with(Role::Nonmortar), with(Role::Mortar));
    own.sort_unstable();
    other.sort_unstable();
    assert_eq!((own, other), ([0, 7], [0, 7]), "each flank has one side");
}

/// Both faces at an edge that touch the same facet are one interface, which knows that the edge is one; those in a corner touch different ones.
#[test]
fn an_edge_on_one_facet_is_one_interface_and_one_in_a_corner_two() {
    let reach = |mesh: &Mesh| skin(mesh, stickslip::interface::Options { search_distance: Some(0.5), ..options(0.3) });
    let diamond = outline(&[[0.1, 0.01], [0.5, 0.41], [0.1, 0.81], [-0.3, 0.41]], 1);
    let on_plate = together(&[outline(&[[-2.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-2.0, 0.0]], 3), diamond]);
    let one = reach(&on_plate);
    assert_eq!((count(&one, &on_plate.x, Role::Nonmortar, |c| c.y > 0.1), one.pieces()), (2, 1));
    let block = outline(&[[0.01, 0.01], [1.0, 0.01], [1.0, 1.0], [0.01, 1.0]], 2);
    let walls = outline(&[[-1.0, -1.0], [3.0, -1.0], [3.0, 0.0], [0.0, 0.0], [0.0, 3.0], [-1.0, 3.0]], 3);
    let in_corner = together(&[walls, block]);
    let two = reach(&in_corner);
    assert_eq!((count(&two, &in_corner.x, Role::Nonmortar, |c| c.x > 0.0 && c.y > 0.0), two.pieces()), (4, 2));
}

/// Bodies that are not to see each other do not, and the others still do.
#[test]
fn a_pair_of_bodies_can_be_left_out() {
    let mesh = together(&[stack(1e-3, false), brick([2, 2, 1], [0.3, 0.3, 0.8989], [0.3, 0.3, 0.2], false)]);
    let mut skin = skin(&mesh, options(0.3));
    assert_eq!(skin.pieces(), 2);
    skin.set_between([1, 2], Between::Nothing).unwrap();
    assert_eq!(skin.pieces(), 1);
    skin.set_between([2, 1], Between::Friction(0.1)).unwrap();
    assert_eq!(skin.pieces(), 2);
    assert!(skin.set_between([0, 3], Between::Nothing).is_err());
}

/// The same in the middle of a run, of a face that goes on touching a third body with the same facets.
#[test]
fn a_pair_of_bodies_can_be_left_out_in_a_run() {
    let below = |y: f64| brick([4, 4, 1], [0.0, y, -0.2], [1.0, 0.4, 0.2], false);
    let mesh = together(&[below(0.0), below(0.6), brick([2, 1, 1], [0.2, 0.25, -1e-3], [0.6, 0.5, 0.2], false)]);
    let mut skin = skin(&mesh, options(0.3));
    skin.commit(&mesh.x, &mut vec![Vec3::zeros(); skin.whole().copies()]).unwrap();
    let pressed = |skin: &mut Skin| {
        let lambda = vec![Vec3::new(0.0, 0.0, -1.0); skin.whole().copies()];
        let forces = skin.residual(&mesh.x, &lambda).unwrap().forces;
        let first = brick([4, 4, 1], [0.0; 3], [1.0; 3], false).x.len();
        [0, first].map(|first_node| forces[first_node..first_node + first].iter().map(|f| f.norm()).sum::<f64>())
    };
    assert!(pressed(&mut skin).iter().all(|force| *force > 0.05));
    skin.set_between([1, 2], Between::Nothing).unwrap();
    let [other, left_out] = pressed(&mut skin);
    assert!(other > 0.05 && left_out == 0.0, "{other} {left_out}");
}
