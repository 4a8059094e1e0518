//! The exact tangent of one facet with dual multipliers, of all its pairs together (docs/formulation.md 10.4), given the
//! nodal states: for hosts that assemble facet by facet. Multiplier form; the mortar side moves.
//!
//! A pair's share of the facet's derivatives has columns of its own nodes alone, and is emitted pair by pair. What couples
//! the mortar nodes of all pairs, -sum_B n_BC D(phi q_B), takes n_BC of each pair with D(phi q_B) of each. Nothing here
//! allocates, so the pairs are gone through three times: for the facet's sums; for what they add to the same entries; and
//! for the blocks. A node that several mortar facets share has a place in each of them, and a host adds these up.

use super::facet_pairs::FacetPairs;
use super::tangent::{FacetResponse, PairNow, PairTangent, row_columns};
use crate::dual::{DualBasis, FacetMotion, FacetSums, PairShare, TractionDerivatives, coupling};
use crate::error::{Error, Kind, Result};
use crate::geometry::Mat3;
use crate::mortar::{
    AreaDerivatives, GapDerivative, MORTAR, NonmortarFrame, PAIR_NODES, PairWeights, pair_motion_raised,
};
use crate::quadrature::Rule;
use crate::shape::MAX_CORNERS;

/// A facet at its tractions, with the nodal states.
pub struct DualFacet<'a, P> {
    frame: &'a NonmortarFrame,
    rule: &'a Rule,
    pairs: &'a P,
    nodes: &'a FacetResponse<3>,
    /// `None` where the facet has faded out.
    motion: Option<(&'a DualBasis, FacetMotion<'a>)>,
}

/// What the pairs of a facet add to the same entries, `[k][j]` for the columns x_k,j of the facet's nodes.
struct Shared {
    forces: [[[[f64; MAX_CORNERS]; 3]; 3]; MORTAR],
    rows: [[[[f64; MAX_CORNERS]; 3]; 3]; MORTAR],
    /// D(phi q_B).
    tractions: [[[[f64; MAX_CORNERS]; 3]; 3]; MORTAR],
    /// The largest number that a block of the tangent can have: infinite or NaN where one overflows.
    bound: f64,
}

/// Derivatives of one pair.
struct Derivatives {
    tangent: PairTangent<3>,
    /// D(phi q_B).
    tractions: TractionDerivatives,
}

/// Where a node of the facet stands among its blocks: its own nodes, those of the mortar facets, its multipliers.
struct Places {
    own: usize,
    mortar: usize,
}

impl Places {
    fn multiplier(&self, a: usize) -> usize {
        self.own + self.mortar + a
    }
}

impl<'a, P: FacetPairs> DualFacet<'a, P> {
    /// Of a facet with its sums ([`super::facet_sums`]) and their basis.
    pub fn new(
        (frame, rule): (&'a NonmortarFrame, &'a Rule),
        pairs: &'a P,
        (sums, basis): (&'a FacetSums, Option<&'a DualBasis>),
        nodes: &'a FacetResponse<3>,
    ) -> Self {
        let motion = |basis| (basis, FacetMotion::new(frame, basis, &sums.gamma, &nodes.traction));
        DualFacet { frame, rule, pairs, nodes, motion: basis.map(motion) }
    }

    /// All blocks of the tangent, each once: row, column, block. Nodes are counted as in `x1`, `x2` of each pair, and the
    /// multipliers, one after the other.
    ///
    /// # Errors
    /// [`Kind::NotFinite`] when a block may overflow, before any is given.
    pub fn blocks(&self, mut sink: impl FnMut(usize, usize, &Mat3)) -> Result<()> {
        let shared = self.shared()?;
        if !shared.bound.is_finite() {
            return Err(Error::new(Kind::NotFinite, "k overflows: the inputs are out of range"));
        }
        let places = Places {
            own: self.frame.projection.shape.n,
            mortar: (0..self.pairs.count()).map(|p| self.pairs.nodes(p)).sum(),
        };
        let mut derivatives = Derivatives::default();
        let mut first = places.own;
        for p in 0..self.pairs.count() {
            self.differentiate(p, &mut derivatives)?;
            self.columns_of_pair((p, first), &derivatives, &places, &mut sink);
            self.rows_of_pair((p, first), &derivatives, &shared, &places, &mut sink);
            first += self.pairs.nodes(p);
        }
        self.own_blocks(&shared, &places, &mut sink);
        Ok(())
    }

    /// The derivatives of a pair, zeros where it has none.
    fn differentiate(&self, p: usize, d: &mut Derivatives) -> Result<()> {
        *d = Derivatives::default();
        let (weights, previous) = (self.pairs.weights(p), self.pairs.previous(p));
        let overlap = self.pairs.overlap(p)?;
        let (dual, mut gap) = (self.dual_weights(&weights), None);
        if let (Some((_, facet)), Some(overlap)) = (&self.motion, &overlap) {
            let mut areas = AreaDerivatives::default();
            let (pair, forces) = ((self.frame, overlap, self.rule), &mut d.tangent.forces);
            let mut along = pair_motion_raised(pair, &weights, &facet.field, forces, facet.raised(&mut areas));
            let share = PairShare { forces, gap: &mut along, areas: &mut areas, tractions: &mut d.tractions };
            facet.share(self.pairs.nodes(p), &weights, share);
            gap = Some(GapDerivative::Facets(along));
        }
        let now = gap.as_ref().map(|gap| PairNow { weights: &dual, gap: Some(gap) });
        row_columns::<true, 3>(now.as_ref(), previous.as_ref(), self.nodes, &mut d.tangent.rows);
        Ok(())
    }

