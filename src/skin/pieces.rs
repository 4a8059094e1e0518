//! Pieces of the skin that are interfaces: non-mortar facets that hang together, with what they may touch
//! (docs/formulation 19.4).

use super::near::Near;
use super::roles::Role;
use super::whole::Whole;
use crate::adjacency::{Lists, root};
use crate::error::Result;
use crate::memory::{self, Store, Stored};

/// Rings of smooth neighbours around what a piece may touch: the room to slide in within a step.
const RINGS: usize = 2;

/// The facets of a piece, as the host has them; each list in ascending order.
#[derive(Debug, Default, PartialEq)]
pub struct Piece {
    /// Its non-mortar facets.
    pub own: Vec<usize>,
    /// Facets without a side around these, for the normals at the border.
    pub ring: Vec<usize>,
    /// Its mortar facets.
    pub mortar: Vec<usize>,
}

/// A piece, and which of its mortar facets it cannot do without.
#[derive(Debug)]
pub struct Wanted {
    pub piece: Piece,
    pub partners: Vec<usize>,
}

/// The pieces of a skin with these sides and pairs, in the order of their first facets.
pub fn pieces(whole: &Whole, roles: &[Role], near: &[Near]) -> Result<Vec<Wanted>> {
    let n = whole.facets();
    let mut parent = (0..n).stored()?;
    for a in 0..whole.copies() {
        let mut own = whole.around.of(a).iter().copied().filter(|&f| roles[f] == Role::Nonmortar);
        if let Some(first) = own.next() {
            own.for_each(|f| unite(&mut parent, f, first));
        }
    }
    let partners = Lists::around(n, near.len(), |p| &near[p].facets)?;
    join_edges(whole, roles, near, &partners, &mut parent);
    let own: Vec<_> = (0..n).filter(|&f| roles[f] == Role::Nonmortar).stored()?;
    let roots: Vec<_> = own.iter().map(|&f| root(&mut parent, f)).stored()?;
    let order = memory::order(own.len(), &|i, j| roots[i].cmp(&roots[j]))?;
    let mut marks = Marks { of: memory::filled(usize::MAX, n)?, round: 0 };
    let mut pieces = Vec::new();
    for same in order.chunk_by(|&i, &j| roots[i] == roots[j]) {
        let own: Vec<_> = same.iter().map(|&i| own[i]).stored()?;
        marks.start(&own);
        let mut met = Vec::new();
        for &f in &own {
            for &p in partners.of(f) {
                let g = near[p].other(f);
                // What lies under another face is no room to slide in.
                if !near[p].under && roles[g] == Role::Mortar && marks.is_new(g) {
                    met.store(g)?;
                }
            }
        }
        memory::sort(&mut met)?;
        let mut mortar = memory::copied(&met)?;
        for _ in 0..RINGS {
            grow(whole, &mut mortar, &mut marks, &|_| true)?;
        }
        memory::sort(&mut mortar)?;
        marks.start(&own);
        let mut ring = memory::copied(&own)?;
        grow(whole, &mut ring, &mut marks, &|f| roles[f] == Role::None)?;
        ring.drain(..own.len());
        memory::sort(&mut ring)?;
        pieces.store(Wanted { piece: Piece { own, ring, mortar }, partners: met })?;
    }
    Ok(pieces)
}

/// Joins faces that meet at an edge and may touch the same facet: the edge is one there, and has one condition, not one a face.
fn join_edges(whole: &Whole, roles: &[Role], near: &[Near], partners: &Lists<usize>, parent: &mut [usize]) {
    let nodes = |f: usize| whole.surface.host_nodes(f).iter().map(|&a| whole.originals[a]);
    let may = |f: usize, p: &Near| roles[f] == Role::Nonmortar && !p.under;
    for g in 0..roles.len() {
        let touch = partners.of(g);
        for (k, &p) in touch.iter().enumerate() {
            for &q in &touch[..k] {
                let [f, other] = [p, q].map(|p| near[p].other(g));
                if may(f, &near[p]) && may(other, &near[q]) && nodes(other).any(|a| nodes(f).any(|b| a == b)) {
                    unite(parent, f, other);
                }
            }
        }
    }
}

fn unite(parent: &mut [usize], f: usize, other: usize) {
    let [f, other] = [root(parent, f), root(parent, other)];
    parent[f.max(other)] = f.min(other);
}

/// Which facets a list has already.
struct Marks {
    of: Vec<usize>,
    round: usize,
}

impl Marks {
    /// A new list, without these facets.
    fn start(&mut self, without: &[usize]) {
        self.round += 1;
        without.iter().for_each(|&f| self.of[f] = self.round);
    }

    fn is_new(&mut self, f: usize) -> bool {
        std::mem::replace(&mut self.of[f], self.round) != self.round
    }
}

/// Appends the smooth neighbours of some facets, those that share a copy with them.
fn grow(whole: &Whole, facets: &mut Vec<usize>, marks: &mut Marks, may: &dyn Fn(usize) -> bool) -> Result<()> {
    for k in 0..facets.len() {
        for &a in whole.surface.host_nodes(facets[k]) {
            for &f in whole.around.of(a) {
                if may(f) && marks.is_new(f) {
                    facets.store(f)?;
                }
            }
        }
    }
    Ok(())
}

/// Whether all of a list, in ascending order, is in another one.
pub fn has_all(list: &[usize], of: &[usize]) -> bool {
    let mut rest = list.iter();
    of.iter().all(|f| rest.any(|g| g == f))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_has_what_it_has() {
        assert!(has_all(&[1, 3, 5], &[]) && has_all(&[1, 3, 5], &[1, 5]));
        assert!(!has_all(&[1, 3, 5], &[2]) && !has_all(&[1], &[1, 1]) && !has_all(&[], &[0]));
    }
}
