//! What a linear facet with all of its pairs puts into its table: what its kernels give, and what dual multipliers and offsets of the
//! nodes make of it (docs/formulation 10.4, 15.2). With o_A = sum_B n_AB h_B + sum_C n_AC h_C of the offsets h, dual multipliers
//! have phi m_A eta_A, eta = m^-1 o with the integrated weights, in its place: D(phi m_A) eta_A + phi m_A (m^-1 [Do - Dm eta])_A.

use super::derivatives::PairDerivatives;
use super::dual_facet::DualFacet;
use super::emission::Emitter;
use super::facet_table::FacetTable;
use super::frame::{self, FrameBlocks};
use super::task::{Numbers, Task};
use super::union::UnionPair;
use crate::dual::FacetMotion;
use crate::element::{FacetResponse, Raise};
use crate::error::Result;
use crate::geometry::AnalyticSurface;
use crate::interface::data::active::Active;
use crate::interface::data::offsets;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::stages::sums::in_previous_gaps;
use crate::mortar::{
    AreaDerivatives, ForceDerivatives, PAIR_NODES, analytic_motion, facet_motion, facet_motion_raised, gap,
    offset_motion, pair_motion, pair_motion_raised,
};
use crate::shape::MAX_CORNERS;

const NO_AREAS: AreaDerivatives = [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES];

/// What kernels are given to write to. Large, so that one serves all facets.
#[derive(Debug, Default)]
pub struct LinearRoom {
    forces: ForceDerivatives,
    overlaps: FacetOverlaps,
}

/// Fills the table of a facet with these pairs, once it was begun; rows of mortar facets that belong to one pair leave at once. Gives
/// the number of pairs whose weights were differentiated.
pub fn fill<const N: usize>(
    task: Task<N>,
    (numbers, pairs): (&Numbers<N>, &[UnionPair]),
    nodes: &FacetResponse<N>,
    (table, LinearRoom { forces, overlaps }): (&mut FacetTable, &mut LinearRoom),
    emitter: &mut Emitter<N>,
) -> Result<i64> {
    let Task { given, normals, moves, .. } = task;
    let ((one, two), f, places) = (given.setup.surfaces(), pairs[0].one, UnionPair::places(pairs));
    let Some(active) = numbers.active.filter(|_| !places.is_empty()) else {
        if let Some(gap) = given.history().facet_gaps.motion(one, f, numbers.x1)?.filter(|_| table.acts) {
            table.put_blocks(gap, None);
        }
        return Ok(0);
    };
    overlaps.of(given, active, UnionPair::places(pairs))?;
    let dual = DualFacet::of(given, (active, overlaps), pairs)?;
    let motion = dual.as_ref().and_then(|dual| dual.motion(overlaps.frame(), &nodes.traction));
    let is_offset = offsets::are_there((one, two));
    let of_nodes = one.facets[f].nodes.map(|a| normals[a]);
    let raise = is_offset.then(|| Raise { normals: of_nodes, in_previous: in_previous_gaps(given) });
    table.differentiate(dual.is_some(), numbers.motion.surface.is_none(), raise)?;
    if given.setup.reads_areas() {
        table.begin_areas()?;
    }
    let linearised = places.len() as i64;
    if dual.is_some() && motion.is_none() {
        return Ok(linearised); // it has faded out
    }
    if frame::is_read(given) {
        table.put_frame(FrameBlocks::of((given, task.pairs), &pairs[0], &numbers.into())?.gap);
    }
    let facet = Facet { f, pairs, active, overlaps, how: &numbers.motion, sides: [one, two], moves };
    let at = (dual.as_ref(), motion.as_ref());
    match numbers.motion.surface {
        Some(surface) => facet.over_surface((surface, &nodes.traction), at, forces, table)?,
        None => facet.over_facets(nodes, at, forces, (table, emitter)),
    }
    if given.setup.reads_areas() && dual.is_none() {
        facet.areas(forces, table)?;
    }
    if is_offset {
        facet.offsets(dual.as_ref(), forces, table)?;
    }
    Ok(linearised)
}

/// A facet with its pairs, where weights are differentiated.
struct Facet<'a> {
    f: usize,
    pairs: &'a [UnionPair],
    active: &'a Active,
    overlaps: &'a FacetOverlaps,
    how: &'a PairDerivatives<'a>,
    sides: [&'a Surface; 2],
    moves: bool,
}

