//! Facets whose maps are all but singular: three nodes on a line, two nodes that nearly coincide, needles, facets seen
//! edge-on, sizes that differ by up to 1e9; one over the other, either way round. Each pair is refused by a status that
//! is true, by weights and derivatives and handle alike, or all that comes of it is finite and within its bounds.

use super::config;
use crate::support::mesh::numbered;
use nalgebra::Rotation3;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use stickslip::error::{Error, Kind};
use stickslip::geometry::bilinear_map::BilinearMap;
use stickslip::geometry::{AnalyticShape, AnalyticSurface, Facet, Projection, Vec3};
use stickslip::interface::{Interface, MultiplierBasis, Options, Scheme, Stiffness, Surface};
use stickslip::mortar::{self, AlongNormal, ForceDerivatives, NonmortarFrame, PairWeights, Segment, WeightDerivatives};
use stickslip::quadrature::{RULES, Rule, cell};

/// Rounding of sums over some hundred points, relative to the overlap.
const SUMS: f64 = 1e-12;
/// What a weight may be beyond 0 and beyond the overlap's area, over that: at the edge of what is taken for convex the
/// places that the inverse map returns are known to a sixteenth.
const BEYOND: f64 = 0.25;

/// A facet in its own plane, its longest side about 1.
#[derive(Clone, Debug)]
enum Outline {
    /// A quadrilateral with its second node this far off the line between its neighbours, towards the outside.
    Straight(f64),
    /// A quadrilateral whose first two nodes are this close.
    Collapsed(f64),
    /// A triangle or quadrilateral of this height; of a quadrilateral the second node may lie on a line, too.
    Needle(f64, bool),
    /// A parallelogram, but for this.
    Parallel(f64),
    /// A facet as others.
    Plain,
}

#[derive(Clone, Debug)]
struct Shape {
    quad: bool,
    outline: Outline,
    noise: [f64; 10],
    begin: usize,
    reverse: bool,
    /// Angle by which it stands out of the plane z = 0, about an axis within it; 90 degrees less 10^-k.
    steep: Option<i32>,
    warp: f64,
    turn: f64,
    size: f64,
}

#[derive(Clone, Debug)]
struct Recipe {
    shapes: [Shape; 2],
    /// Which point of the second facet lies where on the first one.
    places: [[f64; 4]; 2],
    height: f64,
    /// Nodes in common, these of the second with those of the first.
    shared: Vec<[usize; 2]>,
    angles: [f64; 3],
    offset: [f64; 3],
    size: f64,
    /// Coordinates are multiples of this.
    grid: Option<f64>,
    /// Which of the rules, and how many points along a line.
    rule: usize,
    points: usize,
    /// Now and then, for they take longer.
    with_handle: bool,
    with_analytic: bool,
}

fn tiny() -> impl Strategy<Value = f64> {
    prop_oneof![
        2 => Just(0.0),
        12 => (1..=8i32, 1.0..10.0f64).prop_map(|(k, m)| m * 10f64.powi(-k)),
        6 => (9..=18i32, 1.0..10.0f64).prop_map(|(k, m)| m * 10f64.powi(-k)),
        1 => (4..=17i32).prop_map(|k| -10f64.powi(-k)),
    ]
}

fn shape(sizes: impl Strategy<Value = f64>) -> impl Strategy<Value = Shape> {
    let outline = prop_oneof![
        3 => tiny().prop_map(Outline::Straight),
        2 => tiny().prop_map(Outline::Collapsed),
        2 => (tiny(), any::<bool>()).prop_map(|(h, straight)| Outline::Needle(h, straight)),
        1 => tiny().prop_map(Outline::Parallel),
        2 => Just(Outline::Plain),
    ];
    let steep = prop_oneof![4 => Just(None), 1 => (0..=17i32).prop_map(Some)];
    let warp = prop_oneof![3 => Just(0.0), 1 => tiny()];
    let turn = prop_oneof![1 => Just(0.0), 2 => -3.0..3.0f64];
    let noise = proptest::array::uniform10(-1.0..1.0f64);
    (prop::bool::weighted(0.75), outline, noise, 0..4usize, any::<bool>(), (steep, warp, turn), sizes).prop_map(
        |(quad, outline, noise, begin, reverse, (steep, warp, turn), size)| Shape {
            quad,
            outline,
            noise,
            begin,
            reverse,
            steep,
            warp,
            turn,
            size,
        },
    )
}

