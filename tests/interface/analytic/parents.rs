//! Quadratic facets and lines over analytic surfaces: against large facets, against one layer in space, against differences.

use super::*;
use crate::support::differences::worst_difference;
use crate::support::lines::{components, lines, plane_equations};
use crate::support::mesh::{options, under};
use crate::support::parents::{Kind, grid_of};
use crate::support::{lines as of_lines, parents as of_parents};
use stickslip::interface::{Decision, Friction, NO_EQUATION, Stiffness, Weights};
use stickslip::law::SlipMeasure;
use stickslip::line::Measure;
use stickslip::mortar::MultiplierSpace;

/// Differences: truncation 1e-12 and rounding 1e-10 of a step of 1e-6; quadrature points are fixed on their parts.
const DIFFERENCES: f64 = 1e-7;

/// E* where points decide [F/L^2].
const MODULUS: f64 = 30.0;

const MEASURES: [Measure; 2] = [Measure::Thickness(0.7), Measure::Axisymmetric];
const IN_PLANE: [AnalyticShape; 3] = [AnalyticShape::Line, AnalyticShape::Circle(1.5), AnalyticShape::Circle(-4.0)];

/// All choices of space and basis that there are.
fn choices(of: Options) -> [Options; 3] {
    let standard = [MultiplierSpace::Corner, MultiplierSpace::Sub].map(|space| Options { space, ..of });
    [standard[0], standard[1], Options { basis: MultiplierBasis::Dual, ..of }]
}

/// An interface over an analytic surface and where it is evaluated; unknowns are x1 and lambda, in this order.
struct Over<const N: usize> {
    contact: Contact<N>,
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    lambda: Vec<SVector<f64, N>>,
    /// Components of a node that are unknown, and of its multiplier.
    per: [usize; 2],
}

impl<const N: usize> Over<N>
where
    Contact<N>: Create,
{
    fn ends(&self) -> [usize; 4] {
        let a = self.per[0] * self.x1.len();
        [0, a, a, a + self.per[1] * self.lambda.len()]
    }

    fn tangent(&mut self) -> Vec<f64> {
        let n = self.ends()[3];
        let mut k = vec![0.0; n * n];
        let mut add = |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v;
        self.contact.tangent(&self.x1, &self.x2, &self.lambda, None, &mut add).unwrap();
        k
    }

    fn unknowns(&self) -> Vec<f64> {
        let [d, m] = self.per;
        let x = self.x1.iter().flat_map(|x| x.iter().copied().take(d));
        x.chain(self.lambda.iter().flat_map(|l| l.iter().copied().take(m))).collect()
    }

    fn residual(&mut self, z: &[f64]) -> Vec<f64> {
        let ([d, m], a) = (self.per, self.ends()[1]);
        let x: Vec<_> =
            z[..a].chunks_exact(d).map(|x| Vec3::from_fn(|i, _| x.get(i).copied().unwrap_or(0.0))).collect();
        let of = |l: &[f64]| SVector::<f64, N>::from_fn(|i, _| l.get(i).copied().unwrap_or(0.0));
        let lambda: Vec<_> = z[a..].chunks_exact(m).map(of).collect();
        let r = self.contact.residual(&x, &self.x2, &lambda, None).unwrap();
        assert!(d == 3 || r.nonmortar.iter().chain(&r.mortar).all(|f| f.z == 0.0), "forces along z");
        let forces = r.nonmortar.iter().flat_map(|f| f.iter().copied().take(d));
        forces.chain(r.rows.iter().flat_map(|row| row.iter().copied().take(m))).collect()
    }

    fn difference_error(&mut self) -> f64 {
        let (k, x, ends) = (self.tangent(), self.unknowns(), self.ends());
        worst_difference(&k, ends, &x, 0.0, |z| self.residual(z))
    }

    fn count(&mut self, seen: &mut [usize; 3]) {
        for (a, r) in self.contact.responses(&self.x1, &self.x2, &self.lambda, None).unwrap().into_iter().enumerate() {
            seen[r.state as usize] += usize::from(self.contact.surfaces().0.has_row(a));
        }
    }
}

