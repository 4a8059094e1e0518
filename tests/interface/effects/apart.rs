//! Surfaces that are apart cost a comparison of two boxes, and nothing is lost: what was left out of the history is
//! made up for when they come near.

use super::*;
use stickslip::interface::Friction;
use stickslip::law::State;

/// Heights of the upper surface over the lower one and slides, a step each: apart above the shorter of the longest
/// edges, 0.5; then near, closed, sliding; away and back.
const PATH: [(f64, f64); 11] = [
    (3.0, 0.0),
    (1.2, 0.1),
    (0.6, 0.1),
    (0.4, 0.1),
    (0.1, 0.12),
    (-0.01, 0.13),
    (-0.012, 0.16),
    (2.0, 0.2),
    (0.3, 0.2),
    (-0.01, 0.21),
    (-0.011, 0.25),
];
/// Height of the first configuration.
const START: f64 = 5.0;
/// Above this height the boxes are apart.
const REACH: f64 = 0.5;

/// An interface with the shortcut and one without, at the same place.
struct Pair<const N: usize> {
    short: Contact<N>,
    full: Contact<N>,
    meshes: [Mesh; 2],
    touching: usize,
}

impl<const N: usize> Pair<N>
where
    Contact<N>: Create<N>,
{
    fn new(options: Options) -> Pair<N> {
        let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], START, false, Cells::Quads);
        let two = grid(3, 3, [-0.6, -0.5], [1.6, 1.5], 0.0, true, Cells::Quads);
        let off = Options { shortcuts: Shortcuts { apart: false, ..options.shortcuts }, ..options };
        let (short, full) = (contact(&one, &two, false, options), contact(&one, &two, false, off));
        Pair { short, full, meshes: [one, two], touching: 0 }
    }

    /// Positions at a height and slid, somewhat tilted; multipliers as a converged step has them: none where the
    /// surfaces are apart.
    fn point(&self, (z, slide): (f64, f64)) -> (Vec<Vec3>, Vec<Vec3>, Vec<SVector<f64, N>>) {
        let [one, two] = &self.meshes;
        let at = |x: &Vec3| x + Vec3::new(slide, 0.5 * slide, z - START + 0.01 * (x.x - 0.5));
        let lambda = SVector::from_fn(|i, _| {
            if z > 0.0 {
                0.0
            } else if i == N - 1 {
                -0.8
            } else {
                0.25
            }
        });
        // N = 1: along nu, which points up into the upper body.
        (one.x.iter().map(at).collect(), two.x.clone(), vec![lambda; one.x.len()])
    }

    /// Residual and tangent of both are equal: to the bit where the surfaces are near.
    fn compare(&mut self, place: (f64, f64)) {
        let (x1, x2, lambda) = self.point(place);
        let [a, b] = [&mut self.short, &mut self.full].map(|c| c.residual(&x1, &x2, &lambda, None).unwrap());
        assert!(a == b, "{place:?}");
        let [ka, kb] = [&mut self.short, &mut self.full].map(|c| entries(c, (&x1, &x2, &lambda)));
        if place.0 < REACH {
            assert!(bits(&a) == bits(&b) && ka == kb, "{place:?}");
            let responses = self.short.responses(&x1, &x2, &lambda, None).unwrap();
            self.touching += responses.iter().filter(|r| r.state != State::Gap).count();
        }
    }

    fn commit(&mut self, place: (f64, f64)) {
        let (x1, x2, lambda) = self.point(place);
        self.short.commit(&x1, &x2, &lambda, None).unwrap();
        self.full.commit(&x1, &x2, &lambda, None).unwrap();
        if place.0 < REACH {
            assert_eq!(self.short.history(), self.full.history());
        }
    }

    fn export(&mut self) -> (Vec<i64>, Vec<f64>) {
        let [a, b] = [&mut self.short, &mut self.full].map(|c| c.export_history().unwrap());
        assert!(a == b, "what was left out is made up for");
        a
    }
}

fn laws() -> [Options; 2] {
    [Options { mu: 0.5, ..options() }, Options { friction: Friction::Rough, mu: 0.0, ..options() }]
}

fn frictionless() -> Options {
    Options { friction: Friction::None, mu: 0.0, ..options() }
}

#[test]
fn nothing_is_searched_and_commits_and_evaluations_are_counted() {
    let mut pair = Pair::<3>::new(options());
    for place in &PATH[..3] {
        pair.compare(*place);
        let (x1, x2, lambda) = pair.point(*place);
        assert_eq!(entries(&mut pair.short, (&x1, &x2, &lambda)).len(), 9 * 9, "the nodes' own blocks alone");
        pair.commit(*place);
    }
    let (short, full) = (pair.short.counters(), pair.full.counters());
    assert_eq!((short.pairs_tested, short.searches, short.pairs_clipped, short.pairs_linearised), (0, 0, 0, 0));
    assert!(full.pairs_tested > 0 && full.searches == 1 + 3 && full.pairs_linearised > 0);
    // Each step: an evaluation, which the tangent and the commit at the same positions share, and the commit's own.
    assert_eq!((short.evaluations_apart, short.commits_apart), (3, 1 + 3), "with the creation");
    assert_eq!((full.evaluations_apart, full.commits_apart), (0, 0));
    assert_eq!(pair.short.active_pairs(), 0);
    assert!(pair.short.bytes() < pair.full.bytes());
}

