//! Derivatives of all weights of a facet of the host with its active pairs (docs/formulation 17.2). Forces ask for them
//! contracted with tractions; heat and derivatives by positions of t_n contract them with other things, and take them as they are: the forces of tractions that are
//! 1 at one multiplier, as the tangent has them.

use crate::dual::{DualBasis, corner_shares};
use crate::element::NodeTangent;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::extent::Extent;
use crate::interface::data::options::{Options, Tangent};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::interface::stages::respond::Responses;
use crate::interface::tangent::blocks::{Room, of_pairs};
use crate::interface::tangent::derivatives::PairDerivatives;
use crate::interface::tangent::emission::{Blocks, Directions, Emitter, MortarBlock, Place, Span, Weights};
use crate::interface::tangent::frame::FacetPair;
use crate::interface::tangent::parents::{self, ParentRoom};
use crate::interface::tangent::task::{Numbers, Task};
use crate::interface::tangent::union::{Pairs, UnionPair, Walk};
use crate::memory::{self, Store};
use crate::mortar::FrameMotion;
use crate::shape::{MAX_CORNERS, MAX_NODES, MAX_PARENT_NODES};

/// The weights of one facet, and how they change.
#[derive(Debug, Default)]
pub struct FacetWeights {
    /// Own nodes, then mortar ones, each once, as indices over both surfaces.
    pub nodes: Vec<usize>,
    /// Multipliers, at the first own nodes.
    pub multipliers: usize,
    /// `[(A * nodes + k) * nodes + c]`: d n_Ak / d x_c, n_Ak being n_AB or - n_AC `[L]`.
    pub slopes: Vec<Vec3>,
}

impl FacetWeights {
    fn begin(&mut self, own: &[usize], multipliers: usize, mortar: impl Iterator<Item = usize>) -> Result<()> {
        self.nodes.clear();
        self.nodes.store_all(own.iter().copied())?;
        for node in mortar {
            if !self.nodes.contains(&node) {
                self.nodes.store(node)?;
            }
        }
        self.multipliers = multipliers;
        let n = self.nodes.len();
        memory::refill(&mut self.slopes, Vec3::zeros(), multipliers * n * n)
    }

    fn slope(&mut self, a: usize, k: usize, c: usize) -> &mut Vec3 {
        let n = self.nodes.len();
        &mut self.slopes[(a * n + k) * n + c]
    }
}

/// Takes blocks of forces at tractions whose components are 1 at one multiplier each, from this one on: what that multiplier's
/// weights have.
struct Taker<'a> {
    to: &'a mut FacetWeights,
    sides: [&'a Surface; 2],
    /// The facet, its first multiplier and so many.
    facet: usize,
    first: usize,
    count: usize,
}

impl Taker<'_> {
    /// The places of a span's nodes.
    fn places(&self, span: Span) -> ([usize; MAX_NODES], usize) {
        let nodes = match span {
            Span::Own => &self.sides[0].facets[self.facet],
            Span::Mortar(j) => &self.sides[1].facets[j],
            Span::Group(ref nodes) => nodes,
        };
        let (mut places, n1) = ([0; MAX_NODES], self.sides[0].len());
        for (k, place) in places.iter_mut().enumerate().take(nodes.len) {
            *place = if span == Span::Own { k } else { self.place(n1 + nodes.nodes[k]) };
        }
        (places, nodes.len)
    }

    fn place(&self, node: usize) -> usize {
        self.to.nodes.iter().position(|known| *known == node).unwrap_or(0)
    }

    /// Adds d force of one node / d x of another, `[j][i]`.
    fn add(&mut self, row: usize, column: usize, block: impl Fn(usize, usize) -> f64) {
        for i in 0..self.count {
            *self.to.slope(self.first + i, row, column) += Vec3::from_fn(|j, _| block(j, i));
        }
    }
}