/// Multipliers where a mesh has them, pressed along y, z or alone.
fn random_multipliers<const N: usize>(
    has: &[bool],
    normal: Vec3,
    q: &Rotation3<f64>,
    random: &mut Random,
) -> Vec<SVector<f64, N>> {
    let mut of = |has: &bool| {
        let along = Vec3::new(1.0, 0.0, 0.0) * (0.3 * random.next());
        let v = q * (along + normal * (-0.3 + 0.7 * random.next()));
        let v = if N == 1 { Vec3::repeat(0.2 - 0.7 * random.next()) } else { v };
        if *has { SVector::from_fn(|i, _| v[i]) } else { SVector::zeros() }
    };
    has.iter().map(&mut of).collect()
}

/// The equations of multipliers, `per` a node that has one, from `first` on.
fn rows_of<const N: usize>(has: &[bool], first: usize, per: usize) -> Vec<[i64; N]> {
    let row = |(a, has): (usize, &bool)| {
        std::array::from_fn(|i| if *has && i < per { (first + per * a + i) as i64 } else { NO_EQUATION })
    };
    has.iter().enumerate().map(row).collect()
}

/// The points of a frame in the plane for a shape that touches y = 0 from below at (1/2, 0).
fn plane_frame(shape: AnalyticShape) -> Vec<Vec3> {
    let p0 = Vec3::new(0.5, -shape.radius(), 0.0);
    let second = if shape == AnalyticShape::Line { Vec3::new(0.0, 0.8, 0.0) } else { Vec3::new(0.3, 0.7, 0.0) };
    vec![p0, p0 + second, p0 + Vec3::new(1.1, 0.2, 0.0)]
}

trait New<const N: usize>: Sized {
    fn new(one: Surface, two: Surface, rows: Vec<[i64; N]>, options: Options) -> Result<Self>;
}

impl New<3> for Contact<3> {
    fn new(one: Surface, two: Surface, rows: Vec<[i64; 3]>, options: Options) -> Result<Self> {
        Contact::new(one, two, rows, options)
    }
}

impl New<1> for Contact<1> {
    fn new(one: Surface, two: Surface, rows: Vec<[i64; 1]>, options: Options) -> Result<Self> {
        Contact::frictionless(one, two, rows, options)
    }
}

/// Rough lines over a line or a circle, moved since t_n in a turned frame.
fn lines_over<const N: usize>(
    shape: AnalyticShape,
    nodes: usize,
    measure: Measure,
    options: Options,
    seed: u64,
) -> Over<N>
where
    Contact<N>: New<N> + Create,
{
    let (q, shift, mut random) = (Rotation3::from_euler_angles(0.0, 0.0, 0.7), Vec3::new(6.0, 0.4, 0.0), Random(seed));
    let mesh = lines(4, nodes, [0.0, 1.0], false);
    let mut noise = |scale: f64| -> Vec<Vec3> {
        let moved = |x: &Vec3| x + Vec3::new(0.5 * random.next(), random.next(), 0.0) * scale;
        turned(&q, shift, &mesh.x.iter().map(moved).collect::<Vec<_>>())
    };
    let (before, x1) = (noise(0.01), noise(0.01));
    let frame = turned(&q, shift, &plane_frame(shape));
    let step = Rotation3::from_euler_angles(0.0, 0.0, 0.002);
    let x2 = frame.iter().map(|x| frame[0] + step * (x - frame[0]) + Vec3::new(0.002, -0.001, 0.0)).collect();
    let (n, per) = (before.len(), [2, components(N)]);
    let has = of_lines::has_row(&mesh, options.space);
    let one = Surface::of_lines("nonmortar", before, &mesh.facets, plane_equations(0, n), measure).unwrap();
    let two = Surface::analytic("mortar", shape, frame).unwrap();
    let contact = New::new(one, two, rows_of(&has, 2 * n, per[1]), options).unwrap();
    let lambda = random_multipliers(&has, Vec3::y(), &q, &mut random);
    Over { contact, x1, x2, lambda, per }
}

