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
use crate::memory::{self, Store};
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
    pub tree: Tree,
    /// Whether the tree is of these positions; if not it is room.
    is_current: bool,
}

impl KeptTree {
    /// The tree of `two` at `x2`.
    pub fn at(&mut self, two: &Surface, x2: &[Vec3]) -> Result<&Tree> {
        if !are_same(&self.x2, x2) {
            self.is_current = false;
            memory::recopy(&mut self.x2, x2)?;
        }
        let facet_box = |f: usize| Aabb::around(two.facet(f, x2).points().iter().copied());
        if !self.is_current {
            self.tree.renew((0..two.facets.len()).map(facet_box))?;
            self.is_current = true;
        }
        Ok(&self.tree)
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
    let search = Search::new((one, two), options, (x1, x2), (tree, filter), skin);
    for (i, frame) in frames.iter().enumerate() {
        *visited += search.of_facet((i, frame), &mut found, &mut pairs, None)?;
    }
    Ok(pairs)
}

/// A search, facet by facet.
pub struct Search<'a> {
    surfaces: (&'a Surface, &'a Surface),
    x: (&'a [Vec3], &'a [Vec3]),
    tree: &'a Tree,
    filter: &'a FacetFilter,
    skin: f64,
    /// Whether the normals follow the motion.
    pub follows: bool,
    all: bool,
}

impl<'a> Search<'a> {
    /// At these positions; see [`candidates`].
    pub fn new(
        surfaces: (&'a Surface, &'a Surface),
        options: &Options,
        x: (&'a [Vec3], &'a [Vec3]),
        (tree, filter): (&'a Tree, &'a FacetFilter),
        skin: f64,
    ) -> Search<'a> {
        let follows = options.follows_normals();
        let all = follows && (skin > 0.0 || filter.has_turned(surfaces, x));
        Search { surfaces, x, tree, filter, skin, follows, all }
    }

    /// Whether facet i, which has this frame, may have facet j as its partner.
    pub fn admits(&self, (i, frame): (usize, &NonmortarFrame), j: usize) -> bool {
        let Search { filter, skin, .. } = *self;
        if !self.follows {
            return filter.admits(i, j);
        }
        let pair = ((i, &frame.plane), (j, &self.surfaces.1.facet(j, self.x.1)));
        let then = filter.admits(i, j) && (skin > 0.0 || filter.holds_at(pair.0, pair.1));
        then || filter.admits_at(pair.0, pair.1, skin)
    }

    /// Whether facet i can have a partner at all.
    pub fn reaches(&self, i: usize) -> bool {
        self.all || self.filter.reached[i]
    }

    /// Appends the candidates of facet i, which has this frame, and to `excluded` what was found and is none. Gives how many
    /// boxes were compared.
    pub fn of_facet(
        &self,
        (i, frame): (usize, &NonmortarFrame),
        found: &mut Vec<usize>,
        pairs: &mut Vec<(usize, usize)>,
        mut excluded: Option<&mut Vec<(u32, u32)>>,
    ) -> Result<i64> {
        if !self.reaches(i) {
            return Ok(0);
        }
        let facet = self.surfaces.0.facet(i, self.x.0);
        let prism = Prism::over(facet.points(), &frame.plane, (TOUCH_MARGIN + self.skin) * facet.longest_edge());
        let visited = self.tree.find(&prism, found)?;
        for &j in found.iter() {
            if self.admits((i, frame), j) {
                pairs.store((i, j))?;
            } else if let Some(excluded) = &mut excluded {
                excluded.store((i as u32, j as u32))?;
            }
        }
        Ok(visited as i64)
    }
}

/// The points of non-mortar facet `i` where it is integrated by points.
pub fn by_points(options: &Options, filter: &FacetFilter, i: usize) -> Option<&'static [[f64; 2]]> {
    match options.scheme {
        Scheme::Segments => None,
        Scheme::Elements(line) => Some(line),
        Scheme::Hybrid(line) => (!filter.by_overlaps[i]).then_some(line),
    }
}
