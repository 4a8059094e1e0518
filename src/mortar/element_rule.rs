//! Element-based integration: n x n points on the whole non-mortar facet, each projected on the mortar facet that it
//! falls on, in place of triangles of the overlap,
//!
//! n_AB = sum_g w_g j_g N_A N_B, n_AC = sum_g w_g j_g N_A N_C(xi2(y_g)) over the points g on the mortar facet,
//!
//! j the area element. No clipping; but functions with kinks at the mortar edges are integrated as if they were smooth:
//! not exact on non-matching meshes, so that a patch test is not met, however many points there are.
//!
//! The derivative is that of the sums, exact as long as no point passes from one mortar facet to another (there the
//! weights jump by that point's share): at fixed xi1 the point moves with v1 = sum N_k Dy1_k, so that
//! Dj_g = sum_k det J grad N_k . Dy1_k and DN_C = grad N_C . (v1 - v2), v2 = sum N_l Dy2_l.
//!
//! For any processor alone: the rule is for comparisons and coarse answers, and a small library is worth more.

use super::chain::{
    AreaDerivatives, Areas, Chain, Component, Flat, ForceDerivatives, ONE, SHAPES, WeightDerivatives, to_rows,
};
use super::gap::{AlongNormal, Raised, heights_over};
use super::overlap::{check, project};
use super::pair_weights::PairWeights;
use super::segment::{CellPoints, KindKernel, Kinds, NonmortarFrame, Segment};
use super::slots::{MORTAR_CORNER, PAIR_CORNERS, PAIR_NODES};
use super::transport::PlaneDerivatives;
use crate::error::Result;
use crate::geometry::bilinear_map::BilinearMap;
use crate::geometry::clip::Polygon;
use crate::geometry::{Facet, Projection, Vec2, cross};
use crate::quadrature::cell::{square_point, triangle_point};
use crate::shape::{Basis, Isoparametric, MAX_CORNERS, MAX_NODES, SingleBasis};
use crate::simd::{self, Kernel, Lanes, Plain, Real};

impl Segment {
    /// The points of the frame's facet that fall on `facet`; `None` when neither one nor a corner does. `line`: at most
    /// [`crate::quadrature::cell::POINTS`] Gauss points.
    ///
    /// # Errors
    /// As [`Segment::new`].
    pub fn of_points(frame: &NonmortarFrame, facet: &Facet, line: &'static [[f64; 2]]) -> Result<Option<Segment>> {
        let Some(mortar) = simd::dispatch(Projected { frame, facet }) else { return Ok(None) };
        check(frame, &mortar)?;
        let mut points = CellPoints { line, inside: 0 };
        let mut area = 0.0;
        for i in 0..points.count() {
            let p = Point::of(frame, line, i);
            if is_on(&mortar, p.y) {
                points.inside |= 1 << i;
                area += p.area;
            }
        }
        for k in 0..frame.projection.shape.n {
            points.inside |= u128::from(is_on(&mortar, frame.projection.y[k])) << (points.count() + k);
        }
        if points.inside == 0 {
            return Ok(None);
        }
        let (mortar_map, polygon) = (BilinearMap::new(&mortar), Polygon::empty());
        Ok(Some(Segment { mortar, mortar_map, polygon, area, points: Some(points) }))
    }
}

/// The mortar facet in the plane, by the same back end as the non-mortar one: nodes that coincide have the same bits, and
/// the rule of [`is_on`] for what lies on an edge holds.
struct Projected<'a> {
    frame: &'a NonmortarFrame,
    facet: &'a Facet,
}

impl Kernel for Projected<'_> {
    type Output = Option<Projection>;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        project::<L>(self.frame, self.facet)
    }
}

/// Whether a point lies on a convex facet. Facets that share an edge compute the same numbers of it, from the node that
/// comes first among the two, and a point on it counts as moved a little along t1 and much less along t2: every point
/// of a surface lies on one facet.
fn is_on(facet: &Projection, p: Vec2) -> bool {
    (0..facet.shape.n).all(|k| {
        let j = facet.shape.next[k];
        let forward = facet.x[k].as_slice() < facet.x[j].as_slice();
        let (from, to) = if forward { (facet.y[k], facet.y[j]) } else { (facet.y[j], facet.y[k]) };
        let edge = to - from;
        let left = [cross(edge, p - from), -edge.y, edge.x].into_iter().find(|&d| d != 0.0).is_some_and(|d| d > 0.0);
        left == forward
    })
}

/// A point of the non-mortar facet.
pub(super) struct Point {
    xi: f64,
    eta: f64,
    /// Weight on the reference cell, and times j [L^2].
    weight: f64,
    area: f64,
    /// The functions of the map, which are N_A and N_B, too: other kinds have no table of values.
    n: [f64; MAX_CORNERS],
    y: Vec2,
}

/// A point, the functions of the mortar facet's map there, which are N_C, and where on the mortar facet that is.
pub(super) type PointOfBoth = (Point, [f64; MAX_CORNERS], [f64; 3]);

