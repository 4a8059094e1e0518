//! Weights of quadratic facets and their derivatives, over one pair of sub-facets (docs/formulation.md 12.2, 12.3).
//!
//! As in `weights.rs` and `transport.rs`, n_AB = int N_A N_B da and n_AC = int N_A N_C da over the overlap, but N_A, N_B and
//! N_C are functions of the parents, while the velocity of a point is the sub-facet's, v = sum_k N^sigma_k Dy_k. Of a
//! function f1 of the non-mortar parent and f2 of either,
//!
//! D int f1 f2 = -int (grad f1 . v1) f2 + f1 (grad f2 . v2) da + sum_edges int f1 f2 (v . n) ds.

use super::chain::{Chain, Flat};
use super::edges::{edge_points, intervals, line};
use super::field::{Field, MultiplierSpace, Multipliers, Values, cell_corners};
use super::points::{Fan, Maps, points};
use super::segment::{KindKernel, Kinds, NonmortarFrame, Segment};
use super::slots::{MORTAR_CORNER, PAIR_CORNERS, PAIR_NODES};
use super::transport::PlaneDerivatives;
use crate::geometry::edge_interval::EdgeInterval;
use crate::quadrature::{DEGREE_5, DEGREE_7, Rule};
use crate::shape::{Basis, Cell, GROUPS, Isoparametric, MAX_CORNERS, Map, Parent, SingleBasis, SubFacet};
use crate::simd::{Lanes, rolled};

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
    let least = parents.iter().map(|parent| parent.degree()).fold(0, u32::max);
    match (rule.degree >= least, least > DEGREE_5.degree) {
        (true, _) => rule,
        (false, true) => &DEGREE_7,
        (false, false) => &DEGREE_5,
    }
}

/// The weights over an overlap, by a rule of [`rule_for`].
pub fn sub_weights(
    (frame, segment, rule): (&NonmortarFrame, &Segment, &Rule),
    (one, two): (Side, Side),
    space: MultiplierSpace,
) -> SubWeights {
    let mut weights = SubWeights::default();
    let to = (&mut weights, None);
    Kinds::of(frame, segment).dispatch(Integrate { frame, segment, rule, one, two, space, to });
    weights
}

/// The same with their derivatives.
pub fn sub_derivatives(
    (frame, segment, rule): (&NonmortarFrame, &Segment, &Rule),
    (one, two): (Side, Side),
    space: MultiplierSpace,
    derivatives: &mut SubDerivatives,
) -> SubWeights {
    let mut weights = SubWeights::default();
    let to = (&mut weights, Some(derivatives));
    Kinds::of(frame, segment).dispatch(Integrate { frame, segment, rule, one, two, space, to });
    weights
}

struct Integrate<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
    one: Side,
    two: Side,
    space: MultiplierSpace,
    to: (&'a mut SubWeights, Option<&'a mut SubDerivatives>),
}

/// Per row A and group of functions, the derivatives with respect to the projected corners.
type Sums<L> = [[PlaneDerivatives<L>; GROUPS]; MAX_CORNERS];

/// All functions at a point.
struct At<L> {
    /// N_A, and the components of its gradient.
    a: [f64; MAX_CORNERS],
    gradient: [[f64; MAX_CORNERS]; 2],
    b: Values<L, GROUPS>,
    c: Values<L, GROUPS>,
}

struct Functions {
    multipliers: Multipliers,
    one: Field,
    two: Field,
}

impl Functions {
    #[inline(always)]
    fn at<L: Lanes>(&self, one: ([f64; 2], f64), two: ([f64; 2], f64)) -> At<L> {
        let a = self.multipliers.at::<L>(one.0, one.1);
        At {
            a: a.n[0].store(),
            gradient: a.gradient[0].map(L::store),
            b: self.one.at(one.0, one.1),
            c: self.two.at(two.0, two.1),
        }
    }
}

