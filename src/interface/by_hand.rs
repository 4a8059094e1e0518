//! Each stage called by itself, without a handle: two facets, a quad of 1 x 1 that has sunk 0.001 into a larger one below.

use super::data::active::Active;
use super::data::effects::Effects;
use super::data::extent::{Extent, Scope};
use super::data::history::History;
use super::data::options::{Normals, Options, Stiffness};
use super::data::pairs::PairRecord;
use super::data::setup::Setup;
use super::data::surface::{NO_EQUATION, Surface};
use super::pairing::given::{Given, Step};
use super::pairing::settle::Pairing;
use super::pairing::work::Work;
use super::plan::numbering::{Nodes, Numbering, Sides};
use super::plan::pattern::System;
use super::plan::whole::Plan;
use super::stages::commit;
use super::stages::initial::initial_multipliers;
use super::stages::integrate::integrate;
use super::stages::residual::residual;
use super::stages::respond::{Responses, respond};
use super::stages::sums::{NodeSums, sums};
use super::tangent::blocks::{Room, blocks};
use super::tangent::by_equations::{ByEquations, Numbers};
use super::tangent::task::Task;
use super::tangent::union::{Pairs, Walk};
use crate::geometry::Vec3;
use crate::law::State;
use crate::mortar::PairWeights;

const DEPTH: f64 = 1e-3;
/// A few roundings of numbers of size 1.
const ROUNDING: f64 = 1e-14;

