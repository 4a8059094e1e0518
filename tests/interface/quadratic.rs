//! Quadratic facets through the interface (docs/formulation 12.5): golden interfaces and dual facets, tangents against
//! differences, exact identities, plans, histories.

use super::golden::{dense_tangent, expected_tangent, residual_error, tangent_error};
use crate::support::differences::Point;
use crate::support::mesh::*;
use crate::support::parents::*;
use crate::support::*;
use serde_json::Value;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Extent, Friction, Interface, MultiplierBasis, NO_EQUATION, NewContact, Options, PlanPairs, PlanSystem,
    RowScale, Stiffness, Surface, Tangent, Weights,
};
use stickslip::law::{SlipMeasure, State};
use stickslip::mortar::MultiplierSpace;

/// G4: residual blocks, and dual weights, relative to the largest entry.
const RESIDUAL: f64 = 1e-12;
/// G4: tangent blocks, and derivatives of dual weights.
const TANGENT: f64 = 1e-10;
/// A block smaller than this part of the matrix is rounding of a block that vanishes.
const VANISHING: f64 = 1e-5;
/// Differences where the rule is exact: facets that are flat with straight edges, or triangles.
const DIFFERENCES: f64 = 1e-7;
/// Elsewhere: the rule's own error on curved and warped quadrilaterals (measured 2.6e-7).
const DIFFERENCES_CURVED: f64 = 2e-6;
/// Sums that vanish, over the largest entry.
const ROUNDING: f64 = 1e-13;

fn nodes_of(v: &Value) -> Vec<Vec<i64>> {
    let rows = v.as_array().unwrap().iter();
    rows.map(|f| f.as_array().unwrap().iter().map(|k| k.as_i64().unwrap()).collect()).collect()
}

fn golden_interface(case: &Value) -> super::golden::Golden {
    let (x1, x2) = (points(&case["x1"]), points(&case["x2"]));
    let (n1, n2) = (x1.len(), x2.len());
    let space = if case["multiplier_space"] == "sub" { MultiplierSpace::Sub } else { MultiplierSpace::Corner };
    let mut options = Options::paper(Stiffness::Augmentation(1.0));
    (options.space, options.row_scale, options.new_contact) = (space, RowScale::None, NewContact::KeepFriction);
    options.slip = SlipMeasure::Objective;
    assert_eq!(case["variant"], "objective");
    let surface = |side, x: &str, facets: &str, first, n| {
        Surface::new(side, points(&case[x]), &nodes_of(&case[facets]), numbered(first, n)).unwrap()
    };
    let one = surface("nonmortar", "x1_prev", "facets1", 0, n1);
    let two = surface("mortar", "x2_prev", "facets2", 3 * n1, n2);
    let mut multipliers = numbered::<3>(3 * (n1 + n2), n1);
    for (equations, has) in multipliers.iter_mut().zip(case["has_multiplier"].as_array().unwrap()) {
        if !has.as_bool().unwrap() {
            *equations = [NO_EQUATION; 3];
        }
    }
    let mut interface = Interface::new(one, two, multipliers, options).unwrap();
    interface.set_friction(vec![case["mu"].as_f64().unwrap(); n1]).unwrap();
    interface.set_augmentation(Some(numbers(&case["r"]))).unwrap();
    interface.set_normals(Some(points(&case["nu"]))).unwrap();
    super::golden::Golden { interface, x1, x2, lambda: points(&case["lambda"]) }
}

#[test]
fn golden_interfaces_of_quadratic_facets() {
    let mut worst = [0.0_f64; 2];
    for case in golden_part("golden_quadratic.json", "interfaces") {
        let mut g = golden_interface(&case);
        let responses = g.interface.responses(&g.x1, &g.x2, &g.lambda, None).unwrap();
        let has = case["has_multiplier"].as_array().unwrap();
        for (a, state) in numbers(&case["state"]).into_iter().enumerate().filter(|(a, _)| has[*a] == true) {
            assert_eq!(f64::from(responses[a].state as i32), state, "{}: state of node {a}", name(&case));
        }
        let error = residual_error(&mut g, &numbers(&case["residual_mult"]));
        assert!(error <= RESIDUAL, "{}: residual off by {error:e}", name(&case));
        let (n, k) = dense_tangent(&mut g);
        let mut expected = expected_tangent(&case["tangent_mult"], n);
        // Nodes without multipliers have no equations for them; the data have -1 / r on the diagonal there.
        let first = n - 3 * g.x1.len();
        for (i, j) in (first..n).filter(|i| has[(i - first) / 3] == false).flat_map(|i| (0..n).map(move |j| (i, j))) {
            assert!(i == j || expected[i * n + j] == 0.0 && expected[j * n + i] == 0.0);
            expected[i * n + i] = 0.0;
        }
        let tangent = tangent_error(g.x1.len(), n, &k, &expected, VANISHING);
        assert!(tangent <= TANGENT, "{}: tangent off by {tangent:e}", name(&case));
        worst = [worst[0].max(error), worst[1].max(tangent)];
    }
    println!("G4 by the interface: residual {:.1e}, tangent {:.1e}", worst[0], worst[1]);
}

