//! Analytic mortar sides: against facets, against differences, and what must hold by itself.

mod support;

use nalgebra::{Rotation3, SVector};
use stickslip::error::{Kind, Result};
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{Contact, Form, Friction, Options, Residual, Surface, Weights};
use stickslip::law::{SlipMeasure, State};
use support::max_abs;
use support::mesh::{Cells, Mesh, Random, grid, options};

/// Equal but for rounding, relative to the largest entry.
const ROUNDING: f64 = 1e-12;
/// Step of the central differences (facet size 0.5): rounding 1e-16/1e-6 and truncation 1e-12.
const STEP: f64 = 1e-6;
/// Tangent against differences, relative to the largest entry of the block. The quadrature points are fixed on the
/// facet, so that the tangent is the exact derivative on warped facets too.
const DIFFERENCES: f64 = 1e-7;

const SHAPES: [AnalyticShape; 5] = [
    AnalyticShape::Plane,
    AnalyticShape::Sphere(3.0),
    AnalyticShape::Sphere(-4.0),
    AnalyticShape::Cylinder(2.0),
    AnalyticShape::Cylinder(-5.0),
];

/// Three multipliers a node, or one.
trait Create: Sized {
    fn create(one: Surface, two: Surface, options: Options) -> Result<Self>;
}

/// Equations of n nodes with M each, from `first` on.
fn equations<const M: usize>(first: usize, n: usize) -> Vec<[i64; M]> {
    (0..n).map(|k| std::array::from_fn(|i| (first + M * k + i) as i64)).collect()
}

impl Create for Contact<3> {
    fn create(one: Surface, two: Surface, options: Options) -> Result<Self> {
        let n = one.len();
        Contact::new(one, two, equations(3 * n, n), options)
    }
}

impl Create for Contact<1> {
    fn create(one: Surface, two: Surface, options: Options) -> Result<Self> {
        let n = one.len();
        Contact::frictionless(one, two, equations(3 * n, n), options)
    }
}

fn nonmortar(mesh: &Mesh) -> Surface {
    Surface::new("nonmortar", mesh.x.clone(), &mesh.facets, equations(0, mesh.x.len())).unwrap()
}

fn against<C: Create>(mesh: &Mesh, shape: AnalyticShape, frame: &[Vec3], options: Options) -> Result<C> {
    C::create(nonmortar(mesh), Surface::analytic("mortar", shape, frame.to_vec())?, options)
}

/// A frame for a surface that touches the plane z = 0 from below at (1/2, 1/2), its normal there +z.
fn frame_of(shape: AnalyticShape) -> Vec<Vec3> {
    let p0 = Vec3::new(0.5, 0.5, -shape.radius());
    let edges = match shape {
        AnalyticShape::Cylinder(_) => [Vec3::new(0.6, 1.2, 0.0), Vec3::new(1.0, 0.0, 0.3), Vec3::new(0.0, 0.2, 1.5)],
        _ => [Vec3::new(0.0, 0.0, 0.7), Vec3::new(1.0, 0.2, 0.3), Vec3::new(0.1, -1.5, 0.0)],
    };
    std::iter::once(p0).chain(edges.map(|e| p0 + e)).collect()
}

fn turned(q: &Rotation3<f64>, shift: Vec3, x: &[Vec3]) -> Vec<Vec3> {
    x.iter().map(|x| q * x + shift).collect()
}

/// A frame that is no axis's friend.
fn askew() -> Rotation3<f64> {
    Rotation3::from_euler_angles(0.4, -0.9, 1.3)
}

fn flatten<const N: usize>(v: &[SVector<f64, N>]) -> Vec<f64> {
    v.iter().flatten().copied().collect()
}

/// Forces on the non-mortar side and multiplier rows.
fn equations_of<const N: usize>(r: &Residual<N>) -> Vec<f64> {
    [flatten(&r.nonmortar), flatten(&r.rows)].concat()
}

/// The tangent of (x1, lambda), row by row.
fn dense<const N: usize>(c: &mut Contact<N>, x1: &[Vec3], x2: &[Vec3], lambda: &[SVector<f64, N>]) -> Vec<f64> {
    let n = (3 + N) * x1.len();
    let mut k = vec![0.0; n * n];
    c.tangent(x1, x2, lambda, None, &mut |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v).unwrap();
    k
}

