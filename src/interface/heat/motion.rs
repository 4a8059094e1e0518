//! Derivatives of all weights of a facet of the host with its active pairs (docs/formulation.md 17.2). Forces ask for them
//! contracted with tractions; heat has four things to contract them with, and takes them as they are.

use crate::dual::FullDerivatives;
use crate::element::NodeTangent;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::options::{MultiplierBasis, Tangent};
use crate::interface::pairing::given::Given;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::stages::facet::dual_basis;
use crate::interface::tangent::derivatives::PairDerivatives;
use crate::interface::tangent::parents::{self, ParentNumbers, ParentRoom};
use crate::interface::tangent::union::{Pairs, UnionPair, Walk};
use crate::memory::{self, Store};
use crate::mortar::{MORTAR, WeightDerivatives};
use crate::shape::{MAX_CORNERS, MAX_NODES};

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

/// Gives those of every facet with active pairs to `take`.
pub fn each_facet<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    active: &Active,
    take: &mut dyn FnMut(&FacetWeights) -> Result<()>,
) -> Result<()> {
    let mut weights = FacetWeights::default();
    if given.setup.has_parents() {
        return each_parent((given, normals), active, &mut weights, take);
    }
    let (mut overlaps, mut first) = (FacetOverlaps::default(), 0);
    for pairs in active.pairs.chunk_by(|p, q| p.one == q.one) {
        of_facet(given, active, first, pairs.len(), &mut overlaps, &mut weights)?;
        first += pairs.len();
        take(&weights)?;
    }
    Ok(())
}

/// Of the linear facet whose pairs are so many from place `first` on.
#[inline(never)] // compiled once for all kinds of contact: it asks for nothing that N changes
fn of_facet<const N: usize>(
    given: Given<N>,
    active: &Active,
    first: usize,
    count: usize,
    overlaps: &mut FacetOverlaps,
    to: &mut FacetWeights,
) -> Result<()> {
    let ((one, two), rule) = (given.setup.surfaces(), given.setup.options.rule);
    let places = first..first + count;
    let pairs = &active.pairs[first..first + count];
    let own = one.facets[pairs[0].one].as_slice();
    let mortar = pairs.iter().flat_map(|pair| two.facets[pair.two].as_slice().iter().map(|c| one.len() + c));
    to.begin(own, own.len(), mortar)?;
    overlaps.of(given, active, places)?;
    let (m, all) = (to.nodes.len() - own.len(), to.nodes.len());
    let mut d = WeightDerivatives::default();
    if given.setup.options.basis == MultiplierBasis::Standard {
        for (pair, segment) in pairs.iter().zip(&overlaps.segments) {
            d.update(overlaps.frame(), segment, rule);
            let other = two.facets[pair.two].as_slice();
            let columns = columns(to, own.len(), other, one.len());
            for (slot, column) in columns.iter().enumerate() {
                let Some(column) = *column else { continue };
                for a in 0..own.len() {
                    (0..own.len()).for_each(|b| *to.slope(a, b, column) += Vec3::from(d.ab[a][b][slot]));
                    for c in 0..other.len() {
                        let Some(row) = columns[MORTAR + c] else { continue };
                        *to.slope(a, row, column) -= Vec3::from(d.ac[a][c][slot]);
                    }
                }
            }
        }
        return Ok(());
    }
    let integrated = &active.integrated[first..first + count];
    let (_, basis) = dual_basis(one, pairs[0].one, (overlaps.frame(), &overlaps.segments), integrated)?;
    let Some(basis) = basis else { return Ok(()) }; // it has faded out
    let mut sums = memory::filled([0.0; MAX_CORNERS], m)?;
    let place = |to: &FacetWeights, other: &[usize]| {
        let mut places = [0; MAX_NODES];
        let columns = columns(to, own.len(), other, one.len());
        (0..other.len()).for_each(|c| places[c] = columns[MORTAR + c].map_or(0, |k| k - own.len()));
        places
    };
    for (pair, n) in pairs.iter().zip(integrated) {
        let other = two.facets[pair.two].as_slice();
        let places = place(to, other);
        for (c, b) in (0..other.len()).flat_map(|c| (0..own.len()).map(move |b| (c, b))) {
            sums[places[c]][b] += n.ac[b][c];
        }
    }
    let zero = [[0.0; MAX_CORNERS]; 3];
    let mut diagonal = memory::filled(zero, MAX_NODES + m)?;
    let mut off = memory::filled(zero, (MAX_NODES + m) * m)?;
    let mut full = FullDerivatives::new(overlaps.frame(), &basis, &sums, &mut diagonal, &mut off);
    for ((pair, segment), n) in pairs.iter().zip(&overlaps.segments).zip(integrated) {
        d.update(overlaps.frame(), segment, rule);
        let other = two.facets[pair.two].as_slice();
        full.add(n, &d, &place(to, other)[..other.len()]);
    }
    for column in 0..all {
        let from = if column < own.len() { column } else { MAX_NODES + column - own.len() };
        for a in 0..own.len() {
            *to.slope(a, a, column) = Vec3::from_fn(|j, _| diagonal[from][j][a]);
            for c in 0..m {
                *to.slope(a, own.len() + c, column) = Vec3::from_fn(|j, _| -off[from * m + c][j][a]);
            }
        }
    }
    Ok(())
}

/// The column of each slot of a pair.
fn columns(of: &FacetWeights, own: usize, other: &[usize], n1: usize) -> [Option<usize>; 2 * MORTAR] {
    std::array::from_fn(|slot| match slot.checked_sub(MORTAR) {
        None => (slot < own).then_some(slot),
        Some(c) => other.get(c).and_then(|node| of.nodes.iter().position(|known| *known == n1 + node)),
    })
}

/// Of quadratic facets and lines: forces of tractions that are 1 at one multiplier, two multipliers at a time.
fn each_parent<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    active: &Active,
    to: &mut FacetWeights,
    take: &mut dyn FnMut(&FacetWeights) -> Result<()>,
) -> Result<()> {
    let one = &given.setup.nonmortar;
    let mut nodes = memory::filled(NodeTangent::<N>::default(), one.len())?;
    let (mut room, mut of_facet): (_, Vec<UnionPair>) = (ParentRoom::default(), Vec::new());
    let all = Pairs::Parents([&active.parents, &[]]);
    let options = &given.setup.options;
    let opposite = given.setup.effects.opposite;
    let motion = PairDerivatives { opposite, surface: None, tangent: Tangent::Exact, rule: options.rule };
    let mut walk = Walk::through(all, 0..usize::MAX);
    while let Some(f) = walk.next(&mut of_facet)? {
        let own = one.host_nodes(f);
        let multipliers = one.multipliers(f);
        for a in (0..multipliers).step_by(2) {
            let here = (multipliers - a).min(2);
            for (i, a) in (a..a + here).enumerate() {
                nodes[own[a]].traction[i] = 1.0;
            }
            let numbers = ParentNumbers { x1: &active.x1, nodes: &nodes, carried: &[], active: Some(active), motion };
            parents::fill((given, normals), (f, all, &of_facet), (Some(&numbers), true), &mut room)?;
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
