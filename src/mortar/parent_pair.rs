//! A pair of facets as hosts have them, linear or quadratic: the sum over the pairs of their sub-facets
//! (docs/formulation.md 7.2).

use super::field::MultiplierSpace;
use super::segment::{NonmortarFrame, Segment};
use super::sub_pair::{SubDerivatives, SubWeights, rule_for, sub_derivatives, sub_weights};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Facet, Vec3};
use crate::quadrature::Rule;
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES, Parent, SubFacet};

/// Nodes of a pair: the non-mortar ones, then the mortar ones, each in [`MAX_PARENT_NODES`] slots.
pub const PARENT_PAIR_NODES: usize = 2 * MAX_PARENT_NODES;

/// A facet as hosts have it.
#[derive(Clone, Copy, Debug)]
pub struct ParentFacet {
    /// Its kind.
    pub parent: &'static Parent,
    /// Node positions, right-hand order seen from outside the body.
    pub x: [Vec3; MAX_PARENT_NODES],
}

impl ParentFacet {
    /// The facet through 3, 4, 6, 8 or 9 finite points.
    ///
    /// # Errors
    /// [`Kind::InvalidSize`]: another number; [`Kind::DegenerateFacet`]: a sub-facet that is turned over, as where mid nodes
    /// do not follow the corners in order.
    pub fn new(nodes: &[Vec3]) -> Result<ParentFacet> {
        let parent = Parent::of(nodes.len()).ok_or_else(|| {
            let text = text!("a facet has {} nodes; 3, 4, 6, 8 or 9 are allowed", nodes.len());
            Error::new(Kind::InvalidSize, text)
        })?;
        let mut x = [nodes[0]; MAX_PARENT_NODES];
        x[..nodes.len()].copy_from_slice(nodes);
        let facet = ParentFacet { parent, x };
        if parent.subs.len() > 1 {
            let corners = [0, 1, 2, 3].map(|k| x[k % parent.corners]);
            let whole = Facet { nodes: corners, shape: parent.cell }.area_vector();
            for (s, sub) in parent.subs.iter().enumerate() {
                if !(facet.sub(s).area_vector().dot(&whole) > 0.0) {
                    return Err(turned_over(sub));
                }
            }
        }
        Ok(facet)
    }

    /// A sub-facet.
    #[inline]
    pub fn sub(&self, s: usize) -> Facet {
        let SubFacet { nodes, shape, .. } = &self.parent.subs[s];
        Facet { nodes: nodes.map(|k| self.x[k]), shape }
    }
}

/// The first mid node of a sub-facet, or the centre: what is at fault where it is degenerate.
fn turned_over(sub: &SubFacet) -> Error {
    let nodes = &sub.nodes[..sub.shape.n];
    let text = text!(
        "the part of the facet between its nodes {nodes:?} (counted from 0) is turned over: mid node k must lie between corners k and k + 1, counted from 0, in the middle half of the edge"
    );
    Error::new(Kind::DegenerateFacet, text)
}

/// The frames of all sub-facets, each with the planes beyond its edges within the parent.
fn frame(one: &ParentFacet, s: usize) -> Result<NonmortarFrame> {
    let named = |e: Error| {
        let nodes = &one.parent.subs[s].nodes[..one.parent.subs[s].shape.n];
        match one.parent.subs.len() {
            1 => e,
            _ => Error::new(e.kind, text!("the part between nodes {nodes:?} (counted from 0): {}", e.message)),
        }
    };
    let mut frame = NonmortarFrame::new(&one.sub(s)).map_err(named)?;
    for (k, beyond) in one.parent.subs[s].beyond.iter().enumerate() {
        if let Some(other) = *beyond {
            frame.plane.beyond[k] = Some(crate::geometry::Plane::of(&one.sub(other)).map_err(named)?.e);
        }
    }
    Ok(frame)
}

