//! What a facet adds up over its pairs (docs/formulation 10.2).

use super::coverage::{Coverage, whole_area};
use crate::mortar::{NonmortarFrame, PairWeights, Segment, height_gap};
use crate::shape::MAX_CORNERS;

/// Sums over all pairs of one non-mortar facet.
#[derive(Clone, Copy, Debug)]
pub struct FacetSums {
    /// Number of the facet's nodes.
    pub nodes: usize,
    /// |e|, the area of the projected facet [L^2].
    pub area: f64,
    /// m_AB, the sum of n_AB [L^2].
    pub mass: [[f64; MAX_CORNERS]; MAX_CORNERS],
    /// The sum of gamma_A [L^3].
    pub gamma: [f64; MAX_CORNERS],
    /// Whether points stand for overlaps: they may not determine the facet's functions.
    pub by_points: bool,
}

impl FacetSums {
    /// Those of no pairs.
    pub fn new(frame: &NonmortarFrame) -> FacetSums {
        FacetSums {
            nodes: frame.projection.shape.n,
            area: whole_area(frame),
            mass: [[0.0; MAX_CORNERS]; MAX_CORNERS],
            gamma: [0.0; MAX_CORNERS],
            by_points: false,
        }
    }

    /// Those of the pairs of a facet with their current weights. Pairs without area add nothing.
    pub fn of<'a>(frame: &NonmortarFrame, pairs: impl Iterator<Item = (&'a Segment, &'a PairWeights)>) -> FacetSums {
        let mut sums = FacetSums::new(frame);
        for (segment, weights) in pairs {
            sums.by_points |= segment.points.is_some();
            sums.add(weights, &height_gap(frame, &segment.mortar, weights));
        }
        sums
    }

    /// Those of pairs whose gaps do not lie along the facet's normal: against an analytic surface. There is no gamma_A.
    pub fn of_areas(frame: &NonmortarFrame, pairs: &[PairWeights]) -> FacetSums {
        let mut sums = FacetSums::new(frame);
        for weights in pairs {
            sums.add(weights, &[0.0; MAX_CORNERS]);
        }
        sums
    }

    /// Adds a pair's weights and its gamma_A.
    pub fn add(&mut self, weights: &PairWeights, gamma: &[f64; MAX_CORNERS]) {
        for a in 0..MAX_CORNERS {
            self.gamma[a] += gamma[a];
            for b in 0..MAX_CORNERS {
                self.mass[a][b] += weights.ab[a][b];
            }
        }
    }

    /// m_A = sum_B m_AB, the covered area of each node [L^2].
    pub fn areas(&self) -> [f64; MAX_CORNERS] {
        self.mass.map(|row| row.iter().sum())
    }

    /// How much of the facet is covered.
    pub fn coverage(&self) -> Coverage {
        Coverage::of(self.areas().iter().sum::<f64>() / self.area)
    }
}
