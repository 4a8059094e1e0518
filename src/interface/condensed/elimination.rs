//! The elimination of multipliers by the rows of their own nodes (docs/formulation 10.7). With R_u the forces' rows, J_uu their
//! derivative at fixed multipliers and c_A the multiplier rows, the condensed system is
//!
//!   residual L R_u + b,   matrix L J_uu + G,
//!
//! where L and b are here and G is s_A Dc_A / Dx (`Part::Constraints` of the tangent). A node B with a multiplier of its own
//! has D_B, its covered area, and T_B, the directions of its multiplier: the projector on its free directions, or nu_B. A
//! carried node has its T_A too.
//!
//! - rows of B: L_BB = W_B = I - T_B (I + r_B dc_B/dlambda_B) T_B^T,  b_B = s_B T_B c_B,  s_B = r_B D_B;
//! - rows of a mortar node C: L_CB = P_BC = (M_BC T_B + sum_A w_AB M_AC T_A) T_B^T / D_B over the nodes A that B carries;
//! - rows of a carried node A: L_AB = -D_A w_AB T_A T_B^T / D_B.
//!
//! Here all have three components: where a node's multiplier has one, T_A is nu_A in the first of three columns, so that
//! this code need not know how many there are.
//!
//! Of quadratic facets R stands for (C R)_B of a node B with a multiplier (`hats.rs`), and the rows of all other non-mortar nodes k act
//! like those of mortar nodes with the other sign: L_kB = -sum_A n_Ak T_A T_B^T / D_B.
//!
//! Every other row stays as it is, and so does an uncovered node's, whose multiplier is 0. In a step from given multipliers s_A
//! is a constant. Where the multipliers are a function of the displacements, c_A Ds_A belongs to the matrix, too
//! (`Piece::Scales`).

use super::hats::Hats;
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::multiplier::direction;
use crate::interface::data::pairs::{PairRecord, ParentRecord, Weighted};
use crate::interface::data::surface::{NO_EQUATION, Surface, node_equations};
use crate::interface::pairing::given::Given;
use crate::interface::pairing::weak::Carrier;
use crate::interface::stages::carried::multiplier_share;
use crate::interface::stages::sums::NodeSums;
use crate::interface::tangent::by_equations::Sink;
use crate::law::{NodeResponse, State};
use crate::memory::{self, Store, Stored};
use nalgebra::{SMatrix, SVector};

/// A block of L - I in the rows of a node that has no multiplier of its own.
#[derive(Clone, Copy, Debug)]
pub struct Transfer {
    /// The row's node over both surfaces, mortar after non-mortar.
    pub row: usize,
    /// The node whose multiplier is eliminated.
    pub own: usize,
    /// L.
    pub block: Mat3,
}

/// What the law says of a node's multiplier row.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// c_A.
    value: Vec3,
    /// dc_A/dlambda_A.
    derivative: Mat3,
    /// dc_A/dg_A of the gap that slip is measured by.
    slip: Mat3,
    state: State,
}

impl Row {
    /// Of the law's answer.
    pub fn of<const N: usize>(response: &NodeResponse<N>) -> Row {
        let NodeResponse { row, drow_dlambda, drow_dprevious, state, .. } = response;
        Row {
            value: widened(row),
            derivative: widened_matrix(drow_dlambda),
            slip: widened_matrix(drow_dprevious),
            state: *state,
        }
    }

    /// The same of a node whose constraint gives way, with what lies between the surfaces: the reduced form leaves its rows as they are.
    pub fn unreduced(self) -> Row {
        Row { state: State::Gap, ..self }
    }

    /// Gap, stick or slip.
    pub fn state(&self) -> State {
        self.state
    }

    /// dc/dg of the gap that slip is measured by.
    pub(super) fn slip(&self) -> &Mat3 {
        &self.slip
    }
}

/// A multiplier as a vector of three components, of which those beyond N are 0.
pub fn widened<const N: usize>(v: &SVector<f64, N>) -> Vec3 {
    Vec3::from_fn(|i, _| if i < N { v[i] } else { 0.0 })
}

fn widened_matrix<const M: usize, const N: usize>(m: &SMatrix<f64, M, N>) -> Mat3 {
    Mat3::from_fn(|i, j| if i < M && j < N { m[(i, j)] } else { 0.0 })
}

