//! Without friction there is no slip history: no gaps, no slip, and weights of t_n only where they are frozen. Residual
//! and restart do not miss it.

use super::*;
use nalgebra::Vector1;
use stickslip::error::Kind;
use stickslip::interface::{Friction, seal_history};

/// Integers before the list of pairs.
const HEADER: usize = 13;

fn one(weights: Weights) -> Options {
    Options { friction: Friction::None, mu: 0.0, weights, ..options() }
}

struct Step {
    c: Contact<1>,
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    lambda: Vec<Vector1<f64>>,
}

impl Step {
    fn new(weights: Weights) -> Step {
        let scene = moved(&options(), CELLS[0], ROUGH, 3);
        let mut random = Random(5);
        let lambda = (0..9).map(|_| Vector1::new(random.next() - 0.5)).collect();
        Step { c: again(&scene, false, one(weights)), x1: scene.x1, x2: scene.x2, lambda }
    }

    fn commit_and_slide(&mut self) {
        self.c.commit(&self.x1, &self.x2, &self.lambda, None).unwrap();
        self.x1 = shifted(&self.x1, along() * 0.11);
    }

    fn evaluate(&mut self) -> (Vec<u64>, Vec<(i64, i64, u64)>) {
        let r = self.c.residual(&self.x1, &self.x2, &self.lambda, None).unwrap();
        (bits(&r), entries(&mut self.c, (&self.x1, &self.x2, &self.lambda)))
    }
}

#[test]
fn it_is_shorter() {
    for weights in WEIGHTS {
        let mut s = Step::new(weights);
        assert!(s.c.active_pairs() > 4, "a host looks at the pairs right after the creation");
        for _ in 0..2 {
            s.commit_and_slide();
            s.evaluate();
            let h = s.c.history();
            assert!(h.gap.is_empty() && h.slip.is_empty());
            assert_eq!(h.pairs.is_empty(), weights == Weights::Current);
            let pairs = h.pairs.len();
            // Where weights are frozen for good, what positions they are of.
            let places = if weights == Weights::Reference { 3 * (9 + 16) } else { 0 };
            // x1, normals, areas, coverage of 9 nodes, x2 of 16, weights.
            let reals = 9 * (3 + 3 + 1 + 1) + 16 * 3 + places + 32 * pairs;
            assert_eq!(s.c.history_size().unwrap(), (HEADER + 1 + 2 * pairs, reals));
        }
        let mut three = moved(&Options { weights, ..options() }, CELLS[0], ROUGH, 3);
        three.interface.commit(&three.x1, &three.x2, &three.lambda, None).unwrap();
        three.interface.residual(&three.x1, &three.x2, &three.lambda, None).unwrap();
        let mut single = Step::new(weights);
        single.c.commit(&single.x1, &single.x2, &single.lambda, None).unwrap();
        single.evaluate();
        assert!(single.c.bytes() < three.interface.bytes(), "{weights:?}");
    }
}

#[test]
fn rollback_and_restart_continue_bit_for_bit() {
    for weights in WEIGHTS {
        let mut s = Step::new(weights);
        s.commit_and_slide();
        let (before, history) = (s.evaluate(), s.c.history().clone());
        s.c.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
        assert_ne!(*s.c.history(), history);
        s.c.roll_back().unwrap();
        assert_eq!(*s.c.history(), history);
        assert!(s.evaluate() == before, "{weights:?}");
        assert_eq!(s.c.roll_back().unwrap_err().kind, Kind::NothingToRollBack);

        let (integers, reals) = s.c.export_history().unwrap();
        assert_eq!((integers.len(), reals.len()), s.c.history_size().unwrap());
        let mut restarted = Step::new(weights);
        restarted.c.import_history(&integers, &reals).unwrap();
        (restarted.x1, restarted.x2) = (s.x1.clone(), s.x2.clone());
        assert!(restarted.evaluate() == before, "{weights:?}");
        assert_eq!(restarted.c.history(), s.c.history());
    }
}

