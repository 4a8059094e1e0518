//! Weights of quadratic facets and their derivatives, over one pair of sub-facets (docs/formulation 12.2, 12.3).
//!
//! As in `weights.rs` and `transport.rs`, n_AB = int N_A N_B da and n_AC = int N_A N_C da over the overlap, but N_A, N_B and
//! N_C are functions of the parents, while the velocity of a point is the sub-facet's, v = sum_k N^sigma_k Dy_k. Of a
//! function f1 of the non-mortar parent and f2 of either,
//!
//! D int f1 f2 = -int (grad f1 . v1) f2 + f1 (grad f2 . v2) da + sum_edges int f1 f2 (v . n) ds.

use super::chain::{Chain, Flat};
use super::edges::{edge_points, intervals, line};
use super::field::{Field, MultiplierSpace, Multipliers, Values};
use super::points::{Fan, Maps, points};
use super::segment::{NonmortarFrame, Segment};
use super::slots::{MORTAR_CORNER, PAIR_CORNERS, PAIR_NODES};
use super::transport::PlaneDerivatives;
use crate::features;
use crate::geometry::Vec2;
use crate::geometry::bilinear_map::Preimage;
use crate::geometry::edge_interval::{EdgeInterval, EdgeIntervals};
use crate::quadrature::{DEGREE_5, DEGREE_7, Rule};
use crate::shape::{GROUPS, MAX_CORNERS, Parent, Quadrilateral, SubFacet, TERMS, Triangle, cell_corners};
use crate::simd::{self, Kernel, Lanes, rolled};

/// Lanes of a parent's functions.
pub const COLUMNS: usize = 4 * GROUPS;

/// n_AB and n_AC of a pair of sub-facets: rows A, the multipliers over the non-mortar sub-facet; columns, the parents' nodes
/// [L^2].
#[derive(Clone, Debug, PartialEq)]
pub struct SubWeights {
    /// n_AB.
    pub ab: [[f64; COLUMNS]; MAX_CORNERS],
    /// n_AC.
    pub ac: [[f64; COLUMNS]; MAX_CORNERS],
}

/// Their derivatives, `[A][k][j][B]` with respect to component j of the k-th node of the two sub-facets `[L]`.
#[derive(Clone, Debug)]
pub struct SubDerivatives {
    /// Of n_AB.
    pub ab: [[[[f64; COLUMNS]; 3]; PAIR_NODES]; MAX_CORNERS],
    /// Of n_AC.
    pub ac: [[[[f64; COLUMNS]; 3]; PAIR_NODES]; MAX_CORNERS],
}

impl Default for SubWeights {
    fn default() -> Self {
        SubWeights { ab: [[0.0; COLUMNS]; MAX_CORNERS], ac: [[0.0; COLUMNS]; MAX_CORNERS] }
    }
}

impl Default for SubDerivatives {
    fn default() -> Self {
        let zero = [[[[0.0; COLUMNS]; 3]; PAIR_NODES]; MAX_CORNERS];
        SubDerivatives { ab: zero, ac: zero }
    }
}

/// A side of the pair: the parent, and which of its sub-facets it is.
pub type Side = (&'static Parent, &'static SubFacet);

/// The rule for pairs of these parents: the one asked for, or a finer one where that is not exact on affine facets.
pub fn rule_for(rule: &'static Rule, parents: [&Parent; 2]) -> &'static Rule {
    let needs_more = parents.iter().any(|parent| parent.degree() > DEGREE_5.degree);
    if needs_more && rule.degree < DEGREE_7.degree { &DEGREE_7 } else { rule.for_derivatives() }
}

/// The weights over an overlap, by a rule of [`rule_for`], and their derivatives where asked for.
pub fn sub_weights(
    (frame, segment, rule): (&NonmortarFrame, &Segment, &Rule),
    sides: (Side, Side),
    space: MultiplierSpace,
    derivatives: Option<&mut SubDerivatives>,
) -> SubWeights {
    features::QUADRATIC.is_here();
    simd::dispatch(Integrate { frame, segment, rule, sides, space, derivatives })
}

/// For both kinds of cells at once: of a pair of sub-facets the functions of the parents cost most.
struct Integrate<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
    sides: (Side, Side),
    space: MultiplierSpace,
    derivatives: Option<&'a mut SubDerivatives>,
}

/// Per row A and group of functions, the derivatives with respect to the projected corners.
type Sums<L> = [[PlaneDerivatives<L>; GROUPS]; MAX_CORNERS];

/// Four points: of the overlap, or of an edge's part that bounds it.
pub(super) struct Four<L> {
    pub weight: L,
    /// Coordinates on both sub-facets, and the determinants of their maps.
    pub one: [L; 3],
    pub two: [L; 3],
    pub edge: Option<OnEdge>,
}

/// An edge: the slots of its ends, their functions at the points, n ds/dt.
pub(super) struct OnEdge {
    pub slots: [usize; 2],
    pub ends: [[f64; 4]; 2],
    pub normal: [f64; 2],
}

