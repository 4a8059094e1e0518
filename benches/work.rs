//! What is measured: one pair of facets, one node, one interface.

use std::hint::black_box;
use stickslip::element::{FacetResponse, NodeTangent, PairNow, PairTangent, pair_force, row_columns};
use stickslip::geometry::{Facet, Mat3, Vec3};
use stickslip::law::{Friction, Node, SlipMeasure, Special};
use stickslip::mortar::{self, NonmortarFrame, PairWeights, Segment, WeightDerivatives, pair_motion};
use stickslip::quadrature::DEGREE_5;

/// Two facets.
#[derive(Clone, Copy)]
pub struct Pair {
    pub one: Facet,
    pub two: Facet,
}

/// The kinds of pairs.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    /// Quadrilaterals as they come: warped and distorted.
    Quads,
    /// Parallelograms.
    Affine,
    /// Triangles.
    Triangles,
    /// A triangle on a quadrilateral.
    Mixed,
}

impl Kind {
    /// The pairs of this kind that overlap, from quadrilaterals with 24 coordinates a pair.
    pub fn pairs(self, coordinates: &[f64]) -> Vec<Pair> {
        let facet = |x: &[f64], n: usize| {
            let mut x: Vec<_> = x.chunks_exact(3).take(n).map(Vec3::from_column_slice).collect();
            if self == Kind::Affine {
                x[3] = x[0] + x[2] - x[1];
            }
            Facet::new(&x).expect("3 or 4 nodes")
        };
        let (n1, n2) = match self {
            Kind::Quads | Kind::Affine => (4, 4),
            Kind::Triangles => (3, 3),
            Kind::Mixed => (3, 4),
        };
        let pairs = coordinates.chunks_exact(24).map(|x| Pair { one: facet(&x[..12], n1), two: facet(&x[12..], n2) });
        pairs.filter(|p| p.with_segment(|_, segment| segment.area) > Some(0.0)).collect()
    }
}

impl Pair {
    /// Planes, overlap; then `work`, where there is one. By reference: both are large.
    fn with_segment(&self, work: impl FnOnce(&NonmortarFrame, &Segment) -> f64) -> Option<f64> {
        let frame = NonmortarFrame::new(&self.one);
        let frame = frame.as_ref().ok()?;
        match &Segment::new(frame, &self.two) {
            Ok(Some(segment)) => Some(work(frame, segment)),
            _ => None,
        }
    }

    /// n_AB and n_AC.
    pub fn weights(&self) -> f64 {
        let work = |frame: &_, segment: &_| PairWeights::integrate(frame, segment, &DEGREE_5).ab[0][1];
        self.with_segment(work).unwrap_or(0.0)
    }

    /// The same and all derivatives.
    pub fn derivatives(&self, d: &mut WeightDerivatives) -> f64 {
        let work = |frame: &_, segment: &_| {
            let weights = d.update(frame, segment, &DEGREE_5);
            black_box(&d);
            weights.ab[0][1]
        };
        self.with_segment(work).unwrap_or(0.0)
    }

    /// Weights, gap, the law at every node, forces, and all blocks of the tangent.
    pub fn tangent(&self, t: &mut PairTangent) -> f64 {
        self.with_segment(|frame, segment| self.tangent_over(frame, segment, t)).unwrap_or(0.0)
    }

    fn tangent_over(&self, frame: &NonmortarFrame, segment: &Segment, t: &mut PairTangent) -> f64 {
        let w = PairWeights::integrate(frame, segment, &DEGREE_5);
        let gaps = mortar::gap(&w, &self.one, &self.two);
        let mut nodes = [NodeTangent::default(); 4];
        let mut tractions = [Vec3::zeros(); 4];
        for a in 0..self.one.len() {
            let node = node(gaps[a], frame.plane.e);
            let response = Friction::Coulomb.respond(&node);
            tractions[a] = node.lambda;
            nodes[a] = NodeTangent {
                traction: node.lambda,
                drow_dnow: response.drow_dnow,
                drow_dprevious: response.drow_dprevious,
                drow_darea: response.drow_darea,
            };
        }
        let force = pair_force(&w, &tractions);
        let nodes = FacetResponse::new(nodes.each_ref());
        let motion = pair_motion((frame, segment, &DEGREE_5), &w, &nodes.traction, &mut t.forces);
        let now = PairNow { weights: &w, gap: Some(&motion) };
        row_columns::<3>((Some(&now), Some(&w)), &nodes, &mut t.rows);
        black_box(&t);
        force[0].x + t.rows[0][0][0][0]
    }
}

/// A closed node with friction, some tangential traction.
pub fn node(gap: Vec3, e: Vec3) -> Node<3> {
    Node {
        lambda: Vec3::new(0.1, 0.2, -1.0),
        normal: -e,
        augmentation: 3.0,
        mu: 0.3,
        shear_limit: f64::INFINITY,
        gap_now: gap,
        gap_previous: gap * 1.01,
        gap_committed: Vec3::zeros(),
        covered: true,
        covered_before: true,
        slip: SlipMeasure::Objective,
        free: Mat3::identity(),
        special: Special::Nothing,
    }
}
