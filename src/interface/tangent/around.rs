//! What is around a node, for tangents where points decide (docs/formulation 16.4): its facets, and the mortar nodes that these reach.

use super::union::{Pairs, Walk};
use crate::error::Result;
use crate::interface::data::lists::Lists;
use crate::interface::data::points::Points;
use crate::interface::data::setup::Setup;
use crate::memory::Store;
use std::ops::Range;

/// The facets around each node, with the mortar nodes of each.
#[derive(Debug, Default)]
pub struct Around {
    pub facets: Vec<usize>,
    /// Where the points have each facet, or its parts.
    at: Vec<[usize; 2]>,
    mortar: Lists,
    /// By non-mortar nodes, and by mortar nodes.
    of_node: Lists,
    below: Lists,
    /// By non-mortar nodes the facets whose nodes turn their normals, also those without pairs; `None`: normals are held.
    turning: Option<Lists>,
}

impl Around {
    /// Those that have pairs; `points`: whose facets they are.
    pub fn of<const N: usize>(setup: &Setup<N>, pairs: Pairs, points: Option<&Points>) -> Result<Around> {
        let ((one, two), moves) = (setup.surfaces(), setup.mortar_moves());
        let (mut all, mut walk, mut of_facet) = (Around::default(), Walk::through(pairs, 0..usize::MAX), Vec::new());
        let (of_points, mut end) = (points.map_or(&[][..], |points| &points.facets), 0);
        all.mortar.first.store(0)?;
        while let Some(f) = walk.next(&mut of_facet)? {
            let first = end + of_points[end..].iter().take_while(|facet| one.host_facet(facet.one) < f).count();
            end = first + of_points[first..].iter().take_while(|facet| one.host_facet(facet.one) == f).count();
            all.facets.store(f)?;
            all.at.store([first, end])?;
            let first = all.mortar.all.len();
            for &c in of_facet.iter().filter(|_| moves).flat_map(|pair| two.host_nodes(pair.two)) {
                if !all.mortar.all[first..].contains(&(c as u32)) {
                    all.mortar.all.store(c as u32)?;
                }
            }
            all.mortar.first.store(all.mortar.all.len())?;
        }
        let facets = &all.facets;
        all.of_node = Lists::of(one.len(), |give| {
            (0..).zip(facets).for_each(|(k, &f)| one.host_nodes(f).iter().for_each(|&a| give(a, k)));
        })?;
        all.below = Lists::of(two.len(), |give| {
            (0..facets.len()).for_each(|k| all.mortar.get(k).iter().for_each(|&c| give(c as usize, k as u32)));
        })?;
        if setup.options.follows_normals() {
            all.turning = Some(Lists::of(one.len(), |give| {
                (0..one.host_facets()).for_each(|f| one.host_nodes(f).iter().for_each(|&a| give(a, f as u32)));
            })?);
        }
        Ok(all)
    }

    /// The facets of the host whose nodes turn the normal of A.
    pub fn turning(&self, a: usize) -> &[u32] {
        self.turning.as_ref().map_or(&[], |turning| turning.get(a))
    }

    pub fn around(&self, a: usize) -> &[u32] {
        self.of_node.get(a)
    }

    /// The facets that have mortar node c.
    pub fn below(&self, c: usize) -> &[u32] {
        self.below.get(c)
    }

    pub fn mortar(&self, k: usize) -> &[u32] {
        self.mortar.get(k)
    }

    /// Where the points have the k-th facet, or its parts.
    #[inline]
    pub fn at(&self, k: usize) -> Range<usize> {
        self.at[k][0]..self.at[k][1]
    }
}
