//! Which mortar facets may lie over a non-mortar facet: a bounding-volume tree over the mortar facets'
//! boxes, asked with the prism that a non-mortar facet sweeps along its normal. O(log n) a facet,
//! whatever the orientation; the answer is a superset and depends on the positions alone.

use super::boxes::{Aabb, Four};
use super::orientation::{self, Axes, facet_box};
use super::prism::Prism;
use crate::error::Result;
use crate::geometry::{Facet, Vec3};
use crate::memory::{Store, Stored};
use crate::simd::{self, Kernel, Lanes, Stack};

/// Leaves hold at most this many boxes: as many as are compared at once.
const LEAF: usize = 4;
/// The smaller part of a node has at least this of its boxes, or half.
const LEAST_PART: f64 = 0.3;
/// Branches that a query has found and not yet looked into: three for every two levels of a tree over all that a memory can
/// hold. 2^42 boxes have 82 levels if each parts them 3 to 7, and normals are parted up to three times along each axis.
const PENDING: usize = 144;

/// Where the normals of the things in a node differ by more than this along an axis, they are parted by their normals first.
/// Below that, normals that oppose a facet are told from others well enough.
const SPREAD: f64 = 0.25;

/// Boxes are parted along the axis on which most of them would stand side by side, and those that are thinner than this,
/// over how long they are, count as so thick: rounding does not part what is flat.
const THINNEST: f64 = 1e-3;

/// A bounding-volume tree over boxes.
#[derive(Debug, Default)]
pub struct Tree {
    /// Along which axes the boxes lie; `None`: those of space.
    axes: Option<Axes>,
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
        Tree::parted(boxes, &[])
    }

    /// Whether things with these normals are parted by them.
    pub fn parts(normals: &[Vec3]) -> bool {
        let among = Aabb::around(normals.iter().copied());
        widest(&(among.high - among.low)).0 > SPREAD
    }

    /// The same over boxes around things with these normals: what looks elsewhere is in other parts of the tree.
    pub fn parted(boxes: Vec<Aabb>, normals: &[Vec3]) -> Result<Tree> {
        let mut tree = Tree { boxes, ..Tree::default() };
        tree.grow(normals)?;
        Ok(tree)
    }

    /// Becomes the tree over `n` facets, in the memory it has.
    pub fn renew(&mut self, n: usize, facet: &impl Fn(usize) -> Facet) -> Result<()> {
        self.axes = orientation::axes(n, facet);
        self.boxes.clear();
        self.boxes.store_all((0..n).map(|f| facet_box(&facet(f), self.axes.as_ref())))?;
        self.grow(&[])
    }

    /// Builds what is over the boxes.
    fn grow(&mut self, normals: &[Vec3]) -> Result<()> {
        self.nodes.clear();
        self.order.clear();
        self.branches.clear();
        self.order.store_all(0..self.boxes.len())?;
        if !self.boxes.is_empty() {
            let sum = self.boxes.iter().fold(Vec3::zeros(), |sum, b| sum + (b.high - b.low));
            let mean = sum / self.boxes.len() as f64;
            let thick = mean.map(|size| size.max(THINNEST * mean.max()).max(f64::MIN_POSITIVE));
            self.build(&Parting { normals, thick }, 0, self.boxes.len())?;
            self.branch(0)?;
        }
        Ok(())
    }

    /// Fills `found` with the boxes that may reach into `prism`, in ascending order; how many it compared.
    pub fn find(&self, prism: &Prism, found: &mut Vec<usize>) -> Result<usize> {
        found.clear();
        let Some(root) = self.nodes.first() else { return Ok(0) };
        let prism = &prism.among(&root.bounds, self.axes.as_ref());
        let visited = simd::dispatch(Query { branches: &self.branches, prism, found });
        found.sort_unstable();
        visited
    }

    /// Whether its boxes lie along the axes of space.
    pub fn is_along_space(&self) -> bool {
        self.axes.is_none()
    }

    /// Between which heights along `direction`, over `origin`, all boxes lie.
    pub fn along(&self, direction: Vec3, origin: Vec3) -> (f64, f64) {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        self.nodes.first().map_or(none, |root| match &self.axes {
            None => root.bounds.along(direction, origin),
            Some(axes) => root.bounds.along(axes.direction(&direction), axes.place(&origin)),
        })
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

    fn build(&mut self, parting: &Parting, first: usize, end: usize) -> Result<usize> {
        let me = self.nodes.len();
        let bounds = self.boxes[self.order[first]];
        self.nodes.store(TreeNode { bounds, first, count: end - first, right: 0 })?;
        if end - first <= LEAF {
            let held = &self.order[first + 1..end];
            self.nodes[me].bounds = held.iter().fold(bounds, |b, &i| b.union(&self.boxes[i]));
        } else {
            let left = parting.split(&self.boxes, &mut self.order[first..end]);
            self.build(parting, first, first + left)?;
            let right = self.build(parting, first + left, end)?;
            self.nodes[me].bounds = self.nodes[me + 1].bounds.union(&self.nodes[right].bounds);
            self.nodes[me].right = right;
        }
        Ok(me)
    }
}

/// By what the boxes of a node are parted.
struct Parting<'a> {
    /// Of the things in the boxes; empty: where the boxes are decides alone.
    normals: &'a [Vec3],
    /// How thick the boxes are along the axes.
    thick: Vec3,
}

impl Parting<'_> {
    /// Orders boxes so that the first ones, whose number it gives, make one half of a node.
    fn split(&self, boxes: &[Aabb], order: &mut [usize]) -> usize {
        let Parting { normals, thick } = self;
        if !normals.is_empty() {
            let among = Aabb::around(order.iter().map(|&i| normals[i]));
            let (spread, axis) = widest(&(among.high - among.low));
            if spread > SPREAD {
                let middle = 0.5 * (among.low[axis] + among.high[axis]);
                let below = order.iter().filter(|&&i| normals[i][axis] < middle).count();
                order.select_nth_unstable_by(below, |&i, &j| normals[i][axis].total_cmp(&normals[j][axis]));
                return below;
            }
        }
        let middle = |i: usize| boxes[i].low + boxes[i].high; // twice, as all of them
        let among = Aabb::around(order.iter().map(|&i| middle(i)));
        let (_, axis) = widest(&(among.high - among.low).component_div(thick));
        let along = |i: usize| boxes[i].low[axis] + boxes[i].high[axis];
        let part = |order: &mut [usize], at: usize| {
            order.select_nth_unstable_by(at, |&i, &j| along(i).total_cmp(&along(j)));
        };
        let half = order.len() / 2;
        part(order, half);
        // What lies side by side at the middle, as a row or a layer, stays together.
        let (middle, near) = (along(order[half]), 0.5 * thick[axis]);
        let below = order[..half].iter().filter(|&&i| along(i) < middle - near).count();
        let above = half + order[half..].iter().filter(|&&i| along(i) <= middle + near).count();
        let cut = if half - below <= above - half { below } else { above };
        if (cut as f64) < LEAST_PART * order.len() as f64 || (cut as f64) > (1.0 - LEAST_PART) * order.len() as f64 {
            return half;
        }
        if cut < half {
            part(&mut order[..half], cut)
        } else if cut > half {
            part(&mut order[half..], cut - half)
        }
        cut
    }
}

/// The largest component, and which it is.
fn widest(size: &Vec3) -> (f64, usize) {
    let axis = size.imax();
    (size[axis], axis)
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
    use crate::geometry::Plane;
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
