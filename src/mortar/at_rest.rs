//! Derivatives where the mortar side is at rest (docs/formulation 3.8): of the forces and gaps of one non-mortar facet with respect to its own
//! nodes, over all of its pairs at once. They are linear in the pairs' integrals and share plane and facet, so the
//! integrals are added up first, and contracted and chained once a facet.
//!
//! The vertices of a mortar facet move in the plane only because that tilts, by their heights d_l times one and the
//! same vector: the velocity v = sum_l N_l d_l of the whole facet, in one slot more, serves in place of their own. What
//! is left of the transport form (`transport`), with v alone of the mortar side, is
//!
//! D int p N_B = -int (grad p . v1) N_B + p (grad N_B . v1) da + edges, and of the gaps, whose second part is
//! -int N_A v: int (grad N_A . v1) v + N_A (grad v . v2) da + edges, v2 = v times that vector.
//!
//! A translation and a spin of both facets change no integral: the shares of the plane's own cancel between the facets,
//! and only its tilt is left.

use super::chain::{ForceDerivatives, ONE};
use super::edges::{edge_points, in_lanes, intervals, line, unit};
use super::gap::{AlongNormal, Raised, gamma, heights_over};
use super::moments::{MONOMIALS, PRODUCTS, Table, combine, monomials, powers, powers_of, table};
use super::pair_weights::PairWeights;
use super::points::{Fan, Maps, points};
use super::segment::{NonmortarFrame, Segment};
use super::slots::PAIR_NODES;
use super::transport::dots;
use crate::geometry::{Projection, Vec2};
use crate::quadrature::Rule;
use crate::shape::{Basis, Cell, MAX_CORNERS, MAX_NODES, Quad4, SingleBasis, StandardMultipliers, Tri3};
use crate::simd::{self, Kernel, Lanes, Stack, rolled};
use std::marker::PhantomData;

/// d/dy of four numbers in the lanes: the slots of the non-mortar corners, and that of v.
type PlaneDerivatives<L> = [[L; 2]; MAX_CORNERS + 1];
/// The slot of v.
const V: usize = MAX_CORNERS;

/// Derivatives with respect to the facet's nodes, the mortar side at rest, over all of its `pairs`: of the forces of
/// the fields `p[i][A]`, into `forces`, whose other slots are left as they are, and of the gaps.
pub fn facet_motion<'a>(
    frame: &NonmortarFrame,
    mut pairs: impl Iterator<Item = (&'a Segment, &'a PairWeights)>,
    rule: &Rule,
    p: &[[f64; MAX_CORNERS]; 3],
    forces: &mut ForceDerivatives,
) -> AlongNormal {
    motion(frame, &mut pairs, rule, p, forces, None)
}

/// The same over a mortar surface that is raised, as [`super::pair_motion_raised`].
pub fn facet_motion_raised<'a>(
    frame: &NonmortarFrame,
    mut pairs: impl Iterator<Item = (&'a Segment, &'a PairWeights)>,
    rule: &Rule,
    p: &[[f64; MAX_CORNERS]; 3],
    forces: &mut ForceDerivatives,
    raised: Raised,
) -> AlongNormal {
    motion(frame, &mut pairs, rule, p, forces, Some(raised))
}

/// The pairs of a facet. Not a type of its own for each caller: each would compile the kernels once more.
type Pairs<'a, 'p> = dyn Iterator<Item = (&'p Segment, &'p PairWeights)> + 'a;

fn motion<'a, 'p>(
    frame: &'a NonmortarFrame,
    pairs: &'a mut Pairs<'a, 'p>,
    rule: &Rule,
    p: &[[f64; MAX_CORNERS]; 3],
    forces: &mut ForceDerivatives,
    raised: Option<Raised>,
) -> AlongNormal {
    let rule = rule.for_derivatives();
    if frame.projection.shape.n == 3 {
        simd::dispatch(AtRest::<Tri3> { frame, pairs, rule, p, forces, raised, one: PhantomData })
    } else {
        simd::dispatch(AtRest::<Quad4> { frame, pairs, rule, p, forces, raised, one: PhantomData })
    }
}

struct AtRest<'a, 'p, One> {
    frame: &'a NonmortarFrame,
    pairs: &'a mut Pairs<'a, 'p>,
    rule: &'a Rule,
    p: &'a [[f64; MAX_CORNERS]; 3],
    forces: &'a mut ForceDerivatives,
    raised: Option<Raised<'a>>,
    one: PhantomData<One>,
}

