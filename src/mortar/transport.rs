//! Derivatives with respect to the projected vertices, in transport form (formulation c.5, kernel notes A): of the forces
//! of I fields p^i = sum_A N_A p^i_A on the non-mortar facet,
//!
//! f_B^i = int p^i N_B da, f_C^i = -int p^i N_C da,
//!
//! which with p^i = N_i are the weights themselves, and of the gaps gamma_A = int N_A h da, h = sum N_B d_B - sum N_C d_C at
//! fixed heights d. Of every such integral of f1 f2, functions of the two facets,
//!
//! D int f1 f2 = -int (grad f1 . v1) f2 + f1 (grad f2 . v2) da + sum_edges int f1 f2 (v . n) ds,
//!
//! v1 = sum N_k Dy1_k, v2 = sum N_l Dy2_l, v the velocity of the facet that owns the edge. No vertex
//! of the overlap is differentiated: that would lose a digit for every digit of a small crossing angle.

use super::moments::{Moments, RestMoments, combine, powers};
use super::segment::{NonmortarFrame, Segment};
use super::{MORTAR, PAIR_NODES};
use crate::geometry::Vec2;
use crate::geometry::edge_interval::{EdgeInterval, edge_intervals};
use crate::quadrature::Rule;
use crate::shape::{Cell, MAX_NODES};
use crate::simd::Lanes;

/// d/dy of the forces `one[k][i]`, lanes B, and `two[k][i]`, lanes C in the order of the facet as given, and of the gaps
/// `gap[k]`, lanes A; each with the two components of y_k, mortar slots k in the order of the projection.
///
/// Where the mortar side is at rest its vertices move in the plane only because that tilts, by their heights d_l times one and
/// the same vector: the one velocity v = sum_l N_l d_l, in the slot [`MORTAR`], serves in place of four. It has no forces.
pub(super) struct PlaneDerivatives<L, const I: usize> {
    pub one: [[[L; 2]; I]; PAIR_NODES],
    pub two: [[[L; 2]; I]; PAIR_NODES],
    pub gap: [[L; 2]; PAIR_NODES],
}

/// `sum` + n `v`, component by component.
#[inline(always)]
fn add<L: Lanes>(sum: &mut [L; 2], n: Vec2, v: L) {
    *sum = [L::splat(n.x).mul_add(v, sum[0]), L::splat(n.y).mul_add(v, sum[1])];
}

/// 1 in lane k.
#[inline(always)]
fn unit<L: Lanes>(k: usize) -> L {
    let mut v = [0.0; 4];
    v[k] = 1.0;
    L::load(&v)
}

/// The same numbers for another order of the nodes: lane `node[k]` takes lane k.
#[inline(always)]
fn reordered<L: Lanes>(v: L, node: &[usize; MAX_NODES]) -> L {
    let v = v.store();
    let mut w = [0.0; MAX_NODES];
    for k in 0..MAX_NODES {
        w[node[k]] = v[k];
    }
    L::load(&w)
}

/// Everything that the parts of the derivatives look at.
pub(super) struct Transport<'a, const I: usize> {
    pub frame: &'a NonmortarFrame,
    pub segment: &'a Segment,
    pub rule: &'a Rule,
    /// p^i_A.
    pub fields: &'a [[f64; MAX_NODES]; I],
}

