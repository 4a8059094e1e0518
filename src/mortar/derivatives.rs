//! Derivatives with respect to the nodes: the plane derivatives of `transport`, chained
//! with Dy_k = in-plane part of (Dx_k - Dx0), spin and tilt of the plane (docs/formulation.md 3.2).

use super::edges::Edges;
use super::element_rule;
use super::gap::AlongNormal;
use super::moments::Moments;
use super::segment::{CellKernel, Cells, NonmortarFrame, Segment};
use super::transport::{PlaneDerivatives, Transport};
use super::weights::PairWeights;
use super::{MORTAR, PAIR_NODES};
use crate::quadrature::Rule;
use crate::shape::{Cell, MAX_NODES};
use crate::simd::{Lanes, rolled};

/// d/dx of the forces f_B^i = int p^i N_B da, f_C^i = -int p^i N_C da of the three
/// components of a field p = sum_A N_A p_A [F/L].
#[derive(Clone, Debug)]
pub struct ForceDerivatives {
    /// `one[k][j][i][B]` = d f_B^i / d x_k,j, k over the pair's slots.
    pub one: [[[[f64; MAX_NODES]; 3]; 3]; PAIR_NODES],
    /// `two[k][j][i][C]` = d f_C^i / d x_k,j.
    pub two: [[[[f64; MAX_NODES]; 3]; 3]; PAIR_NODES],
}

impl Default for ForceDerivatives {
    fn default() -> Self {
        let zero = [[[[0.0; MAX_NODES]; 3]; 3]; PAIR_NODES];
        ForceDerivatives { one: zero, two: zero }
    }
}

/// dn/dx of every weight of a pair `[L]`; slots of absent nodes are zero.
#[derive(Clone, Debug)]
pub struct WeightDerivatives {
    /// `ab[A][B][k]` = d n_AB / d x_k, k over the pair's slots.
    pub ab: [[[[f64; 3]; PAIR_NODES]; MAX_NODES]; MAX_NODES],
    /// `ac[A][C][k]` = d n_AC / d x_k.
    pub ac: [[[[f64; 3]; PAIR_NODES]; MAX_NODES]; MAX_NODES],
}

impl Default for WeightDerivatives {
    fn default() -> Self {
        let zero = [[[[0.0; 3]; PAIR_NODES]; MAX_NODES]; MAX_NODES];
        WeightDerivatives { ab: zero, ac: zero }
    }
}

/// The fields N_A: their forces are the weights.
pub(super) const SHAPES: [[f64; MAX_NODES]; MAX_NODES] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

impl WeightDerivatives {
    /// The weights and their exact derivatives over a segment (exact when the rule is: affine facets, degree 5; a
    /// coarser rule's derivatives are those of degree 5; of points, those of their own sums). The weights are those of [`PairWeights::integrate`] but for rounding.
    pub fn integrate(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> (PairWeights, WeightDerivatives) {
        let mut derivatives = WeightDerivatives::default();
        (derivatives.update(frame, segment, rule), derivatives)
    }

    /// The same in place of what is there: they are large.
    pub fn update(&mut self, frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> PairWeights {
        if frame.projection.shape.n < MAX_NODES || segment.mortar.shape.n < MAX_NODES {
            *self = WeightDerivatives::default(); // absent nodes
        }
        if let Some(points) = segment.points {
            return element_rule::derivatives(frame, segment, points, self);
        }
        let fine = rule.for_derivatives();
        let weights = Cells::of(frame, segment).dispatch(OfWeights { frame, segment, rule: fine, derivatives: self });
        if fine.degree == rule.degree { weights } else { PairWeights::integrate(frame, segment, rule) }
    }

    /// The derivatives of the forces of the fields `p[i][A]` with these weights.
    pub fn of_forces(&self, p: &[[f64; MAX_NODES]; 3]) -> ForceDerivatives {
        let mut d = ForceDerivatives::default();
        for k in 0..PAIR_NODES {
            for (j, i) in (0..3).flat_map(|j| (0..3).map(move |i| (j, i))) {
                for b in 0..MAX_NODES {
                    for a in 0..MAX_NODES {
                        d.one[k][j][i][b] += p[i][a] * self.ab[a][b][k][j];
                        d.two[k][j][i][b] -= p[i][a] * self.ac[a][b][k][j];
                    }
                }
            }
        }
        d
    }
}

/// Derivatives of a pair with its current weights, exact where [`WeightDerivatives`] are: of the forces of the fields
/// `p[i][A]`, into `forces`, and of the gaps. Nodes that a triangle does not have are left as they are. Where the mortar
/// side is at rest: [`super::facet_motion`].
pub fn pair_motion(
    (frame, segment, rule): (&NonmortarFrame, &Segment, &Rule),
    weights: &PairWeights,
    p: &[[f64; MAX_NODES]; 3],
    forces: &mut ForceDerivatives,
) -> AlongNormal {
    if let Some(points) = segment.points {
        return element_rule::motion((frame, segment, points), weights, p, forces);
    }
    let rule = rule.for_derivatives();
    Cells::of(frame, segment).dispatch(OfPair { frame, segment, rule, weights, p, forces })
}

struct OfPair<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
    weights: &'a PairWeights,
    p: &'a [[f64; MAX_NODES]; 3],
    forces: &'a mut ForceDerivatives,
}

impl CellKernel for OfPair<'_> {
    type Output = AlongNormal;

