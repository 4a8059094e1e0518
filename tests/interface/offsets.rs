//! Offsets of the nodes (docs/formulation 15): the tangent against differences, against meshes that are moved, slip, search.

use super::weak;
use crate::support::differences::Point;
use crate::support::lines::moved_lines;
use crate::support::mesh::*;
use crate::support::parents::moved_parents;
use nalgebra::SVector;
use stickslip::error::Kind;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{
    Contact, Form, Friction, Interface, MultiplierBasis, NO_WEAK_COVERAGE, Normals, Options, Scheme, Surface, Tangent,
    Weights,
};
use stickslip::law::{SlipMeasure, State};
use stickslip::line::Measure;
use stickslip::mortar::MultiplierSpace;
use stickslip::quadrature::DEGREE_10;

/// The tangent against differences, relative to the largest entry of a block.
const DIFFERENCES: f64 = 1e-7;
/// Two ways through other sums, over the largest entry.
const SAME: f64 = 1e-12;
/// Offsets of the size of the gaps of `mesh::moved`.
const SIZE: f64 = 0.02;
/// Nodes that are covered less than this part of their best neighbour are carried.
const CARRIED: f64 = 0.3;

/// Different offsets at the nodes of both sides.
fn give<const N: usize>(contact: &mut Contact<N>, size: f64) {
    let (one, two) = (contact.surfaces().0.reference.len(), contact.surfaces().1.reference.len());
    let mut random = Random(77);
    let mut some = |n: usize| Some((0..n).map(|_| size * random.next()).collect());
    contact.set_offsets([some(one), some(two)]).unwrap();
}

fn check<const N: usize>(contact: &mut Contact<N>, x: (&[Vec3], &[Vec3]), lambda: &[SVector<f64, N>], what: &str) {
    give(contact, SIZE);
    let error = Point { contact, x1: x.0, x2: x.1, lambda }.difference_error(0.0);
    assert!(error <= DIFFERENCES, "{what}: {error:e}");
}

const BASES: [MultiplierBasis; 2] = [MultiplierBasis::Standard, MultiplierBasis::Dual];
const FORMS: [Form; 2] = [Form::Multiplier, Form::Augmented];

#[test]
fn tangents_equal_differences() {
    let mut seen = [0; 3];
    each_moved(FORMS.into_iter().flat_map(|form| BASES.map(|basis| (form, basis))), options(), |t, what| {
        check(&mut t.interface, (&t.x1, &t.x2), &t.lambda, what);
        seen.iter_mut().zip(t.states()).for_each(|(all, here)| *all += here);
    });
    assert!(seen.iter().all(|n| *n > 50), "{seen:?}");
}

#[test]
fn tangents_with_one_multiplier_carried_nodes_and_points_equal_differences() {
    for (form, basis) in FORMS.into_iter().flat_map(|form| BASES.map(|basis| (form, basis))) {
        for cells in [Cells::Quads, Cells::Triangles] {
            for normals in [Normals::Committed, Normals::Current] {
                let of =
                    Options { form, basis, normals, weak_coverage: weak::WEAK, mu: 0.0, rule: &DEGREE_10, ..options() };
                let mut s = weak::scene::<1>(&Options { friction: Friction::None, ..of }, cells);
                check(
                    &mut s.contact,
                    (&s.x1, &s.x2),
                    &s.lambda,
                    &format!("{form:?} {basis:?} {} {normals:?}", cells == Cells::Quads),
                );
                assert!(s.contact.counters().nodes.carried > 0);
                if normals == Normals::Committed {
                    let mut s = weak::scene::<3>(&Options { mu: 0.7, ..of }, cells);
                    check(
                        &mut s.contact,
                        (&s.x1, &s.x2),
                        &s.lambda,
                        &format!("three, {form:?} {basis:?} {}", cells == Cells::Quads),
                    );
                }
            }
        }
        for scheme in [2, 5].map(|n| Scheme::Elements(stickslip::quadrature::cell::line_of(n).unwrap())) {
            let of = Options { form, basis, scheme, weak_coverage: NO_WEAK_COVERAGE, ..options() };
            let wide = |mut t: Moved| {
                check(&mut t.interface, (&t.x1, &t.x2), &t.lambda, &format!("{scheme:?}, {form:?} {basis:?}"));
            };
            wide(moved(&of, [Cells::Quads, Cells::Quads], FLAT, 3));
        }
    }
}