impl KindKernel for Integrate<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) {
        let Integrate { frame, segment, rule, one, two, space, to: (weights, derivatives) } = self;
        let f = Functions {
            multipliers: Multipliers::new::<L>(space, one, &frame.projection, &frame.map),
            one: Field::new::<L>(one.0, one.1, &frame.projection, &frame.map),
            two: Field::new::<L>(two.0, two.1, &segment.mortar, &segment.mortar_map),
        };
        let rows = space.nodes(one.0, one.1).len();
        let maps = Maps::<L>::new(frame, segment);
        let zero = L::splat(0.0);
        let (mut ab, mut ac) = ([[zero; GROUPS]; MAX_CORNERS], [[zero; GROUPS]; MAX_CORNERS]);
        let mut sums: Option<[Sums<L>; 2]> =
            derivatives.is_some().then_some([[[[[zero; 2]; PAIR_CORNERS]; GROUPS]; MAX_CORNERS]; 2]);
        let mut fan = Fan::new(frame, segment);
        while let Some(triangle) = fan.triangle() {
            for four in rule.triangle_lanes {
                let p = points::<L>(&maps, four, &triangle);
                let weight = p.weight.store();
                let one = [p.one.xi.store(), p.one.eta.store(), p.one.det.store()];
                let two = [p.two.xi.store(), p.two.eta.store(), p.two.det.store()];
                for q in 0..rolled(4) {
                    let w = weight[q];
                    if w == 0.0 {
                        continue;
                    }
                    let at = f.at::<L>(([one[0][q], one[1][q]], one[2][q]), ([two[0][q], two[1][q]], two[2][q]));
                    for a in 0..rows {
                        let wn = L::splat(w * at.a[a]);
                        for g in 0..f.one.groups() {
                            ab[a][g] = wn.mul_add(at.b.n[g], ab[a][g]);
                        }
                        for g in 0..f.two.groups() {
                            ac[a][g] = wn.mul_add(at.c.n[g], ac[a][g]);
                        }
                    }
                    let Some(sums) = &mut sums else { continue };
                    let v1 = <Map<One> as Basis>::values(one[0][q], one[1][q]);
                    let v2 = <Map<Two> as Basis>::values(two[0][q], two[1][q]);
                    add_area::<L, One, Two>(sums, (rows, [f.one.groups(), f.two.groups()]), &at, w, [v1, v2]);
                }
            }
        }
        for a in 0..rows {
            for g in 0..GROUPS {
                weights.ab[a][4 * g..][..4].copy_from_slice(&ab[a][g].store());
                weights.ac[a][4 * g..][..4].copy_from_slice(&ac[a][g].store());
            }
        }
        let (Some(mut sums), Some(derivatives)) = (sums, derivatives) else { return };
        let [ones, twos] = intervals::<L>(&frame.projection, &segment.mortar, &frame.plane);
        for (first, edges) in [(0, &ones), (MORTAR_CORNER, &twos)] {
            for edge in edges.iter().flatten() {
                add_edge::<L>((frame, segment, rule), &maps, &f, rows, (first, edge), &mut sums);
            }
        }
        let chain = Chain::new(frame, segment);
        for (sums, to) in sums.iter().zip([&mut derivatives.ab, &mut derivatives.ac]) {
            for a in 0..rolled(rows) {
                for g in 0..rolled(GROUPS) {
                    let mut columns = Flat([[zero; 3]; PAIR_NODES]);
                    chain.nodes::<One::Cell, Two::Cell>(&sums[a][g], &mut columns);
                    for (k, j) in (0..PAIR_NODES).flat_map(|k| (0..3).map(move |j| (k, j))) {
                        to[a][k][j][4 * g..][..4].copy_from_slice(&columns.0[k][j].store());
                    }
                }
            }
        }
    }
}

/// What a point of the area adds.
#[inline(always)]
fn add_area<L: Lanes, One: SingleBasis, Two: Isoparametric>(
    [ab, ac]: &mut [Sums<L>; 2],
    (rows, groups): (usize, [usize; 2]),
    at: &At<L>,
    w: f64,
    [v1, v2]: [[f64; MAX_CORNERS]; 2],
) {
    for a in 0..rows {
        for c in 0..2 {
            let (n, gradient) = (L::splat(-w * at.a[a]), L::splat(-w * at.gradient[c][a]));
            for g in 0..groups[0] {
                let both = gradient.mul_add(at.b.n[g], n * at.b.gradient[g][c]);
                for k in 0..One::Cell::CORNERS {
                    ab[a][g][k][c] = both.mul_add(L::splat(v1[k]), ab[a][g][k][c]);
                }
            }
            for g in 0..groups[1] {
                let (own, other) = (gradient * at.c.n[g], n * at.c.gradient[g][c]);
                for k in 0..One::Cell::CORNERS {
                    ac[a][g][k][c] = own.mul_add(L::splat(v1[k]), ac[a][g][k][c]);
                }
                for l in 0..Two::Cell::CORNERS {
                    let sum = &mut ac[a][g][MORTAR_CORNER + l][c];
                    *sum = other.mul_add(L::splat(v2[l]), *sum);
                }
            }
        }
    }
}

/// What an edge's part that bounds the overlap adds; `first`: the slot of its facet's first corner.
#[inline(always)]
fn add_edge<L: Lanes>(
    (frame, segment, rule): (&NonmortarFrame, &Segment, &Rule),
    maps: &Maps<L>,
    f: &Functions,
    rows: usize,
    (first, edge): (usize, &EdgeInterval),
    [ab, ac]: &mut [Sums<L>; 2],
) {
    let is_own = first == 0;
    let projection = if is_own { &frame.projection } else { &segment.mortar };
    let corners = cell_corners(projection.shape.n);
    let (from, to) = (corners[edge.from & 3], corners[edge.to & 3]);
    let (y0, span, normal) = line(&projection.y, edge);
    for four in rule.line_lanes {
        let (w, [l0, l1], y) = edge_points::<L>(four, edge, y0, span);
        let (w, l0, l1) = (w.store(), l0.store(), l1.store());
        // Along its own edge a point's coordinates are known; the gradients, and so the determinant, are not asked for.
        let other = if is_own { maps.two.at(y) } else { maps.one.at(y) };
        let other = [other.xi.store(), other.eta.store()];
        for q in 0..rolled(4) {
            let own = [0, 1].map(|i| from[i] * l0[q] + to[i] * l1[q]);
            let there = [other[0][q], other[1][q]];
            let (one, two) = if is_own { (own, there) } else { (there, own) };
            let at = f.at::<L>((one, 1.0), (two, 1.0));
            for (end, l) in [(edge.from, l0[q]), (edge.to, l1[q])] {
                let slot = first + (end & 3);
                for a in 0..rows {
                    for c in 0..2 {
                        let n = L::splat(w[q] * l * at.a[a] * normal[c]);
                        for g in 0..f.one.groups() {
                            ab[a][g][slot][c] = n.mul_add(at.b.n[g], ab[a][g][slot][c]);
                        }
                        for g in 0..f.two.groups() {
                            ac[a][g][slot][c] = n.mul_add(at.c.n[g], ac[a][g][slot][c]);
                        }
                    }
                }
            }
        }
    }
}
