//! The tangent against central differences of the library's own residual, every column (row K2 of the
//! hard tests, docs/formulation 9), and its exact properties (K4, K5).

use crate::support::differences::Point;
use crate::support::max_abs;
use crate::support::mesh::*;
use stickslip::geometry::Vec3;
use stickslip::interface::{Form, Options, Tangent, Weights};
use stickslip::law::{SlipMeasure, State};
use stickslip::quadrature::{DEGREE_1, DEGREE_2, DEGREE_4, DEGREE_5, DEGREE_6, DEGREE_10};

/// K2: relative to the largest entry of the block.
const DIFFERENCES: f64 = 1e-7;
/// Warped, jittered quads with the degree-10 rule (measured 7e-10): its own quadrature error.
const DIFFERENCES_WARPED_DEGREE_10: f64 = 1e-8;
/// The same with the default rule (measured 5e-7); Newton does not notice.
const DIFFERENCES_WARPED_DEGREE_5: f64 = 1e-5;
/// K4: sums over a column or a translation, relative to the largest entry.
const ROUNDING: f64 = 1e-13;

impl Moved {
    pub fn at(&mut self) -> Point<'_, 3> {
        Point { contact: &mut self.interface, x1: &self.x1, x2: &self.x2, lambda: &self.lambda }
    }

    pub fn states(&mut self) -> [usize; 3] {
        let mut count = [0; 3];
        for r in self.interface.responses(&self.x1, &self.x2, &self.lambda, None).unwrap() {
            count[r.state as usize] += 1;
        }
        count
    }
}

fn variants() -> Vec<Options> {
    let mut all = Vec::new();
    for form in [Form::Multiplier, Form::Augmented] {
        for weights in [Weights::Current, Weights::Committed, Weights::Reference] {
            for slip in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper] {
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
            let error = scene.at().difference_error(0.0);
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
            let error = moved(&options, [Cells::Quads, Cells::Quads], rough, seed).at().difference_error(1.0);
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
    let error = scene.at().difference_error(0.0);
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
        let (n, k) = (scene.at().unknowns(), scene.at().tangent());
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
        let (n, k) = (scene.at().unknowns(), scene.at().tangent());
        let pairs = (0..n).flat_map(|i| (0..i).map(move |j| (i, j)));
        max_abs(pairs.map(|(i, j)| k[i * n + j] - k[j * n + i])) / max_abs(k.iter().copied())
    };
    assert!(asymmetry(Weights::Reference) <= 1e-14);
    assert!(asymmetry(Weights::Current) > 1e-3);
}

/// Frozen weights: what is left is the tangent at constant weights. Frozen normals: exact where nothing lies off the
/// plane, not elsewhere.
#[test]
fn frozen_tangents_leave_out_what_they_say() {
    let rough = Roughness { warp: 0.05, jitter: 0.08, slide: 0.02 };
    for rough in [FLAT, rough] {
        let errors = [Tangent::Exact, Tangent::FrozenNormals, Tangent::FrozenWeights].map(|tangent| {
            let options = Options { tangent, rule: &DEGREE_10, ..options() };
            moved(&options, [Cells::Quads, Cells::Quads], rough, 7).at().difference_error(1.0)
        });
        assert!(errors[0] < DIFFERENCES_WARPED_DEGREE_10, "{errors:?}");
        // Gaps of a hundredth of a facet; multipliers over a facet's length.
        assert!(errors[1] > 1e-3 && errors[2] > 1e-2, "{errors:?}");
    }
    let mut plane = moved(&Options { tangent: Tangent::FrozenNormals, ..options() }, [Cells::Quads; 2], FLAT, 7);
    (plane.x1, plane.x2) = (plane.interface.history().x1.clone(), plane.interface.history().x2.clone());
    let error = plane.at().difference_error(1.0);
    assert!(error <= DIFFERENCES, "coplanar: off by {error:e}");
}

/// Rules below degree 5 have the tangent of exact weights. A parallelogram ceases to be one when a node moves, which a
/// coarser sum sees in its own way: far from its derivative, but no nonsense.
#[test]
fn coarse_rules_have_the_tangent_of_exact_weights() {
    let error_of = |rule| {
        let mut scene = moved(&Options { rule, ..options() }, [Cells::Quads, Cells::Quads], FLAT, 7);
        scene.at().difference_error(1.0)
    };
    assert!(error_of(&DEGREE_6) <= DIFFERENCES);
    for (rule, range) in [(&DEGREE_1, 1e-3..1.0), (&DEGREE_2, 1e-3..1.0), (&DEGREE_4, 1e-7..1e-2)] {
        let error = error_of(rule);
        assert!(range.contains(&error), "degree {}: {error:e}", rule.degree);
    }
}