#[test]
fn tangents_with_normals_of_now_equal_differences() {
    for (what, rough, cells) in rough_scenes(0.12) {
        let rule = if cells[1] == Cells::Quads { &DEGREE_10 } else { &stickslip::quadrature::DEGREE_5 };
        for (form, basis) in FORMS.into_iter().flat_map(|form| BASES.map(|basis| (form, basis))) {
            for friction in [Friction::Coulomb, Friction::Rough, Friction::Tresca] {
                for slip in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper] {
                    let weak_coverage = if slip == SlipMeasure::Objective { CARRIED } else { NO_WEAK_COVERAGE };
                    let of = Options { form, basis, slip, rule, weak_coverage, ..options() };
                    let of = Options { normals: Normals::Current, ..under(friction, 0.7, of) };
                    let mut t = moved(&of, cells, rough, 3);
                    let what = format!("{what} {form:?} {basis:?} {friction:?} {slip:?}");
                    check(&mut t.interface, (&t.x1, &t.x2), &t.lambda, &what);
                }
            }
        }
    }
}

/// Of a mortar side at rest there are no columns: those of x1 and lambda.
#[test]
fn tangents_over_a_mortar_side_at_rest_are_those_over_one_that_moves() {
    let [one, two] = [
        grid(3, 2, [0.0, 0.0], [1.0, 1.0], -0.01, false, Cells::Triangles),
        grid(2, 3, [-0.3, -0.2], [1.2, 1.3], 0.0, true, Cells::Triangles),
    ];
    for basis in BASES {
        let of = Options { basis, weak_coverage: NO_WEAK_COVERAGE, ..options() };
        let mut random = Random(5);
        let x1: Vec<_> = one.x.iter().map(|x| x + random.vector(0.01)).collect();
        let lambda: Vec<_> = x1.iter().map(|_| Vec3::new(0.1, 0.2, -1.0) + random.vector(0.1)).collect();
        let columns = |prescribed: bool| {
            let mut c: Contact<3> = contact(&one, &two, prescribed, of);
            give(&mut c, SIZE);
            let n = 3 * (2 * one.x.len() + two.x.len());
            let mut k = vec![0.0; n * n];
            c.tangent(&x1, &two.x, &lambda, None, &mut |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v)
                .unwrap();
            let (a, b) = (3 * one.x.len(), n - 3 * one.x.len());
            let rows = (0..a).chain(b..n);
            rows.flat_map(|i| (0..a).chain(b..n).map(move |j| (i, j))).map(|(i, j)| k[i * n + j]).collect::<Vec<_>>()
        };
        let (moves, rests) = (columns(false), columns(true));
        let largest = moves.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let error = moves.iter().zip(&rests).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(error <= SAME * largest, "{basis:?}: {error:e}");
    }
}

#[test]
fn tangents_of_quadratic_facets_and_of_lines_equal_differences() {
    let spaces = [MultiplierSpace::Corner, MultiplierSpace::Sub].map(|space| (space, MultiplierBasis::Standard));
    for (space, basis) in spaces.into_iter().chain([(MultiplierSpace::Corner, MultiplierBasis::Dual)]) {
        for friction in [Friction::Coulomb, Friction::Tied] {
            let weak_coverage = if basis == MultiplierBasis::Dual { 0.4 } else { NO_WEAK_COVERAGE };
            let of = under(friction, 0.7, Options { space, basis, rule: &DEGREE_10, weak_coverage, ..options() });
            for kinds in [[&[6][..], &[6][..]], [&[8], &[9]], [&[9], &[4]], [&[3], &[8]]] {
                let mut s = moved_parents::<3>(&of, kinds, FLAT, 0.0, false, 3);
                check::<3>(
                    &mut s.contact,
                    (&s.x1, &s.x2),
                    &s.lambda,
                    &format!("{kinds:?} {space:?} {basis:?} {friction:?}"),
                );
            }
            for (nodes, measure) in [[2, 2], [3, 2], [2, 3], [3, 3]]
                .into_iter()
                .flat_map(|n| [Measure::Thickness(0.7), Measure::Axisymmetric].map(|m| (n, m)))
            {
                let mut s = moved_lines::<3>(&of, nodes, measure, 5);
                give::<3>(&mut s.contact, SIZE);
                let error = s.difference_error();
                assert!(error <= DIFFERENCES, "{nodes:?} {measure:?} {space:?} {basis:?}: {error:e}");
            }
        }
    }
}