/// A node as its elimination sees it.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// nu.
    normal: Vec3,
    /// T.
    directions: Mat3,
    /// Takes its carriers' multipliers to its own.
    share: Mat3,
    /// D [L^2].
    area: f64,
    /// r [F/L^5].
    augmentation: f64,
    /// Whether it has a multiplier of its own here: covered, and not carried.
    own: bool,
    /// Whether it is carried.
    carried: bool,
    /// Whether its multiplier acts here: in another handle it is eliminated there.
    acts: bool,
}

impl Node {
    /// Whether its multiplier is eliminated here.
    fn is_eliminated(&self) -> bool {
        self.own && self.acts
    }
}

/// The elimination at a configuration.
#[derive(Debug)]
pub struct Elimination {
    nodes: Vec<Node>,
    hats: Hats,
    /// Sorted by row, then by node.
    pub transfers: Vec<Transfer>,
}

/// W_B of a covered node from T_B, r_B and dc_B/dlambda_B.
pub fn own_rows(t: &Mat3, r: f64, drow_dlambda: &Mat3) -> Mat3 {
    Mat3::identity() - t * (Mat3::identity() + drow_dlambda * r) * t.transpose()
}

/// A weight on its way into a block: (row, own node, node through which it acts), weight.
type Share = ((usize, usize, usize), f64);

impl Elimination {
    /// At the pairs whose weights act, their sums, and the nodes that are carried there.
    pub fn of<const N: usize>(
        given: Given<N>,
        normals: &[Vec3],
        pairs: Weighted,
        sums: &[NodeSums],
        carried: &[bool],
    ) -> Result<Elimination> {
        let node = |a: usize| {
            let carried = carried.get(a).is_some_and(|c| *c);
            let covered = sums[a].coverage > given.least_coverage(a);
            Node {
                normal: normals[a],
                directions: widened_matrix(&(given.setup.nodes.free[a] * direction::<N>(normals[a]))),
                share: widened_matrix(&multiplier_share(given, a)),
                area: 0.0,
                augmentation: given.augmentation(a),
                own: given.setup.has_multiplier(a) && covered && !carried,
                carried,
                acts: given.setup.nodes.acts(a),
            }
        };
        let hats = Hats::of(&given.setup.nonmortar)?;
        let mut e = Elimination { nodes: (0..given.nodes()).map(node).stored()?, hats, transfers: Vec::new() };
        let carriers = &given.step.pairing.carriers;
        e.refuse_uncovered_carriers(carriers)?;
        e.add_areas(&given.setup.nonmortar, pairs);
        let mut shares = Vec::new();
        match pairs {
            Weighted::Facets(pairs) => {
                let moving = if given.setup.mortar_moves() { pairs } else { &[] };
                e.shares(given.setup.surfaces(), moving, carriers, &mut shares)?;
            }
            Weighted::Parents(pairs) => {
                e.shares_of_parents(
                    given.setup.surfaces(),
                    (pairs, given.setup.mortar_moves()),
                    carriers,
                    &mut shares,
                )?;
            }
        }
        e.transfers = e.blocks(&shares)?;
        Ok(e)
    }

    fn add_areas(&mut self, nonmortar: &Surface, pairs: Weighted) {
        let pairs = match pairs {
            Weighted::Facets(pairs) => pairs,
            Weighted::Parents(pairs) => {
                for pair in pairs {
                    let rows = nonmortar.host_nodes(pair.one).iter().take(nonmortar.multipliers(pair.one));
                    rows.enumerate().for_each(|(k, &a)| self.nodes[a].area += pair.weights.coverage(k));
                }
                return;
            }
        };
        for pair in pairs {
            for (k, &a) in nonmortar.facets[pair.one].as_slice().iter().enumerate() {
                self.nodes[a].area += pair.weights.coverage(k);
            }
        }
    }

