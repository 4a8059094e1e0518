//! What goes out of a pair of facets: weights, gaps, forces, matrices, node by node.

use super::layout::Matrix;
use super::raw::{self, Output};
use crate::element::{PairTangent, write_pair};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::mortar::{MORTAR, PAIR_NODES, PairWeights};
use crate::shape::MAX_CORNERS;

/// Slot of the k-th of a pair's nodes, non-mortar first.
pub(super) fn slot(n1: usize, k: usize) -> usize {
    if k < n1 { k } else { MORTAR + k - n1 }
}

/// Writes n_ab and n_ac, row A, of a pair with so many nodes; each may be null.
pub(super) fn write_weights(w: &PairWeights, (n1, n2): (usize, usize), n_ab: *mut f64, n_ac: *mut f64) {
    let (mut ab, mut ac) = (Output::new(n_ab), Output::new(n_ac));
    if n1 + n2 == PAIR_NODES {
        ab.append(w.ab.as_flattened());
        ac.append(w.ac.as_flattened());
        return;
    }
    for a in 0..n1 {
        ab.append(&w.ab[a][..n1]);
        ac.append(&w.ac[a][..n2]);
    }
}

/// Writes gaps of so many nodes.
pub(super) fn write_gap(g: &[Vec3; MAX_CORNERS], n1: usize, gap: *mut f64) -> Result<()> {
    let flat = g.each_ref().map(|v| [v.x, v.y, v.z]);
    raw::check_array("gap", flat.as_flattened())?;
    raw::write(gap, &flat.as_flattened()[..3 * n1]);
    Ok(())
}

/// Writes the forces of a pair with so many nodes.
pub(super) fn write_force(f: &[Vec3; PAIR_NODES], (n1, n2): (usize, usize), force: *mut f64) -> Result<()> {
    let flat = f.each_ref().map(|v| [v.x, v.y, v.z]);
    raw::check_array("force", flat.as_flattened())?;
    let mut to = Output::new(force);
    to.append(flat[..n1].as_flattened());
    to.append(flat[MORTAR..][..n2].as_flattened());
    Ok(())
}

/// Refuses a tangent that left the range of doubles.
pub(super) fn check_tangent(t: &PairTangent) -> Result<()> {
    for part in [&t.forces.one, &t.forces.two, &t.rows] {
        raw::check_array("k", part.as_flattened().as_flattened().as_flattened())?;
    }
    Ok(())
}

/// Writes the tangent of a pair with so many nodes and with these weights of now, if it has any.
pub(super) fn write_tangent(t: &PairTangent, now: Option<&PairWeights>, (n1, n2): (usize, usize), k: &mut Matrix) {
    let none = PairWeights::default();
    let (now, n) = (now.unwrap_or(&none), n1 + n2);
    if n == PAIR_NODES {
        return write_pair(t, now, k);
    }
    let force_lambda = |row: usize, a: usize| if row < MORTAR { now.ab[a][row] } else { -now.ac[a][row - MORTAR] };
    let block = |row: usize, column: usize| -> Mat3 {
        match (row < n, column < n) {
            (true, true) => t.force_x(slot(n1, row), slot(n1, column)),
            (true, false) => Mat3::from_diagonal_element(force_lambda(slot(n1, row), column - n)),
            (false, true) => t.row_x(row - n, slot(n1, column)),
            (false, false) => Mat3::zeros(),
        }
    };
    for row in 0..n + n1 {
        for column in 0..n + n1 {
            k.write(row, column, &block(row, column));
        }
    }
}

/// Refuses weights that left the range of doubles.
#[inline]
pub(super) fn check_weights(w: &PairWeights) -> Result<()> {
    raw::check_array("n_ab, n_ac", w.ab.as_flattened())?;
    raw::check_array("n_ab, n_ac", w.ac.as_flattened())
}
