//! Surfaces that are not where their meshes are: offsets of nodes, gaps that are closed at the start, shapes of facets.

use super::choice::choose;
use super::guard::guard;
use super::handle::{dimension, either, flat, handle, sizes, stickslip_interface};
use super::raw;
use crate::error::{Error, Kind, Result};
use crate::geometry::{AnalyticShape, AnalyticSurface, Vec3};
use crate::interface::Adjusted;
use crate::memory::{self, Stored};

/// Of `stickslip_interface_adjust`. Along the node's normal there is no mortar facet that looks at it.
pub const STICKSLIP_ADJUST_ALONE: i32 = 0;
/// The node is farther from the mortar surface than the tolerance, and stays where it is.
pub const STICKSLIP_ADJUST_LEFT: i32 = 1;
/// The node was moved onto the mortar surface.
pub const STICKSLIP_ADJUST_MOVED: i32 = 2;

/// Side of an interface: the non-mortar one.
pub const STICKSLIP_SIDE_NONMORTAR: i32 = 0;
/// Side of an interface: the mortar one.
pub const STICKSLIP_SIDE_MORTAR: i32 = 1;

/// Offsets of the nodes of both sides: how far the surface that is meant lies behind the meshed one, along its normal into the
/// body [L]. They open gaps where they are positive (a clearance) and close them where they are negative (an interference, half
/// the thickness of a shell, the rise of a curve over its facets). A non-mortar node's gap becomes g_A + nu_A o_A with
/// o_A = sum_B n_AB h_B + sum_C n_AC h_C; residual, tangent, states and `stickslip_interface_sums` have it, slip has none of
/// it. Of tied surfaces it is what they are pressed together or apart by, from where they started.
///
/// offsets1 (n1), offsets2 (n2) [L], of the non-mortar and of the mortar nodes: from the next evaluation on, in place of all earlier ones; NULL, or 0 at all nodes: none,
/// and no cost. Set larger ones step by step to apply an interference slowly. Pairs are sought as deep, and as far, as the
/// offsets need. Where a clearance is more than a facet set them before the first commit and before
/// `stickslip_interface_set_committed` is called. Else nodes whose pairs are found too late count as uncovered at t_n, and frozen
/// weights stay as they are. Not part of
/// the history: set them again after a restart, before its import. Not of an analytic mortar side, whose shape or place says the
/// same. On several processes each handle needs those of all of its nodes.
///
/// Not with (UNSUPPORTED): conserving weights (STICKSLIP_WEIGHTS_CONSERVING).
///
/// Errors: NULL_POINTER, NOT_FINITE, UNSUPPORTED, and where pairs are sought anew those of `stickslip_interface_set_previous`.
/// Cost: a copy; where the largest offsets change, one search. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_offsets(
    interface: *mut stickslip_interface,
    offsets1: *const f64,
    offsets2: *const f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let (n1, n2) = sizes(&h.inner);
        let one = raw::optional_numbers(offsets1, n1, "offsets1")?.map(memory::copied).transpose()?;
        let two = raw::optional_numbers(offsets2, n2, "offsets2")?.map(memory::copied).transpose()?;
        either!(&mut h.inner, c => c.set_offsets([one, two]))
    })
}

/// Closes gaps and overlaps of the first configuration without strain: non-mortar nodes within `tolerance` of the mortar surface,
/// along their normals, are put onto it. It changes nothing in the handle: mesh and interface are the host's to make anew with
/// the new coordinates. For parts that are drawn a little apart, or a little into each other, and for tied surfaces that should
/// not keep a gap. Gaps that are meant belong into `stickslip_interface_set_offsets`.
///
/// tolerance: above 0 [L]. Outputs, each or NULL: coordinates (3 n1; of lines 2 n1) [L] of the non-mortar nodes; gaps (n1) [L]:
/// the distance before, positive where open, 0 where there is none; moved (n1): STICKSLIP_ADJUST_... The distance is measured to
/// the nearest mortar facet, or part of a facet, that the node's normal meets and that looks at it. On flat surfaces every gap of
/// moved nodes is closed, whatever the meshes; between curved ones that do not match what the facets' chords leave stays.
///
/// Errors: NULL_POINTER, INVALID_VALUE (a tolerance that is not positive, or that moves a node by more than the shortest edge
/// around it; the message names the node), UNDEFINED_NORMAL.
/// Cost: O((n1 + n2) log n2); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_adjust(
    interface: *mut stickslip_interface,
    tolerance: f64,
    coordinates: *mut f64,
    gaps: *mut f64,
    moved: *mut i32,
) -> i32 {
    guard(|| {
        let h = &mut handle(interface)?.inner;
        raw::check_optional(coordinates, "coordinates")?;
        raw::check_optional(gaps, "gaps")?;
        raw::check_optional(moved, "moved")?;
        let nodes: Vec<Adjusted> = either!(h, c => c.adjusted(tolerance)?);
        let x: Vec<Vec3> = nodes.iter().map(|node| node.x).stored()?;
        let x: Vec<f64> = flat(&x, dimension(h)).stored()?;
        raw::check_results("coordinates", &x)?;
        if !coordinates.is_null() {
            raw::write(coordinates, &x);
        }
        if !gaps.is_null() {
            raw::write_each(gaps, nodes.iter().map(|node| node.gap.unwrap_or(0.0)));
        }
        if !moved.is_null() {
            let kind = |node: &Adjusted| match (node.gap, node.moved) {
                (None, _) => STICKSLIP_ADJUST_ALONE,
                (_, false) => STICKSLIP_ADJUST_LEFT,
                (_, true) => STICKSLIP_ADJUST_MOVED,
            };
            raw::write_each(moved, nodes.iter().map(kind));
        }
        Ok(())
    })
}