/// n_AB and n_AC of a pair of parents, rows and columns their nodes; rows of nodes without a multiplier are zero [L^2].
#[derive(Clone, Debug, PartialEq)]
pub struct ParentWeights {
    /// n_AB.
    pub ab: [[f64; MAX_PARENT_NODES]; MAX_PARENT_NODES],
    /// n_AC.
    pub ac: [[f64; MAX_PARENT_NODES]; MAX_PARENT_NODES],
    /// The area of the overlap, of every pair of sub-facets in the plane of the non-mortar one [L^2].
    pub area: f64,
}

/// Derivatives of weights, `[A][B][k][j]`: with respect to component j of slot k of the pair's nodes `[L]`.
pub type OfParents = [[[[f64; 3]; PARENT_PAIR_NODES]; MAX_PARENT_NODES]; MAX_PARENT_NODES];

/// Derivatives of n_AB and n_AC. Large: made once by who keeps them.
#[derive(Clone, Debug)]
pub struct ParentDerivatives {
    /// Of n_AB.
    pub ab: OfParents,
    /// Of n_AC.
    pub ac: OfParents,
}

impl ParentDerivatives {
    /// Zeros.
    pub const ZERO: ParentDerivatives = {
        let zero = [[[[0.0; 3]; PARENT_PAIR_NODES]; MAX_PARENT_NODES]; MAX_PARENT_NODES];
        ParentDerivatives { ab: zero, ac: zero }
    };
}

/// The weights of a pair, and their derivatives, which begin with zeros, where asked for.
///
/// # Errors
/// [`Kind::DegenerateFacet`] of a sub-facet, which is named; [`Kind::ProjectionNotConvex`].
pub fn parent_weights(
    (one, two): (&ParentFacet, &ParentFacet),
    space: MultiplierSpace,
    rule: &'static Rule,
    mut derivatives: Option<&mut ParentDerivatives>,
) -> Result<ParentWeights> {
    let zero = [[0.0; MAX_PARENT_NODES]; MAX_PARENT_NODES];
    let mut sum = ParentWeights { ab: zero, ac: zero, area: 0.0 };
    let rule = rule_for(rule, [one.parent, two.parent]);
    for (s, sigma) in one.parent.subs.iter().enumerate() {
        let frame = frame(one, s)?;
        for (t, tau) in two.parent.subs.iter().enumerate() {
            let Some(segment) = Segment::new(&frame, &two.sub(t))? else { continue };
            let (pair, sides) = ((&frame, &segment, rule), ((one.parent, sigma), (two.parent, tau)));
            let rows = space.nodes(one.parent, sigma);
            sum.area += segment.area;
            match &mut derivatives {
                None => sum.add(rows, &sub_weights(pair, sides, space)),
                Some(to) => {
                    let mut d = SubDerivatives::default();
                    sum.add(rows, &sub_derivatives(pair, sides, space, &mut d));
                    to.add(rows, (sigma, tau), &d);
                }
            }
        }
    }
    Ok(sum)
}

impl ParentWeights {
    fn add(&mut self, rows: &[usize], weights: &SubWeights) {
        for (a, &row) in rows.iter().enumerate() {
            for b in 0..MAX_PARENT_NODES {
                self.ab[row][b] += weights.ab[a][b];
                self.ac[row][b] += weights.ac[a][b];
            }
        }
    }
}

impl ParentDerivatives {
    fn add(&mut self, rows: &[usize], (sigma, tau): (&SubFacet, &SubFacet), d: &SubDerivatives) {
        let slots = |k: usize| match k.checked_sub(MAX_CORNERS) {
            None => (k < sigma.shape.n).then(|| sigma.nodes[k]),
            Some(l) => (l < tau.shape.n).then(|| MAX_PARENT_NODES + tau.nodes[l]),
        };
        for (a, &row) in rows.iter().enumerate() {
            for (k, slot) in (0..2 * MAX_CORNERS).filter_map(|k| Some((k, slots(k)?))) {
                for (b, j) in (0..MAX_PARENT_NODES).flat_map(|b| (0..3).map(move |j| (b, j))) {
                    self.ab[row][b][slot][j] += d.ab[a][k][j][b];
                    self.ac[row][b][slot][j] += d.ac[a][k][j][b];
                }
            }
        }
    }
}
