//! One table of a facet with all of its pairs: what its kernels give is summed up over its columns, its own nodes in the first places and
//! then the mortar nodes of its pairs, each once, and everything else reads it: dual multipliers, offsets, rows, carried nodes, what
//! couples the pairs of a node. Those of active pairs come first: columns of pairs of t_n alone are in multipliers' rows, but in no
//! forces. Four nodes of the facet stand in lanes.

use super::dual_facet::DualFacet;
use super::read::{NodeBlock, ReadTable, Through};
use super::union::{Pairs, UnionPair};
use crate::dual::{Columns, FacetColumns, FacetMotion, FacetShare, GROUP};
use crate::element::{Along, FacetGaps, FacetResponse, Raise, Rows, Slopes, facet_rows, node_row};
use crate::error::Result;
use crate::geometry::Mat3;
use crate::interface::data::facet_nodes::FacetNodes;
use crate::interface::data::surface::Surface;
use crate::memory::{self, Store};
use crate::mortar::{
    AlongNormal, AreaDerivatives, ForceDerivatives, FrameGaps, GapBlocks, MORTAR, PAIR_NODES, PairWeights,
};
use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd::{self, Kernel, Lanes};
use std::ops::Range;

/// Lanes A of a column.
type Weights = [f64; MAX_CORNERS];

/// Column by column.
#[derive(Debug, Default)]
pub struct FacetTable {
    /// Nodes of the facet.
    own: usize,
    /// Its mortar nodes, and how many of them are of active pairs.
    pub mortar: Vec<usize>,
    pub active: usize,
    /// The columns that there are, each with its node over both surfaces.
    nodes: Vec<(usize, usize)>,
    /// Whether a pair is active.
    pub acts: bool,
    /// D of the own nodes' forces.
    pub forces: Vec<Columns>,
    /// n_AB and - n_AC as they act now, and of t_n.
    pub now: Vec<Weights>,
    previous: Vec<Weights>,
    /// Dg_A in factors.
    along: Option<Along>,
    slopes: Vec<Slopes>,
    blocks: Option<GapBlocks>,
    /// Dg_A of the points of a frame, which are the mortar nodes.
    frame: Option<FrameGaps>,
    /// Whether the weights are held fixed.
    fixed: bool,
    /// D of the covered areas: with dual multipliers, and where rows depend on them.
    areas: Vec<Slopes>,
    has_layer: bool,
    raise: Option<Raise>,
    offsets: Vec<Slopes>,
    /// Of dual multipliers: n_BC as integrated, D(phi q_B), and rows of the mortar nodes, as [`FacetColumns`] has them.
    weights: Vec<[[f64; GROUP]; MAX_CORNERS]>,
    tractions: Vec<Columns>,
    coupled: Vec<Columns>,
}

/// Each slot of a pair with its column.
struct Slots {
    of: [(usize, usize); PAIR_NODES],
    len: usize,
}

impl FacetTable {
    /// Begins with the facet of these pairs, in the memory of the one before. `two`: the mortar side where it has columns.
    pub fn begin(&mut self, one: &Surface, two: Option<&Surface>, (all, pairs): (Pairs, &[UnionPair])) -> Result<()> {
        let own = one.facets[pairs[0].one].as_slice();
        self.own = own.len();
        self.mortar.clear();
        if let Some(two) = two {
            for is_active in [true, false] {
                for pair in pairs.iter().filter(|pair| pair.is_active == is_active) {
                    for &node in two.facets[pair.two].as_slice() {
                        if !self.mortar.contains(&node) {
                            self.mortar.store(node)?;
                        }
                    }
                }
                self.active = if is_active { self.mortar.len() } else { self.active };
            }
        } else {
            self.active = 0;
        }
        self.acts = pairs.iter().any(|pair| pair.is_active);
        self.nodes.clear();
        self.nodes.store_all(own.iter().copied().enumerate())?;
        self.nodes.store_all(self.mortar.iter().enumerate().map(|(k, node)| (MAX_NODES + k, one.len() + node)))?;
        let columns = self.columns();
        memory::refill(&mut self.now, Default::default(), columns)?;
        memory::refill(&mut self.previous, Default::default(), columns)?;
        if self.forces.len() < columns {
            memory::refill(&mut self.forces, Columns::default(), columns)?;
        }
        (self.along, self.blocks, self.frame, self.raise, self.fixed) = (None, None, None, None, true);
        self.has_layer = false;
        for pair in pairs {
            let slots = self.slots(two.map(|two| &two.facets[pair.two]));
            let lists = [(all.now(pair), &mut self.now), (all.previous(pair), &mut self.previous)];
            lists.into_iter().for_each(|(n, to)| n.into_iter().for_each(|n| add_weights(n, &slots, to)));
        }
        Ok(())
    }

