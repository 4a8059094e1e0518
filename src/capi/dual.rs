//! Stage 1b for one non-mortar facet, between pair and node: what makes weights those of dual multipliers. Stateless,
//! re-entrant, without allocation.

use super::facet::facet;
use super::guard::guard;
use super::pair_in::{Pair, stickslip_pair};
use super::pair_out::write_weights;
use super::raw::{self, Output};
use crate::dual::{DualBasis, FacetSums};
use crate::error::{Error, Kind, Result};
use crate::geometry::Facet;
use crate::mortar::{NonmortarFrame, PairWeights};

/// Far above the rounding of any order of sums: n_AB of a pair is symmetric to the last bit.
const SYMMETRIC: f64 = 1e-10;

/// The dual basis of a facet from its sums; `None` where it has faded out. What cannot be a sum of n_AB, as that of weights
/// which are dual already, is refused.
pub(super) fn basis(sums: &FacetSums, name: &str) -> Result<Option<DualBasis>> {
    let (n, m) = (sums.nodes, &sums.mass);
    let largest = m.iter().flatten().fold(0.0_f64, |largest, v| largest.max(v.abs()));
    let is_covered = sums.coverage().fade > 0.0;
    for (a, b) in (0..n).flat_map(|a| (0..n).map(move |b| (a, b))) {
        if (m[a][b] - m[b][a]).abs() > SYMMETRIC * largest || (is_covered && !(m[a][b] > 0.0)) {
            let text = text!(
                "{name}: entry ({a}, {b}) is {:e}, ({b}, {a}) {:e}; sums of n_ab of stickslip_pair_weights are symmetric and positive",
                m[a][b],
                m[b][a]
            );
            return Err(Error::new(Kind::InvalidValue, text));
        }
    }
    DualBasis::of(sums).map_err(raw::named(name))
}

/// The basis of a facet from a caller's sum of n_AB.
fn basis_of(one: &Facet, x: &str, mass: *const f64) -> Result<Option<DualBasis>> {
    let n = one.len();
    let mut sums = FacetSums::new(&NonmortarFrame::new(one).map_err(raw::named(x))?);
    for (row, given) in sums.mass.iter_mut().zip(raw::numbers(mass, n * n, "mass")?.chunks_exact(n)) {
        row[..n].copy_from_slice(given);
    }
    basis(&sums, "mass")
}

/// Stage 1b: what makes the weights of a facet's pairs those of dual multipliers, from the sum of n_ab over all of its
/// pairs. docs/formulation 10.1.
///
/// n: 3 or 4; x: 3 n coordinates of the non-mortar facet [L]; mass (n x n): the sum of n_ab of `stickslip_pair_weights`
/// [L^2]. Outputs, each may be NULL: fade (1) [-], phi: 1, less where below 1 % of the facet is covered, 0 below 0.01 %;
/// areas (n): what the facet adds to the coverage of its nodes, phi m_A [L^2]; coefficients (n x n), row A [-]:
/// phi a_AB, times n_ac of a pair its dual n_ac (in Fortran coefficients(B, A)). All are 0 where fade is 0.
///
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, INVALID_VALUE (mass is no such sum), DEGENERATE_FACET
/// (the facet, or what covers it does not determine its multipliers).
/// Cost: below a microsecond; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_facet_dual(
    n: i32,
    x: *const f64,
    mass: *const f64,
    fade: *mut f64,
    areas: *mut f64,
    coefficients: *mut f64,
) -> i32 {
    guard(|| {
        let one = facet(n, x, "x")?;
        for (p, name) in [(fade, "fade"), (areas, "areas"), (coefficients, "coefficients")] {
            raw::check_optional(p, name)?;
        }
        let (n, basis) = (one.len(), basis_of(&one, "x", mass)?);
        let (phi, diagonal, turn) = basis.map_or_else(Default::default, |b| {
            let phi = b.coverage.fade;
            (phi, b.diagonal(), b.faded_coefficients())
        });
        raw::check_results("areas, coefficients", diagonal.iter().chain(turn.iter().flatten()))?;
        raw::write(fade, &[phi]);
        raw::write(areas, &diagonal[..n]);
        let mut rows = Output::new(coefficients);
        turn[..n].iter().for_each(|row| rows.append(&row[..n]));
        Ok(())
    })
}

/// Stage 1b: a pair's share of the dual weights. They take the place of the pair's weights in `stickslip_pair_gap`, in the
/// coverage of nodes, in `stickslip_pair_residual`, and as weights of t_n. docs/formulation 10.2.
///
/// pair: quadrature and layout are not read. mass (n1 x n1): the sum of n_ab over all pairs of the non-mortar facet [L^2];
/// n_ab (n1 x n1), n_ac (n1 x n2): the pair's own, of `stickslip_pair_weights` [L^2]. Outputs, each may be NULL: dual_ab
/// (n1 x n1) and dual_ac (n1 x n2) [L^2], row A; they may be n_ab and n_ac themselves. Over all pairs dual_ab adds up to
/// areas of `stickslip_facet_dual` on the diagonal, and to 0 elsewhere. With the sums in the order of the handle the
/// weights have its bits.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, INVALID_VALUE (mass is no such sum),
/// DEGENERATE_FACET (the facet, or what covers it does not determine its multipliers).
/// Cost: below a microsecond; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_dual(
    pair: *const stickslip_pair,
    mass: *const f64,
    n_ab: *const f64,
    n_ac: *const f64,
    dual_ab: *mut f64,
    dual_ac: *mut f64,
) -> i32 {
    guard(|| {
        let pair = Pair::read(pair)?;
        let weights = pair.weights(n_ab, n_ac, ["n_ab", "n_ac"])?;
        raw::check_optional(dual_ab, "dual_ab")?;
        raw::check_optional(dual_ac, "dual_ac")?;
        let basis = basis_of(&pair.one, "pair.x1", mass)?;
        let dual = basis.map_or_else(PairWeights::default, |basis| basis.weights(&weights));
        raw::check_results("dual_ab, dual_ac", dual.ab.iter().chain(&dual.ac).flatten())?;
        write_weights(&dual, pair.n(), dual_ab, dual_ac);
        Ok(())
    })
}
