//! The elimination of multipliers by the rows of their own nodes (docs/formulation.md 10.7). With R_u the forces' rows, J_uu their
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
//! Every other row stays as it is, and so does an uncovered node's, whose multiplier is 0. s_A counts as a constant: what
//! D s_A would add to the matrix is c_A Ds_A, which vanishes with the residual.

use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::multiplier::direction;
use crate::interface::data::pairs::PairRecord;
use crate::interface::pairing::given::Given;
use crate::interface::stages::carried::multiplier_share;
use crate::interface::stages::sums::NodeSums;
use crate::law::NodeResponse;
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

/// The elimination at a configuration.
#[derive(Debug)]
pub struct Elimination<const N: usize> {
    /// T of every node.
    directions: Vec<SMatrix<f64, 3, N>>,
    /// D_A [L^2].
    areas: Vec<f64>,
    /// Which nodes have a multiplier of their own here: covered, and not carried.
    own: Vec<bool>,
    /// Which are carried; empty where none is.
    carried: Vec<bool>,
    /// Sorted by row, then by node.
    pub transfers: Vec<Transfer>,
}

/// W_B of a covered node from T_B, r_B and dc_B/dlambda_B.
pub fn own_rows<const N: usize>(t: &SMatrix<f64, 3, N>, r: f64, drow_dlambda: &SMatrix<f64, N, N>) -> Mat3 {
    Mat3::identity() - t * (SMatrix::<f64, N, N>::identity() + drow_dlambda * r) * t.transpose()
}

/// A weight on its way into a block: (row, own node, node through which it acts), weight.
type Share = ((usize, usize, usize), f64);

impl<const N: usize> Elimination<N> {
    /// At the pairs whose weights act, their sums, and the nodes that are carried there.
    pub fn new(
        given: Given<N>,
        normals: &[Vec3],
        pairs: &[PairRecord],
        sums: &[NodeSums],
        carried: Vec<bool>,
    ) -> Result<Elimination<N>> {
        let n1 = given.nodes();
        let mut e = Elimination {
            directions: memory::with_room(n1)?,
            areas: memory::filled(0.0, n1)?,
            own: memory::with_room(n1)?,
            carried,
            transfers: Vec::new(),
        };
        for pair in pairs {
            for (k, &a) in given.setup.nonmortar.facets[pair.one].as_slice().iter().enumerate() {
                e.areas[a] += pair.weights.coverage(k);
            }
        }
        for (a, nu) in normals.iter().enumerate() {
            e.directions.store(given.setup.nodes.free[a] * direction::<N>(*nu))?;
            let covered = sums[a].coverage > given.least_coverage(a);
            e.own.store(given.setup.has_multiplier(a) && covered && !e.is_carried(a))?;
        }
        e.refuse_uncovered_carriers(given)?;
        e.transfers = e.blocks(given, pairs)?;
        Ok(e)
    }

    fn is_carried(&self, a: usize) -> bool {
        self.carried.get(a).is_some_and(|c| *c)
    }

    fn carried(&self) -> impl Iterator<Item = usize> {
        (0..self.carried.len()).filter(|&a| self.carried[a])
    }

    /// The nodes with multipliers of their own.
    pub fn own(&self) -> impl Iterator<Item = usize> {
        (0..self.own.len()).filter(|&a| self.own[a])
    }

    /// A carrier that has lost its own cover within the step, while those that it carries have not, has no row to
    /// eliminate its multiplier with.
    fn refuse_uncovered_carriers(&self, given: Given<N>) -> Result<()> {
        for a in self.carried() {
            if let Some((b, _)) = given.carriers_of(a).iter().find(|(b, _)| !self.own[*b]) {
                let text = text!(
                    "condensation where non-mortar node {b} is not covered any more and carries node {a}, which is: take a smaller step"
                );
                return Err(Error::new(Kind::Unsupported, text));
            }
        }
        Ok(())
    }