#[test]
fn tangents_of_lines_are_those_of_differences() {
    let mut seen = [0; 3];
    for ((shape, measure), nodes) in
        IN_PLANE.into_iter().flat_map(|s| MEASURES.map(|m| (s, m))).flat_map(|of| [2, 3].map(|n| (of, n)))
    {
        let weights = [Weights::Current, Weights::Committed, Weights::Reference];
        for (options, weights) in choices(options()).into_iter().flat_map(|o| weights.map(|w| (o, w))) {
            for (slip, mu) in [(SlipMeasure::Objective, 0.7), (SlipMeasure::Increment, 5.0), (SlipMeasure::Paper, 0.7)]
            {
                let options = Options { weights, slip, mu, ..options };
                let mut s = lines_over::<3>(shape, nodes, measure, options, 3 + nodes as u64);
                s.count(&mut seen);
                let error = s.difference_error();
                assert!(error <= DIFFERENCES, "{shape:?} {measure:?} {nodes} {options:?}: {error:e}");
            }
            for (friction, mu) in [(Friction::Tied, 0.0), (Friction::Tresca, 0.2), (Friction::Rough, 0.0)] {
                let options = Options { weights, ..under(friction, mu, options) };
                let error = lines_over::<3>(shape, nodes, measure, options, 5).difference_error();
                assert!(error <= DIFFERENCES, "{shape:?} {measure:?} {nodes} {options:?}: {error:e}");
            }
            let options = Options { weights, ..under(Friction::None, 0.0, options) };
            let error = lines_over::<1>(shape, nodes, measure, options, 7).difference_error();
            assert!(error <= DIFFERENCES, "{shape:?} {measure:?} {nodes} {options:?}: {error:e}");
        }
    }
    assert!(seen.iter().all(|&n| n > 20), "states {seen:?}");
}

/// Lines over shapes where points decide, with weights that are frozen.
#[test]
fn tangents_of_lines_are_those_of_differences_where_points_decide() {
    let (decision, stiffness) = (Decision::Points(MODULUS), Stiffness::Modulus(MODULUS));
    for (shape, measure) in IN_PLANE.into_iter().flat_map(|s| MEASURES.map(|m| (s, m))) {
        for weights in [Weights::Committed, Weights::Reference] {
            let options = Options { weights, decision, stiffness, basis: MultiplierBasis::Dual, ..options() };
            let error = lines_over::<3>(shape, 2, measure, options, 5).difference_error();
            assert!(error <= DIFFERENCES, "{shape:?} {measure:?} {weights:?}: {error:e}");
            let options = under(Friction::None, 0.0, options);
            let error = lines_over::<1>(shape, 2, measure, options, 7).difference_error();
            assert!(error <= DIFFERENCES, "{shape:?} {measure:?} {weights:?}: {error:e}");
        }
    }
}

/// Rough quadratic facets over a surface in space, moved since t_n in a turned frame.
fn facets_over<const N: usize>(shape: AnalyticShape, kinds: &[Kind], bend: f64, options: Options) -> Over<N>
where
    Contact<N>: New<N> + Create,
{
    let (q, shift, mut random) = (askew(), Vec3::new(3.0, -2.0, 1.0), Random(11));
    let mesh = grid_of(2, 2, [0.0, 0.0], [1.0, 1.0], false, kinds);
    let bent = |x: &Vec3| x + Vec3::z() * (bend * (x.x * x.x - 0.7 * x.x * x.y));
    let mut noise = || -> Vec<Vec3> {
        turned(&q, shift, &mesh.x.iter().map(|x| bent(x) + random.vector(0.01)).collect::<Vec<_>>())
    };
    let (before, x1) = (noise(), noise());
    let frame = turned(&q, shift, &frame_of(shape));
    let step = Rotation3::from_euler_angles(0.001, -0.002, 0.003);
    let x2 = frame.iter().map(|x| frame[0] + step * (x - frame[0]) + Vec3::new(0.002, 0.0, -0.001)).collect();
    let has = of_parents::has_row(&mesh, options.space);
    let n = before.len();
    let one = Surface::new("nonmortar", before, &mesh.facets, equations(0, n)).unwrap();
    let two = Surface::analytic("mortar", shape, frame).unwrap();
    let contact = New::new(one, two, rows_of(&has, 3 * n, N), options).unwrap();
    let lambda = random_multipliers(&has, Vec3::z(), &q, &mut random);
    Over { contact, x1, x2, lambda, per: [3, N] }
}

