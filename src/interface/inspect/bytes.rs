//! What an interface takes on the heap.

use crate::interface::data::active::Active;
use crate::interface::data::history::History;
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::candidates::KeptTree;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::given::NormalsAt;
use crate::interface::pairing::search::Tree;
use crate::interface::pairing::settle::Pairing;

/// A vector's memory `[bytes]`: what it holds and what it has taken for more.
pub fn heap<T>(v: &Vec<T>) -> usize {
    v.capacity() * size_of::<T>()
}

fn of_surface(s: &Surface) -> usize {
    heap(&s.reference) + heap(&s.facets) + heap(&s.equations) + heap(&s.edges)
}

/// Of a history.
pub fn of_history(h: &History) -> usize {
    let vectors = [&h.x1, &h.x2, &h.normals, &h.gap, &h.slip];
    vectors.map(heap).iter().sum::<usize>() + heap(&h.areas) + heap(&h.coverage) + h.facet_gaps.bytes() + heap(&h.pairs)
}

fn of_filter(filter: &Filter) -> usize {
    match filter {
        Filter::Facets(f) => {
            f.sides.iter().map(|s| heap(&s.facets) + heap(&s.edges) + heap(&s.bulges)).sum::<usize>()
                + heap(&f.depths)
                + heap(&f.reached)
                + heap(&f.by_overlaps)
        }
        Filter::Analytic(facing) => heap(facing),
    }
}

/// Of a search tree.
pub fn of_tree(kept: &KeptTree) -> usize {
    let KeptTree { x2, tree: Tree { boxes, nodes, order, branches, .. }, found } = kept;
    heap(x2) + heap(boxes) + heap(nodes) + heap(order) + heap(branches) + heap(found)
}

/// Of the pairs at a configuration.
pub fn of_active(k: &Active) -> usize {
    heap(&k.x1) + heap(&k.x2) + heap(&k.frames) + heap(&k.pairs) + heap(&k.segments)
}

/// Of surfaces, equations and what is set per node.
pub fn of_setup<const N: usize>(setup: &Setup<N>) -> usize {
    let (surfaces, nodes) = (of_surface(&setup.nonmortar) + of_surface(&setup.mortar), &setup.nodes);
    let overrides = nodes.augmentations.as_ref().map_or(0, heap) + nodes.normals.as_ref().map_or(0, heap);
    surfaces + overrides + heap(&setup.multiplier_equations) + heap(&nodes.mu) + heap(&nodes.free) + heap(&nodes.owned)
}

/// Of what t_n settles.
pub fn of_pairing(pairing: &Pairing) -> usize {
    let carriers = heap(&pairing.carriers) + pairing.carriers.iter().map(heap).sum::<usize>();
    pairing.filter.as_ref().map_or(0, of_filter) + heap(&pairing.coverable) + heap(&pairing.keeps_normal) + carriers
}

/// Of the normals of now.
pub fn of_normals(now: &NormalsAt) -> usize {
    heap(&now.x1) + heap(&now.sums) + heap(&now.nu)
}
