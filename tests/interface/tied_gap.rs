//! Tied surfaces that start with an open gap: the gap turns with the non-mortar surface.

use crate::support::differences::Point;
use crate::support::mesh::*;
use nalgebra::{Rotation3, Unit};
use stickslip::error::Kind;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{Contact, Extent, Form, Friction, NodeSums, Options, Surface};

/// The gap that surfaces of facets of 0.5 start with.
const GAP: f64 = 0.2;
/// Rounding of positions of size 3, over that.
const ROUNDING: f64 = 1e-13;
/// Of the residual: the augmentation of `options()` times the above.
const RESIDUAL: f64 = 15.0 * ROUNDING;
/// Tangent against differences, relative to the largest entry of a block, as in `tests/interface/tangent.rs`.
const DIFFERENCES: f64 = 1e-7;
/// Blocks smaller than this over the largest entry are rounding.
const FLOOR: f64 = 1e-6;

const FORMS: [Form; 2] = [Form::Multiplier, Form::Augmented];
const CELLS: [[Cells; 2]; 3] =
    [[Cells::Quads, Cells::Quads], [Cells::Triangles, Cells::Quads], [Cells::Quads, Cells::Triangles]];

fn tied(form: Form) -> Options {
    Options { friction: Friction::Tied, mu: 0.0, form, ..options() }
}

fn with_weak_coverage(form: Form) -> Options {
    Options { weak_coverage: 0.4, ..tied(form) }
}

/// A warped patch over another; with `weak_coverage` the plate ends under it, so that a column of nodes is carried.
fn meshes(cells: [Cells; 2], gap: f64, noise: f64, ends: bool) -> [Mesh; 2] {
    let mut random = Random(5);
    let frame = Rotation3::from_euler_angles(0.4, -0.9, 1.3);
    let one = grid(3, 2, [0.0, 0.0], [1.0, 1.0], gap, false, cells[0]);
    let end = if ends { 0.45 } else { 1.3 };
    let two = grid(2, 3, [-0.5, -0.2], [end, 1.3], 0.0, true, cells[1]);
    [one, two].map(|m| {
        let x = m.x.iter().map(|x| frame * (x + random.vector(noise))).collect();
        Mesh { x, ..m }
    })
}

fn scene(cells: [Cells; 2], options: Options, prescribed: bool) -> Contact<3> {
    let [one, two] = meshes(cells, GAP, 0.02, options.weak_coverage > 0.0);
    contact(&one, &two, prescribed, options)
}

fn references(c: &Contact<3>) -> [Vec<Vec3>; 2] {
    [c.surfaces().0.reference.clone(), c.surfaces().1.reference.clone()]
}

/// Both surfaces turned about an axis of their own and moved.
struct Turn {
    axis: Unit<Vec3>,
    centre: Vec3,
    shift: Vec3,
}

impl Turn {
    fn random(random: &mut Random) -> Turn {
        let axis = Unit::new_normalize(random.vector(1.0) + Vec3::new(0.1, 0.2, -0.3));
        Turn { axis, centre: random.vector(1.0), shift: random.vector(0.5) }
    }

    fn by(&self, angle: f64, x: &[Vec3]) -> Vec<Vec3> {
        let turn = Rotation3::from_axis_angle(&self.axis, angle);
        x.iter().map(|x| self.centre + turn * (x - self.centre) + self.shift * angle).collect()
    }
}

fn largest(v: &[Vec3]) -> f64 {
    v.iter().map(|v| v.amax()).fold(0.0, f64::max)
}

