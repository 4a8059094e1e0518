//! A surface from the host's arrays.

use super::raw;
use super::sized::Sized64;
use crate::error::{Error, Kind, Result};
use crate::interface::{NO_EQUATION, Surface};

/// One surface of an interface.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_surface {
    /// sizeof(stickslip_surface).
    pub struct_size: u64,
    /// Number of nodes; each must belong to a facet.
    pub n_nodes: i64,
    /// Number of facets.
    pub n_facets: i64,
    /// 3 n_nodes coordinates of the first configuration, node by node [L].
    pub coordinates: *const f64,
    /// n_facets + 1 offsets into facet_nodes, starting at 0 whatever the index base: facet f, counted from 0,
    /// has the entries facet_offsets[f] to facet_offsets[f + 1] - 1 of C's array; counted from 1, the
    /// entries facet_offsets(f) + 1 to facet_offsets(f + 1) of Fortran's.
    pub facet_offsets: *const i64,
    /// Node numbers in the index base, 3 (tri3) or 4 (quad4) a facet, right-hand order seen from outside
    /// the body.
    pub facet_nodes: *const i64,
    /// 3 n_nodes displacement equations, node by node, in the index base; -1: none (prescribed), whatever the
    /// index base.
    pub equations: *const i64,
    /// Non-mortar: 3 n_nodes multiplier equations, -1: the component is removed and its axis a constrained
    /// direction (see `stickslip_interface_set_constraints`); a node with three -1 keeps its normal. Mortar:
    /// NULL.
    pub multiplier_equations: *const i64,
    /// Non-mortar, parallel hosts: n_nodes flags, 1 where this handle adds the node's own block; NULL:
    /// all. Mortar: NULL.
    pub owned: *const i32,
}

// SAFETY: repr(C), struct_size first, integers and raw pointers only.
unsafe impl Sized64 for stickslip_surface {
    const NAME: &'static str = "stickslip_surface";
    const FIRST: usize = 72;
}

/// Three equations per node, 0-based.
fn equations(p: *const i64, n: usize, base: i64, name: &str) -> Result<Vec<[i64; 3]>> {
    let values = raw::slice(p, 3 * n, name)?;
    let convert = |k: usize| {
        let v = values[k];
        if v == NO_EQUATION {
            Ok(NO_EQUATION)
        } else if v < base {
            Err(Error::new(Kind::IndexOutOfRange, format!("{name}[{k}] is {v}; -1 or at least {base} is allowed")))
        } else {
            Ok(v - base)
        }
    };
    (0..n).map(|a| Ok([convert(3 * a)?, convert(3 * a + 1)?, convert(3 * a + 2)?])).collect()
}

/// A checked surface; `side` is "nonmortar" or "mortar".
pub(super) fn read_surface(s: &stickslip_surface, base: i64, side: &'static str) -> Result<Surface> {
    let name = |member: &str| format!("{side}.{member}");
    let n = raw::count(s.n_nodes, 3, &name("n_nodes"))?;
    let n_facets = raw::count(s.n_facets, 1, &name("n_facets"))?;
    let coordinates = raw::numbers(s.coordinates, 3 * n, &name("coordinates"))?;
    let offsets = raw::slice(s.facet_offsets, n_facets + 1, &name("facet_offsets"))?;
    let wrong = |f: usize| {
        let text = format!("{side}.facet_offsets[{f}] is {}; offsets start at 0 and grow by 3 or 4", offsets[f]);
        Error::new(Kind::InvalidSize, text)
    };
    if offsets[0] != 0 {
        return Err(wrong(0));
    }
    // Checked before anything is read through them: the last offset is the length of facet_nodes.
    if let Some(f) = (1..=n_facets).find(|&f| !matches!(offsets[f].checked_sub(offsets[f - 1]), Some(3 | 4))) {
        return Err(wrong(f));
    }
    let nodes = raw::slice(s.facet_nodes, offsets[n_facets] as usize, &name("facet_nodes"))?;
    let mut facets = Vec::with_capacity(n_facets);
    for f in 0..n_facets {
        let range = offsets[f] as usize..offsets[f + 1] as usize;
        let facet: Option<Vec<i64>> = nodes[range].iter().map(|k| k.checked_sub(base)).collect();
        facets.push(facet.ok_or_else(|| {
            Error::new(Kind::IndexOutOfRange, format!("{side}.facet_nodes of facet {f} is out of range"))
        })?);
    }
    let equations = equations(s.equations, n, base, &name("equations"))?;
    Surface::new(side, raw::vectors(coordinates), &facets, equations)
}

/// Refuses multipliers on the mortar side: the two surfaces may have been swapped.
pub(super) fn refuse_multipliers(mortar: &stickslip_surface) -> Result<()> {
    for (given, member) in
        [(!mortar.multiplier_equations.is_null(), "multiplier_equations"), (!mortar.owned.is_null(), "owned")]
    {
        if given {
            let text = format!("mortar.{member} must be NULL: only the non-mortar side carries multipliers");
            return Err(Error::new(Kind::InvalidValue, text));
        }
    }
    Ok(())
}

/// Multiplier equations, and which nodes are owned (`None`: all).
type Multipliers = (Vec<[i64; 3]>, Option<Vec<bool>>);

/// The non-mortar side's multipliers.
pub(super) fn read_multipliers(s: &stickslip_surface, base: i64) -> Result<Multipliers> {
    let n = raw::count(s.n_nodes, 3, "nonmortar.n_nodes")?;
    let multipliers = equations(s.multiplier_equations, n, base, "nonmortar.multiplier_equations")?;
    let owned = if s.owned.is_null() {
        None
    } else {
        Some(raw::slice(s.owned, n, "nonmortar.owned")?.iter().map(|&o| o != 0).collect())
    };
    Ok((multipliers, owned))
}
