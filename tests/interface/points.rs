//! Deciding at points (docs/formulation 16): the tangent against differences, momentum, sums over points by brute force, closed
//! and open facets, the patch test's equations, history, what is refused.

use crate::support::differences::Point;
use crate::support::lines::*;
use crate::support::max_abs;
use crate::support::mesh::*;
use nalgebra::SVector;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Decision, Form, Friction, MultiplierBasis, Normals, Options, Owner, RowScale, Scheme, Stiffness, Weights,
};
use stickslip::law::State;
use stickslip::line::Measure;
use stickslip::quadrature::{DEGREE_10, line};

const MODULUS: f64 = 30.0;
/// Differences: truncation 1e-12 and rounding 1e-10 of a step of 1e-6.
const DIFFERENCES: f64 = 1e-7;
/// Sums of some dozen products, over the largest.
const ROUNDING: f64 = 1e-13;
/// Much more than rhat times any gap here.
const PRESSED: f64 = 100.0;
const CELLS: [[Cells; 2]; 4] = [
    [Cells::Quads, Cells::Quads],
    [Cells::Triangles, Cells::Triangles],
    [Cells::Quads, Cells::Triangles],
    [Cells::Triangles, Cells::Quads],
];
const WEIGHTS: [Weights; 3] = [Weights::Current, Weights::Committed, Weights::Reference];

fn by_points(weights: Weights) -> Options {
    let of = Options::paper(Stiffness::Modulus(MODULUS));
    let (basis, decision) = (MultiplierBasis::Dual, Decision::Points(MODULUS));
    Options { basis, decision, weights, friction: Friction::None, ..of }
}

struct Scene {
    contact: Contact<1>,
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    lambda: Vec<SVector<f64, 1>>,
}

/// That of [`moved`] without friction, multipliers of both signs.
fn scene(options: Options, cells: [Cells; 2], rough: Roughness, seed: u64) -> Scene {
    let m = moved(&crate::support::mesh::options(), cells, rough, seed);
    let (one, two) = m.interface.surfaces();
    let contact = contact::<1>(&mesh_of(one), &mesh_of(two), false, options);
    let mut random = Random(seed);
    // Of both signs, and of some seeds mostly pressed.
    let mean = if seed == 8 { -2.5 } else { -0.1 };
    let lambda = (0..m.x1.len()).map(|_| SVector::from([mean + 0.5 * random.next()])).collect();
    Scene { contact, x1: m.x1, x2: m.x2, lambda }
}

impl Scene {
    fn error(&mut self) -> f64 {
        let Scene { contact, x1, x2, lambda } = self;
        Point { contact, x1, x2, lambda }.difference_error(0.0)
    }

    /// Open, cut and closed nodes.
    fn shares(&mut self) -> [usize; 3] {
        let r = self.contact.responses(&self.x1, &self.x2, &self.lambda, None).unwrap();
        let mut count = [0; 3];
        for (a, r) in r.iter().enumerate() {
            let share = self.contact.closed_share(a);
            assert!((-ROUNDING..1.0 + ROUNDING).contains(&share) && (share > 0.0) == (r.state != State::Gap));
            count[if share == 0.0 {
                0
            } else if share < 1.0 - ROUNDING {
                1
            } else {
                2
            }] += 1;
        }
        count
    }
}