fn recipes() -> impl Strategy<Value = Recipe> {
    let sizes = prop_oneof![3 => Just(1.0), 1 => (-9..=9i32).prop_map(|k| 10f64.powi(k)), 1 => 0.1..10.0f64];
    let grid = prop_oneof![4 => Just(None), 2 => Just(Some(0.0625)), 1 => Just(Some(1e-3))];
    let angles = prop_oneof![1 => Just([0.0; 3]), 1 => [-3.0..3.0f64, -3.0..3.0, -3.0..3.0]];
    let offset = prop_oneof![2 => Just([0.0; 3]), 1 => [-10.0..10.0f64, -10.0..10.0, -10.0..10.0]];
    let size = prop_oneof![2 => Just(1.0), 1 => (-30..=30i32).prop_map(|k| 10f64.powi(k))];
    (
        (shape(Just(1.0)), shape(sizes)),
        [[0.0..1.0f64, 0.0..1.0, 0.0..1.0, 0.0..1.0], [0.0..1.0f64, 0.0..1.0, 0.0..1.0, 0.0..1.0]],
        prop_oneof![2 => Just(0.0), 1 => -1.0..1.0f64],
        prop_oneof![3 => Just(vec![]), 2 => prop::collection::vec([0..4usize, 0..4usize], 1..=2)],
        (angles, offset, size, grid),
        (0..RULES.len(), 2..=10usize),
        prop::bool::weighted(0.125),
        prop::bool::weighted(0.125),
    )
        .prop_map(
            |(
                (one, two),
                places,
                height,
                shared,
                (angles, offset, size, grid),
                (rule, points),
                with_handle,
                with_analytic,
            )| {
                Recipe {
                    shapes: [one, two],
                    places,
                    height,
                    shared,
                    angles,
                    offset,
                    size,
                    grid,
                    rule,
                    points,
                    with_handle,
                    with_analytic,
                }
            },
        )
}

impl Shape {
    fn nodes(&self) -> Vec<Vec3> {
        let r = &self.noise;
        let u = |k: usize| 0.5 * (r[k] + 1.0);
        let apex = [u(0), 0.2 + u(1)];
        let at = |[x, y]: [f64; 2]| Vec3::new(x, y, 0.0);
        let plain = vec![at([0.0, 0.0]), at([1.0, 0.2 * r[2]]), at([1.0 + 0.2 * r[3], 1.0]), at([0.2 * r[4], 1.0])];
        let mut x = match self.outline {
            Outline::Straight(off) => {
                vec![at([0.0, 0.0]), at([u(2), -off]), at([1.0, 0.0]), at(apex)]
            }
            Outline::Collapsed(apart) => {
                vec![at([0.0, 0.0]), at([apart, apart * r[2]]), at([1.0, u(3) + 0.3]), at([0.5 * r[4], 1.0])]
            }
            Outline::Needle(h, straight) => {
                let second = if straight { 0.0 } else { -h * u(5) };
                vec![at([0.0, 0.0]), at([u(2), second]), at([1.0, 0.0]), at([u(3), h])]
            }
            Outline::Parallel(off) => vec![plain[0], plain[1], plain[1] + plain[3] + at([off * r[5], off]), plain[3]],
            Outline::Plain => plain,
        };
        if !self.quad {
            x.remove(if matches!(self.outline, Outline::Needle(..)) { 1 } else { 3 });
        }
        for (k, p) in x.iter_mut().enumerate() {
            p.z += self.warp * r[6 + k];
        }
        let steep = match self.steep {
            None => Rotation3::identity(),
            Some(k) => Rotation3::from_axis_angle(&Vec3::x_axis(), std::f64::consts::FRAC_PI_2 - 10f64.powi(-k)),
        };
        let turn = Rotation3::from_axis_angle(&Vec3::z_axis(), self.turn);
        x.iter_mut().for_each(|p| *p = turn * (steep * *p) * self.size);
        let begin = self.begin % x.len();
        x.rotate_left(begin);
        if self.reverse {
            x.reverse();
        }
        x
    }
}

