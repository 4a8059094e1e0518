//! A surface from the host's arrays.

use super::raw::{self, Member};
use super::sized::Sized64;
use crate::error::{Error, Kind, Result, Text};
use crate::geometry::{AnalyticShape, Vec3};
use crate::interface::{NO_EQUATION, Owner, Surface};
use crate::line::Measure;
use crate::memory::{self, Store, Stored};
use std::fmt::Display;

/// Of `owned` in `stickslip_surface`. The node's multiplier acts on the facets of this handle, and another handle adds the node's
/// own block; the sums over all handles make its gap (`stickslip_interface_sums`).
pub const STICKSLIP_NODE_SHARED: i32 = 0;
/// The node's multiplier acts here, and this handle adds the node's own block.
pub const STICKSLIP_NODE_OWN: i32 = 1;
/// The node's multiplier acts in another handle, which has all facets around the node: here it has no traction and no row.
/// Its equations are columns alone, those of a carrier (`weak_coverage`) and no others.
pub const STICKSLIP_NODE_ELSEWHERE: i32 = 2;

/// One surface of an interface.
///
/// An analytic mortar side (STICKSLIP_MORTAR_ANALYTIC) has n_nodes = 4 (of lines 3) and n_facets = 0; facet_offsets and facet_nodes
/// are NULL; equations are NULL or all -1, or those of a frame that `stickslip_rigid_create` puts together. Its nodes P0..P3 are a frame that is fixed to the surface and moves as a rigid
/// body, within 1e-8 of its lengths (INVALID_VALUE otherwise); to move the surface, move them. P0: a point of the
/// plane, the sphere's centre, a point of the axis. P1 - P0: the plane's normal, out of its body, or the direction of
/// the axis; of lines a point of the straight line and its normal, or the centre of the circle and any direction. The three edges
/// P1 - P0, P2 - P0, P3 - P0 must not lie in one plane, the two of lines not on one line; take them about as long as the contact
/// is wide. The points are rounded, and that moves the surface: by eps S D / a, with a the shortest of the edges, D
/// the distance from P0 to the farthest non-mortar node, and S the frame's distance from the origin or D, the larger. A
/// frame that moves it by more than 1e-8 of the longest facet edge is refused, INVALID_VALUE. The forces on these nodes
/// are statically equivalent to those on the surface. A facet takes part in a step when at t_n its normal opposes the
/// surface's to within 80 degrees, as between facets; it then counts as covered.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_surface {
    /// sizeof(stickslip_surface).
    pub struct_size: u64,
    /// Number of nodes; each must belong to a facet. Analytic: 4, of lines 3.
    pub n_nodes: i64,
    /// Number of facets. Analytic: 0.
    pub n_facets: i64,
    /// 3 n_nodes coordinates of the first configuration, node by node; 2 n_nodes of lines (`model` of `stickslip_options`) [L].
    pub coordinates: *const f64,
    /// n_facets + 1 offsets into facet_nodes, starting at 0 whatever the index base: facet f, counted from 0,
    /// has the entries facet_offsets[f] to facet_offsets[f + 1] - 1 of C's array; counted from 1, the
    /// entries facet_offsets(f) + 1 to facet_offsets(f + 1) of Fortran's.
    pub facet_offsets: *const i64,
    /// Node numbers in the index base, 3 (tri3), 4 (quad4), 6 (tri6), 8 (quad8) or 9 (quad9) a facet, right-hand order seen
    /// from outside the body: corners, then the mid nodes, k between the corners k and k + 1, then the centre. Of lines 2
    /// (line2) or 3 (line3): the ends, with the body to the left of the way from the first to the second, then the middle.
    pub facet_nodes: *const i64,
    /// 3 n_nodes displacement equations (of lines 2 n_nodes), node by node, in the index base; -1: none (prescribed), whatever
    /// the index base.
    pub equations: *const i64,
    /// Non-mortar: 3 n_nodes multiplier equations (of lines 2 n_nodes), each in use nowhere else in the interface; -1: the component is removed and its axis a constrained
    /// direction (see `stickslip_interface_set_constraints`); a node with three -1 keeps its normal. All are -1 at a node
    /// where no facet has a multiplier, as at the mid nodes of quadratic facets with STICKSLIP_SPACE_CORNER. With
    /// STICKSLIP_FRICTION_NONE n_nodes equations, one a node, along the normal; -1: none. A longer array cannot be told
    /// from a pointer: of 3 n_nodes the first n_nodes would be read as those of the nodes, without an error; so check that
    /// `multipliers` of `stickslip_interface_counters` is what you expect. Mortar: NULL.
    pub multiplier_equations: *const i64,
    /// Non-mortar, parallel hosts: where the multiplier of each of the n_nodes acts, STICKSLIP_NODE_...; NULL:
    /// STICKSLIP_NODE_OWN at all. Mortar: NULL.
    pub owned: *const i32,
}

