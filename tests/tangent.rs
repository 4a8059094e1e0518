//! The tangent against central differences of the library's own residual, every column (row K2 of the
//! hard tests), and its exact properties (K4, K5).

mod support;

use stickslip::geometry::Vec3;
use stickslip::interface::{Form, Options, Weights};
use stickslip::law::{SlipMeasure, State};
use stickslip::quadrature::{DEGREE_5, DEGREE_10};
use support::max_abs;
use support::mesh::*;

/// Step of the differences (facet size 0.5): rounding 1e-16/1e-6 and truncation 1e-12.
const STEP: f64 = 1e-6;
/// Rounding of a residual entry, relative to the largest.
const NOISE: f64 = 1e-15;
/// K2: relative to the largest entry of the block.
const DIFFERENCES: f64 = 1e-7;
/// Warped, jittered quads with the degree-10 rule (measured 7e-10): its own quadrature error.
const DIFFERENCES_WARPED_DEGREE_10: f64 = 1e-8;
/// The same with the default rule (measured 5e-7); Newton does not notice.
const DIFFERENCES_WARPED_DEGREE_5: f64 = 1e-5;
/// K4: sums over a column or a translation, relative to the largest entry.
const ROUNDING: f64 = 1e-13;

impl Moved {
    fn unknowns(&self) -> usize {
        3 * (2 * self.x1.len() + self.x2.len())
    }

    fn residual(&mut self, x: &[f64]) -> Vec<f64> {
        let v = |x: &[f64]| x.chunks_exact(3).map(Vec3::from_column_slice).collect::<Vec<_>>();
        let (a, b) = (3 * self.x1.len(), 3 * (self.x1.len() + self.x2.len()));
        let r = self.interface.residual(&v(&x[..a]), &v(&x[a..b]), &v(&x[b..]), None).unwrap();
        [r.nonmortar, r.mortar, r.rows].iter().flatten().flat_map(|v| [v.x, v.y, v.z]).collect()
    }

    fn point(&self) -> Vec<f64> {
        [&self.x1, &self.x2, &self.lambda].into_iter().flatten().flat_map(|v| [v.x, v.y, v.z]).collect()
    }

    fn tangent(&mut self) -> Vec<f64> {
        let n = self.unknowns();
        let mut k = vec![0.0; n * n];
        let mut add = |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v;
        self.interface.tangent(&self.x1, &self.x2, &self.lambda, None, &mut add).unwrap();
        k
    }

    fn states(&mut self) -> [usize; 3] {
        let mut count = [0; 3];
        for r in self.interface.responses(&self.x1, &self.x2, &self.lambda, None).unwrap() {
            count[r.state as usize] += 1;
        }
        count
    }

    /// Worst difference per block (f1, f2, rows) x (x1, x2, lambda), relative to the block's largest, or to
    /// `floor` times the matrix's if that is larger.
    fn difference_error(&mut self, floor: f64) -> f64 {
        let (n, k, x) = (self.unknowns(), self.tangent(), self.point());
        let mut fd = vec![0.0; n * n];
        for j in 0..n {
            let at = |h: f64| {
                let mut y = x.clone();
                y[j] += h;
                y
            };
            let (plus, minus) = (at(STEP), at(-STEP));
            let h = plus[j] - minus[j];
            let (plus, minus) = (self.residual(&plus), self.residual(&minus));
            for i in 0..n {
                fd[i * n + j] = (plus[i] - minus[i]) / h;
            }
        }
        let noise = NOISE / STEP * max_abs(self.residual(&x));
        let least = (floor * max_abs(k.iter().copied())).max(f64::MIN_POSITIVE);
        let ends = [0, 3 * self.x1.len(), n - 3 * self.x1.len(), n];
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
}

fn variants() -> Vec<Options> {
    let mut all = Vec::new();
    for form in [Form::Multiplier, Form::Augmented] {
        for weights in [Weights::Current, Weights::Committed, Weights::Reference] {
            for slip in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Seed] {
                all.push(Options { form, weights, slip, ..options() });
            }
        }
    }
    all
}

