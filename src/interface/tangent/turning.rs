//! What current normals add to the tangent (docs/formulation 11.2). nu_A depends on the corners of all facets around A, also
//! of those without pairs. With Dnu_A = (dnu/ds)_A sum Dm over these corners:
//!
//! - rows of A: (dc/dnu) Dnu_A;
//! - forces of A's traction t, which is p or, with one multiplier in the multiplier form, lambda_N nu: (dt/dnu) Dnu_A, at every
//!   node that t acts on;
//! - where A is carried, in the rows of its carriers, what of the gap that they take over turns with nu_A: with one multiplier
//!   w (nu_B . dc_B/dg) g_A . Dnu_A, for it runs along nu_A; else its offset, w (dc_B/dg) T_AB o_A Dnu_A.

use super::augmented::NodeCouplings;
use super::emission::{Emitter, NodeBlock, Place, Span, put_in_order};
use super::read::square;
use super::union::{Pairs, UnionPair, Walk};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::extent::Extent;
use crate::interface::data::host_facets::NormalDerivatives;
use crate::interface::data::multiplier::direction;
use crate::interface::data::offsets;
use crate::interface::data::options::Form;
use crate::interface::data::pairs::Weighted;
use crate::interface::pairing::given::Given;
use crate::interface::pairing::weak::Carrier;
use crate::interface::stages::carried::{carriers_sums, transfer};
use crate::interface::stages::node::node;
use crate::interface::stages::respond::Responses;
use crate::interface::stages::sums::{NodeSums, each_offset, in_previous_gaps};
use crate::memory::{self, Store};
use crate::mortar::MORTAR;
use crate::normal::{corner_normal_derivatives, nodal_normal_derivative};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};
use nalgebra::SMatrix;
use nalgebra::SVector;

/// Derivatives with respect to the normal of a node.
#[derive(Clone, Copy, Debug)]
pub struct NodeTurn<const N: usize> {
    /// dnu/ds.
    normal: Mat3,
    /// dc/ds times the row scale.
    row: SMatrix<f64, N, 3>,
    /// d traction of the forces / dnu.
    traction: Mat3,
    /// dp / dnu; of a carried node, whose carriers have it, none.
    projected: Mat3,
    /// g, as a carried node hands it on.
    gap: Vec3,
    /// o of its offsets likewise.
    offset: f64,
}

/// Which normals turn, and with what.
pub struct Turning<'a, 'b> {
    /// The positions.
    pub x1: &'a [Vec3],
    /// Per node the sum of the corner normals around it there.
    pub corner_sums: &'b [Vec3],
    /// Whether a node's normal is that of these positions.
    pub turns: &'b dyn Fn(usize) -> bool,
}

/// Derivatives with respect to the normals of the nodes, at some positions.
pub struct Turns<'a, const N: usize> {
    x1: &'a [Vec3],
    nodes: &'a [NodeTurn<N>],
}

impl<'a, const N: usize> Turns<'a, N> {
    /// At the sums and the answers of x1, in `nodes`; `scale`: the factor of a node's rows. `None`: the normals are those of t_n.
    pub fn at(
        given: Given<N>,
        (x1, lambda): (&'a [Vec3], &[SVector<f64, N>]),
        of: (Weighted, &[NodeSums], &Responses<N>),
        normals: &[Vec3],
        scale: &dyn Fn(usize) -> f64,
        nodes: &'a mut Vec<NodeTurn<N>>,
    ) -> Result<Option<Turns<'a, N>>> {
        let Some(now) = &given.step.now else { return Ok(None) };
        let turning = Turning { x1, corner_sums: &now.sums, turns: &|a| !given.step.pairing.keeps_normal[a] };
        Turns::of(given, turning, lambda, of, normals, scale, nodes).map(Some)
    }

