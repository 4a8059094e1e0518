//! Weakly covered nodes, and which nodes carry them (docs/formulation 6.7).
//!
//! The multiplier of a node of which a sliver is covered is a point load at the sliver's end: the constraint g_A >= 0
//! holds at a point however small the area, and its multiplier grows without bound as the sliver goes. So such a node A
//! has no multiplier of its own: covered neighbours B carry it,
//!
//!   lambda_A = sum_B w_AB lambda_B,   and row B has the gap g_B + sum_A w_AB g_A,   sum_B w_AB = 1,
//!
//! that is, the multiplier's shape functions are Phi_B = N_B + sum_A w_AB N_A. They hold the constants, so that the
//! patch test stays exact, and the sliver's force goes to zero with its area. (The extension of B-splines in fictitious
//! domain methods does the same: Hoellig, Reif, Wipper 2001.) `carried.rs` has the rows, forces and tangents.
//!
//! Which nodes are weak and the weights w are settled by t_n: functions of the history, constants of the step.

use crate::error::Result;
use crate::interface::data::history::History;
use crate::interface::data::surface::Surface;
use crate::memory::{self, Store, Stored};

/// A neighbour's share of a weak node: (node, w).
pub type Carrier = (usize, f64);

/// Newly covered nodes up to so many facets from the nearest node with a multiplier are carried by it; ones farther off
/// have their own, as nodes that come into contact elsewhere do.
const REACH: usize = 4;
/// Neighbours whose normals enclose more than 60 degrees do not carry each other: a traction is carried as a vector.
const LEAST_ALIGNMENT: f64 = 0.5;

/// What the search for carriers needs to know of the nodes.
pub struct Nodes<'a> {
    /// Covered over full area at t_n.
    pub fraction: &'a [f64],
    /// Whether anything can cover a node in the step.
    pub coverable: &'a [bool],
    /// Whether a node has a multiplier at all.
    pub has_multiplier: &'a dyn Fn(usize) -> bool,
}

/// A node covered up to this is covered as a whole: on facets that are no parallelograms the rule's error is in the
/// fraction, and in any fraction rounding.
const WHOLE: f64 = 0.99;

/// Per node its carriers, sorted; none where it has a multiplier of its own. A node is weak where a part of it is not
/// covered and what is covered is less than `part` times its best covered neighbour.
pub fn carriers(nodes: &Nodes, links: &[Vec<Carrier>], part: f64) -> Result<Vec<Vec<Carrier>>> {
    let n = nodes.fraction.len();
    let takes_part = |a: usize| nodes.coverable[a] && (nodes.has_multiplier)(a);
    let best = |a: usize| {
        let others = links[a].iter().map(|&(b, _)| b).filter(|&b| takes_part(b));
        others.map(|b| nodes.fraction[b]).fold(0.0, f64::max)
    };
    let enough = |a: usize| nodes.fraction[a] >= WHOLE || nodes.fraction[a] >= part * best(a);
    let strong = |a: usize| takes_part(a) && nodes.fraction[a] > 0.0 && enough(a);
    let strong: Vec<bool> = (0..n).map(strong).stored()?;
    let own = |a: usize| if strong[a] { memory::filled((a, 1.0), 1) } else { Ok(Vec::new()) };
    let mut carriers: Vec<Vec<Carrier>> = (0..n).map(own).stored_if_ok()?;
    for _ in 0..REACH {
        let next = |a: usize| {
            let carried = takes_part(a) && carriers[a].is_empty();
            if carried { mean(links[a].iter().map(|&(b, w)| (&carriers[b], w))) } else { Ok(Vec::new()) }
        };
        let found: Vec<_> = (0..n).map(next).stored_if_ok()?;
        for (all, new) in carriers.iter_mut().zip(found).filter(|(_, new)| !new.is_empty()) {
            *all = new;
        }
    }
    for a in (0..n).filter(|&a| strong[a]) {
        carriers[a] = Vec::new();
    }
    Ok(carriers)
}