#[test]
fn tangents_of_quadratic_facets_are_those_of_differences() {
    let mut seen = [0; 3];
    let kinds: [&[Kind]; 4] = [&[6], &[8], &[9], &[3, 9, 4, 6]];
    for (shape, kinds) in SHAPES.into_iter().flat_map(|shape| kinds.map(|kinds| (shape, kinds))) {
        for (options, weights) in
            choices(options()).into_iter().flat_map(|o| [Weights::Current, Weights::Committed].map(|w| (o, w)))
        {
            let options = Options { weights, ..options };
            let mut s = facets_over::<3>(shape, kinds, 0.02, options);
            s.count(&mut seen);
            let error = s.difference_error();
            assert!(error <= DIFFERENCES, "{shape:?} {kinds:?} {options:?}: {error:e}");
            let tied = under(Friction::Tied, 0.0, options);
            let error = facets_over::<3>(shape, kinds, 0.02, tied).difference_error();
            assert!(error <= DIFFERENCES, "{shape:?} {kinds:?} {tied:?}: {error:e}");
            let none = under(Friction::None, 0.0, options);
            let error = facets_over::<1>(shape, kinds, 0.02, none).difference_error();
            assert!(error <= DIFFERENCES, "{shape:?} {kinds:?} {none:?}: {error:e}");
        }
    }
    assert!(seen.iter().all(|&n| n > 20), "states {seen:?}");
}

/// The tangent of x1 and lambda over a mortar side without equations.
fn tangent_at<const N: usize>(
    c: &mut Contact<N>,
    size: usize,
    x: (&[Vec3], &[Vec3]),
    lambda: &[SVector<f64, N>],
) -> Vec<f64> {
    let mut k = vec![0.0; size * size];
    let mut add = |i: i64, j: i64, v: f64| k[i as usize * size + j as usize] += v;
    c.tangent(x.0, x.1, lambda, None, &mut add).unwrap();
    k
}

/// Two interfaces of the same non-mortar side, over facets and over a surface that lies where they do.
struct Both<const N: usize> {
    facets: Contact<N>,
    surface: Contact<N>,
    /// Number of equations.
    size: usize,
    /// Whether the whole tangent is the same, or that of the residual's values alone. Where mid nodes move along their facets,
    /// closest points follow the parent and overlaps its parts: gaps along the facets differ, by products with such motions.
    tangents: bool,
}

impl<const N: usize> Both<N>
where
    Contact<N>: Create,
{
    /// Compares them, and commits.
    fn step(&mut self, x1: &[Vec3], x2: [&[Vec3]; 2], lambda: &[SVector<f64, N>], seen: &mut [usize; 3], what: &str) {
        let a = self.facets.residual(x1, x2[0], lambda, None).unwrap();
        let b = self.surface.residual(x1, x2[1], lambda, None).unwrap();
        close(&equations_of(&b), &equations_of(&a), ROUNDING, &format!("residual, {what}"));
        let sum = |f: &[Vec3]| f.iter().sum::<Vec3>().as_slice().to_vec();
        close(&sum(&b.mortar), &sum(&a.mortar), ROUNDING, &format!("resultant, {what}"));
        if self.tangents {
            let a = tangent_at(&mut self.facets, self.size, (x1, x2[0]), lambda);
            let b = tangent_at(&mut self.surface, self.size, (x1, x2[1]), lambda);
            close(&b, &a, ROUNDING, &format!("tangent, {what}"));
        }
        let a = self.facets.responses(x1, x2[0], lambda, None).unwrap();
        let b = self.surface.responses(x1, x2[1], lambda, None).unwrap();
        for (k, (a, b)) in a.iter().zip(&b).enumerate() {
            assert_eq!(a.state, b.state, "{what}");
            seen[a.state as usize] += usize::from(self.facets.surfaces().0.has_row(k));
        }
        self.facets.commit(x1, x2[0], lambda, None).unwrap();
        self.surface.commit(x1, x2[1], lambda, None).unwrap();
        let slip = |c: &Contact<N>| flatten(&c.history().slip);
        close(&slip(&self.surface), &slip(&self.facets), ROUNDING, &format!("slip, {what}"));
    }
}