/// A point of a facet.
fn within(x: &[Vec3], weights: &[f64; 4]) -> Vec3 {
    let total: f64 = weights[..x.len()].iter().sum::<f64>() + f64::MIN_POSITIVE;
    x.iter().zip(weights).map(|(x, w)| x * (w / total)).sum()
}

impl Recipe {
    fn nodes(&self) -> [Vec<Vec3>; 2] {
        let [one, mut two] = [self.shapes[0].nodes(), self.shapes[1].nodes()];
        let shift = within(&one, &self.places[0]) - within(&two, &self.places[1])
            + Vec3::z() * (self.height * self.shapes[1].size.min(1.0));
        two.iter_mut().for_each(|x| *x += shift);
        for [k, j] in &self.shared {
            let k = k % two.len();
            two[k] = one[j % one.len()];
        }
        let q = Rotation3::from_euler_angles(self.angles[0], self.angles[1], self.angles[2]);
        [one, two].map(|x| {
            let place = |x: &Vec3| q * x + Vec3::from(self.offset);
            let snapped = |x: Vec3| self.grid.map_or(x, |g| x.map(|v| (v / g).round() * g));
            x.iter().map(|x| snapped(place(x)) * self.size).collect()
        })
    }
}

fn finite<'a>(values: impl IntoIterator<Item = &'a f64>, what: &str) -> TestCaseResult {
    prop_assert!(values.into_iter().all(|v| v.is_finite()), "{what} is not finite");
    Ok(())
}

/// The largest det J of a facet over the smallest one.
fn spread(map: &BilinearMap) -> f64 {
    let [j, xi, eta] = map.determinant();
    (j + xi.abs() + eta.abs()) / (j - xi.abs() - eta.abs())
}

/// What a weight that is integrated with 1 / det J loses by the root in the inverse map, over the overlap.
fn root(map: &BilinearMap, facet: &Projection, reach: f64) -> f64 {
    let [j, xi, eta] = map.determinant();
    let least = j - xi.abs() - eta.abs();
    if map.is_affine { 0.0 } else { 16.0 * f64::EPSILON * j * facet.size * reach / (least * least) }
}

fn weights_are_bounded(w: &PairWeights, area: f64, beyond: f64, sums: f64) -> TestCaseResult {
    for a in 0..4 {
        finite(w.ab[a].iter().chain(&w.ac[a]), "a weight")?;
        let (b, c) = (w.coverage(a), w.ac[a].iter().sum::<f64>());
        prop_assert!((b - c).abs() <= sums * area, "row {a}: {b:e} {c:e} of {area:e}");
        for n in w.ab[a].iter().chain(&w.ac[a]) {
            prop_assert!(-beyond * area <= *n && *n <= (1.0 + beyond) * area, "{n:e} of an overlap {area:e}");
        }
    }
    Ok(())
}

fn along(g: &AlongNormal) -> TestCaseResult {
    finite(g.gamma.iter().chain(g.dgamma.iter().flatten().flatten()), "a gap's derivative")
}

const FIELDS: [[f64; 4]; 3] = [[1.0, -0.5, 0.25, 0.75], [0.3, 0.2, -1.0, 0.1], [1.0, 1.0, 1.0, 1.0]];

