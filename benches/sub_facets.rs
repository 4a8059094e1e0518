//! Pairs of sub-facets of quadratic facets, curved and turned against each other: what they add to a tangent, beside the same of
//! the linear kernel on these sub-facets.

use super::Kernel;
use std::hint::black_box;
use std::rc::Rc;
use stickslip::geometry::Vec3;
use stickslip::mortar::{
    ForceDerivatives, MultiplierSpace, NonmortarFrame, PairWeights, ParentFacet, Segment, Side, SubMotion, pair_motion,
    rule_for, sub_motion,
};
use stickslip::quadrature::DEGREE_5;
use stickslip::shape::{MAX_PARENT_NODES, Parent};

/// A pair of sub-facets, and where the nodes of their parents are.
struct Pair {
    frame: NonmortarFrame,
    segment: Segment,
    sides: (Side, Side),
    x: [[Vec3; MAX_PARENT_NODES]; 2],
}

const TRACTIONS: [[f64; 4]; 3] = [[0.3, -0.2, 0.4, 0.1], [0.7, 0.9, 0.2, -0.5], [-1.0, -1.1, -0.8, -0.9]];

/// A parent with noise, seen from above or below.
fn parent(n: usize, up: bool, turn: f64, shift: [f64; 2], mut random: impl FnMut(f64) -> f64) -> ParentFacet {
    let kind = Parent::of(n).expect("a kind");
    let x: Vec<Vec3> = (0..n)
        .map(|k| {
            let [u, v] = if kind.corners() == 3 { kind.at[k].map(|u| 2.0 * u - 0.7) } else { kind.at[k] };
            let (u, v) = (u + random(0.04), v + random(0.04));
            let (s, c) = turn.sin_cos();
            let v = if up { v } else { -v };
            Vec3::new(c * u - s * v + shift[0], s * u + c * v + shift[1], 0.05 * (u * u + v * v) + random(0.02))
        })
        .collect();
    ParentFacet::new(&x).expect("a facet")
}

/// The pairs that overlap of so many pairs of parents.
fn pairs(n: usize, parents: usize) -> Vec<Pair> {
    let mut state = 1u64;
    let mut random = move |range: f64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        range * ((state >> 33) as f64 / (1u64 << 30) as f64 - 1.0)
    };
    let mut pairs = Vec::new();
    for _ in 0..parents {
        let (turn, shift) = (random(3.0), [random(0.5), random(0.5)]);
        let (one, two) = (parent(n, false, 0.0, [0.0; 2], &mut random), parent(n, true, turn, shift, &mut random));
        for (s, sigma) in one.parent.subs.iter().enumerate() {
            let frame = NonmortarFrame::new(&one.sub(s)).expect("a frame");
            for (t, tau) in two.parent.subs.iter().enumerate() {
                if let Ok(Some(segment)) = Segment::new(&frame, &two.sub(t))
                    && segment.area > 1e-3
                {
                    let sides = ((one.parent, sigma), (two.parent, tau));
                    pairs.push(Pair { frame: frame.clone(), segment, sides, x: [one.x, two.x] });
                }
            }
        }
    }
    pairs
}

/// The quadratic kernel and, before it, the linear one.
pub fn kernels(parents: usize) -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for (n, linear, quadratic) in [
        (6, "tri6/tri6: sub-facets, linear motion", "tri6/tri6: sub-facets, motion"),
        (8, "quad8/quad8: sub-facets, linear motion", "quad8/quad8: sub-facets, motion"),
        (9, "quad9/quad9: sub-facets, linear motion", "quad9/quad9: sub-facets, motion"),
    ] {
        let pairs = Rc::new(pairs(n, parents));
        let (calls, own) = (pairs.len(), pairs.clone());
        let mut forces = ForceDerivatives::default();
        let pass = Box::new(move || {
            let mut sum = 0.0;
            for p in own.iter() {
                let w = PairWeights::integrate(&p.frame, &p.segment, &DEGREE_5);
                let along = pair_motion((&p.frame, &p.segment, &DEGREE_5), &w, &TRACTIONS, &mut forces);
                black_box(&forces);
                sum += along.dgamma[0][2][0];
            }
            sum
        });
        kernels.push(Kernel { name: linear, aim: None, calls, pass });
        let mut to = SubMotion::default();
        let pass = Box::new(move || {
            let mut sum = 0.0;
            for p in pairs.iter() {
                let rule = rule_for(&DEGREE_5, [p.sides.0.0, p.sides.1.0]);
                let pair = (&p.frame, &p.segment, rule);
                sub_motion(pair, p.sides, MultiplierSpace::Corner, &TRACTIONS, (&p.x[0], &p.x[1]), &mut to);
                black_box(&to);
                sum += to.gap[0][0][0][3];
            }
            sum
        });
        kernels.push(Kernel { name: quadratic, aim: None, calls, pass });
    }
    kernels
}