// SAFETY: repr(C), struct_size first, integers and raw pointers only.
unsafe impl Sized64 for stickslip_surface {
    const NAME: &'static str = "stickslip_surface";
    const FIRST: usize = 72;
}

/// Equations per node, 0-based: the first `per` of N, which the caller has.
pub(super) fn read_equations<const N: usize>(
    p: *const i64,
    n: usize,
    (base, per): (i64, usize),
    name: impl Display,
) -> Result<Vec<[i64; N]>> {
    let values = raw::slice(p, per * n, &name)?;
    let mut equations = memory::filled([NO_EQUATION; N], n)?;
    let places = equations.iter_mut().flat_map(|of_node| of_node.iter_mut().take(per));
    for (k, (equation, &v)) in places.zip(values).enumerate() {
        if v == NO_EQUATION {
            continue;
        }
        if v < base {
            let text = text!("{name}[{k}] is {v}; -1 or at least {base} is allowed");
            return Err(Error::new(Kind::IndexOutOfRange, text));
        }
        *equation = v - base;
    }
    Ok(equations)
}

/// A checked surface; `side` is "nonmortar" or "mortar".
pub(super) fn read_surface(
    s: &stickslip_surface,
    base: i64,
    side: &'static str,
    measure: Option<Measure>,
) -> Result<Surface> {
    let (x, facets) = read_facets(s, base, side, measure.is_some())?;
    let per = if measure.is_some() { 2 } else { 3 };
    let equations = read_equations(s.equations, x.len(), (base, per), Member(side, "equations"))?;
    match measure {
        None => Surface::new(side, x, &facets, equations),
        Some(measure) => Surface::of_lines(side, x, &facets, equations, measure),
    }
}

/// A surface's coordinates and the nodes of its facets, from 0; `lines`: whether it has two coordinates a node.
pub(super) fn read_facets(
    s: &stickslip_surface,
    base: i64,
    side: &str,
    lines: bool,
) -> Result<(Vec<Vec3>, Vec<Vec<i64>>)> {
    let name = |member| Member(side, member);
    let (dimension, allowed, sizes) = match lines {
        true => (2, "2 or 3 with lines (options.model)", &[2, 3][..]),
        false => (3, "3, 4, 6, 8 or 9", &[3, 4, 6, 8, 9][..]),
    };
    let n = raw::count(s.n_nodes, dimension as i64, name("n_nodes"))?;
    let n_facets = raw::count(s.n_facets, 1, name("n_facets"))?;
    let coordinates = raw::numbers(s.coordinates, dimension * n, name("coordinates"))?;
    let offsets = raw::slice(s.facet_offsets, n_facets + 1, name("facet_offsets"))?;
    let wrong = |f: usize| {
        let text = text!("{side}.facet_offsets[{f}] is {}; offsets start at 0 and grow by {allowed}", offsets[f]);
        Error::new(Kind::InvalidSize, text)
    };
    if offsets[0] != 0 {
        return Err(wrong(0));
    }
    // Checked before anything is read through them: the last offset is the length of facet_nodes.
    if let Some(f) =
        (1..=n_facets).find(|&f| offsets[f].checked_sub(offsets[f - 1]).is_none_or(|n| !sizes.contains(&n)))
    {
        return Err(wrong(f));
    }
    let nodes = raw::slice(s.facet_nodes, offsets[n_facets] as usize, name("facet_nodes"))?;
    let mut facets = memory::with_room(n_facets)?;
    for f in 0..n_facets {
        let range = offsets[f] as usize..offsets[f + 1] as usize;
        let beyond = || Error::new(Kind::IndexOutOfRange, text!("{side}.facet_nodes of facet {f} is out of range"));
        let node = |k: &i64| k.checked_sub(base).ok_or_else(beyond);
        facets.store(nodes[range].iter().map(node).stored_if_ok()?)?;
    }
    Ok((coordinates.chunks_exact(dimension).map(position).stored()?, facets))
}

