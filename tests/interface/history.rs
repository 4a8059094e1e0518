//! Residual and tangent are functions of (x, lambda, committed history) alone; the history changes on
//! commit, rolls back exactly and survives export and import (row S5 of the hard tests, docs/formulation 9).

use crate::support::mesh::*;
use nalgebra::Rotation3;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Extent, Form, Friction, Interface, NewContact, Options, Residual, Stiffness, Weights, seal_history,
};
use stickslip::law::{SlipMeasure, State};

const ROUGH: Roughness = Roughness { warp: 0.05, jitter: 0.08, slide: 0.02 };
const QUADS: [Cells; 2] = [Cells::Quads, Cells::Quads];

fn options_of(form: Form, weights: Weights) -> Options {
    Options { form, weights, ..options() }
}

fn all_options() -> Vec<Options> {
    let weights = [Weights::Current, Weights::Committed, Weights::Reference];
    [Form::Multiplier, Form::Augmented].iter().flat_map(|&f| weights.map(|w| options_of(f, w))).collect()
}

type Entries = Vec<(i64, i64, u64)>;

impl Moved {
    /// Residual and tangent to the bit.
    fn evaluate(&mut self) -> (Residual, Entries) {
        let r = self.interface.residual(&self.x1, &self.x2, &self.lambda, None).unwrap();
        (r, self.tangent())
    }

    fn tangent(&mut self) -> Entries {
        let mut k = Vec::new();
        let mut sink = |i: i64, j: i64, v: f64| k.push((i, j, v.to_bits()));
        self.interface.tangent(&self.x1, &self.x2, &self.lambda, None, &mut sink).unwrap();
        k
    }

    fn slide(&mut self, by: f64) {
        let along = Rotation3::from_euler_angles(0.4, -0.9, 1.3) * Vec3::new(0.8, 0.6, 0.0) * by;
        self.x1.iter_mut().for_each(|x| *x += along);
    }

    fn commit(&mut self) {
        self.interface.commit(&self.x1, &self.x2, &self.lambda, None).unwrap();
    }
}

#[test]
fn evaluating_at_a_b_a_gives_equal_bits() {
    for options in all_options() {
        let mut scene = moved(&options, QUADS, ROUGH, 3);
        let first = scene.evaluate();
        scene.slide(0.7);
        let elsewhere = scene.evaluate();
        scene.slide(-0.7);
        // The way back rounds differently: return to the very same numbers.
        let same = moved(&options, QUADS, ROUGH, 3);
        (scene.x1, scene.x2) = (same.x1, same.x2);
        assert_ne!(elsewhere.0, first.0);
        assert!(scene.evaluate() == first, "{options:?}");
    }
}

#[test]
fn residual_and_tangent_together_or_apart_give_equal_bits() {
    for options in all_options() {
        let together = moved(&options, QUADS, ROUGH, 3).evaluate();
        assert!(moved(&options, QUADS, ROUGH, 3).tangent() == together.1);
        let mut reversed = moved(&options, QUADS, ROUGH, 3);
        let tangent = reversed.tangent();
        assert!(reversed.evaluate() == (together.0, tangent));
    }
}

#[test]
fn pattern_and_tangent_have_the_same_entries_and_the_superset_has_them_all() {
    for options in all_options() {
        let mut scene = moved(&options, QUADS, ROUGH, 3);
        scene.slide(0.3);
        let tangent: Vec<_> = scene.tangent().into_iter().map(|(i, j, _)| (i, j)).collect();
        let (mut pattern, mut superset) = (Vec::new(), std::collections::HashSet::new());
        scene.interface.pattern(&scene.x1, &scene.x2, Extent::Whole, &mut |i, j, _| pattern.push((i, j))).unwrap();
        scene.interface.superset_pattern(&scene.x1, &scene.x2, &mut |i, j, _| _ = superset.insert((i, j))).unwrap();
        assert_eq!(pattern, tangent);
        assert!(tangent.iter().all(|e| superset.contains(e)));
    }
}