#[test]
fn tangents_are_those_of_differences_for_every_kind_on_every_kind() {
    let mut seen = [0; 3];
    for (weights, cells) in WEIGHTS.into_iter().flat_map(|w| CELLS.map(|cells| (w, cells))) {
        for (slide, seed) in [(0.02, 3), (0.02, 8), (1.3, 5)] {
            for rough in [FLAT, Roughness { warp: 0.03, jitter: 0.08, slide }] {
                let row_scale = if seed == 8 { RowScale::None } else { RowScale::Force };
                // The derivatives of a rule's sums have the rule's error on quadrilaterals that are no parallelograms.
                let of = by_points(weights);
                let rule = if weights == Weights::Current { &DEGREE_10 } else { of.rule };
                let mut s = scene(Options { row_scale, rule, ..of }, cells, rough, seed);
                s.shares().iter().zip(&mut seen).for_each(|(n, seen)| *seen += n);
                let error = s.error();
                assert!(error <= DIFFERENCES, "{weights:?} {seed}: {error:e}");
                if weights != Weights::Reference {
                    let (x1, x2) = (s.x1.clone(), s.x2.clone());
                    s.contact.commit(&x1, &x2, &s.lambda, None).unwrap();
                    let error = s.error();
                    assert!(error <= DIFFERENCES, "after a commit {seed}: {error:e}");
                }
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 20), "open, cut, closed: {seen:?}");
}

/// Normals and weights of now, with offsets of both sides that differ from node to node.
#[test]
fn tangents_with_normals_of_now_and_offsets_are_those_of_differences() {
    let now = Options { normals: Normals::Current, rule: &DEGREE_10, ..by_points(Weights::Current) };
    let rough = Roughness { warp: 0.03, jitter: 0.08, slide: 0.02 };
    let raise = |contact: &mut Contact<1>, (n1, n2): (usize, usize), seed: u64| {
        let mut random = Random(seed);
        let mut some = |n: usize| Some((0..n).map(|_| 0.02 * random.next()).collect());
        contact.set_offsets([some(n1), some(n2)]).unwrap();
    };
    for (cells, of) in CELLS
        .into_iter()
        .flat_map(|c| [now, Options { rule: &DEGREE_10, ..by_points(Weights::Current) }].map(|of| (c, of)))
    {
        for seed in [3, 5, 8] {
            let mut s = scene(of, cells, rough, seed);
            let error = s.error();
            assert!(error <= DIFFERENCES, "{:?} {seed}: {error:e}", of.normals);
            raise(&mut s.contact, (s.x1.len(), s.x2.len()), seed);
            let error = s.error();
            assert!(error <= DIFFERENCES, "{:?} {seed}, with offsets: {error:e}", of.normals);
        }
    }
    for (measure, normals) in [Measure::Thickness(0.7), Measure::Axisymmetric]
        .into_iter()
        .flat_map(|m| [(m, Normals::Current), (m, Normals::Committed)])
    {
        for seed in 1..5 {
            let mut s = moved_lines::<1>(&Options { normals, ..now }, [2, 2], measure, seed);
            let error = s.difference_error();
            assert!(error <= DIFFERENCES, "{measure:?} {normals:?} {seed}: {error:e}");
            raise(&mut s.contact, (s.x1.len(), s.x2.len()), seed);
            let error = s.difference_error();
            assert!(error <= DIFFERENCES, "{measure:?} {normals:?} {seed}, with offsets: {error:e}");
        }
    }
}

#[test]
fn tangents_of_lines_are_those_of_differences() {
    let measures = [Measure::Thickness(0.7), Measure::Axisymmetric];
    for (measure, weights) in measures.into_iter().flat_map(|m| WEIGHTS.map(|w| (m, w))) {
        for seed in 1..5 {
            let mut s = moved_lines::<1>(&by_points(weights), [2, 2], measure, seed);
            let error = s.difference_error();
            assert!(error <= DIFFERENCES, "{measure:?} {weights:?} {seed}: {error:e}");
        }
    }
}

/// With weights that are held and all facets closed the residual is linear in positions and multipliers: the tangent says exactly what any
/// step changes, and what it has not (`tangent/slopes.rs`) is nothing.
#[test]
fn tangents_of_closed_facets_are_exact_over_steps_of_any_size() {
    for (weights, cells) in [Weights::Committed, Weights::Reference].into_iter().flat_map(|w| CELLS.map(|c| (w, c))) {
        for (slide, seed) in [(0.02, 3), (0.3, 8), (1.3, 5)] {
            let mut s = scene(by_points(weights), cells, Roughness { warp: 0.03, jitter: 0.08, slide }, seed);
            s.lambda.iter_mut().for_each(|lambda| lambda[0] -= PRESSED);
            let [_, cut, closed] = s.shares();
            assert!(cut == 0 && closed > 3, "{weights:?} {seed}: {closed} closed nodes, {cut} cut ones");
            let (mut random, Scene { contact, x1, x2, lambda }) = (Random(seed + 1), &mut s);
            let mut point = Point { contact, x1, x2, lambda };
            let step: Vec<_> = (0..point.unknowns()).map(|_| 0.1 * random.next()).collect();
            let error = point.linear_error(&step);
            assert!(error <= ROUNDING, "{weights:?} {seed}: {error:e}");
        }
    }
}

/// Newton's matrix of a plan, in two numbers of threads, is that of entries one by one.
#[test]
fn a_plan_has_the_same_tangent() {
    let of = |weights: Weights| [(1, CELLS[0], weights), (3, CELLS[2], weights)];
    for (threads, cells, weights) in of(Weights::Committed).into_iter().chain(of(Weights::Current)) {
        let mut s = scene(Options { threads, ..by_points(weights) }, cells, FLAT, 3);
        let Scene { contact, x1, x2, lambda } = &mut s;
        let error = Point { contact, x1, x2, lambda }.plan_error();
        assert!(error <= ROUNDING, "{error:e}");
    }
}

/// Forces add up to nothing, and so do their moments where the surfaces are where the weights are of: those of now anywhere.
#[test]
fn momentum_is_kept() {
    let of = |weights: Weights| CELLS.into_iter().flat_map(move |c| [(c, 3, weights), (c, 8, weights)]);
    for (cells, seed, weights) in of(Weights::Committed).chain(of(Weights::Current)) {
        let rough = Roughness { warp: 0.03, jitter: 0.08, slide: 0.3 };
        let mut s = scene(by_points(weights), cells, rough, seed);
        let (x1, x2) = (s.x1.clone(), s.x2.clone());
        if weights == Weights::Committed {
            s.contact.commit(&x1, &x2, &s.lambda, None).unwrap();
        }
        let r = s.contact.residual(&x1, &x2, &s.lambda, None).unwrap();
        let all = || r.nonmortar.iter().zip(&x1).chain(r.mortar.iter().zip(&x2));
        let largest = max_abs(all().flat_map(|(f, _)| f.iter().copied()));
        let (force, moment) = all().fold((Vec3::zeros(), Vec3::zeros()), |(f, m), (g, x)| (f + g, m + x.cross(g)));
        assert!(largest > 1e-3 && force.amax() <= ROUNDING * largest, "{force} of {largest:e}");
        assert!(moment.amax() <= ROUNDING * largest, "{moment} of {largest:e}");
    }
}

/// A flat interface, all closed: constant multipliers are in equilibrium with gaps of zero, the rows vanish, and nodal forces are those
/// of nodes with dual multipliers.
#[test]
fn closed_facets_are_those_of_nodes_and_pass_the_patch_test() {
    for (cells, weights) in CELLS.into_iter().flat_map(|c| [(c, Weights::Reference), (c, Weights::Current)]) {
        let flat = Roughness { warp: 0.0, jitter: 0.1, slide: 0.0 };
        let m = moved(&options(), cells, flat, 4);
        let (one, two) = m.interface.surfaces();
        let (one, two) = (mesh_of(one), mesh_of(two));
        let lambda = vec![SVector::from([-0.7]); one.x.len()];
        let of = by_points(weights);
        let mut points = contact::<1>(&one, &two, false, of);
        let mut nodes = contact::<1>(&one, &two, false, Options { decision: Decision::Nodes, ..of });
        let [p, n] = [&mut points, &mut nodes].map(|c| c.residual(&one.x, &two.x, &lambda, None).unwrap());
        let largest = max_abs(n.nonmortar.iter().flat_map(|f| f.iter().copied()));
        let forces = p.nonmortar.iter().zip(&n.nonmortar).chain(p.mortar.iter().zip(&n.mortar));
        let error = max_abs(forces.flat_map(|(p, n)| [p - n]).flat_map(|d| [d.x, d.y, d.z]));
        assert!(error <= ROUNDING * largest, "{error:e} of {largest:e}");
        let rows = max_abs(p.rows.iter().map(|row| row[0]));
        assert!(rows <= ROUNDING * largest, "{rows:e}");
    }
}

/// Of two squares on each other, whose overlap is known: tractions by a fine rule against those of the interface's points. The
/// border lies along an edge of the points' triangles, so that both are exact.
#[test]
fn integrals_are_those_over_points_with_negative_sigma() {
    // sigma = lambda: no gap. Negative for x < 1/2 and linear: the border cuts the square in half, along the mortar side's edge.
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(2, 1, [0.0, 0.0], [1.0, 1.0], 0.0, true, Cells::Quads);
    let lambda: Vec<_> = one.x.iter().map(|x| SVector::from([x.x - 0.5])).collect();
    for weights in WEIGHTS {
        half_of_a_square(&mut contact::<1>(&one, &two, false, by_points(weights)), (&one, &two), &lambda);
    }
}

fn half_of_a_square(contact: &mut Contact<1>, (one, two): (&Mesh, &Mesh), lambda: &[SVector<f64, 1>]) {
    let r = contact.residual(&one.x, &two.x, lambda, None).unwrap();
    let at = |x: f64, node: f64| if node == 0.0 { 1.0 - x } else { x };
    for (a, x) in one.x.iter().enumerate() {
        // int_0^(1/2) N(x) (x - 1/2) dx / 2, by Gauss points that are exact for it.
        let sum: f64 = line::GAUSS_3.iter().map(|[s, w]| 0.5 * w * at(0.5 * s, x.x) * (0.5 * s - 0.5)).sum();
        assert!((r.nonmortar[a].z - 0.5 * sum).abs() <= ROUNDING, "{a}: {}", r.nonmortar[a]);
        let share = contact.closed_share(a);
        let area: f64 = line::GAUSS_3.iter().map(|[s, w]| 0.5 * w * at(0.5 * s, x.x)).sum();
        assert!((share - area / 0.5).abs() <= ROUNDING, "{a}: {share}");
    }
}

/// Evaluations, commits and imports: a history of points is one of nodes, and goes on with the same bits.
#[test]
fn histories_go_on_with_the_same_bits() {
    for weights in WEIGHTS {
        let rough = Roughness { warp: 0.02, jitter: 0.05, slide: 0.3 };
        let mut s = scene(by_points(weights), CELLS[2], rough, 3);
        let first = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let second = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let (integers, reals) = s.contact.export_history().unwrap();
        let mut other = scene(by_points(weights), CELLS[2], rough, 3);
        other.contact.import_history(&integers, &reals).unwrap();
        assert!(second == other.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap());
        s.contact.roll_back().unwrap();
        assert!(first == s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap());
        assert!((first == second) == (weights == Weights::Reference), "{weights:?}");
    }
}

/// Weights of the first configuration were integrated at that of the creation where a border cuts a facet, and K with them, though
/// `set_previous` had made others the first. What is frozen belongs to the weights, through commits and in an exported history.
#[test]
fn weights_frozen_after_set_previous_are_of_its_positions() {
    for (cells, slide) in CELLS.into_iter().flat_map(|c| [(c, 0.0), (c, 0.4)]) {
        let rough = Roughness { warp: 0.03, jitter: 0.08, slide };
        let of = by_points(Weights::Reference);
        let mut s = scene(of, cells, rough, 3);
        assert!(s.shares()[1] > 0, "cut facets");
        let created = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        s.contact.set_previous(&s.x1, &s.x2).unwrap();
        let (one, two) = s.contact.surfaces();
        let at = |mesh: Mesh, x: &[Vec3]| Mesh { x: x.to_vec(), ..mesh };
        let mut there = contact::<1>(&at(mesh_of(one), &s.x1), &at(mesh_of(two), &s.x2), false, of);
        let residual = |c: &mut Contact<1>| c.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let expected = residual(&mut there);
        assert!(expected != created && expected == residual(&mut s.contact));
        let (x1, x2): (Vec<_>, Vec<_>) =
            (s.x1.iter().map(|x| x * 1.01).collect(), s.x2.iter().map(|x| x * 1.02).collect());
        s.contact.commit(&x1, &x2, &s.lambda, None).unwrap();
        assert!(expected == residual(&mut s.contact), "after a commit");
        let (integers, reals) = s.contact.export_history().unwrap();
        let mut again = scene(of, cells, rough, 3).contact;
        again.import_history(&integers, &reals).unwrap();
        assert!(expected == residual(&mut again), "after an import");
        assert!((integers, reals) == again.export_history().unwrap());
    }
}

/// The same of lines, whose sizes in axisymmetric models go by the radius: that which their area is of.
#[test]
fn lines_frozen_after_set_previous_are_of_its_positions() {
    for (measure, seed) in [Measure::Thickness(0.7), Measure::Axisymmetric].into_iter().flat_map(|m| [(m, 1), (m, 2)]) {
        let of = by_points(Weights::Reference);
        let mut s = moved_lines::<1>(&of, [2, 2], measure, seed);
        s.contact.set_previous(&s.x1, &s.x2).unwrap();
        let [one, two] = &s.meshes;
        let at = |mesh: &Mesh, x: &[Vec3]| Mesh { x: x.to_vec(), facets: mesh.facets.clone() };
        let mut there = contact_of_lines::<1>(&at(one, &s.x1), &at(two, &s.x2), measure, of);
        let residual = |c: &mut Contact<1>| c.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let (expected, found) = (residual(&mut there), residual(&mut s.contact));
        // Facets stand for lines, as wide as those of the creation are long: rounding differs.
        let largest = max_abs(expected.nonmortar.iter().map(|f| f.amax()));
        let forces = found.nonmortar.iter().zip(&expected.nonmortar).chain(found.mortar.iter().zip(&expected.mortar));
        let forces = max_abs(forces.map(|(f, e)| (f - e).amax()));
        let rows = max_abs(found.rows.iter().zip(&expected.rows).map(|(f, e)| (f - e).amax()));
        assert!(forces.max(rows) <= ROUNDING * largest, "{measure:?}: {forces:e} {rows:e} of {largest:e}");
        let away = |x: &[Vec3]| x.iter().map(|x| x + Vec3::new(0.3, 0.0, 0.0)).collect::<Vec<_>>();
        s.contact.commit(&away(&s.x1), &away(&s.x2), &s.lambda, None).unwrap();
        assert!(found == residual(&mut s.contact), "{measure:?}: after a commit");
    }
}

/// Lengths alone told them apart, if they did.
#[test]
fn a_history_of_nodes_is_refused_by_name() {
    let of = by_points(Weights::Committed);
    let contact = |of: Options| scene(of, CELLS[0], FLAT, 3).contact;
    let (mut points, mut nodes) = (contact(of), contact(Options { decision: Decision::Nodes, ..of }));
    let refused = |from: &mut Contact<1>, to: &mut Contact<1>, words: &str| {
        let (integers, reals) = from.export_history().unwrap();
        let error = to.import_history(&integers, &reals).unwrap_err();
        assert!(error.kind == Kind::HistoryMismatch && error.message.contains(words), "{error}");
    };
    refused(&mut points, &mut nodes, "one with points that decide (method.decision), the interface one with the dual");
    refused(&mut nodes, &mut points, "one with the dual multiplier basis, the interface one with points that decide");
}

/// Fewer unknowns away from the border say the same: with an augmentation beside the modulus r changes and K does not.
#[test]
fn an_augmentation_takes_the_place_of_r_alone() {
    let of = by_points(Weights::Reference);
    let flat = Roughness { warp: 0.0, jitter: 0.0, slide: 0.0 };
    let row = |options: Options| {
        let mut s = scene(options, CELLS[0], flat, 3);
        // Open: the rows are - (m + (r / r0) K) lambda, as forces.
        let lambda: Vec<_> = (0..s.x1.len()).map(|a| SVector::from([1.0 + a as f64])).collect();
        let away: Vec<_> = s.x1.iter().zip(0..).map(|(x, _)| x + s.contact.normal(0).unwrap()).collect();
        s.contact.residual(&away, &s.x2, &lambda, None).unwrap().rows
    };
    // Facets of 0.5: r0 = 0.9 E* / 0.5.
    let r0 = 0.9 * MODULUS / 0.5;
    let same = row(Options { stiffness: Stiffness::Augmentation(r0), ..of });
    let (own, twice) = (row(of), row(Options { stiffness: Stiffness::Augmentation(2.0 * r0), ..of }));
    let thrice = row(Options { stiffness: Stiffness::Augmentation(3.0 * r0), ..of });
    for (((own, same), twice), thrice) in own.iter().zip(&same).zip(&twice).zip(&thrice) {
        assert!((own - same).amax() <= ROUNDING, "{own} {same}");
        assert!((twice - own - (thrice - twice)).amax() <= ROUNDING, "linear in r / r0: {own} {twice} {thrice}");
    }
}

/// Weights of now: both bodies turn by half a right angle within a step, and the normals with them. Forces turn along, rows stay.
#[test]
fn a_rigid_motion_turns_forces_and_changes_no_row() {
    for (cells, seed) in CELLS.into_iter().flat_map(|c| [(c, 3), (c, 8)]) {
        let rough = Roughness { warp: 0.03, jitter: 0.08, slide: 0.3 };
        let mut s = scene(by_points(Weights::Current), cells, rough, seed);
        let before = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let turn = nalgebra::Rotation3::from_euler_angles(0.5, -0.3, 0.6);
        let moved = |x: &[Vec3]| x.iter().map(|x| turn * x + Vec3::new(0.4, 0.1, -0.7)).collect::<Vec<_>>();
        let normals = (0..s.x1.len()).map(|a| turn * s.contact.normal(a).unwrap()).collect();
        s.contact.set_normals(Some(normals)).unwrap();
        let after = s.contact.residual(&moved(&s.x1), &moved(&s.x2), &s.lambda, None).unwrap();
        let largest = max_abs(before.nonmortar.iter().flat_map(|f| f.iter().copied()));
        let forces = before.nonmortar.iter().zip(&after.nonmortar).chain(before.mortar.iter().zip(&after.mortar));
        let error = max_abs(forces.flat_map(|(b, a)| (turn * b - a).iter().copied().collect::<Vec<_>>()));
        let rows = max_abs(before.rows.iter().zip(&after.rows).map(|(b, a)| b[0] - a[0]));
        assert!(error.max(rows) <= 1e2 * ROUNDING * largest, "{cells:?} {seed}: {error:e}, {rows:e} of {largest:e}");
    }
}

/// Weights of now: as a node's sigma passes 0, and with it facets become closed, cut and open, nothing jumps.
#[test]
fn nothing_jumps_where_facets_become_closed() {
    for cells in CELLS {
        let mut s = scene(by_points(Weights::Current), cells, FLAT, 8);
        for a in 0..s.x1.len() {
            let mut at = |lambda: f64| {
                let mut all = s.lambda.clone();
                all[a][0] = lambda;
                let r = s.contact.residual(&s.x1, &s.x2, &all, None).unwrap();
                let share = s.contact.answers().1[a].sigma.dot(&s.contact.normal(a).unwrap());
                (r, share)
            };
            // sigma_A is lambda_A and what the gap has.
            let zero = -at(0.0).1;
            let [(before, below), (after, above)] = [-1e-9, 1e-9].map(|h| at(zero + h));
            assert!(below < 0.0 && above > 0.0, "{below:e} {above:e}");
            let jump = max_abs(before.nonmortar.iter().zip(&after.nonmortar).map(|(b, a)| (b - a).norm()));
            assert!(jump <= 1e-8, "{cells:?} {a}: {jump:e}");
        }
    }
}

#[test]
fn what_points_do_not_go_with_is_refused_by_name() {
    let of = by_points(Weights::Reference);
    let (one, two) = (
        grid(1, 1, [0.0; 2], [1.0; 2], 0.0, false, Cells::Quads),
        grid(1, 1, [0.0; 2], [1.0; 2], 0.0, true, Cells::Quads),
    );
    let refused = |options: Options, word: &str| {
        let error = options.validate().unwrap_err();
        assert!(error.kind == Kind::Unsupported && error.message.contains(word), "{error}");
    };
    refused(Options { friction: Friction::Tied, ..of }, "tied");
    refused(Options { basis: MultiplierBasis::Standard, ..of }, "BASIS_DUAL");
    refused(Options { form: Form::Augmented, ..of }, "augmented");
    refused(Options { scheme: Scheme::Elements(&line::GAUSS_2), ..of }, "stand for overlaps");
    refused(Options { weak_coverage: 0.2, ..of }, "weak_coverage");
    let mut contact = contact::<1>(&one, &two, false, of);
    let error = contact.set_owners(vec![Owner::Here, Owner::Shared, Owner::Here, Owner::Here]).unwrap_err();
    assert!(error.kind == Kind::Unsupported && error.message.contains("NODE_SHARED"), "{error}");
    contact.set_owners(vec![Owner::Here; 4]).unwrap();
    let sums = contact.sums(&one.x, &two.x).unwrap();
    let error = contact.residual(&one.x, &two.x, &[SVector::zeros(); 4], Some(&sums)).unwrap_err();
    assert!(error.kind == Kind::Unsupported && error.message.contains("sums"), "{error}");
}