    /// Columns, those of nodes that a triangle does not have among them.
    pub fn columns(&self) -> usize {
        MAX_NODES + self.mortar.len()
    }

    fn slots(&self, two: Option<&FacetNodes>) -> Slots {
        let mut slots = Slots { of: [(0, 0); PAIR_NODES], len: self.own };
        (0..self.own).for_each(|k| slots.of[k] = (k, k));
        for (c, node) in two.map_or(&[][..], FacetNodes::as_slice).iter().enumerate() {
            if let Some(place) = self.mortar.iter().position(|known| known == node) {
                slots.of[slots.len] = (MORTAR + c, MAX_NODES + place);
                slots.len += 1;
            }
        }
        slots
    }

    /// Makes room for derivatives of now; of dual multipliers, and of offsets, where there are any. `adds`: whether kernels add up, in
    /// place of blocks that are put.
    pub fn differentiate(&mut self, is_dual: bool, adds: bool, raise: Option<Raise>) -> Result<()> {
        let (columns, none) = (self.columns(), [[0.0; MAX_CORNERS]; 3]);
        // Pairs of t_n alone have no derivatives.
        self.fixed = false;
        if adds {
            memory::refill(&mut self.forces, Columns::default(), columns)?;
            memory::refill(&mut self.slopes, none, columns)?;
        }
        self.raise = raise;
        if raise.is_some() {
            memory::refill(&mut self.offsets, none, columns)?;
        }
        if is_dual {
            memory::refill(&mut self.areas, none, columns)?;
            memory::refill(&mut self.tractions, Columns::default(), MAX_NODES + self.active)?;
            memory::refill(&mut self.weights, Default::default(), self.active.div_ceil(GROUP))?;
            self.begin_coupled()?;
        }
        Ok(())
    }

    /// Begins with no numbers in the rows of mortar nodes that dual multipliers couple.
    pub fn begin_coupled(&mut self) -> Result<()> {
        let columns = self.active.div_ceil(GROUP) * (MAX_NODES + self.active);
        memory::refill(&mut self.coupled, Columns::default(), columns)
    }

    /// Takes how gaps with fixed weights turn besides, or gaps of blocks with the forces of the own nodes.
    pub fn put_blocks(&mut self, blocks: GapBlocks, forces: Option<&ForceDerivatives>) {
        self.blocks = Some(blocks);
        if let Some(forces) = forces {
            self.forces[..self.own].copy_from_slice(&forces.one[..self.own]);
        }
    }

    /// Takes Dg_A by the frame of an analytic surface.
    pub fn put_frame(&mut self, gaps: FrameGaps) {
        self.frame = Some(gaps);
    }

    /// Adds what a kernel gives of a pair, or of all of them where `two` has no columns.
    #[inline(never)]
    pub fn add(
        &mut self,
        two: Option<&FacetNodes>,
        forces: &ForceDerivatives,
        gap: &AlongNormal,
        areas: Option<&AreaDerivatives>,
    ) {
        let slots = self.slots(two.filter(|_| !self.mortar.is_empty()));
        match &mut self.along {
            Some(along) => (0..MAX_CORNERS).for_each(|a| along.gamma[a] += gap.gamma[a]),
            None => self.along = Some(gap.into()),
        }
        let of_columns = self.forces.as_flattened_mut().as_flattened_mut();
        slots.sum(9, of_columns, forces.one.as_flattened().as_flattened());
        slots.sum(3, self.slopes.as_flattened_mut(), gap.dgamma.as_flattened());
        if let Some(areas) = areas {
            slots.sum(3, self.areas.as_flattened_mut(), areas.as_flattened());
        }
    }