/// However far the surfaces have moved, a used interface finds the pairs that a fresh one finds.
#[test]
fn no_pair_is_missed_on_the_way() {
    for (n, m) in [(2, 9), (9, 2), (1, 12)] {
        let one = grid(n, n, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
        let two = grid(m, m, [-1.1, -1.3], [4.0, 2.2], 0.0, true, Cells::Triangles);
        let mut used = interface(&one, &two, options());
        for step in 0..60 {
            let move_by = Vec3::new(0.05 * f64::from(step), 0.3 * (f64::from(step) / 6.0).sin(), 0.0);
            let x1: Vec<_> = one.x.iter().map(|x| x + move_by).collect();
            let mut fresh = interface(&one, &two, options());
            assert_eq!(used.sums(&x1, &two.x).unwrap(), fresh.sums(&x1, &two.x).unwrap(), "step {step}");
        }
    }
}

#[test]
fn rollback_and_restart_continue_bit_for_bit() {
    for options in all_options() {
        let mut scene = moved(&options, QUADS, ROUGH, 3);
        scene.commit();
        scene.slide(0.05);
        let before = scene.evaluate();
        let history = scene.interface.history().clone();
        scene.commit();
        assert_eq!(scene.interface.history().commits, 2);
        assert_ne!(*scene.interface.history(), history);
        scene.interface.roll_back().unwrap();
        assert_eq!(*scene.interface.history(), history);
        assert!(scene.evaluate() == before, "{options:?}");
        assert_eq!(scene.interface.roll_back().unwrap_err().kind, Kind::NothingToRollBack);

        let (integers, reals) = scene.interface.export_history().unwrap();
        assert_eq!((integers.len(), reals.len()), scene.interface.history_size().unwrap());
        let mut restarted = moved(&options, QUADS, ROUGH, 3);
        restarted.interface.import_history(&integers, &reals).unwrap();
        restarted.slide(0.05);
        assert!(restarted.evaluate() == before, "{options:?}");
    }
}

#[test]
fn a_corrupt_history_is_refused_and_nothing_changes() {
    let mut scene = moved(&options(), QUADS, ROUGH, 3);
    scene.commit();
    let before = scene.interface.history().clone();
    let (integers, reals) = scene.interface.export_history().unwrap();
    let mut refuse = |kind: Kind, integers: &[i64], reals: &[f64]| {
        assert_eq!(scene.interface.import_history(integers, reals).unwrap_err().kind, kind);
        assert_eq!(*scene.interface.history(), before);
    };
    refuse(Kind::HistoryMismatch, &[], &reals);
    refuse(Kind::HistoryMismatch, &integers[..integers.len() - 1], &reals);
    refuse(Kind::HistoryMismatch, &integers, &reals[1..]);
    // With a checksum that fits what is wrong.
    let wrong =
        [(0, 7), (2, 1), (5, 0), (8, 0), (9, 0), (10, -1), (11, 3), (12, 1), (13, i64::MAX), (14, -1), (15, 1 << 40)];
    for (at, value) in wrong {
        let mut wrong = integers.clone();
        wrong[at] = value;
        seal_history(&mut wrong, &reals);
        refuse(Kind::HistoryMismatch, &wrong, &reals);
    }
    for (n, m) in [(1, 0), (0, 1), (2, 32)] {
        let (mut longer, mut reals) = (integers.clone(), reals.clone());
        longer.extend(vec![0; n]);
        reals.extend(vec![0.0; m]);
        seal_history(&mut longer, &reals);
        refuse(Kind::HistoryMismatch, &longer, &reals);
    }
    let mut wrong = reals.clone();
    wrong[17] = f64::NAN;
    refuse(Kind::NotFinite, &integers, &wrong);
}

/// Any single bit that is flipped, in any kind of history; numbers that change places or signs; parts that are cut off or
/// moved: none is taken for what was exported.
#[test]
fn a_damaged_history_is_refused() {
    let mut random = Random(15);
    let mut draw = |below: usize| (((random.next() + 1.0) * 0.5 * below as f64) as usize).min(below - 1);
    let mut flips = 0;
    for options in all_options() {
        let mut scene = moved(&options, QUADS, ROUGH, 3);
        scene.commit();
        let (integers, reals) = scene.interface.export_history().unwrap();
        let (n, m) = (integers.len(), reals.len());
        let mut refuse = |integers: &[i64], reals: &[f64], what: &str| {
            let kind = scene.interface.import_history(integers, reals).map_err(|e| e.kind);
            assert!(matches!(kind, Err(Kind::HistoryMismatch | Kind::NotFinite)), "{what}: {kind:?}");
        };
        for _ in 0..3400 {
            let (mut i, mut r) = (integers.clone(), reals.clone());
            let (at, bit) = (draw(n + m), draw(64));
            match at.checked_sub(n) {
                None => i[at] ^= 1 << bit,
                Some(at) => r[at] = f64::from_bits(r[at].to_bits() ^ (1 << bit)),
            }
            refuse(&i, &r, &format!("bit {bit} of word {at}"));
            flips += 1;
        }
        for _ in 0..300 {
            let (mut i, mut r) = (integers.clone(), reals.clone());
            let (a, b) = (draw(m), draw(m));
            r.swap(a, b);
            if r[a].to_bits() != r[b].to_bits() {
                refuse(&i, &r, "two numbers change places");
            }
            r.clone_from(&reals);
            if a != b {
                (r[a], r[b]) = (-r[a], -r[b]);
                refuse(&i, &r, "two signs change");
            }
            let (a, b) = (draw(n), draw(n));
            i.swap(a, b);
            if i[a] != i[b] {
                refuse(&i, &reals, "two integers change places");
            }
            let cut = draw(m);
            refuse(&integers, &reals[..cut], "the end is missing");
            refuse(&integers, &reals[cut + 1..], "the beginning is missing");
            let moved: Vec<_> = reals[cut..].iter().chain(&reals[..cut]).copied().collect();
            if moved != reals {
                refuse(&integers, &moved, "the beginning comes last");
            }
        }
        scene.interface.import_history(&integers, &reals).unwrap();
    }
    assert!(flips >= 20_000);
}

/// Facets and nodes may be alike; the places of the first configuration are those of one mesh.
#[test]
fn a_history_of_another_mesh_is_refused() {
    for options in all_options() {
        let mut scene = moved(&options, QUADS, ROUGH, 3);
        scene.commit();
        let (integers, reals) = scene.interface.export_history().unwrap();
        let (one, two) = scene.interface.surfaces();
        let again = |change: &dyn Fn(&mut Mesh, &mut Mesh)| {
            let (mut one, mut two) = (mesh_of(one), mesh_of(two));
            change(&mut one, &mut two);
            interface(&one, &two, options)
        };
        let ulp = |v: f64| f64::from_bits(v.to_bits() ^ 1);
        type Change<'a> = (&'a str, &'a dyn Fn(&mut Mesh, &mut Mesh));
        let others: [Change; 5] = [
            ("mesh", &|one, _| one.x[4].x = ulp(one.x[4].x)),
            ("mesh", &|_, two| two.x[7].z = ulp(two.x[7].z)),
            ("mesh", &|one, two| one.x.iter_mut().chain(&mut two.x).for_each(|x| *x *= 2.0)),
            ("facets", &|one, _| one.facets[2].rotate_left(1)),
            ("facets", &|_, two| two.facets.swap(3, 4)),
        ];
        for (word, change) in others {
            let error = again(change).import_history(&integers, &reals).unwrap_err();
            assert!(error.kind == Kind::HistoryMismatch && error.message.contains(word), "{}", error.message);
        }
        again(&|_, _| ()).import_history(&integers, &reals).unwrap();
    }
}

/// mu, augmentation, tolerances and forms are no part of a history; law, weights and slip measure are.
#[test]
fn a_restart_may_change_what_a_history_does_not_mean() {
    let mut scene = moved(&options(), QUADS, ROUGH, 3);
    scene.commit();
    let (integers, reals) = scene.interface.export_history().unwrap();
    let (one, two) = scene.interface.surfaces();
    let other = |options: Options| {
        interface(&mesh_of(one), &mesh_of(two), options).import_history(&integers, &reals).map_err(|e| e.message)
    };
    let base = options();
    let fine = [
        Options { mu: 0.1, ..base },
        Options { stiffness: Stiffness::Modulus(7.0), ..base },
        Options { form: Form::Augmented, ..base },
        Options { coverage_min: 1e-3, weak_coverage: 0.5, search_distance: Some(1.0), ..base },
    ];
    fine.into_iter().for_each(|options| assert_eq!(other(options), Ok(())));
    let wrong = [
        (Options { friction: Friction::Rough, mu: 0.0, ..base }, "rough surfaces"),
        (Options { friction: Friction::Tied, mu: 0.0, ..base }, "tied surfaces"),
        (Options { slip: SlipMeasure::Increment, ..base }, "the slip increment"),
        (Options { slip: SlipMeasure::Paper, ..base }, "the paper's slip measure"),
        (Options { weights: Weights::Committed, ..base }, "frozen at the last commit"),
    ];
    for (options, word) in wrong {
        let message = other(options).unwrap_err();
        assert!(message.contains(word), "{message}");
    }
}

/// The layouts of before, by name.
#[test]
fn a_history_of_an_older_layout_is_refused_by_name() {
    let mut scene = moved(&options(), QUADS, ROUGH, 3);
    let (mut integers, reals) = scene.interface.export_history().unwrap();
    for layout in 0x57_1C_01..0x57_1C_06 {
        integers[0] = layout;
        seal_history(&mut integers, &reals);
        let error = scene.interface.import_history(&integers, &reals).unwrap_err();
        assert!(error.message.contains("the layout of an older library version"), "{}", error.message);
    }
}

#[test]
fn slip_accumulates_over_steps() {
    for weights in [Weights::Current, Weights::Committed, Weights::Reference] {
        let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
        let two = grid(3, 3, [-1.0, -1.0], [3.0, 2.0], 0.0, true, Cells::Quads);
        let mut i = interface(&one, &two, options_of(Form::Multiplier, weights));
        let lambda = vec![Vec3::new(0.0, 0.0, -1.0); 9];
        for step in 1..=5 {
            let x1: Vec<_> = one.x.iter().map(|x| x + Vec3::x() * 0.1 * f64::from(step)).collect();
            i.commit(&x1, &two.x, &lambda, None).unwrap();
        }
        for slip in &i.history().slip {
            assert!((slip - Vec3::x() * 0.5).amax() < 1e-14, "{weights:?}: {slip:?}");
        }
    }
}

/// Design 7.5: a node that was uncovered at t_n has g_T = 0; sticking, its rows would vanish.
#[test]
fn a_newly_covered_node_acts_without_friction_for_one_step() {
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [1.5, -1.0], [4.0, 2.0], 0.0, true, Cells::Quads);
    let lambda = vec![Vec3::new(0.1, 0.0, -1.0); 4];
    let slid: Vec<_> = one.x.iter().map(|x| x + Vec3::x() * 2.0).collect();
    for (new_contact, state) in [(NewContact::Frictionless, State::Slip), (NewContact::KeepFriction, State::Stick)] {
        let mut i = interface(&one, &two, Options { new_contact, ..options() });
        let uncovered = i.responses(&one.x, &two.x, &lambda, None).unwrap();
        assert!(uncovered.iter().all(|r| r.state == State::Gap && r.traction == Vec3::zeros()));
        let covered = i.responses(&slid, &two.x, &lambda, None).unwrap();
        assert!(covered.iter().all(|r| r.state == state && r.slip == Vec3::zeros()));
        i.commit(&slid, &two.x, &lambda, None).unwrap();
        let next = i.responses(&slid, &two.x, &lambda, None).unwrap();
        assert!(next.iter().all(|r| r.state == State::Stick));
    }
}