impl<One: SingleBasis> Kernel for AtRest<'_, '_, One> {
    type Output = AlongNormal;

    #[inline(always)]
    fn run<L: Lanes>(self) -> AlongNormal {
        const { assert!(MAX_NODES == MAX_CORNERS) }; // what corners do is what nodes do
        let AtRest { frame, pairs, rule, p, forces, raised, .. } = self;
        let plane = &frame.plane;
        let mut sums = Sums::<L>::new();
        let mut stack = Stack::<Group<L>, GROUPS>::new();
        let (mut heights, mut gammas) = ([L::splat(0.0); MAX_NODES], [0.0; MAX_CORNERS]);
        for (segment, weights) in pairs {
            sums.add_volume::<One>(frame, segment, rule, &mut stack);
            sums.add_edges::<One>(frame, segment, rule);
            let gamma = gamma::<L>(frame, &segment.mortar, weights);
            for b in 0..MAX_NODES {
                heights[b] = heights[b] + L::load(&weights.ab[b]); // n_AB is symmetric
            }
            for a in 0..MAX_CORNERS {
                gammas[a] += gamma[a];
            }
        }
        sums.flush::<One>(&mut stack);
        let integrals = sums.finish::<One::Cell>(frame);
        for i in 0..rolled(3) {
            let x = chain::<L, One::Cell>(frame, &integrals.forces::<One>(&p[i]));
            for k in 0..One::Cell::CORNERS {
                for j in 0..3 {
                    forces.one[k][j][i] = column(frame, &x[k], j).store();
                }
            }
        }
        let lifted = heights_over(frame, &raised);
        if let Some(raised) = raised {
            let x = chain::<L, One::Cell>(frame, &integrals.forces::<One>(&ONE));
            for k in 0..One::Cell::CORNERS {
                for j in 0..3 {
                    raised.areas[k][j] = column(frame, &x[k], j).store();
                }
            }
        }
        let mut x = chain::<L, One::Cell>(frame, &integrals.gaps::<One>(&lifted));
        let mut dgamma = [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES];
        for k in 0..One::Cell::CORNERS {
            x[k][2] = x[k][2] + heights[k]; // n_AB e . Dx_B
            for j in 0..3 {
                dgamma[k][j] = column(frame, &x[k], j).store();
            }
        }
        AlongNormal { e: plane.e, axes: [plane.t1, plane.t2], tilt: plane.tilt, gamma: gammas, dgamma }
    }
}

/// v over a mortar facet: coefficients of 1, xi, eta, xi eta. It has the functions of the map, which are N_C: other kinds
/// have no table.
struct Height<L>([L; 4]);

impl<L: Lanes> Height<L> {
    #[inline(always)]
    fn of(two: &Projection) -> Self {
        let mut v = [0.0; 4];
        for k in 0..MAX_CORNERS {
            for i in 0..4 {
                v[i] += two.shape.coefficients[k][i] * two.d[k];
            }
        }
        Height([L::splat(v[0]), L::splat(v[1]), L::splat(v[2]), L::splat(v[3])])
    }

    #[inline(always)]
    fn at(&self, xi: L, eta: L) -> L {
        let v = &self.0;
        v[3].mul_add(eta, v[1]).mul_add(xi, v[2].mul_add(eta, v[0]))
    }
}

/// Four points.
#[derive(Clone, Copy)]
struct Group<L> {
    /// Monomials of the non-mortar facet with weight / det1.
    monomials: [L; MONOMIALS],
    /// N_B, which are N_A.
    n: [L; MAX_NODES],
    v: L,
    /// Weight times v dv/dy.
    slope: [L; 2],
}

/// Groups of points summed at once.
const GROUPS: usize = 16;

/// Sums over the pairs so far.
struct Sums<L> {
    /// int (monomials / det1) N_B, lanes B.
    own: [L; MONOMIALS],
    /// int (monomials / det1) v, lanes over points.
    height: [L; MONOMIALS],
    /// Of every non-mortar edge int L0^3, L0^2 L1, L0 L1^2, L1^3, lanes over points.
    cubic: [[L; 4]; MAX_CORNERS],
    /// int L_a L_b v for ab = 00, 01, 11.
    edge_height: [[L; 3]; MAX_CORNERS],
    /// Over mortar edges int v N_A N_B n ds: `[c][A]`, lanes B.
    shifted: [[L; MAX_CORNERS]; 2],
    /// int N_A v dv/dy_c da - int N_A v^2 n_c ds, lanes A.
    gap: [L; 2],
}

