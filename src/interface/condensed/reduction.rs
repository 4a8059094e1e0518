//! The reduced form of a condensed system, for multigrid (docs/formulation 10.10). Of a condensed matrix J and residual R it is
//!
//!   matrix E_L J E_R,   residual E_L R,   displacements u = E_R v.
//!
//! A node B with a multiplier of its own has Q_B, the projector on the directions of its constraints: 0 in gap, nu_B nu_B^T
//! where it slips, T_B T_B^T where it sticks or is tied. v has u_B along Q_B apart from what the other side's nodes C move it
//! by, sum_C L_CB^T u_C. With this
//!
//! - rows of B: E_BB takes the constraint out of the rows of forces. So they are independent of each other;
//! - rows of C: E_CB = -L_CB (I - Q_B) E_BB takes out what rows of forces of B have brought there;
//! - columns: (E_R)_BC = Q_B L_CB^T, and (E_R)_mB = c_Bm, (E_R)_mC = c_Bm Q_B L_CB^T of nodes m of `hats.rs`.
//!
//! Where friction is not the same in all directions a sticking node's row is its gap stretched, L^2 g; E_BB takes the stretch out.
//!
//! With what lies between the surfaces a closed node's row has its multiplier in it, and is no constraint: Q is 0 then.
//!
//! Both are invertible, so the solution is that of the condensed system. E_L J E_R has the constraint s_B D_B Q_B v_B = known
//! in place of a penalty, and for the rest the stiffness of the bodies tied along Q.

use super::elimination::{Elimination, Row};
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::surface::Surface;
use crate::interface::tangent::by_equations::Sink;
use crate::law::State;

/// Where a node slips, 1 - beta is the share of forces in the row across the direction of slip. From this share on the row
/// counts as a constraint: to divide by less would give it the weight of 1000 stiffness rows.
const LEAST_SHARE_OF_FORCES: f64 = 1e-3;
/// dc/dg of a row that is not stretched is a projector to this rounding of a few products.
const NOT_STRETCHED: f64 = 1e-12;

/// How a node's own rows are split.
#[derive(Clone, Copy, Debug)]
pub struct SplitRows {
    /// Q.
    pub constrained: Mat3,
    /// E.
    pub rows: Mat3,
}

/// The split of a node with normal nu and condensed rows W R + ..., from N = I - W = T (I + r dc/dlambda) T^T and from `slip`,
/// dc/dg of the gap that slip is measured by.
pub fn split_rows(state: State, nu: &Vec3, n: &Mat3, slip: &Mat3) -> SplitRows {
    let (one, along) = (Mat3::identity(), nu * nu.transpose());
    let in_surface = (one - along) * slip * (one - along);
    match state {
        State::Gap => SplitRows { constrained: Mat3::zeros(), rows: one },
        State::Stick => {
            let stretch = one + in_surface - (n - along);
            let is_stretched = in_surface.amax() > 0.0 && (stretch - one).amax() > NOT_STRETCHED;
            let rows = if is_stretched { stretch.try_inverse().unwrap_or(one) } else { one };
            SplitRows { constrained: *n, rows }
        }
        State::Slip => {
            // N = nu nu^T - mu t nu^T + beta s s^T; stretched, with L t and (L s) (L^-1 s)^T.
            let friction = (one - along) * n * along;
            let across = (one - along) * n * (one - along);
            let beta = across.trace();
            let forces = 1.0 - beta;
            if forces > LEAST_SHARE_OF_FORCES {
                SplitRows { constrained: along, rows: one - friction + across / forces }
            } else {
                let along_s = across * across.transpose() / across.norm_squared();
                let stretch = (along_s * in_surface).trace();
                let scale = if stretch > 0.0 { 1.0 / stretch - 1.0 } else { 0.0 };
                SplitRows { constrained: along + along_s, rows: (one + along_s * scale) * (one - friction) }
            }
        }
    }
}

impl Elimination {
    fn split(&self, b: usize, row: &Row) -> SplitRows {
        split_rows(row.state(), self.normal(b), &(Mat3::identity() - self.diagonal(b, row)), row.slip())
    }

    /// Gives E_L - I.
    pub fn reduction_rows(&self, answers: &[Row], surfaces: (&Surface, &Surface), sink: &mut dyn Sink) {
        for b in self.own() {
            let rows = self.split(b, &answers[b]).rows;
            Self::add_block(surfaces, (b, b), &(rows - Mat3::identity()), sink);
        }
        for t in &self.transfers {
            let SplitRows { constrained, rows } = self.split(t.own, &answers[t.own]);
            let brought = t.block * (Mat3::identity() - constrained) * rows;
            Self::add_block(surfaces, (t.row, t.own), &-brought, sink);
        }
    }

    /// Gives E_R - I.
    pub fn reduction_columns(&self, answers: &[Row], surfaces: (&Surface, &Surface), sink: &mut dyn Sink) {
        for b in self.own() {
            for &(m, c) in self.hat(b) {
                Self::add_block(surfaces, (m, b), &Mat3::from_diagonal_element(c), sink);
            }
        }
        for t in &self.transfers {
            let moved = self.split(t.own, &answers[t.own]).constrained * t.block.transpose();
            Self::add_block(surfaces, (t.own, t.row), &moved, sink);
            for &(m, c) in self.hat(t.own) {
                Self::add_block(surfaces, (m, t.row), &(moved * c), sink);
            }
        }
    }

    /// Gives Q, or s D Q, the constraints' place in the matrix.
    pub fn constrained(&self, answers: &[Row], scaled: bool, surfaces: (&Surface, &Surface), sink: &mut dyn Sink) {
        for b in self.own() {
            let factor = if scaled { self.scale(b) * self.area(b) } else { 1.0 };
            Self::add_block(surfaces, (b, b), &(self.split(b, &answers[b]).constrained * factor), sink);
        }
    }
}
