//! The integrals over the edge parts that bound an overlap (docs/formulation 3.5): an edge's velocity is linear
//! along it, sum L_a Dy_a over its two ends. The functions of its own facet's fields are those of the map, so along
//! it they are the same L_a; the other facet's come from the inverse map.

use super::points::Maps;
use super::segment::{NonmortarFrame, Segment};
use crate::geometry::edge_interval::{EdgeInterval, EdgeIntervals, edge_intervals};
use crate::geometry::{Plane, Projection, Vec2};
use crate::quadrature::{LINE_GROUPS, Rule};
use crate::shape::{Basis, Cell, Isoparametric, MAX_CORNERS, MAX_NODES, SingleBasis, StandardMultipliers};
use crate::simd::{Lanes, Stack};

/// Part of a non-mortar edge, ends 0 and 1; four points of it.
#[derive(Clone, Copy)]
pub(super) struct NonmortarEdge<L> {
    /// Corners at the ends.
    pub ends: [usize; 2],
    /// n ds/dt, n the outward normal.
    pub normal: [L; 2],
    /// int L_a L_b N_B for ab = 00, 01, 11, lanes B; L_b stands for N_A.
    pub own: [L; 3],
    /// int L_a L_b N_C for ab = 00, 01, 11, lanes C in the order of the facet as given; L_b stands for N_A.
    pub mortar: [L; 3],
    /// int L_a N_A v for a = 0, 1, v = sum N_C d_C, d the heights of the corners, lanes A.
    pub height: [L; 2],
}

/// Part of a mortar edge, ends 0 and 1; four points of it.
#[derive(Clone, Copy)]
pub(super) struct MortarEdge<L> {
    /// Corners at the ends, in the order of the projection.
    pub ends: [usize; 2],
    /// 1 in their lanes, in the order of the facet as given.
    pub units: [L; 2],
    /// n ds/dt, n the outward normal.
    pub normal: [L; 2],
    /// int L_l N_A N_B: `[l][A]`, lanes B.
    pub nonmortar: [[L; MAX_CORNERS]; 2],
    /// int L_a L_b N_A for ab = 00, 01, 11, lanes A; L_b stands for N_C.
    pub own: [L; 3],
}

/// Parts that a pair's edges can have: every four points are one.
const PARTS: usize = MAX_CORNERS * LINE_GROUPS;

/// All of a pair's.
pub(super) struct Edges<L> {
    pub nonmortar: Stack<NonmortarEdge<L>, PARTS>,
    pub mortar: Stack<MortarEdge<L>, PARTS>,
}

impl<L: Lanes> Edges<L> {
    #[inline(always)]
    pub fn new() -> Self {
        Edges { nonmortar: Stack::new(), mortar: Stack::new() }
    }

    /// Adds those of a pair. In place: they are large. Along a non-mortar edge L_a stand for N_A and N_B, along a mortar edge
    /// for N_C, and the heights of mortar corners for values of its displacement.
    #[inline(always)]
    pub fn integrate<One: SingleBasis, Two: Isoparametric>(
        &mut self,
        frame: &NonmortarFrame,
        segment: &Segment,
        rule: &Rule,
    ) {
        let [one, two] = intervals::<L>(&frame.projection, &segment.mortar, &frame.plane);
        let maps = Maps::new(frame, segment);
        for edge in one.iter().flatten() {
            for points in rule.line_lanes {
                self.nonmortar.push(NonmortarEdge::integrate::<Two>(&maps, frame, segment, edge, points));
            }
        }
        for edge in two.iter().flatten() {
            for points in rule.line_lanes {
                self.mortar.push(MortarEdge::integrate::<One>(&maps, segment, edge, points));
            }
        }
    }
}

/// [`edge_intervals`], for kernels that share it.
#[inline(always)]
pub(super) fn intervals<L: Lanes>(one: &Projection, two: &Projection, plane: &Plane) -> [EdgeIntervals; 2] {
    if L::SHARED { intervals_shared::<L>(one, two, plane) } else { edge_intervals::<L>(one, two, plane) }
}

#[inline(never)]
fn intervals_shared<L: Lanes>(one: &Projection, two: &Projection, plane: &Plane) -> [EdgeIntervals; 2] {
    edge_intervals::<L>(one, two, plane)
}

/// The products 00, 01, 11 of an edge's ends, in the lanes (`units`) of the two.
#[inline(always)]
pub(super) fn in_lanes<L: Lanes>(products: [f64; 3], units: &[L; 2]) -> [L; 2] {
    let [a, b, c] = products;
    [units[0].mul_add(L::splat(a), units[1] * L::splat(b)), units[0].mul_add(L::splat(b), units[1] * L::splat(c))]
}

impl<L: Lanes> NonmortarEdge<L> {
    #[inline(always)]
    fn integrate<Two: Isoparametric>(
        maps: &Maps<L>,
        frame: &NonmortarFrame,
        segment: &Segment,
        edge: &EdgeInterval,
        points: &[[f64; 4]; 2],
    ) -> Self {
        if L::SHARED {
            Self::shared::<Two>(maps, frame, segment, edge, points)
        } else {
            Self::inlined::<Two>(maps, frame, segment, edge, points)
        }
    }