/// With unit multipliers the forces are the dual weights, and their derivatives those of the weights.
#[test]
fn golden_dual_facets_of_quadratic_facets() {
    let mut worst = [0.0_f64; 2];
    for case in golden_part("golden_quadratic.json", "dual_facets") {
        let (x1, x2) = (points(&case["x1"]), points(&case["x2"]));
        let m = numbers(&case["m"]).len();
        let mesh = |x: &[Vec3], facets| Mesh { x: x.to_vec(), facets };
        let one = mesh(&x1, vec![(0..x1.len() as i64).collect()]);
        let two = mesh(&x2, nodes_of(&case["facets2"]));
        let options = Options { basis: MultiplierBasis::Dual, mu: 0.3, ..Options::paper(Stiffness::Augmentation(1.0)) };
        let mut c: Contact<3> = contact_of(&one, &two, false, options);
        let (n1, n) = (x1.len(), 3 * (x1.len() + x2.len()));
        for a in 0..m {
            let mut lambda = vec![Vec3::zeros(); n1];
            lambda[a] = Vec3::x();
            let r = c.residual(&x1, &x2, &lambda, None).unwrap();
            let mut k = vec![0.0; n * n];
            let mut add = |i: i64, j: i64, v: f64| {
                if (i as usize) < n && (j as usize) < n {
                    k[i as usize * n + j as usize] += v;
                }
            };
            c.tangent(&x1, &x2, &lambda, None, &mut add).unwrap();
            for (forces, first, sign, key) in [(&r.nonmortar, 0, 1.0, "AB"), (&r.mortar, n1, -1.0, "AC")] {
                let expected = numbers(&case[format!("nd_{key}")][a]);
                let scale = max_abs(expected.iter().copied());
                let error = max_abs(forces.iter().zip(&expected).map(|(f, n)| f.x - sign * n)) / scale;
                assert!(error <= RESIDUAL, "{} {key}: weights off by {error:e}", name(&case));
                let slopes = case[format!("dnd_{key}")][a].as_array().unwrap();
                let all: Vec<Vec<f64>> = slopes.iter().map(numbers).collect();
                let scale = max_abs(all.iter().flatten().copied());
                for (b, slope) in all.iter().enumerate() {
                    let row = &k[(3 * (first + b)) * n..][..n];
                    let error = max_abs(row.iter().zip(slope).map(|(k, d)| k - sign * d)) / scale;
                    assert!(error <= TANGENT, "{} {key}: derivatives off by {error:e}", name(&case));
                    worst[1] = worst[1].max(error);
                }
                worst[0] = worst[0].max(error);
            }
        }
    }
    println!("QD by the interface: weights {:.1e}, derivatives {:.1e}", worst[0], worst[1]);
}

fn error_of<const N: usize>(scene: &mut MovedParents<N>, floor: f64) -> f64 {
    Point { contact: &mut scene.contact, x1: &scene.x1, x2: &scene.x2, lambda: &scene.lambda }.difference_error(floor)
}

const SPACES: [MultiplierSpace; 2] = [MultiplierSpace::Corner, MultiplierSpace::Sub];

/// All choices of space and basis that there are.
fn choices(of: Options) -> impl Iterator<Item = Options> {
    let standard = SPACES.into_iter().map(move |space| Options { space, ..of });
    standard.chain([Options { basis: MultiplierBasis::Dual, ..of }])
}