impl<const N: usize> Blocks<N> for Taker<'_> {
    fn forces(&mut self, rows: Span, columns: Span, values: &[[[[f64; MAX_NODES]; 3]; 3]]) {
        let ((rows, n_rows), (columns, n_columns)) = (self.places(rows), self.places(columns));
        for (k, b) in (0..n_columns).flat_map(|k| (0..n_rows).map(move |b| (k, b))) {
            self.add(rows[b], columns[k], |j, i| values[k][j][i][b]);
        }
    }

    fn mortar(&mut self, block: &MortarBlock) {
        let n1 = self.sides[0].len();
        for (c, &row) in block.rows.iter().enumerate() {
            let row = self.place(n1 + row);
            (0..block.own).for_each(|k| self.add(row, k, |j, i| block.values[k][j][i][c]));
            for (k, &node) in block.columns.iter().enumerate() {
                self.add(row, self.place(n1 + node), |j, i| block.values[MAX_NODES + k][j][i][c]);
            }
        }
    }

    fn begin(&mut self, _f: usize) {}
    fn multipliers(&mut self, _rows: Span, _n: &[[f64; MAX_NODES]; MAX_CORNERS], _nu: &[Vec3; MAX_CORNERS]) {}
    fn rows(&mut self, _columns: Span, _values: &[[[[f64; MAX_CORNERS]; N]; 3]]) {}
    fn node(&mut self, _row: Place, _column: Place, _values: &[f64]) {}
    fn multiplier_row(&mut self, _row: Place, _columns: &[(usize, Place)], _n: &Weights, _nu: &Directions) {}
    fn diagonal(&mut self, _a: usize, _values: &[f64]) {}
}

/// Gives those of every facet with active pairs to `take`.
pub fn each_facet<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    (active, responses): (&Active, &Responses<N>),
    take: &mut dyn FnMut(&FacetWeights) -> Result<()>,
) -> Result<()> {
    let mut weights = FacetWeights::default();
    if given.setup.mortar.analytic.is_some() {
        return each_over_surface(given.setup.surfaces(), &given.setup.options, active, &mut weights, take);
    }
    if given.setup.has_parents() {
        return each_parent((given, normals), (active, responses), &mut weights, take);
    }
    let ((one, two), rule) = (given.setup.surfaces(), given.setup.options.rule);
    // Heat has rows and columns of the mortar side where forces have none, too.
    let motion = PairDerivatives { surface: None, tangent: Tangent::Exact, rule };
    let mut nodes = memory::filled(NodeTangent::<N>::default(), one.len())?;
    let mut room = Room::default();
    for pairs in active.pairs.chunk_by(|p, q| p.one == q.one) {
        let (facet, own) = (pairs[0].one, one.facets[pairs[0].one].as_slice());
        let mortar = pairs.iter().flat_map(|pair| two.facets[pair.two].as_slice().iter().map(|c| one.len() + c));
        weights.begin(own, own.len(), mortar)?;
        for first in (0..own.len()).step_by(3) {
            let count = (own.len() - first).min(3);
            (0..count).for_each(|i| nodes[own[first + i]].traction[i] = 1.0);
            let numbers = Numbers::of_weights(active, responses, &nodes, motion);
            let pairs = Pairs::Union([&active.pairs, &[]]);
            let task = Task { given, normals, pairs, extent: Extent::Part, moves: true, numbers: Some(&numbers) };
            let mut taker = Taker { to: &mut weights, sides: [one, two], facet, first, count };
            let mut emitter = Emitter { given, normals, taker: &mut taker, constraints: None };
            of_pairs(task, facet..facet + 1, &mut room, None, &mut emitter)?;
            (0..count).for_each(|i| nodes[own[first + i]].traction = Vec3::zeros());
        }
        take(&weights)?;
    }
    Ok(())
}

/// Of quadratic facets and lines: forces of tractions that are 1 at one multiplier, two multipliers at a time.
#[inline(never)] // large
fn each_parent<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    (active, responses): (&Active, &Responses<N>),
    to: &mut FacetWeights,
    take: &mut dyn FnMut(&FacetWeights) -> Result<()>,
) -> Result<()> {
    let one = &given.setup.nonmortar;
    let mut nodes = memory::filled(NodeTangent::<N>::default(), one.len())?;
    let (mut room, mut of_facet): (_, Vec<UnionPair>) = (ParentRoom::default(), Vec::new());
    let all = Pairs::Parents([&active.parents, &[]]);
    let options = &given.setup.options;
    let motion = PairDerivatives { surface: None, tangent: Tangent::Exact, rule: options.rule };
    let mut walk = Walk::through(all, 0..usize::MAX);
    while let Some(f) = walk.next(&mut of_facet)? {
        let own = one.host_nodes(f);
        let multipliers = one.multipliers(f);
        for a in (0..multipliers).step_by(2) {
            let here = (multipliers - a).min(2);
            for (i, a) in (a..a + here).enumerate() {
                nodes[own[a]].traction[i] = 1.0;
            }
            let numbers = Numbers::of_weights(active, responses, &nodes, motion);
            let (pairs, numbers) = (all, Some(&numbers));
            let task = Task { given, normals, pairs, extent: Extent::Part, moves: true, numbers };
            parents::fill(task, &of_facet, &mut room)?;
            let table = room.table();
            if a == 0 {
                to.begin(own, multipliers, table.mortar.iter().map(|known| one.len() + known.node))?;
            }
            for (i, a) in (a..a + here).enumerate() {
                nodes[own[a]].traction = Vec3::zeros();
                for k in 0..to.nodes.len() {
                    for (c, block) in table.force_row(k).iter().enumerate() {
                        *to.slope(a, k, c) = Vec3::from_fn(|j, _| block[j][i]);
                    }
                }
            }
        }
        take(to)?;
    }
    Ok(())
}