/// Turns by 30, 90, 180 degrees and others, in one step and in many, leave forces and rows 0 without a multiplier.
fn check_rigid_motions(of: impl Fn() -> Contact<3>, what: &str) {
    let mut random = Random(17);
    for degrees in [30.0_f64, 90.0, 180.0, 6.0, 251.0] {
        for steps in [1, 9] {
            let (turn, mut c) = (Turn::random(&mut random), of());
            let [x1, x2] = references(&c);
            let none = vec![Vec3::zeros(); x1.len()];
            for step in 1..=steps {
                let angle = degrees.to_radians() * f64::from(step) / f64::from(steps);
                let (x1, x2) = (turn.by(angle, &x1), turn.by(angle, &x2));
                let r = c.residual(&x1, &x2, &none, None).unwrap();
                let worst = [&r.nonmortar, &r.mortar, &r.rows].map(|v| largest(v)).into_iter().fold(0.0, f64::max);
                assert!(worst <= RESIDUAL, "{what}, {degrees} degrees in {steps} steps: {worst:e}");
                c.commit(&x1, &x2, &none, None).unwrap();
            }
        }
    }
    // The gap is open indeed: over another turn of one side alone there is a residual.
    let mut c = of();
    let [x1, x2] = references(&c);
    let turned = Turn::random(&mut random).by(0.1, &x1);
    let none = vec![Vec3::zeros(); x1.len()];
    assert!(largest(&c.residual(&turned, &x2, &none, None).unwrap().rows) > 1e-3);
}

#[test]
fn a_tied_gap_is_objective() {
    for (form, cells) in FORMS.into_iter().flat_map(|form| CELLS.map(|cells| (form, cells))) {
        for options in [tied(form), with_weak_coverage(form)] {
            for prescribed in [false, true] {
                check_rigid_motions(|| scene(cells, options, prescribed), &format!("{options:?}"));
            }
        }
    }
    let mut weak = scene(CELLS[0], with_weak_coverage(Form::Multiplier), false);
    let [x1, x2] = references(&weak);
    weak.responses(&x1, &x2, &vec![Vec3::zeros(); x1.len()], None).unwrap();
    assert!(weak.counters().nodes.carried > 0);
}

fn over(shape: AnalyticShape, cells: Cells, form: Form) -> Contact<3> {
    let mut random = Random(5);
    let one = grid(3, 2, [0.0, 0.0], [1.0, 1.0], GAP, false, cells);
    let x: Vec<_> = one.x.iter().map(|x| x + random.vector(0.02)).collect();
    let n = x.len();
    // Its highest point is near (1/2, 1/2, 0).
    let centre = Vec3::new(0.5, 0.5, -shape.radius());
    let edges = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    let frame = std::iter::once(centre).chain(edges.map(|e| centre + e)).collect();
    let one = Surface::new("nonmortar", x, &one.facets, numbered(0, n)).unwrap();
    let two = Surface::analytic("mortar", shape, frame).unwrap();
    Contact::new(one, two, numbered(3 * n, n), tied(form)).unwrap()
}

/// Their gaps do not lie along the facets' normals.
#[test]
fn a_tied_gap_to_an_analytic_surface_is_objective() {
    for shape in [AnalyticShape::Plane, AnalyticShape::Sphere(2.0), AnalyticShape::Sphere(-3.0)] {
        for (form, cells) in FORMS.into_iter().flat_map(|f| [Cells::Quads, Cells::Triangles].map(|c| (f, c))) {
            check_rigid_motions(|| over(shape, cells, form), &format!("{shape:?}, {form:?}"));
        }
    }
}

/// Turned, deformed and under load.
fn loaded(c: &Contact<3>) -> (Vec<Vec3>, Vec<Vec3>, Vec<Vec3>) {
    let mut random = Random(29);
    let turn = Turn::random(&mut random);
    let [x1, x2] = references(c);
    let mut rough = |x: &[Vec3]| turn.by(1.2, x).iter().map(|x| x + random.vector(0.03)).collect::<Vec<_>>();
    let (y1, y2) = (rough(&x1), rough(&x2));
    (y1, y2, x1.iter().map(|_| random.vector(1.0)).collect())
}