#[test]
fn tangents_are_those_of_differences_for_every_kind_on_every_kind() {
    let mut seen = [0; 3];
    for (one, two) in KINDS.into_iter().flat_map(|one| KINDS.into_iter().map(move |two| (one, two))) {
        for options in choices(options()).filter(|o| one > 4 || o.space == MultiplierSpace::Corner) {
            if one <= 4 && two <= 4 {
                continue;
            }
            let mut scene = moved_parents::<3>(&options, [&[one], &[two]], FLAT, 0.0, false, 7);
            for r in scene.contact.responses(&scene.x1, &scene.x2, &scene.lambda, None).unwrap() {
                seen[r.state as usize] += 1;
            }
            let error = error_of(&mut scene, 0.0);
            assert!(error <= DIFFERENCES, "{one} on {two}, {:?} {:?}: off by {error:e}", options.space, options.basis);
        }
    }
    for state in [State::Gap, State::Stick, State::Slip] {
        assert!(seen[state as usize] > 20, "{state:?} hardly occurs: {seen:?}");
    }
}

#[test]
fn tangents_of_curved_and_warped_facets_differ_by_the_rule_alone() {
    let rough = Roughness { warp: 0.05, jitter: 0.1, slide: 0.9 };
    for kinds in [[6, 6], [8, 8], [9, 9], [6, 9], [8, 4], [4, 8]] {
        for options in choices(options()).filter(|o| kinds[0] > 4 || o.space == MultiplierSpace::Corner) {
            let mut scene = moved_parents::<3>(&options, [&[kinds[0]], &[kinds[1]]], rough, 0.2, false, 3);
            let error = error_of(&mut scene, 1.0);
            println!("{kinds:?} {:?} {:?}: {error:.1e}", options.space, options.basis);
            let bound = if kinds == [6, 6] { DIFFERENCES } else { DIFFERENCES_CURVED };
            assert!(error <= bound, "{kinds:?} {:?} {:?}: off by {error:e}", options.space, options.basis);
        }
    }
}

#[test]
fn tangents_of_all_choices_of_the_handle() {
    let mixed: [&[usize]; 2] = [&[9, 8, 4, 6], &[4, 6, 9, 3, 8]];
    let of = options();
    let mut variants = Vec::new();
    for weights in [Weights::Committed, Weights::Reference] {
        variants.push(Options { weights, ..of });
    }
    for slip in [SlipMeasure::Increment, SlipMeasure::Paper] {
        variants.push(Options { slip, ..of });
    }
    variants.push(Options { weak_coverage: 0.7, ..of });
    variants.push(under(Friction::Tied, 0.0, of));
    variants.push(under(Friction::Tresca, 0.0, of));
    for options in variants.into_iter().flat_map(choices) {
        for prescribed in [false, true] {
            // Moved off, so that nodes are covered in part and carried.
            let rough = Roughness { slide: 2.6, ..FLAT };
            let mut scene = moved_parents::<3>(&options, mixed, rough, 0.0, prescribed, 5);
            let error = if prescribed { continue } else { error_of(&mut scene, 0.0) };
            assert!(error <= DIFFERENCES, "{options:?} {prescribed}: off by {error:e}");
        }
    }
    for options in choices(of) {
        let mut scene = moved_parents::<1>(&options, mixed, FLAT, 0.0, false, 5);
        let error = error_of(&mut scene, 0.0);
        assert!(error <= DIFFERENCES, "frictionless {:?} {:?}: off by {error:e}", options.space, options.basis);
    }
}

