//! What pairs of sub-facets add to a tangent (`src/mortar/sub_motion.rs`) against the contraction of all derivatives of the
//! weights (`parent_weights`).

use crate::support::random::*;
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use stickslip::geometry::Vec3;
use stickslip::mortar::{
    MORTAR, MultiplierSpace, NonmortarFrame, ParentFacet, Segment, SubMotion, parent_weights, rule_for, sub_motion,
};
use stickslip::quadrature::{DEGREE_5, DEGREE_10, Rule};

/// Relative to the largest.
const ROUNDING: f64 = 1e-12;

/// Derivatives with respect to component j of the pair's k-th node: of forces, gaps and areas, one after the other.
struct Tangent {
    columns: usize,
    of: Vec<f64>,
}

impl Tangent {
    fn new(rows: usize, nodes: usize) -> Tangent {
        Tangent { columns: 3 * nodes, of: vec![0.0; rows * 3 * nodes] }
    }

    fn add(&mut self, row: usize, (k, j): (usize, usize), value: f64) {
        self.of[row * self.columns + 3 * k + j] += value;
    }
}

/// Component i of the row of a node of the first side, of the second, of a multiplier; the area of a multiplier.
fn row(which: usize, n: [usize; 3], b: usize, i: usize) -> usize {
    3 * n[..which].iter().sum::<usize>() + if which < 2 { 3 * b + i } else { 4 * b + i }
}

type Tractions = [[f64; 3]; 9];

fn reference(
    one: &ParentFacet,
    two: &ParentFacet,
    space: MultiplierSpace,
    rule: &'static Rule,
    p: &Tractions,
) -> Tangent {
    let n = [one.parent.n, two.parent.n, one.multipliers(space)];
    let nodes = n[0] + n[1];
    let [mut ab, mut ac] = [n[0], n[1]].map(|c| vec![0.0; 3 * n[2] * c * nodes]);
    parent_weights((one, two), space, rule, Some([&mut ab, &mut ac])).unwrap();
    let mut tangent = Tangent::new(3 * (n[0] + n[1]) + 4 * n[2], nodes);
    for (which, d, facet, sign) in [(0, &ab, one, 1.0), (1, &ac, two, -1.0)] {
        for (a, b) in (0..n[2]).flat_map(|a| (0..n[which]).map(move |b| (a, b))) {
            for (k, j) in (0..nodes).flat_map(|k| (0..3).map(move |j| (k, j))) {
                let d = sign * d[3 * ((a * n[which] + b) * nodes + k) + j];
                for i in 0..3 {
                    tangent.add(row(which, n, b, i), (k, j), d * p[a][i]);
                    tangent.add(row(2, n, a, i), (k, j), d * (facet.x[b] - one.x[0])[i]);
                }
                if which == 0 {
                    tangent.add(row(2, n, a, 3), (k, j), d);
                }
            }
        }
    }
    tangent
}

