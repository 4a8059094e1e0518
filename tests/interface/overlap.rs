//! What weighted gaps do not see (`src/interface/inspect/overlap.rs`): overlaps and gaps that are planted are found to the digit, and what is
//! none is not told.

use crate::support::mesh::*;
use nalgebra::SVector;
use std::f64::consts::FRAC_PI_2;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Equilibrium, Friction, Largest, MultiplierBasis, Options, Scales, Stiffness, Weights,
};

/// Heights are differences of positions of size 1.
const ROUNDING: f64 = 1e-13;
const YOUNG: f64 = 100.0;

fn frictionless(basis: MultiplierBasis, weights: Weights) -> Options {
    Options { friction: Friction::None, mu: 0.0, basis, weights, ..Options::paper(Stiffness::Modulus(YOUNG)) }
}

/// Where the mortar side is lifted by `up`, and all nodes press with `pressure`.
fn measured(one: &Mesh, two: &Mesh, options: Options, up: f64, pressure: f64) -> Equilibrium {
    let mut contact: Contact<1> = contact(one, two, false, options);
    let x2: Vec<_> = two.x.iter().map(|x| x + Vec3::z() * up).collect();
    let lambda = vec![SVector::<f64, 1>::from_element(-pressure); one.x.len()];
    contact.equilibrium(&one.x, &x2, &lambda, None, &Scales { modulus: YOUNG, traction: 0.0 }).unwrap()
}

fn flat(n: usize, half: f64, up: bool, cells: Cells) -> Mesh {
    grid(n, n, [-half, -half], [half, half], 0.0, up, cells)
}

fn is(found: Largest, value: f64, size: f64, what: &str) {
    assert!((found.value - value).abs() <= ROUNDING, "{what}: {found:?}, expected {value}");
    assert!(value == 0.0 || (found.scale / size - 1.0).abs() < 1e-9, "{what}: {found:?}, of a facet of {size}");
}

#[test]
fn a_planted_overlap_is_found_whatever_weights_and_facets() {
    for (n, m, cells) in [(1, 6, Cells::Quads), (6, 2, Cells::Triangles), (3, 4, Cells::Quads)] {
        for weights in [Weights::Current, Weights::Committed, Weights::Reference] {
            let (one, two) = (flat(n, 0.5, false, cells), flat(m, 0.7, true, Cells::Quads));
            let (h1, h2) = (1.0 / n as f64, 1.4 / m as f64);
            let h1 = if cells == Cells::Triangles { h1 * 2f64.sqrt() } else { h1 };
            let size = h1.min(h2);
            let options = frictionless(MultiplierBasis::Standard, weights);
            for depth in [1e-6, 0.01, 0.1] {
                // A facet's edge; where nodes press, and weights know of overlaps, thirty.
                let felt = if matches!(weights, Weights::Current | Weights::Committed) { 30.0 } else { 1.0 };
                for (pressure, part) in [(0.0, 1.0), (1e-3 * YOUNG, felt), (YOUNG, felt)] {
                    let found = measured(&one, &two, options, depth, pressure);
                    is(found.penetration, depth, part * size, &format!("{n} {m} {weights:?} {depth} {pressure}"));
                    is(found.apart, 0.0, 1.0, "nothing is apart");
                }
            }
            is(measured(&one, &two, options, -0.1, 0.0).penetration, 0.0, 1.0, "they are apart");
        }
    }
}

#[test]
fn a_tip_within_a_coarse_facet_is_found_although_its_node_gaps_are_open() {
    let (one, mut two) = (flat(1, 0.5, false, Cells::Quads), flat(8, 0.5, true, Cells::Quads));
    two.x.iter_mut().for_each(|x| x.z = 0.02 - 0.5 * (x.x * x.x + x.y * x.y));
    let mut contact: Contact<1> = contact(&one, &two, false, frictionless(MultiplierBasis::Standard, Weights::Current));
    let lambda = vec![SVector::<f64, 1>::zeros(); 4];
    let answers = contact.responses(&one.x, &two.x, &lambda, None).unwrap();
    assert!(answers.iter().all(|r| r.gap_normal > 0.0), "every weighted gap is open");
    let found = measured(&one, &two, *contact.options(), 0.0, 0.0).penetration;
    // But for the sagittas of its facets, h^2 / 4 along their slopes.
    assert!(
        found.value < 0.02 && found.value > 0.02 - 0.3 / 64.0 && found.scale >= 1.0 / 8.0 && found.scale < 0.13,
        "{found:?}"
    );
}

#[test]
fn nodes_that_press_far_from_anything_are_found() {
    let (one, two) = (flat(3, 0.5, false, Cells::Quads), flat(4, 0.7, true, Cells::Quads));
    for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
        let options = frictionless(basis, Weights::Current);
        is(measured(&one, &two, options, -0.05, YOUNG).apart, 0.05, 1.0 / 3.0, "apart");
        is(measured(&one, &two, options, -0.05, 0.0).apart, 0.0, 1.0, "nothing presses");
        is(measured(&one, &two, options, 0.0, YOUNG).apart, 0.0, 1.0, "they touch");
    }
}

/// Facets as chords of round surfaces whose nodes touch: overlaps as large as the mesh's own error are none.
#[test]
fn chords_of_round_surfaces_do_not_overlap() {
    let bend = |mesh: &mut Mesh| {
        mesh.x.iter_mut().for_each(|x| *x = Vec3::new(x.x.sin(), x.y, x.x.cos()));
    };
    for (n, m) in [(4, 7), (9, 5), (6, 6), (5, 23)] {
        let half = 0.45 * FRAC_PI_2;
        let mut one = grid(n, 2, [-half, -0.2], [half, 0.2], 0.0, false, Cells::Quads);
        let mut two = grid(m, 3, [-1.3 * half, -0.3], [1.3 * half, 0.3], 0.0, true, Cells::Quads);
        bend(&mut one);
        bend(&mut two);
        let options = frictionless(MultiplierBasis::Standard, Weights::Current);
        is(measured(&one, &two, options, 0.0, 0.0).penetration, 0.0, 1.0, &format!("{n} {m}"));
        let deep = measured(&one, &two, options, 0.3, 0.0).penetration;
        assert!(deep.value > 0.15, "{n} {m}: {deep:?}");
    }
}

/// What lies behind a plate in front of it, or behind a body, is no overlap.
#[test]
fn far_sides_and_plates_in_between_are_no_overlap() {
    let one = flat(2, 0.5, false, Cells::Quads);
    // Seen from below: the underside of a shelf above, and its upper side.
    let (underside, top) = (flat(2, 0.6, false, Cells::Quads), flat(2, 0.6, true, Cells::Quads));
    let mut two = flat(2, 0.6, true, Cells::Quads);
    two.x.iter_mut().for_each(|x| x.z = -0.3);
    for (mesh, z) in [(&underside, 0.1), (&top, 0.2)] {
        let first = two.x.len() as i64;
        two.x.extend(mesh.x.iter().map(|x| x + Vec3::z() * z));
        two.facets.extend(mesh.facets.iter().map(|f| f.iter().map(|k| k + first).collect::<Vec<_>>()));
    }
    let options = frictionless(MultiplierBasis::Standard, Weights::Current);
    is(measured(&one, &two, options, 0.0, 0.0).penetration, 0.0, 1.0, "a shelf above");
    is(measured(&one, &two, options, 0.35, 0.0).penetration, 0.05, 0.5, "the floor is nearest");
}
