//! What an effect leaves out is not done: asserted on counters, not on time.

use super::*;
use stickslip::interface::{Counters, Friction};

/// Three steps of two evaluations, residual and tangent, and a commit; what the counters gained.
fn run<const N: usize>(options: Options, prescribed: bool) -> (Counters, Contact<N>)
where
    Contact<N>: Create<N>,
{
    let scene = moved(&options, CELLS[0], FLAT, 3);
    let mut c: Contact<N> = again(&scene, prescribed, options);
    let created = c.counters();
    assert_eq!(created.searches, 1, "creation");
    let lambda = vec![SVector::from_element(-0.3); scene.x1.len()];
    for k in 0..6 {
        let x1 = shifted(&scene.x1, along() * 0.01 * f64::from(k));
        c.residual(&x1, &scene.x2, &lambda, None).unwrap();
        c.tangent(&x1, &scene.x2, &lambda, None, &mut |_: i64, _: i64, _: f64| ()).unwrap();
        if k % 2 == 1 {
            c.commit(&x1, &scene.x2, &lambda, None).unwrap();
        }
    }
    let end = c.counters();
    let gained = Counters {
        pairs_tested: end.pairs_tested - created.pairs_tested,
        pairs_clipped: end.pairs_clipped - created.pairs_clipped,
        pairs_integrated: end.pairs_integrated - created.pairs_integrated,
        searches: end.searches - created.searches,
        ..end
    };
    (gained, c)
}

#[test]
fn without_friction_no_slip_is_computed() {
    let none = Options { friction: Friction::None, mu: 0.0, ..options() };
    for weights in WEIGHTS {
        let (one, c) = run::<1>(Options { weights, ..none }, false);
        assert_eq!((one.nodes_slipping, c.multipliers(), c.components()), (0, 9, 1));
        let (chosen, c) = run::<3>(Options { weights, mu: 0.0, ..options() }, false);
        assert_eq!((chosen.nodes_slipping, c.multipliers(), c.components()), (0, 27, 3));
        // Residual, tangent; the commit computes it once more.
        let (full, _) = run::<3>(Options { weights, ..options() }, false);
        assert_eq!(full.nodes_slipping, (6 * 2 + 3) * 9);
        assert!(one.searches <= full.searches && one.pairs_linearised <= full.pairs_linearised);
    }
    for friction in [Friction::Tied, Friction::Rough] {
        let (counters, _) = run::<3>(Options { friction, mu: 0.0, ..options() }, false);
        assert_eq!(counters.nodes_slipping > 0, friction == Friction::Rough);
    }
}

/// Small sliding: after the creation nothing is searched, clipped, integrated or differentiated, and every evaluation
/// takes the weights there are.
#[test]
fn weights_of_the_reference_are_integrated_once() {
    let small = Options { weights: Weights::Reference, ..options() };
    for options in [small, Options { friction: Friction::Tied, mu: 0.0, ..options() }] {
        let (gained, c) = run::<3>(options, false);
        assert_eq!((gained.searches, gained.pairs_tested, gained.pairs_clipped, gained.pairs_integrated), (0, 0, 0, 0));
        assert_eq!(gained.pairs_linearised, 0);
        let pairs = c.active_pairs() as i64;
        assert!(pairs > 4);
        // Residual and tangent of six points; three commits.
        assert_eq!(gained.pairs_reused, (6 * 2 + 3) * pairs);
    }
    let (gained, _) = run::<3>(options(), false);
    // Six points; commits keep the pairs of theirs, and the point after a commit is that of the commit no more.
    assert_eq!((gained.searches, gained.pairs_reused), (6, 0));
    assert!(gained.pairs_linearised > 0);
    let (gained, _) = run::<3>(Options { weights: Weights::Committed, ..options() }, false);
    assert_eq!((gained.searches, gained.pairs_linearised), (3, 0), "the commits");
    assert!(gained.pairs_reused > 0);
}

/// A rigid mortar side: the same pairs, fewer entries and unknowns of the tangent.
#[test]
fn a_rigid_mortar_side_has_no_entries() {
    let count = |c: &mut Contact<3>| {
        let (x1, x2) = (c.surfaces().0.reference.clone(), c.surfaces().1.reference.clone());
        let mut entries = std::collections::BTreeSet::new();
        c.superset_pattern(&x1, &x2, &mut |i, j, _| _ = entries.insert((i, j))).unwrap();
        assert!(entries.iter().all(|&(i, j)| i >= 0 && j >= 0));
        entries.len()
    };
    let ((rigid, mut one), (full, mut two)) = (run::<3>(options(), true), run::<3>(options(), false));
    assert_eq!((rigid.searches, rigid.pairs_linearised), (full.searches, full.pairs_linearised));
    assert!(count(&mut one) * 3 < count(&mut two), "16 of 25 nodes have no rows and columns");
}

#[test]
fn without_friction_it_takes_less_memory() {
    let bytes = |options: Options, prescribed: bool| {
        if options.friction == Friction::None {
            run::<1>(options, prescribed).1.bytes()
        } else {
            run::<3>(options, prescribed).1.bytes()
        }
    };
    let none = Options { friction: Friction::None, mu: 0.0, ..options() };
    for options in [options(), Options { weights: Weights::Committed, ..options() }] {
        assert!(bytes(Options { weights: options.weights, ..none }, false) < bytes(options, false));
    }
}