impl<L: Lanes> Sums<L> {
    #[inline(always)]
    fn new() -> Self {
        let zero = L::splat(0.0);
        Sums {
            own: [zero; MONOMIALS],
            height: [zero; MONOMIALS],
            cubic: [[zero; 4]; MAX_CORNERS],
            edge_height: [[zero; 3]; MAX_CORNERS],
            shifted: [[zero; MAX_CORNERS]; 2],
            gap: [zero; 2],
        }
    }

    #[inline(always)]
    fn add_volume<One: StandardMultipliers>(
        &mut self,
        frame: &NonmortarFrame,
        segment: &Segment,
        rule: &Rule,
        stack: &mut Stack<Group<L>, GROUPS>,
    ) {
        let height = Height::of(&segment.mortar);
        let slope = dots(&segment.mortar_map.gradients::<L>(), L::load(&segment.mortar.d)); // det2 dv/dy
        let maps = Maps::new(frame, segment);
        let mut fan = Fan::new(frame, segment);
        while let Some(triangle) = fan.triangle() {
            for four in rule.triangle_lanes {
                let p = points::<L>(&maps, four, &triangle);
                let over = p.weight / (p.one.det * p.two.det);
                let (xi, eta) = (p.two.xi, p.two.eta);
                let v = height.at(xi, eta);
                let wv = over * p.one.det * v;
                let mut s = [L::splat(0.0); 2];
                for c in 0..2 {
                    let [constant, with_xi, with_eta] = [slope[0][c], slope[1][c], slope[2][c]];
                    let with_eta = L::splat(with_eta).mul_add(eta, L::splat(constant));
                    s[c] = wv * L::splat(with_xi).mul_add(xi, with_eta);
                }
                let monomials = powers_of::<L, One::Cell>(over * p.two.det, p.one.xi, p.one.eta);
                stack.push(Group { monomials, n: One::Displacement::values(p.one.xi, p.one.eta), v, slope: s });
                if stack.is_full() {
                    self.flush::<One>(stack);
                }
            }
        }
    }

    /// Adds the points that were put off.
    #[inline(always)]
    fn flush<One: StandardMultipliers>(&mut self, stack: &mut Stack<Group<L>, GROUPS>) {
        let zero = L::splat(0.0);
        // Two monomials at a time: as many sums as stay in registers.
        for j in (0..monomials::<One::Cell>()).step_by(2) {
            let (mut s, mut h) = ([[zero; MAX_NODES]; 2], [self.height[j], self.height[j + 1]]);
            for g in stack.values() {
                for q in 0..2 {
                    let m = g.monomials[j + q];
                    for b in 0..One::Displacement::FUNCTIONS {
                        s[q][b] = m.mul_add(g.n[b], s[q][b]);
                    }
                    h[q] = m.mul_add(g.v, h[q]);
                }
            }
            for q in 0..2 {
                self.own[j + q] = self.own[j + q] + L::sums(s[q]);
                self.height[j + q] = h[q];
            }
        }
        let mut s = [[zero; MAX_CORNERS]; 2];
        for g in stack.values() {
            for a in 0..One::Multiplier::FUNCTIONS {
                s[0][a] = g.slope[0].mul_add(g.n[a], s[0][a]);
                s[1][a] = g.slope[1].mul_add(g.n[a], s[1][a]);
            }
        }
        self.gap = [self.gap[0] + L::sums(s[0]), self.gap[1] + L::sums(s[1])];
        stack.clear();
    }

