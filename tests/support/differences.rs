//! The tangent of an interface against central differences of its residual, every column. Unknowns in the order x1, x2,
//! lambda; the interface has all their equations, numbered so.
#![allow(dead_code)]

use super::max_abs;
use nalgebra::SVector;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Extent, PlanPairs, PlanSystem};

/// Step of the differences (facet size 0.5): rounding 1e-16/1e-6 and truncation 1e-12.
const STEP: f64 = 1e-6;
/// Rounding of a residual entry, relative to the largest.
const NOISE: f64 = 1e-15;

/// An interface and where it is evaluated.
pub struct Point<'a, const N: usize> {
    pub contact: &'a mut Contact<N>,
    pub x1: &'a [Vec3],
    pub x2: &'a [Vec3],
    pub lambda: &'a [SVector<f64, N>],
}

impl<const N: usize> Point<'_, N> {
    /// The largest difference between Newton's matrix of a plan, of either choice of pairs, and that of entries one by one, over its
    /// largest entry.
    pub fn plan_error(self) -> f64 {
        let Point { contact, x1, x2, lambda } = self;
        let n = 3 * (x1.len() + x2.len()) + N * lambda.len();
        let mut expected = vec![0.0; n * n];
        let mut add = |i: i64, j: i64, v: f64| expected[i as usize * n + j as usize] += v;
        contact.tangent(x1, x2, lambda, None, &mut add).unwrap();
        let largest = max_abs(expected.iter().copied());
        let mut of_pairs = |pairs| {
            let entries = contact.make_plan((&*x1, &*x2), pairs).unwrap();
            let mut values = vec![0.0; entries];
            contact.plan_values((&*x1, &*x2), lambda, None, &mut values).unwrap();
            let (plan, of) = contact.plan(PlanSystem::Whole).unwrap();
            let (mut k, mut found) = (0, vec![0.0; n * n]);
            let rows = plan.rows().0.to_vec();
            let mut row = rows.iter();
            plan.each_row(of, &mut |columns| {
                let i = *row.next().unwrap() as usize;
                columns.iter().for_each(|&j| {
                    found[i * n + j as usize] += values[k];
                    k += 1;
                });
                Ok(())
            })
            .unwrap();
            assert_eq!(k, entries);
            max_abs(found.iter().zip(&expected).map(|(a, b)| a - b)) / largest
        };
        max_abs([PlanPairs::Active(Extent::Whole), PlanPairs::Possible].into_iter().map(&mut of_pairs))
    }

    /// Ends of the blocks x1, x2, lambda.
    fn ends(&self) -> [usize; 4] {
        let (a, b) = (3 * self.x1.len(), 3 * (self.x1.len() + self.x2.len()));
        [0, a, b, b + N * self.lambda.len()]
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.ends()[3]
    }

    /// The tangent as a full matrix, row by row.
    pub fn tangent(&mut self) -> Vec<f64> {
        let n = self.unknowns();
        let mut k = vec![0.0; n * n];
        let mut add = |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v;
        self.contact.tangent(self.x1, self.x2, self.lambda, None, &mut add).unwrap();
        k
    }

    /// How far the residual is from linear over this step of all unknowns, over its largest entry at the step's end.
    pub fn linear_error(&mut self, step: &[f64]) -> f64 {
        let (k, n) = (self.tangent(), self.unknowns());
        let z = self.values();
        let moved: Vec<_> = z.iter().zip(step).map(|(z, d)| z + d).collect();
        let (before, after) = (self.residual(&z), self.residual(&moved));
        let expected = |i: usize| before[i] + step.iter().zip(&k[i * n..]).map(|(d, k)| k * d).sum::<f64>();
        max_abs((0..n).map(|i| after[i] - expected(i))) / max_abs(after.iter().copied())
    }

    fn values(&self) -> Vec<f64> {
        let x = self.x1.iter().chain(self.x2).flat_map(|v| v.iter().copied());
        x.chain(self.lambda.iter().flat_map(|v| v.iter().copied())).collect()
    }

    fn residual(&mut self, z: &[f64]) -> Vec<f64> {
        let [_, a, b, _] = self.ends();
        let points = |z: &[f64]| z.chunks_exact(3).map(Vec3::from_column_slice).collect::<Vec<_>>();
        let lambda: Vec<_> = z[b..].chunks_exact(N).map(SVector::from_column_slice).collect();
        let r = self.contact.residual(&points(&z[..a]), &points(&z[a..b]), &lambda, None).unwrap();
        let forces = r.nonmortar.iter().chain(&r.mortar).flat_map(|v| v.iter().copied());
        forces.chain(r.rows.iter().flat_map(|v| v.iter().copied())).collect()
    }

    /// Along a direction, the best of central differences with these steps, over the largest derivative: where many points decide, a step
    /// may meet a kink of one of them.
    pub fn error_along(&mut self, direction: &[f64], steps: &[f64]) -> f64 {
        let (k, n, z) = (self.tangent(), self.unknowns(), self.values());
        let exact: Vec<f64> = (0..n).map(|i| direction.iter().zip(&k[i * n..]).map(|(d, k)| k * d).sum()).collect();
        let mut error = |h: f64| {
            let mut at = |h: f64| self.residual(&z.iter().zip(direction).map(|(z, d)| z + h * d).collect::<Vec<_>>());
            let (plus, minus) = (at(h), at(-h));
            max_abs(exact.iter().enumerate().map(|(i, e)| (plus[i] - minus[i]) / (2.0 * h) - e))
                / max_abs(exact.iter().copied())
        };
        steps.iter().map(|&h| error(h)).fold(f64::INFINITY, f64::min)
    }

    /// See [`worst_difference`].
    pub fn difference_error(&mut self, floor: f64) -> f64 {
        let (k, ends, x) = (self.tangent(), self.ends(), self.values());
        worst_difference(&k, ends, &x, floor, |y| self.residual(y))
    }
}

/// Worst difference of the full matrix `k` from central differences of `residual` at `x`, per block (f1, f2, rows) x (x1, x2,
/// lambda), relative to the block's largest, or to `floor` times the matrix's if that is larger.
pub fn worst_difference(
    k: &[f64],
    ends: [usize; 4],
    x: &[f64],
    floor: f64,
    mut residual: impl FnMut(&[f64]) -> Vec<f64>,
) -> f64 {
    let n = x.len();
    let mut fd = vec![0.0; n * n];
    for j in 0..n {
        let at = |h: f64| {
            let mut y = x.to_vec();
            y[j] += h;
            y
        };
        let (plus, minus) = (at(STEP), at(-STEP));
        let h = plus[j] - minus[j];
        let (plus, minus) = (residual(&plus), residual(&minus));
        for i in 0..n {
            fd[i * n + j] = (plus[i] - minus[i]) / h;
        }
    }
    let noise = NOISE / STEP * max_abs(residual(x));
    let least = (floor * max_abs(k.iter().copied())).max(f64::MIN_POSITIVE);
    let mut worst = 0.0_f64;
    for rows in ends.windows(2) {
        for columns in ends.windows(2) {
            let block = || (rows[0]..rows[1]).flat_map(|i| (columns[0]..columns[1]).map(move |j| i * n + j));
            let error = max_abs(block().map(|t| k[t] - fd[t]));
            let scale = max_abs(block().map(|t| k[t]));
            // Blocks that vanish, as rows of sticking nodes over lambda do, differ by the noise alone.
            worst = worst.max((error - noise).max(0.0) / scale.max(least));
        }
    }
    worst
}