fn walk_along_a_line<const N: usize>(nodes: usize, measure: Measure, options: Options, seen: &mut [usize; 3])
where
    Contact<N>: New<N> + Create,
{
    let (q, shift, mut random) = (Rotation3::from_euler_angles(0.0, 0.0, 0.7), Vec3::new(60.0, 0.4, 0.0), Random(5));
    let (mesh, long) = (lines(4, nodes, [0.0, 1.0], false), lines(1, 2, [-9.0, 10.0], true));
    let (start, frame) = (turned(&q, shift, &long.x), turned(&q, shift, &plane_frame(AnalyticShape::Line)));
    let (n, has) = (mesh.x.len(), of_lines::has_row(&mesh, options.space));
    let one = || {
        let x = turned(&q, shift, &mesh.x);
        Surface::of_lines("nonmortar", x, &mesh.facets, plane_equations(0, n), measure).unwrap()
    };
    let two = Surface::of_lines("mortar", start.clone(), &long.facets, vec![[NO_EQUATION; 3]; 2], measure).unwrap();
    let line = Surface::analytic("mortar", AnalyticShape::Line, frame.clone()).unwrap();
    let rows = rows_of::<N>(&has, 2 * n, components(N));
    let mut both = Both {
        facets: New::new(one(), two, rows.clone(), options).unwrap(),
        surface: New::new(one(), line, rows, options).unwrap(),
        size: (2 + components(N)) * n,
        tangents: N == 1 || nodes == 2,
    };
    for step in 1..=3 {
        let s = f64::from(step);
        let strain = |x: &Vec3| x + Vec3::new(0.003 * x.x + 0.01, 0.0, 0.0) * s;
        let x1 = turned(&q, shift, &mesh.x.iter().map(strain).collect::<Vec<_>>());
        let along = q * Vec3::new(-0.002, 0.0, 0.0) * s;
        let [x2, frame] = [&start, &frame].map(|x| x.iter().map(|x| x + along).collect::<Vec<_>>());
        let lambda = random_multipliers(&has, Vec3::y(), &q, &mut random);
        both.step(
            &x1,
            [&x2, &frame],
            &lambda,
            seen,
            &format!("{measure:?} {nodes} {:?} {:?}", options.space, options.basis),
        );
    }
}

/// Steps over a straight line, analytic and one long line of two nodes: the same numbers.
#[test]
fn a_straight_line_equals_one_long_line() {
    let mut seen = [0; 3];
    let all = MEASURES.into_iter().flat_map(|m| [2, 3].map(|n| (m, n)));
    for ((measure, nodes), options) in all.flat_map(|of| choices(options()).map(|o| (of, o))) {
        for weights in [Weights::Current, Weights::Committed, Weights::Reference] {
            for slip in [SlipMeasure::Objective, SlipMeasure::Increment] {
                walk_along_a_line::<3>(nodes, measure, Options { weights, slip, ..options }, &mut seen);
            }
            let none = Options { weights, ..under(Friction::None, 0.0, options) };
            walk_along_a_line::<1>(nodes, measure, none, &mut [0; 3]);
        }
    }
    assert!(seen.iter().all(|&n| n > 20), "states {seen:?}");
}

