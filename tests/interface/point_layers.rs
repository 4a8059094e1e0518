//! A layer that yields under pressure where points decide (docs/formulation 16.12): patches, the tangent against differences, what is
//! refused.

use crate::support::differences::Point;
use crate::support::max_abs;
use crate::support::mesh::*;
use crate::support::parents::{Kind, contact_of, has_row, moved_parents};
use nalgebra::SVector;
use stickslip::error::Kind as ErrorKind;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Decision, Friction, MultiplierBasis, Options, Stiffness, Weights};
use stickslip::law::{Layer, Overclosure, Squeeze};
use stickslip::mortar::MultiplierSpace;
use stickslip::quadrature::DEGREE_10;

const MODULUS: f64 = 30.0;
/// Differences: truncation 1e-12 and rounding 1e-10 of a step of 1e-6.
const DIFFERENCES: f64 = 1e-7;
/// The same along a direction with friction: see `point_parts.rs`.
const DIFFERENCES_OF_CONES: f64 = 1e-6;
const STEPS: [f64; 4] = [1e-6, 2e-7, 4e-8, 8e-9];
/// Sums of some hundred products, over the largest.
const ROUNDING: f64 = 1e-12;
const KINDS: [[&[Kind]; 2]; 4] = [[&[4]; 2], [&[3]; 2], [&[8]; 2], [&[6], &[4]]];
const PRESSURE: f64 = 0.7;
/// The overclosure that is pressed by it: in the middle of a piece.
const DEPTH: f64 = 0.04;

fn layer() -> Layer {
    let table =
        [(-0.02, 0.0), (0.02, 0.3), (0.06, 1.1)].map(|(overclosure, pressure)| Squeeze { overclosure, pressure });
    Layer { overclosure: Some(Overclosure::new(&table).unwrap()), ..Layer::default() }
}

fn by_points(kinds: [&[Kind]; 2], weights: Weights, mu: f64) -> Options {
    let of = Options::paper(Stiffness::Modulus(MODULUS));
    let (basis, decision) = (MultiplierBasis::Dual, Decision::Points(MODULUS));
    let friction = if mu > 0.0 { Friction::Coulomb } else { Friction::None };
    let space = if kinds[0][0] > 4 { MultiplierSpace::Sub } else { MultiplierSpace::Corner };
    // The derivatives of a rule's sums have the rule's error on quadrilaterals that are no parallelograms.
    let rule = if weights == Weights::Current { &DEGREE_10 } else { of.rule };
    Options { basis, decision, weights, space, friction, mu, rule, ..of }
}

/// Weights that go with these facets and this friction.
fn all(mu: f64) -> Vec<(Options, [&'static [Kind]; 2])> {
    let is_linear = |kinds: &[&[Kind]; 2]| kinds.iter().all(|kinds| kinds[0] < 5);
    let weights = [Weights::Reference, Weights::Committed, Weights::Current];
    let each = KINDS.into_iter().flat_map(|kinds| weights.map(|weights| (kinds, weights)));
    each.filter(|(kinds, weights)| *weights != Weights::Current || (is_linear(kinds) && mu == 0.0))
        .map(|(kinds, weights)| (by_points(kinds, weights, mu), kinds))
        .collect()
}

/// Surfaces that overlap by the depth of a pressure are in equilibrium with it: rows vanish, and forces are those without a layer and overlap.
#[test]
fn surfaces_overlap_by_the_depth_of_their_pressure() {
    for (options, kinds) in all(0.0) {
        let flat = Roughness { warp: 0.0, jitter: 0.1, slide: 0.0 };
        let m = moved_parents::<1>(&options, kinds, flat, 0.0, false, 4);
        let [one, two] = &m.meshes;
        let has = has_row(one, options.space);
        let lambda: Vec<_> = has.iter().map(|has| SVector::from([if *has { -PRESSURE } else { 0.0 }])).collect();
        let mut contact = contact_of::<1>(one, two, false, options);
        let expected = contact.residual(&one.x, &two.x, &lambda, None).unwrap();
        contact.set_layer(Some(layer())).unwrap();
        let inwards = contact.normal(0).unwrap();
        let x1: Vec<Vec3> = one.x.iter().map(|x| x - inwards * DEPTH).collect();
        let found = contact.residual(&x1, &two.x, &lambda, None).unwrap();
        let largest = max_abs(expected.nonmortar.iter().map(|f| f.amax()));
        let forces = found.nonmortar.iter().zip(&expected.nonmortar).chain(found.mortar.iter().zip(&expected.mortar));
        let error = max_abs(forces.map(|(f, e)| (f - e).amax()));
        let rows = max_abs(found.rows.iter().map(|row| row[0]));
        assert!(
            largest > 0.01 && error.max(rows) <= ROUNDING * largest,
            "{kinds:?}: {error:e} {rows:e} of {largest:e}"
        );
    }
}

fn tangents<const N: usize>(mu: f64, set: impl Fn(&mut Contact<N>))
where
    Contact<N>: Create<N>,
{
    for (options, kinds) in all(mu) {
        let rough = Roughness { warp: 0.02, jitter: 0.05, slide: 0.1 };
        let mut s = moved_parents::<N>(&options, kinds, rough, 0.0, false, 3);
        set(&mut s.contact);
        let (has, mut random) = (has_row(&s.meshes[0], options.space), Random(5));
        for (lambda, _) in s.lambda.iter_mut().zip(has).filter(|(_, has)| N == 1 && *has) {
            lambda[0] = 0.6 * random.next() - 0.3;
        }
        for step in 0..2 {
            let mut at = Point { contact: &mut s.contact, x1: &s.x1, x2: &s.x2, lambda: &s.lambda };
            let direction: Vec<f64> = (0..at.unknowns()).map(|_| random.next()).collect();
            let error = if N == 1 { at.difference_error(0.0) } else { at.error_along(&direction, &STEPS) };
            let bound = if N == 1 { DIFFERENCES } else { DIFFERENCES_OF_CONES };
            assert!(error <= bound, "{kinds:?} {:?} {step}: {error:e}", options.weights);
            s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
            // Where a step begins points that slipped are on the cone, which is a kink.
            s.x1.iter_mut().for_each(|x| *x += random.vector(1e-3));
        }
    }
}

#[test]
fn tangents_are_those_of_differences() {
    tangents::<1>(0.0, |contact| contact.set_layer(Some(layer())).unwrap());
    tangents::<3>(0.3, |contact| contact.set_layer(Some(layer())).unwrap());
}

#[test]
fn wear_is_refused_by_name() {
    let m = moved_parents::<3>(&by_points(KINDS[0], Weights::Committed, 0.3), KINDS[0], FLAT, 0.0, false, 4);
    let mut contact = m.contact;
    let error = contact.set_layer(Some(Layer { wear: Some(0.1), ..layer() })).unwrap_err();
    assert!(error.kind == ErrorKind::Unsupported && error.message.contains("wear"), "{error}");
    contact.set_layer(Some(layer())).unwrap();
}
