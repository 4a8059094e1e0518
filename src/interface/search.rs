//! Which mortar facets may lie over a non-mortar facet: a bounding-volume tree over the mortar facets'
//! boxes, asked with the prism that a non-mortar facet sweeps along its normal. O(log n) a facet,
//! whatever the orientation; the answer is a superset and depends on the positions alone.

use crate::geometry::{Plane, Vec3};

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

    /// The box around both.
    pub fn union(&self, other: &Aabb) -> Aabb {
        Aabb { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    fn centre(&self) -> Vec3 {
        (self.low + self.high) * 0.5
    }

    /// Along which axes more than `distance` lies between the boxes: this one above the other, then below it.
    pub fn sides(&self, other: &Aabb, distance: f64) -> [bool; 6] {
        let (above, below) = (self.low - other.high, other.low - self.high);
        [above.x, above.y, above.z, below.x, below.y, below.z].map(|between| between > distance)
    }

    /// The least and the largest height of any point of the box along `direction`, over `origin`.
    pub fn along(&self, direction: Vec3, origin: Vec3) -> (f64, f64) {
        let (centre, half) = (self.centre() - origin, (self.high - self.low) * 0.5);
        let (c, r) = (direction.dot(&centre), direction.abs().dot(&half));
        (c - r, c + r)
    }
}

/// What a facet sweeps along its normal, both ways without end: intervals along the plane's two axes.
#[derive(Clone, Copy, Debug)]
pub struct Prism {
    origin: Vec3,
    axes: [Vec3; 2],
    low: [f64; 2],
    high: [f64; 2],
}

impl Prism {
    /// The prism over `points` in the directions of `plane`, grown by `margin` on every side.
    pub fn over(points: &[Vec3], plane: &Plane, margin: f64) -> Prism {
        let (origin, axes) = (plane.reference, [plane.t1, plane.t2]);
        let along = |k: usize| points.iter().map(move |p| axes[k].dot(&(p - origin)));
        Prism {
            origin,
            axes,
            low: [0, 1].map(|k| along(k).fold(f64::INFINITY, f64::min) - margin),
            high: [0, 1].map(|k| along(k).fold(f64::NEG_INFINITY, f64::max) + margin),
        }
    }

    /// Whether the box may reach into the prism; never false when it does.
    fn meets(&self, b: &Aabb) -> bool {
        // Differences of coordinates first: a common offset costs no digits.
        let (low, high) = (b.low - self.origin, b.high - self.origin);
        let (centre, half, farthest) = ((low + high) * 0.5, (high - low) * 0.5, low.abs().sup(&high.abs()));
        (0..2).all(|k| {
            let axis = self.axes[k].abs();
            let (c, r) = (self.axes[k].dot(&centre), axis.dot(&half) + ROUNDING * axis.dot(&farthest));
            c + r >= self.low[k] && c - r <= self.high[k]
        })
    }
}

/// Rounding of a scalar product of three terms and of the interval's ends, over the terms' size: a facet that is huge
/// beside the prism must not be lost to it.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Leaves hold at most this many boxes: fewer make a deeper tree, more make a slower query.
const LEAF: usize = 4;

/// A bounding-volume tree over boxes.
#[derive(Debug)]
pub struct Tree {
    pub(super) boxes: Vec<Aabb>,
    pub(super) nodes: Vec<TreeNode>,
    pub(super) order: Vec<usize>,
}

#[derive(Debug)]
pub(super) struct TreeNode {
    bounds: Aabb,
    first: usize,
    count: usize,
    right: usize, // 0: a leaf; the left child follows its parent
}

impl Tree {
    /// The tree over `boxes`.
    pub fn new(boxes: Vec<Aabb>) -> Tree {
        let mut tree = Tree { nodes: Vec::new(), order: (0..boxes.len()).collect(), boxes: Vec::new() };
        if !boxes.is_empty() {
            tree.build(&boxes, 0, boxes.len());
        }
        tree.boxes = boxes;
        tree
    }

    /// Fills `found` with the boxes that may reach into `prism`, in ascending order; how many it compared.
    pub fn find(&self, prism: &Prism, found: &mut Vec<usize>) -> usize {
        found.clear();
        let visited = self.query(prism, 0, found);
        found.sort_unstable();
        visited
    }

    /// Other boxes of the same things, one around all that a node of the tree holds: in the order of `any`'s nodes.
    pub fn gather(&self, boxes: &[Aabb]) -> Vec<Aabb> {
        let around = |n: &TreeNode| {
            let held = &self.order[n.first..n.first + n.count];
            held.iter().skip(1).fold(boxes[held[0]], |b, &i| b.union(&boxes[i]))
        };
        self.nodes.iter().map(around).collect()
    }

    /// Whether `is` holds of any box, asked of those alone whose nodes in the tree (index and bounds) all `may`.
    pub fn any(&self, may: &impl Fn(usize, &Aabb) -> bool, is: &impl Fn(usize) -> bool) -> bool {
        self.any_below(0, may, is)
    }

    fn any_below(&self, node: usize, may: &impl Fn(usize, &Aabb) -> bool, is: &impl Fn(usize) -> bool) -> bool {
        let Some(n) = self.nodes.get(node).filter(|n| may(node, &n.bounds)) else { return false };
        if n.right == 0 {
            return self.order[n.first..n.first + n.count].iter().any(|&i| is(i));
        }
        self.any_below(node + 1, may, is) || self.any_below(n.right, may, is)
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

    fn query(&self, prism: &Prism, node: usize, found: &mut Vec<usize>) -> usize {
        let Some(n) = self.nodes.get(node) else { return 0 };
        if !prism.meets(&n.bounds) {
            return 1;
        }
        if n.right == 0 {
            let leaf = &self.order[n.first..n.first + n.count];
            found.extend(leaf.iter().filter(|&&i| prism.meets(&self.boxes[i])));
            1 + leaf.len()
        } else {
            1 + self.query(prism, node + 1, found) + self.query(prism, n.right, found)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Facet;

    fn random_numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as f64 / (1u64 << 31) as f64
        }
    }

    fn random_boxes(n: usize, seed: u64, size: f64) -> Vec<Aabb> {
        let mut next = random_numbers(seed);
        let mut point = move || Vec3::new(next(), next(), next());
        (0..n)
            .map(|_| {
                let p = point();
                Aabb::around([p, p + point() * size])
            })
            .collect()
    }

    #[test]
    fn finds_what_all_against_all_finds() {
        let mut next = random_numbers(7);
        for (n, size) in [(0, 0.1), (1, 1.0), (3, 0.1), (300, 0.05), (1000, 0.3)] {
            let boxes = random_boxes(n, 2, size);
            let tree = Tree::new(boxes.clone());
            for _ in 0..50 {
                let x: Vec<_> = (0..3).map(|_| Vec3::new(next(), next(), next())).collect();
                let plane = Plane::of(&Facet::new(&x).unwrap()).unwrap();
                let prism = Prism::over(&x, &plane, 0.01);
                let mut found = Vec::new();
                tree.find(&prism, &mut found);
                let expected: Vec<_> = (0..n).filter(|&i| prism.meets(&boxes[i])).collect();
                assert_eq!(found, expected);
            }
        }
    }

    #[test]
    fn a_point_over_the_facet_is_never_missed() {
        let mut next = random_numbers(3);
        for _ in 0..1000 {
            let x: Vec<_> = (0..3).map(|_| Vec3::new(next(), next(), next())).collect();
            let plane = Plane::of(&Facet::new(&x).unwrap()).unwrap();
            let inside = (x[0] + x[1] + x[2]) / 3.0 + plane.e * (10.0 * next() - 5.0);
            assert!(Prism::over(&x, &plane, 1e-12).meets(&Aabb::around([inside])));
        }
    }
}