#[test]
fn forces_balance_and_rigid_motions_do_nothing() {
    // With common edges: none of them is linear.
    let mixed: [&[usize]; 2] = [&[9, 8, 6, 6], &[8, 6, 9, 9, 8]];
    let rough = Roughness { warp: 0.05, jitter: 0.1, slide: 0.9 };
    let turn = nalgebra::Rotation3::from_euler_angles(0.3, 0.8, -1.1);
    for options in choices(options()) {
        let mut s = moved_parents::<3>(&options, mixed, rough, 0.2, false, 11);
        let r = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let largest = r.nonmortar.iter().map(|f| f.amax()).fold(0.0, f64::max);
        let sum: Vec3 = r.nonmortar.iter().chain(&r.mortar).sum();
        assert!(sum.amax() <= ROUNDING * largest, "momentum {sum:?}");
        // The moment of the forces is that of the gaps with the tractions: sum x_k x f_k = sum g_A x lambda_A.
        let sums = s.contact.sums(&s.x1, &s.x2).unwrap();
        let of_forces: Vec3 =
            s.x1.iter().zip(&r.nonmortar).chain(s.x2.iter().zip(&r.mortar)).map(|(x, f)| x.cross(f)).sum();
        let of_gaps: Vec3 = sums.iter().zip(&s.lambda).map(|(sum, t)| sum.gap_now.cross(t)).sum();
        assert!((of_forces - of_gaps).amax() <= 10.0 * ROUNDING * largest, "moment {of_forces:?} {of_gaps:?}");
        // Turned and moved, with its history.
        let moved = |x: &[Vec3]| x.iter().map(|x| turn * x + Vec3::new(3.0, -5.0, 2.0)).collect::<Vec<_>>();
        let [one, two] = [0, 1].map(|k| Mesh { x: moved(&s.meshes[k].x), facets: s.meshes[k].facets.clone() });
        let lambda: Vec<_> = s.lambda.iter().map(|t| turn * t).collect();
        let mut other: Contact<3> = contact_of(&one, &two, false, options);
        let q = other.residual(&moved(&s.x1), &moved(&s.x2), &lambda, None).unwrap();
        for (f, g) in
            r.nonmortar.iter().chain(&r.mortar).chain(&r.rows).zip(q.nonmortar.iter().chain(&q.mortar).chain(&q.rows))
        {
            assert!((turn * f - g).amax() <= 1e3 * ROUNDING * largest, "{:?} {:?}", turn * f, g);
        }
    }
}

#[test]
fn plans_have_the_entries_of_the_tangent() {
    let mixed: [&[usize]; 2] = [&[9, 8, 4, 6], &[4, 6, 9, 3, 8]];
    for options in choices(options()).flat_map(|o| [o, Options { weak_coverage: 0.7, ..o }]) {
        for prescribed in [false, true] {
            let mut s = moved_parents::<3>(&options, mixed, Roughness { slide: 2.6, ..FLAT }, 0.0, prescribed, 5);
            super::plan::agrees(&mut s.contact, &s.x1, &s.x2, &s.lambda, &format!("{options:?}"));
            // As many as there are pairs of nodes, counted otherwise.
            let n = s.contact.make_plan((&s.x1, &s.x2), PlanPairs::Active(Extent::Whole)).unwrap();
            assert!(n > 0);
            s.contact.plan(PlanSystem::Whole).unwrap();
        }
    }
}

#[test]
fn effects_say_where_multipliers_stand() {
    for (space, words) in
        [(MultiplierSpace::Corner, "at the corners (default)"), (MultiplierSpace::Sub, "at all nodes (asked for)")]
    {
        let scene = moved_parents::<3>(&Options { space, ..options() }, [&[8], &[6]], FLAT, 0.1, false, 5);
        let text = scene.contact.effects().unwrap().to_string();
        assert!(text.contains(&format!("Multipliers of quadratic facets: {words}.")), "{text}");
    }
}

#[test]
fn histories_of_quadratic_facets_are_kept_undone_and_imported() {
    let mixed: [&[usize]; 2] = [&[9, 8, 4, 6], &[4, 6, 9, 3, 8]];
    for options in choices(options()).flat_map(|o| [o, Options { weights: Weights::Committed, ..o }]) {
        let new = || moved_parents::<3>(&options, mixed, FLAT, 0.1, false, 5);
        let (mut s, mut t) = (new(), new());
        let before = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let (integers, reals) = s.contact.export_history().unwrap();
        assert_eq!(s.contact.history_size().unwrap(), (integers.len(), reals.len()));
        t.contact.import_history(&integers, &reals).unwrap();
        let x1: Vec<_> = s.x1.iter().map(|x| x + Vec3::new(0.01, 0.02, -0.003)).collect();
        let after = s.contact.residual(&x1, &s.x2, &s.lambda, None).unwrap();
        assert_eq!(t.contact.residual(&x1, &s.x2, &s.lambda, None).unwrap(), after);
        assert_ne!(before, after);
        s.contact.roll_back().unwrap();
        assert_eq!(s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap(), before);
        // Of another space or other facets it is refused.
        let mut other = if options.space == MultiplierSpace::Sub {
            options
        } else {
            Options { basis: MultiplierBasis::Standard, ..options }
        };
        other.space =
            if options.space == MultiplierSpace::Sub { MultiplierSpace::Corner } else { MultiplierSpace::Sub };
        let mut o = moved_parents::<3>(&other, mixed, FLAT, 0.1, false, 5);
        assert!(o.contact.import_history(&integers, &reals).is_err());
    }
}

