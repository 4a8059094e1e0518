//! How far a point is from contact equilibrium: nothing at solutions, the same for every augmentation, and what each
//! condition's violation is.

use crate::support::host::{Body, Host};
use crate::support::mesh::*;
use nalgebra::Rotation3;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Equilibrium, Form, Friction, MortarSide, Options, RowScale, Scales, Stiffness, Weights,
};
use stickslip::law::{Coefficient, LAWS};

/// Newton's method ends at such a step, relative to the unknowns: multipliers of slivers come no closer.
const NEWTON: f64 = 1e-11;
/// What is left then: the last step, squared where the method is quadratic, or the rounding of its matrix.
const SOLVED: f64 = 1e-9;
/// What is taken off a traction for the rounding of positions, 8 eps E / h of 1, and some more.
const ROUNDING: f64 = 1e-11;
/// Of the upper, softer body.
const YOUNG: f64 = 100.0;
/// Of the default; Newton's method with full steps finds the states in all of them.
const AUGMENTATIONS: [f64; 3] = [1e-3, 3e-2, 1.0];

/// Over the modulus; some nodes slip at it, others at mu times their pressure.
const SHEAR_LIMIT: f64 = 3e-3;

const SCALES: Scales = Scales { modulus: YOUNG, traction: 0.0 };

/// Three numbers without a unit.
fn relative(e: &Equilibrium) -> [f64; 3] {
    [e.gap, e.traction, e.slip].map(|l| if l.value == 0.0 { 0.0 } else { l.value / l.scale })
}

