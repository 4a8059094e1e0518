//! Which mortar facets nearer ones hide from a non-mortar facet, of a mortar surface in layers (`stages/layers.rs`). It is
//! settled at a commit, and a function of the positions of t_n alone.

use crate::interface::data::surface::NO_FACET;

/// What is hidden from what; empty where there are no layers.
#[derive(Debug, Default)]
pub struct Hidden {
    /// Pairs of facets that lie over each other at t_n and are none, sorted.
    pub pairs: Vec<(u32, u32)>,
    /// Per mortar facet others that lie over or under it, or `NO_FACET` (`stacked.rs`); empty where `pairs` is. From non-mortar
    /// facets that come over it within the step, the nearer one of two hides the other one.
    pub stacked: Vec<[u32; 2]>,
    /// Pairs with such mortar facets that lie over each other at t_n and stay pairs, sorted.
    pub kept: Vec<(u32, u32)>,
}

impl Hidden {
    /// Whether, where there are layers, mortar facet j is hidden from non-mortar facet i; `is_nearer`: whether they could be a
    /// pair with this facet, and
    /// it is the nearer one.
    pub fn hides(&self, i: usize, j: usize, is_nearer: &dyn Fn(usize) -> bool) -> bool {
        let is_in = |pairs: &[(u32, u32)]| pairs.binary_search(&(i as u32, j as u32)).is_ok();
        let is_nearer = |other: &u32| *other != NO_FACET && is_nearer(*other as usize);
        is_in(&self.pairs) || self.stacked[j].iter().any(is_nearer) && !is_in(&self.kept)
    }
}
