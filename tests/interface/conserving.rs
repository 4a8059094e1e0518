//! Conserving weights (docs/formulation 21): forces work exactly what the gaps change by and have neither resultant nor moment, the
//! tangent is the derivative, nothing sinks from step to step, history, what is refused.

use crate::support::differences::Point;
use crate::support::lines::*;
use crate::support::max_abs;
use crate::support::mesh::*;
use crate::support::parents::*;
use nalgebra::SVector;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Friction, MultiplierBasis, NO_WEAK_COVERAGE, Options, Stiffness, Weights};
use stickslip::line::Measure;

/// Differences: truncation and rounding of a step of 1e-6, as for all lines.
const DIFFERENCES: f64 = 1e-7;
/// Sums of some dozen products, over the largest.
const ROUNDING: f64 = 1e-13;
/// How far surfaces are pushed into each other: beyond the gaps of the scenes, a part of a facet.
const PUSHED: f64 = 0.05;
const MEASURE: Measure = Measure::Thickness(0.45);
const BASES: [MultiplierBasis; 2] = [MultiplierBasis::Standard, MultiplierBasis::Dual];

fn options(friction: Friction, basis: MultiplierBasis) -> Options {
    let mu = if friction == Friction::None { 0.0 } else { 0.3 };
    let of = Options::paper(Stiffness::Modulus(30.0));
    Options { friction, mu, basis, weights: Weights::Conserving, weak_coverage: NO_WEAK_COVERAGE, ..of }
}

/// A step of an interface of either dimension.
struct Scene<const N: usize> {
    contact: Contact<N>,
    before: [Vec<Vec3>; 2],
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    lambda: Vec<SVector<f64, N>>,
    name: String,
}

impl<const N: usize> Scene<N> {
    fn of_lines(s: MovedLines<N>, name: String) -> Scene<N> {
        let before = [s.contact.history().x1.clone(), s.contact.history().x2.clone()];
        Scene { contact: s.contact, before, x1: s.x1, x2: s.x2, lambda: s.lambda, name }
    }

