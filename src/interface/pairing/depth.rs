//! How deep the mortar surface may lie behind coarse non-mortar facets, beyond what the facets of a pair say themselves.
//!
//! A coarse facet holds its nodes' weighted gaps at zero, not every point's: a fine tip rightly dips into it, by the tip's
//! bulge over the coarse facet's extent, which may be many of its own facets. But weights are positive. So over the facets
//! around a node in equilibrium, closed or open, some part of the other surface is not behind them, and the surface hangs
//! together: what lies deep is connected with that part within the prisms of these facets. The far side of a body is not.
//!
//! So each deep mortar facet is followed back: over the facets around one non-mortar node, through mortar facets that
//! share a node, oppose and lie in a prism, to one that the pair's own measure admits. One that is reached may lie as
//! deep as it does there. It is a number per mortar facet, not a list of pairs: in the next step it may slide to others.

use super::ends::MARGIN;
use super::filter::FacetFilter;
use super::prism::{Prism, Slab};
use super::search::Tree;
use crate::adjacency::{Lists, root};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::surface::Surface;
use crate::memory::{self, Store};

/// A mortar facet in the prism of a non-mortar facet that it opposes, and how deep behind it, where that is deeper than
/// their own measure.
#[derive(Clone, Copy)]
struct Over {
    two: usize,
    deep: Option<f64>,
}

/// Per mortar facet, how deep it may lie beyond what the facets of a pair allow `[L]`; empty where none is deep. A search
/// over the facets around those that are `reached`, and linear in the pairs found.
pub fn followed(surfaces: (&Surface, &Surface), filter: &FacetFilter, tree: &Tree, x2: &[Vec3]) -> Result<Vec<f64>> {
    let (one, two) = surfaces;
    let around = Lists::around(one.len(), one.facets.len(), |f| one.facets[f].as_slice())?;
    let nodes = |f: usize| one.facets[f].as_slice().iter();
    let mut near = memory::filled(false, one.facets.len())?;
    for i in (0..near.len()).filter(|&i| filter.reached[i]) {
        nodes(i).flat_map(|&a| around.of(a)).for_each(|&k| near[k] = true);
    }
    let (mut over, mut found) = (Lists::with_room(near.len())?, Vec::new());
    for i in 0..near.len() {
        if near[i] {
            add_over(i, filter, tree, &mut found, &mut over.items)?;
        }
        over.end()?;
    }
    if !over.items.iter().any(|pair| pair.deep.is_some()) {
        return Ok(Vec::new());
    }
    let places = places(x2)?;
    let (mut depth, mut sheets) = (memory::filled(0.0_f64, two.facets.len())?, Sheets::new(two, &places)?);
    for a in 0..one.len() {
        let pairs = || around.of(a).iter().flat_map(|&i| over.of(i));
        if pairs().any(|pair| pair.deep.is_some()) {
            sheets.start();
            pairs().for_each(|pair| sheets.add(pair.two, pair.deep.is_none()));
            for (j, deep) in pairs().filter_map(|pair| pair.deep.map(|deep| (pair.two, deep))) {
                if sheets.is_held(j) {
                    depth[j] = depth[j].max(deep);
                }
            }
        }
    }
    Ok(depth)
}

/// Appends the mortar facets over non-mortar facet i; `found`: room.
fn add_over(i: usize, filter: &FacetFilter, tree: &Tree, found: &mut Vec<usize>, over: &mut Vec<Over>) -> Result<()> {
    let (facet, plane) = &filter.sides[0].facets[i];
    // Deeper than that the coarser one of no pair lets a body in.
    let low = plane.e.dot(&plane.origin) - filter.deepest_let_in(i);
    let ends = Slab { direction: plane.e, low: low - MARGIN * filter.sides[0].edges[i], high: f64::INFINITY };
    tree.find(&Prism::over(facet.points(), plane, 0.0).within([ends]), found)?;
    let pair = |&j: &usize| {
        let depth = filter.opposes(i, j).then(|| -filter.heights(i, j).1)?;
        let [own, most] = filter.penetrations(i, j);
        (depth <= most).then_some(Over { two: j, deep: (depth > own).then_some(depth) })
    };
    over.store_all(found.iter().filter_map(pair))
}

/// Per node a number that nodes at the same place share: a mesh whose facets have nodes of their own hangs together too.
fn places(x: &[Vec3]) -> Result<Vec<usize>> {
    // Adding 0 makes -0 the same place.
    let key = |a: usize| [0, 1, 2].map(|k| (x[a][k] + 0.0).to_bits());
    let order = memory::order(x.len(), &|a, b| key(a).cmp(&key(b)))?;
    let mut places = memory::filled(0, x.len())?;
    for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
        same.iter().for_each(|&a| places[a] = same[0]);
    }
    Ok(places)
}

/// Some mortar facets, joined where they share a place, and which of these groups are held at one facet.
struct Sheets<'a> {
    two: &'a Surface,
    places: &'a [usize],
    /// Of each place: in which round it was met, the next place of its group (itself at the root).
    met: Vec<usize>,
    parent: Vec<usize>,
    held: Vec<bool>,
    round: usize,
}

impl<'a> Sheets<'a> {
    fn new(two: &'a Surface, places: &'a [usize]) -> Result<Sheets<'a>> {
        let n = places.len();
        let (met, parent, held) = (memory::filled(0, n)?, memory::filled(0, n)?, memory::filled(false, n)?);
        Ok(Sheets { two, places, met, parent, held, round: 0 })
    }

    fn start(&mut self) {
        self.round += 1;
    }

    fn root(&mut self, place: usize) -> usize {
        if self.met[place] != self.round {
            (self.met[place], self.parent[place], self.held[place]) = (self.round, place, false);
        }
        root(&mut self.parent, place)
    }

    fn add(&mut self, facet: usize, held: bool) {
        let nodes = &self.two.facets[facet];
        let first = self.root(self.places[nodes.nodes[0]]);
        self.held[first] |= held;
        for &node in &nodes.as_slice()[1..] {
            let (other, first) = (self.root(self.places[node]), self.root(first));
            self.parent[other] = first;
            self.held[first] |= self.held[other];
        }
    }

    fn is_held(&mut self, facet: usize) -> bool {
        let root = self.root(self.places[self.two.facets[facet].nodes[0]]);
        self.held[root]
    }
}
