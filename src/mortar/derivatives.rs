//! Derivatives with respect to the nodes: the plane derivatives of `transport`, chained
//! with Dy_k = in-plane part of (Dx_k - Dx0), spin and tilt of the plane (formulation c.2).

use super::gap::AlongNormal;
use super::segment::{CellKernel, Cells, NonmortarFrame, Segment};
use super::transport::{PlaneDerivatives, Transport};
use super::weights::PairWeights;
use super::{MORTAR, PAIR_NODES};
use crate::quadrature::Rule;
use crate::shape::{Cell, MAX_NODES};
use crate::simd::Lanes;

/// d/dx of the forces f_B^i = int p^i N_B da, f_C^i = -int p^i N_C da of I fields p^i = sum_A N_A p^i_A: what a field has
/// per area, times `L`.
#[derive(Clone, Debug)]
pub struct ForceDerivatives<const I: usize = 3> {
    /// `one[k][j][i][B]` = d f_B^i / d x_k,j, k over the pair's slots.
    pub one: [[[[f64; MAX_NODES]; I]; 3]; PAIR_NODES],
    /// `two[k][j][i][C]` = d f_C^i / d x_k,j.
    pub two: [[[[f64; MAX_NODES]; I]; 3]; PAIR_NODES],
}

impl<const I: usize> Default for ForceDerivatives<I> {
    fn default() -> Self {
        let zero = [[[[0.0; MAX_NODES]; I]; 3]; PAIR_NODES];
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
const SHAPES: [[f64; MAX_NODES]; MAX_NODES] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

impl WeightDerivatives {
    /// Exact derivatives over a segment (exact when the rule is: affine facets, degree 5).
    pub fn integrate(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> WeightDerivatives {
        let mut weights = WeightDerivatives::default();
        let transport = Transport { frame, segment, rule, fields: &SHAPES };
        Cells::of(frame, segment).dispatch(OfWeights { transport, weights: &mut weights });
        weights
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
/// `p[i][A]`, into `forces`, and of the gaps. Where the mortar side does not move (`MOVES` false) its rows and columns are
/// left as they are; so are those of nodes that a triangle does not have.
pub fn pair_motion<const MOVES: bool>(
    (frame, segment, rule): (&NonmortarFrame, &Segment, &Rule),
    weights: &PairWeights,
    p: &[[f64; MAX_NODES]; 3],
    forces: &mut ForceDerivatives,
) -> AlongNormal {
    let transport = Transport { frame, segment, rule, fields: p };
    Cells::of(frame, segment).dispatch(OfPair::<MOVES> { transport, weights, forces })
}

struct OfPair<'a, const MOVES: bool> {
    transport: Transport<'a, 3>,
    weights: &'a PairWeights,
    forces: &'a mut ForceDerivatives,
}

impl<const MOVES: bool> CellKernel for OfPair<'_, MOVES> {
    type Output = AlongNormal;

    #[inline(always)]
    fn run<L: Lanes, One: Cell, Two: Cell>(self) -> AlongNormal {
        let d = self.transport.derivatives::<L, One, Two, MOVES, true>();
        let chain = Chain { frame: self.transport.frame, segment: self.transport.segment };
        for i in 0..3 {
            chain.forces::<L, One, Two, MOVES, 3>(&d, i, self.forces);
        }
        let local = chain.local::<L, One, Two, MOVES>(&d.gap);
        AlongNormal::new::<L, One, Two, MOVES>(&chain, local, self.weights)
    }
}

struct OfWeights<'a> {
    transport: Transport<'a, MAX_NODES>,
    weights: &'a mut WeightDerivatives,
}

impl CellKernel for OfWeights<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes, One: Cell, Two: Cell>(self) {
        let d = self.transport.derivatives::<L, One, Two, true, false>();
        let chain = Chain { frame: self.transport.frame, segment: self.transport.segment };
        for a in 0..One::NODES {
            let one = chain.columns::<L, One, Two, true>(chain.local::<L, One, Two, true>(&field(&d.one, a)));
            let two = chain.columns::<L, One, Two, true>(chain.local::<L, One, Two, true>(&field(&d.two, a)));
            to_rows::<L, One>(&one, 1.0, &mut self.weights.ab[a]);
            to_rows::<L, Two>(&two, -1.0, &mut self.weights.ac[a]);
        }
    }
}

/// The derivatives of field i.
#[inline(always)]
fn field<L: Lanes, const I: usize>(d: &[[[L; 2]; I]; PAIR_NODES], i: usize) -> [[L; 2]; PAIR_NODES] {
    let mut g = [[L::splat(0.0); 2]; PAIR_NODES];
    for k in 0..PAIR_NODES {
        g[k] = d[k][i];
    }
    g
}

/// Columns, lanes over the rows, into rows.
#[inline(always)]
fn to_rows<L: Lanes, C: Cell>(
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
    /// sum_k g_k . Dy_k as coefficients of the Dx of the pair's nodes, in the plane's axes t1, t2, e, mortar slots in the order
    /// of the facet as given.
    ///
    /// A translation and a spin of both facets change no weight: with a mortar side at rest the shares of the plane's own
    /// translation and spin cancel between the facets, and only its tilt is left.
    #[inline(always)]
    pub fn local<L: Lanes, One: Cell, Two: Cell, const MOVES: bool>(
        &self,
        g: &[[L; 2]; PAIR_NODES],
    ) -> [[L; 3]; PAIR_NODES] {
        let (plane, one, two) = (&self.frame.plane, &self.frame.projection, &self.segment.mortar);
        let zero = L::splat(0.0);
        let (mut shift, mut tilt, mut spin) = ([zero; 2], [zero; 2], zero);
        let mut x = [[zero; 3]; PAIR_NODES];
        for k in 0..One::NODES {
            gather(&mut shift, &mut tilt, &mut spin, g[k], [one.y[k].x, one.y[k].y, one.d[k]]);
        }
        if MOVES {
            for l in 0..Two::NODES {
                let g = g[MORTAR + l];
                gather(&mut shift, &mut tilt, &mut spin, g, [two.y[l].x, two.y[l].y, two.d[l]]);
                x[MORTAR + two.node[l]] = [g[0], g[1], zero];
            }
        } else {
            tilt = [tilt[0] + g[MORTAR][0], tilt[1] + g[MORTAR][1]];
        }
        let mean = L::splat(1.0 / One::NODES as f64);
        for k in 0..One::NODES {
            let along = L::splat(plane.tilt[0][k]).mul_add(tilt[0], L::splat(plane.tilt[1][k]) * tilt[1]);
            x[k] = [g[k][0], g[k][1], -along];
            if MOVES {
                x[k][0] = x[k][0] - shift[0] * mean;
                x[k][1] = L::splat(plane.spin[k]).mul_add(spin, x[k][1] - shift[1] * mean);
            }
        }
        x
    }

    /// The same in space.
    #[inline(always)]
    pub fn columns<L: Lanes, One: Cell, Two: Cell, const MOVES: bool>(
        &self,
        local: [[L; 3]; PAIR_NODES],
    ) -> [[L; 3]; PAIR_NODES] {
        let plane = &self.frame.plane;
        let mut x = [[L::splat(0.0); 3]; PAIR_NODES];
        for j in 0..3 {
            let (t1, t2, e) = (L::splat(plane.t1[j]), L::splat(plane.t2[j]), L::splat(plane.e[j]));
            for k in 0..One::NODES {
                x[k][j] = t1.mul_add(local[k][0], t2.mul_add(local[k][1], e * local[k][2]));
            }
            if MOVES {
                for k in MORTAR..MORTAR + Two::NODES {
                    x[k][j] = t1.mul_add(local[k][0], t2 * local[k][1]);
                }
            }
        }
        x
    }

    #[inline(always)]
    fn forces<L: Lanes, One: Cell, Two: Cell, const MOVES: bool, const I: usize>(
        &self,
        d: &PlaneDerivatives<L, I>,
        i: usize,
        forces: &mut ForceDerivatives<I>,
    ) {
        let one = self.columns::<L, One, Two, MOVES>(self.local::<L, One, Two, MOVES>(&field(&d.one, i)));
        write::<L, One, Two, MOVES, I>(&one, i, &mut forces.one);
        if MOVES {
            let two = self.columns::<L, One, Two, MOVES>(self.local::<L, One, Two, MOVES>(&field(&d.two, i)));
            write::<L, One, Two, MOVES, I>(&two, i, &mut forces.two);
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

#[inline(always)]
fn write<L: Lanes, One: Cell, Two: Cell, const MOVES: bool, const I: usize>(
    columns: &[[L; 3]; PAIR_NODES],
    i: usize,
    to: &mut [[[[f64; MAX_NODES]; I]; 3]; PAIR_NODES],
) {
    for j in 0..3 {
        for k in 0..One::NODES {
            to[k][j][i] = columns[k][j].store();
        }
        if MOVES {
            for k in MORTAR..MORTAR + Two::NODES {
                to[k][j][i] = columns[k][j].store();
            }
        }
    }
}