/// A block pressed on another, or on a prescribed surface, and pushed, tilted so that some nodes open; the distances
/// from equilibrium at the ends of the steps, and in between.
fn press<const N: usize>(options: Options, rigid: bool) -> (Vec<[f64; 3]>, Vec<[f64; 3]>)
where
    Contact<N>: Create<N>,
{
    let upper = grid(3, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let lower = grid(4, 4, [-0.4, -0.3], [1.5, 1.4], 0.0, true, Cells::Quads);
    let upper = Body::new(upper, Vec3::z() * 0.4, YOUNG, 0.3);
    let lower = if rigid { Err(lower) } else { Ok(Body::new(lower, -Vec3::z() * 0.5, 150.0, 0.2)) };
    let mut host = Host::<N>::new(upper, lower, options);
    if !rigid {
        host.hold(1, |_| Vec3::zeros());
    }
    let (mut ends, mut between) = (Vec::new(), Vec::new());
    for step in 1..=3 {
        let s = f64::from(step);
        host.hold(0, |x| Vec3::new(0.006 * s, 0.002 * s, -0.01 * s + 0.03 * s * (x.x - 0.3)));
        host.solve_to(NEWTON);
        let (mut x1, x2) = host.positions();
        let mut at = |x1: &[Vec3]| relative(&host.contact.equilibrium(x1, &x2, &host.lambda, None, &SCALES).unwrap());
        ends.push(at(&x1));
        // Off by 1e-5 of the block.
        x1.iter_mut().for_each(|x| *x += Vec3::new(-1e-5, 2e-5, 1e-5));
        between.push(at(&x1));
        host.commit();
    }
    (ends, between)
}

#[test]
fn nothing_is_amiss_at_a_solution_whatever_the_augmentation() {
    for friction in LAWS.map(|law| law.friction) {
        for (form, row_scale, scale) in AUGMENTATIONS
            .iter()
            .flat_map(|&s| [(Form::Multiplier, RowScale::Force, s), (Form::Augmented, RowScale::None, s)])
        {
            for rigid in [false, true] {
                let mu = if friction.law().mu == Coefficient::Given { 0.3 } else { 0.0 };
                let shear_limit = friction.law().limits_shear.then_some(SHEAR_LIMIT * YOUNG);
                let stiffness = Stiffness::Modulus(scale * YOUNG);
                let options = Options { form, row_scale, friction, mu, shear_limit, ..Options::paper(stiffness) };
                let (ends, between) = match friction {
                    Friction::None => press::<1>(options, rigid),
                    _ => press::<3>(options, rigid),
                };
                let what = format!("{friction:?} {form:?} {row_scale:?} {scale:e} rigid {rigid}");
                for end in &ends {
                    assert!(end.iter().all(|v| *v <= SOLVED), "{what}: {end:?}");
                }
                // 1e-5 of E over a facet of a third is 3e-5 E; the largest traction is some per cent of E.
                for point in &between {
                    assert!(point[0] > 1e-5 && point[0] < 1e-2, "{what}: off by 1e-5: {point:?}");
                    // A traction that is not along the slip may be either.
                    assert!(point[1].max(point[2]) > 1e-6 || friction == Friction::None, "{what}: {point:?}");
                }
            }
        }
    }
}

/// All nodes, states and violations of a random point.
fn random_point(options: &Options) -> Moved {
    moved(options, [Cells::Quads, Cells::Triangles], FLAT, 7)
}

fn measured<const N: usize>(
    contact: &mut Contact<N>,
    (x1, x2): (&[Vec3], &[Vec3]),
    lambda: &[nalgebra::SVector<f64, N>],
    scales: Scales,
) -> Equilibrium {
    contact.equilibrium(x1, x2, lambda, None, &scales).unwrap()
}

/// Without what asks which nodes slip: far from equilibrium the augmentation decides that.
fn without_states(found: Equilibrium) -> Equilibrium {
    Equilibrium { lag_force: [0.0; 2], ..found }
}

#[test]
fn augmentation_row_scale_and_form_have_no_part_in_it() {
    let mut found = [0.0_f64; 3];
    for scales in [SCALES, Scales::default(), Scales { modulus: 1.0, traction: 4.0 }] {
        let mut t = random_point(&options());
        let expected = without_states(measured(&mut t.interface, (&t.x1, &t.x2), &t.lambda, scales));
        found = std::array::from_fn(|k| found[k].max(relative(&expected)[k]));
        for r in [1e-12, 3.0, 1e9] {
            for (form, row_scale) in [(Form::Augmented, RowScale::Force), (Form::Multiplier, RowScale::None)] {
                let stiffness = Stiffness::Augmentation(r);
                let mut t = random_point(&Options { form, row_scale, stiffness, ..options() });
                assert_eq!(without_states(measured(&mut t.interface, (&t.x1, &t.x2), &t.lambda, scales)), expected);
                t.interface.set_augmentation(Some((0..9).map(|a| r * 10f64.powi(a)).collect())).unwrap();
                assert_eq!(without_states(measured(&mut t.interface, (&t.x1, &t.x2), &t.lambda, scales)), expected);
            }
        }
    }
    assert!(found.iter().all(|v| *v > 1e-4), "each of them is met: {found:?}");
}

#[test]
fn units_scale_it() {
    let mut t = random_point(&options());
    let expected = measured(&mut t.interface, (&t.x1, &t.x2), &t.lambda, SCALES);
    // Powers of two: exact.
    let (length, stress) = (2f64.powi(-10), 2f64.powi(30));
    let mesh = |s: &stickslip::interface::Surface| {
        let m = mesh_of(s);
        Mesh { x: m.x.iter().map(|x| x * length).collect(), ..m }
    };
    let (one, two) = t.interface.surfaces();
    let mut other = interface(&mesh(one), &mesh(two), options());
    let scale = |v: &[Vec3], by: f64| v.iter().map(|v| v * by).collect::<Vec<_>>();
    let scales = Scales { modulus: SCALES.modulus * stress, ..SCALES };
    let (x1, x2) = (scale(&t.x1, length), scale(&t.x2, length));
    let found = measured(&mut other, (&x1, &x2), &scale(&t.lambda, stress), scales);
    for (f, e, unit) in [
        (found.gap, expected.gap, length),
        (found.traction, expected.traction, stress),
        (found.slip, expected.slip, length),
    ] {
        assert_eq!((f.value, f.scale, f.node), (e.value * unit, e.scale * unit, e.node));
    }
}

#[test]
fn an_open_interface_and_a_first_touch_without_load_are_in_equilibrium() {
    for lift in [0.0, 0.1, 30.0] {
        let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], lift, false, Cells::Quads);
        let two = grid(3, 3, [-0.4, -0.4], [1.5, 1.5], 0.0, true, Cells::Quads);
        let mut t = interface(&one, &two, options());
        let mut lambda = vec![Vec3::zeros(); 9];
        for scales in [Scales::default(), SCALES] {
            let found = measured(&mut t, (&one.x, &two.x), &lambda, scales);
            assert_eq!(relative(&found), [0.0; 3], "{lift} {scales:?}");
            assert!([found.gap, found.traction, found.slip].iter().all(|l| l.node.is_none()));
        }
        // What an open node has is a violation; and it is the largest traction, too.
        lambda[4] = Vec3::new(0.0, 0.1, -0.2);
        let found = measured(&mut t, (&one.x, &two.x), &lambda, SCALES);
        if lift > 0.0 {
            let size = lambda[4].norm();
            assert!((found.traction.value - size).abs() <= 1e-9 * size && found.traction.node == Some(4), "{found:?}");
        }
    }
}

