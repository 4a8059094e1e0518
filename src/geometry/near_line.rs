//! Signed distances of points that lie nearly on a line, in twice the precision of a double (docs/formulation
//! 3.7).
//!
//! Where two edges cross at a small angle, the crossing's parameter tau = d0 / (d0 - d1) is known to the error of the
//! distances over their difference, in doubles to eps over the angle; and heights over the plane times the error of its
//! normal are part of it. The nodes are taken as exact. So all is computed from them alone: differences of nodes
//! without error, the plane's normal w = w1 x w2, the distance w . ((b - a) x (p - a)) / |w|. Its length |w| is common
//! to all and may be rounded.
//!
//! What is right for each of two facets may not be for both. Where a boundary of the mortar surface follows the edge
//! between two non-mortar facets, heights times the angle between their planes, be it of rounding, decide whether both
//! claim it, or none. Where both planes see a point on that edge, but for what no one means (`ON_LINE`), it is on it
//! for both. That takes the normal of the other plane, which an interface knows and a pair alone does not.

use super::double_double::DoubleDouble;
use super::facet::Facet;
use super::plane::Plane;
use super::projection::Projection;
use super::vector::Vec3;
use crate::shape::MAX_CORNERS;

/// A distance below this (over the lengths that make it) is 0: a few dozen roundings of a pair of doubles, 2^-106 each,
/// which is what points that lie on the line come out at.
const TIE: f64 = 1e-29;

/// Two planes see a point on a line where it is nearer to it than this, over the same lengths, in both: above the noise
/// of meshes that match but for rounding, below what an assembled tangent may be wrong by, 1e-9.
const ON_LINE: f64 = 1e-11;

type Vector = [DoubleDouble; 3];

fn difference(a: &Vec3, b: &Vec3) -> Vector {
    [0, 1, 2].map(|i| DoubleDouble::difference(a[i], b[i]))
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

fn dot(a: &Vector, b: &Vector) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Whether `a` comes before `b`: which end of an edge is its beginning, whoever looks at it.
#[inline]
fn is_before(a: &Vec3, b: &Vec3) -> bool {
    (a.x, a.y, a.z) < (b.x, b.y, b.z)
}

/// Whether planes with these normals both see a point on a line: the same for either of them and for the line in either
/// direction.
fn is_on_line(normals: [Vec3; 2], [from, to]: [&Vec3; 2], p: &Vec3) -> bool {
    let (from, to) = if is_before(from, to) { (from, to) } else { (to, from) };
    let v = (to - from).cross(&(p - from)); // doubles do: matching meshes come here all of the time
    let on_line = ON_LINE * lengths([from, to], p);
    normals.iter().all(|e| e.dot(&v).abs() <= on_line)
}

/// What distances are compared with: of a line and a point, whichever end is the first [L^2].
fn lengths([from, to]: [&Vec3; 2], p: &Vec3) -> f64 {
    (to - from).norm() * (p - from).norm().max((p - to).norm())
}

/// Whose edge a line is: the non-mortar facet's own k-th one, or one of the mortar facet.
#[derive(Clone, Copy)]
pub enum LineOf {
    Nonmortar(usize),
    Mortar,
}

/// A non-mortar facet's view of points near lines.
pub struct View<'a> {
    plane: &'a Plane,
    one: &'a Projection,
    /// The plane's unit normal, when it was first needed.
    normal: Option<Vector>,
}

impl<'a> View<'a> {
    /// That of the facet `one`.
    pub fn new(one: &'a Projection, plane: &'a Plane) -> View<'a> {
        View { plane, one, normal: None }
    }

    /// The signed distances of a facet's nodes from a line, times its length, positive to the left [L^2]: edge by edge
    /// of the node where it begins (`from`) and where it ends (`to`). Those of edges with both ends below `near` (over
    /// the lengths) are taken anew; an edge with one end farther off crosses at an angle, where doubles do.
    #[cold]
    #[inline(never)]
    pub fn refine(
        &mut self,
        (whose, line): (LineOf, [&Vec3; 2]),
        nodes: &Projection,
        near: f64,
        [from, to]: [&mut [f64; MAX_CORNERS]; 2],
    ) {
        let (mut left, x, n) = (None, &nodes.x, nodes.shape.n);
        let near_squared = near * near * (line[1] - line[0]).norm_squared();
        let is_near = [0, 1, 2, 3].map(|k| {
            let reach = (x[k] - line[0]).norm_squared().max((x[k] - line[1]).norm_squared());
            from[k] * from[k] < near_squared * reach
        });
        for k in 0..n {
            let next = nodes.shape.next[k] & 3; // so that no bounds are checked
            if !(is_near[k] && is_near[next]) {
                continue;
            }
            let ends = [&x[k], &x[next]];
            let one_line =
                matches!(whose, LineOf::Mortar) && ends.iter().all(|p| self.shares(LineOf::Nonmortar(k), line, p));
            [from[k], to[k]] = ends.map(|p| if one_line { 0.0 } else { self.distance((whose, line), p, &mut left) });
        }
    }

    /// Of one node; `left`: the normal of the line in the plane, when it was first needed.
    fn distance(&mut self, (whose, line): (LineOf, [&Vec3; 2]), p: &Vec3, left: &mut Option<Vector>) -> f64 {
        if p == line[0] || p == line[1] || self.shares(whose, line, p) {
            return 0.0; // the first as it would come out: the commonest case, matching meshes
        }
        let left = left.get_or_insert_with(|| cross(self.normal(), &difference(line[1], line[0])));
        let d = dot(left, &difference(p, line[0])).value();
        if d.abs() <= TIE * lengths(line, p) { 0.0 } else { d }
    }

    /// Whether this plane and the one beyond the non-mortar edge agree that a point is on a line.
    fn shares(&self, edge: LineOf, line: [&Vec3; 2], p: &Vec3) -> bool {
        let LineOf::Nonmortar(k) = edge else { return false };
        self.plane.beyond[k].is_some_and(|beyond| is_on_line([self.plane.e, beyond], line, p))
    }

    fn normal(&mut self) -> &Vector {
        self.normal.get_or_insert_with(|| {
            let facet = Facet { nodes: self.one.x, shape: self.one.shape };
            let [w1, w2] = facet.spanning_signs().map(|(to, from)| difference(&facet.nodes[to], &facet.nodes[from]));
            let w = cross(&w1, &w2);
            let length = Vec3::from(w.map(DoubleDouble::value)).norm();
            w.map(|c| c * (1.0 / length))
        })
    }
}
