//! Which mortar facets may lie over a non-mortar facet: a bounding-volume tree over the mortar facets'
//! boxes, asked with the prism that a non-mortar facet sweeps along its normal. O(log n) a facet,
//! whatever the orientation; the answer is a superset and depends on the positions alone.

use crate::error::Result;
use crate::geometry::{Plane, Vec3};
use crate::memory::{Store, Stored};
use crate::simd::{self, Kernel, Lanes, Stack};

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

    /// Whether all of the other box is in this one.
    pub fn contains(&self, other: &Aabb) -> bool {
        self.union(other) == *self
    }

    /// Its middle.
    pub fn centre(&self) -> Vec3 {
        (self.low + self.high) * 0.5
    }

    /// The largest distance along any axis that lies between the boxes; 0 where they overlap along all.
    pub fn distance(&self, other: &Aabb) -> f64 {
        (self.low - other.high).sup(&(other.low - self.high)).max().max(0.0)
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

    /// Of four boxes, how far the two overlap along the prism's axes: at least 0 when the box may reach into the prism;
    /// never less when it does.
    #[inline(always)]
    fn overlaps<L: Lanes>(&self, b: &Four) -> [f64; 4] {
        let half = L::splat(0.5);
        let mut most = L::splat(f64::INFINITY);
        // Differences of coordinates first: a common offset costs no digits.
        let (mut centre, mut extent, mut farthest) = ([half; 3], [half; 3], [half; 3]);
        for i in 0..3 {
            let origin = L::splat(self.origin[i]);
            let (low, high) = (L::load(&b.low[i]) - origin, L::load(&b.high[i]) - origin);
            (centre[i], extent[i]) = ((low + high) * half, (high - low) * half);
            farthest[i] = high.max(-low).max(low.max(-high));
        }
        for k in 0..2 {
            let (mut c, mut r) = (L::splat(0.0), L::splat(0.0));
            for i in 0..3 {
                let axis = self.axes[k][i];
                let (size, rounding) = (L::splat(axis.abs()), L::splat(ROUNDING));
                c = L::splat(axis).mul_add(centre[i], c);
                r = size.mul_add(rounding.mul_add(farthest[i], extent[i]), r);
            }
            most = most.min(c + r - L::splat(self.low[k])).min(L::splat(self.high[k]) - (c - r));
        }
        most.store()
    }
}

/// Four boxes, component by component.
#[derive(Debug)]
struct Four {
    low: [[f64; 4]; 3],
    high: [[f64; 4]; 3],
}

impl Four {
    fn of(b: [&Aabb; 4]) -> Four {
        Four { low: [0, 1, 2].map(|i| b.map(|b| b.low[i])), high: [0, 1, 2].map(|i| b.map(|b| b.high[i])) }
    }
}

/// Rounding of a scalar product of three terms and of the interval's ends, over the terms' size: a facet that is huge
/// beside the prism must not be lost to it.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Leaves hold at most this many boxes: as many as are compared at once.
const LEAF: usize = 4;
/// Branches that a query has found and not yet looked into: three a level of a tree over all that a memory can hold.
const PENDING: usize = 96;

/// A bounding-volume tree over boxes.
#[derive(Debug, Default)]
pub struct Tree {
    pub(crate) boxes: Vec<Aabb>,
    pub(crate) nodes: Vec<TreeNode>,
    pub(crate) order: Vec<usize>,
    pub(crate) branches: Vec<Branch>,
}

/// Two levels of the tree, or a leaf: what queries look at.
#[derive(Debug)]
pub struct Branch {
    bounds: Four,
    /// Which branches, or boxes of a leaf, they are around; the first `count` of them.
    below: [usize; 4],
    count: usize,
    is_leaf: bool,
}

#[derive(Debug)]
pub struct TreeNode {
    bounds: Aabb,
    first: usize,
    count: usize,
    right: usize, // 0: a leaf; the left child follows its parent
}

impl Tree {
    /// The tree over `boxes`.
    pub fn new(boxes: Vec<Aabb>) -> Result<Tree> {
        let mut tree = Tree { boxes, ..Tree::default() };
        tree.grow()?;
        Ok(tree)
    }

    /// Becomes the tree over other boxes, in the memory of the one before.
    pub fn renew(&mut self, boxes: impl Iterator<Item = Aabb>) -> Result<()> {
        self.boxes.clear();
        self.boxes.store_all(boxes)?;
        self.grow()
    }

    /// Builds all that is above the boxes.
    fn grow(&mut self) -> Result<()> {
        self.nodes.clear();
        self.branches.clear();
        self.order.clear();
        self.order.store_all(0..self.boxes.len())?;
        if !self.boxes.is_empty() {
            let boxes = std::mem::take(&mut self.boxes);
            let built = self.build(&boxes, 0, boxes.len());
            self.boxes = boxes;
            built?;
            self.branch(0)?;
        }
        Ok(())
    }

    /// Fills `found` with the boxes that may reach into `prism`, in ascending order; how many it compared.
    pub fn find(&self, prism: &Prism, found: &mut Vec<usize>) -> Result<usize> {
        found.clear();
        let visited = simd::dispatch(Query { branches: &self.branches, prism, found });
        found.sort_unstable();
        visited
    }