    #[inline(always)]
    fn add_edges<One: StandardMultipliers>(&mut self, frame: &NonmortarFrame, segment: &Segment, rule: &Rule) {
        let (one, two) = (&frame.projection, &segment.mortar);
        let [nonmortar, mortar] = intervals::<L>(one, two, &frame.plane);
        let v = Height::of(two);
        for edge in nonmortar.iter().flatten() {
            let (y0, span, _) = line(&one.y, edge);
            let (cubic, height) = (&mut self.cubic[edge.from], &mut self.edge_height[edge.from]);
            for points in rule.line_lanes {
                let (w, l, y) = edge_points::<L>(points, edge, y0, span);
                let ww = [w * l[0] * l[0], w * l[0] * l[1], w * l[1] * l[1]];
                for q in 0..2 {
                    cubic[q] = ww[q].mul_add(l[0], cubic[q]);
                    cubic[q + 2] = ww[q + 1].mul_add(l[1], cubic[q + 2]);
                }
                let at = segment.mortar_map.inverse(y);
                let v = v.at(at.xi, at.eta);
                for q in 0..3 {
                    height[q] = ww[q].mul_add(v, height[q]);
                }
            }
        }
        for edge in mortar.iter().flatten() {
            let (y0, span, normal) = line(&two.y, edge);
            let ends = [L::splat(two.d[edge.from]), L::splat(two.d[edge.to])];
            let (mut nn, mut own) = ([[L::splat(0.0); MAX_NODES]; MAX_CORNERS], [L::splat(0.0); MAX_CORNERS]);
            for points in rule.line_lanes {
                let (w, l, y) = edge_points::<L>(points, edge, y0, span);
                let at = frame.map.inverse(y);
                let n = One::Multiplier::values(at.xi, at.eta); // N_A, and N_B
                let v = ends[0].mul_add(l[0], ends[1] * l[1]);
                let wv = w * v;
                for a in 0..One::Multiplier::FUNCTIONS {
                    let wvn = wv * n[a];
                    own[a] = wvn.mul_add(v, own[a]);
                    for b in 0..One::Displacement::FUNCTIONS {
                        nn[a][b] = wvn.mul_add(n[b], nn[a][b]);
                    }
                }
            }
            let normal = [L::splat(normal.x), L::splat(normal.y)];
            let own = L::sums(own);
            for a in 0..One::Multiplier::FUNCTIONS {
                let nn = L::sums(nn[a]);
                self.shifted[0][a] = normal[0].mul_add(nn, self.shifted[0][a]);
                self.shifted[1][a] = normal[1].mul_add(nn, self.shifted[1][a]);
            }
            self.gap = [self.gap[0] - normal[0] * own, self.gap[1] - normal[1] * own];
        }
    }

    /// What the facet's derivatives follow from by contraction.
    #[inline(always)]
    fn finish<One: Cell>(&self, frame: &NonmortarFrame) -> Integrals<L> {
        let h = &self.height;
        let (low, high) = (L::sums([h[0], h[1], h[2], h[3]]).store(), L::sums([h[4], h[5], h[6], h[7]]).store());
        let at = |m: usize| if m < 4 { low[m] } else { high[m - 4] };
        let mut height = [[0.0; MAX_CORNERS]; 3];
        let mut edges = [Edge { cubic: [0.0; 4], height: [0.0; 4], normal: Vec2::zeros() }; MAX_CORNERS];
        for m in 0..powers::<One>() {
            let [a, b, c, d] = PRODUCTS[m];
            height[m] = One::Map::nodal([at(a), at(b), at(c), at(d)]);
        }
        let y = &frame.projection.y;
        for k in 0..One::CORNERS {
            let (span, h) = (y[frame.projection.shape.next[k]] - y[k], &self.edge_height[k]);
            edges[k] = Edge {
                cubic: L::sums(self.cubic[k]).store(),
                height: L::sums([h[0], h[1], h[2], L::splat(0.0)]).store(),
                normal: Vec2::new(span.y, -span.x),
            };
        }
        Integrals {
            r: table::<L, One>(&self.own),
            height,
            edges,
            shifted: self.shifted,
            gap: self.gap,
            gradients: frame.map.gradients::<L>(),
        }
    }
}

#[derive(Clone, Copy)]
struct Edge {
    cubic: [f64; 4],
    height: [f64; 4],
    /// n ds/dt, n the outward normal.
    normal: Vec2,
}

/// The facet's integrals, of all pairs.
struct Integrals<L> {
    /// int (mu1_m / det1) N_k N_B, lanes B.
    r: Table<L>,
    /// int (mu1_m / det1) N_k v.
    height: [[f64; MAX_CORNERS]; 3],
    edges: [Edge; MAX_CORNERS],
    shifted: [[L; MAX_CORNERS]; 2],
    gap: [L; 2],
    /// det J grad N of the facet in powers (1, xi, eta), lanes over its nodes.
    gradients: [[L; 2]; 3],
}