/// All that comes of a segment.
fn segment_is_sound(frame: &NonmortarFrame, segment: &Segment, two: &Facet, rule: &Rule) -> TestCaseResult {
    let reach = frame.projection.size.max(segment.mortar.distance());
    let alone = PairWeights::integrate(frame, segment, rule);
    let (with, d) = WeightDerivatives::integrate(frame, segment, rule);
    let digits = SUMS * spread(&frame.map).max(spread(&segment.mortar_map));
    let root = root(&frame.map, &frame.projection, reach) + root(&segment.mortar_map, &segment.mortar, reach);
    weights_are_bounded(&alone, segment.area, BEYOND, SUMS)?;
    weights_are_bounded(&with, segment.area, BEYOND + root, digits)?;
    finite(d.ab.iter().chain(&d.ac).flatten().flatten().flatten(), "a weight's derivative")?;
    let one = Facet { nodes: [0, 1, 2, 3].map(|k| frame.projection.x[k]), shape: frame.projection.shape };
    finite(mortar::gap(&alone, &one, two).iter().flatten(), "the gap")?;
    let mut f = ForceDerivatives::default();
    along(&mortar::pair_motion((frame, segment, rule), &alone, &FIELDS, &mut f))?;
    finite(f.one.iter().chain(&f.two).flatten().flatten().flatten(), "a force's derivative")?;
    if segment.points.is_none() {
        along(&mortar::facet_motion(frame, [(segment, &alone)].into_iter(), rule, &FIELDS, &mut f))?;
        finite(f.one.iter().flatten().flatten().flatten(), "a force's derivative, the other side at rest")?;
    }
    Ok(())
}

fn is_true(error: &Error) -> TestCaseResult {
    let fine = matches!(error.kind, Kind::DegenerateFacet | Kind::ProjectionNotConvex);
    prop_assert!(fine, "{:?}: {error}", error.kind);
    Ok(())
}

/// The pair by its kernels, over the overlap and over points.
fn pair(one: &Facet, two: &Facet, rule: &Rule, points: usize) -> TestCaseResult {
    let frame = match NonmortarFrame::new(one) {
        Ok(frame) => frame,
        Err(error) => return is_true(&error),
    };
    finite(&frame.nodal_areas(), "an area")?;
    let line = cell::line_of(points).unwrap();
    let (cells, points) = (Segment::new(&frame, two), Segment::of_points(&frame, two, line));
    prop_assert_eq!(cells.is_err(), points.is_err(), "cells and points disagree on what can be integrated");
    match &cells {
        Err(error) => is_true(error)?,
        Ok(None) => {}
        Ok(Some(segment)) => segment_is_sound(&frame, segment, two, rule)?,
    }
    if let Ok(Some(segment)) = &points {
        segment_is_sound(&frame, segment, two, rule)?;
    }
    Ok(())
}

/// The facet against surfaces of its own size.
fn against_analytic(one: &Facet, rule: &Rule) -> TestCaseResult {
    let Ok(frame) = NonmortarFrame::new(one) else { return Ok(()) };
    let h = one.longest_edge();
    let origin = one.nodes[0] - frame.plane.e * (0.9 * h) + frame.plane.t1 * (0.1 * h);
    let points = [Vec3::zeros(), Vec3::x() * h, Vec3::y() * h, Vec3::z() * h].map(|x| origin + x);
    for shape in [AnalyticShape::Plane, AnalyticShape::Sphere(h), AnalyticShape::Cylinder(-h)] {
        let surface = AnalyticSurface::new(shape, &points).unwrap();
        let w = match mortar::analytic_weights(&frame, &surface, rule) {
            Ok(w) => w,
            Err(error) => {
                prop_assert_eq!(error.kind, Kind::UndefinedNormal);
                continue;
            }
        };
        finite(w.ab.iter().chain(&w.ac).flatten(), "a weight of a surface")?;
        let mut f = ForceDerivatives::default();
        let b = mortar::analytic_motion(&frame, &surface, rule, &FIELDS, &mut f).unwrap();
        finite(b.iter().flatten().flatten().flatten(), "a gap's derivative")?;
        finite(f.one.iter().flatten().flatten().flatten(), "a force's derivative")?;
        // Raised by its own distance, as dual multipliers ask for it.
        let raised = [0, 1, 2].map(|i| [0, 1, 2, 3].map(|b| points[0][i] - one.nodes[b][i]));
        let b = mortar::analytic_motion_raised(&frame, &surface, rule, &raised, &mut f).unwrap();
        finite(b.iter().flatten().flatten().flatten(), "a gap's derivative over a raised surface")?;
        finite(f.one.iter().flatten().flatten().flatten(), "an area's derivative")?;
    }
    Ok(())
}