impl Point {
    fn of(frame: &NonmortarFrame, line: &[[f64; 2]], i: usize) -> Point {
        let one = &frame.projection;
        Point::at(frame, if one.shape.n == 3 { triangle_point(line, i) } else { square_point(line, i) })
    }

    /// At these coordinates, with this weight on the reference cell.
    fn at(frame: &NonmortarFrame, [xi, eta, weight]: [f64; 3]) -> Point {
        let one = &frame.projection;
        let (n, j) = (one.shape.values(xi, eta), frame.map.determinant());
        let y = (0..MAX_CORNERS).fold(Vec2::zeros(), |y, k| y + one.y[k] * n[k]);
        Point { xi, eta, weight, area: weight * (j[0] + j[1] * xi + j[2] * eta), n, y }
    }

    /// With the mortar facet.
    fn on(self, segment: &Segment) -> PointOfBoth {
        let two = segment.mortar_map.inverse([self.y.x, self.y.y]);
        let n2 = segment.mortar.shape.values(two.xi, two.eta);
        (self, n2, [two.xi, two.eta, two.det])
    }

    /// The same of the point at these coordinates.
    pub(super) fn of_both(frame: &NonmortarFrame, segment: &Segment, at: [f64; 3]) -> PointOfBoth {
        Point::at(frame, at).on(segment)
    }

    /// Those of a segment that count.
    fn all<'a>(
        frame: &'a NonmortarFrame,
        segment: &'a Segment,
        points: CellPoints,
    ) -> impl Iterator<Item = PointOfBoth> + 'a {
        let counts = move |i: &usize| points.inside >> i & 1 == 1;
        (0..points.count()).filter(counts).map(move |i| Point::of(frame, points.line, i).on(segment))
    }
}

/// The weights of the points.
pub(super) fn weights(frame: &NonmortarFrame, segment: &Segment, points: CellPoints) -> PairWeights {
    let mut w = PairWeights::default();
    Point::all(frame, segment, points).for_each(|p| add_weights(&mut w, segment, &p));
    w
}

/// Adds a point's.
pub(super) fn add_weights(w: &mut PairWeights, segment: &Segment, (p, n2, _): &PointOfBoth) {
    for a in 0..MAX_CORNERS {
        for k in 0..MAX_NODES {
            w.ab[a][k] += p.area * p.n[a] * p.n[k];
            w.ac[a][segment.mortar.node[k]] += p.area * p.n[a] * n2[k];
        }
    }
}

/// d/dy: per corner's slot k the two components of y_k, of each four numbers; mortar ones in the order of the projection.
type Sums = [[[f64; 4]; 2]; PAIR_CORNERS];

/// Derivatives with respect to the projected vertices.
pub(super) struct Derivatives<const F: usize> {
    /// Of f_B = int p N_B of the fields p = sum N_A p_A.
    pub one: [Sums; F],
    /// Of f_C = -int p N_C, C in the order of the facet as given.
    pub two: [Sums; F],
    /// Of gamma_A = int N_A (sum N_B d_B - sum N_C d_C) at fixed heights d.
    gap: Sums,
}

impl<const F: usize> Derivatives<F> {
    /// `heights`: the d_B.
    fn new(
        (frame, segment, points): (&NonmortarFrame, &Segment, CellPoints),
        fields: &[[f64; MAX_CORNERS]; F],
        heights: &[f64; MAX_CORNERS],
    ) -> Self {
        let mut d = Derivatives::zero();
        Point::all(frame, segment, points).for_each(|p| d.add((frame, segment), &p, fields, heights));
        d
    }

    pub(super) fn zero() -> Self {
        let zero = [[[0.0; 4]; 2]; PAIR_CORNERS];
        Derivatives { one: [zero; F], two: [zero; F], gap: zero }
    }

    /// Adds those of a point.
    pub(super) fn add(
        &mut self,
        (frame, segment): (&NonmortarFrame, &Segment),
        (p, n2, [xi2, eta2, det2]): &PointOfBoth,
        fields: &[[f64; MAX_CORNERS]; F],
        heights: &[f64; MAX_CORNERS],
    ) {
        let (map1, map2) = (frame.map.gradients::<Plain>(), segment.mortar_map.gradients::<Plain>());
        let two = &segment.mortar;
        for c in 0..2 {
            let g1 = at(&map1, c, p.xi, p.eta).map(|g| g * p.weight); // w Dj / Dy1_k
            let g2 = at(&map2, c, *xi2, *eta2).map(|g| g * p.area / det2); // w j grad N_C
            let slope = dot(&g2, &two.d);
            let gap = dot(&p.n, heights) - dot(n2, &two.d);
            for k in 0..MAX_CORNERS {
                for a in 0..MAX_CORNERS {
                    self.gap[k][c][a] += p.n[a] * (gap * g1[k] - slope * p.n[k]);
                    self.gap[MORTAR_CORNER + k][c][a] += p.n[a] * slope * n2[k];
                }
                for (f, field) in fields.iter().enumerate() {
                    let value = dot(field, &p.n);
                    for b in 0..MAX_NODES {
                        self.one[f][k][c][b] += value * p.n[b] * g1[k];
                        self.two[f][k][c][two.node[b]] -= value * (n2[b] * g1[k] + g2[b] * p.n[k]);
                        self.two[f][MORTAR_CORNER + k][c][two.node[b]] += value * g2[b] * n2[k];
                    }
                }
            }
        }
    }
}