/// A checked analytic surface: the points of its frame, no facets.
pub(super) fn read_analytic(s: &stickslip_surface, shape: AnalyticShape, base: i64) -> Result<Surface> {
    let refuse = |kind, text: Text| Err(Error::new(kind, text));
    let (points, dimension) = (shape.points(), if shape.is_in_plane() { 2 } else { 3 });
    if s.n_nodes != points as i64 || s.n_facets != 0 {
        let text = text!(
            "mortar has n_nodes = {} and n_facets = {}; an analytic surface has {points} nodes, its frame, and no facets",
            s.n_nodes,
            s.n_facets
        );
        return refuse(Kind::InvalidSize, text);
    }
    if !s.facet_offsets.is_null() || !s.facet_nodes.is_null() {
        let text = "mortar.facet_offsets and mortar.facet_nodes must be NULL: an analytic surface has no facets";
        return refuse(Kind::InvalidValue, text.into());
    }
    let coordinates = raw::numbers(s.coordinates, dimension * points, "mortar.coordinates")?;
    let mut surface = Surface::analytic("mortar", shape, coordinates.chunks_exact(dimension).map(position).stored()?)?;
    if !s.equations.is_null() {
        surface.equations = read_equations::<3>(s.equations, points, (base, dimension), "mortar.equations")?;
    }
    Ok(surface)
}

/// A position of two or three coordinates.
fn position(x: &[f64]) -> Vec3 {
    Vec3::new(x[0], x[1], x.get(2).copied().unwrap_or(0.0))
}

/// Refuses multipliers on the mortar side, for the two surfaces may have been swapped, and of a skin, which numbers them itself.
pub(super) fn refuse_multipliers(surface: &stickslip_surface, side: &str) -> Result<()> {
    for (given, member) in
        [(!surface.multiplier_equations.is_null(), "multiplier_equations"), (!surface.owned.is_null(), "owned")]
    {
        if given {
            let text = text!(
                "{side}.{member} must be NULL: the non-mortar side of an interface alone has multipliers of the host's"
            );
            return Err(Error::new(Kind::InvalidValue, text));
        }
    }
    Ok(())
}

/// The non-mortar side's multiplier equations, of which the caller has `per` a node.
pub(super) fn read_multipliers<const N: usize>(s: &stickslip_surface, base: i64, per: usize) -> Result<Vec<[i64; N]>> {
    let n = raw::count(s.n_nodes, 2, "nonmortar.n_nodes")?;
    read_equations(s.multiplier_equations, n, (base, per), "nonmortar.multiplier_equations")
}

/// Where the multipliers of the non-mortar nodes act; `None`: here.
pub(super) fn read_owners(s: &stickslip_surface) -> Result<Option<Vec<Owner>>> {
    if s.owned.is_null() {
        return Ok(None);
    }
    let n = raw::count(s.n_nodes, 2, "nonmortar.n_nodes")?;
    let owner = |(a, &owned): (usize, &i32)| match owned {
        STICKSLIP_NODE_SHARED => Ok(Owner::Shared),
        STICKSLIP_NODE_OWN => Ok(Owner::Here),
        STICKSLIP_NODE_ELSEWHERE => Ok(Owner::Elsewhere),
        _ => {
            let text = text!("nonmortar.owned[{a}] is {owned}; a STICKSLIP_NODE_... constant is expected: 0, 1 or 2");
            Err(Error::new(Kind::InvalidValue, text))
        }
    };
    raw::slice(s.owned, n, "nonmortar.owned")?.iter().enumerate().map(owner).stored_if_ok().map(Some)
}