    /// nu_A . g_A and what is covered, with weights and normals of these places.
    fn gaps(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Vec<[f64; 2]> {
        let sums = self.contact.sums(x1, x2).unwrap();
        let of = |a: usize| [self.contact.normal(a).unwrap().dot(&sums[a].gap_now), sums[a].coverage];
        (0..sums.len()).map(of).collect()
    }
}

fn lines_of<const N: usize>(friction: Friction, nodes: [usize; 2]) -> Vec<Scene<N>>
where
    Contact<N>: Create<N>,
{
    let of = |basis| {
        let s = moved_lines::<N>(&options(friction, basis), nodes, MEASURE, 11);
        Scene::of_lines(s, format!("lines {nodes:?} {friction:?} {basis:?}"))
    };
    BASES.map(of).into_iter().collect()
}

fn facets_of<const N: usize>(friction: Friction) -> Vec<Scene<N>>
where
    Contact<N>: Create<N>,
{
    let mut scenes = Vec::new();
    for basis in BASES {
        for (name, rough, cells) in rough_scenes(0.0) {
            let m = moved(&options(friction, basis), cells, rough, 7);
            let meshes = [mesh_of(m.interface.surfaces().0), mesh_of(m.interface.surfaces().1)];
            let contact = contact::<N>(&meshes[0], &meshes[1], false, options(friction, basis));
            let lambda = m.lambda.iter().map(|l| SVector::from_fn(|i, _| if N == 1 { l.z } else { l[i] })).collect();
            let before = meshes.map(|mesh| mesh.x);
            let name = format!("{name} {friction:?} {basis:?}");
            scenes.push(Scene { contact, before, x1: m.x1, x2: m.x2, lambda, name });
        }
    }
    scenes
}

/// What the forces of a scene work, and their resultant and moment about the origin half way, against what the gaps say.
fn identities<const N: usize>(mut s: Scene<N>) {
    let [b1, b2] = s.before.clone();
    let (x1, x2) = (s.x1.clone(), s.x2.clone());
    let before = s.gaps(&b1, &b2);
    let now = s.gaps(&x1, &x2);
    let half = |from: &[Vec3], to: &[Vec3]| from.iter().zip(to).map(|(a, b)| (a + b) * 0.5).collect::<Vec<_>>();
    let mean = s.gaps(&half(&b1, &x1), &half(&b2, &x2));
    let r = s.contact.residual(&x1, &x2, &s.lambda, None).unwrap();
    let forces = r.nonmortar.iter().chain(&r.mortar);
    let (from, to) = (b1.iter().chain(&b2), x1.iter().chain(&x2));
    let work: Vec<f64> = forces.clone().zip(from.clone().zip(to.clone())).map(|(f, (a, b))| f.dot(&(b - a))).collect();
    let (sums, answers) = s.contact.evaluate(&x1, &x2, &s.lambda, None).unwrap();
    let terms: Vec<f64> = (0..now.len())
        .map(|a| {
            let nu = s.contact.normal(a).unwrap();
            let l = &s.lambda[a];
            if sums[a].coverage == 0.0 {
                return 0.0;
            }
            let change = mean[a][1] * (now[a][0] / now[a][1] - before[a][0] / before[a][1]);
            if N == 1 {
                return l[0] * change;
            }
            let l = Vec3::from_fn(|i, _| l[i]);
            let normal = nu.dot(&l);
            normal * change + (l - nu * normal).dot(&sums[a].gap_previous)
        })
        .collect();
    assert!(answers.len() == now.len());
    let largest = max_abs(terms.iter().copied());
    let error = (work.iter().sum::<f64>() - terms.iter().sum::<f64>()).abs();
    assert!(
        largest > 1e-4 && error <= ROUNDING * largest.max(max_abs(work.iter().copied())),
        "{}: {error:e} of {largest:e}",
        s.name
    );
    let resultant: Vec3 = forces.clone().sum();
    let size = forces.clone().map(Vec3::norm).sum::<f64>();
    assert!(resultant.norm() <= ROUNDING * size, "{}: {:e}", s.name, resultant.norm() / size);
    if N == 1 {
        let moment: Vec3 = forces.zip(from.zip(to)).map(|(f, (a, b))| ((a + b) * 0.5).cross(f)).sum();
        assert!(moment.norm() <= 10.0 * ROUNDING * size, "{}: {:e}", s.name, moment.norm() / size);
    }
}

fn parents_of<const N: usize>(friction: Friction) -> Vec<Scene<N>>
where
    Contact<N>: Create<N>,
{
    let rough = Roughness { warp: 0.02, jitter: 0.08, slide: 0.3 };
    let of = |basis| {
        let m = moved_parents::<N>(&options(friction, basis), [&[8], &[6]], rough, 0.1, false, 5);
        let before = m.meshes.map(|mesh| mesh.x);
        let name = format!("quadratic facets {friction:?} {basis:?}");
        Scene { contact: m.contact, before, x1: m.x1, x2: m.x2, lambda: m.lambda, name }
    };
    BASES.map(of).into_iter().collect()
}

#[test]
fn forces_work_what_the_gaps_change_by_and_have_neither_resultant_nor_moment() {
    for nodes in [[2, 2], [3, 2], [3, 3]] {
        lines_of::<1>(Friction::None, nodes).into_iter().for_each(identities);
        lines_of::<3>(Friction::Coulomb, nodes).into_iter().for_each(identities);
    }
    facets_of::<1>(Friction::None).into_iter().for_each(identities);
    facets_of::<3>(Friction::Coulomb).into_iter().for_each(identities);
    parents_of::<1>(Friction::None).into_iter().for_each(identities);
    parents_of::<3>(Friction::Coulomb).into_iter().for_each(identities);
}

#[test]
fn the_tangent_of_lines_is_the_derivative() {
    for (basis, nodes) in BASES.into_iter().flat_map(|basis| [[2, 2], [3, 2], [3, 3]].map(|nodes| (basis, nodes))) {
        let mut s = moved_lines::<1>(&options(Friction::None, basis), nodes, MEASURE, 11);
        let mut t = moved_lines::<3>(&options(Friction::Coulomb, basis), nodes, MEASURE, 11);
        let mut r = moved_lines::<3>(&options(Friction::Coulomb, basis), nodes, Measure::Axisymmetric, 11);
        let errors = [s.difference_error(), t.difference_error(), r.difference_error()];
        assert!(errors.iter().all(|error| *error <= DIFFERENCES), "{basis:?} {nodes:?}: {errors:?}");
    }
}

fn is_the_derivative<const N: usize>(mut s: Scene<N>) {
    let point = |s: &mut Scene<N>| {
        Point { contact: &mut s.contact, x1: &s.x1, x2: &s.x2, lambda: &s.lambda }.difference_error(0.0)
    };
    let error = point(&mut s);
    assert!(error <= DIFFERENCES, "{}: {error:e}", s.name);
    let plan = Point { contact: &mut s.contact, x1: &s.x1, x2: &s.x2, lambda: &s.lambda }.plan_error();
    assert!(plan <= ROUNDING, "{}: {plan:e}", s.name);
}

#[test]
fn the_tangent_of_facets_is_the_derivative() {
    facets_of::<1>(Friction::None).into_iter().for_each(is_the_derivative);
    facets_of::<3>(Friction::Coulomb).into_iter().for_each(is_the_derivative);
}

#[test]
fn the_tangent_of_quadratic_facets_is_the_derivative() {
    parents_of::<1>(Friction::None).into_iter().for_each(is_the_derivative);
    parents_of::<3>(Friction::Coulomb).into_iter().for_each(is_the_derivative);
}

/// A step closes gaps up to what the last one has left, however far surfaces slide: the same function of the same places.
#[test]
fn the_bound_is_where_the_last_step_has_ended() {
    for mut s in facets_of::<1>(Friction::None) {
        let (nu, x2) = (s.contact.normal(4).unwrap(), s.x2.clone());
        let x1: Vec<_> = s.x1.iter().map(|x| x - nu * PUSHED).collect();
        let reached = s.gaps(&x1, &x2);
        let reached: Vec<f64> = reached.iter().map(|gap| gap[0]).collect();
        assert!(reached.iter().any(|g| *g < 0.0), "{}: nothing overlaps", s.name);
        s.contact.commit(&x1, &x2, &s.lambda, None).unwrap();
        let none = vec![SVector::<f64, 1>::zeros(); s.lambda.len()];
        let answers = s.contact.responses(&x1, &x2, &none, None).unwrap();
        let size = max_abs(reached.iter().copied());
        for (a, answer) in answers.iter().enumerate() {
            assert!((answer.gap_normal - reached[a]).abs() <= ROUNDING * size, "{}: node {a}", s.name);
            assert!(answer.row[0].abs() <= ROUNDING * size || reached[a] > 0.0, "{}: node {a} presses", s.name);
        }
    }
}

#[test]
fn a_history_keeps_the_gaps() {
    let of = options(Friction::None, MultiplierBasis::Standard);
    let mut s = moved_lines::<1>(&of, [2, 2], MEASURE, 11);
    s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
    let mut fresh = moved_lines::<1>(&of, [2, 2], MEASURE, 11);
    let (integers, reals) = s.contact.export_history().unwrap();
    fresh.contact.import_history(&integers, &reals).unwrap();
    let mut z = s.unknowns();
    z.iter_mut().enumerate().for_each(|(k, z)| *z += 1e-3 * (k as f64).sin());
    assert_eq!(s.residual(&z), fresh.residual(&z));
    let mut other = moved_lines::<1>(&Options { weights: Weights::Current, ..of }, [2, 2], MEASURE, 11);
    let error = other.contact.import_history(&integers, &reals).unwrap_err();
    assert!(error.message.contains("discrete derivatives"), "{}", error.message);
    let before = s.residual(&z);
    let x1: Vec<_> = s.x1.iter().map(|x| x + Vec3::new(0.01, -0.01, 0.0)).collect();
    s.contact.commit(&x1, &s.x2, &s.lambda, None).unwrap();
    assert_ne!(s.residual(&z), before);
    s.contact.roll_back().unwrap();
    assert_eq!(s.residual(&z), before);
}