#[test]
fn the_tangent_over_a_tied_gap_equals_differences() {
    for (form, cells) in FORMS.into_iter().flat_map(|form| CELLS.map(|cells| (form, cells))) {
        for options in [tied(form), with_weak_coverage(form)] {
            let mut c = scene(cells, options, false);
            let (x1, x2, lambda) = loaded(&c);
            let error = Point { contact: &mut c, x1: &x1, x2: &x2, lambda: &lambda }.difference_error(FLOOR);
            assert!(error <= DIFFERENCES, "{options:?}: {error:e}");
        }
    }
}

type Entries = Vec<(i64, i64, u64)>;

fn evaluate(c: &mut Contact<3>, (x1, x2, lambda): &(Vec<Vec3>, Vec<Vec3>, Vec<Vec3>)) -> (Vec<u64>, Entries) {
    let r = c.residual(x1, x2, lambda, None).unwrap();
    let bits = [r.nonmortar, r.mortar, r.rows].concat().iter().flatten().map(|v| v.to_bits()).collect();
    let mut entries = Vec::new();
    c.tangent(x1, x2, lambda, None, &mut |i: i64, j: i64, v: f64| entries.push((i, j, v.to_bits()))).unwrap();
    (bits, entries)
}

#[test]
fn the_pattern_over_a_tied_gap_has_the_tangents_entries() {
    for options in FORMS.into_iter().flat_map(|form| [tied(form), with_weak_coverage(form)]) {
        let mut c = scene(CELLS[0], options, false);
        let point = loaded(&c);
        let tangent: Vec<_> = evaluate(&mut c, &point).1.into_iter().map(|(i, j, _)| (i, j)).collect();
        let mut pattern = Vec::new();
        c.pattern(&point.0, &point.1, Extent::Whole, &mut |i, j, _| pattern.push((i, j))).unwrap();
        assert!(pattern == tangent, "{options:?}");
    }
}

/// Commits, rollback and restart: the gap that counts is the first one. `set_previous` starts with another.
#[test]
fn a_tied_gap_survives_steps_and_restarts() {
    for options in FORMS.into_iter().flat_map(|form| [tied(form), with_weak_coverage(form)]) {
        let mut c = scene(CELLS[0], options, false);
        let point = loaded(&c);
        let [x1, x2] = references(&c);
        let turn = Turn::random(&mut Random(31));
        let mut found = vec![evaluate(&mut c, &point)];
        for angle in [0.5, 1.4] {
            c.commit(&turn.by(angle, &x1), &turn.by(angle, &x2), &point.2, None).unwrap();
            found.push(evaluate(&mut c, &point));
        }
        // Carriers share by the areas of t_n, which a turn rounds.
        assert!(options.weak_coverage > 0.0 || found.iter().all(|at| *at == found[0]));
        let (integers, reals) = c.export_history().unwrap();
        let mut restarted = scene(CELLS[0], options, false);
        restarted.set_previous(&turn.by(0.7, &x1), &x2).unwrap();
        assert!(found[2] != evaluate(&mut restarted, &point), "another gap");
        restarted.import_history(&integers, &reals).unwrap();
        assert!(found[2] == evaluate(&mut restarted, &point));
        assert!(restarted.export_history().unwrap() == (integers, reals));
        c.roll_back().unwrap();
        assert!(found[1] == evaluate(&mut c, &point));

        // The same surfaces turned first and tied then.
        let mut later = scene(CELLS[0], options, false);
        let (y1, y2) = (turn.by(2.0, &x1), turn.by(2.0, &x2));
        later.set_previous(&y1, &y2).unwrap();
        let rows = |c: &mut Contact<3>| c.residual(&point.0, &point.1, &point.2, None).unwrap().rows;
        let apart = rows(&mut later).iter().zip(rows(&mut c)).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
        assert!(apart <= RESIDUAL, "{apart:e}");
    }
}

