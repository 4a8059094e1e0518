//! What a facet of the host adds up over its parts before its blocks leave, where either side has quadratic facets: derivatives
//! over its own nodes and those of its mortar facets (docs/formulation 12.5).

use super::read::{NodeBlock, ReadTable, Through, matrix};
use super::union::UnionPair;
use crate::dual::{DualBasis, corner_shares};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::surface::Surface;
use crate::memory::{self, Store};
use crate::mortar::{FrameGaps, MORTAR, ParentWeights, SubMotion};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES, Parent};

/// A mortar node of a facet's pairs.
#[derive(Clone, Copy, Debug)]
pub struct MortarNode {
    pub node: usize,
    /// Which of the active pairs have it, a bit each; the last one stands for all that have no bit of their own.
    pub pairs: u128,
}

/// The bit of the k-th pair.
pub fn bit(k: usize) -> u128 {
    1 << k.min(127)
}

/// Sums over the parts of a facet. Rows and columns of nodes: the facet's own, then mortar nodes, each once.
#[derive(Debug, Default)]
pub struct ParentTable {
    /// Own nodes.
    pub own: usize,
    /// Multipliers, at the first own nodes.
    pub multipliers: usize,
    /// Mortar nodes.
    pub mortar: Vec<MortarNode>,
    /// Whether a pair is active.
    pub acts: bool,
    /// The columns, each with its node over both surfaces.
    nodes: Vec<(usize, usize)>,
    /// Derivatives of forces with fixed tractions, `[row][column]`.
    forces: Vec<NodeBlock>,
    /// Dg, `[multiplier][column]`; the fourth number: of the covered area.
    gaps: Vec<NodeBlock>,
    /// Do_A of the nodes' offsets, `[multiplier][column]`; empty where there are none.
    offsets: Vec<[f64; 3]>,
    /// nu of the own nodes, along which they count, and whether they do in the gaps that slip is measured from.
    along: ([Vec3; MAX_PARENT_NODES], bool),
    /// n_AB and - n_AC of now as they act, of now as they were integrated, and of t_n, `[multiplier][column]`.
    pub now: Vec<f64>,
    integrated: Vec<f64>,
    pub previous: Vec<f64>,
}

/// A facet with dual multipliers: its basis, its tractions, and what its kernels are asked for.
pub struct DualParent<'a> {
    pub basis: &'a DualBasis,
    pub parent: &'static Parent,
    /// p_A.
    pub tractions: [Vec3; MAX_CORNERS],
    /// q_A with sum_B m_AB q_B = m_A p_A.
    pub field: [Vec3; MAX_CORNERS],
    /// h_A = (m^-1 gamma)_A.
    pub heights: [Vec3; MAX_CORNERS],
    /// D|e| of the own nodes.
    pub area: [Vec3; MAX_PARENT_NODES],
}

/// Adds those of the b-th function.
#[inline(always)]
fn add<const B: usize>(to: &mut NodeBlock, of: &[[[f64; 4]; B]; 3], b: usize) {
    for j in 0..3 {
        for i in 0..4 {
            to[j][i] += of[j][b][i];
        }
    }
}

fn set(to: &mut NodeBlock, of: &Mat3) {
    (0..9).for_each(|ij| to[ij % 3][ij / 3] = of[(ij / 3, ij % 3)]);
}

/// A linear function of three components, of each.
fn each(v: &[Vec3; MAX_CORNERS], f: impl Fn(&[f64; MAX_CORNERS]) -> [f64; MAX_CORNERS]) -> [Vec3; MAX_CORNERS] {
    let rows = [0, 1, 2].map(|i| f(&v.map(|v| v[i])));
    std::array::from_fn(|a| Vec3::new(rows[0][a], rows[1][a], rows[2][a]))
}

impl<'a> DualParent<'a> {
    /// At these tractions and gaps as they were integrated.
    pub fn new(
        basis: &'a DualBasis,
        parent: &'static Parent,
        tractions: [Vec3; MAX_CORNERS],
        gaps: &[Vec3; MAX_CORNERS],
        area: [Vec3; MAX_PARENT_NODES],
    ) -> DualParent<'a> {
        let p = [0, 1, 2].map(|i| tractions.map(|t| t[i]));
        let q = basis.tractions(&p);
        let field = std::array::from_fn(|a| Vec3::new(q[0][a], q[1][a], q[2][a]));
        let heights = each(gaps, |g| basis.heights(g));
        DualParent { basis, parent, tractions, field, heights, area }
    }

    /// The own nodes with their heights taken away: over these the kernels' gaps are gamma_A - (m h)_A.
    pub fn lowered(&self, x: &[Vec3; MAX_PARENT_NODES]) -> [Vec3; MAX_PARENT_NODES] {
        self.lowered_by(x, &self.heights)
    }

    /// The same with other heights.
    pub fn lowered_by(&self, x: &[Vec3; MAX_PARENT_NODES], heights: &[Vec3; MAX_CORNERS]) -> [Vec3; MAX_PARENT_NODES] {
        let c = corner_shares(self.parent);
        let height = |k: usize| -> Vec3 { (0..self.basis.nodes).map(|b| heights[b] * c[b][k]).sum() };
        std::array::from_fn(|k| x[k] - height(k))
    }
}