/// Tied over a gap, both bodies turn as one: nothing holds them back. And the tangent knows the turn.
#[test]
fn tied_gaps_of_quadratic_facets_turn_with_them() {
    let turn = nalgebra::Rotation3::from_euler_angles(0.3, 0.8, -1.1);
    for (kinds, options) in [[6, 8], [8, 9], [9, 6], [4, 8]]
        .into_iter()
        .flat_map(|kinds| choices(under(Friction::Tied, 0.0, options())).map(move |o| (kinds, o)))
        .filter(|(kinds, o)| kinds[0] > 4 || o.space == MultiplierSpace::Corner)
    {
        let (one, two) = (
            grid_of(2, 2, [0.0, 0.0], [1.0, 1.0], false, &[kinds[0]]),
            grid_of(3, 3, [-0.1, -0.1], [1.1, 1.1], true, &[kinds[1]]),
        );
        let bent = |m: Mesh, lift: f64| Mesh {
            x: m.x.iter().map(|x| Vec3::new(x.x, x.y, lift + 0.1 * x.x * x.x)).collect(),
            facets: m.facets,
        };
        let (one, two) = (bent(one, 0.05), bent(two, 0.0));
        let mut c: Contact<3> = contact_of(&one, &two, false, options);
        let moved = |x: &[Vec3]| x.iter().map(|x| turn * x + Vec3::new(3.0, -5.0, 2.0)).collect::<Vec<_>>();
        let (x1, x2) = (moved(&one.x), moved(&two.x));
        let lambda = vec![Vec3::zeros(); x1.len()];
        let r = c.residual(&x1, &x2, &lambda, None).unwrap();
        // Rows are forces: of a gap of 0.05 they would be of the size of 0.05.
        let worst = r.rows.iter().map(|row| row.amax()).fold(0.0, f64::max);
        assert!(worst <= 100.0 * ROUNDING, "{kinds:?} {:?} {:?}: {worst:e}", options.space, options.basis);
        let error = Point { contact: &mut c, x1: &x1, x2: &x2, lambda: &lambda }.difference_error(1.0);
        assert!(error <= DIFFERENCES, "{kinds:?} {:?} {:?}: off by {error:e}", options.space, options.basis);
    }
}

#[test]
fn frozen_normals_and_weights_are_tangents_too() {
    for tangent in [Tangent::FrozenNormals, Tangent::FrozenWeights] {
        for options in choices(Options { tangent, ..options() }) {
            let mut s = moved_parents::<3>(&options, [&[9], &[8]], FLAT, 0.0, false, 5);
            let mut sum = 0.0;
            s.contact.tangent(&s.x1, &s.x2, &s.lambda, None, &mut |_: i64, _: i64, v: f64| sum += v.abs()).unwrap();
            assert!(sum > 0.0 && sum.is_finite());
        }
    }
}