/// Two handles with a part of the mortar facets each: their shares of the turned gap add up.
#[test]
fn shares_of_a_tied_gap_add_up() {
    let [one, two] = meshes(CELLS[0], GAP, 0.02, false);
    let mut whole = contact::<3>(&one, &two, false, tied(Form::Multiplier));
    let (x1, x2, _) = loaded(&whole);
    let mut total = vec![NodeSums::default(); x1.len()];
    for part in 0..2 {
        let facets = two.facets.iter().enumerate().filter(|(f, _)| f % 2 == part).map(|(_, f)| f.clone()).collect();
        // Nodes without a facet are refused: take those in use.
        let facets: Vec<Vec<i64>> = facets;
        let mut used: Vec<_> = facets.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        let place = |k: i64| used.iter().position(|u| *u == k).unwrap() as i64;
        let of = |x: &[Vec3]| used.iter().map(|&k| x[k as usize]).collect::<Vec<_>>();
        let facets = facets.iter().map(|f| f.iter().map(|&k| place(k)).collect()).collect();
        let mut c = contact::<3>(&one, &Mesh { x: of(&two.x), facets }, false, tied(Form::Multiplier));
        for (sum, share) in total.iter_mut().zip(c.share_of_sums(&x1, &of(&x2)).unwrap()) {
            sum.gap_committed += share.gap_committed;
            sum.gap_now += share.gap_now;
        }
    }
    for (sum, all) in total.iter().zip(whole.sums(&x1, &x2).unwrap()) {
        assert!((sum.gap_committed - all.gap_committed).amax() <= ROUNDING && all.gap_committed.amax() > 1e-3);
        assert!((sum.gap_now - all.gap_now).amax() <= ROUNDING);
    }
}

/// Flat surfaces that meet, in any frame and a thousand facets from the origin: nothing turns, every number stays what the
/// fixed gap gives.
#[test]
fn closed_tied_surfaces_have_a_fixed_gap() {
    let mut random = Random(41);
    for cells in CELLS {
        let (turn, away) = (Turn::random(&mut random), random.vector(400.0));
        let put = |m: Mesh| Mesh { x: turn.by(2.3, &m.x).iter().map(|x| x + away).collect(), ..m };
        let [one, two] = meshes(cells, 0.0, 0.0, false).map(put);
        let mut c = contact::<3>(&one, &two, false, tied(Form::Multiplier));
        let (x1, x2, lambda) = loaded(&c);
        let sums = c.sums(&x1, &x2).unwrap();
        assert!(sums.iter().zip(&c.history().gap).all(|(sum, gap)| sum.gap_committed == *gap));
        let tangent = evaluate(&mut c, &(x1, x2, lambda.clone())).1;
        assert!(tangent == evaluate(&mut c, &(one.x.clone(), two.x.clone(), lambda)).1, "linear");
    }
}

/// The offset of a tied surface acts along the normals of the first configuration: it does not turn with the bodies.
#[test]
fn tied_surfaces_with_offsets_are_refused_where_they_have_turned() {
    for (offset, degrees, is_refused) in [(0.0, 40.0, false), (0.01, 10.0, false), (0.01, 25.0, true)] {
        let mut s =
            moved(&tied(Form::Multiplier), [Cells::Quads; 2], Roughness { warp: 0.0, jitter: 0.0, slide: 0.0 }, 3);
        let n = s.x1.len();
        s.interface.set_offsets([Some(vec![offset; n]), None]).unwrap();
        let turn = Rotation3::new(Vec3::x() * f64::to_radians(degrees));
        let [x1, x2] = [&s.x1, &s.x2].map(|x| x.iter().map(|x| turn * x).collect::<Vec<_>>());
        match s.interface.commit(&x1, &x2, &s.lambda, None) {
            Err(error) => assert!(is_refused && error.kind == Kind::TurnedTooFar, "{offset} {degrees}: {error}"),
            Ok(()) => assert!(!is_refused, "{offset} {degrees}"),
        }
    }
}