    /// A pair's share of the dual weights; none where the facet has faded out.
    fn dual_weights(&self, weights: &PairWeights) -> PairWeights {
        self.motion.as_ref().map_or_else(PairWeights::default, |(basis, _)| basis.weights(weights))
    }

    fn shared(&self) -> Result<Shared> {
        let mut shared = Shared::default();
        let mut d = Derivatives::default();
        let (mut blocks, mut weights, mut tractions) = (0.0, 0.0, 0.0);
        for p in 0..self.pairs.count() {
            self.differentiate(p, &mut d)?;
            let (PairTangent { forces, rows }, n) = (&d.tangent, self.pairs.weights(p));
            add(&mut shared.forces, &forces.one[..MORTAR]);
            add(&mut shared.rows, &rows[..MORTAR]);
            add(&mut shared.tractions, &d.tractions[..MORTAR]);
            // Sums of sizes: none overflows without them.
            blocks += size(&forces.one) + size(&forces.two) + size(rows);
            blocks += self.dual_weights(&n).ac.as_flattened().iter().map(|n| n.abs()).sum::<f64>();
            weights += n.ac.as_flattened().iter().map(|n| n.abs()).sum::<f64>();
            tractions += size(&d.tractions);
        }
        shared.bound = blocks + weights * tractions;
        Ok(shared)
    }

    /// The columns of a pair's mortar nodes, with the rows of all nodes and multipliers.
    fn columns_of_pair(
        &self,
        (p, first): (usize, usize),
        d: &Derivatives,
        places: &Places,
        sink: &mut impl FnMut(usize, usize, &Mat3),
    ) {
        for c in 0..self.pairs.nodes(p) {
            let (slot, column) = (MORTAR + c, first + c);
            for a in 0..places.own {
                sink(a, column, &d.tangent.force_x(a, slot));
                sink(places.multiplier(a), column, &d.tangent.row_x(a, slot));
            }
        }
        let mut row = places.own;
        for q in 0..self.pairs.count() {
            let weights = self.pairs.weights(q);
            for (b, c) in (0..self.pairs.nodes(q)).flat_map(|b| (0..self.pairs.nodes(p)).map(move |c| (b, c))) {
                let coupled = coupling(&weights.ac.map(|n| n[b]), &d.tractions[MORTAR + c]);
                let own = if p == q { d.tangent.force_x(MORTAR + b, MORTAR + c) } else { Mat3::zeros() };
                sink(row + b, first + c, &(own + coupled));
            }
            row += self.pairs.nodes(q);
        }
    }

    /// The rows of a pair's mortar nodes, with the columns of the facet's nodes and of its multipliers.
    fn rows_of_pair(
        &self,
        (p, first): (usize, usize),
        d: &Derivatives,
        shared: &Shared,
        places: &Places,
        sink: &mut impl FnMut(usize, usize, &Mat3),
    ) {
        let weights = self.pairs.weights(p);
        let dual = self.dual_weights(&weights);
        for (c, k) in (0..self.pairs.nodes(p)).flat_map(|c| (0..places.own).map(move |k| (c, k))) {
            let coupled = coupling(&weights.ac.map(|n| n[c]), &shared.tractions[k]);
            sink(first + c, k, &(d.tangent.force_x(MORTAR + c, k) + coupled));
            sink(first + c, places.multiplier(k), &Mat3::from_diagonal_element(-dual.ac[k][c]));
        }
    }

    /// The blocks that have the facet's own nodes and multipliers alone.
    fn own_blocks(&self, shared: &Shared, places: &Places, sink: &mut impl FnMut(usize, usize, &Mat3)) {
        let diagonal = self.motion.as_ref().map_or([0.0; MAX_CORNERS], |(basis, _)| basis.diagonal());
        for (a, k) in (0..places.own).flat_map(|a| (0..places.own).map(move |k| (a, k))) {
            let of = |d: &[[[f64; MAX_CORNERS]; 3]; 3]| Mat3::from_fn(|i, j| d[j][i][a]);
            sink(a, k, &of(&shared.forces[k]));
            sink(places.multiplier(a), k, &of(&shared.rows[k]));
            let area = if a == k { diagonal[a] } else { 0.0 };
            sink(a, places.multiplier(k), &Mat3::from_diagonal_element(area));
            sink(places.multiplier(a), places.multiplier(k), &Mat3::zeros());
        }
    }
}

impl Default for Derivatives {
    fn default() -> Self {
        Derivatives { tangent: PairTangent::default(), tractions: [[[[0.0; MAX_CORNERS]; 3]; 3]; PAIR_NODES] }
    }
}

impl Default for Shared {
    fn default() -> Self {
        let nothing = [[[[0.0; MAX_CORNERS]; 3]; 3]; MORTAR];
        Shared { forces: nothing, rows: nothing, tractions: nothing, bound: 0.0 }
    }
}

fn add(sum: &mut [[[[f64; MAX_CORNERS]; 3]; 3]], values: &[[[[f64; MAX_CORNERS]; 3]; 3]]) {
    let sum = sum.as_flattened_mut().as_flattened_mut().as_flattened_mut();
    for (sum, v) in sum.iter_mut().zip(values.as_flattened().as_flattened().as_flattened()) {
        *sum += v;
    }
}

/// The sum of the sizes of some numbers: NaN or infinite where one is.
fn size(values: &[[[[f64; MAX_CORNERS]; 3]; 3]]) -> f64 {
    values.as_flattened().as_flattened().as_flattened().iter().map(|v| v.abs()).sum()
}