impl ReadTable for ParentTable {
    fn nodes(&self) -> &[(usize, usize)] {
        &self.nodes
    }

    fn acts_on(&self, column: usize) -> bool {
        column.checked_sub(self.own).map_or(self.acts, |k| self.mortar[k].pairs != 0)
    }

    fn weight(&self, column: usize, k: usize) -> f64 {
        self.now.get(k * self.columns() + column).copied().unwrap_or_default() // none in a pattern
    }

    fn gap_row(&self, a: usize, through: &Through, row: &mut Vec<NodeBlock>) -> Result<()> {
        let Through { now, previous, area } = through;
        let columns = a * self.columns()..(a + 1) * self.columns();
        let (start, end) = (columns.start, columns.end);
        memory::refill(row, NodeBlock::default(), self.columns())?;
        for ((to, gap), n) in row.iter_mut().zip(&self.gaps[start..end]).zip(&self.previous[columns]) {
            for j in 0..3 {
                for i in 0..3 {
                    to[j][i] = (0..3).map(|k| now[(i, k)] * gap[j][k]).sum::<f64>() + previous[(i, j)] * n;
                }
            }
        }
        if *area != Vec3::zeros() {
            for (to, gap) in row.iter_mut().zip(&self.gaps[start..end]) {
                (0..9).for_each(|ij| to[ij % 3][ij / 3] += area[ij / 3] * gap[ij % 3][3]);
            }
        }
        let Some(offsets) = self.offsets.get(start..end) else { return Ok(()) };
        let (nu, in_previous) = (&self.along.0[a], self.along.1);
        let along = if in_previous { (now + previous) * nu } else { now * nu };
        for (to, slope) in row.iter_mut().zip(offsets) {
            (0..9).for_each(|ij| to[ij % 3][ij / 3] += along[ij / 3] * slope[ij % 3]);
        }
        Ok(())
    }
}

impl ParentTable {
    /// Begins with facet f of the host and these nodes, in the memory of the facet before.
    pub fn begin(
        &mut self,
        (one, f): (&Surface, usize),
        mortar: impl Iterator<Item = MortarNode>,
        has_numbers: bool,
    ) -> Result<()> {
        let (own, multipliers) = (one.host_nodes(f), one.multipliers(f));
        (self.own, self.multipliers, self.acts) = (own.len(), multipliers, false);
        self.mortar.clear();
        for new in mortar {
            match self.mortar.iter_mut().find(|known| known.node == new.node) {
                Some(known) => known.pairs |= new.pairs,
                None => self.mortar.store(new)?,
            }
        }
        let mortar = self.mortar.iter().map(|known| one.len() + known.node);
        self.nodes.clear();
        self.nodes.store_all(own.iter().copied().chain(mortar).enumerate())?;
        let n = if has_numbers { self.columns() } else { 0 };
        memory::refill(&mut self.forces, NodeBlock::default(), n * n)?;
        memory::refill(&mut self.gaps, NodeBlock::default(), multipliers * n)?;
        self.offsets.clear();
        for weights in [&mut self.now, &mut self.integrated, &mut self.previous] {
            memory::refill(weights, 0.0, multipliers * n)?;
        }
        Ok(())
    }

    /// Own and mortar nodes.
    pub fn columns(&self) -> usize {
        self.own + self.mortar.len()
    }

    /// The column of a mortar node, if it has one.
    pub fn column(&self, node: usize) -> Option<usize> {
        self.mortar.iter().position(|known| known.node == node).map(|k| self.own + k)
    }

    /// Whether two mortar nodes are of one facet of these pairs that is active.
    pub fn share_a_pair(&self, nodes: [usize; 2], pairs: &[UnionPair], two: &Surface) -> bool {
        let [c, d] = nodes.map(|k| self.mortar[k]);
        let common = c.pairs & d.pairs;
        // The last bit stands for several pairs.
        let both = |pair: &UnionPair| {
            let nodes = two.host_nodes(pair.two);
            pair.is_active && nodes.contains(&c.node) && nodes.contains(&d.node)
        };
        if common == bit(usize::MAX) { pairs.iter().any(both) } else { common != 0 }
    }

