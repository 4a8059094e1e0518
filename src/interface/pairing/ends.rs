//! Where the prism over a non-mortar facet ends: the filter admits no mortar facet above its gap or below its deepest
//! penetration, and a search need not look there.
//!
//! The filter measures heights with the positions of t_n, a search is at others. A mortar node that was at a height over a
//! non-mortar facet has moved by u since, so that its height over the plane of t_n is now larger by e . u. The box around
//! the u of all mortar nodes says how much that can be, and moving the ends by it loses no pair, whatever the motion. A
//! common motion moves both ends alike; motions that differ much move them apart, and the prism is as good as endless.

use super::boxes::Aabb;
use super::filter::FacetFilter;
use super::prism::{Prism, ROUNDING, Slab};
use super::search::Tree;
use crate::geometry::{Plane, Vec3};
use crate::interface::data::surface::Surface;
use std::sync::OnceLock;

/// Room for rounding in heights, over the facet's longest edge: an end never cuts off what the filter would admit.
pub const MARGIN: f64 = 1e-9;

/// Where the prisms of a search end.
pub struct Ends<'a> {
    filter: &'a FacetFilter,
    tree: &'a Tree,
    two: &'a Surface,
    x2: &'a [Vec3],
    /// Where normals follow the motion: how far (over the longest edge of the non-mortar facet) there is still to move.
    follows: Option<f64>,
    /// The most that any mortar facet may lie deeper than the pairs' own measure `[L]`.
    depth: f64,
    /// The box around the motions of all mortar nodes since t_n, once it was asked for.
    moved: OnceLock<Aabb>,
}

impl<'a> Ends<'a> {
    /// Those of a search in the tree over mortar facets at `x2`; `follows`: where normals follow the motion, the skin.
    pub fn new(
        (tree, filter): (&'a Tree, &'a FacetFilter),
        (two, x2): (&'a Surface, &'a [Vec3]),
        follows: Option<f64>,
    ) -> Ends<'a> {
        Ends { filter, tree, two, x2, follows, depth: filter.largest_depth(), moved: OnceLock::new() }
    }

    /// Whether the prism of non-mortar facet i may have ends that cut anything off. The point may be off its plane's by `slack`.
    pub fn may_cut(&self, i: usize, (normal, point): (Vec3, Vec3), slack: f64) -> bool {
        let (low, high) = self.tree.along(normal, point);
        low - slack < -self.filter.deepest_of(i, self.depth) || high + slack > self.filter.gap()
    }

    /// The prism of non-mortar facet i, whose plane is this one now, with its ends.
    pub fn of(&self, prism: Prism, i: usize, plane: &Plane) -> Prism {
        let one = &self.filter.sides[0];
        let (gap, deepest) = (self.filter.gap(), self.filter.deepest_of(i, self.depth));
        // Where all mortar facets are between the ends now, there is most likely nothing to cut off.
        let (low, high) = self.tree.along(plane.e, plane.reference + plane.origin);
        if !(low < -deepest || high > gap) {
            return prism;
        }
        let then = &one.facets[i].1;
        let at = then.reference + then.origin;
        let moved = self.moved.get_or_init(|| self.motions());
        let least = MARGIN * one.edges[i];
        let between = |direction: Vec3, at: Vec3, (down, up): (f64, f64), far: f64| {
            let over = at - prism.origin;
            let (height, ends) = (direction.dot(&over), deepest + if gap.is_finite() { gap } else { 0.0 });
            let margin = least + ROUNDING * (over.abs().sum() + far + ends);
            Slab { direction, low: height - deepest + down - margin, high: height + gap + up + margin }
        };
        let once = between(then.e, at, moved.along(then.e, Vec3::zeros()), moved.farthest().sum());
        // What the filter says of the facets where they are now.
        let now = self.follows.map(|skin| {
            let slack = skin * one.edges[i];
            between(plane.e, plane.reference + plane.origin, (-slack, slack), slack)
        });
        prism.within([Some(once), now].into_iter().flatten())
    }

    /// The box around the motions of all mortar nodes since t_n.
    fn motions(&self) -> Aabb {
        let then = &self.filter.sides[1].facets;
        let facets = self.two.facets.iter().zip(then);
        Aabb::around(facets.flat_map(|(now, then)| (0..now.len).map(move |k| self.x2[now.nodes[k]] - then.0.nodes[k])))
    }
}