fn setup() -> Setup<3> {
    let x1 = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)].map(|(x, y)| Vec3::new(x, y, -DEPTH)).to_vec();
    let x2 = [(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    let equations = |first: i64| (0..4).map(|a| [0, 1, 2].map(|i| first + 3 * a + i)).collect::<Vec<_>>();
    let one = Surface::new("nonmortar", x1, &[vec![0, 1, 2, 3]], equations(0)).unwrap();
    let two = Surface::new("mortar", x2, &[vec![0, 1, 2, 3]], vec![[NO_EQUATION; 3]; 4]).unwrap();
    let options = Options { mu: 0.3, ..Options::paper(Stiffness::Modulus(1000.0)) };
    let mu = vec![0.3; 4];
    let effects = Effects::of_three(&options, &two, &mu, None, false);
    Setup::new((one, two), equations(12), options, mu, effects).unwrap()
}

fn step(setup: &Setup<3>) -> Step {
    let at = (&setup.nonmortar.reference[..], &setup.mortar.reference[..]);
    let (work, active) = (&mut Work::default(), &mut Active::default());
    let (known, history) = (commit::Known { active, filter: None }, History::empty());
    let start = commit::settled_at(setup.surfaces(), &setup.options, Extent::Whole, work, at, known, history).unwrap();
    let pairing = Pairing::new(setup, start.filter, &start.history).unwrap();
    Step { history: start.history, pairing, normals: Normals::Committed, now: None, room: Default::default() }
}

#[test]
fn an_evaluation_stage_by_stage() {
    let setup = setup();
    let step = step(&setup);
    let given = Given { setup: &setup, step: &step };
    let x = (&setup.nonmortar.reference[..], &setup.mortar.reference[..]);
    assert!(step.pairing.coverable == [true; 4] && step.pairing.carriers.is_empty());

    let filter = step.pairing.filter.as_ref().unwrap();
    let (work, mut active) = (&mut Work::default(), Active::default());
    integrate(setup.surfaces(), &setup.options, filter, work, x, &mut active, None).unwrap();
    assert_eq!(active.pairs.iter().map(|p| (p.one, p.two)).collect::<Vec<_>>(), [(0, 0)]);
    let area: f64 = (0..4).map(|a| active.pairs[0].weights.coverage(a)).sum();
    assert!((area - 1.0).abs() < ROUNDING, "{area}");

    let mut all = Vec::new();
    sums(given, Some(&active), true, x, &mut all).unwrap();
    let sums = all;
    for sum in &sums {
        assert!((sum.coverage - 0.25).abs() < ROUNDING && (sum.gap_now.z + 0.25 * DEPTH).abs() < ROUNDING, "{sum:?}");
    }

    let lambda = initial_multipliers(given, &sums).unwrap();
    let scope = Scope { extent: Extent::Whole, apart: false };
    let mut responses = Responses::default();
    respond((given, Some(&active)), &lambda, &sums, scope, &mut responses).unwrap();
    assert!(responses.nodes.iter().all(|r| r.state == State::Stick) && responses.counts.frictional == 4);

    let forces = residual(given, active.weighted(setup.surfaces()), &lambda, &responses.nodes).unwrap();
    let total: Vec3 = forces.nonmortar.iter().chain(&forces.mortar).sum();
    assert!(total.norm() < ROUNDING, "{total}");
    assert!(forces.rows.iter().all(|row| (row.z + 0.05).abs() < ROUNDING), "r_A M_A g_N: {:?}", forces.rows);

    let pairs = Pairs::Union([&active.pairs, &step.history.pairs]);
    let mut entries = 0;
    let mut count = |_: i64, _: i64, _: f64| entries += 1;
    let task = Task { given, normals: &[Vec3::zeros(); 4], pairs, extent: Extent::Whole, moves: false, numbers: None };
    blocks(task, &mut Room::default(), (&mut ByEquations::new(&setup, Numbers::of(&setup), &mut count), None)).unwrap();
    // 12 x 12 of the forces, 3 x 16 of the multipliers in them, 12 x 12 of the rows, 4 x 9 of the nodes.
    assert_eq!(entries, 372);
    let numbering = Numbering::of(Nodes::of(Sides::of(&setup))).unwrap();
    let plan =
        Plan::new((Sides::of(&setup), &numbering), System::Whole, pairs, (Vec::new(), true), &|_| false).unwrap();
    // The four rows of multipliers have each other as columns, too, of which each has its own alone: no block twice here.
    assert_eq!(plan.len(), 372);
}

#[test]
fn what_nothing_covers_is_answered_without_the_law() {
    let setup = setup();
    let step = step(&setup);
    let given = Given { setup: &setup, step: &step };
    let lambda = [Vec3::new(0.0, 0.0, -2.0); 4];
    let scope = Scope { extent: Extent::Whole, apart: true };
    let mut responses = Responses::default();
    respond((given, None), &lambda, &[NodeSums::default(); 4], scope, &mut responses).unwrap();
    assert_eq!(responses.counts.left_out, 4);
    let row = Vec3::new(0.0, 0.0, 2.0 / given.augmentation(0));
    assert!(responses.nodes.iter().all(|r| r.state == State::Gap && r.row == row));
}

#[test]
fn the_union_merges_pairs_of_now_and_of_the_last_step() {
    let pair = |one, two| PairRecord { one, two, weights: PairWeights::default() };
    let (now, previous) = ([pair(0, 1), pair(2, 0)], [pair(0, 0), pair(0, 1), pair(1, 5)]);
    let of = |pairs: Pairs| {
        let (mut walk, mut of_facet, mut found) = (Walk::through(pairs, 0..usize::MAX), Vec::new(), Vec::new());
        while let Some(f) = walk.next(&mut of_facet).unwrap() {
            assert!(of_facet.iter().all(|p| p.one == f));
            found.extend(of_facet.iter().map(|p| (p.one, p.two, p.place, p.is_active, p.previous)));
        }
        found
    };
    let expected =
        [(0, 0, 0, false, Some(0)), (0, 1, 0, true, Some(1)), (1, 5, 1, false, Some(2)), (2, 0, 1, true, None)];
    assert_eq!(of(Pairs::Union([&now, &previous])), expected);
    assert_eq!(of(Pairs::Union([&now, &[]])).len(), 2);
    assert_eq!(of(Pairs::Possible(&[(0, 3), (4, 1)])), [(0, 3, 0, true, Some(0)), (4, 1, 1, true, Some(1))]);
}