fn close(a: &[f64], b: &[f64], bound: f64, what: &str) {
    let error = max_abs(a.iter().zip(b).map(|(a, b)| a - b));
    let scale = max_abs(b.iter().copied());
    assert!(a.len() == b.len() && error <= bound * scale, "{what}: off by {error:.1e} of {scale:.1e}");
}

/// Compressed nodes that stick and slip, and open ones, in axes that `q` turns.
fn multipliers<const N: usize>(n: usize, q: &Rotation3<f64>, random: &mut Random) -> Vec<SVector<f64, N>> {
    let vector = |v: Vec3| if N == 1 { SVector::from_fn(|_, _| v.z) } else { SVector::from_fn(|i, _| (q * v)[i]) };
    (0..n).map(|_| vector(Vec3::new(0.3 * random.next(), 0.3 * random.next(), -0.3 + 0.7 * random.next()))).collect()
}

/// Steps over a plane, analytic and one large facet: the same numbers. `gap`: uniform height over the plane.
fn walk_over_plane<const N: usize>(options: Options, cells: Cells, gap: f64)
where
    Contact<N>: Create,
{
    let (q, shift, mut random) = (askew(), Vec3::new(3.0, -2.0, 1.0), Random(5));
    let mut mesh = grid(3, 2, [0.0, 0.0], [1.0, 1.2], gap, false, cells);
    let flat = mesh.x.clone();
    mesh.x = turned(&q, shift, &flat);
    let big = grid(1, 1, [-9.0, -8.0], [9.0, 10.0], 0.0, true, Cells::Quads);
    let big = Mesh { x: turned(&q, shift, &big.x), ..big };
    let frame = turned(&q, shift, &frame_of(AnalyticShape::Plane));
    let facet = Surface::new("mortar", big.x.clone(), &big.facets, vec![[-1; 3]; 4]).unwrap();
    let mut facets = Contact::create(nonmortar(&mesh), facet, options).unwrap();
    let mut plane: Contact<N> = against(&mesh, AnalyticShape::Plane, &frame, options).unwrap();
    let mut seen = [0; 3];
    for step in 1..=3 {
        // Slides, stretches and shears in the plane; the plane moves as well, along itself.
        let s = f64::from(step);
        let strain = |x: &Vec3| x + Vec3::new(0.003 * x.x - 0.002 * x.y + 0.01, 0.004 * x.y, 0.0) * s;
        let x1 = turned(&q, shift, &flat.iter().map(strain).collect::<Vec<_>>());
        let along = q * Vec3::new(-0.002, 0.003, 0.0) * s;
        let move_all = |x: &[Vec3]| x.iter().map(|x| x + along).collect::<Vec<_>>();
        let (x2, frame2) = (move_all(&big.x), move_all(&frame));
        let lambda = multipliers(x1.len(), &q, &mut random);
        let a = facets.residual(&x1, &x2, &lambda, None).unwrap();
        let b = plane.residual(&x1, &frame2, &lambda, None).unwrap();
        close(&equations_of(&b), &equations_of(&a), ROUNDING, "residual");
        let sum = |f: &[Vec3]| f.iter().sum::<Vec3>().as_slice().to_vec();
        close(&sum(&b.mortar), &sum(&a.mortar), ROUNDING, "mortar resultant");
        if N == 1 || gap == 0.0 {
            // Over a tilting facet the gap of facets turns with its normal; that of the plane does not.
            let (a, b) = (dense(&mut facets, &x1, &x2, &lambda), dense(&mut plane, &x1, &frame2, &lambda));
            close(&b, &a, ROUNDING, "tangent");
        }
        let responses = facets.responses(&x1, &x2, &lambda, None).unwrap();
        for (a, b) in responses.iter().zip(plane.responses(&x1, &frame2, &lambda, None).unwrap()) {
            assert_eq!(a.state, b.state);
            seen[a.state as usize] += 1;
        }
        facets.commit(&x1, &x2, &lambda, None).unwrap();
        plane.commit(&x1, &frame2, &lambda, None).unwrap();
        if !plane.history().slip.is_empty() {
            close(&flatten(&plane.history().slip), &flatten(&facets.history().slip), ROUNDING, "slip");
        }
    }
    let closed = if N == 1 { seen[State::Slip as usize] } else { seen[1].min(seen[2]) };
    assert!(seen[0] > 0 && closed > 0, "states {seen:?}");
}

