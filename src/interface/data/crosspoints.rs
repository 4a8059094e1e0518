//! Nodes that several interfaces of a host share (docs/formulation 6.5).
//!
//! A node that is non-mortar in two interfaces has multipliers in both: where it sticks or is tied in both, six
//! conditions meet three displacements. A node that is non-mortar in one and mortar in another is a link of a chain,
//! which is fine. A node on both sides of one interface touches itself.

use crate::error::Result;
use crate::memory::{self, Store};

/// The nodes of one interface, in the host's numbers; a number may come more than once.
#[derive(Clone, Copy, Debug)]
pub struct InterfaceNodes<'a> {
    /// Those of the non-mortar side.
    pub nonmortar: &'a [i64],
    /// Those of the mortar side.
    pub mortar: &'a [i64],
}

/// A node that interfaces share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crosspoint {
    /// The host's number.
    pub node: i64,
    /// In how many interfaces it is non-mortar.
    pub claims: i64,
    /// Non-mortar in more than one interface.
    pub claimed_twice: bool,
    /// Non-mortar in one interface, mortar in another one.
    pub chain: bool,
    /// On both sides of the same interface.
    pub both_sides: bool,
}

/// The nodes that interfaces share in a way that a host may have to do something about, by ascending number. Nodes that
/// are mortar alone, in however many interfaces, are none. O(n log n).
///
/// # Errors
/// [`crate::error::Kind::OutOfMemory`].
pub fn crosspoints(interfaces: &[InterfaceNodes]) -> Result<Vec<Crosspoint>> {
    let mut uses = Vec::new();
    for (k, interface) in interfaces.iter().enumerate() {
        uses.store_all(interface.nonmortar.iter().map(|&node| (node, k, false)))?;
        uses.store_all(interface.mortar.iter().map(|&node| (node, k, true)))?;
    }
    memory::sort(&mut uses)?;
    uses.dedup();
    let mut found = Vec::new();
    for uses in uses.chunk_by(|u, v| u.0 == v.0) {
        let sides = |mortar: bool| uses.iter().filter(move |u| u.2 == mortar).map(|u| u.1);
        let claims = sides(false).count();
        let both_sides = sides(false).any(|k| sides(true).any(|j| j == k));
        let chain = sides(false).any(|k| sides(true).any(|j| j != k));
        if claims > 1 || both_sides || chain {
            let claimed_twice = claims > 1;
            found.store(Crosspoint { node: uses[0].0, claims: claims as i64, claimed_twice, chain, both_sides })?;
        }
    }
    Ok(found)
}
