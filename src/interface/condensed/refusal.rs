//! What cannot be condensed, by name: multipliers are eliminated with the rows of their nodes, which must be there and serve
//! one multiplier each.

use crate::error::{Error, Kind, Result, Text};
use crate::geometry::Vec3;
use crate::interface::data::multiplier::direction;
use crate::interface::data::node_data::Owner;
use crate::interface::data::options::{Form, MultiplierBasis};
use crate::interface::data::surface::NO_EQUATION;
use crate::interface::pairing::given::Given;
use crate::memory::{self, Store};

/// A component of a unit direction below this is rounding of the normal.
const NO_COMPONENT: f64 = 1e-8;

/// Refuses an interface whose multipliers cannot be eliminated. O(n log n) in the nodes.
pub fn refuse<const N: usize>(given: Given<N>, normals: &[Vec3]) -> Result<()> {
    let (setup, refuse) = (given.setup, |text: Text| Err(Error::new(Kind::Unsupported, text)));
    if setup.options.basis != MultiplierBasis::Dual {
        let text = "condensation with standard multipliers: their forces couple neighbours; take the dual basis (STICKSLIP_BASIS_DUAL)";
        return refuse(text.into());
    }
    if setup.decides_at_points() {
        let text = "condensation where points decide: a facet's mass matrix couples its multipliers; keep them as unknowns, or take STICKSLIP_DECISION_NODES";
        return refuse(text.into());
    }
    if setup.options.form != Form::Multiplier {
        let text = "condensation with the augmented form: its forces do not determine the multipliers of open nodes; take the multiplier form";
        return refuse(text.into());
    }
    if let Some(a) = setup.nodes.owners.iter().position(|owner| *owner == Owner::Shared) {
        let text = text!(
            "condensation where non-mortar node {a} is shared: all facets around a node must be known to one handle, which owns it, and to others its multiplier acts elsewhere"
        );
        return refuse(text);
    }
    if let Some(a) =
        setup.nodes.owners.iter().position(|owner| *owner == Owner::Elsewhere).filter(|_| setup.has_parents())
    {
        let text = text!(
            "condensation of quadratic facets and lines where the multiplier of non-mortar node {a} acts elsewhere: several multipliers act on a node in the middle, and one handle must have them all"
        );
        return refuse(text);
    }
    refuse_hanging(given)?;
    refuse_prescribed(given, normals)?;
    refuse_shared(given)
}

/// Refuses parts of an interface where a host's matrix is to be changed in place: a row of it belongs to one part, and what the
/// others add to it is known to them alone.
pub fn refuse_parts<const N: usize>(given: Given<N>) -> Result<()> {
    match given.setup.nodes.owners.iter().position(|owner| *owner != Owner::Here) {
        None => Ok(()),
        Some(a) => Err(Error::new(
            Kind::Unsupported,
            text!(
                "a matrix condensed in place where the multiplier of non-mortar node {a} acts elsewhere; take the pieces (stickslip_interface_condensed_coo), which add up over the handles"
            ),
        )),
    }
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
