//! Which nodes can be covered at all before the next commit. What a commit settles holds until the next one, whatever
//! the positions do: a facet that no facet of the other side passes the filter with has no pair, and a node among such
//! facets alone no coverage, no gap and no traction; its multiplier row is -lambda / r.

use super::filter::{FacetFilter, Filter, LEAST_OPPOSITION};
use super::search::{Aabb, Tree};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::Surface;
use crate::memory::{self, Stored};

/// Room for rounding in a box's bounds (of normals; of heights over the facet's longest edge), so that a box never
/// refuses what a facet in it would pass.
const MARGIN: f64 = 1e-9;

/// Per non-mortar facet, whether any mortar facet passes the filter with it. `tree` is over the mortar facets, with a box
/// of points and one of normals a node: O(log n) a facet, but for those on the border between yes and no.
pub fn reached(filter: &FacetFilter, tree: &Tree) -> Result<Vec<bool>> {
    let [one, two] = &filter.sides;
    let normals: Vec<_> = two.facets.iter().map(|(_, plane)| Aabb::around([plane.e])).stored()?;
    let normals = tree.gather(&normals)?;
    let deepest = filter.deepest_of_each()?;
    let any = |i: usize| {
        let (facet, plane) = &one.facets[i];
        let margin = MARGIN * facet.longest_edge();
        let (gap, penetration) = (filter.gap() + margin, deepest[i] + margin);
        let centre = plane.reference + plane.origin;
        let may = |node: usize, points: &Aabb| {
            let (low, high) = points.along(plane.e, centre);
            let (opposition, _) = normals[node].along(plane.e, Vec3::zeros());
            low <= gap && high >= -penetration && opposition < MARGIN - LEAST_OPPOSITION
        };
        tree.any(&may, &|j| filter.admits(i, j))
    };
    (0..one.facets.len()).map(any).stored()
}

/// Per non-mortar node, whether it belongs to one of some facets.
fn nodes_of(nonmortar: &Surface, facets: impl Iterator<Item = usize>) -> Result<Vec<bool>> {
    let mut nodes = memory::filled(false, nonmortar.len())?;
    for facet in facets.map(|f| &nonmortar.facets[f]) {
        facet.nodes[..facet.len].iter().for_each(|&a| nodes[a] = true);
    }
    Ok(nodes)
}

/// Per non-mortar node, whether anything can cover it: by the filter, or by the pairs whose weights are frozen.
pub fn coverable(nonmortar: &Surface, filter: Option<&Filter>, frozen: Option<&[PairRecord]>) -> Result<Vec<bool>> {
    match (frozen, filter.map(Filter::reached)) {
        (Some(pairs), _) => nodes_of(nonmortar, pairs.iter().map(|pair| pair.one)),
        (None, Some(reached)) => nodes_of(nonmortar, (0..reached.len()).filter(|&f| reached[f])),
        (None, None) => memory::filled(true, nonmortar.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::pairing::filter::Side;

    /// Surfaces of scattered facets of either size, any way round: the tree finds what all against all finds.
    #[test]
    fn a_facet_is_reached_when_any_other_one_passes_the_filter_with_it() {
        let mut state = 11_u64;
        let mut next = move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as f64 / (1u64 << 30) as f64 - 1.0
        };
        let mut seen = [0; 2];
        for round in 0..60 {
            // Half of them bent little, as bodies that look one way.
            let (bend, spread) = if round % 2 == 0 { (1.0, 2.0) } else { (0.1, 3.0) };
            let mut surface = |side: &'static str, n: usize, size: f64, up: f64| {
                let mut x = Vec::new();
                for _ in 0..n {
                    let centre = Vec3::new(next(), next(), next()) * spread;
                    let mut corner = |a: f64, b: f64| {
                        Vec3::new(a, b * up, 0.0) + Vec3::new(next() * 0.2, next() * 0.2, next()) * bend
                    };
                    x.extend([corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)].map(|c| centre + c * size));
                }
                let facets: Vec<Vec<i64>> = (0..n as i64).map(|f| vec![3 * f, 3 * f + 1, 3 * f + 2]).collect();
                let equations = vec![[-1; 3]; x.len()];
                Surface::new(side, x, &facets, equations).unwrap()
            };
            let (one, two) = (surface("nonmortar", 20, 0.3, -1.0), surface("mortar", 12, 0.2, 1.0));
            let side = |surface: &Surface| Side::new(surface, &surface.reference).unwrap();
            let filter = FacetFilter {
                sides: [side(&one), side(&two)],
                distance: (round % 3 > 0).then_some(0.05),
                depths: Vec::new(),
                reached: Vec::new(),
                by_overlaps: Vec::new(),
            };
            let expected: Vec<_> = (0..20).map(|i| (0..12).any(|j| filter.admits(i, j))).collect();
            let tree = Tree::new(two.facets.iter().map(|f| Aabb::around(f.nodes.map(|k| two.reference[k]))).collect())
                .unwrap();
            assert_eq!(reached(&filter, &tree).unwrap(), expected, "round {round}");
            expected.iter().for_each(|&any| seen[usize::from(any)] += 1);
        }
        assert!(seen[0] > 100 && seen[1] > 100, "both answers occur: {seen:?}");
    }
}