    /// Df of one node with respect to each.
    pub fn force_row(&self, row: usize) -> &[NodeBlock] {
        let columns = self.columns();
        self.forces.get(row * columns..(row + 1) * columns).unwrap_or_default()
    }

    /// Df of one node with respect to another.
    fn force(&self, row: usize, column: usize) -> Mat3 {
        matrix(&self.forces[row * self.columns() + column])
    }

    /// Dg_A with respect to a node.
    fn gap(&self, a: usize, column: usize) -> Mat3 {
        matrix(&self.gaps[a * self.columns() + column])
    }

    /// Adds to Dg_A.
    pub fn add_gap(&mut self, a: usize, column: usize, block: &Mat3) {
        let columns = self.columns();
        let to = &mut self.gaps[a * columns + column];
        (0..9).for_each(|ij| to[ij % 3][ij / 3] += block[(ij / 3, ij % 3)]);
    }

    /// Adds the weights of a pair whose mortar nodes have these columns: those that act now, those of now as they were
    /// integrated, those of t_n.
    pub fn add_weights(&mut self, two: &[Option<usize>], weights: [Option<&ParentWeights>; 3]) {
        let columns = self.columns();
        for (to, n) in [&mut self.now, &mut self.integrated, &mut self.previous].into_iter().zip(weights) {
            let Some(n) = n else { continue };
            for a in 0..self.multipliers {
                let row = &mut to[a * columns..][..columns];
                (0..self.own).for_each(|b| row[b] += n.ab[a][b]);
                for (c, column) in two.iter().enumerate() {
                    if let Some(column) = *column {
                        row[column] -= n.ac[a][c];
                    }
                }
            }
        }
    }

    /// Adds what a pair of parts has, by the columns of its slots, of the mortar facet's nodes, and by the multipliers of its
    /// rows.
    pub fn add_motion(
        &mut self,
        d: &SubMotion,
        slots: &[Option<usize>; 2 * MORTAR],
        two: &[Option<usize>],
        rows: &[usize],
    ) {
        let columns = self.columns();
        for (k, column) in slots.iter().enumerate() {
            let Some(column) = *column else { continue };
            (0..self.own).for_each(|b| add(&mut self.forces[b * columns + column], &d.one[k], b));
            for (c, row) in two.iter().enumerate() {
                if let Some(row) = *row {
                    add(&mut self.forces[row * columns + column], &d.two[k], c);
                }
            }
            for (a, &row) in rows.iter().enumerate() {
                add(&mut self.gaps[row * columns + column], &d.gap[k], a);
            }
        }
    }

    /// Takes Dg_A by the frame of an analytic surface, whose points are the mortar nodes.
    pub fn put_frame(&mut self, gaps: &FrameGaps) {
        let (own, columns) = (self.own, self.columns());
        for (a, of) in gaps.iter().enumerate().take(self.multipliers) {
            (own..columns).zip(of).for_each(|(column, of)| set(&mut self.gaps[a * columns + column], of));
        }
    }

    /// Begins with what offsets of the nodes add to the gaps.
    pub fn begin_offsets(&mut self) -> Result<()> {
        memory::refill(&mut self.offsets, [0.0; 3], self.gaps.len())
    }

    /// Adds what a pair of parts has of it: in the first component of its gaps stand offsets in place of positions.
    pub fn add_offsets(&mut self, (d, sign): (&SubMotion, f64), slots: &[Option<usize>; 2 * MORTAR], rows: &[usize]) {
        let columns = self.columns();
        for (k, column) in slots.iter().enumerate() {
            let Some(column) = *column else { continue };
            for (a, &row) in rows.iter().enumerate() {
                let to = &mut self.offsets[row * columns + column];
                (0..3).for_each(|j| to[j] += sign * d.gap[k][j][a][0]);
            }
        }
    }

    /// What the offsets add counts along these normals. `dual`: the facet as [`ParentTable::make_dual`] has it, with eta_A of the
    /// offsets (docs/formulation 15.2).
    pub fn put_offsets(
        &mut self,
        along: ([Vec3; MAX_PARENT_NODES], bool),
        dual: Option<(&DualParent, &[f64; MAX_CORNERS])>,
    ) {
        self.along = along;
        let Some((d, eta)) = dual else { return };
        let (columns, m, basis, a_ab) = (self.columns(), self.multipliers, d.basis, d.basis.coefficients());
        for column in 0..columns {
            let old: [Vec3; MAX_CORNERS] =
                std::array::from_fn(
                    |b| {
                        if b < m { Vec3::from(self.offsets[b * columns + column]) } else { Vec3::zeros() }
                    },
                );
            for a in 0..m {
                let solved: Vec3 = (0..m).map(|b| old[b] * (a_ab[a][b] * basis.coverage.fade)).sum(); // phi m_A m^-1
                self.offsets[a * columns + column] = (solved + self.faded_area(d, a, column) * eta[a]).into();
            }
        }
    }

