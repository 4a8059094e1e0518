//! A facet's share of nodal normals and areas, for hosts that assemble them themselves.

use super::guard::guard;
use super::raw;
use crate::error::{Error, Kind, Result};
use crate::geometry::{Facet, Plane, Vec3};
use crate::mortar::{MultiplierSpace, NonmortarFrame, ParentFacet};
use crate::normal;
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES, Parent, Shape};
use nalgebra::SVector;

/// Refuses nodes at the same place.
#[inline]
pub(super) fn check_distinct<const D: usize>(nodes: &[SVector<f64, D>], name: &str) -> Result<()> {
    match (1..nodes.len()).find(|&k| nodes[..k].contains(&nodes[k])) {
        None => Ok(()),
        Some(k) => Err(Error::new(Kind::DuplicateNode, text!("{name} has two nodes at the same place (node {k})"))),
    }
}

/// A facet from `n` points of an argument called `name`; allocates nothing.
pub(super) fn facet(n: i32, x: *const f64, name: &str) -> Result<Facet> {
    if !(3..=MAX_CORNERS as i32).contains(&n) {
        let text = text!("{name} has {n} nodes; 3 (tri3) or 4 (quad4) are allowed");
        return Err(Error::new(Kind::InvalidSize, text));
    }
    let n = n as usize;
    let values = raw::numbers(x, 3 * n, name)?;
    let Some(shape) = Shape::of(n) else { unreachable!("3 or 4 nodes") };
    let at = |k: usize| Vec3::new(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
    let nodes = [at(0), at(1), at(2), at(if n == 4 { 3 } else { 0 })];
    check_distinct(&nodes[..n], name)?;
    Ok(Facet { nodes, shape })
}

/// A facet as hosts have it, from `n` points of an argument called `name`; allocates nothing.
pub(super) fn parent(n: i32, x: *const f64, name: &str) -> Result<ParentFacet> {
    let Some(kind) = usize::try_from(n).ok().and_then(Parent::of) else {
        let text = text!("{name} has {n} nodes; 3 (tri3), 4 (quad4), 6 (tri6), 8 (quad8) or 9 (quad9) are allowed");
        return Err(Error::new(Kind::InvalidSize, text));
    };
    let values = raw::numbers(x, 3 * kind.n, name)?;
    let mut nodes = [Vec3::zeros(); MAX_PARENT_NODES];
    nodes.iter_mut().zip(values.chunks_exact(3)).for_each(|(x, v)| *x = Vec3::from_column_slice(v));
    check_distinct(&nodes[..kind.n], name)?;
    ParentFacet::new(&nodes[..kind.n]).map_err(raw::named(name))
}

/// Far above the rounding of a normalisation, far below any angle that matters.
const UNIT: f64 = 1e-10;

/// Gives a frame what is known of the facets beyond its facet's edges; `name` is that of the argument.
pub(super) fn set_neighbours(frame: &mut NonmortarFrame, neighbour_normals: *const f64, name: &str) -> Result<()> {
    if neighbour_normals.is_null() {
        return Ok(());
    }
    let normals = raw::numbers(neighbour_normals, 3 * frame.projection.shape.n, name)?;
    for (k, normal) in normals.chunks_exact(3).enumerate() {
        let normal = Vec3::from_column_slice(normal);
        let (length, is_known) = (normal.norm(), normal != Vec3::zeros());
        if is_known && !((length - 1.0).abs() <= UNIT) {
            let text = text!("{name} of edge {k} has length {length}; it must be 1, or 0 for none");
            return Err(Error::new(Kind::InvalidValue, text));
        }
        frame.plane.beyond[k] = is_known.then_some(normal);
    }
    Ok(())
}

/// A non-mortar facet's share of its nodes' normals and areas.
///
/// n: 3, 4, 6, 8 or 9 (`stickslip_pair`); x: 3 n coordinates [L]. Outputs, each may be NULL: normals (3 n) [-], unit
/// normals at the nodes, out of the body, to be summed over the facets around a node for `stickslip_node_normal`; areas (n;
/// of a quadratic facet 3 or 4, those of its corners with STICKSLIP_SPACE_CORNER) int N_A da over the facet [L^2], to be
/// summed to M_A. (With STICKSLIP_SPACE_SUB areas are those of the facet's parts, each a linear facet.)
///
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET.
/// Cost: below a microsecond, of a quadratic facet some; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_facet_geometry(n: i32, x: *const f64, normals: *mut f64, areas: *mut f64) -> i32 {
    guard(|| {
        raw::check_optional(normals, "normals")?;
        raw::check_optional(areas, "areas")?;
        if n > MAX_CORNERS as i32 {
            let facet = parent(n, x, "x")?;
            let of_corners = facet.areas(MultiplierSpace::Corner).map_err(raw::named("x"))?;
            let found: [Vec3; MAX_PARENT_NODES] = std::array::from_fn(|k| facet.normal(k % facet.parent.n));
            raw::check_results("normals", found.iter().flat_map(|v| v.iter()))?;
            raw::check_results("areas", &of_corners)?;
            raw::write_each(normals, found[..facet.parent.n].iter().flat_map(|v| v.iter().copied()));
            raw::write(areas, &of_corners[..facet.parent.corners()]);
            return Ok(());
        }
        let facet = facet(n, x, "x")?;
        let frame = NonmortarFrame::new(&facet).map_err(raw::named("x"))?;
        let corners: [Vec3; MAX_CORNERS] = std::array::from_fn(|k| normal::corner_normal(&facet, k % facet.len()));
        raw::write_each(normals, corners[..facet.len()].iter().flat_map(|v| v.iter().copied()));
        raw::write(areas, &frame.nodal_areas()[..facet.len()]);
        Ok(())
    })
}

/// The unit normal of a facet's auxiliary plane, out of its body: (x2 - x1) x (x3 - x1) of a tri3, (x3 - x1) x (x4 - x2) of
/// a quad4, over its length. For `neighbour_normals` of `stickslip_pair`.
///
/// n: 3 or 4; x: 3 n coordinates [L]. normal (3) [-], output.
///
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET.
/// Cost: nanoseconds; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_facet_normal(n: i32, x: *const f64, normal: *mut f64) -> i32 {
    guard(|| {
        let facet = facet(n, x, "x")?;
        raw::check(normal, "normal")?;
        let plane = Plane::of(&facet).map_err(raw::named("x"))?;
        raw::check_results("normal", plane.e.iter())?;
        raw::write(normal, plane.e.as_slice());
        Ok(())
    })
}

/// The nodal normal nu_A (unit, INTO the non-mortar body) from the sum of the corner normals around a
/// node.
///
/// sum (3) [-]; normal (3) [-], output.
///
/// Errors: NULL_POINTER, NOT_FINITE, UNDEFINED_NORMAL (the normals cancel).
/// Cost: nanoseconds; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_node_normal(sum: *const f64, normal: *mut f64) -> i32 {
    guard(|| {
        let sum = raw::numbers(sum, 3, "sum")?;
        raw::check(normal, "normal")?;
        let nu = normal::nodal_normal(Vec3::from_column_slice(sum), 0)?;
        raw::write(normal, nu.as_slice());
        Ok(())
    })
}
