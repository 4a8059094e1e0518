//! The exact tangent of one facet with dual multipliers, of all its pairs together (docs/formulation 10.4), given the
//! nodal states: for hosts that assemble facet by facet. Multiplier form; the mortar side moves.
//!
//! A pair's share of the facet's derivatives has columns of its own nodes alone, and is emitted pair by pair. What couples
//! the mortar nodes of all pairs, -sum_B n_BC D(phi q_B), takes n_BC of each pair with D(phi q_B) of each. So the pairs are
//! gone through twice after the facet's sums: for what they add to the same entries, and for the blocks. Nothing here
//! allocates: the first few pairs keep their derivatives in between, the others are differentiated twice. A node that
//! several mortar facets share has a place in each of them, and a host adds these up.

use super::facet_pairs::FacetPairs;
use super::response::FacetResponse;
use super::tangent::{PairNow, PairTangent, row_columns};
use crate::dual::{Columns, DualBasis, FacetMotion, FacetSums, GROUP, PairShare, TractionDerivatives, couple};
use crate::error::{Error, Kind, Result};
use crate::mortar::{
    AreaDerivatives, ForceDerivatives, MORTAR, NonmortarFrame, PAIR_NODES, PairWeights, pair_motion_raised,
};
use crate::quadrature::Rule;
use crate::shape::{MAX_CORNERS, MAX_NODES};

/// Pairs that keep their derivatives, 6 kB each on the stack. A facet over others of its size has about as many.
const KEPT: usize = 4;

/// A facet at its tractions, with the nodal states.
pub struct DualFacet<'a, P> {
    frame: &'a NonmortarFrame,
    rule: &'a Rule,
    pairs: &'a P,
    nodes: &'a FacetResponse<3>,
    /// `None` where the facet has faded out.
    motion: Option<(&'a DualBasis, FacetMotion<'a>)>,
}

/// What the pairs of a facet add to the same entries, for the columns x_k of the facet's nodes.
#[derive(Default)]
struct Shared {
    forces: [Columns; MORTAR],
    rows: [Columns; MORTAR],
    /// D(phi q_B).
    tractions: [Columns; MORTAR],
    /// Sizes of blocks, of weights n_BC, of D(phi q_B), added up.
    sizes: [f64; 3],
}

/// Derivatives of one pair.
#[derive(Default)]
struct Derivatives {
    tangent: PairTangent<3>,
    areas: AreaDerivatives,
    /// D(phi q_B).
    tractions: TractionDerivatives,
    /// n_BC and its share of n^d_AC: `[B][C]`, `[A][C]`.
    weights: [[f64; GROUP]; MAX_CORNERS],
    dual: [[f64; GROUP]; MAX_CORNERS],
}

/// What the blocks of a pair are made of, its mortar nodes in the rows or in the columns.
struct PairBlocks {
    number: usize,
    weights: [[f64; GROUP]; MAX_CORNERS],
    dual: [[f64; GROUP]; MAX_CORNERS],
    forces: [Columns; MAX_NODES],
    rows: [Columns; MAX_NODES],
    tractions: [Columns; MAX_NODES],
    /// The pair's own part of the rows of its mortar nodes.
    two: [Columns; PAIR_NODES],
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

