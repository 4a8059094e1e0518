//! Rows of a facet's multipliers with respect to all of its columns: its own nodes in the first [`MAX_NODES`] places, then mortar ones.
//! What `tangent.rs` has of a pair, once a facet:
//!
//! Dc_A = (dc/dg_now) Dg_A + (dc/dg_previous) Dg_A at t_n's weights, with Dg_A = e Dgamma_A + gamma_A De, or n_A where weights are
//! fixed, or blocks of the facet's own nodes against an analytic surface; and drow . nu Do_A of the nodes' offsets.

use super::response::FacetResponse;
use crate::geometry::{Mat3, Vec3};
use crate::mortar::{AlongNormal, GapBlocks};
use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd::{self, Kernel, Lanes, rolled};

/// `[j][A]`: a number of every multiplier by component j of a column's node.
pub type Slopes = [[f64; MAX_CORNERS]; 3];

/// `[j][n][A]`: d row_A,n / d x_j of a column's node.
pub type Rows<const N: usize> = [[[f64; MAX_CORNERS]; N]; 3];

/// How gaps along the normal e of a facet's plane turn with it: [`AlongNormal`] without its columns.
#[derive(Clone, Copy, Debug)]
pub struct Along {
    /// e, and the plane's other axes.
    pub e: Vec3,
    /// t1, t2.
    pub axes: [Vec3; 2],
    /// t_j . De = sum_k `tilt[j][k]` e . Dx_k [1/L].
    pub tilt: [[f64; MAX_CORNERS]; 2],
    /// gamma_A of all pairs [L^3].
    pub gamma: [f64; MAX_CORNERS],
}

impl From<&AlongNormal> for Along {
    fn from(of: &AlongNormal) -> Along {
        Along { e: of.e, axes: of.axes, tilt: of.tilt, gamma: of.gamma }
    }
}

/// How gaps of nodes that are offset run: along nu of the facet's nodes, and whether in those that slip is measured from, too.
#[derive(Clone, Copy, Debug)]
pub struct Raise {
    /// nu.
    pub normals: [Vec3; MAX_CORNERS],
    /// Whether in those of t_n's weights.
    pub in_previous: bool,
}

/// Dg_A of a facet, column by column; a list is as long as the columns, or empty.
#[derive(Clone, Copy, Debug)]
pub struct FacetGaps<'a> {
    /// Where the weights' derivatives are known: how gaps turn, and Dgamma_A.
    pub along: Option<&'a Along>,
    /// `d gamma_A`.
    pub slopes: &'a [Slopes],
    /// Of the own nodes alone.
    pub blocks: Option<&'a GapBlocks>,
    /// n_AB and - n_AC of now, where they are held fixed, lanes A.
    pub fixed: &'a [[f64; MAX_CORNERS]],
    /// Those of t_n: of every column.
    pub previous: &'a [[f64; MAX_CORNERS]],
    /// Of nodes that are offset.
    pub raise: Option<&'a Raise>,
    /// Do_A.
    pub offsets: &'a [Slopes],
    /// Dm_A of the covered areas, where a row depends on them.
    pub areas: &'a [Slopes],
}

/// d row / d x of a facet, in place of what is in `rows`, of as many columns.
#[inline(never)]
pub fn facet_rows<const N: usize>(gaps: FacetGaps, nodes: &FacetResponse<N>, rows: &mut [Rows<N>]) {
    simd::dispatch(RowsKernel { gaps, nodes, rows });
}

/// The same of one multiplier, through how an answer of three components depends on its gaps of now and of t_n: `[column][j][i]`, with a
/// fourth number that nobody takes.
#[inline(never)]
pub fn node_row(gaps: FacetGaps, k: usize, ([now, before], area): ([&Mat3; 2], &Vec3), row: &mut [[[f64; 4]; 3]]) {
    let mut add = |column: usize, j: usize, of: Vec3| (0..3).for_each(|i| row[column][j][i] += of[i]);
    for (column, previous) in gaps.previous.iter().enumerate() {
        let fixed = gaps.fixed.get(column).map_or(0.0, |fixed| fixed[k]);
        (0..3).for_each(|j| add(column, j, before.column(j) * previous[k] + now.column(j) * fixed));
    }
    if let Some(Along { e, axes, tilt, gamma }) = gaps.along {
        let (of_e, across) = (now * e, axes.map(|axis| now * axis * gamma[k]));
        for (column, slopes) in gaps.slopes.iter().enumerate() {
            (0..3).for_each(|j| add(column, j, of_e * slopes[j][k]));
        }
        for column in 0..MAX_NODES {
            let tilt = across[0] * tilt[0][column] + across[1] * tilt[1][column];
            (0..3).for_each(|j| add(column, j, tilt * e[j]));
        }
    }
    if let Some(blocks) = gaps.blocks {
        for (column, of) in blocks.iter().enumerate() {
            (0..3).for_each(|j| add(column, j, now * Vec3::new(of[0][j][k], of[1][j][k], of[2][j][k])));
        }
    }
    if let Some(raise) = gaps.raise {
        let along = (if raise.in_previous { now + before } else { *now }) * raise.normals[k];
        for (column, slopes) in gaps.offsets.iter().enumerate() {
            (0..3).for_each(|j| add(column, j, along * slopes[j][k]));
        }
    }
    for (column, slopes) in gaps.areas.iter().enumerate() {
        (0..3).for_each(|j| add(column, j, area * slopes[j][k]));
    }
}