/// The weighted mean of some nodes' carriers, each node's sum being 1 or 0.
fn mean<'a>(nodes: impl Iterator<Item = (&'a Vec<Carrier>, f64)>) -> Result<Vec<Carrier>> {
    let all = nodes.flat_map(|(carriers, w)| carriers.iter().map(move |&(b, v)| (b, w * v)));
    let mut sum = gather(all.stored()?)?;
    let total: f64 = sum.iter().map(|(_, w)| w).sum();
    sum.iter_mut().for_each(|(_, w)| *w /= total);
    Ok(sum)
}

/// Sorted by node, the weights of a node added up.
pub fn gather(all: Vec<Carrier>) -> Result<Vec<Carrier>> {
    let mut all = memory::sorted(&all, |p, q| p.0.cmp(&q.0).then(p.1.total_cmp(&q.1)))?;
    all.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        kept.1 += if same { next.1 } else { 0.0 };
        same
    });
    Ok(all)
}

/// How often a facet's area counts between its i-th and its l-th node: twice at an edge, as int N_A N_B da on parallelograms; `None`:
/// their normals differ too much.
pub fn share(surface: &Surface, history: &History, (f, i, l): (usize, usize, usize)) -> Option<f64> {
    let nodes = surface.rows(f).as_slice();
    let diagonal = nodes.len() == 4 && (i + 2) % 4 == l;
    let aligned = history.normals[nodes[i]].dot(&history.normals[nodes[l]]) >= LEAST_ALIGNMENT;
    aligned.then_some(if diagonal { 1.0 } else { 2.0 })
}

/// Per node the nodes that share a facet with it, each with the facets' area, as often as it counts.
pub fn links(surface: &Surface, history: &History) -> Result<Vec<Vec<Carrier>>> {
    let mut links = memory::defaults::<Vec<_>>(surface.len())?;
    for f in 0..surface.facets.len() {
        let area = surface.facet(f, &history.x1).area_vector().norm();
        let nodes = surface.rows(f).as_slice();
        for (i, &a) in nodes.iter().enumerate() {
            for (l, &b) in nodes.iter().enumerate().filter(|&(l, _)| l != i) {
                if let Some(times) = share(surface, history, (f, i, l)) {
                    links[a].store((b, times * area))?;
                }
            }
        }
    }
    links.into_iter().map(gather).stored_if_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(fraction: &[f64], part: f64) -> Vec<Vec<Carrier>> {
        let n = fraction.len();
        // A strip of facets.
        let neighbours = |a: usize| [a.checked_sub(1), (a + 1 < n).then_some(a + 1)];
        let links: Vec<_> = (0..n).map(|a| neighbours(a).into_iter().flatten().map(|b| (b, 2.0)).collect()).collect();
        let nodes = Nodes { fraction, coverable: &vec![true; n], has_multiplier: &|_| true };
        carriers(&nodes, &links, part).unwrap()
    }

    #[test]
    fn the_best_covered_neighbour_carries_the_end_of_a_strip() {
        let none: Vec<Carrier> = Vec::new();
        let found = found(&[1.0, 1.0, 0.6, 0.05, 0.0, 0.0, 0.0, 0.0], 0.25);
        assert_eq!(found[..3], [none.clone(), none.clone(), none.clone()]);
        assert_eq!(found[3..7], [(); 4].map(|()| vec![(2, 1.0)]), "as far as {REACH} facets");
        assert_eq!(found[7], none);
    }

    #[test]
    fn a_node_between_two_is_carried_by_both() {
        assert_eq!(found(&[1.0, 0.1, 1.0], 0.25)[1], [(0, 0.5), (2, 0.5)]);
    }

    #[test]
    fn a_small_patch_within_a_facet_keeps_its_multipliers() {
        assert!(found(&[0.01, 0.009, 0.0101], 0.25).iter().all(Vec::is_empty));
        assert!(found(&[0.0; 4], 0.25).iter().all(Vec::is_empty));
    }
}