/// A history that lacks what the interface needs, or holds what it does not know, is refused by name.
#[test]
fn histories_of_other_effects_are_refused() {
    let scene = moved(&options(), CELLS[0], ROUGH, 3);
    let mut with_slip: Contact<3> = again(&scene, false, options());
    let (integers, reals) = with_slip.export_history().unwrap();
    let refused = |outcome: stickslip::error::Result<()>, words: [&str; 2]| {
        let error = outcome.unwrap_err();
        assert_eq!(error.kind, Kind::HistoryMismatch);
        assert!(words.iter().all(|w| error.message.contains(w)), "{}", error.message);
    };
    let mut all = WEIGHTS.map(Step::new);
    let exported: Vec<_> = all.iter_mut().map(|s| s.c.export_history().unwrap()).collect();
    let names = ["weights of now", "weights frozen at the last commit", "weights of the first configuration"];
    for (k, s) in all.iter_mut().enumerate() {
        let before = s.c.history().clone();
        refused(s.c.import_history(&integers, &reals), ["the history is one with Coulomb's law", "no friction"]);
        for other in (0..3).filter(|&other| other != k) {
            let (integers, reals) = &exported[other];
            refused(s.c.import_history(integers, reals), [names[other], names[k]]);
        }
        assert_eq!(*s.c.history(), before);
        refused(with_slip.import_history(&exported[k].0, &exported[k].1), ["no friction", "Coulomb's law"]);
    }

    let (integers, reals) = &exported[0];
    let corrupt = |at: usize, value: i64| {
        let mut wrong = integers.clone();
        wrong[at] = value;
        seal_history(&mut wrong, reals);
        wrong
    };
    // Layout, law, weights, slip, facets, coordinates, commits, nodes, pairs.
    let wrong = [(0, 7), (2, 0), (4, 1), (5, 1), (8, 0), (9, 0), (10, -1), (11, 3), (12, 1), (13, 1), (13, -1)];
    for (at, value) in wrong.into_iter().chain([(13, i64::MAX)]) {
        assert_eq!(
            all[0].c.import_history(&corrupt(at, value), reals).unwrap_err().kind,
            Kind::HistoryMismatch,
            "{at}"
        );
    }
    assert_eq!(all[0].c.import_history(integers, &reals[1..]).unwrap_err().kind, Kind::HistoryMismatch);
    all[0].c.import_history(integers, reals).unwrap();
}

/// Layers of the mortar surface are settled though the history keeps no weights.
#[test]
fn layers_are_settled_all_the_same() {
    let upper = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let mut lower = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], -0.1, true, Cells::Quads);
    let second = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], -0.4, true, Cells::Quads);
    lower.x.extend(second.x);
    lower.facets.push(second.facets[0].iter().map(|k| k + 4).collect());
    let surface = |side, m: &Mesh, first| {
        stickslip::interface::Surface::new(side, m.x.clone(), &m.facets, numbered(first, m.x.len())).unwrap()
    };
    let (one_surface, two_surface) = (surface("nonmortar", &upper, 0), surface("mortar", &lower, 12));
    let mut near = Contact::frictionless(one_surface, two_surface, numbered(36, 4), one(Weights::Current)).unwrap();
    let lambda = [Vector1::new(-1.0); 4];
    let expected = near.residual(&upper.x, &lower.x, &lambda, None).unwrap();
    let given: f64 = expected.mortar[..4].iter().map(|f| f.z).sum();
    assert!((given.abs() - 1.0).abs() < 1e-14 && expected.mortar[4..].iter().all(|f| *f == Vec3::zeros()));

    // Far away at first: found when they come near.
    let far = Mesh { x: shifted(&upper.x, Vec3::z() * 50.0), ..upper.clone() };
    let mut c = Contact::frictionless(
        surface("nonmortar", &far, 0),
        surface("mortar", &lower, 12),
        numbered(36, 4),
        one(Weights::Current),
    )
    .unwrap();
    for _ in 0..2 {
        let found = c.residual(&upper.x, &lower.x, &lambda, None).unwrap();
        assert_eq!(
            (&found.nonmortar, &found.mortar, &found.rows),
            (&expected.nonmortar, &expected.mortar, &expected.rows)
        );
    }
}
