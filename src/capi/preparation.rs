//! Stateless help before interfaces are created: creases, nodes that interfaces share.

use super::guard::guard;
use super::surface::{read_facets, stickslip_surface};
use super::{raw, sized};
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::interface::{InterfaceNodes, Surface, crosspoints};
use crate::line::Measure;
use crate::memory::{self, Stored};

/// Splits the nodes on creases of a non-mortar surface: gives each fan of facets that look nearly the same way nodes of
/// its own, until no two corner normals around a node differ by more than angle. A node of a sharp edge or corner then
/// has one averaged normal, gap and multiplier for each side; without, it has a compromise, or none at all
/// (UNDEFINED_NORMAL).
///
/// surface: n_nodes, n_facets, coordinates, facet_offsets and facet_nodes are read, in index_base (0 or 1). angle:
/// above 0 and below pi, in radians [-]; 40 degrees (0.7) splits what is drawn as an edge. Outputs: facet_nodes, the
/// new node numbers in index_base, as many as the surface has and with the same offsets (the surface's own array will
/// do); originals (n_nodes of the new surface, its length capacity): the old number of each new node, in index_base.
/// The old nodes keep their numbers, copies come behind them. count: nodes of the new surface. With facet_nodes and
/// originals both NULL only count is written.
///
/// The new surface takes coordinates and displacement equations of the originals (several nodes with the same
/// equations; forces add up) and multiplier equations of its own for every copy, in contact or not: the number of unknowns
/// stays. A copy that touches nothing has the row lambda = 0. By the equations the interface knows copies: one that is in
/// contact alone has friction as any other node; in a step in which two may be in contact, they act without (where both
/// stick, six conditions meet three displacements). Tied surfaces need no split.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, INDEX_OUT_OF_RANGE, DUPLICATE_NODE, INVALID_VALUE (the
/// angle, the index base, or a surface that no interface takes), BUFFER_TOO_SMALL.
/// Cost: O(n log n), and O(k^2) for the k facets around a node; allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_surface_split_creases(
    surface: *const stickslip_surface,
    angle: f64,
    index_base: i32,
    capacity: i64,
    facet_nodes: *mut i64,
    originals: *mut i64,
    count: *mut i64,
) -> i32 {
    guard(|| split((surface, None), angle, index_base, Outputs { capacity, facet_nodes, originals, count }))
}

/// `stickslip_surface_split_creases` for the lines of a plane or axisymmetric model: n_nodes points of two coordinates and
/// facets of 2 or 3 nodes, as `stickslip_interface_create` takes them with these models. A node whose two lines meet at
/// more than angle is listed once for each; lines with a node in the middle are not split there. index_base, capacity,
/// the outputs facet_nodes, originals and count, and what the new surface takes: as there.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, INDEX_OUT_OF_RANGE, DUPLICATE_NODE, INVALID_VALUE (the
/// angle, the index base, or a surface that no interface takes), UNSUPPORTED (a build without lines), BUFFER_TOO_SMALL.
/// Cost: O(n log n); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_lines_split_creases(
    surface: *const stickslip_surface,
    angle: f64,
    index_base: i32,
    capacity: i64,
    facet_nodes: *mut i64,
    originals: *mut i64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(LINES);
        // Which way a corner of a line looks does not depend on what the line stands for.
        let measure = Some(Measure::Thickness(1.0));
        split((surface, measure), angle, index_base, Outputs { capacity, facet_nodes, originals, count })
    })
}

/// Where a split surface goes.
struct Outputs {
    capacity: i64,
    facet_nodes: *mut i64,
    originals: *mut i64,
    count: *mut i64,
}

/// Splits a surface, of lines where these have a measure.
fn split(
    (surface, measure): (*const stickslip_surface, Option<Measure>),
    angle: f64,
    index_base: i32,
    to: Outputs,
) -> Result<()> {
    raw::check(surface, "surface")?;
    raw::check(to.count, "count")?;
    let base = read_base(index_base)?;
    let (x, facets) = read_facets(&sized::read(surface)?, base, "surface", measure.is_some())?;
    let equations = memory::filled([crate::interface::NO_EQUATION; 3], x.len())?;
    let surface = match measure {
        None => Surface::new("surface", x, &facets, equations),
        Some(measure) => Surface::of_lines("surface", x, &facets, equations, measure),
    };
    let split = surface?.split_creases(angle)?;
    let n = split.originals.len();
    if !(to.facet_nodes.is_null() && to.originals.is_null()) {
        raw::check(to.facet_nodes, "facet_nodes")?;
        raw::check(to.originals, "originals")?;
        raw::room(to.capacity, n, "originals")?;
        raw::write_each(to.facet_nodes, split.facet_nodes.iter().map(|&k| k as i64 + base));
        raw::write_each(to.originals, split.originals.iter().map(|&k| k as i64 + base));
    }
    raw::write(to.count, &[n as i64]);
    Ok(())
}

