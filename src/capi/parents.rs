//! A pair with a quadratic facet, as a caller gives it to the functions of pairs (`pair.rs`).

use super::facet::parent;
use super::layout::{Matrix, column_major};
use super::node::{read_response, stickslip_node_response};
use super::options::rule;
use super::pair_in::{STICKSLIP_SPACE_SUB, stickslip_pair};
use super::raw::{self, Output};
use crate::element::ParentPair;
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::memory;
use crate::mortar::{MultiplierSpace, ParentFacet, ParentWeights, parent_weights};
use crate::shape::MAX_PARENT_NODES;

/// What a call gives: n_ab and n_ac, or their derivatives.
type Two<T> = [T; 2];

// Apart from the linear pairs, whose calls need no room for these.

/// `stickslip_pair_weights`.
#[cold]
#[inline(never)]
pub(super) fn weights(raw: &stickslip_pair, n: Two<*mut f64>, dn: Two<*mut f64>) -> Result<()> {
    Parents::of(raw)?.weights(n, dn)
}

/// `stickslip_pair_gap`.
#[cold]
#[inline(never)]
pub(super) fn gap(raw: &stickslip_pair, n: Two<*const f64>, gap: *mut f64) -> Result<()> {
    Parents::of(raw)?.gap(n, gap)
}

/// `stickslip_pair_residual`.
#[cold]
#[inline(never)]
pub(super) fn residual(raw: &stickslip_pair, n: Two<*const f64>, traction: *const f64, force: *mut f64) -> Result<()> {
    Parents::of(raw)?.residual(n, traction, force)
}

/// `stickslip_pair_tangent`.
#[cold]
#[inline(never)]
pub(super) fn tangent(
    raw: &stickslip_pair,
    now: (Two<*const f64>, Two<*const f64>),
    previous: Two<*const f64>,
    nodes: (*const f64, *const stickslip_node_response, *const f64),
    to: (*mut f64, i64),
) -> Result<()> {
    Parents::of(raw)?.tangent(now, previous, nodes, to)
}

/// Such a pair.
struct Parents {
    one: ParentFacet,
    two: ParentFacet,
    space: MultiplierSpace,
    raw: stickslip_pair,
}

impl Parents {
    /// Of what a caller gives.
    fn of(raw: &stickslip_pair) -> Result<Parents> {
        let space = match raw.multiplier_space {
            STICKSLIP_SPACE_SUB => MultiplierSpace::Sub,
            _ => MultiplierSpace::Corner,
        };
        let (one, two) = (parent(raw.n1, raw.x1, "pair.x1")?, parent(raw.n2, raw.x2, "pair.x2")?);
        if raw.element_points != 0 || !raw.neighbour_normals.is_null() {
            let text = "pair.element_points and pair.neighbour_normals are for linear facets; leave them 0 and NULL";
            return Err(Error::new(Kind::Unsupported, text));
        }
        Ok(Parents { one, two, space, raw: *raw })
    }

