//! What cannot be condensed, by name: multipliers are eliminated with the rows of their nodes, which must be there and serve
//! one multiplier each.

use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::compose::Feature;
use crate::interface::data::multiplier::direction;
use crate::interface::data::surface::NO_EQUATION;
use crate::interface::pairing::given::Given;
use crate::memory::{self, Store};

/// A component of a unit direction below this is rounding of the normal.
const NO_COMPONENT: f64 = 1e-8;

/// Refuses an interface whose multipliers cannot be eliminated. O(n log n) in the nodes.
pub fn refuse<const N: usize>(given: Given<N>, normals: &[Vec3]) -> Result<()> {
    given.setup.refuse(&[(Feature::Condensed, true)])?;
    refuse_hanging(given)?;
    refuse_prescribed(given, normals)?;
    refuse_shared(given)
}

/// A mid node of one facet that is another's corner: the hats of the first one's corners would meet its multiplier.
fn refuse_hanging<const N: usize>(given: Given<N>) -> Result<()> {
    let surface = &given.setup.nonmortar;
    for (f, facet) in surface.parents.iter().flat_map(|parents| &parents.facets).enumerate() {
        let mids = &facet.as_slice()[facet.parent.corners()..];
        if let Some(a) = mids.iter().find(|&&a| surface.has_row(a)) {
            let text = text!(
                "condensation where non-mortar node {a} is a mid node of facet {f} and a corner of another one: its multiplier is no unknown of one row; keep multipliers as unknowns, or mesh facet {f} with the same edges as its neighbours"
            );
            return Err(Error::new(Kind::Unsupported, text));
        }
    }
    Ok(())
}

/// A component that has a multiplier and no row to eliminate it with.
fn refuse_prescribed<const N: usize>(given: Given<N>, normals: &[Vec3]) -> Result<()> {
    let setup = given.setup;
    for a in (0..given.nodes()).filter(|&a| setup.has_multiplier(a) && setup.nodes.acts(a)) {
        let t = direction::<N>(normals[a]);
        for i in (0..3).filter(|&i| setup.nonmortar.equations[a][i] == NO_EQUATION) {
            let axis = setup.nodes.free[a].column(i).norm() * t.row(i).norm();
            if axis > NO_COMPONENT {
                let text = text!(
                    "condensation where component {i} of non-mortar node {a} is prescribed (equation -1) and has a multiplier: no row is left to eliminate it with. Where the mortar side is prescribed there too, take the multiplier away (multiplier equation -1, or stickslip_interface_set_constraints); else keep multipliers as unknowns, or end the interface before that edge"
                );
                return Err(Error::new(Kind::Unsupported, text));
            }
        }
    }
    Ok(())
}

/// Whose displacement equation it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum User {
    /// A non-mortar node with a multiplier.
    Holder(usize),
    /// A non-mortar node without.
    Free(usize),
    Mortar(usize),
}

/// A row of a node with a multiplier that serves another node, or another component, too.
fn refuse_shared<const N: usize>(given: Given<N>) -> Result<()> {
    let setup = given.setup;
    let mut used = Vec::new();
    for (a, equations) in setup.nonmortar.equations.iter().enumerate() {
        let user = if setup.has_multiplier(a) { User::Holder(a) } else { User::Free(a) };
        used.store_all(equations.iter().filter(|e| **e != NO_EQUATION).map(|&e| (e, user)))?;
    }
    for (k, equations) in setup.mortar.equations.iter().enumerate() {
        used.store_all(equations.iter().filter(|e| **e != NO_EQUATION).map(|&e| (e, User::Mortar(k))))?;
    }
    // Holders come first among those of an equation.
    memory::sort(&mut used)?;
    let found = used.windows(2).find(|pair| pair[0].0 == pair[1].0 && matches!(pair[0].1, User::Holder(_)));
    let Some(&[(_, User::Holder(a)), (_, other)]) = found else { return Ok(()) };
    let text = match other {
        User::Mortar(k) => text!(
            "condensation where non-mortar node {a} and mortar node {k} have an equation in common: a node on both sides"
        ),
        User::Holder(k) if k == a => text!(
            "condensation where two components of non-mortar node {a} have an equation in common: one row is left for two components of its multiplier"
        ),
        User::Holder(k) => text!(
            "condensation where non-mortar nodes {a} and {k} have an equation in common: two multipliers hold one displacement"
        ),
        User::Free(k) => text!(
            "condensation where non-mortar nodes {a} and {k} have an equation in common, and node {k} has no multiplier: a row can be that of one node alone"
        ),
    };
    Err(Error::new(Kind::Unsupported, text))
}