/// Lines over a circle are one layer of quadrilaterals over a cylinder along z, nodes above each other having one unknown.
#[test]
fn lines_over_a_circle_are_one_layer_over_a_cylinder() {
    const THICKNESS: f64 = 0.45;
    for (radius, basis) in [1.5, -4.0].into_iter().flat_map(|r| BASES.map(|b| (r, b))) {
        let options = Options { basis, ..options() };
        let (circle, cylinder) = (AnalyticShape::Circle(radius), AnalyticShape::Cylinder(radius));
        let mut flat = lines_over::<3>(circle, 2, Measure::Thickness(THICKNESS), options, 4);
        let n = flat.x1.len();
        let layer = |x: &[Vec3]| -> Vec<Vec3> {
            x.iter().copied().chain(x.iter().map(|x| x + Vec3::z() * THICKNESS)).collect()
        };
        let (before, frame) = (&flat.contact.surfaces().0.reference, &flat.contact.surfaces().1.reference);
        let along = |x: &[Vec3]| vec![x[0], x[0] + Vec3::z(), x[1], x[2]];
        let up = |k: i64| k + n as i64;
        let facets: Vec<Vec<i64>> = (0..n as i64 - 1).map(|k| vec![k, k + 1, up(k + 1), up(k)]).collect();
        let one = Surface::new("nonmortar", layer(before), &facets, equations(0, 2 * n)).unwrap();
        let two = Surface::analytic("mortar", cylinder, along(frame)).unwrap();
        let mut space = Contact::<3>::create(one, two, options).unwrap();
        let (y1, y2) = (layer(&flat.x1), along(&flat.x2));
        let lambda: Vec<_> = flat.lambda.iter().chain(&flat.lambda).copied().collect();
        let own = flat.contact.residual(&flat.x1, &flat.x2, &flat.lambda, None).unwrap();
        let all = space.residual(&y1, &y2, &lambda, None).unwrap();
        let both = |v: &[Vec3]| (0..n).flat_map(|k| [0, 1].map(|i| v[k][i] + v[k + n][i])).collect::<Vec<_>>();
        let of = |v: &[Vec3]| v.iter().flat_map(|v| [v.x, v.y]).collect::<Vec<_>>();
        close(&of(&own.nonmortar), &both(&all.nonmortar), ROUNDING, "forces");
        close(&of(&own.rows), &both(&all.rows), ROUNDING, "rows");
        let own = flat.contact.responses(&flat.x1, &flat.x2, &flat.lambda, None).unwrap();
        let all = space.responses(&y1, &y2, &lambda, None).unwrap();
        assert!(own.iter().zip(&all).all(|(a, b)| a.state == b.state));
    }
}

fn walk_over_plane<const N: usize>(kinds: &[Kind], options: Options, seen: &mut [usize; 3])
where
    Contact<N>: New<N> + Create,
{
    let (q, shift, mut random) = (askew(), Vec3::new(3.0, -2.0, 1.0), Random(5));
    let mesh = grid_of(2, 2, [0.0, 0.0], [1.0, 1.2], false, kinds);
    let big = grid(1, 1, [-9.0, -8.0], [9.0, 10.0], 0.0, true, Cells::Quads);
    let (start, frame) = (turned(&q, shift, &big.x), turned(&q, shift, &frame_of(AnalyticShape::Plane)));
    let (n, has) = (mesh.x.len(), of_parents::has_row(&mesh, options.space));
    let one = || Surface::new("nonmortar", turned(&q, shift, &mesh.x), &mesh.facets, equations(0, n)).unwrap();
    let two = Surface::new("mortar", start.clone(), &big.facets, vec![[NO_EQUATION; 3]; 4]).unwrap();
    let plane = Surface::analytic("mortar", AnalyticShape::Plane, frame.clone()).unwrap();
    let rows = rows_of::<N>(&has, 3 * n, N);
    let mut both = Both {
        facets: New::new(one(), two, rows.clone(), options).unwrap(),
        surface: New::new(one(), plane, rows, options).unwrap(),
        size: (3 + N) * n,
        tangents: N == 1,
    };
    for step in 1..=2 {
        let s = f64::from(step);
        let strain = |x: &Vec3| x + Vec3::new(0.003 * x.x - 0.002 * x.y + 0.01, 0.004 * x.y, 0.0) * s;
        let x1 = turned(&q, shift, &mesh.x.iter().map(strain).collect::<Vec<_>>());
        let lambda = random_multipliers(&has, Vec3::z(), &q, &mut random);
        both.step(&x1, [&start, &frame], &lambda, seen, &format!("{kinds:?} {:?} {:?}", options.space, options.basis));
    }
}

