//! Derivatives of the weights with respect to the nodes: the plane derivatives of `transport`, chained
//! with Dy_k = in-plane part of (Dx_k - Dx0), spin and tilt of the plane (formulation c.2).

use super::segment::{NonmortarFrame, Segment};
use super::transport::{AT_REST, PlaneDerivatives};
use super::{MORTAR, PAIR_NODES};
use crate::geometry::{Vec2, Vec3};
use crate::quadrature::Rule;
use crate::shape::MAX_NODES;

/// dn/dx of every weight of a pair `[L]`; slots of absent nodes are zero.
#[derive(Clone, Debug)]
pub struct WeightDerivatives {
    /// `ab[A][B][k]` = d n_AB / d x_k, k over the pair's slots.
    pub ab: [[[Vec3; PAIR_NODES]; MAX_NODES]; MAX_NODES],
    /// `ac[A][C][k]` = d n_AC / d x_k.
    pub ac: [[[Vec3; PAIR_NODES]; MAX_NODES]; MAX_NODES],
}

impl Default for WeightDerivatives {
    fn default() -> Self {
        let zero = [[[Vec3::zeros(); PAIR_NODES]; MAX_NODES]; MAX_NODES];
        WeightDerivatives { ab: zero, ac: zero }
    }
}

impl WeightDerivatives {
    /// Exact derivatives over a segment (exact when the rule is: affine facets, degree 5).
    pub fn integrate(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> WeightDerivatives {
        let mut d = WeightDerivatives::default();
        d.update::<true>(frame, segment, rule);
        d
    }

    /// The same in place. Where the mortar side does not move (`MOVES` false) its slots are left as they are.
    pub fn update<const MOVES: bool>(&mut self, frame: &NonmortarFrame, segment: &Segment, rule: &Rule) {
        if frame.projection.shape.n < MAX_NODES || segment.mortar.shape.n < MAX_NODES {
            *self = WeightDerivatives::default(); // absent nodes
        }
        if MOVES {
            self.chain_all(frame, segment, &PlaneDerivatives::<PAIR_NODES>::integrate(frame, segment, rule));
        } else {
            self.chain_all(frame, segment, &PlaneDerivatives::<AT_REST>::integrate(frame, segment, rule));
        }
    }

    fn chain_all<const S: usize>(&mut self, frame: &NonmortarFrame, segment: &Segment, plane: &PlaneDerivatives<S>) {
        for a in 0..frame.projection.shape.n {
            for b in 0..frame.projection.shape.n {
                chain(frame, segment, plane.ab.each_ref().map(|g| g[a][b]), &mut self.ab[a][b]);
            }
            for c in 0..segment.mortar.shape.n {
                let dx = &mut self.ac[a][segment.mortar.node[c]];
                chain(frame, segment, plane.ac.each_ref().map(|g| g[a][c]), dx);
            }
        }
    }
}

/// sum_k g_k . Dy_k as coefficients of the Dx of the pair's nodes.
///
/// A translation and a spin of both facets change no weight: with a mortar side at rest the shares of the plane's own
/// translation and spin cancel between the facets, and only its tilt is left.
fn chain<const S: usize>(frame: &NonmortarFrame, segment: &Segment, g: [Vec2; S], dx: &mut [Vec3; PAIR_NODES]) {
    let (plane, one, two) = (&frame.plane, &frame.projection, &segment.mortar);
    let moves = S == PAIR_NODES;
    let (mut shift, mut spin, mut tilt) = (Vec3::zeros(), 0.0, Vec2::zeros());
    let mut add = |slot: usize, g: Vec2, y: Vec2, d: f64| {
        dx[slot] = plane.t1 * g.x + plane.t2 * g.y;
        tilt += g * d;
        if moves {
            shift += dx[slot];
            spin += g.x * y.y - g.y * y.x;
        }
    };
    for k in 0..one.shape.n {
        add(k, g[k], one.y[k], one.d[k]);
    }
    if moves {
        for k in 0..two.shape.n {
            add(MORTAR + two.node[k], g[MORTAR + k], two.y[k], two.d[k]);
        }
        shift /= one.shape.n as f64;
    } else {
        tilt += g[MORTAR];
    }
    for c in 0..one.shape.n {
        dx[c] -= plane.tilt[0][c] * tilt.x + plane.tilt[1][c] * tilt.y;
        if moves {
            dx[c] += plane.spin[c] * spin - shift;
        }
    }
}
