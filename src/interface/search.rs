//! Which facets may overlap: a guaranteed superset by bounding boxes, with a skin, so that it is built
//! anew only when something has moved out of its skin.
//!
//! A non-mortar facet's box reaches along its normal. Whether two current boxes meet is pure geometry
//! and part of what makes a pair active; the superset only saves asking for all of them.

use crate::geometry::Vec3;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    low: Vec3,
    high: Vec3,
}

impl Aabb {
    /// The box around some points.
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Aabb {
        let empty = Aabb { low: Vec3::repeat(f64::INFINITY), high: Vec3::repeat(f64::NEG_INFINITY) };
        points.into_iter().fold(empty, |b, p| Aabb { low: b.low.inf(&p), high: b.high.sup(&p) })
    }

    /// Grown by `margin` on every side.
    pub fn grown(self, margin: f64) -> Aabb {
        Aabb { low: self.low.add_scalar(-margin), high: self.high.add_scalar(margin) }
    }

    /// Whether two boxes share a point.
    pub fn meets(&self, other: &Aabb) -> bool {
        (0..3).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }

    fn contains(&self, other: &Aabb) -> bool {
        (0..3).all(|i| self.low[i] <= other.low[i] && other.high[i] <= self.high[i])
    }

    fn union(&self, other: &Aabb) -> Aabb {
        Aabb { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    fn centre(&self) -> Vec3 {
        (self.low + self.high) * 0.5
    }

    /// Length of the diagonal.
    pub fn diagonal(&self) -> f64 {
        (self.high - self.low).norm()
    }
}

/// Leaves hold at most this many boxes: fewer make a deeper tree, more make a slower query.
const LEAF: usize = 4;

/// A bounding-volume tree over boxes.
#[derive(Debug, Default)]
struct Tree {
    nodes: Vec<TreeNode>,
    order: Vec<usize>,
}

#[derive(Debug)]
struct TreeNode {
    bounds: Aabb,
    first: usize,
    count: usize,
    right: usize, // 0: a leaf; the left child follows its parent
}

impl Tree {
    fn new(boxes: &[Aabb]) -> Tree {
        let mut tree = Tree { nodes: Vec::new(), order: (0..boxes.len()).collect() };
        if !boxes.is_empty() {
            tree.build(boxes, 0, boxes.len());
        }
        tree
    }

    fn build(&mut self, boxes: &[Aabb], first: usize, end: usize) -> usize {
        let range = &mut self.order[first..end];
        let bounds = range.iter().skip(1).fold(boxes[range[0]], |b, &i| b.union(&boxes[i]));
        let me = self.nodes.len();
        self.nodes.push(TreeNode { bounds, first, count: end - first, right: 0 });
        if end - first > LEAF {
            let axis = (bounds.high - bounds.low).imax();
            let half = (end - first) / 2;
            range.select_nth_unstable_by(half, |&i, &j| boxes[i].centre()[axis].total_cmp(&boxes[j].centre()[axis]));
            self.build(boxes, first, first + half);
            let right = self.build(boxes, first + half, end);
            self.nodes[me].right = right;
        }
        me
    }

    fn query(&self, boxes: &[Aabb], target: &Aabb, node: usize, visit: &mut impl FnMut(usize)) {
        let Some(n) = self.nodes.get(node) else { return };
        if !n.bounds.meets(target) {
            return;
        }
        if n.right == 0 {
            let leaf = &self.order[n.first..n.first + n.count];
            leaf.iter().filter(|&&i| boxes[i].meets(target)).for_each(|&i| visit(i));
        } else {
            self.query(boxes, target, node + 1, visit);
            self.query(boxes, target, n.right, visit);
        }
    }
}

/// A superset of the pairs that may be active.
#[derive(Debug, Default)]
pub struct Candidates {
    /// (non-mortar facet, mortar facet), sorted.
    pub pairs: Vec<(usize, usize)>,
    skins: [Vec<Aabb>; 2],
}

impl Candidates {
    /// Whether the list still covers all pairs whose boxes may meet.
    pub fn covers(&self, one: &[Aabb], two: &[Aabb]) -> bool {
        let within = |skins: &[Aabb], boxes: &[Aabb]| {
            skins.len() == boxes.len() && skins.iter().zip(boxes).all(|(s, b)| s.contains(b))
        };
        within(&self.skins[0], one) && within(&self.skins[1], two)
    }

    /// Lists all pairs whose boxes, each grown by `skin`, meet and that `admit` lets pass.
    pub fn build(one: &[Aabb], two: &[Aabb], skin: f64, admit: impl Fn(usize, usize) -> bool) -> Candidates {
        let grow = |boxes: &[Aabb]| boxes.iter().map(|b| b.grown(skin)).collect::<Vec<_>>();
        let skins = [grow(one), grow(two)];
        let tree = Tree::new(&skins[1]);
        let mut pairs = Vec::new();
        for (i, target) in skins[0].iter().enumerate() {
            let first = pairs.len();
            tree.query(&skins[1], target, 0, &mut |j| {
                if admit(i, j) {
                    pairs.push((i, j));
                }
            });
            pairs[first..].sort_unstable();
        }
        Candidates { pairs, skins }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random_boxes(n: usize, seed: u64, size: f64) -> Vec<Aabb> {
        let mut state = seed;
        let mut next = move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as f64 / (1u64 << 31) as f64
        };
        (0..n)
            .map(|_| {
                let p = Vec3::new(next(), next(), next());
                Aabb::around([p, p + Vec3::new(next(), next(), next()) * size])
            })
            .collect()
    }

    #[test]
    fn finds_what_all_against_all_finds() {
        for (n1, n2, size) in [(1, 1000, 1.0), (1000, 1, 0.1), (200, 300, 0.05), (3, 0, 0.1)] {
            let (one, two) = (random_boxes(n1, 1, size), random_boxes(n2, 2, size));
            let found = Candidates::build(&one, &two, 0.01, |i, j| (i + j) % 3 != 0);
            let mut expected = Vec::new();
            for i in 0..n1 {
                for j in 0..n2 {
                    if (i + j) % 3 != 0 && one[i].grown(0.01).meets(&two[j].grown(0.01)) {
                        expected.push((i, j));
                    }
                }
            }
            assert_eq!(found.pairs, expected);
        }
    }

    #[test]
    fn covers_motion_within_the_skin_only() {
        let (one, two) = (random_boxes(5, 1, 0.1), random_boxes(5, 2, 0.1));
        let found = Candidates::build(&one, &two, 0.01, |_, _| true);
        let moved = |d: f64| {
            one.iter().map(|b| Aabb { low: b.low.add_scalar(d), high: b.high.add_scalar(d) }).collect::<Vec<_>>()
        };
        assert!(found.covers(&one, &two));
        assert!(found.covers(&moved(0.009), &two));
        assert!(!found.covers(&moved(0.011), &two));
        assert!(!Candidates::default().covers(&one, &two));
    }
}