fn approach<const N: usize>(options: Options)
where
    Contact<N>: Create<N>,
{
    let mut pair = Pair::<N>::new(options);
    assert!(pair.short.initial_multipliers().unwrap() == pair.full.initial_multipliers().unwrap());
    for place in PATH {
        pair.compare(place);
        pair.commit(place);
    }
    assert!(pair.touching > 4 * 5, "{}", pair.touching);
    assert!(pair.short.counters().evaluations_apart > 0 && pair.full.counters().evaluations_apart == 0);
}

#[test]
fn surfaces_that_meet_answer_as_if_they_had_been_searched_all_the_time() {
    for form in FORMS {
        laws().into_iter().for_each(|options| approach::<3>(Options { form, ..options }));
        approach::<1>(Options { form, ..frictionless() });
    }
}

/// In one step from far away to touching, without a commit on the way.
#[test]
fn one_step_is_enough() {
    for options in laws() {
        let mut pair = Pair::<3>::new(options);
        for place in [PATH[0], PATH[5], PATH[1], PATH[6]] {
            pair.compare(place);
        }
        assert!(pair.touching > 0);
    }
}

fn rollback_and_restart<const N: usize>(options: Options)
where
    Contact<N>: Create<N>,
{
    // `apart` steps are committed while apart, the last of them undone; then near or not before the rollback.
    for near_before in [false, true] {
        let mut pair = Pair::<N>::new(options);
        pair.commit(PATH[0]);
        if near_before {
            pair.compare(PATH[4]);
        }
        pair.commit(PATH[1]);
        pair.short.roll_back().unwrap();
        pair.full.roll_back().unwrap();
        pair.compare(PATH[1]);
        pair.compare(PATH[5]);
        pair.commit(PATH[5]);
        pair.short.roll_back().unwrap();
        pair.full.roll_back().unwrap();
        pair.compare(PATH[6]);
    }

    let mut pair = Pair::<N>::new(options);
    pair.commit(PATH[0]);
    let (integers, reals) = pair.export();
    assert_eq!((integers.len(), reals.len()), pair.short.history_size().unwrap());
    let mut restarted = Pair::<N>::new(options);
    restarted.short.import_history(&integers, &reals).unwrap();
    restarted.full.import_history(&integers, &reals).unwrap();
    for place in &PATH[1..] {
        restarted.compare(*place);
        restarted.commit(*place);
        pair.compare(*place);
        pair.commit(*place);
        let histories = [&restarted.short, &restarted.full, &pair.full].map(|c| c.history().clone());
        assert!(place.0 > REACH || histories.iter().all(|h| h == pair.short.history()));
    }
}

#[test]
fn rollback_and_restart_while_apart() {
    rollback_and_restart::<3>(laws()[0]);
    rollback_and_restart::<1>(frictionless());
}

/// `set_previous` far away and the superset pattern of surfaces that are apart.
#[test]
fn another_t_n_and_the_pattern_while_apart() {
    let mut pair = Pair::<3>::new(options());
    let (x1, x2, _) = pair.point(PATH[1]);
    pair.short.set_previous(&x1, &x2).unwrap();
    pair.full.set_previous(&x1, &x2).unwrap();
    assert_eq!(pair.short.counters().commits_apart, 2);
    pair.compare(PATH[5]);
    let [a, b] = [&mut pair.short, &mut pair.full].map(|c| {
        let mut entries = std::collections::BTreeSet::new();
        c.superset_pattern(&x1, &x2, &mut |i, j, _| _ = entries.insert((i, j))).unwrap();
        entries
    });
    assert!(a == b && a.len() > 9 * 9, "the pattern is that of surfaces that may meet");
}

/// A Newton step may throw one surface through the other and far out on the other side: that is penetration, however
/// far, and not a gap.
#[test]
fn surfaces_that_have_passed_through_each_other_are_not_apart() {
    for from in [START, 0.4, -0.01] {
        let mut pair = Pair::<3>::new(Options { mu: 0.0, ..options() });
        if from < START {
            pair.commit((from, 0.0));
        }
        let (x1, x2, lambda) = pair.point((-2.0, 0.0));
        let [a, b] = [&mut pair.short, &mut pair.full].map(|c| c.residual(&x1, &x2, &lambda, None).unwrap());
        assert!(bits(&a) == bits(&b), "from {from}");
        let responses = pair.short.responses(&x1, &x2, &lambda, None).unwrap();
        assert!(responses.iter().all(|r| r.state != State::Gap && r.gap_normal < 0.0), "from {from}");
    }
}