/// Design 7.6: closed covered nodes start with a slight compression, before the first step only.
#[test]
fn initial_multipliers_hold_closed_nodes() {
    let frame = Rotation3::from_euler_angles(0.3, 0.5, -0.2);
    let turned = |mut m: Mesh| {
        m.x.iter_mut().for_each(|x| *x = frame * *x);
        m
    };
    let one = turned(grid(2, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads));
    for (z, closed) in [(0.0, true), (-0.1, false), (0.1, true)] {
        let two = turned(grid(3, 3, [-1.0, -1.0], [0.7, 2.0], z, true, Cells::Quads));
        let mut i = interface(&one, &two, Options::paper(Stiffness::Modulus(1000.0)));
        let lambda = i.initial_multipliers().unwrap();
        for (a, l) in lambda.iter().enumerate() {
            let nu = frame * Vec3::z();
            assert!((i.normal(a).unwrap() - nu).amax() < 1e-14);
            // tau rhat sqrt(M) = 1e-6 * 0.1 E.
            let expected = if closed { nu * -1e-4 } else { Vec3::zeros() };
            assert!((l - expected).amax() < 1e-15, "z = {z}, node {a}: {l:?}");
        }
        let states = i.responses(&one.x, &two.x, &lambda, None).unwrap();
        assert!(states.iter().all(|r| (r.state != State::Gap) == closed));
        i.commit(&one.x, &two.x, &lambda, None).unwrap();
        assert_eq!(i.initial_multipliers().unwrap_err().kind, Kind::InvalidValue);
    }
}