fn dot(a: &[f64; MAX_CORNERS], b: &[f64; MAX_CORNERS]) -> f64 {
    (0..MAX_CORNERS).map(|k| a[k] * b[k]).sum()
}

/// Component `c` of det J dN_k/dy at a point.
fn at(gradients: &[[Plain; 2]; 3], c: usize, xi: f64, eta: f64) -> [f64; MAX_CORNERS] {
    (gradients[0][c] + gradients[1][c] * Plain::splat(xi) + gradients[2][c] * Plain::splat(eta)).store()
}

/// As the chain to the nodes takes them.
pub(super) fn lanes<L: Lanes>(sums: &Sums) -> PlaneDerivatives<L> {
    let mut d = [[L::splat(0.0); 2]; PAIR_CORNERS];
    for k in 0..PAIR_CORNERS {
        d[k] = [L::load(&sums[k][0]), L::load(&sums[k][1])];
    }
    d
}

/// As [`super::pair_motion`].
pub(super) fn motion(
    (frame, segment, points): (&NonmortarFrame, &Segment, CellPoints),
    weights: &PairWeights,
    p: &[[f64; MAX_CORNERS]; 3],
    forces: &mut ForceDerivatives,
    raised: Option<Raised>,
) -> AlongNormal {
    let plane = Derivatives::new((frame, segment, points), &[p[0], p[1], p[2], ONE], &heights_over(frame, &raised));
    let areas = raised.map(|raised| raised.areas);
    Kinds::of(frame, segment).plain(Motion { frame, segment, plane, weights, forces, areas })
}

struct Motion<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    /// Of the forces' three fields, and of the field 1.
    plane: Derivatives<4>,
    weights: &'a PairWeights,
    forces: &'a mut ForceDerivatives,
    areas: Option<&'a mut AreaDerivatives>,
}

impl KindKernel for Motion<'_> {
    type Output = AlongNormal;

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) -> AlongNormal {
        let Motion { frame, segment, plane, weights, forces, areas } = self;
        let chain = Chain::new(frame, segment);
        for i in 0..3 {
            chain.nodes::<One::Cell, Two::Cell>(&lanes::<L>(&plane.one[i]), &mut Component { to: &mut forces.one, i });
            chain.nodes::<One::Cell, Two::Cell>(&lanes::<L>(&plane.two[i]), &mut Component { to: &mut forces.two, i });
        }
        if let Some(areas) = areas {
            chain.nodes::<One::Cell, Two::Cell>(&lanes::<L>(&plane.one[3]), &mut Areas(areas));
        }
        AlongNormal::new::<L, One, Two>(&chain, &lanes::<L>(&plane.gap), weights)
    }
}

/// As [`super::offset_motion`], `raised` the segment with the mortar side's values in place of its heights.
pub(super) fn offsets(
    (frame, segment, points): (&NonmortarFrame, &Segment, CellPoints),
    raised: &Segment,
    one: &[f64; MAX_CORNERS],
    slopes: &mut AreaDerivatives,
) {
    let plane = Derivatives::<0>::new((frame, raised, points), &[], one);
    Kinds::of(frame, segment).plain(Offsets { frame, segment, gap: plane.gap, slopes });
}

struct Offsets<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    gap: Sums,
    slopes: &'a mut AreaDerivatives,
}

impl KindKernel for Offsets<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) {
        let Offsets { frame, segment, gap, slopes } = self;
        Chain::new(frame, segment).nodes::<One::Cell, Two::Cell>(&lanes::<L>(&gap), &mut Areas(slopes));
    }
}

/// As [`WeightDerivatives::update`].
pub(super) fn derivatives(
    frame: &NonmortarFrame,
    segment: &Segment,
    points: CellPoints,
    derivatives: &mut WeightDerivatives,
) -> PairWeights {
    let plane = Derivatives::new((frame, segment, points), &SHAPES, &frame.projection.d);
    Kinds::of(frame, segment).plain(OfWeights { frame, segment, plane, derivatives });
    weights(frame, segment, points)
}

struct OfWeights<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    plane: Derivatives<4>,
    derivatives: &'a mut WeightDerivatives,
}

impl KindKernel for OfWeights<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) {
        let OfWeights { frame, segment, plane, derivatives } = self;
        let chain = Chain::new(frame, segment);
        let mut columns = Flat([[L::splat(0.0); 3]; PAIR_NODES]);
        for a in 0..One::Multiplier::FUNCTIONS {
            chain.nodes::<One::Cell, Two::Cell>(&lanes::<L>(&plane.one[a]), &mut columns);
            to_rows::<L, One::Displacement>(&columns.0, 1.0, &mut derivatives.ab[a]);
            chain.nodes::<One::Cell, Two::Cell>(&lanes::<L>(&plane.two[a]), &mut columns);
            to_rows::<L, Two::Displacement>(&columns.0, -1.0, &mut derivatives.ac[a]);
        }
    }
}