#[test]
fn what_quadratic_facets_do_not_take_is_refused() {
    let (one, two) =
        (grid_of(1, 1, [0.0, 0.0], [1.0, 1.0], false, &[8]), grid_of(1, 1, [0.0, 0.0], [1.0, 1.0], true, &[8]));
    let refused = |options: Options, multipliers: Vec<[i64; 3]>| {
        let n1 = one.x.len();
        let s1 = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, n1)).unwrap();
        let s2 = Surface::new("mortar", two.x.clone(), &two.facets, numbered(3 * n1, two.x.len())).unwrap();
        Interface::new(s1, s2, multipliers, options).unwrap_err().to_string()
    };
    let none = vec![[NO_EQUATION; 3]; one.x.len()];
    let text =
        refused(Options { space: MultiplierSpace::Sub, basis: MultiplierBasis::Dual, ..options() }, none.clone());
    assert!(text.contains("multipliers at all nodes of quadratic facets"), "{text}");
    let text = refused(options(), numbered(100, one.x.len()));
    assert!(text.contains("non-mortar node 4 has a multiplier's equation"), "{text}");
    // A corner between two mid nodes; a mid node beyond a quarter.
    let mut facets = one.facets.clone();
    facets[0].swap(1, 4);
    let text = Surface::new("mortar", one.x.clone(), &facets, numbered(0, one.x.len())).unwrap_err().to_string();
    assert!(text.contains("facet 0") && text.contains("mid node"), "{text}");
    let mut x = one.x.clone();
    x[one.facets[0][4] as usize] = x[one.facets[0][0] as usize] * 0.9 + x[one.facets[0][1] as usize] * 0.1;
    let text = Surface::new("mortar", x, &one.facets, numbered(0, one.x.len())).unwrap_err().to_string();
    assert!(text.contains("facet 0") && text.contains("quarter"), "{text}");
    // A mid node nearly as far off leaves a non-mortar corner without a normal: of an interface that needs one, on that side.
    for (s, side, friction, fine) in [
        (0.22, 0, Friction::Coulomb, true),
        (0.24, 0, Friction::Coulomb, false),
        (0.24, 0, Friction::Tied, true),
        (0.24, 1, Friction::Coulomb, true),
    ] {
        let mut x = [one.x.clone(), two.x.clone()];
        let [a, b, mid] = [0, 1, 4].map(|k| [&one, &two][side].facets[0][k] as usize);
        x[side][mid] = x[side][a] * (0.5 + s) + x[side][b] * (0.5 - s);
        let [x1, x2] = x;
        let n1 = x1.len();
        let s1 = Surface::new("nonmortar", x1, &one.facets, numbered(0, n1)).unwrap();
        let s2 = Surface::new("mortar", x2, &two.facets, numbered(3 * n1, two.x.len())).unwrap();
        let options = under(friction, 0.0, Options { space: MultiplierSpace::Sub, ..options() });
        match Interface::new(s1, s2, numbered(100, n1), options) {
            Ok(_) => assert!(fine, "{s} on side {side}, {friction:?}"),
            Err(e) => assert!(!fine && e.to_string().contains("no normal to go by"), "{s} on side {side}: {e}"),
        }
    }
    let text = Surface::new("mortar", one.x.clone(), &[(0..7).collect()], numbered(0, 8)).unwrap_err().to_string();
    assert!(text.contains("facet 0 has 7 nodes; 3, 4, 6, 8 or 9 are allowed"), "{text}");
}

/// Seconds and more: `make test-long`.
mod long {
    use super::*;

    /// Facets enough for several chunks a phase (`src/interface/plan/phases.rs`), in whose order a plan adds blocks up.
    #[test]
    fn threads_do_not_change_a_bit() {
        const CELLS: i64 = 58;
        let one = grid_of(CELLS, CELLS, [0.0, 0.0], [1.0, 1.0], false, &[8, 9]);
        let mut two = grid_of(40, 41, [-0.1, -0.1], [1.1, 1.1], true, &[6, 9, 8]);
        two.x.iter_mut().for_each(|x| x.z = 0.001 * x.x * x.y);
        for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
            let mut expected = None;
            for threads in [1, 2, 3] {
                let options = Options { threads, basis, ..options() };
                let has = has_row(&one, options.space);
                let lambda: Vec<_> = has.iter().map(|has| Vec3::new(0.1, 0.0, if *has { -0.5 } else { 0.0 })).collect();
                let mut c = contact_of::<3>(&one, &two, false, options);
                let residual = c.residual(&one.x, &two.x, &lambda, None).unwrap();
                let n = c.make_plan((&one.x, &two.x), PlanPairs::Active(Extent::Whole)).unwrap();
                let mut values = vec![f64::NAN; n];
                c.plan_values((&one.x, &two.x), &lambda, None, &mut values).unwrap();
                assert!(values.iter().all(|v| v.is_finite()) && values.iter().any(|v| v.abs() > 1e-5));
                let found = (residual, values);
                assert!(*expected.get_or_insert_with(|| found.clone()) == found, "{basis:?}, {threads} threads");
                // Too few entries: refused, on threads too.
                let far: Vec<_> = one.x.iter().map(|x| x + Vec3::new(0.05, 0.02, 0.0)).collect();
                let refused = c.plan_values((&far, &two.x), &lambda, None, &mut vec![0.0; n]).unwrap_err();
                assert_eq!(
                    refused.kind,
                    stickslip::error::Kind::MissingEntry,
                    "{basis:?}, {threads} threads: {refused}"
                );
            }
        }
    }
}