/// What the handle says of an interface of these two facets, all of it.
fn evaluate(one: &[Vec3], two: &[Vec3], scheme: Scheme, basis: MultiplierBasis) -> Result<Vec<f64>, Error> {
    let (n1, n2) = (one.len(), two.len());
    let facet = |n: usize| [(0..n as i64).collect::<Vec<_>>()];
    let surface = |side, x: &[Vec3], first| Surface::new(side, x.to_vec(), &facet(x.len()), numbered(first, x.len()));
    let options = Options { scheme, basis, ..Options::paper(Stiffness::Augmentation(1.0)) };
    let (a, b) = (surface("nonmortar", one, 0)?, surface("mortar", two, 3 * n1)?);
    let mut contact = Interface::new(a, b, numbered(3 * (n1 + n2), n1), options)?;
    let lambda = vec![Vec3::new(0.1, 0.0, -1.0); n1];
    let r = contact.residual(one, two, &lambda, None)?;
    let mut values: Vec<f64> = r.nonmortar.iter().chain(&r.mortar).chain(&r.rows).flatten().copied().collect();
    contact.tangent(one, two, &lambda, None, &mut |_: i64, _: i64, v: f64| values.push(v))?;
    Ok(values)
}

fn handle(one: &[Vec3], two: &[Vec3], points: usize) -> TestCaseResult {
    let line = cell::line_of(points).unwrap();
    let schemes = [Scheme::Segments, Scheme::Elements(line), Scheme::Hybrid(line)];
    let bases = [MultiplierBasis::Standard, MultiplierBasis::Dual];
    for (scheme, basis) in schemes.into_iter().flat_map(|scheme| bases.map(|basis| (scheme, basis))) {
        match evaluate(one, two, scheme, basis) {
            Ok(values) => finite(&values, "an entry of the handle")?,
            Err(error) => {
                let other = matches!(error.kind, Kind::DuplicateNode | Kind::UndefinedNormal);
                prop_assert!(other || is_true(&error).is_ok(), "{:?}: {error}", error.kind);
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(file!(), 1))]

    #[test]
    fn facets_with_nearly_singular_maps_are_refused_or_finite(recipe in recipes()) {
        let [one, two] = recipe.nodes();
        let facets = [Facet::new(&one).unwrap(), Facet::new(&two).unwrap()];
        let rule = RULES[recipe.rule];
        pair(&facets[0], &facets[1], rule, recipe.points)?;
        pair(&facets[1], &facets[0], rule, recipe.points)?;
        if recipe.with_analytic {
            against_analytic(&facets[1], rule)?;
        }
        if recipe.with_handle {
            handle(&one, &two, recipe.points)?;
            handle(&two, &one, recipe.points)?;
        }
    }
}

/// A law that is hardly ever tested holds easily: of pairs, how many are taken and meet, and how many are refused.
#[test]
fn recipes_of_singular_maps_are_taken_and_refused() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let (strategy, drawn) = (recipes(), 2000);
    let (mut met, mut refused) = (0, 0);
    for _ in 0..drawn {
        let [one, two] = proptest::strategy::ValueTree::current(&strategy.new_tree(&mut runner).unwrap()).nodes();
        let (one, two) = (Facet::new(&one).unwrap(), Facet::new(&two).unwrap());
        match NonmortarFrame::new(&one).and_then(|frame| Segment::new(&frame, &two)) {
            Ok(segment) => met += i32::from(segment.is_some()),
            Err(_) => refused += 1,
        }
    }
    assert!(4 * met > drawn && 4 * refused > drawn, "{met} of {drawn} meet, {refused} are refused");
}
