//! Derivatives with respect to the nodes: the plane derivatives of `transport`, chained
//! with Dy_k = in-plane part of (Dx_k - Dx0), spin and tilt of the plane (formulation c.2).

use super::element_rule;
use super::gap::AlongNormal;
use super::segment::{CellKernel, Cells, NonmortarFrame, Segment};
use super::transport::{Integrals, PlaneDerivatives, Transport};
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
        let integrals = Integrals::<L>::new::<One, Two>(frame, segment, rule);
        let transport = Transport::new::<Two>(frame, segment, &integrals);
        let chain = Chain { frame, segment };
        for i in 0..rolled(3) {
            let one = chain.local::<L, One, Two>(&transport.one::<One>(&p[i]));
            chain.columns::<L, One, Two>(&one, &mut Component { to: &mut forces.one, i });
            let two = chain.local::<L, One, Two>(&transport.two::<One, Two>(&p[i]));
            chain.columns::<L, One, Two>(&two, &mut Component { to: &mut forces.two, i });
        }
        let gap = transport.gap::<One, Two>(&frame.projection.d);
        AlongNormal::new::<L, One, Two>(&chain, chain.local::<L, One, Two>(&gap), weights)
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
        let integrals = Integrals::<L>::new::<One, Two>(frame, segment, rule);
        let transport = Transport::new::<Two>(frame, segment, &integrals);
        let chain = Chain { frame, segment };
        for a in 0..rolled(One::NODES) {
            let one = chain.local::<L, One, Two>(&transport.one::<One>(&SHAPES[a]));
            let mut columns = Flat([[L::splat(0.0); 3]; PAIR_NODES]);
            chain.columns::<L, One, Two>(&one, &mut columns);
            to_rows::<L, One>(&columns.0, 1.0, &mut derivatives.ab[a]);
            let two = chain.local::<L, One, Two>(&transport.two::<One, Two>(&SHAPES[a]));
            chain.columns::<L, One, Two>(&two, &mut columns);
            to_rows::<L, Two>(&columns.0, -1.0, &mut derivatives.ac[a]);
        }
        integrals.moments.weights::<One>(&frame.map.determinant())
    }
}

/// Where columns go, each with slot k and component j.
pub(super) trait Columns<L> {
    fn set(&mut self, k: usize, j: usize, column: L);
}

/// Component i of the forces.
pub(super) struct Component<'a> {
    pub to: &'a mut [[[[f64; MAX_NODES]; 3]; 3]; PAIR_NODES],
    pub i: usize,
}

impl<L: Lanes> Columns<L> for Component<'_> {
    #[inline(always)]
    fn set(&mut self, k: usize, j: usize, column: L) {
        self.to[k][j][self.i] = column.store();
    }
}

pub(super) struct Flat<L>(pub [[L; 3]; PAIR_NODES]);

impl<L: Lanes> Columns<L> for Flat<L> {
    #[inline(always)]
    fn set(&mut self, k: usize, j: usize, column: L) {
        self.0[k][j] = column;
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

/// From the projected vertices to the nodes.
pub(super) struct Chain<'a> {
    pub frame: &'a NonmortarFrame,
    pub segment: &'a Segment,
}

impl Chain<'_> {
    /// sum_k g_k . Dy_k as coefficients of the Dx of the pair's nodes, in the plane's axes t1, t2, e; mortar slots in
    /// the order of the projection.
    #[inline(always)]
    pub fn local<L: Lanes, One: Cell, Two: Cell>(&self, g: &PlaneDerivatives<L>) -> [[L; 3]; PAIR_NODES] {
        if L::SHARED { self.local_shared::<L, One, Two>(g) } else { self.local_inlined::<L, One, Two>(g) }
    }

    #[inline(never)]
    fn local_shared<L: Lanes, One: Cell, Two: Cell>(&self, g: &PlaneDerivatives<L>) -> [[L; 3]; PAIR_NODES] {
        self.local_inlined::<L, One, Two>(g)
    }

    #[inline(always)]
    fn local_inlined<L: Lanes, One: Cell, Two: Cell>(&self, g: &PlaneDerivatives<L>) -> [[L; 3]; PAIR_NODES] {
        let (plane, one, two) = (&self.frame.plane, &self.frame.projection, &self.segment.mortar);
        let zero = L::splat(0.0);
        let (mut shift, mut tilt, mut spin) = ([zero; 2], [zero; 2], zero);
        for k in 0..One::NODES {
            gather(&mut shift, &mut tilt, &mut spin, g[k], [one.y[k].x, one.y[k].y, one.d[k]]);
        }
        let mut x = [[zero; 3]; PAIR_NODES];
        for l in 0..Two::NODES {
            let g = g[MORTAR + l];
            gather(&mut shift, &mut tilt, &mut spin, g, [two.y[l].x, two.y[l].y, two.d[l]]);
            x[MORTAR + l] = [g[0], g[1], zero];
        }
        let mean = L::splat(1.0 / One::NODES as f64);
        for k in 0..One::NODES {
            let along = L::splat(plane.tilt[0][k]).mul_add(tilt[0], L::splat(plane.tilt[1][k]) * tilt[1]);
            let across = L::splat(plane.spin[k]).mul_add(spin, g[k][1] - shift[1] * mean);
            x[k] = [g[k][0] - shift[0] * mean, across, -along];
        }
        x
    }

    /// The same in space, mortar slots in the order of the facet as given.
    #[inline(always)]
    pub fn columns<L: Lanes, One: Cell, Two: Cell>(&self, local: &[[L; 3]; PAIR_NODES], to: &mut impl Columns<L>) {
        if L::SHARED {
            self.columns_shared::<L, One, Two>(local, to)
        } else {
            self.columns_inlined::<L, One, Two>(local, to)
        }
    }

    #[inline(never)]
    fn columns_shared<L: Lanes, One: Cell, Two: Cell>(&self, local: &[[L; 3]; PAIR_NODES], to: &mut impl Columns<L>) {
        self.columns_inlined::<L, One, Two>(local, to);
    }

    #[inline(always)]
    fn columns_inlined<L: Lanes, One: Cell, Two: Cell>(&self, local: &[[L; 3]; PAIR_NODES], to: &mut impl Columns<L>) {
        let plane = &self.frame.plane;
        for j in 0..3 {
            let (t1, t2, e) = (L::splat(plane.t1[j]), L::splat(plane.t2[j]), L::splat(plane.e[j]));
            for k in 0..One::NODES {
                to.set(k, j, t1.mul_add(local[k][0], t2.mul_add(local[k][1], e * local[k][2])));
            }
            for l in 0..Two::NODES {
                let x = &local[MORTAR + l];
                let slot = MORTAR + self.segment.mortar.node[l];
                to.set(slot, j, t1.mul_add(x[0], t2.mul_add(x[1], e * x[2])));
            }
        }
    }
}

/// Adds what a vertex at `y`, `d` contributes to translation, tilt and spin of the plane.
#[inline(always)]
fn gather<L: Lanes>(shift: &mut [L; 2], tilt: &mut [L; 2], spin: &mut L, g: [L; 2], [y0, y1, d]: [f64; 3]) {
    for c in 0..2 {
        shift[c] = shift[c] + g[c];
        tilt[c] = L::splat(d).mul_add(g[c], tilt[c]);
    }
    *spin = L::splat(y1).mul_add(g[0], L::splat(-y0).mul_add(g[1], *spin));
}