/// Flat parallel surfaces, one offset: the answers are those of a body that is moved by it, in all that is asked for.
#[test]
fn a_uniform_offset_is_a_motion_along_the_normal() {
    for (basis, friction) in
        BASES.into_iter().flat_map(|basis| [Friction::Coulomb, Friction::None].map(|law| (basis, law)))
    {
        let of = under(friction, 0.3, Options { basis, ..options() });
        for (h1, h2) in [(0.03, 0.0), (-0.02, 0.0), (0.0, -0.01), (0.05, -0.02)] {
            let one = grid(3, 2, [0.0, 0.0], [1.0, 1.0], -0.01, false, Cells::Quads);
            let two = grid(2, 3, [-0.5, -0.2], [1.5, 1.3], 0.0, true, Cells::Triangles);
            let raised: Vec<_> = one.x.iter().map(|x| x + Vec3::z() * (h1 + h2)).collect();
            let lambda: Vec<_> = one.x.iter().map(|x| Vec3::new(0.01, 0.02, -0.1 * x.x)).collect();
            let mut offset = interface(&one, &two, of);
            offset.set_offsets([Some(vec![h1; one.x.len()]), Some(vec![h2; two.x.len()])]).unwrap();
            let mut moved = interface(&one, &two, of);
            let (a, b) = (
                offset.responses(&one.x, &two.x, &lambda, None).unwrap().to_vec(),
                moved.responses(&raised, &two.x, &lambda, None).unwrap().to_vec(),
            );
            for (a, b) in a.iter().zip(&b) {
                assert_eq!(a.state, b.state);
                assert!((a.gap_normal - b.gap_normal).abs() <= SAME && (a.traction - b.traction).norm() <= 15.0 * SAME);
            }
            assert!(a.iter().any(|a| a.state != State::Gap) || h1 + h2 > 0.01);
            // How much of a step may be taken: what is left of the gap, with a tenth of an edge.
            let (down, rest) = (vec![-Vec3::z(); one.x.len()], vec![Vec3::zeros(); two.x.len()]);
            let limits = [
                offset.step_limit((&one.x, &two.x), (&down, &rest), None).unwrap(),
                moved.step_limit((&raised, &two.x), (&down, &rest), None).unwrap(),
            ];
            assert!((limits[0] - limits[1]).abs() <= 1e-9, "{limits:?}");
        }
    }
}

/// What an offset adds to a slip is nothing: a step that slides and turns has the slip of one without.
#[test]
fn slip_is_that_without_offsets() {
    for slip in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper] {
        let rough = Roughness { warp: 0.05, jitter: 0.08, slide: 0.1 };
        let slips = [0.0, SIZE].map(|size| {
            let mut t = moved(&Options { slip, ..options() }, [Cells::Triangles; 2], rough, 3);
            give(&mut t.interface, size);
            t.interface.responses(&t.x1, &t.x2, &t.lambda, None).unwrap().iter().map(|r| r.slip).collect::<Vec<_>>()
        });
        let largest = slips[0].iter().map(|s| s.norm()).fold(0.0, f64::max);
        for (a, b) in slips[0].iter().zip(&slips[1]) {
            assert!((a - b).norm() <= SAME * largest, "{slip:?}: {a} {b}");
        }
    }
}

/// Both bodies, with their offsets, moved rigidly within a step: normals of now, rows turned along.
#[test]
fn a_rigid_motion_within_a_step_turns_the_residual() {
    let q = nalgebra::Rotation3::from_euler_angles(0.9, -0.4, 0.7);
    for basis in BASES {
        let of = Options { basis, normals: Normals::Current, weak_coverage: NO_WEAK_COVERAGE, ..options() };
        let mut t = moved(&of, [Cells::Triangles; 2], Roughness { warp: 0.05, jitter: 0.08, slide: 0.0 }, 3);
        give(&mut t.interface, SIZE);
        let turned = |x: &[Vec3]| x.iter().map(|x| q * x).collect::<Vec<_>>();
        let here = t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap().rows.clone();
        let there =
            t.interface.residual(&turned(&t.x1), &turned(&t.x2), &turned(&t.lambda), None).unwrap().rows.clone();
        let largest = here.iter().map(|r| r.norm()).fold(0.0, f64::max);
        for (a, b) in here.iter().zip(&there) {
            assert!((q * a - b).norm() <= SAME * largest, "{basis:?}");
        }
    }
}

#[test]
fn offsets_of_zero_are_none_to_the_bit_and_in_memory() {
    for basis in BASES {
        let [none, zero] = [false, true].map(|zero| {
            let mut t = moved(&Options { basis, ..options() }, [Cells::Quads; 2], FLAT, 3);
            if zero {
                give(&mut t.interface, SIZE);
                give(&mut t.interface, 0.0);
            }
            let r = t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap().rows.clone();
            (r, t.at().tangent(), t.interface.surfaces().0.offsets.capacity())
        });
        assert_eq!(none, zero);
    }
}

