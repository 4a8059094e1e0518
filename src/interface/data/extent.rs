//! What a call is about: the whole interface, or the share of one handle among several.

/// What a call is about. It is an argument of each call and no state of the handle: what one call is about changes no
/// later one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The whole interface: what is far away may be left out.
    Whole,
    /// A part of the mortar surface; a host adds the sums of several handles. Each owes its share, be its part far
    /// away, and other handles may cover any node.
    Part,
}

impl Extent {
    /// Of a call that takes the sums of all handles, or none.
    pub(crate) fn of<T>(sums: Option<T>) -> Extent {
        if sums.is_some() { Extent::Part } else { Extent::Whole }
    }
}

/// What an evaluation is about, and whether it found the surfaces apart: both decide what it leaves out.
#[derive(Clone, Copy, Debug)]
pub struct Scope {
    /// What it is about.
    pub extent: Extent,
    /// Whether the surfaces were found apart.
    pub apart: bool,
}