    fn pair(&self) -> ParentPair<'_> {
        ParentPair { one: &self.one, two: &self.two, multipliers: self.one.multipliers(self.space) }
    }

    /// Multipliers, and nodes of both sides.
    fn counts(&self) -> (usize, usize, usize) {
        (self.one.multipliers(self.space), self.one.parent.n, self.two.parent.n)
    }

    fn weights(&self, n: [*mut f64; 2], dn: [*mut f64; 2]) -> Result<()> {
        for (p, name) in n.into_iter().chain(dn).zip(["n_ab", "n_ac", "dn_ab", "dn_ac"]) {
            raw::check_optional(p, name)?;
        }
        let rule = rule(self.raw.quadrature, "pair.quadrature")?;
        let ((m, n1, n2), facets) = (self.counts(), (&self.one, &self.two));
        let all = 3 * m * (n1 + n2);
        let wants = !(dn[0].is_null() && dn[1].is_null());
        let size = if wants { all } else { 0 };
        let (mut ab, mut ac) = (memory::filled(0.0, size * n1)?, memory::filled(0.0, size * n2)?);
        let derivatives = wants.then_some([&mut ab[..], &mut ac[..]]);
        let w = parent_weights(facets, self.space, rule, derivatives).map_err(raw::named("pair"))?;
        raw::check_results("n_ab, n_ac", w.ab.as_flattened().iter().chain(w.ac.as_flattened()))?;
        raw::check_results("dn_ab, dn_ac", ab.iter().chain(&ac))?;
        for (to, (of, columns)) in n.into_iter().zip([(&w.ab, n1), (&w.ac, n2)]) {
            let mut to = Output::new(to);
            of[..m].iter().for_each(|row| to.append(&row[..columns]));
        }
        dn.into_iter().zip([&ab, &ac]).for_each(|(to, of)| raw::write(to, of));
        Ok(())
    }

    fn read_weights(&self, of: [*const f64; 2], names: [&str; 2]) -> Result<ParentWeights> {
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
    fn optional_weights(&self, of: [*const f64; 2], names: [&str; 2]) -> Result<Option<ParentWeights>> {
        of.iter().any(|p| !p.is_null()).then(|| self.read_weights(of, names)).transpose()
    }

    /// Tractions of the multipliers.
    fn tractions(&self, p: *const f64) -> Result<[Vec3; MAX_PARENT_NODES]> {
        let mut t = [Vec3::zeros(); MAX_PARENT_NODES];
        let values = raw::numbers(p, 3 * self.counts().0, "traction")?;
        t.iter_mut().zip(values.chunks_exact(3)).for_each(|(t, v)| *t = Vec3::from_column_slice(v));
        Ok(t)
    }

    fn gap(&self, weights: [*const f64; 2], gap: *mut f64) -> Result<()> {
        let w = self.read_weights(weights, ["n_ab", "n_ac"])?;
        raw::check(gap, "gap")?;
        let g = self.pair().gap(&w);
        raw::check_results("gap", g.iter().flat_map(|g| g.iter()))?;
        raw::write_each(gap, g[..self.counts().0].iter().flat_map(|g| g.iter().copied()));
        Ok(())
    }

    fn residual(&self, weights: [*const f64; 2], traction: *const f64, force: *mut f64) -> Result<()> {
        let w = self.read_weights(weights, ["n_ab", "n_ac"])?;
        let (traction, (m, n1, n2)) = (self.tractions(traction)?, self.counts());
        raw::check(force, "force")?;
        let f = self.pair().force(&w, &traction[..m]);
        raw::check_results("force", f.iter().flat_map(|f| f.iter()))?;
        raw::write_each(force, f[..n1 + n2].iter().flat_map(|f| f.iter().copied()));
        Ok(())
    }

    fn tangent(
        &self,
        (n, dn): ([*const f64; 2], [*const f64; 2]),
        previous: [*const f64; 2],
        (traction, responses, row_scale): (*const f64, *const stickslip_node_response, *const f64),
        (k, ld): (*mut f64, i64),
    ) -> Result<()> {
        let (m, n1, n2) = self.counts();
        let column_major = column_major(self.raw.layout, "pair.layout")?;
        let mut k = Matrix::new(k, 3 * (n1 + n2 + m), ld, column_major)?;
        let now = self.optional_weights(n, ["n_ab", "n_ac"])?;
        let all = 3 * m * (n1 + n2);
        let slopes = match dn.iter().any(|p| !p.is_null()) {
            true => Some([raw::numbers(dn[0], all * n1, "dn_ab")?, raw::numbers(dn[1], all * n2, "dn_ac")?]),
            false => None,
        };
        let previous = self.optional_weights(previous, ["n_ab_previous", "n_ac_previous"])?;
        let traction = self.tractions(traction)?;
        let scale = raw::optional_numbers(row_scale, m, "row_scale")?;
        let mut nodes = [(Vec3::zeros(), Mat3::zeros(), Mat3::zeros()); MAX_PARENT_NODES];
        for (a, node) in nodes.iter_mut().enumerate().take(m) {
            let (now, previous) = read_response(responses, a)?;
            let s = scale.map_or(1.0, |s| s[a]);
            *node = (traction[a], now * s, previous * s);
        }
        let (pair, now) = (self.pair(), now.as_ref().map(|w| (w, slopes)));
        // Twice: nothing is written where a number is out of range.
        let mut finite = true;
        pair.tangent(now, previous.as_ref(), &nodes[..m], |_, _, block| finite &= block.iter().all(|v| v.is_finite()));
        if !finite {
            return raw::overflow("k");
        }
        pair.tangent(now, previous.as_ref(), &nodes[..m], |row, column, block| k.write(row, column, block));
        Ok(())
    }
}