/// A clearance of more than the facets are long; surfaces that an interference closes over a gap.
#[test]
fn pairs_are_found_at_any_offset() {
    for (z, weights) in
        [(-2.0, Weights::Current), (3.0, Weights::Current), (-2.0, Weights::Reference), (3.0, Weights::Committed)]
    {
        let one = grid(4, 4, [0.0, 0.0], [1.0, 1.0], z, false, Cells::Quads);
        let two = grid(3, 3, [-0.5, -0.2], [1.5, 1.3], 0.0, true, Cells::Triangles);
        let lambda = vec![Vec3::zeros(); one.x.len()];
        for search_distance in [None, Some(0.1)] {
            let of = Options { weights, search_distance, ..options() };
            let mut c = interface(&one, &two, of);
            let state = |c: &mut Interface| {
                let r = c.responses(&one.x, &two.x, &lambda, None).unwrap();
                r.iter().filter(|r| r.state != State::Gap).count()
            };
            // Without: no pair that deep, no contact over a gap.
            assert_eq!(state(&mut c), 0);
            let closes = -z - 0.01;
            c.set_offsets([Some(vec![0.5 * closes; one.x.len()]), Some(vec![0.5 * closes; two.x.len()])]).unwrap();
            assert_eq!(state(&mut c), one.x.len(), "{z} {weights:?} {search_distance:?}");
            c.set_offsets([None, None]).unwrap();
            assert_eq!(state(&mut c), 0);
        }
    }
}

#[test]
fn analytic_sides_take_offsets_of_the_other_side_alone() {
    let one = grid(3, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let n = one.x.len();
    let surface = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, n)).unwrap();
    let frame = vec![Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()];
    let plane = Surface::analytic("mortar", AnalyticShape::Plane, frame).unwrap();
    let two: Vec<_> = plane.reference.clone();
    let mut c = Interface::new(surface, plane, numbered(3 * n, n), options()).unwrap();
    assert_eq!(c.set_offsets([None, Some(vec![1.0; 4])]).unwrap_err().kind, Kind::Unsupported);
    c.set_offsets([Some(vec![-0.01; n]), None]).unwrap();
    for r in c.responses(&one.x, &two, &vec![Vec3::zeros(); n], None).unwrap() {
        assert!(r.state != State::Gap && r.gap_normal < 0.0);
    }
}

#[test]
fn bad_offsets_are_refused_and_change_nothing() {
    let mut t = moved(&options(), [Cells::Quads; 2], FLAT, 3);
    give(&mut t.interface, SIZE);
    let before = t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap().rows.clone();
    let n = t.x1.len();
    let mut bad = vec![0.0; n];
    bad[n - 1] = f64::NAN;
    assert_eq!(t.interface.set_offsets([Some(vec![0.0; n + 1]), None]).unwrap_err().kind, Kind::InvalidSize);
    assert_eq!(t.interface.set_offsets([None, Some(vec![0.0; 1])]).unwrap_err().kind, Kind::InvalidSize);
    assert_eq!(t.interface.set_offsets([Some(bad), None]).unwrap_err().kind, Kind::NotFinite);
    assert_eq!(t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap().rows, before);
}

/// Frozen normals of a tangent: what a tilt does is left out of an offset's part, too.
#[test]
fn frozen_tangents_leave_out_what_they_say() {
    let mut t = moved(&Options { tangent: Tangent::FrozenNormals, ..options() }, [Cells::Quads; 2], FLAT, 7);
    give(&mut t.interface, SIZE);
    (t.x1, t.x2) = (t.interface.history().x1.clone(), t.interface.history().x2.clone());
    let error = t.at().difference_error(1.0);
    assert!(error <= DIFFERENCES, "{error:e}");
}

