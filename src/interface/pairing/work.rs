//! What searches and integrations work with, in memory that is kept from one to the next.

use super::candidates::KeptTree;
use super::seen::Seen;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::counters::Counters;
use crate::interface::data::pairs::PairRecord;
use crate::mortar::{NonmortarFrame, Segment};
use std::sync::Mutex;

/// Facets that are searched for and then integrated in a row: their frames, 0.7 kB each, stay in the processor's second
/// cache, and what is done once a row counts for nothing. Rows do not know of each other.
pub const ROW: usize = 32;

/// What follows at once for a facet, while its overlaps are there: given the place of its first pair. `None`: nothing does.
pub type Following<'a> = Option<&'a (dyn Fn(&mut Active, usize, (&NonmortarFrame, &[Segment])) + Sync)>;

/// What searches and integrations work with.
#[derive(Debug, Default)]
pub struct Work {
    /// What has been done so far.
    pub counters: Counters,
    /// The search tree.
    pub tree: KeptTree,
    /// Room.
    pub room: Room,
    /// What threads have for themselves, and the pairs of each chunk of facets, where there are several threads.
    pub threads: Vec<ThreadRoom>,
    pub chunks: Vec<Mutex<Active>>,
}

/// What one thread works with.
#[derive(Debug, Default)]
pub struct ThreadRoom {
    pub counters: Counters,
    pub room: Room,
}

/// Room for what does not outlive a call.
#[derive(Debug, Default)]
pub struct Room {
    /// The frames of a row of facets.
    pub frames: Vec<NonmortarFrame>,
    /// Their candidates.
    pub candidates: Vec<(usize, usize)>,
    /// What a query of the tree has found.
    pub found: Vec<usize>,
    /// The mortar facets of the pairs of one facet.
    pub known: Vec<usize>,
    /// The overlaps of one facet.
    pub segments: Vec<Segment>,
    /// Per mortar node the non-mortar facet, and the place among its pairs, that met it last.
    pub met: Vec<(usize, usize)>,
    /// Per pair of a facet another one of its sheet, or itself.
    pub sheets: Vec<usize>,
    /// Coverage and gap of every non-mortar node.
    pub sums: Vec<(f64, Vec3)>,
    /// A vector per non-mortar node.
    pub vectors: Vec<Vec3>,
    /// Pairs that a commit drops, with their weights as they were integrated.
    pub dropped: Vec<PairRecord>,
    /// Pairs of a commit that integrates anew.
    pub anew: Active,
    /// Pairs that a commit adds, with the area of their overlap.
    pub added: Vec<(PairRecord, f64)>,
    /// Which facets lie nearest to each node.
    pub seen: Seen,
}
