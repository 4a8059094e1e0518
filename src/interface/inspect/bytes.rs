//! What an interface takes on the heap.

use crate::interface::data::active::Active;
use crate::interface::data::history::History;
use crate::interface::data::parents::Parents;
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::candidates::KeptTree;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::given::NormalsAt;
use crate::interface::pairing::hidden::Hidden;
use crate::interface::pairing::search::Tree;
use crate::interface::pairing::settle::Pairing;
use crate::interface::pairing::work::{Room, ThreadRoom, Work};
use crate::interface::stages::residual::Residual;
use std::sync::Mutex;

/// A vector's memory `[bytes]`: what it holds and what it has taken for more.
pub fn heap<T>(v: &Vec<T>) -> usize {
    v.capacity() * size_of::<T>()
}

fn of_surface(s: &Surface) -> usize {
    heap(&s.reference)
        + heap(&s.facets)
        + heap(&s.equations)
        + heap(&s.edges)
        + heap(&s.neighbours)
        + heap(&s.idle)
        + heap(&s.offsets)
        + heap(&s.backs)
        + s.parents.as_ref().map_or(0, Parents::bytes)
}

/// Of a history.
pub fn of_history(h: &History) -> usize {
    let [frozen1, frozen2] = &h.frozen_at;
    let vectors = [&h.x1, &h.x2, frozen1, frozen2, &h.normals, &h.gap, &h.slip];
    vectors.map(heap).iter().sum::<usize>()
        + heap(&h.areas)
        + heap(&h.coverage)
        + heap(&h.states)
        + h.facet_gaps.bytes()
        + heap(&h.pairs)
        + heap(&h.parents)
}

fn of_filter(filter: &Filter) -> usize {
    match filter {
        Filter::Facets(f) => {
            f.sides.iter().map(|s| heap(&s.facets) + heap(&s.edges) + heap(&s.bulges) + heap(&s.walls)).sum::<usize>()
                + heap(&f.depths)
                + heap(&f.reached)
                + heap(&f.by_overlaps)
                + of_hidden(&f.hidden)
        }
        Filter::Analytic(facing) => heap(facing),
    }
}

/// Of what is hidden.
pub fn of_hidden(hidden: &Hidden) -> usize {
    heap(&hidden.pairs) + heap(&hidden.stacked) + heap(&hidden.kept)
}

/// Of a search tree.
fn of_tree(kept: &KeptTree) -> usize {
    let KeptTree { x2, tree: Tree { boxes, nodes, order, branches, .. }, .. } = kept;
    heap(x2) + heap(boxes) + heap(nodes) + heap(order) + heap(branches)
}

/// Of what searches and integrations work with.
pub fn of_work(work: &Work) -> usize {
    let of_thread = |thread: &ThreadRoom| of_room(&thread.room);
    let of_chunk = |chunk: &Mutex<Active>| chunk.lock().map_or(0, |chunk| of_active(&chunk));
    let threads = work.threads.iter().map(of_thread).sum::<usize>() + work.chunks.iter().map(of_chunk).sum::<usize>();
    of_tree(&work.tree) + of_room(&work.room) + threads
}

fn of_room(r: &Room) -> usize {
    let of_row = heap(&r.frames) + heap(&r.candidates) + heap(&r.found) + heap(&r.segments) + heap(&r.sheets);
    let of_nodes = heap(&r.met) + heap(&r.sums) + heap(&r.vectors);
    let of_nodes =
        of_nodes + heap(&r.seen.nearest) + heap(&r.seen.front) + r.seen.normals.iter().map(heap).sum::<usize>();
    of_row + of_nodes + heap(&r.dropped) + heap(&r.added) + of_active(&r.anew)
}

/// Of the pairs at a configuration.
pub fn of_active(k: &Active) -> usize {
    let of_pairs = heap(&k.pairs) + heap(&k.areas) + heap(&k.integrated) + heap(&k.excluded);
    heap(&k.x1) + heap(&k.x2) + heap(&k.normals) + of_pairs
}

/// Of surfaces, equations and what is set per node.
pub fn of_setup<const N: usize>(setup: &Setup<N>) -> usize {
    let (surfaces, nodes) = (of_surface(&setup.nonmortar) + of_surface(&setup.mortar), &setup.nodes);
    let overrides = nodes.augmentations.as_ref().map_or(0, heap) + nodes.normals.as_ref().map_or(0, heap);
    surfaces
        + overrides
        + heap(&setup.size_factors)
        + heap(&setup.copies)
        + heap(&setup.multiplier_equations)
        + heap(&nodes.mu)
        + heap(&nodes.free)
        + heap(&nodes.owners)
}

/// Of what t_n settles.
pub fn of_pairing(pairing: &Pairing) -> usize {
    let carriers = heap(&pairing.carriers) + pairing.carriers.iter().map(heap).sum::<usize>();
    pairing.filter.as_ref().map_or(0, of_filter) + heap(&pairing.coverable) + heap(&pairing.keeps_normal) + carriers
}

/// Of a residual.
pub fn of_residual<const N: usize>(r: &Residual<N>) -> usize {
    heap(&r.nonmortar) + heap(&r.mortar) + heap(&r.rows)
}

/// Of the normals of now.
pub fn of_normals(now: &NormalsAt) -> usize {
    heap(&now.x1) + heap(&now.sums) + heap(&now.nu)
}