/// A clearance of several facets, set before the first step: t_n is settled again, so that nodes have friction in that step, with
/// weights of now too, and against an analytic surface. The slip that a host has said stays.
#[test]
fn the_first_step_with_a_large_clearance_has_friction() {
    const DEPTH: f64 = 1.5;
    /// Slips of 1e-3 are differences of depths.
    const ROUNDED: f64 = 1e-11;
    let down = Vec3::z() * -DEPTH;
    for (weights, analytic) in [Weights::Current, Weights::Committed, Weights::Reference]
        .into_iter()
        .flat_map(|weights| [false, true].map(|analytic| (weights, analytic)))
    {
        for basis in BASES {
            let options = Options { weights, basis, mu: 0.5, ..options() };
            let one = grid(3, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
            let two = grid(4, 4, [-0.5, -0.5], [1.5, 1.5], 0.0, true, Cells::Quads);
            let make = |shift: Vec3| -> Interface {
                let x = one.x.iter().map(|x| x + shift).collect::<Vec<_>>();
                let (n1, n2) = (one.x.len(), two.x.len());
                let nonmortar = Surface::new("nonmortar", x, &one.facets, numbered(0, n1)).unwrap();
                let frame = [Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()].to_vec();
                let mortar = match analytic {
                    true => Surface::analytic("mortar", AnalyticShape::Plane, frame).unwrap(),
                    false => Surface::new("mortar", two.x.clone(), &two.facets, numbered(3 * n1, n2)).unwrap(),
                };
                Contact::new(nonmortar, mortar, numbered(3 * (n1 + n2), n1), options).unwrap()
            };
            let (mut meant, mut meshed) = (make(Vec3::zeros()), make(down));
            meshed.set_offsets([Some(vec![DEPTH; one.x.len()]), None]).unwrap();
            // Pressed and dragged along by less than friction carries.
            let pressed = Vec3::new(0.001, 0.0, 0.0);
            let lambda = vec![Vec3::new(0.1, 0.0, -1.0); one.x.len()];
            let x2 = meant.surfaces().1.reference.clone();
            let at = |shift: Vec3| one.x.iter().map(|x| x + pressed + shift).collect::<Vec<_>>();
            let a = meant.responses(&at(Vec3::zeros()), &x2, &lambda, None).unwrap();
            let b = meshed.responses(&at(down), &x2, &lambda, None).unwrap();
            for (a, b) in a.iter().zip(&b) {
                assert_eq!(a.state, State::Stick, "{weights:?} {analytic} {basis:?}");
                assert_eq!(a.state, b.state, "{weights:?} {analytic} {basis:?}");
                assert!((a.row - b.row).norm() <= ROUNDED * a.row.norm(), "{weights:?} {analytic} {basis:?}");
            }
        }
    }
}

#[test]
fn the_slip_that_a_host_has_said_stays_when_offsets_are_set() {
    let mut s = moved(&options(), [Cells::Quads; 2], Roughness { warp: 0.0, jitter: 0.0, slide: 0.0 }, 3);
    let slip: Vec<_> = (0..s.x1.len()).map(|a| Vec3::new(0.01 * a as f64, -0.02, 0.0)).collect();
    s.interface.set_committed(&s.x1, &s.x2, &slip, 0).unwrap();
    s.interface.set_offsets([Some(vec![1e-3; s.x1.len()]), None]).unwrap();
    assert_eq!(s.interface.history().slip, slip);
}

/// Nodes over a ball are put onto it, and one on the axis of rings stays there.
#[test]
fn nodes_are_put_onto_curved_surfaces_and_stay_on_the_axis() {
    let mesh = grid(2, 2, [-0.5, -0.5], [0.5, 0.5], 1.05, false, Cells::Quads);
    let n = mesh.x.len();
    let one = Surface::new("nonmortar", mesh.x.clone(), &mesh.facets, numbered(0, n)).unwrap();
    let frame = [Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()].to_vec();
    let ball = Surface::analytic("mortar", AnalyticShape::Sphere(1.0), frame).unwrap();
    let contact: Interface = Contact::new(one, ball, numbered(3 * n, n), options()).unwrap();
    for node in contact.adjusted(0.5).unwrap() {
        assert!(node.moved && (node.x.norm() - 1.0).abs() < 1e-14, "{node:?}");
    }
    // The line at the axis is slanted, and with it the normal there.
    let mut mesh = crate::support::lines::lines(3, 2, [0.0, 1.5], false);
    for (x, height) in mesh.x.iter_mut().zip([0.01, 0.04, 0.03, 0.0]) {
        x.y = height;
    }
    let n = mesh.x.len();
    let equations = crate::support::lines::plane_equations;
    let one =
        Surface::of_lines("nonmortar", mesh.x.clone(), &mesh.facets, equations(0, n), Measure::Axisymmetric).unwrap();
    let flat = [Vec3::zeros(), Vec3::y(), Vec3::x()].to_vec();
    let line = Surface::analytic("mortar", AnalyticShape::Line, flat).unwrap();
    let contact: Interface = Contact::new(one, line, equations(2 * n, n), options()).unwrap();
    let nodes = contact.adjusted(0.1).unwrap();
    assert!(nodes[0].moved && nodes[0].x == Vec3::zeros(), "{:?}", nodes[0]);
}