impl<L: Lanes> Integrals<L> {
    /// Of the forces f_B of the field with the nodal values `p`, lanes B.
    #[inline(always)]
    fn forces<One: SingleBasis>(&self, p: &[f64; MAX_CORNERS]) -> PlaneDerivatives<L> {
        let mut d = [[L::splat(0.0); 2]; V + 1];
        let g = &self.gradients;
        let slope = dots(g, L::load(p));
        for m in 0..powers::<One::Cell>() {
            let r = &self.r[m];
            // sum_A R[k][A] p_A, lanes k: N_A, N_B and N_k are the same, so r is symmetric in k and B and serves for A.
            let rp = combine(r, p, One::Multiplier::FUNCTIONS).store();
            for k in 0..One::Cell::CORNERS {
                for c in 0..2 {
                    let v = L::splat(slope[m][c]).mul_add(r[k], g[m][c] * L::splat(rp[k]));
                    d[k][c] = d[k][c] - v;
                }
            }
        }
        // Along an edge N_A and N_B are the two linear functions of the map.
        for k in 0..One::Cell::CORNERS {
            let next = if k + 1 == One::Cell::CORNERS { 0 } else { k + 1 };
            let (p0, p1, s) = (p[k], p[next], &self.edges[k].cubic);
            let products = [p0 * s[0] + p1 * s[1], p0 * s[1] + p1 * s[2], p0 * s[2] + p1 * s[3]];
            add_ends(&mut d, [k, next], self.edges[k].normal, products);
        }
        let multipliers = One::Multiplier::FUNCTIONS;
        d[V] = [combine(&self.shifted[0], p, multipliers), combine(&self.shifted[1], p, multipliers)];
        d
    }

    /// Of the gaps gamma_A at fixed heights, lanes A; `heights` are those of the facet's nodes.
    #[inline(always)]
    fn gaps<One: SingleBasis>(&self, heights: &[f64; MAX_CORNERS]) -> PlaneDerivatives<L> {
        let mut d = self.forces::<One>(heights); // n_AB is symmetric: the field of heights, lanes A
        for m in 0..powers::<One::Cell>() {
            for k in 0..One::Cell::CORNERS {
                for c in 0..2 {
                    d[k][c] = self.gradients[m][c].mul_add(L::splat(self.height[m][k]), d[k][c]);
                }
            }
        }
        for k in 0..One::Cell::CORNERS {
            let next = if k + 1 == One::Cell::CORNERS { 0 } else { k + 1 };
            let [h0, h1, h2, _] = self.edges[k].height;
            add_ends(&mut d, [k, next], -self.edges[k].normal, [h0, h1, h2]);
        }
        d[V] = [d[V][0] + self.gap[0], d[V][1] + self.gap[1]];
        d
    }
}

/// Adds n times the products 00, 01, 11 of an edge's ends, in the slots and in the lanes of the two.
#[inline(always)]
fn add_ends<L: Lanes>(d: &mut PlaneDerivatives<L>, ends: [usize; 2], n: Vec2, products: [f64; 3]) {
    let v = in_lanes(products, &[unit(ends[0]), unit(ends[1])]);
    for j in 0..2 {
        let sum = &mut d[ends[j]];
        *sum = [L::splat(n.x).mul_add(v[j], sum[0]), L::splat(n.y).mul_add(v[j], sum[1])];
    }
}

/// sum_k g_k . Dy_k as coefficients of the Dx of the facet's nodes, in the plane's axes t1, t2, e.
#[inline(always)]
fn chain<L: Lanes, One: Cell>(frame: &NonmortarFrame, g: &PlaneDerivatives<L>) -> [[L; 3]; MAX_CORNERS] {
    let (plane, d) = (&frame.plane, &frame.projection.d);
    let mut tilt = g[V];
    for k in 0..One::CORNERS {
        tilt = [L::splat(d[k]).mul_add(g[k][0], tilt[0]), L::splat(d[k]).mul_add(g[k][1], tilt[1])];
    }
    let mut x = [[L::splat(0.0); 3]; MAX_CORNERS];
    for k in 0..One::CORNERS {
        let along = L::splat(plane.tilt[0][k]).mul_add(tilt[0], L::splat(plane.tilt[1][k]) * tilt[1]);
        x[k] = [g[k][0], g[k][1], -along];
    }
    x
}

/// Component j of such coefficients in space.
#[inline(always)]
fn column<L: Lanes>(frame: &NonmortarFrame, x: &[L; 3], j: usize) -> L {
    let (t1, t2, e) = (&frame.plane.t1, &frame.plane.t2, &frame.plane.e);
    L::splat(t1[j]).mul_add(x[0], L::splat(t2[j]).mul_add(x[1], L::splat(e[j]) * x[2]))
}