/// The same quadratic facets over a plane and over one large facet.
#[test]
fn quadratic_facets_over_a_plane_are_those_over_a_large_facet() {
    let (kinds, mut seen): ([&[Kind]; 3], _) = ([&[6], &[9], &[8, 6, 4, 3]], [0; 3]);
    for (kinds, options) in kinds.into_iter().flat_map(|k| choices(options()).map(|o| (k, o))) {
        walk_over_plane::<3>(kinds, options, &mut seen);
        walk_over_plane::<1>(kinds, under(Friction::None, 0.0, options), &mut [0; 3]);
    }
    assert!(seen.iter().all(|&n| n > 5), "states {seen:?}");
}

#[test]
fn shapes_of_the_other_model_are_refused() {
    let mesh = lines(2, 2, [0.0, 1.0], false);
    let line = || {
        let x = mesh.x.clone();
        Surface::of_lines("nonmortar", x, &mesh.facets, plane_equations(0, 3), Measure::Thickness(1.0)).unwrap()
    };
    let rows = rows_of::<3>(&[true; 3], 6, 2);
    let plane = Surface::analytic("mortar", AnalyticShape::Plane, frame_of(AnalyticShape::Plane)).unwrap();
    let error = Contact::<3>::new(line(), plane, rows, options()).map(|_| ()).unwrap_err();
    assert!(error.message.contains("one side is of another model"), "{error}");
    let solid = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = Surface::analytic("mortar", AnalyticShape::Line, plane_frame(AnalyticShape::Line)).unwrap();
    let error = Contact::<3>::create(nonmortar(&solid), two, options()).map(|_| ()).unwrap_err();
    assert!(error.message.contains("one side is of another model"), "{error}");
    let four = frame_of(AnalyticShape::Plane);
    let error = Surface::analytic("mortar", AnalyticShape::Circle(2.0), four).map(|_| ()).unwrap_err();
    assert!(error.message.contains("a disc of radius 2 has 3"), "{error}");
    let lifted = plane_frame(AnalyticShape::Line).iter().map(|x| x + Vec3::z()).collect();
    let error = Surface::analytic("mortar", AnalyticShape::Line, lifted).map(|_| ()).unwrap_err();
    assert!(error.message.contains("nodes of plane models have z = 0"), "{error}");
}

/// Offsets of the nodes, different ones (docs/formulation 15).
#[test]
fn offsets_are_differentiated() {
    let give = |n: usize| [Some((0..n).map(|a| 0.004 * (a as f64 - 1.5)).collect()), None];
    for options in choices(options()) {
        for (shape, measure) in IN_PLANE.into_iter().flat_map(|s| MEASURES.map(|m| (s, m))) {
            for nodes in [2, 3] {
                let mut s = lines_over::<3>(shape, nodes, measure, options, 5);
                s.contact.set_offsets(give(s.x1.len())).unwrap();
                let error = s.difference_error();
                assert!(error <= DIFFERENCES, "{shape:?} {measure:?} {nodes} {options:?}: {error:e}");
            }
        }
        for (shape, kinds) in SHAPES.into_iter().flat_map(|shape| [&[6][..], &[9]].map(|kinds| (shape, kinds))) {
            let mut s = facets_over::<3>(shape, kinds, 0.05, options);
            s.contact.set_offsets(give(s.x1.len())).unwrap();
            let error = s.difference_error();
            assert!(error <= DIFFERENCES, "{shape:?} {kinds:?} {options:?}: {error:e}");
        }
    }
}
