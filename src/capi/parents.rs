//! A pair with a quadratic facet, as a caller gives it to the functions of pairs (`pair.rs`). Apart from linear pairs, whose calls
//! need no room for these.

use super::facet::parent;
use super::layout::{Matrix, column_major};
use super::node::stickslip_node_response;
use super::options::rule;
use super::pair_in::{node_tangents, stickslip_pair, tractions};
use super::raw::{self, Output};
use super::space::multiplier_space;
use crate::element::{NodeTangent, ParentPair};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::memory;
use crate::mortar::{MultiplierSpace, ParentFacet, ParentWeights, parent_weights};
use crate::shape::MAX_PARENT_NODES;

/// n_ab and n_ac of a call, or their derivatives.
type Two<T> = [T; 2];

/// `stickslip_pair_weights`.
#[cold]
#[inline(never)]
pub(super) fn weights(given: &stickslip_pair, n: Two<*mut f64>, dn: Two<*mut f64>) -> Result<()> {
    let pair = Parents::of(given)?;
    for (p, name) in n.into_iter().chain(dn).zip(["n_ab", "n_ac", "dn_ab", "dn_ac"]) {
        raw::check_optional(p, name)?;
    }
    let rule = rule(given.quadrature, "pair.quadrature")?;
    let wants = !(dn[0].is_null() && dn[1].is_null());
    let [n_ab, n_ac] = if wants { pair.derivatives() } else { [0; 2] };
    let (mut ab, mut ac) = (memory::filled(0.0, n_ab)?, memory::filled(0.0, n_ac)?);
    let derivatives = wants.then_some([&mut ab[..], &mut ac[..]]);
    let w = parent_weights((&pair.one, &pair.two), pair.space, rule, derivatives).map_err(raw::named("pair"))?;
    raw::check_results("n_ab, n_ac", w.ab.as_flattened().iter().chain(w.ac.as_flattened()))?;
    raw::check_results("dn_ab, dn_ac", ab.iter().chain(&ac))?;
    let (m, n1, n2) = pair.counts();
    for (to, (of, columns)) in n.into_iter().zip([(&w.ab, n1), (&w.ac, n2)]) {
        let mut to = Output::new(to);
        of[..m].iter().for_each(|row| to.append(&row[..columns]));
    }
    dn.into_iter().zip([&ab, &ac]).for_each(|(to, of)| raw::write(to, of));
    Ok(())
}

/// `stickslip_pair_gap`.
#[cold]
#[inline(never)]
pub(super) fn gap(given: &stickslip_pair, n: Two<*const f64>, gap: *mut f64) -> Result<()> {
    let pair = Parents::of(given)?;
    let w = pair.read_weights(n, ["n_ab", "n_ac"])?;
    raw::check(gap, "gap")?;
    write_vectors("gap", &pair.pair().gap(&w)[..pair.counts().0], gap)
}

/// `stickslip_pair_residual`.
#[cold]
#[inline(never)]
pub(super) fn residual(given: &stickslip_pair, n: Two<*const f64>, t: *const f64, force: *mut f64) -> Result<()> {
    let pair = Parents::of(given)?;
    let (w, (m, n1, n2)) = (pair.read_weights(n, ["n_ab", "n_ac"])?, pair.counts());
    let traction = tractions::<MAX_PARENT_NODES>(t, m)?;
    raw::check(force, "force")?;
    write_vectors("force", &pair.pair().force(&w, &traction[..m])[..n1 + n2], force)
}