    /// Adds the rows of the mortar nodes of a pair with dual multipliers, and its weights as they were integrated.
    pub fn add_mortar(&mut self, two: &FacetNodes, weights: &PairWeights, forces: &ForceDerivatives) {
        let places = two.nodes.map(|node| self.mortar.iter().position(|known| *known == node).unwrap_or(0));
        let mut sums = self.sums();
        sums.add_weights(weights, &places[..two.len]);
        sums.add_forces(forces, &places[..two.len]);
    }

    fn sums(&mut self) -> FacetColumns<'_> {
        let FacetTable { own, weights, tractions, coupled, .. } = self;
        FacetColumns { nodes: *own, weights, tractions, rows: coupled }
    }

    /// Begins with no derivatives of the covered areas, which rows depend on.
    pub fn begin_areas(&mut self) -> Result<()> {
        self.has_layer = true;
        let columns = self.columns();
        memory::refill(&mut self.areas, [[0.0; MAX_CORNERS]; 3], columns)
    }

    /// Adds Dm_A of a pair.
    pub fn add_areas(&mut self, two: Option<&FacetNodes>, of: &AreaDerivatives) {
        let slots = self.slots(two.filter(|_| !self.mortar.is_empty()));
        slots.sum(3, self.areas.as_flattened_mut(), of.as_flattened());
    }

    /// Adds Do_A of a pair.
    pub fn add_offsets(&mut self, two: Option<&FacetNodes>, of: &AreaDerivatives) {
        let slots = self.slots(two.filter(|_| !self.mortar.is_empty()));
        slots.sum(3, self.offsets.as_flattened_mut(), of.as_flattened());
    }

    /// Makes of what is there that of dual multipliers, of pairs with this kappa and phi.
    pub fn make_dual(&mut self, facet: &FacetMotion, (kappa, fade): (f64, f64)) {
        let FacetTable { along: Some(along), forces, slopes, areas, tractions, coupled, .. } = self else { return };
        let forces = &mut forces[..tractions.len()];
        facet.share_facet(
            kappa,
            FacetShare { forces, opposite: &mut [], gamma: &mut along.gamma, slopes, areas, tractions },
        );
        if fade != 1.0 {
            coupled.as_flattened_mut().as_flattened_mut().as_flattened_mut().iter_mut().for_each(|v| *v *= fade);
        }
        self.sums().couple();
    }

    /// The same of offsets, after it.
    pub fn make_dual_offsets(&mut self, dual: &DualFacet) {
        dual.share_offsets(&self.areas, &mut self.offsets);
    }

    /// D of the covered areas where they are known otherwise.
    pub fn put_areas(&mut self, areas: &AreaDerivatives) {
        self.areas[..MAX_NODES].copy_from_slice(&areas[..MAX_NODES]);
    }

    fn gaps(&self) -> FacetGaps<'_> {
        FacetGaps {
            along: self.along.as_ref(),
            slopes: &self.slopes,
            blocks: self.blocks.as_ref(),
            fixed: if self.fixed { &self.now } else { &[] },
            previous: &self.previous,
            raise: self.raise.as_ref(),
            offsets: &self.offsets,
            areas: if self.has_layer { &self.areas } else { &[] },
        }
    }

    /// The rows of the facet's multipliers, in place of what is in `rows`; zeros without the nodes' answers.
    pub fn rows<const N: usize>(&self, nodes: Option<&FacetResponse<N>>, rows: &mut Vec<Rows<N>>) -> Result<()> {
        memory::refill(rows, [[[0.0; MAX_CORNERS]; N]; 3], self.columns())?;
        if let Some(nodes) = nodes {
            facet_rows(self.gaps(), nodes, rows);
        }
        Ok(())
    }

    /// n_AB, or - n_AC, of these columns: `[A][column]`.
    pub fn weights_of(&self, columns: Range<usize>) -> [[f64; MAX_NODES]; MAX_CORNERS] {
        let mut n = [[0.0; MAX_NODES]; MAX_CORNERS];
        for (k, of) in self.now[columns].iter().enumerate() {
            (0..MAX_CORNERS).for_each(|a| n[a][k] = of[a]);
        }
        n
    }

    /// The columns of mortar nodes, up to four at a time, with the nodes and whether these are of active pairs.
    pub fn groups(&self) -> impl Iterator<Item = (Range<usize>, FacetNodes, bool)> {
        let of = |(first, end): (usize, usize), acts: bool| {
            (first..end).step_by(MAX_NODES).map(move |k| (k..end.min(k + MAX_NODES), acts))
        };
        let (active, all) = (self.active, self.mortar.len());
        of((0, active), true).chain(of((active, all), false)).map(|(of, acts)| {
            let mut nodes = FacetNodes { nodes: [self.mortar[of.start]; MAX_NODES], len: of.len() };
            nodes.nodes[..of.len()].copy_from_slice(&self.mortar[of.start..of.end]);
            (MAX_NODES + of.start..MAX_NODES + of.end, nodes, acts)
        })
    }

    /// Rows of mortar nodes that dual multipliers couple, four at a time: these nodes, and what they have in the columns of the own
    /// and of all of these.
    pub fn coupled(&self) -> impl Iterator<Item = (&[usize], &[Columns])> {
        self.mortar[..self.active].chunks(GROUP).zip(self.coupled.chunks_exact(MAX_NODES + self.active))
    }
}