/// Stage by stage, with the sums of two handles that share the mortar facets: what a parallel host does.
#[test]
fn handles_with_disjoint_mortar_facets_add_up() {
    let mut whole = moved(&options_of(Form::Multiplier, Weights::Current), QUADS, ROUGH, 3);
    let (one, two) = whole.interface.surfaces();
    let mesh = |s: &stickslip::interface::Surface, keep: &dyn Fn(usize) -> bool| {
        let facets = s.facets.iter().enumerate().filter(|(f, _)| keep(*f));
        Mesh {
            x: s.reference.clone(),
            facets: facets.map(|(_, f)| f.nodes.iter().map(|&k| k as i64).collect()).collect(),
        }
    };
    // Rows of facets, so that every node stays in use: unused nodes are refused.
    let mut parts: Vec<Interface> = Vec::new();
    for part in 0..2 {
        let mut m = mesh(two, &|f| (f < 3) == (part == 0));
        let used: Vec<i64> = {
            let mut u: Vec<i64> = m.facets.iter().flatten().copied().collect();
            u.sort_unstable();
            u.dedup();
            u
        };
        m.x = used.iter().map(|&k| m.x[k as usize]).collect();
        m.facets.iter_mut().flatten().for_each(|k| *k = used.iter().position(|u| u == k).unwrap() as i64);
        parts.push(interface(&mesh(one, &|_| true), &m, *whole.interface.options()));
    }
    let x2_of = |part: usize| if part == 0 { whole.x2[..8].to_vec() } else { whole.x2[4..].to_vec() };
    let shares: Vec<_> = (0..2).map(|p| parts[p].sums(&whole.x1, &x2_of(p)).unwrap()).collect();
    let total: Vec<_> = (0..9)
        .map(|a| {
            let (mut s, t) = (shares[0][a], &shares[1][a]);
            s.coverage += t.coverage;
            s.gap_now += t.gap_now;
            s.coverage_previous += t.coverage_previous;
            s.gap_previous += t.gap_previous;
            s.gap_committed += t.gap_committed;
            s
        })
        .collect();
    let expected = whole.interface.residual(&whole.x1, &whole.x2, &whole.lambda, None).unwrap();
    let mut force = vec![Vec3::zeros(); 9];
    for p in 0..2 {
        let r = parts[p].residual(&whole.x1, &x2_of(p), &whole.lambda, Some(&total)).unwrap();
        force.iter_mut().zip(&r.nonmortar).for_each(|(f, g)| *f += g);
        for (row, e) in r.rows.iter().zip(&expected.rows) {
            assert!((row - e).amax() < 1e-14);
        }
    }
    for (f, e) in force.iter().zip(&expected.nonmortar) {
        assert!((f - e).amax() < 1e-14);
    }
}