fn found(one: &ParentFacet, two: &ParentFacet, space: MultiplierSpace, rule: &'static Rule, p: &Tractions) -> Tangent {
    let n = [one.parent.n, two.parent.n, one.multipliers(space)];
    let mut tangent = Tangent::new(3 * (n[0] + n[1]) + 4 * n[2], n[0] + n[1]);
    let mut to = SubMotion::default();
    for (s, sigma) in one.parent.subs.iter().enumerate() {
        let mut frame = NonmortarFrame::new(&one.sub(s)).unwrap();
        for (k, beyond) in sigma.beyond.iter().enumerate() {
            frame.plane.beyond[k] = beyond.map(|other| NonmortarFrame::new(&one.sub(other)).unwrap().plane.e);
        }
        let rows = space.nodes(one.parent, sigma);
        let mut tractions = [[0.0; 4]; 3];
        for (a, &node) in rows.iter().enumerate() {
            (0..3).for_each(|i| tractions[i][a] = p[node][i]);
        }
        for (t, tau) in two.parent.subs.iter().enumerate() {
            let Some(segment) = Segment::new(&frame, &two.sub(t)).unwrap() else { continue };
            let pair = (&frame, &segment, rule_for(rule, [one.parent, two.parent]));
            let (x1, x2) = (one.x.map(|x| x - one.x[0]), two.x.map(|x| x - one.x[0]));
            sub_motion(pair, ((one.parent, sigma), (two.parent, tau)), space, &tractions, (&x1, &x2), &mut to);
            let non_mortar = (0..sigma.shape.n).map(|k| (k, sigma.nodes[k]));
            let mortar = (0..tau.shape.n).map(|l| (MORTAR + l, n[0] + tau.nodes[l]));
            for ((slot, k), j) in non_mortar.chain(mortar).flat_map(|k| (0..3).map(move |j| (k, j))) {
                for i in 0..3 {
                    (0..n[0]).for_each(|b| tangent.add(row(0, n, b, i), (k, j), to.one[slot][j][b][i]));
                    (0..n[1]).for_each(|c| tangent.add(row(1, n, c, i), (k, j), to.two[slot][j][c][i]));
                }
                for (a, &node) in rows.iter().enumerate() {
                    (0..4).for_each(|i| tangent.add(row(2, n, node, i), (k, j), to.gap[slot][j][a][i]));
                }
            }
        }
    }
    tangent
}

/// A parent with nodes off the middle and off the plane, about (u, v); seen from above, counter-clockwise.
fn random_parent(n: usize, scale: f64, turn: f64, noise: &[f64], up: bool, shift: Vec3) -> ParentFacet {
    let kind = stickslip::shape::Parent::of(n).unwrap();
    let rotation = Rotation3::from_euler_angles(0.05, -0.03, turn);
    let x: Vec<Vec3> = (0..n)
        .map(|k| {
            let [u, v] = if kind.corners() == 3 { kind.at[k].map(|u| 2.0 * u - 0.7) } else { kind.at[k] };
            let d = Vector3::new(noise[3 * k], noise[3 * k + 1], noise[3 * k + 2]) * 0.08;
            let mut at = rotation * (Vec3::new(u, v, 0.2 * (u * u - v)) + d) * scale;
            if !up {
                at.y = -at.y;
            }
            at + shift
        })
        .collect();
    ParentFacet::new(&x).unwrap()
}

proptest! {
    #![proptest_config(cases(6))]

    #[test]
    fn motion_is_the_contraction_of_all_derivatives(
        one in prop::collection::vec(-1.0..1.0_f64, 27),
        two in prop::collection::vec(-1.0..1.0_f64, 27),
        p in prop::collection::vec(-1.0..1.0_f64, 27),
        (turn, u, v) in (-3.0..3.0_f64, -0.4..0.4_f64, -0.4..0.4_f64),
        offset in prop::sample::select(vec![0.0, 30.0]),
    ) {
        let p: Tractions = std::array::from_fn(|a| std::array::from_fn(|i| p[3 * a + i]));
        let base = Vec3::new(offset, -offset, 0.5 * offset);
        for (n1, n2) in [3, 4, 6, 8, 9].into_iter().flat_map(|n| [3, 4, 6, 8, 9].map(|m| (n, m))) {
            let one = random_parent(n1, 1.0, 0.0, &one, false, base);
            let two = random_parent(n2, 1.2, turn, &two, true, base + Vec3::new(u, v, -0.05));
            for (space, rule) in [(MultiplierSpace::Corner, &DEGREE_5), (MultiplierSpace::Sub, &DEGREE_5),
                (MultiplierSpace::Corner, &DEGREE_10)] {
                let (expected, found) = (reference(&one, &two, space, rule, &p), found(&one, &two, space, rule, &p));
                let largest = expected.of.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                let error = expected.of.iter().zip(&found.of).fold(0.0_f64, |m, (v, w)| m.max((v - w).abs()));
                prop_assert!(largest > 0.1 && error < ROUNDING * largest, "{n1} {n2} {space:?}: {error:e} of {largest}");
            }
        }
    }
}