    #[inline(always)]
    fn run<L: Lanes, One: Cell, Two: Cell>(self) -> AlongNormal {
        let OfPair { frame, segment, rule, weights, p, forces } = self;
        let moments = Moments::<L>::integrate::<One, Two>(frame, segment, rule);
        let mut edges = Edges::new();
        edges.integrate::<One, Two>(frame, segment, rule);
        let transport = Transport::new::<One, Two>(frame, segment, &moments, &edges);
        let chain = Chain::new(frame, segment);
        for i in 0..rolled(3) {
            chain.nodes::<One, Two>(&transport.one::<One>(&p[i]), &mut Component { to: &mut forces.one, i });
            chain.nodes::<One, Two>(&transport.two::<One, Two>(&p[i]), &mut Component { to: &mut forces.two, i });
        }
        AlongNormal::new::<L, One, Two>(&chain, &transport.gap::<One, Two>(&frame.projection.d), weights)
    }
}

struct OfWeights<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
    derivatives: &'a mut WeightDerivatives,
}

impl CellKernel for OfWeights<'_> {
    type Output = PairWeights;

    #[inline(always)]
    fn run<L: Lanes, One: Cell, Two: Cell>(self) -> PairWeights {
        let OfWeights { frame, segment, rule, derivatives } = self;
        let moments = Moments::<L>::integrate::<One, Two>(frame, segment, rule);
        let mut edges = Edges::new();
        edges.integrate::<One, Two>(frame, segment, rule);
        let transport = Transport::new::<One, Two>(frame, segment, &moments, &edges);
        let chain = Chain::new(frame, segment);
        let mut columns = Flat([[L::splat(0.0); 3]; PAIR_NODES]);
        for a in 0..rolled(One::NODES) {
            chain.nodes::<One, Two>(&transport.one::<One>(&SHAPES[a]), &mut columns);
            to_rows::<L, One>(&columns.0, 1.0, &mut derivatives.ab[a]);
            chain.nodes::<One, Two>(&transport.two::<One, Two>(&SHAPES[a]), &mut columns);
            to_rows::<L, Two>(&columns.0, -1.0, &mut derivatives.ac[a]);
        }
        moments.weights::<One>(&frame.map.determinant())
    }
}

/// Where columns go: those of slot k, its three components.
pub(super) trait Columns<L> {
    fn set(&mut self, k: usize, columns: [L; 3]);
}

/// Component i of the forces.
pub(super) struct Component<'a> {
    pub to: &'a mut [[[[f64; MAX_NODES]; 3]; 3]; PAIR_NODES],
    pub i: usize,
}

impl<L: Lanes> Columns<L> for Component<'_> {
    #[inline(always)]
    fn set(&mut self, k: usize, columns: [L; 3]) {
        let to = &mut self.to[k];
        for j in 0..3 {
            to[j][self.i] = columns[j].store();
        }
    }
}

pub(super) struct Flat<L>(pub [[L; 3]; PAIR_NODES]);

impl<L: Lanes> Columns<L> for Flat<L> {
    #[inline(always)]
    fn set(&mut self, k: usize, columns: [L; 3]) {
        self.0[k] = columns;
    }
}

/// Columns, lanes over the rows, into rows.
#[inline(always)]
pub(super) fn to_rows<L: Lanes, C: Cell>(
    columns: &[[L; 3]; PAIR_NODES],
    sign: f64,
    rows: &mut [[[f64; 3]; PAIR_NODES]; MAX_NODES],
) {
    let (columns, sign) = (columns.as_flattened(), L::splat(sign));
    for (q, four) in columns.chunks_exact(4).enumerate() {
        let four = L::transpose([four[0] * sign, four[1] * sign, four[2] * sign, four[3] * sign]);
        for b in 0..C::NODES {
            rows[b].as_flattened_mut()[4 * q..][..4].copy_from_slice(&four[b].store());
        }
    }
}