impl ReadTable for FacetTable {
    fn nodes(&self) -> &[(usize, usize)] {
        &self.nodes
    }

    fn acts_on(&self, column: usize) -> bool {
        if column < MAX_NODES { self.acts } else { column < MAX_NODES + self.active }
    }

    fn weight(&self, column: usize, k: usize) -> f64 {
        self.now[column][k]
    }

    fn gap_row(&self, k: usize, through: &Through, row: &mut Vec<NodeBlock>) -> Result<()> {
        let Through { now, previous, area } = through;
        memory::refill(row, NodeBlock::default(), self.columns())?;
        node_row(self.gaps(), k, ([now, previous], area), row);
        for (d, to) in row[MAX_NODES..].iter_mut().enumerate() {
            let block = self.frame.map_or_else(Mat3::zeros, |frame| now * frame[k][d]);
            (0..9).for_each(|ij| to[ij / 3][ij % 3] += block[(ij % 3, ij / 3)]);
        }
        Ok(())
    }
}

#[inline(never)]
fn add_weights(n: &PairWeights, slots: &Slots, to: &mut [Weights]) {
    for &(slot, column) in &slots.of[..slots.len] {
        for a in 0..MAX_CORNERS {
            to[column][a] += if slot < MORTAR { n.ab[a][slot] } else { -n.ac[a][slot - MORTAR] };
        }
    }
}

impl Slots {
    /// Adds the columns of a pair's slots, of so many times four numbers each, to those of a facet.
    fn sum(&self, width: usize, to: &mut [[f64; 4]], of: &[[f64; 4]]) {
        simd::dispatch(Sum { slots: &self.of[..self.len], width, to, of });
    }
}

struct Sum<'a> {
    slots: &'a [(usize, usize)],
    width: usize,
    to: &'a mut [[f64; 4]],
    of: &'a [[f64; 4]],
}

impl Kernel for Sum<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Sum { slots, width, to, of } = self;
        for &(slot, column) in slots {
            let to = &mut to[column * width..][..width];
            for (to, of) in to.iter_mut().zip(&of[slot * width..]) {
                *to = (L::load(to) + L::load(of)).store();
            }
        }
    }
}
