//! A pair with a quadratic facet, as a caller gives it to the functions of pairs (`pair.rs`). Apart from linear pairs, whose calls
//! need no room for these.

use super::facet::parent;
use super::method::rule;
use super::nodal::{self, Two};
use super::node::stickslip_node_response;
use super::pair_in::stickslip_pair;
use super::raw;
use super::space::multiplier_space;
use crate::element::{NodalPair, ParentPair};
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::geometry::{Mat3, Vec3};
use crate::memory;
use crate::mortar::{MultiplierSpace, ParentFacet, parent_weights};
use crate::shape::MAX_PARENT_NODES;

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
    let [n_ab, n_ac] = if wants { nodal::derivatives(&pair.nodal()) } else { [0; 2] };
    let (mut ab, mut ac) = (memory::filled(0.0, n_ab)?, memory::filled(0.0, n_ac)?);
    let derivatives = wants.then_some([&mut ab[..], &mut ac[..]]);
    let w = parent_weights((&pair.one, &pair.two), pair.space, rule, derivatives).map_err(raw::named("pair"))?;
    raw::check_results("n_ab, n_ac", w.ab.as_flattened().iter().chain(w.ac.as_flattened()))?;
    raw::check_results("dn_ab, dn_ac", ab.iter().chain(&ac))?;
    nodal::write_weights(&pair.nodal(), [&w.ab, &w.ac], n);
    dn.into_iter().zip([&ab, &ac]).for_each(|(to, of)| raw::write(to, of));
    Ok(())
}

/// `stickslip_pair_gap`.
#[cold]
#[inline(never)]
pub(super) fn gap(given: &stickslip_pair, n: Two<*const f64>, gap: *mut f64) -> Result<()> {
    nodal::gap::<3, MAX_PARENT_NODES>(&Parents::of(given)?.nodal(), n, gap)
}

/// `stickslip_pair_residual`.
#[cold]
#[inline(never)]
pub(super) fn residual(given: &stickslip_pair, n: Two<*const f64>, t: *const f64, force: *mut f64) -> Result<()> {
    let mut room = [Vec3::zeros(); 2 * MAX_PARENT_NODES];
    nodal::residual::<3, MAX_PARENT_NODES>(&Parents::of(given)?.nodal(), n, t, force, &mut room)
}

/// `stickslip_pair_tangent`.
#[cold]
#[inline(never)]
pub(super) fn tangent(
    given: &stickslip_pair,
    now: (Two<*const f64>, Two<*const f64>),
    previous: Two<*const f64>,
    at: (*const f64, *const stickslip_node_response, *const f64),
    (k, ld): (*mut f64, i64),
) -> Result<()> {
    let pair = Parents::of(given)?;
    let mut blocks = memory::filled(Mat3::zeros(), pair.nodal().size().pow(2))?;
    nodal::tangent::<3, MAX_PARENT_NODES>(&pair.nodal(), now, previous, at, (given.layout, k, ld), &mut blocks)
}

/// Such a pair.
struct Parents {
    one: ParentFacet,
    two: ParentFacet,
    space: MultiplierSpace,
}

impl Parents {
    fn of(given: &stickslip_pair) -> Result<Parents> {
        features::needs!(QUADRATIC);
        let (one, two) = (parent(given.n1, given.x1, "pair.x1")?, parent(given.n2, given.x2, "pair.x2")?);
        check_linear_alone(given, "linear facets")?;
        Ok(Parents { one, two, space: multiplier_space(given.multiplier_space, "pair.multiplier_space")? })
    }

    fn nodal(&self) -> NodalPair<'_, 3> {
        ParentPair { one: &self.one, two: &self.two, multipliers: self.one.multipliers(self.space) }.nodal()
    }
}

/// Refuses what pairs of linear facets of a solid take alone.
pub(super) fn check_linear_alone(given: &stickslip_pair, who: &str) -> Result<()> {
    if given.element_points != 0 || !given.neighbour_normals.is_null() {
        let text = text!("pair.element_points and pair.neighbour_normals are for {who}; leave them 0 and NULL");
        return Err(Error::new(Kind::Unsupported, text));
    }
    Ok(())
}
