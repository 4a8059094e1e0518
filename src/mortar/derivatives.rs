//! Derivatives of a pair's weights, forces and gaps with respect to its nodes (docs/formulation 3).

use super::chain::{Areas, Chain, Component, Flat, ForceDerivatives, ONE, SHAPES, WeightDerivatives, to_rows};
use super::edges::Edges;
use super::element_rule;
use super::gap::{AlongNormal, Raised, heights_over};
use super::moments::Moments;
use super::pair_weights::PairWeights;
use super::segment::{KindKernel, Kinds, NonmortarFrame, Segment};
use super::slots::PAIR_NODES;
use super::transport::Transport;
use super::weight_sums::Sums;
use crate::quadrature::Rule;
use crate::shape::{Basis, Isoparametric, MAX_CORNERS, MAX_NODES, SingleBasis};
use crate::simd::{Lanes, rolled};

impl WeightDerivatives {
    /// The weights and their exact derivatives over a segment (exact when the rule is: affine facets, degree 5; a
    /// coarser rule's derivatives are those of degree 5; of points, those of their own sums). The weights are those of
    /// [`PairWeights::integrate`] to the last bit.
    pub fn integrate(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> (PairWeights, WeightDerivatives) {
        let mut derivatives = WeightDerivatives::default();
        (derivatives.update(frame, segment, rule), derivatives)
    }

    /// The same in place of what is there: they are large.
    pub fn update(&mut self, frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> PairWeights {
        if frame.projection.shape.n < MAX_CORNERS || segment.mortar.shape.n < MAX_CORNERS {
            *self = WeightDerivatives::default(); // absent nodes
        }
        if let Some(points) = segment.points {
            return element_rule::derivatives(frame, segment, points, self);
        }
        let fine = rule.for_derivatives();
        let weights = Kinds::of(frame, segment).dispatch(OfWeights { frame, segment, rule: fine, derivatives: self });
        if fine.degree == rule.degree { weights } else { PairWeights::integrate(frame, segment, rule) }
    }

    /// The derivatives of the forces of the fields `p[i][A]` with these weights.
    pub fn of_forces(&self, p: &[[f64; MAX_CORNERS]; 3]) -> ForceDerivatives {
        let mut d = ForceDerivatives::default();
        for k in 0..PAIR_NODES {
            for (j, i) in (0..3).flat_map(|j| (0..3).map(move |i| (j, i))) {
                for b in 0..MAX_NODES {
                    for a in 0..MAX_CORNERS {
                        d.one[k][j][i][b] += p[i][a] * self.ab[a][b][k][j];
                        d.two[k][j][i][b] -= p[i][a] * self.ac[a][b][k][j];
                    }
                }
            }
        }
        d
    }
}

/// Derivatives of a pair with its current weights, exact where [`WeightDerivatives`] are: of the forces of the fields
/// `p[i][A]`, into `forces`, and of the gaps. Nodes that a triangle does not have are left as they are. Where the mortar
/// side is at rest: [`super::facet_motion`].
pub fn pair_motion(
    (frame, segment, rule): (&NonmortarFrame, &Segment, &Rule),
    weights: &PairWeights,
    p: &[[f64; MAX_CORNERS]; 3],
    forces: &mut ForceDerivatives,
) -> AlongNormal {
    motion((frame, segment, rule), weights, p, forces, None)
}

/// The same over a mortar surface that is raised: `dgamma` is that of gamma_A - sum_B n_AB h_B, while `gamma` stays the
/// pair's own.
pub fn pair_motion_raised(
    pair: (&NonmortarFrame, &Segment, &Rule),
    weights: &PairWeights,
    p: &[[f64; MAX_CORNERS]; 3],
    forces: &mut ForceDerivatives,
    raised: Raised,
) -> AlongNormal {
    motion(pair, weights, p, forces, Some(raised))
}

fn motion(
    (frame, segment, rule): (&NonmortarFrame, &Segment, &Rule),
    weights: &PairWeights,
    p: &[[f64; MAX_CORNERS]; 3],
    forces: &mut ForceDerivatives,
    raised: Option<Raised>,
) -> AlongNormal {
    if let Some(points) = segment.points {
        return element_rule::motion((frame, segment, points), weights, p, forces, raised);
    }
    let rule = rule.for_derivatives();
    Kinds::of(frame, segment).dispatch(OfPair { frame, segment, rule, weights, p, forces, raised })
}

struct OfPair<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
    weights: &'a PairWeights,
    p: &'a [[f64; MAX_CORNERS]; 3],
    forces: &'a mut ForceDerivatives,
    raised: Option<Raised<'a>>,
}

impl KindKernel for OfPair<'_> {
    type Output = AlongNormal;

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) -> AlongNormal {
        let OfPair { frame, segment, rule, weights, p, forces, raised } = self;
        let moments = Moments::<L>::integrate::<One, Two>(frame, segment, rule, None);
        let mut edges = Edges::new();
        edges.integrate::<One, Two>(frame, segment, rule);
        let transport = Transport::new::<One, Two>(frame, segment, &moments, &edges);
        let chain = Chain::new(frame, segment);
        // The gap first: the rows of multipliers wait for it, the forces do not wait for each other.
        let heights = heights_over(frame, &raised);
        let along = AlongNormal::new::<L, One, Two>(&chain, &transport.gap::<One, Two>(&heights), weights);
        for i in 0..rolled(3) {
            // Both sides before either is chained: sums of one are ready while those of the other are made.
            let field = transport.field(&p[i]);
            let (one, two) = (transport.one::<One>(&field), transport.two::<One, Two>(&field));
            chain.nodes::<One::Cell, Two::Cell>(&one, &mut Component { to: &mut forces.one, i });
            chain.nodes::<One::Cell, Two::Cell>(&two, &mut Component { to: &mut forces.two, i });
        }
        if let Some(raised) = raised {
            chain
                .nodes::<One::Cell, Two::Cell>(&transport.one::<One>(&transport.field(&ONE)), &mut Areas(raised.areas));
        }
        along
    }
}

struct OfWeights<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
    derivatives: &'a mut WeightDerivatives,
}

impl KindKernel for OfWeights<'_> {
    type Output = PairWeights;

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) -> PairWeights {
        let OfWeights { frame, segment, rule, derivatives } = self;
        let mut weights = Sums::new();
        let moments = Moments::<L>::integrate::<One, Two>(frame, segment, rule, Some(&mut weights));
        let mut edges = Edges::new();
        edges.integrate::<One, Two>(frame, segment, rule);
        let transport = Transport::new::<One, Two>(frame, segment, &moments, &edges);
        let chain = Chain::new(frame, segment);
        let mut columns = Flat([[L::splat(0.0); 3]; PAIR_NODES]);
        for a in 0..rolled(One::Multiplier::FUNCTIONS) {
            let field = transport.field(&SHAPES[a]);
            let (one, two) = (transport.one::<One>(&field), transport.two::<One, Two>(&field));
            chain.nodes::<One::Cell, Two::Cell>(&one, &mut columns);
            to_rows::<L, One::Displacement>(&columns.0, 1.0, &mut derivatives.ab[a]);
            chain.nodes::<One::Cell, Two::Cell>(&two, &mut columns);
            to_rows::<L, Two::Displacement>(&columns.0, -1.0, &mut derivatives.ac[a]);
        }
        weights.weights::<One, Two>(segment)
    }
}
