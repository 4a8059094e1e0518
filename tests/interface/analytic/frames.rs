//! Frames that have equations: rows and columns of their points against differences, by the facets' nodes, by the multipliers and by
//! each rigid motion of the frame.

use super::*;
use crate::support::mesh::options;
use stickslip::interface::{Decision, Friction, Normals, Stiffness, Weights};

/// Step of the differences, and what the tangent may be off by of the largest entry of a block: as in `tangent.rs`.
const STEP: f64 = 1e-6;
const DIFFERENCES: f64 = 1e-7;
/// Rounding of a residual, relative to its largest entry.
const NOISE: f64 = 1e-15;

/// E* where points decide [F/L^2]; and a step in which none of them leaves its state.
const MODULUS: f64 = 30.0;
const POINT_STEP: f64 = 2e-7;

/// A way to move everything by h.
enum Way {
    Unknown(usize),
    Shift(Vec3),
    Turn(Vec3),
}

impl<const N: usize> Rough<N> {
    /// Forces of the patch, its rows, forces on the frame, after a motion by `h`.
    fn moved(&mut self, way: &Way, h: f64) -> Vec<f64> {
        let (mut x1, mut x2, mut lambda) = (self.x1.clone(), self.x2.clone(), self.lambda.clone());
        let origin = x2[0];
        match way {
            Way::Unknown(j) if *j < 3 * x1.len() => x1[j / 3][j % 3] += h,
            Way::Unknown(j) => lambda[(j - 3 * x1.len()) / N][(j - 3 * x1.len()) % N] += h,
            Way::Shift(d) => x2.iter_mut().for_each(|x| *x += d * h),
            Way::Turn(axis) => {
                let q = Rotation3::from_scaled_axis(axis * h);
                x2.iter_mut().for_each(|x| *x = origin + q * (*x - origin));
            }
        }
        let r = self.contact.residual(&x1, &x2, &lambda, None).unwrap();
        [equations_of(&r), flatten(&r.mortar)].concat()
    }

    /// The same way among the unknowns.
    fn direction(&self, way: &Way, n: usize) -> Vec<f64> {
        let frame: Vec<_> = match way {
            Way::Unknown(j) => return (0..n).map(|k| f64::from(u8::from(k == *j))).collect(),
            Way::Shift(d) => vec![*d; self.x2.len()],
            Way::Turn(axis) => self.x2.iter().map(|x| axis.cross(&(x - self.x2[0]))).collect(),
        };
        [vec![0.0; (3 + N) * self.x1.len()], flatten(&frame)].concat()
    }
}

/// The worst block of rows (forces, multipliers' rows, forces on the frame) and columns (nodes, multipliers, motions of the frame).
fn worst<const N: usize>(rough: &mut Rough<N>, step: f64) -> f64 {
    let (at, after) = (3 * rough.x1.len(), (3 + N) * rough.x1.len());
    let n = after + 3 * rough.x2.len();
    let mut k = vec![0.0; n * n];
    let mut add = |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v;
    rough.contact.tangent(&rough.x1, &rough.x2, &rough.lambda, None, &mut add).unwrap();
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let groups: [Vec<Way>; 3] = [
        (0..at).map(Way::Unknown).collect(),
        (at..after).map(Way::Unknown).collect(),
        axes.map(Way::Shift).into_iter().chain(axes.map(Way::Turn)).collect(),
    ];
    let noise = NOISE / step * max_abs(rough.moved(&Way::Shift(Vec3::x()), 0.0));
    let mut worst = 0.0_f64;
    for ways in &groups {
        let (mut error, mut scale) = ([0.0_f64; 3], [0.0_f64; 3]);
        for way in ways {
            let (plus, minus, d) = (rough.moved(way, step), rough.moved(way, -step), rough.direction(way, n));
            for i in 0..n {
                let block = usize::from(i >= at) + usize::from(i >= after);
                let entry: f64 = (0..n).map(|j| k[i * n + j] * d[j]).sum();
                error[block] = error[block].max((entry - (plus[i] - minus[i]) / (2.0 * step)).abs());
                scale[block] = scale[block].max(entry.abs());
            }
        }
        for (error, scale) in error.into_iter().zip(scale).filter(|(error, _)| *error > noise) {
            worst = worst.max((error - noise) / scale);
        }
    }
    worst
}

fn check<const N: usize>(options: Options, step: f64)
where
    Contact<N>: Create,
{
    for shape in SHAPES {
        for cells in [Cells::Quads, Cells::Triangles] {
            let error = worst(&mut Rough::<N>::with(shape, cells, options, true), step);
            let Options { weights, normals, .. } = options;
            assert!(error <= DIFFERENCES, "{shape:?}, {N} multipliers, {weights:?}, {normals:?}: {error:.1e}");
        }
    }
}

#[test]
fn rows_and_columns_of_a_frame_equal_differences() {
    for (weights, normals) in [
        (Weights::Current, Normals::Committed),
        (Weights::Current, Normals::Current),
        (Weights::Committed, Normals::Committed),
    ] {
        let options = Options { weights, normals, ..options() };
        check::<3>(options, STEP);
        check::<1>(Options { mu: 0.0, ..options }, STEP);
    }
}

/// Where points decide, with weights that are frozen.
#[test]
fn rows_and_columns_of_a_frame_equal_differences_where_points_decide() {
    let (decision, stiffness) = (Decision::Points(MODULUS), Stiffness::Modulus(MODULUS));
    for weights in [Weights::Committed, Weights::Reference] {
        let options = Options { weights, decision, stiffness, basis: MultiplierBasis::Dual, ..options() };
        check::<3>(options, POINT_STEP);
        check::<1>(Options { friction: Friction::None, mu: 0.0, ..options }, POINT_STEP);
    }
}