/// One node among many, a thousand and a million times less loaded than the others.
#[test]
fn each_condition_at_one_node() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(3, 3, [-0.4, -0.4], [1.5, 1.5], 0.0, true, Cells::Quads);
    let mut t = interface(&one, &two, Options { mu: 0.5, ..options() });
    let nu = t.normal(4).unwrap();
    for light in [1.0, 1e-3, 1e-6] {
        let pressed = |a: usize| nu * if a == 4 { -light } else { -1.0 };
        let mut check = |lambda: Vec3, expected: f64, why: &str| {
            let mut all: Vec<_> = (0..9).map(pressed).collect();
            all[4] = lambda;
            let found = measured(&mut t, (&one.x, &two.x), &all, SCALES);
            let got = found.traction;
            assert!((got.value - expected).abs() <= ROUNDING, "{why}: {found:?}, expected {expected:e}");
            assert!(found.gap.value == 0.0 && found.slip.value == 0.0, "{why}: {found:?}");
            assert!((got.scale - lambda.norm().max(1.0)).abs() <= ROUNDING, "{found:?}");
            assert_eq!(got.node, (expected > 0.0).then_some(4));
        };
        let across = Vec3::x();
        check(pressed(4), 0.0, "pressed");
        check(pressed(4) + across * (0.49 * light), 0.0, "sticks");
        check(pressed(4) + across * (0.5 * light), 0.0, "on the cone");
        check(pressed(4) + across * (0.75 * light), 0.25 * light, "beyond the cone");
        check(nu * light, light, "tension");
    }
}

#[test]
fn slip_must_go_along_the_traction() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(3, 3, [-0.4, -0.4], [1.5, 1.5], 0.0, true, Cells::Quads);
    let mut t = interface(&one, &two, Options { mu: 0.5, ..options() });
    let nu = t.normal(0).unwrap();
    let d = 1e-3;
    for (way, expected) in [(Vec3::x(), 0.0), (-Vec3::x(), d), (Vec3::y(), d)] {
        let x1: Vec<_> = one.x.iter().map(|x| x + Vec3::x() * d).collect();
        // The sign of the traction that goes with slip along x is found by asking the law.
        let sticking = vec![-nu; 9];
        let response = t.responses(&x1, &two.x, &sticking, None).unwrap()[4].slip;
        let sign = response.x.signum();
        let lambda = vec![-nu + way * (0.5 * sign); 9];
        let found = measured(&mut t, (&x1, &two.x), &lambda, SCALES);
        assert!((found.slip.value - expected).abs() <= ROUNDING, "{way:?}: {found:?}");
    }
}

