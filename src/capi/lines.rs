//! A pair of lines of a plane or axisymmetric model, as a caller gives it to the functions of pairs (`pair.rs`).

use super::facet::check_distinct;
use super::method::rule;
use super::model::{measure, model};
use super::nodal::{self, Two};
use super::node::stickslip_node_response;
use super::pair_in::stickslip_pair;
use super::parents::check_linear_alone;
use super::raw::{self, Output};
use super::space::multiplier_space;
use crate::element::NodalPair;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec2;
use crate::line::{LineDerivatives, LineFacet, LineWeights, MAX_LINE_NODES, Measure};
use crate::mortar::MultiplierSpace;
use nalgebra::SMatrix;

/// Nodes of both lines, and with them the multipliers.
const NODES: usize = 2 * MAX_LINE_NODES;
const SLOTS: usize = 3 * MAX_LINE_NODES;

/// `stickslip_pair_weights`.
#[inline(never)]
pub(super) fn weights(given: &stickslip_pair, n: Two<*mut f64>, dn: Two<*mut f64>) -> Result<()> {
    let pair = Lines::of(given)?;
    for (p, name) in n.into_iter().chain(dn).zip(["n_ab", "n_ac", "dn_ab", "dn_ac"]) {
        raw::check_optional(p, name)?;
    }
    rule(given.quadrature, "pair.quadrature")?;
    let w = match dn.iter().all(|p| p.is_null()) {
        true => {
            let w = LineWeights::new(&pair.one, &pair.two, pair.space, pair.measure);
            check(&w)?;
            w
        }
        false => derivatives(&pair, dn)?,
    };
    nodal::write_weights(&pair.nodal(), [&w.ab, &w.ac], n);
    Ok(())
}

#[inline]
fn check(w: &LineWeights) -> Result<()> {
    raw::check_array("n_ab, n_ac", w.ab.as_flattened())?;
    raw::check_array("n_ab, n_ac", w.ac.as_flattened())
}

/// Writes derivatives, each pointer may be null, and gives the weights.
#[inline(never)]
fn derivatives(pair: &Lines, to: Two<*mut f64>) -> Result<LineWeights> {
    let (mut d, (one, two)) = (LineDerivatives::default(), (&pair.one, &pair.two));
    let w = d.add(one, two, pair.space, pair.measure);
    check(&w)?; // before anything is written
    for d in [&d.ab, &d.ac] {
        raw::check_array("dn_ab, dn_ac", d.as_flattened().as_flattened())?;
    }
    for (to, (d, columns)) in to.into_iter().zip([(&d.ab, one.n), (&d.ac, two.n)]) {
        let mut to = Output::new(to);
        for row in d[..one.multipliers(pair.space)].iter().flat_map(|rows| &rows[..columns]) {
            let (of_one, of_two) = row.split_at(2 * MAX_LINE_NODES);
            // Lengths that the compiler knows: no calls.
            for (of, n) in [(of_one, one.n), (of_two, two.n)] {
                if n == 2 { to.append(&of[..4]) } else { to.append(&of[..6]) }
            }
        }
    }
    Ok(w)
}

/// `stickslip_pair_gap`.
#[inline(never)]
pub(super) fn gap(given: &stickslip_pair, n: Two<*const f64>, gap: *mut f64) -> Result<()> {
    nodal::gap::<2, MAX_LINE_NODES>(&Lines::of(given)?.nodal(), n, gap)
}

/// `stickslip_pair_residual`.
#[inline(never)]
pub(super) fn residual(given: &stickslip_pair, n: Two<*const f64>, t: *const f64, force: *mut f64) -> Result<()> {
    let mut room = [Vec2::zeros(); NODES];
    nodal::residual::<2, MAX_LINE_NODES>(&Lines::of(given)?.nodal(), n, t, force, &mut room)
}

/// `stickslip_pair_tangent`.
#[inline(never)]
pub(super) fn tangent(
    given: &stickslip_pair,
    now: (Two<*const f64>, Two<*const f64>),
    previous: Two<*const f64>,
    at: (*const f64, *const stickslip_node_response, *const f64),
    (k, ld): (*mut f64, i64),
) -> Result<()> {
    let mut blocks = [SMatrix::zeros(); SLOTS * SLOTS];
    nodal::tangent::<2, MAX_LINE_NODES>(
        &Lines::of(given)?.nodal(),
        now,
        previous,
        at,
        (given.layout, k, ld),
        &mut blocks,
    )
}

/// Such a pair.
struct Lines {
    one: LineFacet,
    two: LineFacet,
    space: MultiplierSpace,
    measure: Measure,
}

impl Lines {
    /// A pair whose model is of lines.
    fn of(given: &stickslip_pair) -> Result<Lines> {
        let measure = measure(model(given.model, "pair.model")?, given.thickness, "pair.thickness")?;
        let Some(measure) = measure else { unreachable!("a model of lines") };
        let one = line(given.n1, given.x1, measure, "pair.x1")?;
        let two = line(given.n2, given.x2, measure, "pair.x2")?;
        check_linear_alone(given, "linear facets of solids")?;
        let space = multiplier_space(given.multiplier_space, "pair.multiplier_space")?;
        Ok(Lines { one, two, space, measure })
    }

    fn nodal(&self) -> NodalPair<'_, 2> {
        let (one, two) = (&self.one, &self.two);
        NodalPair { one: &one.x[..one.n], two: &two.x[..two.n], multipliers: one.multipliers(self.space) }
    }
}

/// A line from `n` points of an argument called `name`; allocates nothing.
#[inline]
fn line(n: i32, x: *const f64, measure: Measure, name: &str) -> Result<LineFacet> {
    if !(2..=MAX_LINE_NODES as i32).contains(&n) {
        let text = text!("{name} has {n} nodes; 2 (line2) or 3 (line3) are allowed in this model");
        return Err(Error::new(Kind::InvalidSize, text));
    }
    let nodes = raw::as_vectors::<2>(raw::numbers(x, 2 * n as usize, name)?);
    check_distinct(nodes, name)?;
    if let Some(k) = measure.beyond_axis(nodes) {
        let text = text!("{name}: node {k} has r = {}; no node lies beyond the axis, r = 0", nodes[k].x);
        return Err(Error::new(Kind::InvalidValue, text));
    }
    LineFacet::new(nodes).map_err(raw::named(name))
}