#[test]
fn plane_equals_a_large_facet() {
    for cells in [Cells::Quads, Cells::Triangles] {
        for slip in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Seed] {
            for weights in [Weights::Current, Weights::Committed, Weights::Reference] {
                walk_over_plane::<3>(Options { slip, weights, ..options() }, cells, 0.0);
            }
        }
        walk_over_plane::<3>(options(), cells, 0.004);
        for gap in [-0.01, 0.0, 0.01] {
            walk_over_plane::<1>(options(), cells, gap);
        }
    }
}

/// A rough patch that touches the surface, moved since t_n, and the surface moved as a rigid body.
struct Rough<const N: usize> {
    contact: Contact<N>,
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    lambda: Vec<SVector<f64, N>>,
}

impl<const N: usize> Rough<N>
where
    Contact<N>: Create,
{
    fn new(shape: AnalyticShape, cells: Cells, options: Options) -> Rough<N> {
        let (q, shift, mut random) = (askew(), Vec3::new(3.0, -2.0, 1.0), Random(11));
        let mut mesh = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.01, false, cells);
        let mut noise = |x: &Vec3| x + random.vector(0.01);
        let (before, now): (Vec<_>, Vec<_>) =
            (mesh.x.iter().map(&mut noise).collect(), mesh.x.iter().map(noise).collect());
        mesh.x = turned(&q, shift, &before);
        let frame = turned(&q, shift, &frame_of(shape));
        let contact = against(&mesh, shape, &frame, options).unwrap();
        let step = Rotation3::from_euler_angles(0.001, -0.002, 0.003);
        let x2 = frame.iter().map(|x| frame[0] + step * (x - frame[0]) + Vec3::new(0.002, 0.0, -0.001)).collect();
        let lambda = multipliers(before.len(), &q, &mut random);
        Rough { contact, x1: turned(&q, shift, &now), x2, lambda }
    }

    fn point(&self) -> Vec<f64> {
        [flatten(&self.x1), flatten(&self.lambda)].concat()
    }

    fn residual(&mut self, point: &[f64]) -> Vec<f64> {
        let (x, lambda) = point.split_at(3 * self.x1.len());
        let x: Vec<_> = x.chunks_exact(3).map(Vec3::from_column_slice).collect();
        let lambda: Vec<_> = lambda.chunks_exact(N).map(SVector::from_column_slice).collect();
        equations_of(&self.contact.residual(&x, &self.x2, &lambda, None).unwrap())
    }

    /// Worst difference per block (f1, rows) x (x1, lambda), relative to the block's largest entry.
    fn difference_error(&mut self) -> f64 {
        let (k, point) = (dense(&mut self.contact, &self.x1, &self.x2, &self.lambda), self.point());
        let n = point.len();
        let mut differences = vec![0.0; n * n];
        for j in 0..n {
            let at =
                |h: f64| point.iter().enumerate().map(|(i, x)| if i == j { x + h } else { *x }).collect::<Vec<_>>();
            let (plus, minus) = (at(STEP), at(-STEP));
            let h = plus[j] - minus[j];
            for (i, (p, m)) in self.residual(&plus).iter().zip(self.residual(&minus)).enumerate() {
                differences[i * n + j] = (p - m) / h;
            }
        }
        let (ends, noise) = ([0, 3 * self.x1.len(), n], 1e-15 / STEP * max_abs(self.residual(&point)));
        let mut worst = 0.0_f64;
        for rows in ends.windows(2) {
            for columns in ends.windows(2) {
                let block = || (rows[0]..rows[1]).flat_map(|i| (columns[0]..columns[1]).map(move |j| i * n + j));
                let error = (max_abs(block().map(|t| k[t] - differences[t])) - noise).max(0.0);
                let scale = max_abs(block().map(|t| k[t]));
                worst = worst.max(if error > 0.0 { error / scale } else { 0.0 });
            }
        }
        worst
    }

    fn states(&mut self) -> [usize; 3] {
        let mut count = [0; 3];
        for r in self.contact.responses(&self.x1, &self.x2, &self.lambda, None).unwrap() {
            count[r.state as usize] += 1;
        }
        count
    }
}

