//! Copies of a node on a crease (docs/formulation 6.5), and what each of them does in a step. Settled by t_n.
//!
//! Copies share displacements. Where two of them touch different faces, as in a corner, two normals hold the node, and a third condition,
//! of sticking, would be one of the two again: the matrix is singular. So a copy acts without friction in a step in which another one may
//! be in contact, too; one that is alone in contact has friction as any other node.
//!
//! Where they have the same face opposite, dual gaps are the gap of the one point, in all copies: one condition, several multipliers.
//! A side that stands off that face stays open where another side lies on it. Where all stand off, the edge itself touches, and where
//! all lie on it, it is pressed flat: one copy carries the others, with the normal of the face.

use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::history::History;
use crate::interface::data::options::Options;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::filter::LEAST_OPPOSITION;
use crate::interface::pairing::weak::{self, Carrier};
use crate::memory::{self, Store};
use crate::normal::SMALLEST_SUM;

/// A copy that is farther open than so many facets at t_n is not taken to close within the step: where the sides of an edge lean over the
/// other surface by 40 degrees it is open by 0.4.
pub const FACETS: f64 = 0.2;
/// cos 20 degrees: a side lies on a face that it encloses no larger angle with. Of two sides that differ by the angle from which on the
/// driver splits, 40 degrees, not more than one does.
const LIES_ON: f64 = 0.939_692_620_785_908_4;
/// cos 45 degrees: faces that differ by no more are one face.
const ONE_FACE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// What the copies do.
#[derive(Debug, Default)]
pub struct Corners {
    /// Per node, whether it acts without friction for the sake of a copy; empty where none does.
    pub frictionless: Vec<bool>,
    /// Per node, whether it stays open, since a copy lies on what it would meet; empty where none does.
    pub open: Vec<bool>,
    /// Edges of which one copy carries the others.
    pub edges: Vec<Edge>,
}

/// Copies of nodes on creases, and what is known of them at creation.
pub struct Copies<'a> {
    /// Pairs of them, both ways round.
    pub pairs: &'a [[usize; 2]],
    /// The non-mortar side.
    pub surface: &'a Surface,
    /// The interface's choices.
    pub options: &'a Options,
    /// Whether the law slips.
    pub slips: bool,
    /// Whether a node has a multiplier at all.
    pub has_multiplier: &'a dyn Fn(usize) -> bool,
}

impl Copies<'_> {
    fn is_covered(&self, h: &History, a: usize) -> bool {
        h.coverage[a] > self.options.coverage_min * h.areas[a]
    }
}

/// Copies of a node that touch as one.
#[derive(Debug)]
pub struct Edge {
    /// All of them; the first one carries the others.
    pub sides: Vec<usize>,
    /// nu of the step, of all of them: the normal of the face, along which a smooth face pushes whatever lies on it.
    pub normal: Vec3,
}

impl Edge {
    /// The sum of the sides' normals.
    pub fn sum(&self, normal: &dyn Fn(usize) -> Vec3) -> Vec3 {
        self.sides.iter().fold(Vec3::zeros(), |sum, &a| sum + normal(a))
    }
}

impl Corners {
    /// Those of a step. Adds copies that others carry to `carriers`.
    pub fn settle(
        copies: &Copies,
        h: &History,
        coverable: &[bool],
        carriers: &mut Vec<Vec<Carrier>>,
    ) -> Result<Corners> {
        let mut corners = Corners::default();
        if copies.pairs.is_empty() || !h.integrated {
            return Ok(corners);
        }
        let may_touch = |a: usize| coverable[a] && (copies.has_multiplier)(a);
        let touches = |a: usize| may_touch(a) && copies.is_covered(h, a);
        if copies.options.tells_copies_apart() {
            let sums = opposite(copies, h)?;
            let face_of = |a: usize| (touches(a) && sums[a].norm() > SMALLEST_SUM).then(|| -sums[a].normalize());
            for group in copies.pairs.chunk_by(|p, q| p[0] == q[0]).filter(|group| group[0][0] < group[0][1]) {
                let mut sides = Vec::new();
                for &[first, other] in [[group[0][1], group[0][0]]].iter().chain(group) {
                    // What a side will meet that meets nothing yet: the face of a copy that it looks at.
                    let looks_at = |face: &Vec3| may_touch(other) && face.dot(&h.normals[other]) > LEAST_OPPOSITION;
                    let of_others = || group.iter().find_map(|&[_, b]| face_of(b).filter(looks_at));
                    let of_copy = || face_of(first).filter(looks_at).or_else(of_others);
                    if let Some(face) = face_of(other).or_else(of_copy) {
                        sides.store(Side { node: other, face })?;
                    }
                }
                corners.tell_apart(sides, h, carriers)?;
            }
        }
        if copies.slips {
            let mut frictionless = memory::filled(false, coverable.len())?;
            let stands_in = |b: usize| !corners.is_open(b) && carriers.get(b).is_none_or(Vec::is_empty);
            let surface = copies.surface;
            let near = |b: usize| height(h, b) <= FACETS * surface.size(h.areas[b], h.x1[b]);
            for &[a, b] in copies.pairs {
                frictionless[a] |= touches(b) && stands_in(b) && near(b);
            }
            corners.frictionless = frictionless;
        }
        Ok(corners)
    }