impl Facet<'_> {
    /// Its active pairs.
    fn active_pairs(&self) -> impl Iterator<Item = &UnionPair> {
        self.pairs.iter().filter(|pair| pair.is_active)
    }

    fn over_facets<const N: usize>(
        &self,
        nodes: &FacetResponse<N>,
        (dual, motion): (Option<&DualFacet>, Option<&FacetMotion>),
        forces: &mut ForceDerivatives,
        (table, emitter): (&mut FacetTable, &mut Emitter<N>),
    ) {
        let (how, segments) = (self.how, &self.overlaps.segments);
        let (frame, mut areas) = (how.frame(self.overlaps.frame()), NO_AREAS);
        let of_pairs = self.active_pairs().zip(segments);
        if !self.moves && segments[0].points.is_none() {
            // With the mortar side at rest all of it is linear in the weights.
            let of = of_pairs.map(|(pair, segment)| (segment, self.active.integrated(pair.place)));
            let gap = match motion {
                Some(m) => facet_motion_raised(&frame, of, how.rule, &m.field, forces, m.raised(&mut areas)),
                None => facet_motion(&frame, of, how.rule, &nodes.traction, forces),
            };
            table.add(None, forces, &gap, motion.map(|_| &areas));
        } else {
            for (pair, segment) in of_pairs {
                let (weights, over) = (self.active.integrated(pair.place), (&*frame, segment, how.rule));
                let gap = match motion {
                    Some(m) => pair_motion_raised(over, weights, &m.field, forces, m.raised(&mut areas)),
                    None => pair_motion(over, weights, &nodes.traction, forces),
                };
                let two = &self.sides[1].facets[pair.two];
                table.add(Some(two), forces, &gap, motion.map(|_| &areas));
                match motion {
                    _ if !self.moves => {}
                    Some(_) => table.add_mortar(two, weights, forces),
                    None => emitter.pair(pair.two, forces),
                }
            }
        }
        if let (Some(dual), Some(motion)) = (dual, motion) {
            table.make_dual(motion, dual.coverage());
        }
    }

    fn over_surface(
        &self,
        (surface, traction): (&AnalyticSurface, &[[f64; MAX_CORNERS]; 3]),
        (dual, motion): (Option<&DualFacet>, Option<&FacetMotion>),
        forces: &mut ForceDerivatives,
        table: &mut FacetTable,
    ) -> Result<()> {
        let (frame, how) = (self.overlaps.frame(), self.how);
        let (Some(dual), Some(motion)) = (dual, motion) else {
            let gap = analytic_motion(frame, surface, how.rule, traction, forces)?;
            table.put_blocks(gap, Some(forces));
            return Ok(());
        };
        let mut areas = NO_AREAS;
        for pair in self.active_pairs() {
            let [one, two] = self.sides;
            let facets = (one.facet(self.f, &self.active.x1), two.facet(pair.two, &self.active.x2));
            let gaps = gap(self.active.integrated(pair.place), &facets.0, &facets.1);
            let at = (&motion.tractions, &gaps);
            if let Some(gap) = dual.of_analytic((how, surface), frame, at, (forces, &mut areas))? {
                table.put_blocks(gap, Some(forces));
                table.put_areas(&areas);
            }
        }
        Ok(())
    }

    /// Derivatives of the covered areas with the standard basis: of the integrals of N_A times 1.
    fn areas(&self, forces: &mut ForceDerivatives, table: &mut FacetTable) -> Result<()> {
        let (how, frame, ones) = (self.how, self.overlaps.frame(), [1.0; MAX_CORNERS]);
        if let Some(surface) = how.surface {
            analytic_motion(frame, surface, how.rule, &[ones; 3], forces)?;
            let slopes = forces.one.map(|column| column.map(|of| of[0]));
            table.add_areas(None, &slopes);
            return Ok(());
        }
        let frame = how.frame(frame);
        for (pair, segment) in self.active_pairs().zip(&self.overlaps.segments) {
            let mut slopes = NO_AREAS;
            offset_motion((&frame, segment, how.rule), (&ones, &[0.0; MAX_CORNERS]), &mut slopes);
            table.add_areas(Some(&self.sides[1].facets[pair.two]), &slopes);
        }
        Ok(())
    }

    /// What offsets of the nodes add, after all else.
    fn offsets(&self, dual: Option<&DualFacet>, forces: &mut ForceDerivatives, table: &mut FacetTable) -> Result<()> {
        let (how, [one, two]) = (self.how, self.sides);
        let (frame, mut h) = (self.overlaps.frame(), one.offsets_of(one.facets[self.f].as_slice()));
        let eta = dual.and_then(DualFacet::offsets);
        if let Some(surface) = how.surface {
            if eta.is_none() {
                // n_AB is symmetric: the field of offsets as a traction.
                analytic_motion(frame, surface, how.rule, &[h; 3], forces)?;
                let slopes = forces.one.map(|column| column.map(|of| of[0]));
                table.add_offsets(None, &slopes);
            } // else eta are the offsets themselves
        } else {
            if let Some(eta) = eta {
                (0..MAX_CORNERS).for_each(|b| h[b] -= eta[b]);
            }
            let frame = how.frame(frame);
            for (pair, segment) in self.active_pairs().zip(&self.overlaps.segments) {
                let mut slopes = NO_AREAS;
                let of_two = two.offsets_of(two.facets[pair.two].as_slice());
                offset_motion((&frame, segment, how.rule), (&h, &of_two), &mut slopes);
                table.add_offsets(Some(&two.facets[pair.two]), &slopes);
            }
        }
        if let Some(dual) = dual {
            table.make_dual_offsets(dual);
        }
        Ok(())
    }
}