    /// All blocks of the tangent, each once: first row and number of rows, column, `[j][i][row]` of them. Nodes are counted
    /// as in `x1`, `x2` of each pair, and the multipliers, one after the other.
    ///
    /// # Errors
    /// [`Kind::NotFinite`] when a block may overflow, before any is given.
    pub fn blocks(&self, mut sink: impl FnMut((usize, usize), usize, &Columns)) -> Result<()> {
        let (mut d, mut shared, mut kept) = (Derivatives::default(), Shared::default(), [const { None }; KEPT]);
        let mut n = 0;
        for p in 0..self.pairs.count() {
            if self.differentiate(p, &mut d)? {
                shared.add(&d);
                if let Some(kept) = kept.get_mut(n) {
                    *kept = Some(PairBlocks::of(p, &d));
                }
                n += 1;
            }
        }
        if !(shared.sizes[0] + shared.sizes[1] * shared.sizes[2]).is_finite() {
            return Err(Error::new(Kind::NotFinite, "k overflows: the inputs are out of range"));
        }
        let places = Places {
            own: self.frame.projection.shape.n,
            mortar: (0..self.pairs.count()).map(|p| self.pairs.nodes(p)).sum(),
        };
        let last = if n > KEPT { kept[KEPT - 1].as_ref().map(|pair| pair.number) } else { None };
        let mut first = places.own;
        for p in 0..self.pairs.count() {
            if last.is_some_and(|last| p > last) && self.differentiate(p, &mut d)? {
                kept[0] = Some(PairBlocks::of(p, &d)); // all that are kept have had their turn
            }
            let pair = kept.iter().flatten().find(|pair| pair.number == p);
            self.columns_of_pair((p, first), pair, &places, &mut sink);
            self.rows_of_pair((p, first), pair, &shared, &places, &mut sink);
            first += self.pairs.nodes(p);
        }
        self.own_blocks(&shared, &places, &mut sink);
        Ok(())
    }

    /// The derivatives of a pair; whether it overlaps or did at t_n, and has any. (Pairs that only touch have derivatives,
    /// though no weights: 3.6.)
    fn differentiate(&self, p: usize, d: &mut Derivatives) -> Result<bool> {
        let (weights, previous) =
            (self.pairs.weights(p), self.pairs.previous(p).filter(|n| *n != PairWeights::default()));
        let overlap = self.pairs.overlap(p)?;
        if overlap.is_none() && previous.is_none() {
            return Ok(false);
        }
        let Derivatives { tangent: PairTangent { forces, rows }, areas, tractions, .. } = d;
        let (mut gap, mut dual) = (None, PairWeights::default());
        if let (Some((basis, facet)), Some(overlap)) = (&self.motion, &overlap) {
            let pair = (self.frame, overlap, self.rule);
            let mut along = pair_motion_raised(pair, &weights, &facet.field, forces, facet.raised(areas));
            let share = PairShare { forces, gap: &mut along, areas, tractions };
            facet.share(self.pairs.nodes(p), &weights, share);
            (gap, dual) = (Some(along), basis.weights(&weights));
        } else {
            (*forces, *tractions) = (ForceDerivatives::default(), TractionDerivatives::default());
            *rows = Default::default();
        }
        let now = gap.as_ref().map(|gap| PairNow { weights: &dual, gap: Some(gap) });
        row_columns::<3>((now.as_ref(), previous.as_ref()), self.nodes, rows);
        (d.weights, d.dual) = (weights.ac, dual.ac);
        Ok(true)
    }

    /// The columns of a pair's mortar nodes, with the rows of all nodes and multipliers.
    fn columns_of_pair(
        &self,
        (p, first): (usize, usize),
        pair: Option<&PairBlocks>,
        places: &Places,
        sink: &mut impl FnMut((usize, usize), usize, &Columns),
    ) {
        let nothing = Columns::default();
        for c in 0..self.pairs.nodes(p) {
            let (forces, rows) = pair.map_or((&nothing, &nothing), |pair| (&pair.forces[c], &pair.rows[c]));
            sink((0, places.own), first + c, forces);
            sink((places.multiplier(0), places.own), first + c, rows);
        }
        let mut row = places.own;
        for q in 0..self.pairs.count() {
            let mut rows = [nothing; MAX_NODES];
            if let Some(pair) = pair {
                if p == q {
                    rows.copy_from_slice(&pair.two[MORTAR..]);
                }
                couple(&self.pairs.weights(q).ac, &pair.tractions, &mut rows);
            }
            for c in 0..self.pairs.nodes(p) {
                sink((row, self.pairs.nodes(q)), first + c, &rows[c]);
            }
            row += self.pairs.nodes(q);
        }
    }