/// A step whose slip leaves the range of doubles is refused: the history it left could be exported, but not imported
/// again. (The weights of t_n are those of a corrupt history; nothing else makes such a slip.)
#[test]
fn a_step_whose_slip_overflows_is_not_committed() {
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], 0.0, true, Cells::Quads);
    let mut i = interface(&one, &two, options());
    let (mut integers, mut reals) = i.export_history().unwrap();
    // After five vectors a node: areas, coverages, then the weights of the only pair.
    let coverage = 5 * 12 + 4;
    reals[coverage..coverage + 4].fill(2.5e-8);
    reals[coverage + 4..].iter_mut().for_each(|w| *w *= 1e303);
    seal_history(&mut integers, &reals);
    i.import_history(&integers, &reals).unwrap();
    let x1: Vec<_> = one.x.iter().map(|x| x + Vec3::x() * 0.5).collect();
    let lambda = [Vec3::new(0.0, 0.0, -1.0); 4];
    assert!(i.residual(&x1, &two.x, &lambda, None).is_ok());
    let refused = i.commit(&x1, &two.x, &lambda, None).unwrap_err();
    assert_eq!(refused.kind, Kind::NotFinite);
    assert!(refused.message.contains("the slip of non-mortar node 0 overflows"), "{}", refused.message);
    let after = i.export_history().unwrap();
    assert!(after == (integers, reals), "a refused commit has changed nothing");
}

/// With weights frozen for good a step may end where a facet has no area; what it exports is imported again.
#[test]
fn a_history_of_frozen_weights_is_imported_wherever_its_facets_are() {
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], 0.0, true, Cells::Quads);
    for (weights, accepted) in [(Weights::Reference, true), (Weights::Committed, false), (Weights::Current, false)] {
        let mut i = interface(&one, &two, options_of(Form::Multiplier, weights));
        let line: Vec<_> = one.x.iter().map(|x| Vec3::new(x.x, x.x, 0.0)).collect();
        assert_eq!(i.commit(&line, &two.x, &[Vec3::zeros(); 4], None).is_ok(), accepted);
        let (integers, reals) = i.export_history().unwrap();
        i.import_history(&integers, &reals).unwrap();
    }
}