/// All points of a pair, four at a time.
pub(super) struct Points<'a, L> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
    maps: Maps<L>,
    fan: Fan<'a>,
    triangle: Option<[Vec2; 3]>,
    /// The edges' parts of both sub-facets; none where no derivatives are asked for.
    edges: [EdgeIntervals; 2],
    /// The next group of points, and the edge that it is on, once the triangles are through.
    group: usize,
    edge: usize,
}

/// Coordinates and determinant.
#[inline(always)]
fn at<L: Lanes>(at: &Preimage<L>) -> [L; 3] {
    [at.xi, at.eta, at.det]
}

#[inline(always)]
fn stored<L: Lanes>(v: &[L; 3]) -> [[f64; 4]; 3] {
    [v[0].store(), v[1].store(), v[2].store()]
}

impl<'a, L: Lanes> Points<'a, L> {
    /// Those on edges where derivatives are asked for.
    #[inline(always)]
    pub fn new((frame, segment, rule): (&'a NonmortarFrame, &'a Segment, &'a Rule), derivatives: bool) -> Self {
        let edges = match derivatives {
            true => intervals::<L>(&frame.projection, &segment.mortar, &frame.plane),
            false => [[None; MAX_CORNERS]; 2],
        };
        let (mut fan, maps) = (Fan::new(frame, segment), Maps::<L>::new(frame, segment));
        let triangle = fan.triangle();
        Points { frame, segment, rule, maps, fan, triangle, edges, group: 0, edge: 0 }
    }

    #[inline(always)]
    pub fn next(&mut self) -> Option<Four<L>> {
        while let Some(triangle) = &self.triangle {
            if let Some(four) = self.rule.triangle_lanes.get(self.group) {
                self.group += 1;
                let p = points::<L>(&self.maps, four, triangle);
                return Some(Four { weight: p.weight, one: at(&p.one), two: at(&p.two), edge: None });
            }
            (self.triangle, self.group) = (self.fan.triangle(), 0);
        }
        while self.edge < 2 * MAX_CORNERS {
            let (side, k) = (self.edge / MAX_CORNERS, self.edge % MAX_CORNERS);
            if let (Some(edge), Some(four)) = (&self.edges[side][k], self.rule.line_lanes.get(self.group)) {
                self.group += 1;
                return Some(self.on_edge(side, edge, four));
            }
            (self.edge, self.group) = (self.edge + 1, 0);
        }
        None
    }

    /// Along its own edge a point's coordinates are known. Gradients, and so the determinants, are not asked for.
    #[inline(always)]
    fn on_edge(&self, side: usize, edge: &EdgeInterval, four: &[[f64; 4]; 2]) -> Four<L> {
        let projection = [&self.frame.projection, &self.segment.mortar][side];
        let corners = cell_corners(projection.shape);
        let (from, to) = (corners[edge.from & 3], corners[edge.to & 3]);
        let (y0, span, normal) = line(&projection.y, edge);
        let (w, [l0, l1], y) = edge_points::<L>(four, edge, y0, span);
        let one = L::splat(1.0);
        let mut own = [one; 3];
        for i in 0..2 {
            own[i] = L::splat(from[i]).mul_add(l0, L::splat(to[i]) * l1);
        }
        let there = if side == 0 { self.maps.two.at(y) } else { self.maps.one.at(y) };
        let there = [there.xi, there.eta, one];
        let slots = [edge.from, edge.to].map(|end| side * MORTAR_CORNER + (end & 3));
        let edge = OnEdge { slots, ends: [l0.store(), l1.store()], normal: [normal.x, normal.y] };
        let (one, two) = if side == 0 { (own, there) } else { (there, own) };
        Four { weight: w, one, two, edge: Some(edge) }
    }
}

/// Adds `n` (v . n) ds of the q-th point of an edge.
#[inline(always)]
fn add_edge<L: Lanes>(edge: &OnEdge, q: usize, n: L, sums: &mut PlaneDerivatives<L>) {
    for (slot, end) in edge.slots.iter().zip(&edge.ends) {
        for c in 0..2 {
            let along = L::splat(end[q] * edge.normal[c]);
            sums[*slot][c] = n.mul_add(along, sums[*slot][c]);
        }
    }
}

/// Adds `n` times component c of a point's velocity, sum_k v_k Dy_k over the corners from slot `first` on.
#[inline(always)]
fn add_velocity<L: Lanes>(n: L, v: &[f64; MAX_CORNERS], (first, c): (usize, usize), sums: &mut PlaneDerivatives<L>) {
    for k in 0..MAX_CORNERS {
        sums[first + k][c] = n.mul_add(L::splat(v[k]), sums[first + k][c]);
    }
}

impl Kernel for Integrate<'_> {
    type Output = SubWeights;