    /// Carried nodes with their carriers.
    fn carried<'a>(&'a self, carriers: &'a [Vec<Carrier>]) -> impl Iterator<Item = (usize, &'a [Carrier])> {
        carriers.iter().enumerate().filter(|(a, _)| self.nodes[*a].carried).map(|(a, c)| (a, &c[..]))
    }

    /// The nodes with multipliers of their own that act here.
    pub fn own(&self) -> impl Iterator<Item = usize> {
        (0..self.nodes.len()).filter(|&a| self.nodes[a].is_eliminated())
    }

    /// A carrier that has lost its own cover within the step, while those that it carries have not, has no row to
    /// eliminate its multiplier with. Where neither acts here, cover may be missing with facets that only their handle has.
    fn refuse_uncovered_carriers(&self, carriers: &[Vec<Carrier>]) -> Result<()> {
        for (a, carriers) in self.carried(carriers) {
            let here = |b: usize| self.nodes[a].acts || self.nodes[b].acts;
            if let Some((b, _)) = carriers.iter().find(|(b, _)| here(*b) && !self.nodes[*b].own) {
                let text = text!(
                    "condensation where non-mortar node {b} is not covered any more and carries node {a}, which is: take a smaller step"
                );
                return Err(Error::new(Kind::Unsupported, text));
            }
        }
        Ok(())
    }

    fn shares(
        &self,
        (one, two): (&Surface, &Surface),
        moving: &[PairRecord],
        carriers: &[Vec<Carrier>],
        shares: &mut Vec<Share>,
    ) -> Result<()> {
        for pair in moving {
            for (k, &a) in one.facets[pair.one].as_slice().iter().enumerate() {
                for (c, &node) in two.facets[pair.two].as_slice().iter().enumerate() {
                    let (row, weight) = (one.len() + node, pair.weights.ac[k][c]);
                    if self.nodes[a].is_eliminated() {
                        shares.store(((row, a, a), weight))?;
                    } else if self.nodes[a].carried {
                        shares.store_all(self.acting(&carriers[a]).map(|(b, w)| ((row, b, a), w * weight)))?;
                    }
                }
            }
        }
        for (a, carriers) in self.carried(carriers) {
            shares.store_all(self.acting(carriers).map(|(b, w)| ((a, b, a), -w * self.nodes[a].area)))?;
        }
        Ok(())
    }

    /// The carriers whose multipliers act here.
    fn acting<'a>(&'a self, carriers: &'a [Carrier]) -> impl Iterator<Item = Carrier> + 'a {
        carriers.iter().copied().filter(|(b, _)| self.nodes[*b].acts)
    }

    /// The same of pairs of parents: with the rows of non-mortar nodes that have no multiplier of their own.
    fn shares_of_parents(
        &self,
        (one, two): (&Surface, &Surface),
        (pairs, moves): (&[ParentRecord], bool),
        carriers: &[Vec<Carrier>],
        shares: &mut Vec<Share>,
    ) -> Result<()> {
        for pair in pairs {
            let own = one.host_nodes(pair.one);
            let weights = &pair.weights;
            for (k, &a) in own.iter().enumerate().take(one.multipliers(pair.one)) {
                let mut add = |row: usize, weight: f64| {
                    if self.nodes[a].own {
                        return shares.store(((row, a, a), weight));
                    }
                    let carriers: &[Carrier] = if self.nodes[a].carried { &carriers[a] } else { &[] };
                    shares.store_all(carriers.iter().map(|&(b, w)| ((row, b, a), w * weight)))
                };
                for (b, &node) in own.iter().enumerate().filter(|(_, node)| !self.nodes[**node].own) {
                    add(node, -weights.ab[k][b])?;
                }
                for (c, &node) in two.host_nodes(pair.two).iter().enumerate().filter(|_| moves) {
                    add(one.len() + node, weights.ac[k][c])?;
                }
            }
        }
        Ok(())
    }

    fn blocks(&self, shares: &[Share]) -> Result<Vec<Transfer>> {
        let shares = memory::sorted(shares, |p, q| p.0.cmp(&q.0))?;
        let mut transfers: Vec<Transfer> = Vec::new();
        for same in shares.chunk_by(|p, q| p.0 == q.0) {
            let ((row, own, via), weight) = (same[0].0, same.iter().map(|s| s.1).sum::<f64>());
            let (node, via) = (&self.nodes[own], &self.nodes[via]);
            let block = via.directions * node.directions.transpose() * (weight / node.area);
            match transfers.last_mut() {
                Some(last) if (last.row, last.own) == (row, own) => last.block += block,
                _ => transfers.store(Transfer { row, own, block })?,
            }
        }
        Ok(transfers)
    }

    /// Gives a block in the rows and columns of two nodes: its diagonal, and what else is not 0.
    pub(super) fn add_block(
        surfaces: (&Surface, &Surface),
        (row, column): (usize, usize),
        block: &Mat3,
        sink: &mut dyn Sink,
    ) {
        let (rows, columns) = (node_equations(surfaces, row), node_equations(surfaces, column));
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let exists = rows[i] != NO_EQUATION && columns[j] != NO_EQUATION;
            if exists && (i == j || block[(i, j)] != 0.0) {
                sink.add(rows[i], columns[j], block[(i, j)]);
            }
        }
    }

    /// Gives L - I.
    pub fn entries(&self, answers: &[Row], surfaces: (&Surface, &Surface), sink: &mut dyn Sink) {
        let mut add = |row: usize, own: usize, block: &Mat3| Self::add_block(surfaces, (row, own), block, sink);
        for t in &self.transfers {
            add(t.row, t.own, &t.block);
            self.hats.get(t.own).iter().for_each(|&(m, c)| add(t.row, m, &(t.block * c)));
        }
        for b in self.own() {
            let diagonal = self.diagonal(b, &answers[b]);
            add(b, b, &(diagonal - Mat3::identity()));
            self.hats.get(b).iter().for_each(|&(m, c)| add(b, m, &(diagonal * c)));
        }
    }

    /// m and c_Bm of node B.
    pub fn hat(&self, b: usize) -> &[(usize, f64)] {
        self.hats.get(b)
    }

    /// (C R)_B of a node B.
    fn gathered(&self, rows: &[Vec3], b: usize) -> Vec3 {
        rows[b] + self.hats.get(b).iter().map(|&(m, c)| rows[m] * c).sum::<Vec3>()
    }

    /// s_A [F/L^3]; 0 where a node has no multiplier of its own, or it acts elsewhere.
    pub fn scale(&self, a: usize) -> f64 {
        let node = &self.nodes[a];
        if node.is_eliminated() { node.augmentation * node.area } else { 0.0 }
    }

    /// D [L^2].
    pub(super) fn area(&self, a: usize) -> f64 {
        self.nodes[a].area
    }

    /// nu.
    pub(super) fn normal(&self, a: usize) -> &Vec3 {
        &self.nodes[a].normal
    }

    /// s of every node.
    pub fn scales(&self) -> Result<Vec<f64>> {
        (0..self.nodes.len()).map(|a| self.scale(a)).stored()
    }

    /// r_A c_A of the nodes with multipliers of their own: what the projection makes of these.
    pub fn traction_changes(&self, rows: &[Row]) -> Result<Vec<Vec3>> {
        let change = |(node, row): (&Node, &Row)| match node.is_eliminated() {
            true => row.value * node.augmentation,
            false => Vec3::zeros(),
        };
        self.nodes.iter().zip(rows).map(change).stored()
    }

    /// W_B.
    pub fn diagonal(&self, b: usize, row: &Row) -> Mat3 {
        own_rows(&self.nodes[b].directions, self.nodes[b].augmentation, &row.derivative)
    }

    /// The condensed rows of the non-mortar nodes, L R_u + b, and what the rows of so many mortar nodes gain beyond R_u, of
    /// the forces' rows R_u of the non-mortar nodes.
    pub fn residual(&self, forces: &[Vec3], mortar: usize, rows: &[Row]) -> Result<(Vec<Vec3>, Vec<Vec3>)> {
        let n1 = forces.len();
        let (mut own, mut gains) = (memory::copied(forces)?, memory::filled(Vec3::zeros(), mortar)?);
        for t in &self.transfers {
            let row = if t.row < n1 { &mut own[t.row] } else { &mut gains[t.row - n1] };
            *row += t.block * self.gathered(forces, t.own);
        }
        for b in self.own() {
            let constraint = self.nodes[b].directions * rows[b].value * self.scale(b);
            own[b] = self.diagonal(b, &rows[b]) * self.gathered(forces, b) + constraint;
        }
        Ok((own, gains))
    }

    /// The multipliers in force: those of `lambda` at the nodes that have their own, and what these tell of the others.
    pub fn completed(&self, carriers: &[Vec<Carrier>], mut lambda: Vec<Vec3>) -> Vec<Vec3> {
        for (node, lambda) in self.nodes.iter().zip(&mut lambda) {
            *lambda = if node.own { node.share * *lambda } else { Vec3::zeros() };
        }
        for (a, carriers) in self.carried(carriers) {
            lambda[a] = self.nodes[a].share * carriers.iter().map(|&(b, w)| lambda[b] * w).sum::<Vec3>();
        }
        lambda
    }

    /// The multipliers that balance the host's own forces at the non-mortar nodes, lambda_B = -T_B^T R_B / D_B.
    pub fn multipliers(&self, carriers: &[Vec<Carrier>], host: &[Vec3]) -> Result<Vec<Vec3>> {
        let mut lambda = memory::filled(Vec3::zeros(), host.len())?;
        for b in (0..self.nodes.len()).filter(|&b| self.nodes[b].own) {
            let Node { directions, area, .. } = &self.nodes[b];
            lambda[b] = directions.transpose() * self.gathered(host, b) * (-1.0 / area);
        }
        Ok(self.completed(carriers, lambda))
    }
}