    /// Makes of D m_A those of phi m_A, after all else.
    pub fn fade_areas(&mut self, d: &DualParent) {
        let (columns, m) = (self.columns(), self.multipliers);
        for column in 0..columns {
            let areas: [Vec3; MAX_CORNERS] =
                std::array::from_fn(|a| if a < m { self.faded_area(d, a, column) } else { Vec3::zeros() });
            for (a, area) in areas.iter().enumerate().take(m) {
                (0..3).for_each(|j| self.gaps[a * columns + column][j][3] = area[j]);
            }
        }
    }

    /// D(phi m_A) with respect to a node.
    fn faded_area(&self, d: &DualParent, a: usize, column: usize) -> Vec3 {
        let (basis, columns) = (d.basis, self.columns());
        let dm = |a: usize| {
            let block = &self.gaps[a * columns + column];
            Vec3::new(block[0][3], block[1][3], block[2][3])
        };
        let whole = if column < self.own { d.area[column] } else { Vec3::zeros() };
        let all: Vec3 = (0..self.multipliers).map(dm).sum();
        let dphi = (all - whole * basis.coverage.share) * (basis.coverage.slope / basis.area);
        dphi * basis.areas[a] + dm(a) * basis.coverage.fade
    }

    /// Adds what the nodes' own motion does to the gaps.
    pub fn carry(&mut self) {
        for (gap, n) in self.gaps.iter_mut().zip(&self.integrated) {
            (0..3).for_each(|i| gap[i][i] += n);
        }
    }

    /// Makes of sums with the field q and lowered nodes those of dual gaps and forces (docs/formulation 10.4, of vectors).
    pub fn make_dual(&mut self, d: &DualParent) {
        let (columns, m, basis, c) = (self.columns(), self.multipliers, d.basis, corner_shares(d.parent));
        let (phi, slope, inverse) = (basis.coverage.fade, basis.coverage.slope, basis.coefficients());
        // (m^-1)_AB = a_AB / m_A.
        let inverse = |a: usize, b: usize| inverse[a][b] / basis.areas[a];
        for column in 0..columns {
            let dm = |table: &ParentTable, a: usize| {
                let block = &table.gaps[a * columns + column];
                Vec3::new(block[0][3], block[1][3], block[2][3])
            };
            let whole = if column < self.own { d.area[column] } else { Vec3::zeros() };
            let all: Vec3 = (0..m).map(|a| dm(self, a)).sum();
            let dphi = (all - whole * basis.coverage.share) * (slope / basis.area);
            // p_B Dm_B - (Dm q)_B.
            let mut r = [Mat3::zeros(); MAX_CORNERS];
            for (b, r) in r.iter_mut().enumerate().take(m) {
                let dmq: Mat3 =
                    (0..self.own).filter(|k| c[b][*k] != 0.0).map(|k| self.force(k, column) * c[b][k]).sum();
                *r = d.tractions[b] * dm(self, b).transpose() - dmq;
            }
            // D(phi q_A), and with it the forces.
            let solved = |r: &[Mat3; MAX_CORNERS], a: usize| (0..m).map(|b| r[b] * inverse(a, b)).sum::<Mat3>();
            let change: [Mat3; MAX_CORNERS] = std::array::from_fn(|a| match a < m {
                true => solved(&r, a) * phi + d.field[a] * dphi.transpose(),
                false => Mat3::zeros(),
            });
            for row in 0..columns {
                let mut force = self.force(row, column) * phi;
                (0..m).for_each(|a| force += change[a] * self.integrated[a * columns + row]);
                set(&mut self.forces[row * columns + column], &force);
            }
            let old: [Mat3; MAX_CORNERS] =
                std::array::from_fn(|b| if b < m { self.gap(b, column) } else { Mat3::zeros() });
            for a in 0..m {
                let area = dphi * basis.areas[a] + dm(self, a) * phi;
                let gap = solved(&old, a) * (phi * basis.areas[a]) + d.heights[a] * area.transpose();
                set(&mut self.gaps[a * columns + column], &gap);
            }
        }
    }
}