impl<const I: usize> Transport<'_, I> {
    /// `MOVES`: with respect to the mortar side too; `GAP`: the gaps as well.
    #[inline(always)]
    pub fn derivatives<L: Lanes, One: Cell, Two: Cell, const MOVES: bool, const GAP: bool>(
        &self,
    ) -> PlaneDerivatives<L, I> {
        let zero = [L::splat(0.0); 2];
        let mut d = PlaneDerivatives { one: [[zero; I]; 8], two: [[zero; I]; 8], gap: [zero; 8] };
        let Transport { frame, segment, rule, .. } = *self;
        if MOVES {
            self.volume::<L, One, Two, GAP>(&mut d, &Moments::integrate::<One, Two>(frame, segment, rule));
        } else {
            self.volume_at_rest::<L, One, Two, GAP>(&mut d, &RestMoments::integrate::<One, Two>(frame, segment, rule));
        }
        let [nonmortar, mortar] = edge_intervals::<L>(&frame.projection, &segment.mortar, &frame.plane);
        for k in 0..One::NODES {
            if let Some(edge) = &nonmortar[k] {
                self.nonmortar_edge::<L, Two, MOVES, GAP>(&mut d, edge);
            }
        }
        for l in 0..Two::NODES {
            if let Some(edge) = &mortar[l] {
                self.mortar_edge::<L, One, MOVES, GAP>(&mut d, edge);
            }
        }
        d
    }

    /// Velocities and fields of the non-mortar facet in f_B and gamma_A: all of -int (grad (p N_B) . v1), and of the gap.
    #[inline(always)]
    fn volume_one<L: Lanes, One: Cell, const GAP: bool>(
        &self,
        d: &mut PlaneDerivatives<L, I>,
        r: &[[L; MAX_NODES]; 3],
        rh: &[[f64; MAX_NODES]; 3],
    ) {
        let g1 = self.frame.map.gradients::<L>();
        let heights = L::load(&self.frame.projection.d);
        for m in 0..powers::<One>() {
            // int (mu_m / det) N_k p^i, for r is symmetric in k and B.
            let mut rp = [[0.0; MAX_NODES]; I];
            for i in 0..I {
                rp[i] = combine(&r[m], &self.fields[i], One::NODES).store();
            }
            for c in 0..2 {
                // grad p^i and grad of the heights, their coefficients at mu_m.
                let mut p = [0.0; I];
                for i in 0..I {
                    p[i] = sum(g1[m][c] * L::load(&self.fields[i]));
                }
                let h = if GAP { sum(g1[m][c] * heights) } else { 0.0 };
                for k in 0..One::NODES {
                    for i in 0..I {
                        let s = L::splat(p[i]).mul_add(r[m][k], g1[m][c] * L::splat(rp[i][k]));
                        d.one[k][i][c] = d.one[k][i][c] - s;
                    }
                    if GAP {
                        let s = L::splat(h).mul_add(r[m][k], g1[m][c] * L::splat(rh[m][k]));
                        d.gap[k][c] = d.gap[k][c] - s;
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn volume<L: Lanes, One: Cell, Two: Cell, const GAP: bool>(&self, d: &mut PlaneDerivatives<L, I>, m: &Moments<L>) {
        let two = &self.segment.mortar;
        let mut rh = [[0.0; MAX_NODES]; 3];
        if GAP {
            let (d1, d2) = (L::load(&self.frame.projection.d), reordered(L::load(&two.d), &two.node));
            for (m, (r, q1)) in m.r.iter().zip(&m.q1).enumerate().take(powers::<One>()) {
                let mut h = [L::splat(0.0); MAX_NODES];
                for k in 0..One::NODES {
                    h[k] = r[k].mul_add(d1, -(q1[k] * d2));
                }
                rh[m] = L::sums(h).store();
            }
        }
        self.volume_one::<L, One, GAP>(d, &m.r, &rh);

        // f_C: grad p^i . v1, then grad N_C . v2.
        let (g1, g2) = (self.frame.map.gradients::<L>(), self.segment.mortar_map.gradients::<L>());
        for n in 0..powers::<One>() {
            for c in 0..2 {
                for i in 0..I {
                    let p = L::splat(sum(g1[n][c] * L::load(&self.fields[i])));
                    for k in 0..One::NODES {
                        d.two[k][i][c] = p.mul_add(m.q1[n][k], d.two[k][i][c]);
                    }
                }
            }
        }
        let heights = L::load(&two.d);
        for n in 0..powers::<Two>() {
            let mut q2p = [[0.0; MAX_NODES]; I];
            for i in 0..I {
                let (p, q2) = (L::load(&self.fields[i]), &m.q2[n]);
                q2p[i] = L::sums([q2[0] * p, q2[1] * p, q2[2] * p, q2[3] * p]).store();
            }
            for c in 0..2 {
                let g = reordered(g2[n][c], &two.node);
                let h = if GAP { L::splat(sum(g2[n][c] * heights)) } else { L::splat(0.0) };
                for l in 0..Two::NODES {
                    for i in 0..I {
                        d.two[MORTAR + l][i][c] = g.mul_add(L::splat(q2p[i][l]), d.two[MORTAR + l][i][c]);
                    }
                    if GAP {
                        d.gap[MORTAR + l][c] = h.mul_add(m.q2[n][l], d.gap[MORTAR + l][c]);
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn volume_at_rest<L: Lanes, One: Cell, Two: Cell, const GAP: bool>(
        &self,
        d: &mut PlaneDerivatives<L, I>,
        m: &RestMoments<L>,
    ) {
        self.volume_one::<L, One, GAP>(d, &m.r, &m.rh);
        if GAP {
            let (g2, heights) = (self.segment.mortar_map.gradients::<L>(), L::load(&self.segment.mortar.d));
            for n in 0..powers::<Two>() {
                for c in 0..2 {
                    let h = L::splat(sum(g2[n][c] * heights));
                    d.gap[MORTAR][c] = h.mul_add(m.q2v[n], d.gap[MORTAR][c]);
                }
            }
        }
    }

    #[inline(always)]
    fn nonmortar_edge<L: Lanes, Two: Cell, const MOVES: bool, const GAP: bool>(
        &self,
        d: &mut PlaneDerivatives<L, I>,
        edge: &EdgeInterval,
    ) {
        let (one, two) = (&self.frame.projection, &self.segment.mortar);
        let (from, to, zero) = (edge.from, edge.to, L::splat(0.0));
        let (y0, span, normal) = line(&one.y, edge);
        // int L_a L_b N_C, int L_a L_b h for the products 00, 01, 11, and int L_a L_b L_c.
        let (mut nc, mut h, mut cubic) = ([[zero; MAX_NODES]; 3], [zero; 4], [zero; 4]);
        for points in self.rule.line_lanes {
            let (w, t, y) = edge_points::<L>(points, edge, y0, span);
            let l = [L::splat(1.0) - t, t];
            let ww = [w * l[0] * l[0], w * l[0] * l[1], w * l[1] * l[1]];
            let terms = [ww[0] * l[0], ww[0] * l[1], ww[2] * l[0], ww[2] * l[1]];
            for q in 0..4 {
                cubic[q] = cubic[q] + terms[q];
            }
            if !MOVES && !GAP {
                continue;
            }
            let at = self.segment.mortar_map.inverse(y);
            let n2 = Two::values(at.xi, at.eta);
            if MOVES {
                for c in 0..Two::NODES {
                    for q in 0..3 {
                        nc[q][two.node[c]] = ww[q].mul_add(n2[c], nc[q][two.node[c]]);
                    }
                }
            }
            if GAP {
                let own = l[0].mul_add(L::splat(one.d[from]), l[1] * L::splat(one.d[to]));
                let gap = own - combine(&n2, &two.d, Two::NODES);
                for q in 0..3 {
                    h[q] = ww[q].mul_add(gap, h[q]);
                }
            }
        }
        let (e0, e1) = (unit::<L>(from), unit::<L>(to));
        let s = L::sums(cubic).store();
        let c = [L::sums(nc[0]), L::sums(nc[1]), L::sums(nc[2])];
        for i in 0..I {
            let (p0, p1) = (self.fields[i][from], self.fields[i][to]);
            let [s00, s01, s11] = [p0 * s[0] + p1 * s[1], p0 * s[1] + p1 * s[2], p0 * s[2] + p1 * s[3]];
            add(&mut d.one[from][i], normal, ends(e0, e1, s00, s01));
            add(&mut d.one[to][i], normal, ends(e0, e1, s01, s11));
            if MOVES {
                add(&mut d.two[from][i], -normal, ends(c[0], c[1], p0, p1));
                add(&mut d.two[to][i], -normal, ends(c[1], c[2], p0, p1));
            }
        }
        if GAP {
            let h = L::sums(h).store();
            add(&mut d.gap[from], normal, ends(e0, e1, h[0], h[1]));
            add(&mut d.gap[to], normal, ends(e0, e1, h[1], h[2]));
        }
    }

    #[inline(always)]
    fn mortar_edge<L: Lanes, One: Cell, const MOVES: bool, const GAP: bool>(
        &self,
        d: &mut PlaneDerivatives<L, I>,
        edge: &EdgeInterval,
    ) {
        let (one, two) = (&self.frame.projection, &self.segment.mortar);
        let (from, to, zero) = (edge.from, edge.to, L::splat(0.0));
        let (y0, span, normal) = line(&two.y, edge);
        // Velocities: of the edge's two nodes, or the one of a facet at rest.
        let velocities = if MOVES { 2 } else { 1 };
        // int v p^i N_B, int v h N_A, and int L_a L_b p^i for the products 00, 01, 11.
        let mut nb = [[[zero; MAX_NODES]; I]; 2];
        let (mut h, mut own) = ([[zero; MAX_NODES]; 2], [[zero; 4]; I]);
        for points in self.rule.line_lanes {
            let (w, t, y) = edge_points::<L>(points, edge, y0, span);
            let l = [L::splat(1.0) - t, t];
            let height = l[0].mul_add(L::splat(two.d[from]), l[1] * L::splat(two.d[to]));
            let v = if MOVES { [w * l[0], w * l[1]] } else { [w * height, zero] };
            let at = self.frame.map.inverse(y);
            let n1 = One::values(at.xi, at.eta);
            for i in 0..I {
                let p = combine(&n1, &self.fields[i], One::NODES);
                for j in 0..velocities {
                    let vp = v[j] * p;
                    for b in 0..One::NODES {
                        nb[j][i][b] = vp.mul_add(n1[b], nb[j][i][b]);
                    }
                    if MOVES {
                        own[i][2 * j] = vp.mul_add(l[j], own[i][2 * j]);
                    }
                }
                if MOVES {
                    own[i][1] = (v[0] * p).mul_add(l[1], own[i][1]);
                }
            }
            if GAP {
                let gap = combine(&n1, &one.d, One::NODES) - height;
                for j in 0..velocities {
                    for a in 0..One::NODES {
                        h[j][a] = (v[j] * gap).mul_add(n1[a], h[j][a]);
                    }
                }
            }
        }
        let slots = if MOVES { [MORTAR + from, MORTAR + to] } else { [MORTAR, MORTAR] };
        let (e0, e1) = (unit::<L>(two.node[from]), unit::<L>(two.node[to]));
        for i in 0..I {
            for j in 0..velocities {
                add(&mut d.one[slots[j]][i], normal, L::sums(nb[j][i]));
            }
            if MOVES {
                let s = L::sums(own[i]).store();
                add(&mut d.two[slots[0]][i], -normal, ends(e0, e1, s[0], s[1]));
                add(&mut d.two[slots[1]][i], -normal, ends(e0, e1, s[1], s[2]));
            }
        }
        if GAP {
            for j in 0..velocities {
                add(&mut d.gap[slots[j]], normal, L::sums(h[j]));
            }
        }
    }
}

/// The sum over the lanes.
#[inline(always)]
fn sum<L: Lanes>(v: L) -> f64 {
    let v = v.store();
    (v[0] + v[1]) + (v[2] + v[3])
}

/// `a` `s` + `b` `t`.
#[inline(always)]
fn ends<L: Lanes>(a: L, b: L, s: f64, t: f64) -> L {
    a.mul_add(L::splat(s), b * L::splat(t))
}

/// Beginning and span of an edge, and n ds/dt, n the outward normal of the facet that owns it.
#[inline(always)]
fn line(y: &[Vec2; MAX_NODES], edge: &EdgeInterval) -> (Vec2, Vec2, Vec2) {
    let span = y[edge.to] - y[edge.from];
    (y[edge.from], span, Vec2::new(span.y, -span.x) * edge.orientation)
}

/// Weights, parameters and positions of four points of an edge's interval.
#[inline(always)]
fn edge_points<L: Lanes>([t, w]: &[[f64; 4]; 2], edge: &EdgeInterval, y0: Vec2, span: Vec2) -> (L, L, [L; 2]) {
    let length = L::splat(edge.high - edge.low);
    let t = length.mul_add(L::load(t), L::splat(edge.low));
    let y = [L::splat(span.x).mul_add(t, L::splat(y0.x)), L::splat(span.y).mul_add(t, L::splat(y0.y))];
    (L::load(w) * length, t, y)
}
