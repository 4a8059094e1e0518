//! Gaps and overlaps of the first configuration that are closed before there is any strain: the nodes of the non-mortar surface are
//! moved along their normals onto the mortar surface, where that is within a tolerance (docs/formulation 15.4).
//!
//! A node's distance is that of the mortar facet, or part of a facet, that its normal meets: from all that look at the node the
//! nearest. Positive: open. Nodes are looked at one by one, so that none is moved for the sake of a neighbour.

use crate::error::{Error, Kind, Result};
use crate::geometry::{AnalyticSurface, Facet, OUTSIDE, Over, Plane, Vec3};
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::boxes::Aabb;
use crate::interface::pairing::filter::LEAST_OPPOSITION;
use crate::interface::pairing::prism::Prism;
use crate::interface::pairing::search::Tree;
use crate::line::Measure;
use crate::memory::{self, Store, Stored};
use crate::normal::nodal_normal;
use crate::shape::Shape;

/// Newton's method along a normal doubles its digits in each; a normal that passes a surface by meets none.
const ITERATIONS: usize = 50;
/// Of a distance that is 0, over the lengths that it is a difference of.
const ROUNDING: f64 = 1e-12;

/// A node of the non-mortar surface.
#[derive(Clone, Copy, Debug)]
pub struct Adjusted {
    /// Where it is put: on the mortar surface, or where it was.
    pub x: Vec3,
    /// Its distance from the mortar surface before `[L]`; `None`: its normal meets none.
    pub gap: Option<f64>,
    /// Whether it was within the tolerance.
    pub moved: bool,
}

/// The nodes of the first configuration, those within the tolerance moved.
///
/// # Errors
/// [`Kind::InvalidValue`] where the tolerance is not positive, or moves a node by more than the shortest edge around it.
pub fn adjusted<const N: usize>(setup: &Setup<N>, tolerance: f64) -> Result<Vec<Adjusted>> {
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        let text = text!("tolerance is {tolerance}; it must be positive and finite");
        return Err(Error::new(Kind::InvalidValue, text));
    }
    let (one, two) = setup.surfaces();
    let mut sums = Vec::new();
    one.add_normals(&one.reference, &mut sums)?;
    let edges = shortest_edges(one)?;
    let over = Mortar::new(two)?;
    let mut nodes = memory::with_room(one.len())?;
    let mut found = Vec::new();
    for (a, &x) in one.reference.iter().enumerate() {
        let mut nu = nodal_normal(sums[a], a)?;
        if one.lines().is_some_and(|lines| lines.measure == Measure::Axisymmetric) && x.x == 0.0 {
            nu = Vec3::new(0.0, nu.y.signum(), 0.0); // the axis stays where it is
        }
        let gap = over.gap(x, nu, edges[a], &mut found)?;
        let moves = gap.filter(|gap| gap.abs() <= tolerance);
        if let Some(gap) = moves.filter(|gap| gap.abs() > edges[a]) {
            let text = text!(
                "tolerance {tolerance} moves non-mortar node {a} by {:.3e}, more than the shortest edge around it ({:.3e}): a facet would be crushed; give a smaller tolerance, or offsets",
                gap.abs(),
                edges[a]
            );
            return Err(Error::new(Kind::InvalidValue, text));
        }
        let x = moves.map_or(x, |gap| x - nu * gap);
        nodes.store(Adjusted { x, gap, moved: moves.is_some() })?;
    }
    Ok(nodes)
}

/// The shortest edge of the facets around each node `[L]`.
fn shortest_edges(one: &Surface) -> Result<Vec<f64>> {
    let mut edges = memory::filled(f64::INFINITY, one.len())?;
    for facet in &one.facets {
        let nodes = facet.as_slice();
        for (k, &a) in nodes.iter().enumerate() {
            let b = nodes[(k + 1) % nodes.len()];
            let length = (one.reference[a] - one.reference[b]).norm();
            // The two nodes of a line.
            if length > 0.0 {
                (edges[a], edges[b]) = (edges[a].min(length), edges[b].min(length));
            }
        }
    }
    Ok(edges)
}

/// What lies over the nodes.
enum Mortar<'a> {
    Facets(&'a Surface, Tree),
    Analytic(AnalyticSurface),
}