    /// Appends the branch of a node and all that is below it; its number.
    fn branch(&mut self, node: usize) -> Result<usize> {
        let (mut below, mut count) = ([0; 4], 0);
        let mut add = |k: usize| {
            below[count] = k;
            count += 1;
        };
        let is_leaf = self.nodes[node].right == 0;
        if is_leaf {
            self.held(&self.nodes[node]).iter().for_each(|&k| add(k));
        } else {
            for child in [node + 1, self.nodes[node].right] {
                match self.nodes[child].right {
                    0 => add(child),
                    right => [child + 1, right].into_iter().for_each(&mut add),
                }
            }
        }
        let bounds = |k: usize| if is_leaf { &self.boxes[k] } else { &self.nodes[k].bounds };
        let bounds = Four::of(below.map(bounds)); // of something else in place of those that are missing
        let me = self.branches.len();
        self.branches.store(Branch { bounds, below, count, is_leaf })?;
        if !is_leaf {
            for place in 0..count {
                self.branches[me].below[place] = self.branch(below[place])?;
            }
        }
        Ok(me)
    }

    /// The boxes that a node holds.
    fn held(&self, n: &TreeNode) -> &[usize] {
        &self.order[n.first..n.first + n.count]
    }

    /// Other boxes of the same things, one around all that a node of the tree holds: in the order of `any`'s nodes.
    pub fn gather(&self, boxes: &[Aabb]) -> Result<Vec<Aabb>> {
        let around = |n: &TreeNode| {
            let held = self.held(n);
            held.iter().skip(1).fold(boxes[held[0]], |b, &i| b.union(&boxes[i]))
        };
        self.nodes.iter().map(around).stored()
    }

    /// Whether `is` holds of any box, asked of those alone whose nodes in the tree (index and bounds) all `may`.
    pub fn any(&self, may: &impl Fn(usize, &Aabb) -> bool, is: &impl Fn(usize) -> bool) -> bool {
        self.any_below(0, may, is)
    }

    fn any_below(&self, node: usize, may: &impl Fn(usize, &Aabb) -> bool, is: &impl Fn(usize) -> bool) -> bool {
        let Some(n) = self.nodes.get(node).filter(|n| may(node, &n.bounds)) else { return false };
        if n.right == 0 {
            return self.held(n).iter().any(|&i| is(i));
        }
        self.any_below(node + 1, may, is) || self.any_below(n.right, may, is)
    }

    fn build(&mut self, boxes: &[Aabb], first: usize, end: usize) -> Result<usize> {
        let range = &mut self.order[first..end];
        let bounds = range.iter().skip(1).fold(boxes[range[0]], |b, &i| b.union(&boxes[i]));
        let me = self.nodes.len();
        self.nodes.store(TreeNode { bounds, first, count: end - first, right: 0 })?;
        if end - first > LEAF {
            let axis = (bounds.high - bounds.low).imax();
            let half = (end - first) / 2;
            range.select_nth_unstable_by(half, |&i, &j| boxes[i].centre()[axis].total_cmp(&boxes[j].centre()[axis]));
            self.build(boxes, first, first + half)?;
            let right = self.build(boxes, first + half, end)?;
            self.nodes[me].right = right;
        }
        Ok(me)
    }
}

/// The boxes of leaves that may reach into a prism; how many boxes were compared.
struct Query<'a> {
    branches: &'a [Branch],
    prism: &'a Prism,
    found: &'a mut Vec<usize>,
}

impl Kernel for Query<'_> {
    type Output = Result<usize>;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Result<usize> {
        let (mut pending, mut visited) = (Stack::<usize, PENDING>::new(), 0);
        if !self.branches.is_empty() {
            pending.push(0);
        }
        while let Some(k) = pending.pop() {
            let branch = &self.branches[k];
            visited += branch.count;
            let overlaps = self.prism.overlaps::<L>(&branch.bounds);
            for place in 0..branch.count {
                if overlaps[place] >= 0.0 {
                    if branch.is_leaf {
                        self.found.store(branch.below[place])?;
                    } else {
                        pending.push(branch.below[place]);
                    }
                }
            }
        }
        Ok(visited)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Facet;
    use crate::simd::Plain;

    fn meets(prism: &Prism, b: &Aabb) -> bool {
        prism.overlaps::<Plain>(&Four::of([b; 4]))[0] >= 0.0
    }

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
            let tree = Tree::new(boxes.clone()).unwrap();
            for _ in 0..50 {
                let x: Vec<_> = (0..3).map(|_| Vec3::new(next(), next(), next())).collect();
                let plane = Plane::of(&Facet::new(&x).unwrap()).unwrap();
                let prism = Prism::over(&x, &plane, 0.01);
                let mut found = Vec::new();
                tree.find(&prism, &mut found).unwrap();
                let expected: Vec<_> = (0..n).filter(|&i| meets(&prism, &boxes[i])).collect();
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
            assert!(meets(&Prism::over(&x, &plane, 1e-12), &Aabb::around([inside])));
        }
    }
}