    /// The same by normals of other positions, of the nodes that have them.
    #[inline(never)] // two callers, one of them seldom
    pub fn of(
        given: Given<N>,
        turning: Turning<'a, '_>,
        lambda: &[SVector<f64, N>],
        (pairs, sums, responses): (Weighted, &[NodeSums], &Responses<N>),
        normals: &[Vec3],
        scale: &dyn Fn(usize) -> f64,
        nodes: &'a mut Vec<NodeTurn<N>>,
    ) -> Result<Turns<'a, N>> {
        let (setup, carried) = (given.setup, &responses.carried);
        let shared = if carried.contains(&true) { carriers_sums(given, sums, carried, normals)? } else { Vec::new() };
        let augmented = setup.options.form == Form::Augmented;
        let mut offsets = memory::filled(0.0, if shared.is_empty() { 0 } else { lambda.len() })?;
        if !shared.is_empty() && offsets::are_there(setup.surfaces()) {
            each_offset(setup.surfaces(), pairs, &mut |a, offset| offsets[a] += offset);
        }
        let turn = |a: usize| -> Result<NodeTurn<N>> {
            let sum = shared.binary_search_by_key(&a, |(b, _)| *b).map_or(&sums[a], |at| &shared[at].1);
            let is_carried = carried.get(a).is_some_and(|c| *c);
            let fixed = !(turning.turns)(a);
            let turn = match is_carried {
                true => Default::default(),
                false => {
                    let node = node(given, a, lambda[a], sum)?;
                    responses.own.turn(given, a, node)
                }
            };
            let traction = match (augmented, N) {
                (true, 1) if is_carried => Mat3::identity() * normals[a].dot(&responses.nodes[a].traction),
                (true, _) => turn.dp_dnormal,
                (false, 1) => Mat3::identity() * lambda[a][0],
                (false, _) => Mat3::zeros(),
            };
            let normal = if fixed {
                Mat3::zeros()
            } else {
                nodal_normal_derivative(turning.corner_sums[a], &setup.nodes.free[a])
            };
            Ok(NodeTurn {
                normal,
                row: turn.drow_dnormal * normal * if setup.nodes.is_own(a) { scale(a) } else { 0.0 },
                traction,
                projected: turn.dp_dnormal,
                gap: if is_carried { sums[a].gap_now } else { Vec3::zeros() },
                offset: if is_carried { offsets[a] } else { 0.0 },
            })
        };
        nodes.clear();
        (0..lambda.len()).try_for_each(|a| nodes.store(turn(a)?))?;
        Ok(Turns { x1: turning.x1, nodes })
    }

    /// dp_A / dnu_A, as the law has it.
    pub fn projected(&self, a: usize) -> &Mat3 {
        &self.nodes[a].projected
    }

    /// d (gap that B takes over of A, which it carries with weight w) / dnu_A.
    pub fn taken_over(&self, given: Given<N>, normals: &[Vec3], (a, (b, w)): (usize, Carrier)) -> Mat3 {
        let node = &self.nodes[a];
        match N {
            1 => normals[b] * node.gap.transpose() * w,
            _ => transfer(given, a, normals[a], normals[b]) * (w * node.offset),
        }
    }

    /// Dnu of the k-th node of a facet of the host, by those of its nodes that it depends on.
    pub fn of_normal(&self, given: Given<N>, (f, k): (usize, usize)) -> NormalDerivatives {
        let one = &given.setup.nonmortar;
        one.normal_derivatives((f, k), self.x1, &self.nodes[one.host_nodes(f)[k]].normal)
    }

    /// Of the row of that node likewise, in the first rows.
    pub fn of_row(&self, given: Given<N>, (f, k): (usize, usize)) -> NormalDerivatives {
        let one = &given.setup.nonmortar;
        one.normal_derivatives((f, k), self.x1, &square(&self.nodes[one.host_nodes(f)[k]].row))
    }

    /// Adds to the row of the k-th node of a facet of the host, `[column][j][i]`, its own nodes first.
    pub fn add_row(&self, given: Given<N>, (f, k): (usize, usize), row: &mut [NodeBlock]) {
        self.of_row(given, (f, k))
            .as_slice()
            .iter()
            .for_each(|(column, d)| (0..9).for_each(|ij| row[*column][ij / 3][ij % 3] += d[(ij % 3, ij / 3)]));
    }

    /// Adds to the rows of a facet's nodes, `[k][j][n][A]`.
    pub fn add_rows(&self, given: Given<N>, f: usize, rows: &mut [[[[f64; MAX_CORNERS]; N]; 3]]) {
        let one = &given.setup.nonmortar;
        let facet = one.facet(f, self.x1);
        for (k, &a) in one.facets[f].as_slice().iter().enumerate() {
            for (corner, row) in corner_normal_derivatives(&facet, k, &self.nodes[a].row) {
                for (j, n) in (0..3).flat_map(|j| (0..N).map(move |n| (j, n))) {
                    rows[corner][j][n][k] += row[(n, j)];
                }
            }
        }
    }
}