fn check_differences<const N: usize>(options: Options) -> [usize; 3]
where
    Contact<N>: Create,
{
    let mut seen = [0; 3];
    for shape in SHAPES {
        for cells in [Cells::Quads, Cells::Triangles] {
            let mut rough = Rough::<N>::new(shape, cells, options);
            let error = rough.difference_error();
            assert!(error <= DIFFERENCES, "{shape:?}, {:?}, {:?}: {error:.1e}", options.friction, options.form);
            let states = rough.states();
            (0..3).for_each(|s| seen[s] += states[s]);
        }
    }
    seen
}

#[test]
fn tangent_equals_differences_in_every_column() {
    let mut seen = [0; 3];
    for form in [Form::Multiplier, Form::Augmented] {
        for weights in [Weights::Current, Weights::Committed, Weights::Reference] {
            let options = Options { form, weights, ..options() };
            for slip in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Seed] {
                let states = check_differences::<3>(Options { slip, ..options });
                (0..3).for_each(|s| seen[s] += states[s]);
            }
            for (friction, mu) in [(Friction::Rough, 0.0), (Friction::Tied, 0.0), (Friction::Coulomb, 0.0)] {
                check_differences::<3>(Options { friction, mu, ..options });
            }
            check_differences::<1>(Options { mu: 0.0, ..options });
        }
    }
    assert!(seen.iter().all(|&n| n > 0), "states {seen:?}");
}

/// The patch of a sphere around the origin over [-a, a]^2, seen from outside (`up`) or from inside.
fn cap(n: usize, a: f64, radius: f64, up: bool) -> Mesh {
    let mut mesh = grid(n, n, [-a, -a], [a, a], 1.0, up, Cells::Quads);
    mesh.x.iter_mut().for_each(|x| *x = x.normalize() * radius);
    mesh
}

/// Facets of both sides refined together: their gaps over a ball tend to those over the ball, with the square of their size.
#[test]
fn facets_of_a_ball_converge_to_the_ball() {
    const DISTANCE: f64 = 0.02;
    let frame = [Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()];
    let mut errors = Vec::new();
    for n in [4, 8, 16] {
        let (one, two) = (cap(n, 0.3, 2.0 + DISTANCE, false), cap(3 * n / 2, 0.45, 2.0, true));
        let mut ball: Contact<3> = against(&one, AnalyticShape::Sphere(2.0), &frame, options()).unwrap();
        let facets = Surface::new("mortar", two.x.clone(), &two.facets, vec![[-1; 3]; two.x.len()]).unwrap();
        let mut faceted = <Contact<3>>::create(nonmortar(&one), facets, options()).unwrap();
        let (a, b) = (faceted.sums(&one.x, &two.x).unwrap(), ball.sums(&one.x, &frame).unwrap());
        let error = |k: usize| (a[k].gap_now / a[k].coverage - b[k].gap_now / b[k].coverage).norm();
        errors.push((0..one.x.len()).map(error).fold(0.0, f64::max) / DISTANCE);
    }
    let orders: Vec<_> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
    assert!(orders.iter().all(|o| (1.9..2.1).contains(o)), "errors {errors:?}, orders {orders:?}");
}