    #[inline(always)]
    fn run<L: Lanes>(self) -> SubWeights {
        let Integrate { frame, segment, rule, sides: (one, two), space, derivatives } = self;
        let multipliers = Multipliers::new::<L>(space, one, &frame.projection, &frame.map);
        let fields = [
            Field::new::<L>(one.0, one.1, &frame.projection, &frame.map),
            Field::new::<L>(two.0, two.1, &segment.mortar, &segment.mortar_map),
        ];
        let rows = space.nodes(one.0, one.1).len();
        let shapes = [frame.projection.shape, segment.mortar.shape];
        let zero = L::splat(0.0);
        let mut moments = [[[zero; TERMS]; MAX_CORNERS]; 2];
        // 12 kB, begun only where somebody asks.
        let mut room: [Sums<L>; 2];
        let mut sums = match derivatives.is_some() {
            true => {
                room = [[[[[zero; 2]; PAIR_CORNERS]; GROUPS]; MAX_CORNERS]; 2];
                Some(&mut room)
            }
            false => None,
        };
        let mut points = Points::<L>::new((frame, segment, rule), derivatives.is_some());
        while let Some(four) = points.next() {
            if four.edge.is_none() {
                let mut n = multipliers.of_four([four.one[0], four.one[1]]);
                for a in 0..MAX_CORNERS {
                    n[a] = n[a] * four.weight;
                }
                let (one, two) = (&four.one, &four.two);
                fields[0].add_moments([one[0], one[1]], &n[..rows], &mut moments[0]);
                fields[1].add_moments([two[0], two[1]], &n[..rows], &mut moments[1]);
            }
            let Some(sums) = sums.as_deref_mut() else { continue };
            let (weight, at) = (four.weight.store(), [stored(&four.one), stored(&four.two)]);
            for q in 0..rolled(4) {
                let w = weight[q];
                if w == 0.0 {
                    continue;
                }
                let [one, two] = &at;
                let at = [([one[0][q], one[1][q]], one[2][q]), ([two[0][q], two[1][q]], two[2][q])];
                let a = multipliers.at::<L>(at[0].0, at[0].1);
                let (n, gradient) = (a.n[0].store(), [a.gradient[0][0].store(), a.gradient[0][1].store()]);
                let v = [shapes[0].values(at[0].0[0], at[0].0[1]), shapes[1].values(at[1].0[0], at[1].0[1])];
                for which in 0..rolled(2) {
                    let f: Values<L, GROUPS> = fields[which].at(at[which].0, at[which].1);
                    let (sums, groups) = (&mut sums[which], fields[which].groups());
                    for (row, g) in (0..rows).flat_map(|row| (0..groups).map(move |g| (row, g))) {
                        let (wn, sums) = (L::splat(w * n[row]), &mut sums[row][g]);
                        match &four.edge {
                            Some(edge) => add_edge(edge, q, wn * f.n[g], sums),
                            None => {
                                // -(grad N_A . v1) N, and -N_A grad N . v of the side that has N.
                                for c in 0..2 {
                                    let of_a = f.n[g] * L::splat(-w * gradient[c][row]);
                                    let of_n = -wn * f.gradient[g][c];
                                    if which == 0 {
                                        add_velocity(of_a + of_n, &v[0], (0, c), sums);
                                    } else {
                                        add_velocity(of_a, &v[0], (0, c), sums);
                                        add_velocity(of_n, &v[1], (MORTAR_CORNER, c), sums);
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
        if let (Some(derivatives), Some(sums)) = (derivatives, &sums) {
            let chain = Chain::new(frame, segment);
            for (sums, to) in sums.iter().zip([&mut derivatives.ab, &mut derivatives.ac]) {
                for (a, g) in (0..rows).flat_map(|a| (0..GROUPS).map(move |g| (a, g))) {
                    let mut columns = Flat([[zero; 3]; PAIR_NODES]);
                    match (shapes[0].n, shapes[1].n) {
                        (3, 3) => chain.nodes::<Triangle, Triangle>(&sums[a][g], &mut columns),
                        (3, _) => chain.nodes::<Triangle, Quadrilateral>(&sums[a][g], &mut columns),
                        (_, 3) => chain.nodes::<Quadrilateral, Triangle>(&sums[a][g], &mut columns),
                        _ => chain.nodes::<Quadrilateral, Quadrilateral>(&sums[a][g], &mut columns),
                    }
                    for (k, j) in (0..PAIR_NODES).flat_map(|k| (0..3).map(move |j| (k, j))) {
                        to[a][k][j][4 * g..][..4].copy_from_slice(&columns.0[k][j].store());
                    }
                }
            }
        }
        let mut weights = SubWeights::default();
        for a in 0..rolled(rows) {
            let (ab, ac) = (fields[0].of_moments(&moments[0][a]), fields[1].of_moments(&moments[1][a]));
            for g in 0..GROUPS {
                weights.ab[a][4 * g..][..4].copy_from_slice(&ab[g].store());
                weights.ac[a][4 * g..][..4].copy_from_slice(&ac[g].store());
            }
        }
        weights
    }
}