    /// The rows of a pair's mortar nodes, with the columns of the facet's nodes and of its multipliers.
    fn rows_of_pair(
        &self,
        (p, first): (usize, usize),
        pair: Option<&PairBlocks>,
        shared: &Shared,
        places: &Places,
        sink: &mut impl FnMut((usize, usize), usize, &Columns),
    ) {
        let (mut rows, mut dual) = ([Columns::default(); MORTAR], [[0.0; GROUP]; MAX_CORNERS]);
        if let Some(pair) = pair {
            rows.copy_from_slice(&pair.two[..MORTAR]);
            couple(&pair.weights, &shared.tractions, &mut rows);
            dual = pair.dual;
        }
        for k in 0..places.own {
            sink((first, self.pairs.nodes(p)), k, &rows[k]);
            sink((first, self.pairs.nodes(p)), places.multiplier(k), &diagonal(dual[k].map(|n| -n)));
        }
    }

    /// The blocks that have the facet's own nodes and multipliers alone.
    fn own_blocks(&self, shared: &Shared, places: &Places, sink: &mut impl FnMut((usize, usize), usize, &Columns)) {
        let areas = self.motion.as_ref().map_or([0.0; MAX_CORNERS], |(basis, _)| basis.diagonal());
        for k in 0..places.own {
            let mut area = [0.0; MAX_CORNERS];
            area[k] = areas[k];
            sink((0, places.own), k, &shared.forces[k]);
            sink((places.multiplier(0), places.own), k, &shared.rows[k]);
            sink((0, places.own), places.multiplier(k), &diagonal(area));
            sink((places.multiplier(0), places.own), places.multiplier(k), &Columns::default());
        }
    }
}

impl PairBlocks {
    fn of(number: usize, d: &Derivatives) -> PairBlocks {
        let PairTangent { forces, rows } = &d.tangent;
        let mortar = |columns: &[Columns; PAIR_NODES]| *columns.last_chunk().expect("the mortar slots");
        PairBlocks {
            number,
            weights: d.weights,
            dual: d.dual,
            forces: mortar(&forces.one),
            rows: mortar(rows),
            tractions: mortar(&d.tractions),
            two: forces.two,
        }
    }
}

impl Shared {
    fn add(&mut self, d: &Derivatives) {
        let PairTangent { forces, rows } = &d.tangent;
        add(&mut self.forces, &forces.one[..MORTAR]);
        add(&mut self.rows, &rows[..MORTAR]);
        add(&mut self.tractions, &d.tractions[..MORTAR]);
        // Sums of sizes: none overflows without them.
        for blocks in [&forces.one, &forces.two, rows] {
            self.sizes[0] += size(flat(blocks));
        }
        self.sizes[0] += size(&d.dual);
        self.sizes[1] += size(&d.weights);
        self.sizes[2] += size(flat(&d.tractions));
    }
}

/// A block of one component each.
fn diagonal(n: [f64; MAX_CORNERS]) -> Columns {
    let mut block = Columns::default();
    for i in 0..3 {
        block[i][i] = n;
    }
    block
}

fn flat(columns: &[Columns]) -> &[[f64; MAX_CORNERS]] {
    columns.as_flattened().as_flattened()
}

fn add(sum: &mut [Columns], values: &[Columns]) {
    for (sum, v) in sum.as_flattened_mut().as_flattened_mut().iter_mut().zip(flat(values)) {
        for b in 0..MAX_CORNERS {
            sum[b] += v[b];
        }
    }
}

/// The sum of the sizes of some numbers: NaN or infinite where one is.
fn size(values: &[[f64; MAX_CORNERS]]) -> f64 {
    let mut sums = [0.0; MAX_CORNERS];
    for v in values {
        for b in 0..MAX_CORNERS {
            sums[b] += v[b].abs();
        }
    }
    sums.iter().sum()
}
