//! The tangent against central differences of the residual, every column, on rough facets.

use super::*;
use crate::support::mesh::options;
use stickslip::interface::{Form, Friction, Normals, Weights};
use stickslip::law::SlipMeasure;

/// Step of the central differences (facet size 0.5): rounding 1e-16/1e-6 and truncation 1e-12.
const STEP: f64 = 1e-6;
/// Tangent against differences, relative to the largest entry of the block. The quadrature points are fixed on the
/// facet, so that the tangent is the exact derivative on warped facets too.
const DIFFERENCES: f64 = 1e-7;

impl<const N: usize> Rough<N> {
    fn point(&self) -> Vec<f64> {
        [flatten(&self.x1), flatten(&self.lambda)].concat()
    }

    fn residual(&mut self, point: &[f64]) -> Vec<f64> {
        let (x, lambda) = point.split_at(3 * self.x1.len());
        let x: Vec<_> = x.chunks_exact(3).map(Vec3::from_column_slice).collect();
        let lambda: Vec<_> = lambda.chunks_exact(N).map(SVector::from_column_slice).collect();
        equations_of(&self.contact.residual(&x, &self.x2, &lambda, None).unwrap())
    }

    /// Worst difference per block (f1, rows) x (x1, lambda), relative to the block's largest entry.
    fn difference_error(&mut self) -> f64 {
        let (k, point) = (dense(&mut self.contact, &self.x1, &self.x2, &self.lambda), self.point());
        let n = point.len();
        let mut differences = vec![0.0; n * n];
        for j in 0..n {
            let at =
                |h: f64| point.iter().enumerate().map(|(i, x)| if i == j { x + h } else { *x }).collect::<Vec<_>>();
            let (plus, minus) = (at(STEP), at(-STEP));
            let h = plus[j] - minus[j];
            for (i, (p, m)) in self.residual(&plus).iter().zip(self.residual(&minus)).enumerate() {
                differences[i * n + j] = (p - m) / h;
            }
        }
        let (ends, noise) = ([0, 3 * self.x1.len(), n], 1e-15 / STEP * max_abs(self.residual(&point)));
        let mut worst = 0.0_f64;
        for rows in ends.windows(2) {
            for columns in ends.windows(2) {
                let block = || (rows[0]..rows[1]).flat_map(|i| (columns[0]..columns[1]).map(move |j| i * n + j));
                let error = (max_abs(block().map(|t| k[t] - differences[t])) - noise).max(0.0);
                let scale = max_abs(block().map(|t| k[t]));
                worst = worst.max(if error > 0.0 { error / scale } else { 0.0 });
            }
        }
        worst
    }

    fn states(&mut self) -> [usize; 3] {
        let mut count = [0; 3];
        for r in self.contact.responses(&self.x1, &self.x2, &self.lambda, None).unwrap() {
            count[r.state as usize] += 1;
        }
        count
    }
}

fn check_differences<const N: usize>(options: Options) -> [usize; 3]
where
    Contact<N>: Create,
{
    let mut seen = [0; 3];
    for shape in SHAPES {
        for cells in [Cells::Quads, Cells::Triangles] {
            let mut rough = Rough::<N>::new(shape, cells, options);
            let error = rough.difference_error();
            assert!(error <= DIFFERENCES, "{shape:?}, {:?}, {:?}: {error:.1e}", options.friction, options.form);
            let states = rough.states();
            (0..3).for_each(|s| seen[s] += states[s]);
        }
    }
    seen
}

#[test]
fn tangent_equals_differences_in_every_column() {
    let forms = [Form::Multiplier, Form::Augmented];
    let mut seen = [0; 3];
    for (form, basis) in forms.into_iter().flat_map(|form| BASES.map(|basis| (form, basis))) {
        for (weights, normals) in [
            (Weights::Current, Normals::Committed),
            (Weights::Current, Normals::Current),
            (Weights::Committed, Normals::Committed),
            (Weights::Reference, Normals::Committed),
        ] {
            let options = Options { form, weights, normals, basis, ..options() };
            for slip in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper] {
                let states = check_differences::<3>(Options { slip, ..options });
                (0..3).for_each(|s| seen[s] += states[s]);
            }
            for (friction, mu) in [(Friction::Rough, 0.0), (Friction::Tied, 0.0), (Friction::Coulomb, 0.0)] {
                check_differences::<3>(Options { friction, mu, ..options });
            }
            check_differences::<3>(Options { friction: Friction::Tresca, shear_limit: Some(0.2), ..options });
            check_differences::<3>(Options { weak_coverage: 0.5, ..options });
            check_differences::<1>(Options { mu: 0.0, ..options });
        }
    }
    assert!(seen.iter().all(|&n| n > 0), "states {seen:?}");
}

/// Offsets of the nodes, different ones (docs/formulation 15).
#[test]
fn offsets_are_differentiated() {
    for (basis, form) in
        BASES.into_iter().flat_map(|basis| [Form::Multiplier, Form::Augmented].map(|form| (basis, form)))
    {
        for (shape, cells) in
            SHAPES.into_iter().flat_map(|shape| [Cells::Quads, Cells::Triangles].map(|cells| (shape, cells)))
        {
            let mut rough = Rough::<3>::new(shape, cells, Options { basis, form, ..options() });
            let mut random = Random(9);
            let offsets = rough.x1.iter().map(|_| 0.02 * random.next()).collect();
            rough.contact.set_offsets([Some(offsets), None]).unwrap();
            let error = rough.difference_error();
            assert!(error <= DIFFERENCES, "{shape:?} {basis:?} {form:?}: {error:.1e}");
        }
    }
}