/// A rigid motion of everything, its history included, turns the forces and changes nothing else.
#[test]
fn rigid_motion_of_everything_turns_the_forces() {
    let (q, shift) = (Rotation3::from_euler_angles(-1.0, 0.7, 2.0), Vec3::new(-4.0, 5.0, 2.0));
    for shape in SHAPES {
        let mut a = Rough::<3>::new(shape, Cells::Quads, options());
        let mut b = Rough::<3>::new(shape, Cells::Quads, options());
        let start = a.contact.history().clone();
        let start = [&start.x1, &start.x2].map(|x| turned(&q, shift, x));
        // The first frame is where the surface was created; its motion to here is rigid.
        b.contact.set_previous(&start[0], &start[1]).unwrap();
        (b.x1, b.x2) = (turned(&q, shift, &a.x1), turned(&q, shift, &a.x2));
        b.lambda = turned(&q, Vec3::zeros(), &a.lambda);
        let at_a = a.contact.residual(&a.x1, &a.x2, &a.lambda, None).unwrap();
        let at_b = b.contact.residual(&b.x1, &b.x2, &b.lambda, None).unwrap();
        for (a, b) in [(&at_a.nonmortar, &at_b.nonmortar), (&at_a.mortar, &at_b.mortar), (&at_a.rows, &at_b.rows)] {
            close(&flatten(b), &flatten(&turned(&q, Vec3::zeros(), a)), ROUNDING, "forces");
        }
    }
}

/// Within a step, the objective measure sees no slip when both sides turn together.
#[test]
fn a_common_rotation_within_a_step_is_no_slip() {
    let q = Rotation3::from_euler_angles(0.2, -0.3, 0.5);
    for shape in SHAPES {
        let mut rough = Rough::<3>::new(shape, Cells::Triangles, options());
        let start = rough.contact.history().clone();
        let [x1, x2] = [&start.x1, &start.x2].map(|x| turned(&q, Vec3::x(), x));
        for response in rough.contact.responses(&x1, &x2, &rough.lambda, None).unwrap() {
            assert!(response.slip.norm() <= ROUNDING, "{shape:?}: {:e}", response.slip.norm());
        }
    }
}

/// Forces on both sides cancel; their moments leave that of the tractions across the gap, sum g_A x t_A.
#[test]
fn forces_and_moments_balance() {
    for shape in SHAPES {
        let mut rough = Rough::<3>::new(shape, Cells::Quads, options());
        let sums = rough.contact.sums(&rough.x1, &rough.x2).unwrap();
        let r = rough.contact.residual(&rough.x1, &rough.x2, &rough.lambda, None).unwrap();
        let total: Vec3 = r.nonmortar.iter().chain(&r.mortar).sum();
        let moment = |x: &[Vec3], f: &[Vec3]| x.iter().zip(f).map(|(x, f)| x.cross(f)).sum::<Vec3>();
        let moments = moment(&rough.x1, &r.nonmortar) + moment(&rough.x2, &r.mortar);
        let across: Vec3 = sums.iter().zip(&rough.lambda).map(|(s, t)| s.gap_now.cross(t)).sum();
        let scale = max_abs(r.nonmortar.iter().chain(&r.mortar).map(|f| f.norm()));
        assert!(total.norm() <= ROUNDING * scale, "{shape:?}: force {total}");
        assert!((moments - across).norm() <= 10.0 * ROUNDING * scale, "{shape:?}: moment {}", moments - across);
    }
}

/// A ball that turns under a small stuck patch drags its surface along by R dtheta.
#[test]
fn turning_ball_slips_by_the_arc() {
    const RADIUS: f64 = 2.0;
    const ANGLE: f64 = 1e-3;
    /// Half the patch's width over the radius, squared: how far its points are from the pole.
    const PATCH: f64 = 1e-4;
    let width = 2.0 * RADIUS * PATCH.sqrt();
    let mut mesh = grid(2, 2, [-0.5 * width; 2], [0.5 * width; 2], RADIUS, false, Cells::Quads);
    mesh.x.iter_mut().for_each(|x| x.z -= 1e-9);
    let frame = vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    let mut contact: Contact<3> = against(
        &mesh,
        AnalyticShape::Sphere(RADIUS),
        &frame,
        Options { friction: Friction::Rough, mu: 0.0, ..options() },
    )
    .unwrap();
    let x2 = turned(&Rotation3::from_axis_angle(&Vec3::y_axis(), ANGLE), Vec3::zeros(), &frame);
    let sums = contact.sums(&mesh.x, &x2).unwrap();
    let lambda = vec![Vec3::new(0.0, 0.0, -1.0); mesh.x.len()];
    for (response, sums) in contact.responses(&mesh.x, &x2, &lambda, None).unwrap().iter().zip(sums) {
        assert_eq!(response.state, State::Stick);
        // The ball's points moved by +R dtheta along x; the patch slips the other way.
        let slip = response.slip / sums.coverage_previous;
        assert!((slip + Vec3::x() * (RADIUS * ANGLE)).norm() <= 2.0 * PATCH * RADIUS * ANGLE, "{slip}");
    }
}