/// From the projected vertices to the nodes. Its numbers stand in every lane: spread once, for several fields.
pub(super) struct Chain<'a, L> {
    pub frame: &'a NonmortarFrame,
    pub segment: &'a Segment,
    /// y_1, -y_0 and height of the vertices, mortar slots in the order of the projection.
    vertices: [[L; 3]; PAIR_NODES],
    /// Spin and negative tilts of the plane that the non-mortar nodes make.
    turns: [[L; 3]; MAX_NODES],
    /// `[j]`: components j of t1, t2, e.
    pub axes: [[L; 3]; 3],
}

/// Three numbers in every lane.
#[inline(always)]
fn spread<L: Lanes>([a, b, c]: [f64; 3]) -> [L; 3] {
    [L::splat(a), L::splat(b), L::splat(c)]
}

impl<'a, L: Lanes> Chain<'a, L> {
    #[inline(always)]
    pub fn new(frame: &'a NonmortarFrame, segment: &'a Segment) -> Self {
        let (plane, one, two) = (&frame.plane, &frame.projection, &segment.mortar);
        let zero = [L::splat(0.0); 3];
        let (mut vertices, mut turns, mut axes) = ([zero; PAIR_NODES], [zero; MAX_NODES], [zero; 3]);
        for k in 0..MAX_NODES {
            vertices[k] = spread([one.y[k].y, -one.y[k].x, one.d[k]]);
            vertices[MORTAR + k] = spread([two.y[k].y, -two.y[k].x, two.d[k]]);
            turns[k] = spread([plane.spin[k], -plane.tilt[0][k], -plane.tilt[1][k]]);
        }
        for j in 0..3 {
            axes[j] = spread([plane.t1[j], plane.t2[j], plane.e[j]]);
        }
        Chain { frame, segment, vertices, turns, axes }
    }

    /// sum_k g_k . Dy_k as coefficients of the Dx of the pair's nodes, mortar slots in the order of the facet as given.
    #[inline(always)]
    pub fn nodes<One: Cell, Two: Cell>(&self, g: &PlaneDerivatives<L>, to: &mut impl Columns<L>) {
        if L::SHARED { self.nodes_shared::<One, Two>(g, to) } else { self.nodes_inlined::<One, Two>(g, to) }
    }

    #[inline(never)]
    fn nodes_shared<One: Cell, Two: Cell>(&self, g: &PlaneDerivatives<L>, to: &mut impl Columns<L>) {
        self.nodes_inlined::<One, Two>(g, to);
    }

    #[inline(always)]
    fn nodes_inlined<One: Cell, Two: Cell>(&self, g: &PlaneDerivatives<L>, to: &mut impl Columns<L>) {
        // What the pair does to translation, tilt and spin of the plane.
        let (mut shift, mut tilt, mut spin) = ([L::splat(0.0); 2], [L::splat(0.0); 2], L::splat(0.0));
        for k in 0..PAIR_NODES {
            if k < One::NODES || (k >= MORTAR && k < MORTAR + Two::NODES) {
                let ([y1, minus_y0, d], [g0, g1]) = (&self.vertices[k], g[k]);
                shift = [shift[0] + g0, shift[1] + g1];
                tilt = [d.mul_add(g0, tilt[0]), d.mul_add(g1, tilt[1])];
                spin = y1.mul_add(g0, minus_y0.mul_add(g1, spin));
            }
        }
        let mean = L::splat(1.0 / One::NODES as f64);
        shift = [shift[0] * mean, shift[1] * mean];
        for k in 0..One::NODES {
            let [spins, tilts0, tilts1] = &self.turns[k];
            let x = g[k][0] - shift[0];
            let y = spins.mul_add(spin, g[k][1] - shift[1]);
            let z = tilts0.mul_add(tilt[0], *tilts1 * tilt[1]);
            let mut columns = [x; 3];
            for j in 0..3 {
                let [t1, t2, e] = &self.axes[j];
                columns[j] = t1.mul_add(x, t2.mul_add(y, *e * z));
            }
            to.set(k, columns);
        }
        for l in 0..Two::NODES {
            let [x, y] = g[MORTAR + l];
            let mut columns = [x; 3];
            for j in 0..3 {
                let [t1, t2, _] = &self.axes[j];
                columns[j] = t1.mul_add(x, *t2 * y);
            }
            to.set(MORTAR + (self.segment.mortar.node[l] & 3), columns); // so that no bounds are checked
        }
    }
}
