//! Derivatives of what offsets of the nodes add to the gaps of a pair (docs/formulation 15.2):
//!
//! o_A = sum_B n_AB h_B + sum_C n_AC h_C [L^3],
//!
//! the integral of N_A times the sum of both fields of offsets, h held fixed at the nodes. They are derivatives of gaps
//! whose heights are h on the non-mortar and -h on the mortar side, with the geometry as it is.

use super::chain::{AreaDerivatives, Areas, Chain};
use super::edges::Edges;
use super::element_rule;
use super::moments::Moments;
use super::segment::{KindKernel, Kinds, NonmortarFrame, Segment};
use super::transport::Transport;
use crate::features;
use crate::quadrature::Rule;
use crate::shape::{Isoparametric, MAX_CORNERS, SingleBasis};
use crate::simd::Lanes;

/// `[k][j][A]`: d o_A / d x_k,j, into `slopes` [L^2]. `one`, `two`: h of the two facets' nodes, in the order of the facets
/// `[L]`. Nodes that a triangle does not have are left as they are.
pub fn offset_motion(
    (frame, segment, rule): (&NonmortarFrame, &Segment, &Rule),
    (one, two): (&[f64; MAX_CORNERS], &[f64; MAX_CORNERS]),
    slopes: &mut AreaDerivatives,
) {
    features::OFFSETS.is_here();
    let mut raised = segment.clone();
    for k in 0..MAX_CORNERS {
        raised.mortar.d[k] = -two[segment.mortar.node[k]];
    }
    match segment.points {
        Some(points) => element_rule::offsets((frame, segment, points), &raised, one, slopes),
        None => {
            let rule = rule.for_derivatives();
            Kinds::of(frame, segment).plain(Offsets { frame, segment, raised: &raised, rule, one, slopes });
        }
    }
}

struct Offsets<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    /// The segment with the mortar side's values in place of its heights.
    raised: &'a Segment,
    rule: &'a Rule,
    one: &'a [f64; MAX_CORNERS],
    slopes: &'a mut AreaDerivatives,
}

impl KindKernel for Offsets<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) {
        let Offsets { frame, segment, raised, rule, one, slopes } = self;
        let moments = Moments::<L>::integrate::<One, Two>(frame, raised, rule, None);
        let mut edges = Edges::new();
        edges.integrate::<One, Two>(frame, raised, rule);
        let transport = Transport::new::<One, Two>(frame, raised, &moments, &edges);
        Chain::new(frame, segment).nodes::<One::Cell, Two::Cell>(&transport.gap::<One, Two>(one), &mut Areas(slopes));
    }
}
