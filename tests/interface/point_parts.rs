//! Points that decide over facets with nodes that are no corners (docs/formulation 16.11): the tangent against differences, sums over
//! points by brute force, patches, momentum, history, heat, what is refused.

use crate::support::differences::Point;
use crate::support::lines::*;
use crate::support::max_abs;
use crate::support::mesh::*;
use crate::support::parents::{Kind, MovedParents, contact_of, grid_of, has_row, moved_parents};
use nalgebra::SVector;
use stickslip::error::Kind as ErrorKind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Decision, Friction, MultiplierBasis, NO_EQUATION, Options, Residual, Stiffness, Temperatures, Weights,
};
use stickslip::law::{Conductance, State};
use stickslip::line::Measure;
use stickslip::mortar::MultiplierSpace;
use stickslip::quadrature::line::GAUSS_3;

const MODULUS: f64 = 30.0;
/// Differences: truncation 1e-12 and rounding 1e-10 of a step of 1e-6.
const DIFFERENCES: f64 = 1e-7;
/// The same with friction: where a point hardly slips its traction turns by as much as the step is of its slip.
const DIFFERENCES_OF_CONES: f64 = 1e-6;
/// Of some thousand points one may pass from stick to slip within a step, but hardly within all of these.
const STEPS: [f64; 4] = [1e-6, 2e-7, 4e-8, 8e-9];
/// Sums of some hundred products, over the largest.
const ROUNDING: f64 = 1e-12;
const KINDS: [[&[Kind]; 2]; 7] =
    [[&[6]; 2], [&[8]; 2], [&[9]; 2], [&[8, 6], &[9, 4]], [&[9], &[3]], [&[4], &[8]], [&[3, 9], &[6]]];
const SPACES: [MultiplierSpace; 2] = [MultiplierSpace::Corner, MultiplierSpace::Sub];
const WEIGHTS: [Weights; 2] = [Weights::Committed, Weights::Reference];
const ROUGH: Roughness = Roughness { warp: 0.02, jitter: 0.05, slide: 0.1 };

fn by_points(space: MultiplierSpace, weights: Weights, mu: f64) -> Options {
    let of = Options::paper(Stiffness::Modulus(MODULUS));
    let (basis, decision) = (MultiplierBasis::Dual, Decision::Points(MODULUS));
    let friction = if mu > 0.0 { Friction::Coulomb } else { Friction::None };
    Options { basis, decision, weights, space, friction, mu, ..of }
}