#[test]
fn equals_differences_in_every_column_variant_and_state() {
    use Cells::{Quads, Triangles};
    let mut seen = [0; 3];
    for options in variants() {
        for cells in [[Quads, Quads], [Triangles, Triangles], [Quads, Triangles], [Triangles, Quads]] {
            // Quads stay parallelograms; triangles may be as rough as they like.
            let rough =
                if cells == [Triangles, Triangles] { Roughness { warp: 0.05, jitter: 0.1, slide: 0.02 } } else { FLAT };
            let mut scene = moved(&options, cells, rough, 7);
            let states = scene.states();
            (0..3).for_each(|s| seen[s] += states[s]);
            let error = scene.difference_error(0.0);
            assert!(error <= DIFFERENCES, "{options:?}: off by {error:e}");
        }
    }
    for state in [State::Gap, State::Stick, State::Slip] {
        assert!(seen[state as usize] > 20, "{state:?} hardly occurs: {seen:?}");
    }
}

#[test]
fn on_warped_facets_the_difference_is_the_quadrature_error() {
    let rough = Roughness { warp: 0.05, jitter: 0.08, slide: 0.02 };
    for (rule, bound) in [(&DEGREE_5, DIFFERENCES_WARPED_DEGREE_5), (&DEGREE_10, DIFFERENCES_WARPED_DEGREE_10)] {
        for seed in 1..4 {
            let options = Options { rule, ..options() };
            let error = moved(&options, [Cells::Quads, Cells::Quads], rough, seed).difference_error(1.0);
            println!("degree {}: {error:.1e}", rule.degree);
            assert!(error <= bound, "degree {}: off by {error:e}", rule.degree);
        }
    }
}

#[test]
fn constrained_directions_are_differentiated_too() {
    let mut scene = moved(&options(), [Cells::Quads, Cells::Quads], FLAT, 7);
    let in_plane = nalgebra::Rotation3::from_euler_angles(0.4, -0.9, 1.3) * Vec3::x();
    let directions: Vec<_> = (0..scene.x1.len()).step_by(2).map(|a| (a, in_plane)).collect();
    scene.interface.set_constraints(&directions).unwrap();
    let error = scene.difference_error(0.0);
    assert!(error <= DIFFERENCES, "off by {error:e}");
    for (a, d) in directions {
        assert!(scene.interface.normal(a).unwrap().dot(&d).abs() < ROUNDING);
        let r = scene.interface.responses(&scene.x1, &scene.x2, &scene.lambda, None).unwrap();
        assert!(r[a].traction.dot(&d).abs() < ROUNDING);
    }
}

#[test]
fn force_columns_sum_to_zero_and_translations_do_nothing() {
    for options in variants() {
        let mut scene = moved(&options, [Cells::Quads, Cells::Quads], FLAT, 7);
        let (n, k) = (scene.unknowns(), scene.tangent());
        let displacements = n - 3 * scene.x1.len();
        let scale = max_abs(k.iter().copied());
        for i in 0..3 {
            for j in 0..n {
                let sum: f64 = (i..displacements).step_by(3).map(|r| k[r * n + j]).sum();
                assert!(sum.abs() <= ROUNDING * scale, "column {j}: {sum:e}");
                let shift: f64 = (i..displacements).step_by(3).map(|c| k[j * n + c]).sum();
                assert!(shift.abs() <= ROUNDING * scale, "row {j}: {shift:e}");
            }
        }
    }
}

/// K5: symmetric when the weights are frozen and nothing slides; not symmetric with true weights, which
/// guards against dropping their derivative.
#[test]
fn symmetric_exactly_when_weights_are_frozen_and_nothing_slips() {
    let asymmetry = |weights: Weights| {
        let mut options = Options { form: Form::Augmented, weights, mu: 1e6, ..options() };
        options.row_scale = stickslip::interface::RowScale::None;
        let mut scene = moved(&options, [Cells::Quads, Cells::Quads], FLAT, 7);
        // All closed.
        let frame = nalgebra::Rotation3::from_euler_angles(0.4, -0.9, 1.3);
        scene.lambda.iter_mut().for_each(|l| *l = frame * Vec3::new(0.0, 0.0, -10.0));
        assert_eq!(scene.states(), [0, 9, 0]);
        let (n, k) = (scene.unknowns(), scene.tangent());
        let pairs = (0..n).flat_map(|i| (0..i).map(move |j| (i, j)));
        max_abs(pairs.map(|(i, j)| k[i * n + j] - k[j * n + i])) / max_abs(k.iter().copied())
    };
    assert!(asymmetry(Weights::Reference) <= 1e-14);
    assert!(asymmetry(Weights::Current) > 1e-3);
}