#[test]
fn only_facets_that_face_the_surface_are_found() {
    let at = |height: f64, down: bool, shape: AnalyticShape, search_distance: Option<f64>| {
        let mesh = grid(2, 2, [0.0, 0.0], [1.0, 1.0], height, !down, Cells::Quads);
        let mut options = Options { search_distance, ..options() };
        options.shortcuts.apart = false;
        let contact: Contact<3> = against(&mesh, shape, &frame_of(shape), options).unwrap();
        contact.active_pairs()
    };
    for shape in SHAPES {
        assert_eq!(at(0.1, true, shape, None), 4, "{shape:?}: above");
        assert_eq!(at(1.9, true, shape, None), 4, "{shape:?}: far above");
        assert_eq!(at(-0.4, true, shape, None), 4, "{shape:?}: less deep than a facet");
        assert_eq!(at(-0.9, true, shape, None), 0, "{shape:?}: deeper than a facet");
        assert_eq!(at(0.1, false, shape, None), 0, "{shape:?}: looks away");
        assert_eq!(at(0.5, true, shape, Some(0.3)), 0, "{shape:?}: beyond the search distance");
        assert_eq!(at(-0.4, true, shape, Some(0.1)), 0, "{shape:?}: deeper than the search distance");
    }
}

#[test]
fn counters_tell_what_was_done() {
    let mesh = grid(3, 2, [0.0, 0.0], [1.0, 1.0], 0.001, false, Cells::Quads);
    let lambda = vec![Vec3::zeros(); mesh.x.len()];
    let [lifted, higher] = [0.8, 1.0].map(|h| mesh.x.iter().map(|x| x + Vec3::z() * h).collect::<Vec<_>>());
    for shape in SHAPES {
        let frame = frame_of(shape);
        let mut contact: Contact<3> = against(&mesh, shape, &frame, options()).unwrap();
        dense(&mut contact, &mesh.x, &frame, &lambda);
        let c = contact.counters();
        assert_eq!((c.pairs_tested, c.pairs_clipped, c.pairs_integrated, c.pairs_linearised), (12, 0, 12, 6));
        assert_eq!((c.searches, c.evaluations_apart), (0, 0));
        assert!(contact.effects().contains(&format!("Mortar side: {shape} (asked for)")), "{}", contact.effects());
        // Apart is one comparison a node, and changes nothing.
        let mut options = options();
        options.shortcuts.apart = false;
        let mut all: Contact<3> = against(&mesh, shape, &frame, options).unwrap();
        let apart = [&mut contact, &mut all].map(|c| {
            c.set_previous(&lifted, &frame).unwrap();
            c.residual(&higher, &frame, &lambda, None).unwrap()
        });
        assert_eq!(apart[0], apart[1]);
        let c = contact.counters();
        assert_eq!((c.pairs_tested, c.commits_apart, c.evaluations_apart), (12, 1, 1), "{shape:?}");
        assert_eq!(all.counters().evaluations_apart, 0);
        // Frozen weights integrate once.
        let frozen = Options { weights: Weights::Reference, ..options };
        let mut frozen: Contact<3> = against(&mesh, shape, &frame, frozen).unwrap();
        dense(&mut frozen, &mesh.x, &frame, &lambda);
        frozen.commit(&mesh.x, &frame, &lambda, None).unwrap();
        let c = frozen.counters();
        assert_eq!((c.pairs_integrated, c.pairs_linearised), (6, 0));
    }
}

