//! What the library chooses by itself changes no bit of the residual: mu = 0 at every node, a prescribed mortar side.
//! It says what it has chosen.

use super::*;
use stickslip::error::Kind;
use stickslip::interface::{Friction, MortarSide, Wishes};

/// Tangents of the two ways to compute: rounding, relative to the largest entry.
const ROUNDING: f64 = 1e-13;

/// The tangent as a full matrix over n unknowns.
fn matrix(c: &mut Contact<3>, scene: &Moved) -> Vec<f64> {
    let n = 3 * (2 * scene.x1.len() + scene.x2.len());
    let mut k = vec![0.0; n * n];
    let mut add = |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v;
    c.tangent(&scene.x1, &scene.x2, &scene.lambda, None, &mut add).unwrap();
    k
}

/// mu = 0 for two steps, then friction: as if every slip had been computed from the beginning, but for the slip that is
/// reported.
#[test]
fn without_friction_and_with_friction_from_the_middle_on() {
    for options in variants(Options { mu: 0.0, ..options() }) {
        let mut scene = moved(&options, CELLS[0], ROUGH, 3);
        let mut short: Contact<3> = again(&scene, false, options);
        let mut full: Contact<3> = again(&scene, false, Options { shortcuts: NO_SHORTCUTS, ..options });
        // Constrained nodes too: their multiplier has no part along.
        let directions: Vec<_> = (0..9).step_by(4).map(|a| (a, along())).collect();
        short.set_constraints(&directions).unwrap();
        full.set_constraints(&directions).unwrap();
        for step in 0..5 {
            if step == 2 {
                short.set_friction(vec![0.4; 9]).unwrap();
                full.set_friction(vec![0.4; 9]).unwrap();
            }
            let lambda = scene.lambda.clone();
            let (a, b) =
                [&mut short, &mut full].map(|c| c.residual(&scene.x1, &scene.x2, &lambda, None).unwrap()).into();
            assert!(bits(&a) == bits(&b), "{:?}, {:?}: step {step}", options.form, options.weights);
            let (a, b) = [&mut short, &mut full].map(|c| matrix(c, &scene)).into();
            let scale = crate::support::max_abs(b.iter().copied());
            let error = crate::support::max_abs(a.iter().zip(&b).map(|(a, b)| a - b)) / scale;
            assert!(error <= ROUNDING, "{:?}, {:?}: step {step}, tangent {error:e}", options.form, options.weights);
            short.commit(&scene.x1, &scene.x2, &lambda, None).unwrap();
            full.commit(&scene.x1, &scene.x2, &lambda, None).unwrap();
            scene.x1 = shifted(&scene.x1, along() * 0.06);
        }
        // Nine nodes in each of the three steps with friction, which evaluate thrice.
        assert_eq!(short.counters().nodes_slipping, 3 * 3 * 9);
        assert_eq!(full.counters().nodes_slipping, 5 * 3 * 9);
    }
}

/// One node with friction is enough for the slip of all; none, and it is left out again.
#[test]
fn friction_may_come_and_go() {
    let mut scene = moved(&Options { mu: 0.0, ..options() }, CELLS[0], FLAT, 3);
    let count = |c: &mut Contact<3>| {
        let before = c.counters().nodes_slipping;
        c.residual(&scene.x1, &scene.x2, &scene.lambda, None).unwrap();
        c.counters().nodes_slipping - before
    };
    let c = &mut scene.interface;
    assert_eq!(count(c), 0);
    let mut mu = vec![0.0; 9];
    mu[4] = 0.1;
    c.set_friction(mu).unwrap();
    assert_eq!(count(c), 9);
    c.set_friction(vec![0.0; 9]).unwrap();
    assert_eq!(count(c), 0);
}

#[test]
fn friction_of_another_law_is_refused() {
    for friction in [Friction::Tied, Friction::Rough] {
        let scene = moved(&options(), CELLS[0], FLAT, 3);
        let mut c: Contact<3> = again(&scene, false, Options { friction, mu: 0.0, ..options() });
        assert_eq!(c.set_friction(vec![0.5; 9]).unwrap_err().kind, Kind::InvalidValue);
    }
}

/// Every effect has its sentence; what is chosen and what was asked for is told apart.
#[test]
fn it_says_what_it_computes_and_why() {
    let scene = moved(&options(), CELLS[0], FLAT, 3);
    let says = |prescribed: bool, options: Options, words: &[&str]| {
        let text = if options.friction == Friction::None {
            again::<1>(&scene, prescribed, options).effects().unwrap()
        } else {
            again::<3>(&scene, prescribed, options).effects().unwrap()
        };
        // Tied surfaces use no normals; where nodes are carried, that is told.
        let carried = usize::from(options.effective_weak_coverage() > 0.0);
        let sentences = carried + if options.friction == Friction::Tied { 7 } else { 8 };
        assert_eq!(text.matches(". ").count() + 1, sentences, "{text}");
        assert!(text.is_ascii() && text.len() < 700, "{text}");
        for word in words {
            assert!(text.contains(word), "'{word}' is not in: {text}");
        }
    };
    let of = |friction| Options { friction, mu: 0.0, ..options() };
    let coulomb = of(Friction::Coulomb);
    says(false, options(), &["Coulomb's law with mu 0.7; three multipliers", "Mortar side: deformable.", "of now"]);
    says(false, coulomb, &["none (chosen: mu is 0 at every node)"]);
    says(
        false,
        Options { shortcuts: NO_SHORTCUTS, ..coulomb },
        &["Coulomb's law with mu 0;", "searched all the same", "the law all the same"],
    );
    says(
        false,
        of(Friction::None),
        &["none (asked for)", "one multiplier a node", "boxes and normals are compared (chosen)", "no law (chosen)"],
    );
    says(
        false,
        of(Friction::Tied),
        &["tied (asked for)", "first configuration (tied)", "frozen weights need no search"],
    );
    says(false, of(Friction::Rough), &["rough (asked for)"]);
    says(true, options(), &["rigid (chosen: no mortar node has an equation)"]);
    says(
        true,
        Options { shortcuts: NO_SHORTCUTS, ..options() },
        &["as deformable though no node of it has an equation"],
    );
    says(true, Options { mortar_side: MortarSide::Rigid, ..options() }, &["rigid (asked for)"]);
    says(false, Options { weights: Weights::Committed, ..options() }, &["frozen at the last commit (asked for)"]);
    says(
        false,
        Options { weights: Weights::Reference, ..options() },
        &["frozen at the first configuration (asked for)"],
    );

    let chosen = Options::new(options().stiffness);
    says(false, chosen, &["Multipliers: dual.", "Normals: of now"]);
    let frozen = Wishes { weights: Some(Weights::Committed), ..Wishes::default() };
    says(false, chosen.settle(frozen), &["last commit (chosen: the weights are frozen)"]);
    says(false, options(), &["Multipliers: standard.", "of the last commit (asked for)"]);

    let mut some: Contact<3> = again(&scene, false, coulomb);
    let mut mu = vec![0.0; 9];
    mu[4] = 0.25;
    some.set_friction(mu).unwrap();
    assert!(some.effects().unwrap().contains("mu from 0 to 0.25"), "{}", some.effects().unwrap());
}