/// Offsets that give a faceted surface the shape that it was meshed from: of each node the mean of the signed distance of its
/// facets from the shape, weighted with the node's function, in the first configuration. Facets are chords: a shaft's lie inside
/// it, so that it is too thin by h^2 / (12 R) in the mean, and a bore's lie in the hole. Give the result to
/// `stickslip_interface_set_offsets`.
///
/// side: STICKSLIP_SIDE_... whose nodes they are. shape: STICKSLIP_SHAPE_SPHERE or _CYLINDER; radius [L]: above 0 of a ball or a
/// bar, below 0 of a cavity or a bore. point (3) [L]: the centre, or a point of the axis; direction (3) [-]: of the axis, any
/// length but 0 (of a sphere any). Of lines a circle is a cylinder along z or a sphere, and point[2] is 0. offsets, output (n1 or n2) [L].
///
/// Errors: NULL_POINTER, NOT_FINITE, INVALID_VALUE (side, shape, radius, direction, of lines point; a node that is farther from the shape than the
/// longest facet is long; a facet that looks into the shape's body), UNSUPPORTED (a plane; facets with mid nodes, which lie on a shape by themselves; an analytic side).
/// Cost: O(n); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_shape_offsets(
    interface: *mut stickslip_interface,
    side: i32,
    shape: i32,
    radius: f64,
    point: *const f64,
    direction: *const f64,
    offsets: *mut f64,
) -> i32 {
    guard(|| {
        let h = &mut handle(interface)?.inner;
        let side = choose(side, "side", &[0_usize, 1], 2)?;
        let shape = round_shape(shape, radius)?;
        let point = Vec3::from_column_slice(raw::numbers(point, 3, "point")?);
        let direction = Vec3::from_column_slice(raw::numbers(direction, 3, "direction")?);
        raw::check(offsets, "offsets")?;
        if dimension(h) == 2 {
            check_in_plane(shape, point, direction)?;
        }
        let values = either!(h, c => c.shape_offsets(side, &placed(shape, point, direction)?)?);
        raw::check_results("offsets", &values)?;
        raw::write(offsets, &values);
        Ok(())
    })
}

fn round_shape(shape: i32, radius: f64) -> Result<AnalyticShape> {
    let shapes = [AnalyticShape::Plane, AnalyticShape::Sphere(radius), AnalyticShape::Cylinder(radius)];
    match choose(shape, "shape", &shapes, 3)? {
        AnalyticShape::Plane => {
            Err(Error::new(Kind::Unsupported, "shape is a plane: flat facets lie on it, and need no offsets"))
        }
        _ if !(radius.is_finite() && radius != 0.0) => {
            let text = text!("radius is {radius}; above 0 (a ball, a bar) or below 0 (a cavity, a bore) is allowed");
            Err(Error::new(Kind::InvalidValue, text))
        }
        shape => Ok(shape),
    }
}

/// Lines lie in the plane z = 0, and so does the centre of their circle.
fn check_in_plane(shape: AnalyticShape, point: Vec3, direction: Vec3) -> Result<()> {
    if point.z != 0.0 {
        let text = text!("point[2] is {}; of lines, which lie in the plane z = 0, 0 is allowed", point.z);
        return Err(Error::new(Kind::InvalidValue, text));
    }
    if matches!(shape, AnalyticShape::Cylinder(_)) && (direction.x != 0.0 || direction.y != 0.0) {
        let text =
            text!("direction is ({}, {}, {}); of lines a cylinder is along z", direction.x, direction.y, direction.z);
        return Err(Error::new(Kind::InvalidValue, text));
    }
    Ok(())
}

/// A shape at a point, about an axis.
fn placed(shape: AnalyticShape, point: Vec3, direction: Vec3) -> Result<AnalyticSurface> {
    let length = direction.norm();
    if !(length > 0.0 && length.is_finite()) {
        let text = text!("direction has length {length}; it must be finite and not zero");
        return Err(Error::new(Kind::InvalidValue, text));
    }
    let axis = direction / length;
    let across = if axis.x.abs() < 0.7 { Vec3::x() } else { Vec3::y() };
    let one = axis.cross(&across).normalize();
    let edges = [axis, one, axis.cross(&one)].map(|edge| point + edge * shape.radius().abs());
    AnalyticSurface::new(shape, &[point, edges[0], edges[1], edges[2]])
}
