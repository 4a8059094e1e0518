//! From the projected vertices to the nodes: the plane derivatives of `transport`, chained with Dy_k = in-plane part of
//! (Dx_k - Dx0), spin and tilt of the plane (docs/formulation 3.2); and what comes out.

use super::segment::{NonmortarFrame, Segment};
use super::slots::{MORTAR, MORTAR_CORNER, PAIR_CORNERS, PAIR_NODES};
use super::transport::PlaneDerivatives;
use crate::shape::{Basis, Cell, MAX_CORNERS, MAX_NODES};
use crate::simd::Lanes;

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
    pub ab: [[[[f64; 3]; PAIR_NODES]; MAX_NODES]; MAX_CORNERS],
    /// `ac[A][C][k]` = d n_AC / d x_k.
    pub ac: [[[[f64; 3]; PAIR_NODES]; MAX_NODES]; MAX_CORNERS],
}

impl Default for WeightDerivatives {
    fn default() -> Self {
        let zero = [[[[0.0; 3]; PAIR_NODES]; MAX_NODES]; MAX_CORNERS];
        WeightDerivatives { ab: zero, ac: zero }
    }
}

/// `[k][j][A]`: d m_A / d x_k,j of the covered areas, k over the pair's slots `[L]`.
pub type AreaDerivatives = [[[f64; MAX_CORNERS]; 3]; PAIR_NODES];

/// Where the derivatives of covered areas go.
pub(super) struct Areas<'a>(pub &'a mut AreaDerivatives);

impl<L: Lanes> Columns<L> for Areas<'_> {
    #[inline(always)]
    fn set(&mut self, k: usize, columns: [L; 3]) {
        let to = &mut self.0[k];
        for j in 0..3 {
            to[j] = columns[j].store();
        }
    }
}

/// The field 1: its forces f_B are the covered areas.
pub(super) const ONE: [f64; MAX_CORNERS] = [1.0; MAX_CORNERS];
/// The fields N_A: their forces are the weights.
pub(super) const SHAPES: [[f64; MAX_CORNERS]; MAX_CORNERS] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

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

/// Columns, lanes over the functions B or C of a displacement, into rows of these.
#[inline(always)]
pub(super) fn to_rows<L: Lanes, Field: Basis>(
    columns: &[[L; 3]; PAIR_NODES],
    sign: f64,
    rows: &mut [[[f64; 3]; PAIR_NODES]; MAX_NODES],
) {
    let (columns, sign) = (columns.as_flattened(), L::splat(sign));
    for (q, four) in columns.chunks_exact(4).enumerate() {
        let four = L::transpose([four[0] * sign, four[1] * sign, four[2] * sign, four[3] * sign]);
        for b in 0..Field::FUNCTIONS {
            rows[b].as_flattened_mut()[4 * q..][..4].copy_from_slice(&four[b].store());
        }
    }
}

/// From the projected vertices to the nodes. Its numbers stand in every lane: spread once, for several fields.
pub(super) struct Chain<'a, L> {
    pub frame: &'a NonmortarFrame,
    pub segment: &'a Segment,
    /// y_1, -y_0 and height of the vertices, mortar slots in the order of the projection.
    vertices: [[L; 3]; PAIR_CORNERS],
    /// Spin and negative tilts of the plane that the non-mortar nodes make.
    turns: [[L; 3]; MAX_CORNERS],
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
        let (mut vertices, mut turns, mut axes) = ([zero; PAIR_CORNERS], [zero; MAX_CORNERS], [zero; 3]);
        for k in 0..MAX_CORNERS {
            vertices[k] = spread([one.y[k].y, -one.y[k].x, one.d[k]]);
            vertices[MORTAR_CORNER + k] = spread([two.y[k].y, -two.y[k].x, two.d[k]]);
            turns[k] = spread([plane.spin[k], -plane.tilt[0][k], -plane.tilt[1][k]]);
        }
        for j in 0..3 {
            axes[j] = spread([plane.t1[j], plane.t2[j], plane.e[j]]);
        }
        Chain { frame, segment, vertices, turns, axes }
    }

    /// sum_k g_k . Dy_k as coefficients of the Dx of the pair's nodes, mortar slots in the order of the facet as given:
    /// the corners, which are projected, are the nodes.
    #[inline(always)]
    pub fn nodes<One: Cell, Two: Cell>(&self, g: &PlaneDerivatives<L>, to: &mut impl Columns<L>) {
        if !L::SHARED {
            return self.nodes_inlined::<One, Two>(g, to);
        }
        // One function for all that columns may go to.
        let Flat(columns) = self.nodes_shared::<One, Two>(g);
        for k in (0..One::CORNERS).chain(MORTAR..MORTAR + Two::CORNERS) {
            to.set(k, columns[k]);
        }
    }

    #[inline(never)]
    fn nodes_shared<One: Cell, Two: Cell>(&self, g: &PlaneDerivatives<L>) -> Flat<L> {
        let mut columns = Flat([[L::splat(0.0); 3]; PAIR_NODES]);
        self.nodes_inlined::<One, Two>(g, &mut columns);
        columns
    }

    #[inline(always)]
    fn nodes_inlined<One: Cell, Two: Cell>(&self, g: &PlaneDerivatives<L>, to: &mut impl Columns<L>) {
        const { assert!(PAIR_NODES == PAIR_CORNERS) };
        // What the pair does to translation, tilt and spin of the plane.
        let [mut shift, mut tilt, mut spins] = [[L::splat(0.0); 2]; 3];
        for k in 0..PAIR_CORNERS {
            if k < One::CORNERS || (k >= MORTAR_CORNER && k < MORTAR_CORNER + Two::CORNERS) {
                let ([y1, minus_y0, d], [g0, g1]) = (&self.vertices[k], g[k]);
                shift = [shift[0] + g0, shift[1] + g1];
                tilt = [d.mul_add(g0, tilt[0]), d.mul_add(g1, tilt[1])];
                spins = [y1.mul_add(g0, spins[0]), minus_y0.mul_add(g1, spins[1])];
            }
        }
        let mean = L::splat(1.0 / One::CORNERS as f64);
        shift = [shift[0] * mean, shift[1] * mean];
        let spin = spins[0] + spins[1]; // in two parts: one sum would be twice as long a chain
        for k in 0..One::CORNERS {
            let [turn, tilts0, tilts1] = &self.turns[k];
            let x = g[k][0] - shift[0];
            let y = turn.mul_add(spin, g[k][1] - shift[1]);
            let z = tilts0.mul_add(tilt[0], *tilts1 * tilt[1]);
            let mut columns = [x; 3];
            for j in 0..3 {
                let [t1, t2, e] = &self.axes[j];
                columns[j] = t1.mul_add(x, t2.mul_add(y, *e * z));
            }
            to.set(k, columns);
        }
        for l in 0..Two::CORNERS {
            let [x, y] = g[MORTAR_CORNER + l];
            let mut columns = [x; 3];
            for j in 0..3 {
                let [t1, t2, _] = &self.axes[j];
                columns[j] = t1.mul_add(x, *t2 * y);
            }
            to.set(MORTAR + (self.segment.mortar.node[l] & 3), columns); // so that no bounds are checked
        }
    }
}