/// Of facets against an analytic surface, whose weights are of the points of its frame.
fn each_over_surface(
    surfaces: (&Surface, &Surface),
    options: &Options,
    active: &Active,
    to: &mut FacetWeights,
    take: &mut dyn FnMut(&FacetWeights) -> Result<()>,
) -> Result<()> {
    let (one, two) = surfaces;
    let (surface, points) = (two.analytic_at(&active.x2)?, two.len());
    let all = match one.parents.is_some() {
        true => Pairs::Parents([&active.parents, &[]]),
        false => Pairs::Union([&active.pairs, &[]]),
    };
    let (mut walk, mut of_facet) = (Walk::through(all, 0..usize::MAX), Vec::new());
    let mut motion: Vec<FrameMotion> = Vec::new(); // large
    while let Some(f) = walk.next(&mut of_facet)? {
        let (own, multipliers) = (one.host_nodes(f), one.multipliers(f));
        motion.clear();
        motion.store(FrameMotion::default())?;
        let motion = &mut motion[0];
        let at = FacetPair { one, basis: options.basis, active, pair: &of_facet[0] };
        at.add_motion((&surface, options.rule), motion)?;
        to.begin(own, multipliers, (0..points).map(|c| one.len() + two.facets[0].nodes[c]))?;
        let n = own.len();
        for a in 0..multipliers {
            for c in 0..n {
                (0..n).for_each(|b| *to.slope(a, b, c) = motion.own[a][b][c]);
                (0..points).for_each(|k| *to.slope(a, n + k, c) = -motion.by_nodes[a][k][c]);
            }
            for (k, d) in (0..points).flat_map(|k| (0..points).map(move |d| (k, d))) {
                *to.slope(a, n + k, n + d) = -motion.by_frame[a][k][d];
            }
        }
        if let Some(basis) = at.basis()? {
            make_dual((&basis, at), motion, to);
        }
        take(to)?;
    }
    Ok(())
}

/// Makes of the derivatives of weights those of dual ones, n^d_A = m_A (m^-1 n)_A. The facet is covered wholly.
fn make_dual((basis, at): (&DualBasis, FacetPair), motion: &FrameMotion, to: &mut FacetWeights) {
    let (coefficients, shares, m, n) =
        (basis.coefficients(), corner_shares(at.parent()), to.multipliers, to.nodes.len());
    let inverse = |a: usize, b: usize| coefficients[a][b] / basis.areas[a];
    // The frame changes no area.
    let mass = |a: usize, b: usize, c: usize| {
        if c < MAX_PARENT_NODES { motion.mass((a, b, c), &shares) } else { Vec3::zeros() }
    };
    for (k, c) in (0..n).flat_map(|k| (0..n).map(move |c| (k, c))) {
        let solved = |a: usize| (0..m).map(|b| inverse(a, b) * at.integrated(b, k)).sum::<f64>();
        let mut rest = [Vec3::zeros(); MAX_CORNERS];
        for (b, rest) in rest.iter_mut().enumerate().take(m) {
            *rest = *to.slope(b, k, c) - (0..m).map(|e| mass(b, e, c) * solved(e)).sum::<Vec3>();
        }
        for a in 0..m {
            let area: Vec3 = (0..m).map(|e| mass(a, e, c)).sum();
            let of: Vec3 = (0..m).map(|b| rest[b] * coefficients[a][b]).sum();
            *to.slope(a, k, c) = of + area * solved(a);
        }
    }
}