/// Kind of a shared node: non-mortar in more than one interface. Where it sticks or is tied in two of them, six
/// conditions meet three displacements: leave it its multipliers in one of them and give it -1 in the others, or, where
/// their normals differ, let it be without friction in all. Interfaces that are condensed must have none: give it multipliers in
/// one of them alone.
pub const STICKSLIP_CROSSPOINT_CLAIMED: i32 = 1;
/// Kind of a shared node: non-mortar in one interface, mortar in another one, a link of a chain. Fine; where they are condensed,
/// the one in which it is mortar comes first.
pub const STICKSLIP_CROSSPOINT_CHAIN: i32 = 2;
/// Kind of a shared node: on both sides of the same interface. It touches itself: leave the facets around it out of one
/// side.
pub const STICKSLIP_CROSSPOINT_BOTH_SIDES: i32 = 4;

/// The nodes that several interfaces of a host share in a way that matters (crosspoints). Nodes that are mortar alone,
/// in however many interfaces, do not.
///
/// n_interfaces: how many. nonmortar_offsets (n_interfaces + 1), starting at 0: interface k has the entries
/// nonmortar_offsets[k] to nonmortar_offsets[k + 1] - 1 of nonmortar_nodes, any numbers of the host's, each as often as
/// it likes (copies of a node on a crease are one node); mortar_offsets and mortar_nodes the same of the other sides.
/// Outputs (capacity entries each): nodes, ascending, kinds: sums of STICKSLIP_CROSSPOINT_..., claims: in how many
/// interfaces the node is non-mortar; count: how many nodes. With nodes, kinds and claims all NULL only count is
/// written.
///
/// Errors: NULL_POINTER, INVALID_SIZE (n_interfaces, offsets that do not start at 0 or decrease), BUFFER_TOO_SMALL.
/// Cost: O(n log n); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_crosspoints_find(
    n_interfaces: i64,
    nonmortar_offsets: *const i64,
    nonmortar_nodes: *const i64,
    mortar_offsets: *const i64,
    mortar_nodes: *const i64,
    capacity: i64,
    nodes: *mut i64,
    kinds: *mut i32,
    claims: *mut i64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        let n = raw::count(n_interfaces, 1, "n_interfaces")?;
        raw::check(count, "count")?;
        let one = read_lists(nonmortar_offsets, nonmortar_nodes, n, "nonmortar")?;
        let two = read_lists(mortar_offsets, mortar_nodes, n, "mortar")?;
        let both = one.into_iter().zip(two);
        let found = crosspoints(&both.map(|(nonmortar, mortar)| InterfaceNodes { nonmortar, mortar }).stored()?)?;
        if !(nodes.is_null() && kinds.is_null() && claims.is_null()) {
            raw::check(nodes, "nodes")?;
            raw::check(kinds, "kinds")?;
            raw::check(claims, "claims")?;
            raw::room(capacity, found.len(), "nodes, kinds and claims")?;
            let kind = |bit: i32, set: bool| if set { bit } else { 0 };
            raw::write_each(nodes, found.iter().map(|p| p.node));
            raw::write_each(claims, found.iter().map(|p| p.claims));
            raw::write_each(
                kinds,
                found.iter().map(|p| {
                    kind(STICKSLIP_CROSSPOINT_CLAIMED, p.claimed_twice)
                        | kind(STICKSLIP_CROSSPOINT_CHAIN, p.chain)
                        | kind(STICKSLIP_CROSSPOINT_BOTH_SIDES, p.both_sides)
                }),
            );
        }
        raw::write(count, &[found.len() as i64]);
        Ok(())
    })
}

pub(super) fn read_base(index_base: i32) -> Result<i64> {
    match index_base {
        0 | 1 => Ok(index_base.into()),
        other => Err(Error::new(Kind::InvalidValue, text!("index_base is {other}; it must be 0 or 1"))),
    }
}

/// `n` lists of nodes, one after the other.
fn read_lists<'a>(offsets: *const i64, nodes: *const i64, n: usize, side: &str) -> Result<Vec<&'a [i64]>> {
    let name = format_args!("{side}_offsets");
    let offsets = raw::slice(offsets, n + 1, name)?;
    let wrong = |k: usize| {
        let text = text!("{name}[{k}] is {}; offsets start at 0 and do not decrease", offsets[k]);
        Error::new(Kind::InvalidSize, text)
    };
    if offsets[0] != 0 {
        return Err(wrong(0));
    }
    if let Some(k) = (1..=n).find(|&k| offsets[k] < offsets[k - 1]) {
        return Err(wrong(k));
    }
    let all = if offsets[n] == 0 { &[] } else { raw::slice(nodes, offsets[n] as usize, format_args!("{side}_nodes"))? };
    offsets.windows(2).map(|o| &all[o[0] as usize..o[1] as usize]).stored()
}