/// Slivers, newly covered nodes, and nodes that their neighbours carry, at solutions: a block pushed off the end of a
/// plate and onto it.
#[test]
fn at_the_end_of_a_plate() {
    for (weak_coverage, weights) in [(0.0, Weights::Current), (0.5, Weights::Current), (0.5, Weights::Committed)] {
        let upper = grid(4, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
        let lower = grid(4, 4, [-0.4, -0.3], [0.77, 1.4], 0.0, true, Cells::Quads);
        let upper = Body::new(upper, Vec3::z() * 0.4, YOUNG, 0.3);
        let options = Options { weak_coverage, weights, mu: 0.2, ..Options::paper(Stiffness::Modulus(YOUNG)) };
        let mut host = Host::<3>::new(upper, Err(lower), options);
        let (mut carried, mut new) = (0, 0);
        for push in [0.0, 0.01, -0.05, -0.1] {
            host.hold(0, |_| Vec3::new(push, 0.0, -0.01));
            host.solve_to(NEWTON);
            let (x1, x2) = host.positions();
            let found = measured(&mut host.contact, (&x1, &x2), &host.lambda, SCALES);
            assert!(relative(&found).iter().all(|v| *v <= SOLVED), "{weak_coverage} {weights:?} {push}: {found:?}");
            carried += host.contact.counters().nodes.carried;
            new += host.contact.counters().nodes.new;
            host.commit();
        }
        assert_eq!(carried > 0, weak_coverage > 0.0, "{carried} carried, {new} new");
    }
}

/// A plane instead of facets; multipliers taken away along y.
#[test]
fn a_rigid_side_and_removed_directions() {
    let upper = grid(3, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let lower = grid(2, 2, [-1.0, -1.0], [2.0, 2.0], 0.0, true, Cells::Quads);
    let mut t = interface(&upper, &lower, Options { mortar_side: MortarSide::Deformable, ..options() });
    let nu = t.normal(0).unwrap();
    let mut lambda = vec![-nu; 16];
    lambda[5] += Vec3::y() * 0.1;
    assert_eq!(relative(&measured(&mut t, (&upper.x, &lower.x), &lambda, SCALES)), [0.0; 3]);
    t.set_constraints(&[(5, Vec3::y())]).unwrap();
    let found = measured(&mut t, (&upper.x, &lower.x), &lambda, SCALES).traction;
    assert!((found.value - 0.1).abs() <= ROUNDING && found.node == Some(5), "{found:?}");
}

/// A square that is pressed on a larger one and slides: by frozen weights the traction acts on the mortar side where it did when they
/// were made, and the slide is the whole way since then, in sizes of the facets around the node.
#[test]
fn frozen_weights_tell_how_far_they_have_slid() {
    let (upper, lower) = (square([0.0, 0.0], [1.0, 1.0], false), square([-1.0, -1.0], [4.0, 4.0], true));
    let way = Vec3::new(0.3, 0.4, 0.0);
    let lambda = vec![-Vec3::z(); 16];
    for (weights, friction, slides) in [
        (Weights::Current, Friction::Coulomb, [0.0, 0.0]),
        (Weights::Committed, Friction::Coulomb, [0.5, 0.5]),
        (Weights::Reference, Friction::Coulomb, [0.5, 1.0]),
        (Weights::Reference, Friction::Tied, [0.0, 0.0]),
    ] {
        let mut contact = interface(&upper, &lower, Options { weights, friction, ..options() });
        for (step, expected) in (1..).zip(slides) {
            let x1: Vec<_> = upper.x.iter().map(|x| x + f64::from(step) * way).collect();
            let slide = measured(&mut contact, (&x1, &lower.x), &lambda, SCALES).slide;
            assert!((slide.value - expected).abs() <= ROUNDING, "{weights:?} {friction:?} {step}: {slide:?}");
            assert!(expected == 0.0 || (slide.scale - 1.0 / 3.0).abs() <= ROUNDING, "a side of a facet: {slide:?}");
            // What is not pressed counts by its part of the largest traction.
            let mut light = lambda.clone();
            light.iter_mut().skip(1).for_each(|lambda| *lambda *= 1e-3);
            let node = measured(&mut contact, (&x1, &lower.x), &light, SCALES).slide.node;
            assert_eq!(node, (expected > 0.0).then_some(0));
            contact.commit(&x1, &lower.x, &lambda, None).unwrap();
        }
    }
}

/// A node that touched at t_n and opens by less than it slides has a gap that frozen weights measure as a chord's: it counts in full. One that
/// opens by more, or was apart, does not; nor does one under weights of now.
#[test]
fn what_opens_by_less_than_it_slides_has_slid() {
    let lower = square([-1.0, -1.0], [4.0, 4.0], true);
    let scales = Scales { traction: 1.0, ..SCALES };
    let open = vec![Vec3::zeros(); 16];
    for (weights, apart, opening, expected) in [
        (Weights::Committed, 0.0, 0.05, 0.4),
        (Weights::Reference, 0.0, 0.05, 0.4),
        (Weights::Committed, 0.0, 0.5, 0.0),
        (Weights::Committed, 0.1, 0.05, 0.0),
        (Weights::Current, 0.0, 0.05, 0.0),
    ] {
        let mut upper = square([0.0, 0.0], [1.0, 1.0], false);
        upper.x.iter_mut().for_each(|x| x.z += apart);
        let mut contact = interface(&upper, &lower, Options { weights, ..options() });
        let x1: Vec<_> = upper.x.iter().map(|x| x + Vec3::new(0.4, 0.0, opening)).collect();
        let slide = measured(&mut contact, (&x1, &lower.x), &open, scales).slide;
        assert!((slide.value - expected).abs() <= ROUNDING, "{weights:?} {apart} {opening}: {slide:?}");
    }
}

/// Two squares that are pressed on each other and turned as one: with weights of the reference pressure keeps its first normals, so that a
/// part of it acts along the surfaces. That was told by the driver alone; the diagnosis said nothing.
#[test]
fn weights_of_the_reference_tell_how_far_they_have_turned() {
    let (upper, lower) = (square([0.0, 0.0], [1.0, 1.0], false), square([-1.0, -1.0], [4.0, 4.0], true));
    let lambda = vec![-Vec3::z(); 16];
    for (weights, friction, angle, expected) in [
        (Weights::Current, Friction::Coulomb, 0.25, 0.0),
        (Weights::Committed, Friction::Coulomb, 0.25, 0.0),
        (Weights::Reference, Friction::Coulomb, 0.25, 0.25),
        (Weights::Reference, Friction::Coulomb, 0.02, 0.02),
        (Weights::Reference, Friction::Tied, 0.25, 0.0),
    ] {
        let mut contact = interface(&upper, &lower, Options { weights, friction, ..options() });
        let turn = Rotation3::from_axis_angle(&Vec3::y_axis(), angle);
        let [x1, x2] = [&upper.x, &lower.x].map(|x| x.iter().map(|x| turn * x).collect::<Vec<_>>());
        let found = measured(&mut contact, (&x1, &x2), &lambda, SCALES).turn;
        assert!((found.value - expected).abs() <= ROUNDING, "{weights:?} {friction:?} {angle}: {found:?}");
        let text = contact.diagnose(&x1, &x2, &lambda, None).unwrap().text(1).unwrap();
        let told = text.contains("has turned by 0.25 rad since its weights were made");
        assert_eq!(told, expected > 0.1, "{weights:?} {friction:?} {angle}: {text}");
        // What is not pressed counts by its part of the largest traction.
        let mut light = lambda.clone();
        light.iter_mut().skip(1).for_each(|lambda| *lambda *= 1e-3);
        let node = measured(&mut contact, (&x1, &x2), &light, SCALES).turn.node;
        assert_eq!(node, (expected > 0.0).then_some(0));
    }
}

/// Nodes on an edge, at a corner and within have one, two, three, four or six facets around them, all of the same size.
#[test]
fn a_slide_counts_in_the_size_of_facets_however_many_a_node_has() {
    for (name, cells) in [("squares", Cells::Quads), ("triangles", Cells::Triangles)] {
        let upper = grid(3, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, cells);
        let lower = square([-1.0, -1.0], [4.0, 4.0], true);
        let weights = Weights::Committed;
        let mut contact = interface(&upper, &lower, Options { weights, friction: Friction::Coulomb, ..options() });
        let x1: Vec<_> = upper.x.iter().map(|x| x + Vec3::x() * 0.1).collect();
        for a in 0..upper.x.len() {
            let lambda: Vec<_> = (0..upper.x.len()).map(|b| -Vec3::z() * if a == b { 1.0 } else { 1e-6 }).collect();
            let slide = measured(&mut contact, (&x1, &lower.x), &lambda, SCALES).slide;
            assert_eq!(slide.node, Some(a), "{name}");
            assert!((slide.scale - 1.0 / 3.0).abs() <= ROUNDING, "{name}, node {a}: {slide:?}");
        }
    }
}

fn square(lower: [f64; 2], upper: [f64; 2], up: bool) -> Mesh {
    grid(3, 3, lower, upper, 0.0, up, Cells::Quads)
}
