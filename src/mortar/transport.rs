//! Derivatives of the weights with respect to the projected vertices, in transport form
//! (formulation c.5, kernel notes A):
//!
//! Dn_AC = -int (grad N_A . v1) N_C + N_A (grad N_C . v2) da + sum_edges int N_A N_C (v . n) ds,
//!
//! v1 = sum N_k Dy1_k, v2 = sum N_l Dy2_l, v the velocity of the facet that owns the edge. No vertex
//! of the overlap is differentiated: that would lose a digit for every digit of a small crossing angle.

use super::segment::{NonmortarFrame, Segment};
use super::{MORTAR, PAIR_NODES};
use crate::geometry::Vec2;
use crate::geometry::edge_interval::EdgeInterval;
use crate::quadrature::Rule;
use crate::shape::MAX_NODES;

/// dn/dy of every weight: `ab[k][A][B]`, `ac[k][A][C]`, k over S slots; mortar nodes (C and k) in the order of the
/// projection.
///
/// S is [`PAIR_NODES`], or [`AT_REST`] where the mortar side does not move: its vertices then move in the plane only
/// because the plane tilts, by their heights d_l times one and the same vector, and the one velocity sum_l N_l d_l, in the
/// slot `MORTAR`, serves in place of four.
pub(super) struct PlaneDerivatives<const S: usize> {
    pub ab: [[[Vec2; MAX_NODES]; MAX_NODES]; S],
    pub ac: [[[Vec2; MAX_NODES]; MAX_NODES]; S],
}

/// Slots with a mortar side at rest: the non-mortar nodes and one for all mortar nodes.
pub(super) const AT_REST: usize = MORTAR + 1;

/// The velocities of the mortar facet, S - MORTAR of them, where its shape functions have the values `n2`.
#[inline]
fn mortar_velocity<const S: usize>(segment: &Segment, n2: &[f64; MAX_NODES]) -> [f64; MAX_NODES] {
    if S == PAIR_NODES {
        return *n2;
    }
    let height = (0..MAX_NODES).map(|l| n2[l] * segment.mortar.d[l]).sum();
    [height, 0.0, 0.0, 0.0]
}

impl<const S: usize> PlaneDerivatives<S> {
    pub fn integrate(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> PlaneDerivatives<S> {
        let zero = [[[Vec2::zeros(); MAX_NODES]; MAX_NODES]; S];
        let mut d = PlaneDerivatives { ab: zero, ac: zero };
        d.add_volume(frame, segment, rule);
        let edges = segment.edges(frame);
        for edge in edges.nonmortar.iter().flatten() {
            d.add_nonmortar_edge(frame, segment, rule, edge);
        }
        for edge in edges.mortar.iter().flatten() {
            d.add_mortar_edge(frame, segment, rule, edge);
        }
        d
    }

    fn add_volume(&mut self, frame: &NonmortarFrame, segment: &Segment, rule: &Rule) {
        // det J grad N is linear in (xi, eta), so three moments of each product carry everything:
        // q1[m][k][C] = int mu1_m N1_k N2_C / det1, r likewise with N1_B, q2[m][l][A] = int mu2_m v2_l N1_A / det2.
        let mut q1 = [[[0.0; MAX_NODES]; MAX_NODES]; 3];
        let mut r = q1;
        let mut q2 = q1;
        segment.for_each_point(frame, rule, |p| {
            let (w1, w2) = (p.weight / p.one.det, p.weight / p.two.det);
            let mu1 = [w1, w1 * p.one.xi, w1 * p.one.eta];
            let mu2 = [w2, w2 * p.two.xi, w2 * p.two.eta];
            let v2 = mortar_velocity::<S>(segment, &p.n2);
            for m in 0..3 {
                for k in 0..MAX_NODES {
                    let a = mu1[m] * p.n1[k];
                    for j in 0..MAX_NODES {
                        q1[m][k][j] += a * p.n2[j];
                        r[m][k][j] += a * p.n1[j];
                    }
                }
                for l in 0..S - MORTAR {
                    let b = mu2[m] * v2[l];
                    for j in 0..MAX_NODES {
                        q2[m][l][j] += b * p.n1[j];
                    }
                }
            }
        });
        let (g1, g2) = (frame.map.gradients(), segment.mortar_map.gradients());
        for m in 0..3 {
            for a in 0..MAX_NODES {
                for b in 0..MAX_NODES {
                    for k in 0..MAX_NODES {
                        self.ab[k][a][b] -= g1[m][a] * r[m][k][b] + g1[m][b] * r[m][k][a];
                        self.ac[k][a][b] -= g1[m][a] * q1[m][k][b];
                    }
                    for l in 0..S - MORTAR {
                        self.ac[MORTAR + l][a][b] -= g2[m][b] * q2[m][l][a];
                    }
                }
            }
        }
    }

    fn add_nonmortar_edge(&mut self, frame: &NonmortarFrame, segment: &Segment, rule: &Rule, edge: &EdgeInterval) {
        let ends = [edge.from, edge.to];
        for_each_edge_point(&frame.projection.y, edge, rule, |weight, y, l, normal| {
            let two = segment.mortar_map.inverse(y);
            let n2 = segment.mortar.shape.values(two.xi, two.eta);
            for (i, &a) in ends.iter().enumerate() {
                for (j, &k) in ends.iter().enumerate() {
                    let s = normal * (weight * l[i] * l[j]);
                    for (o, &b) in ends.iter().enumerate() {
                        self.ab[k][a][b] += s * l[o];
                    }
                    for c in 0..MAX_NODES {
                        self.ac[k][a][c] += s * n2[c];
                    }
                }
            }
        });
    }

    fn add_mortar_edge(&mut self, frame: &NonmortarFrame, segment: &Segment, rule: &Rule, edge: &EdgeInterval) {
        let ends = [edge.from, edge.to];
        for_each_edge_point(&segment.mortar.y, edge, rule, |weight, y, l, normal| {
            let one = frame.map.inverse(y);
            let n1 = frame.projection.shape.values(one.xi, one.eta);
            // The edge's own two velocities, or the one of all.
            let height = l[0] * segment.mortar.d[ends[0]] + l[1] * segment.mortar.d[ends[1]];
            let (slots, v) = if S == PAIR_NODES { (ends, l) } else { ([0, 0], [height, 0.0]) };
            for j in 0..if S == PAIR_NODES { 2 } else { 1 } {
                for a in 0..MAX_NODES {
                    let s = normal * (weight * v[j] * n1[a]);
                    for b in 0..MAX_NODES {
                        self.ab[MORTAR + slots[j]][a][b] += s * n1[b];
                    }
                    for (o, &c) in ends.iter().enumerate() {
                        self.ac[MORTAR + slots[j]][a][c] += s * l[o];
                    }
                }
            }
        });
    }
}

/// Calls `visit(weight, y, [L_from, L_to], n ds/dt)` at the points of an interval of a source edge;
/// n is the outward normal of the facet that owns the edge.
#[inline]
fn for_each_edge_point(
    y: &[Vec2; MAX_NODES],
    edge: &EdgeInterval,
    rule: &Rule,
    mut visit: impl FnMut(f64, Vec2, [f64; 2], Vec2),
) {
    let span = y[edge.to] - y[edge.from];
    let normal = Vec2::new(span.y, -span.x) * edge.orientation;
    let length = edge.high - edge.low;
    for [t, w] in rule.line {
        let t = edge.low + length * t;
        visit(w * length, y[edge.from] + span * t, [1.0 - t, t], normal);
    }
}
