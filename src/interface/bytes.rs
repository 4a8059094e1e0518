//! What an interface takes on the heap.

use super::filter::Filter;
use super::history::History;
use super::integration::{Integration, KeptTree};
use super::search::Tree;
use super::{Contact, Surface};

/// A vector's memory `[bytes]`: what it holds and what it has taken for more.
fn heap<T>(v: &Vec<T>) -> usize {
    v.capacity() * size_of::<T>()
}

fn of_surface(s: &Surface) -> usize {
    heap(&s.reference) + heap(&s.facets) + heap(&s.equations) + heap(&s.edges)
}

fn of_history(h: &History) -> usize {
    let vectors = [&h.x1, &h.x2, &h.normals, &h.gap, &h.slip];
    vectors.map(heap).iter().sum::<usize>() + heap(&h.areas) + heap(&h.coverage) + h.facet_gaps.bytes() + heap(&h.pairs)
}

fn of_filter(filter: &Filter) -> usize {
    match filter {
        Filter::Facets(f) => {
            f.sides.iter().map(|s| heap(&s.facets) + heap(&s.edges) + heap(&s.bulges)).sum::<usize>()
                + heap(&f.depths)
                + heap(&f.reached)
                + heap(&f.by_cells)
        }
        Filter::Analytic(facing) => heap(facing),
    }
}

fn of_tree(kept: &KeptTree) -> usize {
    let of = |t: &Tree| heap(&t.boxes) + heap(&t.nodes) + heap(&t.order) + heap(&t.branches);
    heap(&kept.x2) + kept.tree.as_ref().map_or(0, of)
}

fn of_integration(k: &Integration) -> usize {
    heap(&k.x1)
        + heap(&k.x2)
        + heap(&k.frames)
        + heap(&k.pairs)
        + heap(&k.segments)
        + k.sums.as_ref().map_or(0, |(_, sums)| heap(sums))
}

impl<const N: usize> Contact<N> {
    /// Heap memory in use `[bytes]`: surfaces, histories, the filter, the search tree, the last evaluation, what is
    /// set per node.
    pub fn bytes(&self) -> usize {
        let surfaces = of_surface(&self.nonmortar) + of_surface(&self.mortar);
        let histories = of_history(&self.history) + self.rollback.as_ref().map_or(0, of_history);
        let step = self.filter.as_ref().map_or(0, of_filter) + self.integration.as_ref().map_or(0, of_integration);
        let step = step + of_tree(&self.tree);
        let flags = heap(&self.owned) + heap(&self.coverable);
        let flags = flags + heap(&self.carriers) + self.carriers.iter().map(heap).sum::<usize>();
        let overrides = self.augmentations.as_ref().map_or(0, heap) + self.normals.as_ref().map_or(0, heap);
        let nodes = heap(&self.multiplier_equations) + heap(&self.mu) + heap(&self.free);
        surfaces + histories + step + flags + overrides + nodes
    }
}