    fn blocks(&self, given: Given<N>, pairs: &[PairRecord]) -> Result<Vec<Transfer>> {
        let mut shares: Vec<Share> = Vec::new();
        let moving = if given.setup.effects.moves() { pairs } else { &[] };
        for pair in moving {
            let (one, two) = (&given.setup.nonmortar.facets[pair.one], &given.setup.mortar.facets[pair.two]);
            for (k, &a) in one.as_slice().iter().enumerate() {
                for (c, &node) in two.as_slice().iter().enumerate() {
                    let (row, weight) = (given.nodes() + node, pair.weights.ac[k][c]);
                    if self.own[a] {
                        shares.store(((row, a, a), weight))?;
                    } else if self.is_carried(a) {
                        let carriers = given.carriers_of(a).iter();
                        shares.store_all(carriers.map(|&(b, w)| ((row, b, a), w * weight)))?;
                    }
                }
            }
        }
        for a in self.carried() {
            shares.store_all(given.carriers_of(a).iter().map(|&(b, w)| ((a, b, a), -w * self.areas[a])))?;
        }
        let shares = memory::sorted(&shares, |p, q| p.0.cmp(&q.0))?;
        let mut transfers: Vec<Transfer> = Vec::new();
        for same in shares.chunk_by(|p, q| p.0 == q.0) {
            let ((row, own, via), weight) = (same[0].0, same.iter().map(|s| s.1).sum::<f64>());
            let block = self.directions[via] * self.directions[own].transpose() * (weight / self.areas[own]);
            match transfers.last_mut() {
                Some(last) if (last.row, last.own) == (row, own) => last.block += block,
                _ => transfers.store(Transfer { row, own, block })?,
            }
        }
        Ok(transfers)
    }

    /// s_A of every node [F/L^3]; 0 where it has no multiplier of its own.
    pub fn scales(&self, given: Given<N>) -> Result<Vec<f64>> {
        let scale = |a: usize| if self.own[a] { given.augmentation(a) * self.areas[a] } else { 0.0 };
        (0..self.own.len()).map(scale).stored()
    }

    /// W_B.
    pub fn diagonal(&self, given: Given<N>, b: usize, response: &NodeResponse<N>) -> Mat3 {
        own_rows(&self.directions[b], given.augmentation(b), &response.drow_dlambda)
    }

    /// The condensed rows of the non-mortar nodes, L R_u + b, and what the mortar nodes' rows gain beyond R_u, of the forces'
    /// rows R_u of the non-mortar nodes.
    pub fn residual(
        &self,
        given: Given<N>,
        forces: &[Vec3],
        responses: &[NodeResponse<N>],
    ) -> Result<(Vec<Vec3>, Vec<Vec3>)> {
        let (scales, n1) = (self.scales(given)?, forces.len());
        let (mut rows, mut mortar) =
            (memory::copied(forces)?, memory::filled(Vec3::zeros(), given.setup.mortar.len())?);
        for t in &self.transfers {
            let row = if t.row < n1 { &mut rows[t.row] } else { &mut mortar[t.row - n1] };
            *row += t.block * forces[t.own];
        }
        for b in self.own() {
            let constraint = self.directions[b] * responses[b].row * scales[b];
            rows[b] = self.diagonal(given, b, &responses[b]) * forces[b] + constraint;
        }
        Ok((rows, mortar))
    }

    /// The multipliers in force: those of `lambda` at the nodes that have their own, and what these tell of the others.
    pub fn completed(&self, given: Given<N>, mut lambda: Vec<SVector<f64, N>>) -> Vec<SVector<f64, N>> {
        for (a, lambda) in lambda.iter_mut().enumerate() {
            *lambda = if self.own[a] { multiplier_share(given, a) * *lambda } else { SVector::zeros() };
        }
        for a in self.carried() {
            let told = given.carriers_of(a).iter().map(|&(b, w)| lambda[b] * w).sum::<SVector<f64, N>>();
            lambda[a] = multiplier_share(given, a) * told;
        }
        lambda
    }

    /// The multipliers that balance the host's own forces at the non-mortar nodes, lambda_B = -T_B^T R_B / D_B.
    pub fn multipliers(&self, given: Given<N>, host: &[Vec3]) -> Result<Vec<SVector<f64, N>>> {
        let mut lambda = memory::filled(SVector::zeros(), host.len())?;
        for b in self.own() {
            lambda[b] = self.directions[b].transpose() * host[b] * (-1.0 / self.areas[b]);
        }
        Ok(self.completed(given, lambda))
    }
}