impl Mortar<'_> {
    fn new(two: &Surface) -> Result<Mortar<'_>> {
        if two.analytic.is_some() {
            return two.analytic_at(&two.reference).map(Mortar::Analytic);
        }
        let boxes = |f: usize| Aabb::around(two.facet(f, &two.reference).points().iter().copied());
        Ok(Mortar::Facets(two, Tree::new((0..two.facets.len()).map(boxes).stored()?)?))
    }

    /// The distance along nu from what looks at x; `size`: of facets there `[L]`.
    fn gap(&self, x: Vec3, nu: Vec3, size: f64, found: &mut Vec<usize>) -> Result<Option<f64>> {
        let (two, tree) = match self {
            Mortar::Analytic(surface) => {
                return Ok(along(surface, x - surface.origin, nu));
            }
            Mortar::Facets(two, tree) => (two, tree),
        };
        let plane = Plane::of(&around(x, nu, size))?;
        tree.find(&Prism::over(&[x], &plane, OUTSIDE * size), found)?;
        let gaps = found.iter().filter_map(|&f| {
            let flat = below(&two.facet(f, &two.reference), x, &plane)?;
            Some(curved(two, f, x, &plane).unwrap_or(flat))
        });
        Ok(gaps.min_by(|a, b| a.abs().total_cmp(&b.abs())))
    }
}

/// The distance along nu of a point, from the origin of a surface that looks at it: by Newton's method, which ends in rounding.
fn along(surface: &AnalyticSurface, x: Vec3, nu: Vec3) -> Option<f64> {
    let (mut gap, mut last) = (0.0_f64, f64::INFINITY);
    for _ in 0..ITERATIONS {
        let closest = surface.closest(x - nu * gap).filter(|c| c.normal.dot(&nu) > LEAST_OPPOSITION)?;
        if !(closest.distance.abs() < last) {
            return (last <= ROUNDING * (x.norm() + gap.abs())).then_some(gap);
        }
        last = closest.distance.abs();
        gap += closest.distance / closest.normal.dot(&nu);
    }
    None
}

/// How far x lies over the facet with mid nodes that `f` is a part of, along the plane's normal: by Newton's method, from the part's middle. `None`:
/// it has no mid nodes, or bends too much for that.
fn curved(two: &Surface, f: usize, x: Vec3, plane: &Plane) -> Option<f64> {
    let parents = two.parents.as_ref()?;
    let (parent, sub) = (parents.at(parents.parent(f), &two.reference), parents.sub(f));
    let nodes = &sub.nodes[..sub.shape.n];
    let [mut xi, mut eta] =
        [0, 1].map(|i| nodes.iter().map(|&k| parent.parent.at[k][i]).sum::<f64>() / nodes.len() as f64);
    for _ in 0..ITERATIONS {
        let (point, [a, b]) = parent.point([xi, eta]);
        let away = x - point;
        let [a, b, r] = [a, b, away].map(|v| [plane.t1.dot(&v), plane.t2.dot(&v)]);
        let det = a[0] * b[1] - a[1] * b[0];
        let [d_xi, d_eta] = [(r[0] * b[1] - r[1] * b[0]) / det, (a[0] * r[1] - a[1] * r[0]) / det];
        (xi, eta) = (xi + d_xi, eta + d_eta);
        if d_xi.abs().max(d_eta.abs()) <= ROUNDING {
            return Some(plane.e.dot(&away));
        }
    }
    None
}

/// A triangle around x whose normal is nu.
fn around(x: Vec3, nu: Vec3, size: f64) -> Facet {
    let across = if nu.x.abs() < 0.7 { Vec3::x() } else { Vec3::y() };
    let t1 = nu.cross(&across).normalize();
    let t2 = nu.cross(&t1);
    let half = (t1 + t2) / 3.0;
    let nodes = [-half, t1 - half, t2 - half, -half].map(|d| x + d * size);
    Facet { nodes, shape: Shape::of(3).expect("there are triangles") }
}

/// How far x lies over a facet along the plane's normal, if it lies over it and they look at each other.
fn below(facet: &Facet, x: Vec3, plane: &Plane) -> Option<f64> {
    let out = facet.area_vector();
    let looks = out.dot(&plane.e) > LEAST_OPPOSITION * out.norm();
    looks.then(|| Over::new(facet, plane).height(x, plane))?.map(|(height, _)| height)
}
