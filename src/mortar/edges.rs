//! The integrals over the edge parts that bound an overlap (kernel notes A, "strict"): an edge's velocity is linear
//! along it, sum L_a Dy_a over its two ends, so are its own facet's functions; the other facet's come from the inverse
//! map.

use super::segment::{NonmortarFrame, Segment};
use crate::geometry::Vec2;
use crate::geometry::edge_interval::{EdgeInterval, edge_intervals};
use crate::quadrature::Rule;
use crate::shape::{Cell, MAX_NODES};
use crate::simd::{Lanes, Stack};

/// Part of a non-mortar edge, ends 0 and 1.
#[derive(Clone, Copy)]
pub(super) struct NonmortarEdge<L> {
    /// Nodes of the ends.
    pub ends: [usize; 2],
    /// 1 in their lanes.
    pub units: [L; 2],
    /// n ds/dt, n the outward normal.
    pub normal: Vec2,
    /// int L0^3, L0^2 L1, L0 L1^2, L1^3.
    pub cubic: [f64; 4],
    /// int L_a L_b N_C for ab = 00, 01, 11, lanes C in the order of the facet as given.
    pub mortar: [L; 3],
    /// int L_a L_b v, v = sum N_C d_C.
    pub height: [f64; 3],
}

/// Part of a mortar edge, ends 0 and 1.
#[derive(Clone, Copy)]
pub(super) struct MortarEdge<L> {
    /// Nodes of the ends, in the order of the projection.
    pub ends: [usize; 2],
    /// 1 in their lanes, in the order of the facet as given.
    pub units: [L; 2],
    /// n ds/dt, n the outward normal.
    pub normal: Vec2,
    /// int L_l N_A N_B: `[l][A]`, lanes B.
    pub nonmortar: [[L; MAX_NODES]; 2],
    /// int L_a L_b N_A for ab = 00, 01, 11, lanes A.
    pub own: [L; 3],
}

/// All of a pair's.
pub(super) struct Edges<L> {
    pub nonmortar: Stack<NonmortarEdge<L>, MAX_NODES>,
    pub mortar: Stack<MortarEdge<L>, MAX_NODES>,
}

impl<L: Lanes> Edges<L> {
    #[inline(always)]
    pub fn integrate<One: Cell, Two: Cell>(&mut self, frame: &NonmortarFrame, segment: &Segment, rule: &Rule) {
        let [one, two] = edge_intervals::<L>(&frame.projection, &segment.mortar, &frame.plane);
        for edge in one.iter().flatten() {
            self.nonmortar.push(nonmortar_edge::<L, Two>(frame, segment, rule, edge));
        }
        for edge in two.iter().flatten() {
            self.mortar.push(mortar_edge::<L, One>(frame, segment, rule, edge));
        }
    }
}

#[inline(always)]
fn nonmortar_edge<L: Lanes, Two: Cell>(
    frame: &NonmortarFrame,
    segment: &Segment,
    rule: &Rule,
    edge: &EdgeInterval,
) -> NonmortarEdge<L> {
    let two = &segment.mortar;
    let zero = L::splat(0.0);
    let (y0, span, normal) = line(&frame.projection.y, edge);
    let (mut nc, mut heights, mut cubic) = ([[zero; MAX_NODES]; 3], [zero; 4], [zero; 4]);
    for points in rule.line_lanes {
        let (w, l, y) = edge_points::<L>(points, edge, y0, span);
        let ww = [w * l[0] * l[0], w * l[0] * l[1], w * l[1] * l[1]];
        for q in 0..2 {
            cubic[q] = ww[q].mul_add(l[0], cubic[q]);
            cubic[q + 2] = ww[q + 1].mul_add(l[1], cubic[q + 2]);
        }
        let at = segment.mortar_map.inverse(y);
        let n2 = Two::values(at.xi, at.eta);
        for q in 0..3 {
            for c in 0..Two::NODES {
                nc[q][c] = ww[q].mul_add(n2[c], nc[q][c]);
            }
        }
    }
    let mut mortar = [zero; 3];
    let d = L::load(&two.d);
    for q in 0..3 {
        let sums = L::sums(nc[q]);
        heights[q] = sums * d;
        mortar[q] = Two::given(sums, two.is_reversed());
    }
    let h = L::sums(heights).store();
    NonmortarEdge {
        ends: [edge.from, edge.to],
        units: [unit(edge.from), unit(edge.to)],
        normal,
        cubic: L::sums(cubic).store(),
        mortar,
        height: [h[0], h[1], h[2]],
    }
}

#[inline(always)]
fn mortar_edge<L: Lanes, One: Cell>(
    frame: &NonmortarFrame,
    segment: &Segment,
    rule: &Rule,
    edge: &EdgeInterval,
) -> MortarEdge<L> {
    let zero = L::splat(0.0);
    let (y0, span, normal) = line(&segment.mortar.y, edge);
    let (mut nn, mut own) = ([[[zero; MAX_NODES]; MAX_NODES]; 2], [[zero; MAX_NODES]; 3]);
    for points in rule.line_lanes {
        let (w, l, y) = edge_points::<L>(points, edge, y0, span);
        let at = frame.map.inverse(y);
        let n1 = One::values(at.xi, at.eta);
        for a in 0..One::NODES {
            let wa = [w * l[0] * n1[a], w * l[1] * n1[a]];
            for b in 0..One::NODES {
                nn[0][a][b] = wa[0].mul_add(n1[b], nn[0][a][b]);
                nn[1][a][b] = wa[1].mul_add(n1[b], nn[1][a][b]);
            }
            own[0][a] = wa[0].mul_add(l[0], own[0][a]);
            own[1][a] = wa[0].mul_add(l[1], own[1][a]);
            own[2][a] = wa[1].mul_add(l[1], own[2][a]);
        }
    }
    let mut nonmortar = [[zero; MAX_NODES]; 2];
    for a in 0..One::NODES {
        nonmortar[0][a] = L::sums(nn[0][a]);
        nonmortar[1][a] = L::sums(nn[1][a]);
    }
    let own = [L::sums(own[0]), L::sums(own[1]), L::sums(own[2])];
    let (ends, node) = ([edge.from, edge.to], &segment.mortar.node);
    MortarEdge { ends, units: [unit(node[edge.from]), unit(node[edge.to])], normal, nonmortar, own }
}

/// 1 in lane k.
#[inline(always)]
pub(super) fn unit<L: Lanes>(k: usize) -> L {
    const UNITS: [[f64; 4]; 4] =
        [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    L::load(&UNITS[k])
}

/// Beginning and span of an edge, and n ds/dt, n the outward normal of the facet that owns it.
#[inline(always)]
pub(super) fn line(y: &[Vec2; MAX_NODES], edge: &EdgeInterval) -> (Vec2, Vec2, Vec2) {
    let span = y[edge.to] - y[edge.from];
    (y[edge.from], span, Vec2::new(span.y, -span.x) * edge.orientation)
}

/// Weights, L0 and L1, and positions of four points of an edge's interval.
#[inline(always)]
pub(super) fn edge_points<L: Lanes>(
    [t, w]: &[[f64; 4]; 2],
    edge: &EdgeInterval,
    y0: Vec2,
    span: Vec2,
) -> (L, [L; 2], [L; 2]) {
    let length = L::splat(edge.high - edge.low);
    let t = length.mul_add(L::load(t), L::splat(edge.low));
    let y = [L::splat(span.x).mul_add(t, L::splat(y0.x)), L::splat(span.y).mul_add(t, L::splat(y0.y))];
    (L::load(w) * length, [L::splat(1.0) - t, t], y)
}
