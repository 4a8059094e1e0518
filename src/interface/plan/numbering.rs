//! The nodes of an interface in the order of their equations. A node here is three displacements of either side, or the
//! multipliers of a non-mortar node: its scalars.
//!
//! A node is plain where all of its scalars have equations that follow each other among those of the interface, and no other
//! node has any of them. The entries of plain nodes stand side by side in a row, and their rows one after the other.

use crate::error::{Error, Kind, Result};
use crate::interface::data::node_data::Owner;
use crate::interface::data::options::Options;
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::{NO_EQUATION, Surface, node_equations};
use crate::interface::tangent::emission::Place;
use crate::memory::{self, Store, Stored};

/// Scalars of a node at most.
pub const SCALARS: usize = 3;
/// The rank of a node without equations.
pub const NO_RANK: u32 = u32::MAX;
/// Nodes at most: a rank and the kind of its node have to fit into 32 bits.
const MOST_NODES: usize = 1 << 30;

/// What a plan must know of an interface, however many multipliers a node has.
#[derive(Clone, Copy, Debug)]
pub struct Sides<'a> {
    /// The side with the multipliers.
    pub nonmortar: &'a Surface,
    /// The other side.
    pub mortar: &'a Surface,
    /// The multipliers' equations, node by node.
    multipliers: &'a [i64],
    /// Multipliers of a node.
    pub components: usize,
    /// The choices.
    pub options: &'a Options,
    /// Whether the mortar side has rows and columns.
    pub moves: bool,
    /// Where the multipliers act.
    pub owners: &'a [Owner],
}

impl<'a> Sides<'a> {
    /// Of this interface.
    pub fn of<const N: usize>(setup: &'a Setup<N>) -> Sides<'a> {
        Sides {
            nonmortar: &setup.nonmortar,
            mortar: &setup.mortar,
            multipliers: setup.multiplier_equations.as_flattened(),
            components: N,
            options: &setup.options,
            moves: setup.effects.moves(),
            owners: &setup.nodes.owners,
        }
    }
}

/// The nodes of an interface.
#[derive(Clone, Copy, Debug)]
pub struct Nodes<'a> {
    setup: Sides<'a>,
}

impl<'a> Nodes<'a> {
    /// Of this interface.
    pub fn of(setup: Sides<'a>) -> Nodes<'a> {
        Nodes { setup }
    }

    /// The displacements of both sides and the multipliers.
    pub fn len(self) -> usize {
        2 * self.setup.nonmortar.len() + self.setup.mortar.len()
    }

    /// The number of a mortar node.
    pub fn mortar(self, node: usize) -> usize {
        self.setup.nonmortar.len() + node
    }

    /// The number of a non-mortar node's multiplier.
    pub fn multiplier(self, a: usize) -> usize {
        self.setup.nonmortar.len() + self.setup.mortar.len() + a
    }

    /// The number of a place.
    pub fn number(self, place: Place) -> usize {
        match place {
            Place::Displacement(node) => node,
            Place::Multiplier(a) => self.multiplier(a),
        }
    }

    /// Whether a number is that of a multiplier.
    pub fn is_multiplier(self, node: usize) -> bool {
        node >= self.multiplier(0)
    }

    /// Whether a node has rows here: a multiplier that acts elsewhere is but a column.
    #[inline(always)]
    pub fn has_rows(self, node: usize) -> bool {
        node.checked_sub(self.multiplier(0)).is_none_or(|a| self.setup.owners[a] != Owner::Elsewhere)
    }

    /// Its equations.
    pub fn equations(self, node: usize) -> &'a [i64] {
        match node.checked_sub(self.multiplier(0)) {
            Some(a) => &self.setup.multipliers[self.setup.components * a..self.setup.components * (a + 1)],
            None => node_equations((self.setup.nonmortar, self.setup.mortar), node),
        }
    }
}

/// The order of the nodes.
#[derive(Debug, Default)]
pub struct Numbering {
    /// The place of each node among those with equations, or [`NO_RANK`].
    pub rank: Vec<u32>,
    /// The nodes with equations.
    pub node: Vec<u32>,
    /// Which nodes are plain.
    pub plain: Vec<bool>,
    /// All scalars with equations, [`SCALARS`] times the node plus the component, by their equations.
    pub scalars: Vec<u32>,
}

impl Numbering {
    /// Whether a node has an equation.
    #[inline]
    pub fn has_equations(&self, node: usize) -> bool {
        self.rank[node] != NO_RANK
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        let numbers = self.rank.capacity() + self.node.capacity() + self.scalars.capacity();
        numbers * size_of::<u32>() + self.plain.capacity()
    }

    /// Of an interface.
    pub fn of(nodes: Nodes) -> Result<Numbering> {
        if nodes.len() > MOST_NODES {
            let text = text!("{} nodes of both sides; a plan holds {MOST_NODES} at most", nodes.len());
            return Err(Error::new(Kind::Unsupported, text));
        }
        let mut equations = memory::with_room(SCALARS * nodes.len())?;
        for node in 0..nodes.len() {
            for (i, &equation) in nodes.equations(node).iter().enumerate().filter(|(_, e)| **e != NO_EQUATION) {
                equations.store((equation, (SCALARS * node + i) as u32))?;
            }
        }
        memory::sort(&mut equations)?;
        let mut numbering = Numbering {
            rank: memory::filled(NO_RANK, nodes.len())?,
            node: memory::with_room(nodes.len())?,
            plain: memory::filled(false, nodes.len())?,
            scalars: equations.iter().map(|e| e.1).stored()?,
        };
        for (k, &(_, scalar)) in equations.iter().enumerate() {
            let node = scalar as usize / SCALARS;
            if numbering.rank[node] != NO_RANK {
                continue;
            }
            numbering.rank[node] = numbering.node.len() as u32;
            numbering.node.store(node as u32)?;
            let n = nodes.equations(node).len();
            let own = equations.get(k..k + n).unwrap_or_default();
            let follow = (0..n as u32).map(|i| (SCALARS * node) as u32 + i);
            let alone = |j: usize| equations.get(j).is_none_or(|next| j == 0 || next.0 != equations[j - 1].0);
            numbering.plain[node] = own.len() == n && own.iter().map(|e| e.1).eq(follow) && (k..=k + n).all(alone);
        }
        Ok(numbering)
    }
}