    /// Of the copies of one node that may touch, face by face.
    fn tell_apart(&mut self, mut sides: Vec<Side>, h: &History, carriers: &mut Vec<Vec<Carrier>>) -> Result<()> {
        let lies = |side: &Side| side.face.dot(&h.normals[side.node]) >= LIES_ON;
        while let Some(&Side { face, .. }) = sides.first() {
            let has_it = |side: &Side| side.face.dot(&face) >= ONE_FACE;
            let any_lies = sides.iter().any(|side| has_it(side) && lies(side));
            let (mut touching, mut faces) = (Vec::new(), Vec3::zeros());
            for side in sides.iter().filter(|side| has_it(side)) {
                if lies(side) == any_lies {
                    touching.store(side.node)?;
                    faces += side.face;
                } else {
                    self.keep_open(side.node, h.x1.len())?;
                }
            }
            sides.retain(|side| !has_it(side));
            if let [first, others @ ..] = &touching[..]
                && !others.is_empty()
            {
                others.iter().try_for_each(|&a| hand_over(carriers, a, *first, h.x1.len()))?;
                self.edges.store(Edge { sides: touching, normal: faces.normalize() })?;
            }
        }
        Ok(())
    }

    fn keep_open(&mut self, a: usize, nodes: usize) -> Result<()> {
        if self.open.is_empty() {
            self.open = memory::filled(false, nodes)?;
        }
        self.open[a] = true;
        Ok(())
    }

    /// Whether a node stays open in the step.
    pub fn is_open(&self, a: usize) -> bool {
        self.open.get(a).is_some_and(|open| *open)
    }

    /// The edge that a node belongs to.
    pub fn edge(&self, a: usize) -> Option<&Edge> {
        self.edges.iter().find(|edge| edge.sides.contains(&a))
    }
}

/// A copy that may touch, with the normal of the face opposite, as nu into the non-mortar body.
struct Side {
    node: usize,
    face: Vec3,
}

/// The gap of a covered node along nu at t_n `[L]`.
fn height(h: &History, a: usize) -> f64 {
    h.gap[a].dot(&h.normals[a]) / h.coverage[a]
}

/// Per node minus the sum of the normals of what the corners of its facets have opposite, the surface of the points x - g / m; 0 where too
/// little is covered.
fn opposite(copies: &Copies, h: &History) -> Result<Vec<Vec3>> {
    let mut points = memory::copied(&h.x1)?;
    for (a, point) in points.iter_mut().enumerate() {
        // A corner with a neighbour that is nowhere has no normal.
        *point = if copies.is_covered(h, a) { *point - h.gap[a] / h.coverage[a] } else { Vec3::repeat(f64::NAN) };
    }
    // Nodes in the middle of edges and facets, which have no gap of their own.
    for f in 0..copies.surface.host_facets() {
        let (nodes, n) = (copies.surface.host_nodes(f), copies.surface.multipliers(f));
        for k in n..nodes.len() {
            points[nodes[k]] = match nodes.get(k - n) {
                Some(&corner) if k < 2 * n => (points[corner] + points[nodes[(k - n + 1) % n]]) / 2.0,
                _ => nodes[..n].iter().map(|&corner| points[corner]).sum::<Vec3>() / n as f64,
            };
        }
    }
    copies.surface.sums_of_normals(&points)
}

/// `from` and all that it carries are carried by `to`, or by who carries that.
fn hand_over(carriers: &mut Vec<Vec<Carrier>>, from: usize, to: usize, n: usize) -> Result<()> {
    if carriers.is_empty() {
        *carriers = memory::defaults(n)?;
    }
    let mut heirs = memory::copied(&carriers[to])?;
    if heirs.is_empty() {
        heirs.store((to, 1.0))?;
    }
    for all in carriers.iter_mut() {
        if let Some(k) = all.iter().position(|&(b, _)| b == from) {
            let (_, share) = all.swap_remove(k);
            all.store_all(heirs.iter().map(|&(b, w)| (b, share * w)))?;
            *all = weak::gather(std::mem::take(all))?;
        }
    }
    carriers[from] = heirs;
    Ok(())
}