#[inline(always)]
fn components<L: Lanes>(of: &[[f64; MAX_CORNERS]; 3]) -> [L; 3] {
    [L::load(&of[0]), L::load(&of[1]), L::load(&of[2])]
}

#[inline(always)]
fn dot<L: Lanes>(of: &[L; 3], v: &Vec3) -> L {
    of[2].mul_add(L::splat(v[2]), of[1].mul_add(L::splat(v[1]), of[0] * L::splat(v[0])))
}

struct RowsKernel<'a, const N: usize> {
    gaps: FacetGaps<'a>,
    nodes: &'a FacetResponse<N>,
    rows: &'a mut [Rows<N>],
}

impl<const N: usize> Kernel for RowsKernel<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let RowsKernel { gaps, nodes, rows } = self;
        for n in 0..N {
            let (now, before) = (components::<L>(&nodes.now[n]), components::<L>(&nodes.previous[n]));
            for (row, previous) in rows.iter_mut().zip(gaps.previous) {
                let previous = L::load(previous);
                for j in 0..3 {
                    row[j][n] = (before[j] * previous).store();
                }
            }
            for (row, fixed) in rows.iter_mut().zip(gaps.fixed) {
                let fixed = L::load(fixed);
                for j in 0..3 {
                    row[j][n] = now[j].mul_add(fixed, L::load(&row[j][n])).store();
                }
            }
            if let Some(along) = gaps.along {
                let (of_e, gamma) = (dot(&now, &along.e), L::load(&along.gamma));
                let across = [dot(&now, &along.axes[0]) * gamma, dot(&now, &along.axes[1]) * gamma];
                for (row, slopes) in rows.iter_mut().zip(gaps.slopes) {
                    for j in 0..3 {
                        row[j][n] = of_e.mul_add(L::load(&slopes[j]), L::load(&row[j][n])).store();
                    }
                }
                for (k, row) in rows.iter_mut().enumerate().take(MAX_NODES) {
                    // gamma De = gamma (t1 tilt1 + t2 tilt2) e . Dx_k
                    let tilt = across[1].mul_add(L::splat(along.tilt[1][k]), across[0] * L::splat(along.tilt[0][k]));
                    for j in 0..3 {
                        row[j][n] = tilt.mul_add(L::splat(along.e[j]), L::load(&row[j][n])).store();
                    }
                }
            }
            if let Some(blocks) = gaps.blocks {
                for (row, of) in rows.iter_mut().zip(blocks) {
                    for (i, j) in (0..rolled(3)).flat_map(|i| (0..3).map(move |j| (i, j))) {
                        row[j][n] = now[i].mul_add(L::load(&of[i][j]), L::load(&row[j][n])).store();
                    }
                }
            }
            if let Some(raise) = gaps.raise {
                let mut along = L::splat(0.0);
                for i in 0..3 {
                    let nu = L::load(&raise.normals.map(|nu| nu[i]));
                    along = now[i].mul_add(nu, along);
                    if raise.in_previous {
                        along = before[i].mul_add(nu, along);
                    }
                }
                for (row, slopes) in rows.iter_mut().zip(gaps.offsets) {
                    for j in 0..3 {
                        row[j][n] = along.mul_add(L::load(&slopes[j]), L::load(&row[j][n])).store();
                    }
                }
            }
            for (row, slopes) in rows.iter_mut().zip(gaps.areas) {
                let area = L::load(&nodes.area[n]);
                for j in 0..3 {
                    row[j][n] = area.mul_add(L::load(&slopes[j]), L::load(&row[j][n])).store();
                }
            }
        }
    }
}