/// Every kind of facet in every space, with both weights.
fn all(mu: f64) -> impl Iterator<Item = (Options, [&'static [Kind]; 2])> {
    let options = SPACES.into_iter().flat_map(move |space| WEIGHTS.map(|weights| by_points(space, weights, mu)));
    options.flat_map(|options| KINDS.map(|kinds| (options, kinds)))
}

/// An interface of these kinds, moved; with one multiplier a node, pressed as a whole, or open here and there.
fn scene<const N: usize>(
    options: &Options,
    kinds: [&[Kind]; 2],
    rough: Roughness,
    bend: f64,
    pressed: bool,
) -> MovedParents<N>
where
    Contact<N>: Create<N>,
{
    let mut s = moved_parents::<N>(options, kinds, rough, bend, false, 3);
    let (has, mut random) = (has_row(&s.meshes[0], options.space), Random(5));
    for (lambda, _) in s.lambda.iter_mut().zip(has).filter(|(_, has)| N == 1 && *has) {
        lambda[0] = 0.5 * random.next() - if pressed { 5.0 } else { 0.1 };
    }
    if N == 3 && pressed {
        for (a, lambda) in s.lambda.iter_mut().enumerate() {
            let normal = s.contact.normal(a).unwrap();
            *lambda -= SVector::from_fn(|i, _| 5.0 * normal[i]);
        }
    }
    s
}

/// How many nodes with a multiplier are open, cut and closed.
fn count<const N: usize>(contact: &mut Contact<N>, has: &[bool], seen: &mut [usize; 3]) {
    for (a, _) in has.iter().enumerate().filter(|(_, has)| **has) {
        let share = contact.closed_share(a);
        assert!((-ROUNDING..1.0 + ROUNDING).contains(&share), "{share}");
        seen[if share == 0.0 { 0 } else { 1 + usize::from(share > 1.0 - ROUNDING) }] += 1;
    }
}

fn tangents<const N: usize>(mu: f64)
where
    Contact<N>: Create<N>,
{
    let mut seen = [0; 3];
    for (options, kinds) in all(mu) {
        for (pressed, step) in [(false, 0), (false, 1), (true, 0), (true, 1)] {
            let mut s = scene::<N>(&options, kinds, ROUGH, 0.1, pressed);
            if step == 1 {
                s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
                // Where a step begins points that slipped are on the cone, which is a kink.
                let mut random = Random(7);
                s.x1.iter_mut().for_each(|x| *x += random.vector(1e-3));
            }
            s.contact.responses(&s.x1, &s.x2, &s.lambda, None).unwrap();
            count(&mut s.contact, &has_row(&s.meshes[0], options.space), &mut seen);
            let mut at = Point { contact: &mut s.contact, x1: &s.x1, x2: &s.x2, lambda: &s.lambda };
            let mut random = Random(11);
            let direction: Vec<f64> = (0..at.unknowns()).map(|_| random.next()).collect();
            let error = if N == 1 { at.difference_error(0.0) } else { at.error_along(&direction, &STEPS) };
            let bound = if N == 1 { DIFFERENCES } else { DIFFERENCES_OF_CONES };
            assert!(error <= bound, "{kinds:?} {:?} {:?}, {step}: {error:e}", options.space, options.weights);
        }
    }
    assert!(seen.iter().all(|n| *n > 20), "open, cut, closed: {seen:?}");
}

#[test]
fn tangents_are_those_of_differences() {
    tangents::<1>(0.0);
}

#[test]
fn tangents_with_friction_are_those_of_differences() {
    tangents::<3>(0.3);
}

#[test]
fn tangents_of_lines_are_those_of_differences() {
    for (space, weights) in SPACES.into_iter().flat_map(|space| WEIGHTS.map(|weights| (space, weights))) {
        for (measure, nodes) in [Measure::Thickness(0.7), Measure::Axisymmetric]
            .into_iter()
            .flat_map(|m| [(m, [3, 3]), (m, [3, 2]), (m, [2, 3])])
        {
            for seed in [1, 2] {
                let smooth = moved_lines::<1>(&by_points(space, weights, 0.0), nodes, measure, seed).difference_error();
                let rough = moved_lines::<3>(&by_points(space, weights, 0.3), nodes, measure, seed).difference_error();
                assert!(
                    smooth <= DIFFERENCES && rough <= DIFFERENCES,
                    "{space:?} {weights:?} {nodes:?}: {smooth:e} {rough:e}"
                );
            }
        }
    }
}

/// Forces of a residual.
fn forces<const N: usize>(r: &Residual<N>) -> impl Iterator<Item = &Vec3> {
    r.nonmortar.iter().chain(&r.mortar)
}

/// A flat interface, all closed: with constant multipliers the rows vanish, and nodal forces are those of nodes that decide. Those of
/// the space of all nodes are standard: the sum of the functions is 1 with either basis.
#[test]
fn closed_facets_are_those_of_nodes_and_pass_the_patch_test() {
    for (options, kinds) in all(0.0) {
        let flat = Roughness { warp: 0.0, jitter: 0.1, slide: 0.0 };
        let m = moved_parents::<1>(&options, kinds, flat, 0.0, false, 4);
        let [one, two] = &m.meshes;
        let basis =
            if options.space == MultiplierSpace::Sub { MultiplierBasis::Standard } else { MultiplierBasis::Dual };
        let of_nodes = Options { decision: Decision::Nodes, basis, ..options };
        let has = has_row(one, options.space);
        let lambda: Vec<_> = has.iter().map(|has| SVector::from([if *has { -0.7 } else { 0.0 }])).collect();
        let residual =
            |options| contact_of::<1>(one, two, false, options).residual(&one.x, &two.x, &lambda, None).unwrap();
        let (p, n) = (residual(options), residual(of_nodes));
        let largest = max_abs(forces(&n).map(|f| f.amax()));
        let error = max_abs(forces(&p).zip(forces(&n)).map(|(p, n)| (p - n).amax()));
        assert!(
            largest > 0.01 && error <= ROUNDING * largest,
            "{kinds:?} {:?}: {error:e} of {largest:e}",
            options.space
        );
        let rows = max_abs(p.rows.iter().map(|row| row[0]));
        assert!(rows <= ROUNDING * largest, "{kinds:?} {:?}: {rows:e}", options.space);
    }
}

/// Force is balanced at any shape; moment where facets are flat, at the positions that the weights are of.
#[test]
fn force_and_moment_are_balanced() {
    for (options, kinds) in all(0.0).filter(|(options, _)| options.weights == Weights::Committed) {
        for bend in [0.0, 0.1] {
            let rough = if bend > 0.0 { ROUGH } else { Roughness { warp: 0.0, jitter: 0.0, slide: 0.1 } };
            let mut s = scene::<1>(&options, kinds, rough, bend, true);
            s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
            let r = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
            let at = || forces(&r).zip(s.x1.iter().chain(&s.x2));
            let largest = max_abs(forces(&r).map(|f| f.amax()));
            let (force, moment) = at().fold((Vec3::zeros(), Vec3::zeros()), |(f, m), (g, x)| (f + g, m + x.cross(g)));
            assert!(largest > 1e-3 && force.amax() <= ROUNDING * largest, "{kinds:?}: {force} of {largest:e}");
            assert!(bend > 0.0 || moment.amax() <= ROUNDING * largest, "{kinds:?}: {moment} of {largest:e}");
        }
    }
}

/// Of two squares on each other: tractions by a rule that is exact against those of the interface's points. The border lies along the parts'
/// edges, and sigma is linear.
#[test]
fn integrals_are_those_over_points_with_negative_sigma() {
    for (space, kind) in SPACES.into_iter().flat_map(|space| [(space, 9), (space, 4)]) {
        let one = grid_of(1, 1, [0.0, 0.0], [1.0, 1.0], false, &[9]);
        let two = grid_of(2, 1, [0.0, 0.0], [1.0, 1.0], true, &[kind]);
        let has = has_row(&one, space);
        // sigma = lambda: no gap.
        let lambda: Vec<_> =
            one.x.iter().zip(&has).map(|(x, has)| SVector::from([if *has { x.x - 0.5 } else { 0.0 }])).collect();
        let mut contact = contact_of::<1>(&one, &two, false, by_points(space, Weights::Reference, 0.0));
        let r = contact.residual(&one.x, &two.x, &lambda, None).unwrap();
        let n = |x: f64, at: f64| match at {
            0.0 => (1.0 - x) * (1.0 - 2.0 * x),
            1.0 => x * (2.0 * x - 1.0),
            _ => 4.0 * x * (1.0 - x),
        };
        for (x, f) in one.x.iter().zip(&r.nonmortar) {
            let along: f64 = GAUSS_3.iter().map(|[s, w]| 0.5 * w * n(0.5 * s, x.x) * (0.5 * s - 0.5)).sum();
            let across: f64 = GAUSS_3.iter().map(|[s, w]| w * n(*s, x.y)).sum();
            assert!((f.z - along * across).abs() <= ROUNDING, "{space:?} {x}: {f} {}", along * across);
        }
    }
}

/// Evaluations, commits, rollbacks and imports have the same bits.
fn history<const N: usize>(mu: f64)
where
    Contact<N>: Create<N>,
{
    for (options, kinds) in all(mu) {
        let create = || scene::<N>(&options, kinds, ROUGH, 0.1, false);
        let mut s = create();
        let residual = |c: &mut Contact<N>| c.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let first = residual(&mut s.contact);
        s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let second = residual(&mut s.contact);
        let (integers, reals) = s.contact.export_history().unwrap();
        let mut other = create().contact;
        other.import_history(&integers, &reals).unwrap();
        assert!(second == residual(&mut other));
        s.contact.roll_back().unwrap();
        assert!(first == residual(&mut s.contact));
    }
}

#[test]
fn histories_go_on_with_the_same_bits() {
    history::<1>(0.0);
    history::<3>(0.3);
}

/// With friction steps of rest change nothing: points remember their tractions.
#[test]
fn rest_changes_nothing() {
    for (options, kinds) in all(0.3) {
        let mut s = scene::<3>(&options, kinds, FLAT, 0.0, false);
        let residual = |c: &mut Contact<3>| c.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let before = residual(&mut s.contact);
        for _ in 0..10 {
            s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
        }
        let after = residual(&mut s.contact);
        let largest = max_abs(forces(&before).map(|f| f.amax()));
        let change = max_abs(forces(&before).zip(forces(&after)).map(|(b, a)| (b - a).amax()));
        assert!(change <= ROUNDING * largest, "{kinds:?} {:?}: {change:e} of {largest:e}", options.space);
    }
}

/// Heat passes by the pressure of points: where all of it is the same, so is the flux, over meshes that do not match; what leaves one
/// body enters the other one.
#[test]
fn heat_passes_by_the_pressure_of_points() {
    let conductance = Conductance {
        contact: 3.0,
        pressure: 0.7,
        exponent: 0.95,
        constant: 0.0,
        gas: 0.0,
        gas_gap: 0.0,
        reach: 0.0,
        share: 0.5,
        time: 0.0,
    };
    for kinds in KINDS.into_iter().chain([[&[4_usize] as &[Kind]; 2], [&[3_usize] as &[Kind]; 2]]) {
        let options = by_points(MultiplierSpace::Corner, Weights::Reference, 0.0);
        let flat = Roughness { warp: 0.0, jitter: 0.1, slide: 0.0 };
        let m = moved_parents::<1>(&options, kinds, flat, 0.0, false, 4);
        let [one, two] = &m.meshes;
        let has = has_row(one, options.space);
        let lambda: Vec<_> = has.iter().map(|has| SVector::from([if *has { -0.7 } else { 0.0 }])).collect();
        let mut contact = contact_of::<1>(one, two, false, options);
        let (hot, cold) = (vec![5.0; one.x.len()], vec![3.0; two.x.len()]);
        let heat = contact
            .heat([&one.x, &two.x], &lambda, Temperatures { sides: [&hot, &cold], conductance: &conductance })
            .unwrap();
        let responses = contact.responses(&one.x, &two.x, &lambda, None).unwrap();
        for (a, (node, flow)) in
            heat.nodes.iter().enumerate().filter(|(a, _)| responses[*a].state != State::Gap && has[*a])
        {
            assert!(
                (node.pressure - 0.7).abs() <= ROUNDING && (flow.sides[0] - 6.0).abs() <= 1e2 * ROUNDING,
                "{a}: {node:?} {flow:?}"
            );
        }
        let [out, into] = heat.sides.map(|side| side.iter().sum::<f64>());
        assert!(out > 1.0 && (out + into).abs() <= ROUNDING * out, "{out} {into}");
    }
}

#[test]
fn what_parts_do_not_go_with_is_refused_by_name() {
    let of = Options { weights: Weights::Current, ..by_points(MultiplierSpace::Corner, Weights::Current, 0.0) };
    let one = grid_of(1, 1, [0.0, 0.0], [1.0, 1.0], false, &[8]);
    let surfaces = || {
        let two = grid_of(1, 1, [0.0, 0.0], [1.0, 1.0], true, &[4]);
        let surface = |side, mesh: &Mesh, first| {
            stickslip::interface::Surface::new(side, mesh.x.clone(), &mesh.facets, numbered(first, mesh.x.len()))
                .unwrap()
        };
        (surface("nonmortar", &one, 0), surface("mortar", &two, 24))
    };
    let create = |options: Options| {
        let (nonmortar, mortar) = surfaces();
        let mut multipliers = numbered::<1>(36, one.x.len());
        multipliers[4..].fill([NO_EQUATION]);
        Contact::<1>::frictionless(nonmortar, mortar, multipliers, options)
    };
    let error = create(of).unwrap_err();
    assert!(error.kind == ErrorKind::Unsupported && error.message.contains("mid nodes"), "{error}");
    // Where the library chooses, it chooses what goes.
    let chosen = create(Options { weights_yield: true, normals_yield: true, ..of });
    assert!(chosen.is_ok(), "{:?}", chosen.err());
}