/// `stickslip_pair_tangent`.
#[cold]
#[inline(never)]
pub(super) fn tangent(
    given: &stickslip_pair,
    (n, dn): (Two<*const f64>, Two<*const f64>),
    previous: Two<*const f64>,
    (traction, responses, row_scale): (*const f64, *const stickslip_node_response, *const f64),
    (k, ld): (*mut f64, i64),
) -> Result<()> {
    let pair = Parents::of(given)?;
    let ((m, n1, n2), column_major) = (pair.counts(), column_major(given.layout, "pair.layout")?);
    let size = n1 + n2 + m;
    let mut k = Matrix::new(k, 3 * size, ld, column_major)?;
    let now = pair.optional_weights(n, ["n_ab", "n_ac"])?;
    let slopes = match dn.iter().any(|p| !p.is_null()) {
        true => {
            let [n_ab, n_ac] = pair.derivatives();
            Some([raw::numbers(dn[0], n_ab, "dn_ab")?, raw::numbers(dn[1], n_ac, "dn_ac")?])
        }
        false => None,
    };
    let previous = pair.optional_weights(previous, ["n_ab_previous", "n_ac_previous"])?;
    let traction = tractions::<MAX_PARENT_NODES>(traction, m)?;
    let nodes: [NodeTangent; MAX_PARENT_NODES] = node_tangents(&traction[..m], responses, row_scale)?;
    // Nothing is written where a number is out of range.
    let mut blocks = memory::filled(Mat3::zeros(), size * size)?;
    let now = now.as_ref().map(|w| (w, slopes));
    let give = |row: usize, column: usize, block: Mat3| blocks[row * size + column] = block;
    pair.pair().tangent(now, previous.as_ref(), &nodes[..m], give);
    raw::check_results("k", blocks.iter().flat_map(|block| block.iter()))?;
    blocks.iter().enumerate().for_each(|(at, block)| k.write(at / size, at % size, block));
    Ok(())
}

/// Writes vectors, if they are in range.
fn write_vectors(name: &str, of: &[Vec3], to: *mut f64) -> Result<()> {
    raw::check_results(name, of.iter().flat_map(|v| v.iter()))?;
    raw::write_each(to, of.iter().flat_map(|v| v.iter().copied()));
    Ok(())
}

/// Such a pair.
struct Parents {
    one: ParentFacet,
    two: ParentFacet,
    space: MultiplierSpace,
}

impl Parents {
    fn of(given: &stickslip_pair) -> Result<Parents> {
        let (one, two) = (parent(given.n1, given.x1, "pair.x1")?, parent(given.n2, given.x2, "pair.x2")?);
        if given.element_points != 0 || !given.neighbour_normals.is_null() {
            let text = "pair.element_points and pair.neighbour_normals are for linear facets; leave them 0 and NULL";
            return Err(Error::new(Kind::Unsupported, text));
        }
        Ok(Parents { one, two, space: multiplier_space(given.multiplier_space, "pair.multiplier_space")? })
    }

    fn pair(&self) -> ParentPair<'_> {
        ParentPair { one: &self.one, two: &self.two, multipliers: self.one.multipliers(self.space) }
    }

    /// Multipliers, and nodes of both sides.
    fn counts(&self) -> (usize, usize, usize) {
        (self.one.multipliers(self.space), self.one.parent.n, self.two.parent.n)
    }

    /// How many derivatives n_ab and n_ac have.
    fn derivatives(&self) -> [usize; 2] {
        let (m, n1, n2) = self.counts();
        [n1, n2].map(|columns| 3 * m * columns * (n1 + n2))
    }

    fn read_weights(&self, of: Two<*const f64>, names: [&str; 2]) -> Result<ParentWeights> {
        let (m, n1, n2) = self.counts();
        let ab = raw::numbers(of[0], m * n1, names[0])?;
        let ac = raw::numbers(of[1], m * n2, names[1])?;
        let mut w = ParentWeights::default();
        for a in 0..m {
            w.ab[a][..n1].copy_from_slice(&ab[a * n1..][..n1]);
            w.ac[a][..n2].copy_from_slice(&ac[a * n2..][..n2]);
        }
        Ok(w)
    }

    /// The same, or nothing where both are null.
    fn optional_weights(&self, of: Two<*const f64>, names: [&str; 2]) -> Result<Option<ParentWeights>> {
        of.iter().any(|p| !p.is_null()).then(|| self.read_weights(of, names)).transpose()
    }
}