    #[inline(never)]
    fn shared<Two: Isoparametric>(
        maps: &Maps<L>,
        frame: &NonmortarFrame,
        segment: &Segment,
        edge: &EdgeInterval,
        points: &[[f64; 4]; 2],
    ) -> Self {
        Self::inlined::<Two>(maps, frame, segment, edge, points)
    }

    #[inline(always)]
    fn inlined<Two: Isoparametric>(
        maps: &Maps<L>,
        frame: &NonmortarFrame,
        segment: &Segment,
        edge: &EdgeInterval,
        points: &[[f64; 4]; 2],
    ) -> Self {
        let two = &segment.mortar;
        let zero = L::splat(0.0);
        let (y0, span, normal) = line(&frame.projection.y, edge);
        let (w, l, y) = edge_points::<L>(points, edge, y0, span);
        let (w0, w1) = (w * l[0], w * l[1]);
        let ww = [w0 * l[0], w0 * l[1], w1 * l[1]];
        // int L0^3, L0^2 L1, L0 L1^2, L1^3.
        let [s0, s1, s2, s3] = L::sums([ww[0] * l[0], ww[0] * l[1], ww[1] * l[1], ww[2] * l[1]]).store();
        let at = maps.two.at(y);
        let n2 = Two::Displacement::values(at.xi, at.eta);
        let (mut mortar, mut heights, d) = ([zero; 3], [zero; 4], L::load(&two.d));
        for q in 0..3 {
            let mut products = [zero; MAX_NODES];
            for c in 0..Two::Displacement::FUNCTIONS {
                products[c] = ww[q] * n2[c];
            }
            let sums = L::sums(products);
            heights[q] = sums * d;
            mortar[q] = Two::Cell::given(sums, two.is_reversed());
        }
        let [h0, h1, h2, _] = L::sums(heights).store();
        let units = [unit(edge.from), unit(edge.to)];
        let ([own0, own1], [_, own2]) = (in_lanes([s0, s1, s2], &units), in_lanes([s1, s2, s3], &units));
        NonmortarEdge {
            ends: [edge.from, edge.to],
            normal: [L::splat(normal.x), L::splat(normal.y)],
            own: [own0, own1, own2],
            mortar,
            height: in_lanes([h0, h1, h2], &units),
        }
    }
}

impl<L: Lanes> MortarEdge<L> {
    #[inline(always)]
    fn integrate<One: StandardMultipliers>(
        maps: &Maps<L>,
        segment: &Segment,
        edge: &EdgeInterval,
        points: &[[f64; 4]; 2],
    ) -> Self {
        if L::SHARED {
            Self::shared::<One>(maps, segment, edge, points)
        } else {
            Self::inlined::<One>(maps, segment, edge, points)
        }
    }

    #[inline(never)]
    fn shared<One: StandardMultipliers>(
        maps: &Maps<L>,
        segment: &Segment,
        edge: &EdgeInterval,
        points: &[[f64; 4]; 2],
    ) -> Self {
        Self::inlined::<One>(maps, segment, edge, points)
    }

    #[inline(always)]
    fn inlined<One: StandardMultipliers>(
        maps: &Maps<L>,
        segment: &Segment,
        edge: &EdgeInterval,
        points: &[[f64; 4]; 2],
    ) -> Self {
        let zero = L::splat(0.0);
        let (y0, span, normal) = line(&segment.mortar.y, edge);
        let (w, l, y) = edge_points::<L>(points, edge, y0, span);
        let at = maps.one.at(y);
        let n1 = One::Multiplier::values(at.xi, at.eta); // N_A, and N_B
        let (mut nonmortar, mut own) = ([[zero; MAX_CORNERS]; 2], [[zero; MAX_CORNERS]; 3]);
        for e in 0..2 {
            let wl = w * l[e];
            // N_A N_B is symmetric.
            let mut products = [[zero; MAX_NODES]; MAX_CORNERS];
            for a in 0..One::Multiplier::FUNCTIONS {
                let wn = wl * n1[a];
                for b in a..One::Displacement::FUNCTIONS {
                    products[a][b] = wn * n1[b];
                    products[b][a] = products[a][b];
                }
                own[e][a] = wn * l[0];
                own[e + 1][a] = wn * l[1];
            }
            for a in 0..One::Multiplier::FUNCTIONS {
                nonmortar[e][a] = L::sums(products[a]);
            }
        }
        let own = [L::sums(own[0]), L::sums(own[1]), L::sums(own[2])];
        let node = &segment.mortar.node;
        MortarEdge {
            ends: [edge.from, edge.to],
            units: [unit(node[edge.from & 3]), unit(node[edge.to & 3])],
            normal: [L::splat(normal.x), L::splat(normal.y)],
            nonmortar,
            own,
        }
    }
}

/// 1 in lane k.
#[inline(always)]
pub(super) fn unit<L: Lanes>(k: usize) -> L {
    const UNITS: [[f64; 4]; 4] =
        [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    L::load(&UNITS[k & 3]) // so that no bounds are checked
}

/// Beginning and span of an edge, and n ds/dt, n the outward normal of the facet that owns it.
#[inline(always)]
pub(super) fn line(y: &[Vec2; MAX_CORNERS], edge: &EdgeInterval) -> (Vec2, Vec2, Vec2) {
    let (from, to) = (y[edge.from & 3], y[edge.to & 3]);
    let span = to - from;
    (from, span, Vec2::new(span.y, -span.x) * edge.orientation)
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