/// What a facet's corners add to tractions, and to the rows of those who carry its nodes. `drow`: of every node by its gaps of now
/// and of t_n, times the row scale; `turns`: `None` for the pattern alone.
pub fn facet<const N: usize>(
    f: usize,
    (turns, drow): (Option<&Turns<N>>, impl Fn(usize) -> [SMatrix<f64, N, 3>; 2]),
    mut couplings: Option<&mut [NodeCouplings]>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let (given, normals, one) = (emitter.given, emitter.normals, &emitter.given.setup.nonmortar);
    let nodes = one.host_nodes(f);
    for (k, &a) in nodes.iter().enumerate().take(one.multipliers(f)) {
        let dnu = match turns {
            Some(turns) => turns.of_normal(given, (f, k)),
            None => one.normal_columns((f, k)),
        };
        let traction = turns.map_or(Mat3::zeros(), |turns| turns.nodes[a].traction);
        if let Some(couplings) = couplings.as_deref_mut() {
            add(&mut couplings[a], nodes, &dnu, &traction)?;
        }
        let carriers = if N == 1 || offsets::are_there(given.setup.surfaces()) { given.carriers_of(a) } else { &[] };
        for &(b, w) in carriers {
            let along = turns.map_or(Mat3::zeros(), |turns| turns.taken_over(given, normals, (a, (b, w))));
            let [now, previous] = drow(b);
            let by_gap = if N > 1 && in_previous_gaps(given) { now + previous } else { now };
            let mut rows = [[[0.0; N]; 3]; MAX_PARENT_NODES];
            for (corner, dnu) in dnu.as_slice() {
                let row = by_gap * along * dnu;
                for (j, n) in (0..3).flat_map(|j| (0..N).map(move |n| (j, n))) {
                    rows[*corner][j][n] += row[(n, j)];
                }
            }
            nodes.iter().zip(&rows).for_each(|(&node, row)| emitter.node_row(b, node, row));
            if let (Some(couplings), Form::Augmented) = (couplings.as_deref_mut(), given.setup.options.form) {
                let scale = given.augmentation(b) / given.row_scale(b);
                let traction = direction::<N>(normals[b]) * (by_gap * along) * scale;
                add(&mut couplings[b], nodes, &dnu, &traction)?;
            }
        }
    }
    Ok(())
}

fn add(couplings: &mut NodeCouplings, nodes: &[usize], dnu: &NormalDerivatives, traction: &Mat3) -> Result<()> {
    dnu.as_slice().iter().try_for_each(|(node, dnu)| couplings.add_traction(nodes[*node], traction * dnu))
}

/// What lone facets are found in.
#[derive(Debug, Default)]
pub struct LoneRoom {
    paired: Vec<bool>,
    covered: Vec<bool>,
    of_facet: Vec<UnionPair>,
    /// The facets that were found last.
    pub lone: Vec<usize>,
}

/// The facets without pairs around nodes that a pair covers: their corners enter through the normals alone. With sums of
/// several handles a pair of another one may cover any node, and its row is in the tangent of who owns it.
pub fn lone_facets<const N: usize>(
    given: Given<N>,
    (pairs, extent): (Pairs, Extent),
    LoneRoom { paired, covered, of_facet, lone }: &mut LoneRoom,
) -> Result<()> {
    let one = &given.setup.nonmortar;
    memory::refill(paired, false, one.host_facets())?;
    memory::refill(covered, false, one.len())?;
    if extent == Extent::Part {
        (0..covered.len()).for_each(|a| covered[a] = given.setup.nodes.is_own(a));
    }
    let mut walk = Walk::through(pairs, 0..usize::MAX);
    while let Some(f) = walk.next(of_facet)? {
        paired[f] = true;
        one.host_nodes(f).iter().for_each(|&a| covered[a] = true);
    }
    let is_lone = |f: &usize| !paired[*f] && one.host_nodes(*f).iter().any(|&a| covered[a]);
    lone.clear();
    (0..paired.len()).filter(is_lone).try_for_each(|f| lone.store(f))
}

/// The rows of such a facet.
pub fn lone_rows<const N: usize>(f: usize, turns: Option<&Turns<N>>, emitter: &mut Emitter<N>) {
    let one = &emitter.given.setup.nonmortar;
    if one.parents.is_some() {
        return lone_parent(f, turns, emitter);
    }
    let mut rows = [[[[0.0; MAX_CORNERS]; N]; 3]; MORTAR];
    if let Some(turns) = turns {
        turns.add_rows(emitter.given, f, &mut rows);
    }
    emitter.begin(f);
    emitter.facet_rows(f, Span::Own, &rows);
}

fn lone_parent<const N: usize>(f: usize, turns: Option<&Turns<N>>, emitter: &mut Emitter<N>) {
    let (given, one) = (emitter.given, &emitter.given.setup.nonmortar);
    let nodes = one.host_nodes(f);
    let mut columns = [(0, Place::Displacement(0)); MAX_PARENT_NODES];
    columns.iter_mut().zip(nodes).enumerate().for_each(|(k, (to, &node))| *to = (k, Place::Displacement(node)));
    let columns = &mut columns[..nodes.len()];
    put_in_order(columns, &|place| emitter.taker.order(place));
    for (k, &a) in nodes.iter().enumerate().take(one.multipliers(f)) {
        let mut row = [NodeBlock::default(); MAX_PARENT_NODES];
        if let Some(turns) = turns {
            turns.add_row(given, (f, k), &mut row);
        }
        emitter.node_rows(a, columns, &mut row);
    }
}