/// History goes out and in, and back, bit for bit.
#[test]
fn restart_and_rollback() {
    for shape in SHAPES {
        let mut a = Rough::<3>::new(shape, Cells::Quads, options());
        let before = a.contact.residual(&a.x1, &a.x2, &a.lambda, None).unwrap();
        a.contact.commit(&a.x1, &a.x2, &a.lambda, None).unwrap();
        let (integers, reals) = a.contact.export_history().unwrap();
        let after = a.contact.residual(&a.x1, &a.x2, &a.lambda, None).unwrap();
        let mut b = Rough::<3>::new(shape, Cells::Quads, options());
        b.contact.import_history(&integers, &reals).unwrap();
        assert_eq!(b.contact.residual(&a.x1, &a.x2, &a.lambda, None).unwrap(), after);
        a.contact.roll_back().unwrap();
        assert_eq!(a.contact.residual(&a.x1, &a.x2, &a.lambda, None).unwrap(), before);
        let mut other = Rough::<3>::new(AnalyticShape::Sphere(3.5), Cells::Quads, options());
        assert_eq!(other.contact.import_history(&integers, &reals).unwrap_err().kind, Kind::HistoryMismatch);
        let mut reals = reals;
        reals[3 * a.x1.len()] += 0.1; // P0
        let error = b.contact.import_history(&integers, &reals).unwrap_err();
        assert_eq!(error.kind, Kind::HistoryMismatch);
        assert!(error.message.contains("rigid body"), "{}", error.message);
    }
}

fn refused<T: std::fmt::Debug>(result: Result<T>, kind: Kind, word: &str) {
    let error = result.unwrap_err();
    assert!(error.kind == kind && error.message.contains(word), "{word}: {error:?}");
}

#[test]
fn what_is_no_surface_is_refused_by_name() {
    let frame = frame_of(AnalyticShape::Plane);
    let surface = |shape, frame: &[Vec3]| Surface::analytic("mortar", shape, frame.to_vec());
    for radius in [0.0, f64::NAN, f64::INFINITY] {
        refused(surface(AnalyticShape::Sphere(radius), &frame), Kind::InvalidValue, "mortar: the radius");
        refused(surface(AnalyticShape::Cylinder(radius), &frame), Kind::InvalidValue, "mortar: the radius");
    }
    refused(surface(AnalyticShape::Plane, &frame[..3]), Kind::InvalidSize, "3 nodes");
    let flat = [frame[0], frame[1], frame[2], frame[1] + frame[2] - frame[0]];
    refused(surface(AnalyticShape::Plane, &flat), Kind::InvalidValue, "one plane");
    refused(surface(AnalyticShape::Plane, &[frame[0], frame[0], frame[2], frame[3]]), Kind::InvalidValue, "one plane");
    let far = [frame[0], frame[1], frame[2], Vec3::new(f64::NAN, 0.0, 0.0)];
    refused(surface(AnalyticShape::Plane, &far), Kind::NotFinite, "node 3");

    let mesh = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = Surface::new("mortar", mesh.x.clone(), &mesh.facets, equations(0, 9)).unwrap();
    let one = surface(AnalyticShape::Plane, &frame).unwrap();
    refused(<Contact<3>>::create(one, two, options()), Kind::InvalidValue, "nonmortar");
}

#[test]
fn what_is_no_rigid_motion_and_the_centre_are_refused() {
    let mesh = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let shape = AnalyticShape::Sphere(0.5);
    let frame = frame_of(shape);
    let mut contact: Contact<3> = against(&mesh, shape, &frame, options()).unwrap();
    let lambda = vec![Vec3::zeros(); 9];
    let history = contact.history().clone();
    let mirrored: Vec<_> = frame.iter().map(|x| Vec3::new(-x.x, x.y, x.z)).collect();
    refused(contact.residual(&mesh.x, &mirrored, &lambda, None), Kind::InvalidValue, "mirrored");
    for k in 0..4 {
        let mut bent = frame.clone();
        bent[k] += Vec3::new(1e-6, 1e-6, 1e-6);
        refused(contact.residual(&mesh.x, &bent, &lambda, None), Kind::InvalidValue, "rigid body");
        refused(contact.commit(&mesh.x, &bent, &lambda, None), Kind::InvalidValue, "rigid body");
    }
    // The middle of facet 0, where a quadrature point is, at the centre of the ball.
    let sunk: Vec<_> = mesh.x.iter().map(|x| x + frame[0] - Vec3::new(0.25, 0.25, 0.0)).collect();
    refused(contact.residual(&sunk, &frame, &lambda, None), Kind::UndefinedNormal, "nonmortar facet 0: ");
    assert_eq!(contact.history(), &history);
}
