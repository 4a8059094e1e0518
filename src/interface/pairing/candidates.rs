//! Which pairs of facets may be active at a configuration: those that the filter of t_n admits and whose mortar facet may
//! reach into the non-mortar facet's prism.
//!
//! Where the normals follow the motion, a surface may slide round a curve or turn by any angle within a step. Then a pair may
//! be active, too, that the filter would admit where the facets are now. And what t_n admits counts only while neither facet
//! has turned far: a pair of t_n may be one of far sides now.

use super::filter::FacetFilter;
use super::search::{Aabb, Prism, Tree};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::options::{Options, Scheme};
use crate::interface::data::surface::{Surface, are_same};
use crate::memory::{self, Store, Stored};
use crate::mortar::NonmortarFrame;

/// Prisms are grown by this (over the facet's longest edge), so that touching facets are visited.
const TOUCH_MARGIN: f64 = 1e-6;
/// How far (over the facet's longest edge) surfaces may move within their plane before a tangent needs
/// entries beyond the superset pattern.
pub const SKIN: f64 = 0.25;

/// The search tree over a mortar surface, with the positions that it is of: a mortar side at rest needs one alone.
#[derive(Debug, Default)]
pub struct KeptTree {
    pub x2: Vec<Vec3>,
    pub tree: Option<Tree>,
}

impl KeptTree {
    /// The tree of `two` at `x2`.
    pub fn at(&mut self, two: &Surface, x2: &[Vec3]) -> Result<&Tree> {
        if !are_same(&self.x2, x2) {
            *self = KeptTree { x2: memory::copied(x2)?, tree: None };
        }
        let facet_box = |f: usize| Aabb::around(two.facet(f, x2).points().iter().copied());
        if self.tree.is_none() {
            self.tree = Some(Tree::new((0..two.facets.len()).map(facet_box).stored()?)?);
        }
        Ok(self.tree.as_ref().expect("there is one now"))
    }
}

/// Pairs that pass the filter and whose mortar facet may reach into the non-mortar facet's prism, grown by
/// `skin` (over the facet's longest edge). Where the normals follow the motion, those too that pass it after such a motion.
/// Sorted.
pub fn candidates(
    (one, two): (&Surface, &Surface),
    options: &Options,
    frames: &[NonmortarFrame],
    (x1, x2): (&[Vec3], &[Vec3]),
    (tree, filter): (&Tree, &FacetFilter),
    skin: f64,
    visited: &mut i64,
) -> Result<Vec<(usize, usize)>> {
    let (mut pairs, mut found) = (Vec::new(), Vec::new());
    let follows = options.follows_normals();
    let all = follows && (skin > 0.0 || filter.has_turned((one, two), (x1, x2)));
    for (i, frame) in frames.iter().enumerate().filter(|&(i, _)| all || filter.reached[i]) {
        let facet = one.facet(i, x1);
        let prism = Prism::over(facet.points(), &frame.plane, (TOUCH_MARGIN + skin) * facet.longest_edge());
        *visited += tree.find(&prism, &mut found)? as i64;
        let admits = |j: usize| {
            if !follows {
                return filter.admits(i, j);
            }
            let pair = ((i, &frame.plane), (j, &two.facet(j, x2)));
            let then = filter.admits(i, j) && (skin > 0.0 || filter.holds_at(pair.0, pair.1));
            then || filter.admits_at(pair.0, pair.1, skin)
        };
        let admitted = found.iter().filter(|&&j| admits(j));
        pairs.store_all(admitted.map(|&j| (i, j)))?;
    }
    Ok(pairs)
}

/// The points of non-mortar facet `i` where it is integrated by points.
pub fn by_points(options: &Options, filter: &FacetFilter, i: usize) -> Option<&'static [[f64; 2]]> {
    match options.scheme {
        Scheme::Segments => None,
        Scheme::Elements(line) => Some(line),
        Scheme::Hybrid(line) => (!filter.by_overlaps[i]).then_some(line),
    }
}