/// A host that adds the sums of several handles gets every share, be it of a part that is far away.
#[test]
fn a_shared_handle_leaves_nothing_out() {
    let mut pair = Pair::<3>::new(Options { mu: 0.3, ..options() });
    let (x1, x2, _) = pair.point(PATH[0]);
    assert_eq!(pair.short.sums(&x1, &x2).unwrap()[0].coverage, 0.0);
    let [a, b] = [&mut pair.short, &mut pair.full].map(|c| c.share_of_sums(&x1, &x2).unwrap());
    assert_eq!(a, b);
    assert!(a[0].coverage > 0.0);
    assert_eq!(pair.short.sums(&x1, &x2).unwrap()[0].coverage, 0.0, "a share asked for changes no other call");
}

/// What an evaluation gives depends on its point, not on whether t_n was made up for in between.
#[test]
fn made_up_history_changes_no_evaluation() {
    let mut pair = Pair::<3>::new(Options { mu: 0.3, ..options() });
    let (x1, x2, lambda) = pair.point(PATH[0]);
    let before = (pair.short.sums(&x1, &x2).unwrap(), entries(&mut pair.short, (&x1, &x2, &lambda)));
    let (near, under, _) = pair.point(PATH[4]);
    pair.short.sums(&near, &under).unwrap();
    pair.short.history_size().unwrap();
    let after = (pair.short.sums(&x1, &x2).unwrap(), entries(&mut pair.short, (&x1, &x2, &lambda)));
    assert!(before == after);
}

/// What surfaces at some place look like: tilted, warped, either way round.
fn placed(mesh: &Mesh, random: &mut Random, warp: f64, turn: f64, shift: Vec3) -> Vec<Vec3> {
    let turn = Rotation3::new(random.vector(turn));
    mesh.x.iter().map(|x| turn * (x + random.vector(warp)) + shift).collect()
}

/// Over random placements at t_n and now, in front of each other, behind, beside and through: where the library finds the
/// surfaces apart the full search finds every node open without a multiplier, and elsewhere the same bits.
#[test]
fn tilted_and_warped_placements_answer_alike() {
    let mut random = Random(21);
    let (mut apart, mut touching, mut behind) = (0, 0, 0);
    for round in 0..3000 {
        // A facet is half as long as the surface of four.
        let ways = (round % 2 == 0, round % 4 < 2);
        let mut one = grid(2, 2, [-0.5, -0.5], [0.5, 0.5], 0.0, ways.0, Cells::Quads);
        let mut two = grid(2, 2, [-0.6, -0.55], [0.5, 0.6], 0.0, ways.1, CELLS[1][0]);
        let (warp, turn) = ([0.0, 0.05][round % 5 % 2], [0.2, 0.7, 3.0][round % 3]);
        let far = |random: &mut Random| Vec3::new(0.4 * random.next(), 0.4 * random.next(), 2.0 * random.next());
        let shift = far(&mut random);
        (one.x, two.x) =
            (placed(&one, &mut random, warp, turn, shift), placed(&two, &mut random, warp, turn, Vec3::zeros()));
        let off = Options { shortcuts: Shortcuts { apart: false, ..options().shortcuts }, ..options() };
        let (mut short, mut full) = (contact::<3>(&one, &two, false, options()), contact::<3>(&one, &two, false, off));
        // Half of the steps are small.
        let (step, by) = if round % 7 < 4 { (0.05, 0.1) } else { (2.0, 1.0) };
        let shift = far(&mut random) * by;
        let x1 = placed(&one, &mut random, 0.2 * warp, step, shift);
        for lambda in [vec![Vec3::zeros(); 9], (0..9).map(|_| random.vector(1.0)).collect()] {
            let [a, b] = [&mut short, &mut full].map(|c| c.residual(&x1, &two.x, &lambda, None).unwrap());
            let found = short.counters().evaluations_apart > 0;
            if !found {
                assert!(bits(&a) == bits(&b), "round {round}");
                let at = (&x1[..], &two.x[..], &lambda[..]);
                assert!(entries(&mut short, at) == entries(&mut full, at), "round {round}");
                touching +=
                    full.responses(&x1, &two.x, &lambda, None).unwrap().iter().filter(|r| r.traction.z != 0.0).count();
            } else if lambda[0] == Vec3::zeros() {
                assert!(a == b, "round {round}: {:?}", b);
                let states = full.responses(&x1, &two.x, &lambda, None).unwrap();
                assert!(states.iter().all(|r| r.state == State::Gap), "round {round}");
                apart += 1;
            }
        }
        behind += usize::from(full.counters().pairs_tested > 0 && ways.0 == ways.1);
    }
    assert!(apart > 200 && touching > 1000 && behind > 100, "all of them occur: {apart}, {touching}, {behind}");
}
