//! Heat across an interface (docs/formulation 17): what is conserved, what passes exactly, derivatives against differences.

use super::weak;
use crate::support::lines::{components, contact_of_lines, lines, moved_lines};
use crate::support::max_abs;
use crate::support::mesh::*;
use crate::support::parents::{contact_of, grid_of, moved_parents};
use crate::support::parts::part;
use nalgebra::SVector;
use stickslip::error::Kind;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{
    Contact, Form, Friction, Heat, Interface, MultiplierBasis, NO_EQUATION, NO_WEAK_COVERAGE, Normals, Options, Scheme,
    Surface, Temperatures, Weights,
};
use stickslip::law::{Conductance, SlipMeasure};
use stickslip::line::Measure;
use stickslip::mortar::MultiplierSpace;
use stickslip::quadrature::DEGREE_10;

/// The tangent against differences, relative to the largest entry of a block.
const DIFFERENCES: f64 = 1e-7;
/// Step of the differences.
const STEP: f64 = 1e-6;
/// What differences make of the rounding of what they are of.
const NOISE: f64 = 1e-15 / STEP;
/// Sums of some hundred products, over their largest.
const ROUNDING: f64 = 1e-13;
/// The patch of temperature.
const PATCH: f64 = 1e-12;

const BASES: [MultiplierBasis; 2] = [MultiplierBasis::Standard, MultiplierBasis::Dual];
const NORMALS: [Normals; 2] = [Normals::Committed, Normals::Current];

/// Everything at once, and no gap of the scenes near where the reach ends. Where a thousandth of the pressure ends is wide against a
/// step of the differences.
const ALL: Conductance = Conductance {
    contact: 100.0,
    pressure: 50.0,
    exponent: 0.95,
    constant: 0.3,
    gas: 0.1,
    gas_gap: 0.2,
    reach: 10.0,
    share: 0.3,
    time: 0.25,
};
/// A constant one.
const CONSTANT: Conductance = Conductance {
    contact: 0.0,
    pressure: 0.0,
    exponent: 0.0,
    constant: 3.0,
    gas: 0.0,
    gas_gap: 0.0,
    reach: 1.0,
    share: 0.0,
    time: 0.0,
};

/// An interface, a configuration, temperatures.
struct Scene<'a, const N: usize> {
    contact: &'a mut Contact<N>,
    x: [Vec<Vec3>; 2],
    lambda: Vec<SVector<f64, N>>,
    t: [Vec<f64>; 2],
    /// Numbers of a node's position and multiplier that have equations.
    numbers: (usize, usize),
}

impl<'a, const N: usize> Scene<'a, N> {
    fn new(contact: &'a mut Contact<N>, x: [&[Vec3]; 2], lambda: &[SVector<f64, N>], numbers: (usize, usize)) -> Self {
        let mut random = Random(11);
        let t = x.map(|x| x.iter().map(|_| 300.0 + random.next()).collect());
        Scene { contact, x: x.map(<[_]>::to_vec), lambda: lambda.to_vec(), t, numbers }
    }

    fn heat(&mut self, conductance: &Conductance) -> Heat {
        let t = Temperatures { sides: [&self.t[0], &self.t[1]], conductance };
        self.contact.heat([&self.x[0], &self.x[1]], &self.lambda, t).unwrap()
    }

    /// The unknowns: positions, multipliers, temperatures.
    fn unknowns(&self) -> Vec<f64> {
        let (d, m) = self.numbers;
        let positions = self.x.iter().flatten().flat_map(|x| x.iter().take(d).copied().collect::<Vec<_>>());
        let multipliers = self.lambda.iter().flat_map(|l| l.iter().take(m).copied().collect::<Vec<_>>());
        positions.chain(multipliers).chain(self.t.iter().flatten().copied()).collect()
    }

    fn put(&mut self, values: &[f64]) {
        let (d, m) = self.numbers;
        let mut next = values.iter().copied();
        let mut take = || next.next().unwrap();
        self.x.iter_mut().flatten().for_each(|x| (0..d).for_each(|i| x[i] = take()));
        self.lambda.iter_mut().for_each(|l| (0..m).for_each(|i| l[i] = take()));
        self.t.iter_mut().flatten().for_each(|t| *t = take());
    }

    fn residual(&mut self, values: &[f64], conductance: &Conductance) -> Vec<f64> {
        self.put(values);
        self.heat(conductance).sides.concat()
    }

    /// The tangent, row by row.
    fn tangent(&mut self, conductance: &Conductance, with_motion: bool) -> Vec<f64> {
        let n = self.unknowns().len();
        let first = n - self.t[0].len() - self.t[1].len();
        let one: Vec<i64> = (first..first + self.t[0].len()).map(|e| e as i64).collect();
        let two: Vec<i64> = (first + self.t[0].len()..n).map(|e| e as i64).collect();
        let mut k = vec![0.0; (n - first) * n];
        let mut sink = |i: i64, j: i64, v: f64| k[(i as usize - first) * n + j as usize] += v;
        let t = Temperatures { sides: [&self.t[0], &self.t[1]], conductance };
        let x = [&self.x[0][..], &self.x[1][..]];
        self.contact.heat_tangent(x, &self.lambda, t, ([&one, &two], with_motion), &mut sink).unwrap();
        k
    }

    /// Of every block: by positions, by multipliers, by temperatures.
    fn check(&mut self, conductance: &Conductance, what: &str) {
        let (at, (d, m)) = (self.unknowns(), self.numbers);
        let (k, n) = (self.tangent(conductance, true), at.len());
        let noise = NOISE * max_abs(self.residual(&at, conductance));
        let rows = k.len() / n;
        let mut differences = vec![0.0; k.len()];
        for j in 0..n {
            let mut moved = at.clone();
            moved[j] = at[j] + STEP;
            let (more, up) = (self.residual(&moved, conductance), moved[j]);
            moved[j] = at[j] - STEP;
            let less = self.residual(&moved, conductance);
            (0..rows).for_each(|i| differences[i * n + j] = (more[i] - less[i]) / (up - moved[j]));
        }
        self.put(&at);
        let a = d * (self.x[0].len() + self.x[1].len());
        for (name, columns) in [
            ("positions", 0..a),
            ("multipliers", a..a + m * self.lambda.len()),
            ("temperatures", a + m * self.lambda.len()..n),
        ] {
            let block = || (0..rows).flat_map(|i| columns.clone().map(move |j| i * n + j));
            let error = max_abs(block().map(|t| k[t] - differences[t]));
            let largest = max_abs(block().map(|t| k[t]));
            let bound = DIFFERENCES * largest + noise;
            assert!(error <= bound, "{what}, by {name}: {error:e} of {largest:e}, noise {noise:e}");
        }
        let (alone, first) = (self.tangent(conductance, false), n - rows);
        for i in 0..rows {
            assert!((0..first).all(|j| alone[i * n + j] == 0.0));
            assert!((first..n).all(|j| alone[i * n + j] == k[i * n + j]));
        }
        self.balance(conductance, what);
    }

    /// What friction makes is all that the bodies get; equal temperatures pass nothing.
    fn balance(&mut self, conductance: &Conductance, what: &str) {
        let heat = self.heat(conductance);
        let (one, two) = self.contact.evaluate(&self.x[0], &self.x[1], &self.lambda, None).unwrap();
        assert_eq!(one.len(), two.len());
        let work: f64 = two.iter().map(|r| r.traction.dot(&r.slip)).sum();
        let made = if conductance.time > 0.0 { work / conductance.time } else { 0.0 };
        let all = heat.sides.concat();
        let error = (all.iter().sum::<f64>() + made).abs();
        let scale = all.iter().map(|q| q.abs()).sum::<f64>() + made.abs();
        assert!(error <= ROUNDING * scale, "{what}: {error:e} of {scale:e}");
        let still = Conductance { time: 0.0, ..*conductance };
        let t = std::mem::replace(&mut self.t, [vec![291.7; self.x[0].len()], vec![291.7; self.x[1].len()]]);
        assert!(self.heat(&still).sides.concat().iter().all(|q| *q == 0.0), "{what}");
        self.t = t;
    }
}

#[test]
fn tangents_equal_differences_and_heat_is_conserved() {
    let mut passes = 0;
    let forms = [(Form::Multiplier, BASES[0]), (Form::Multiplier, BASES[1]), (Form::Augmented, BASES[0])];
    each_moved(forms, options(), |t, what| {
        let mut scene = Scene::new(&mut t.interface, [&t.x1, &t.x2], &t.lambda, (3, 3));
        scene.check(&ALL, what);
        passes += scene.heat(&ALL).nodes.iter().filter(|(_, flow)| flow.flux != 0.0).count();
    });
    assert!(passes > 100, "{passes}");
}

#[test]
fn the_same_with_one_multiplier_carried_nodes_points_and_offsets() {
    for (basis, normals) in BASES.into_iter().flat_map(|basis| NORMALS.map(|normals| (basis, normals))) {
        for cells in [Cells::Quads, Cells::Triangles] {
            let of = Options { basis, normals, weak_coverage: weak::WEAK, rule: &DEGREE_10, ..options() };
            let what = format!("{basis:?} {normals:?} {}", cells == Cells::Quads);
            let mut s = weak::scene::<1>(&Options { friction: Friction::None, mu: 0.0, ..of }, cells);
            Scene::new(&mut s.contact, [&s.x1, &s.x2], &s.lambda, (3, 1)).check(&ALL, &what);
            assert!(s.contact.counters().nodes.carried > 0);
            let mut s = weak::scene::<3>(&of, cells);
            Scene::new(&mut s.contact, [&s.x1, &s.x2], &s.lambda, (3, 3)).check(&ALL, &what);
            let mut t = moved(&Options { basis, normals, rule: &DEGREE_10, ..options() }, [cells, cells], FLAT, 3);
            let (n1, n2, mut random) = (t.x1.len(), t.x2.len(), Random(5));
            let mut some = |n: usize| Some((0..n).map(|_| 0.02 * random.next()).collect());
            t.interface.set_offsets([some(n1), some(n2)]).unwrap();
            Scene::new(&mut t.interface, [&t.x1, &t.x2], &t.lambda, (3, 3)).check(&ALL, &format!("{what} offsets"));
        }
        for scheme in [2, 5].map(|n| Scheme::Elements(stickslip::quadrature::cell::line_of(n).unwrap())) {
            let of = Options { basis, normals, scheme, weak_coverage: NO_WEAK_COVERAGE, ..options() };
            let mut t = moved(&of, [Cells::Quads, Cells::Quads], FLAT, 3);
            Scene::new(&mut t.interface, [&t.x1, &t.x2], &t.lambda, (3, 3)).check(&ALL, &format!("{basis:?} points"));
        }
    }
}

/// With conserving weights by temperatures alone: pressures and slip are those half way, weights of now.
#[test]
fn with_conserving_weights_heat_is_conserved() {
    for basis in BASES {
        let of = Options { basis, weights: Weights::Conserving, weak_coverage: NO_WEAK_COVERAGE, ..options() };
        let mut t = moved(&of, [Cells::Quads, Cells::Triangles], FLAT, 3);
        let mut scene = Scene::new(&mut t.interface, [&t.x1, &t.x2], &t.lambda, (3, 3));
        scene.balance(&ALL, &format!("{basis:?}"));
        let (at, k) = (scene.unknowns(), scene.tangent(&ALL, false));
        let (n, rows) = (at.len(), k.len() / at.len());
        let noise = NOISE * max_abs(scene.residual(&at, &ALL));
        for j in n - rows..n {
            let shifted =
                |by: f64| at.iter().enumerate().map(|(i, v)| if i == j { v + by } else { *v }).collect::<Vec<_>>();
            let (more, less) = (scene.residual(&shifted(STEP), &ALL), scene.residual(&shifted(-STEP), &ALL));
            for i in 0..rows {
                let error = (k[i * n + j] - (more[i] - less[i]) / (2.0 * STEP)).abs();
                assert!(error <= DIFFERENCES * max_abs(k.iter().copied()) + noise, "{basis:?}: {error:e}");
            }
        }
        scene.put(&at);
        let (heat, answers) = (scene.heat(&ALL), scene.contact.evaluate(&scene.x[0], &scene.x[1], &scene.lambda, None));
        let pressures: Vec<f64> = (0..heat.nodes.len())
            .map(|a| scene.contact.normal(a).unwrap().dot(&answers.as_ref().unwrap().1[a].traction))
            .collect();
        for (node, along) in heat.nodes.iter().zip(pressures).filter(|((node, _), _)| node.area > 0.0) {
            assert!(
                (node.0.pressure - (-along).max(0.0)).abs() <= ROUNDING * along.abs(),
                "{basis:?}: along the normals half way"
            );
        }
    }
}

#[test]
fn the_same_with_every_measure_of_slip() {
    for (slip, normals) in
        [SlipMeasure::Increment, SlipMeasure::Paper].into_iter().flat_map(|slip| NORMALS.map(|normals| (slip, normals)))
    {
        let mut t = moved(&Options { slip, normals, ..options() }, [Cells::Triangles; 2], FLAT, 3);
        let what = format!("{slip:?} {normals:?}");
        Scene::new(&mut t.interface, [&t.x1, &t.x2], &t.lambda, (3, 3)).check(&ALL, &what);
    }
}

#[test]
fn the_same_of_quadratic_facets_and_of_lines() {
    let spaces = [MultiplierSpace::Corner, MultiplierSpace::Sub].map(|space| (space, MultiplierBasis::Standard));
    let spaces = spaces.into_iter().chain([(MultiplierSpace::Corner, MultiplierBasis::Dual)]);
    for ((space, basis), friction) in spaces.flat_map(|s| [Friction::Coulomb, Friction::Tied].map(|f| (s, f))) {
        let weak_coverage = if basis == MultiplierBasis::Dual { 0.4 } else { NO_WEAK_COVERAGE };
        let normals = NORMALS[usize::from(friction == Friction::Coulomb)];
        let of = Options { space, basis, normals, rule: &DEGREE_10, weak_coverage, ..options() };
        let of = under(friction, 0.7, of);
        for kinds in [[&[6][..], &[6][..]], [&[8], &[9]], [&[9], &[4]], [&[3], &[8]]] {
            for prescribed in [false, true] {
                let mut s = moved_parents::<3>(&of, kinds, FLAT, 0.0, prescribed, 3);
                let mut scene = Scene::new(&mut s.contact, [&s.x1, &s.x2], &s.lambda, (3, 3));
                let what = format!("{kinds:?} {space:?} {basis:?} {friction:?}");
                if prescribed {
                    scene.balance(&ALL, &what);
                } else {
                    scene.check(&ALL, &what);
                }
            }
        }
        for (nodes, measure) in [[2, 2], [3, 2], [2, 3], [3, 3]]
            .into_iter()
            .flat_map(|n| [Measure::Thickness(0.7), Measure::Axisymmetric].map(|m| (n, m)))
        {
            let mut s = moved_lines::<3>(&of, nodes, measure, 5);
            let what = format!("{nodes:?} {measure:?} {space:?} {basis:?} {friction:?}");
            Scene::new(&mut s.contact, [&s.x1, &s.x2], &s.lambda, (2, components(3))).check(&ALL, &what);
        }
    }
}

/// A mortar side at rest has temperatures, and the same columns as one that moves but for its own.
#[test]
fn a_mortar_side_at_rest_has_temperatures() {
    for basis in BASES {
        for quadratic in [false, true] {
            let of = Options { basis, weak_coverage: NO_WEAK_COVERAGE, rule: &DEGREE_10, ..options() };
            let [one, two] = if quadratic {
                [
                    grid_of(2, 2, [0.0, 0.0], [1.0, 1.0], false, &[8]),
                    grid_of(3, 2, [-0.3, -0.2], [1.2, 1.3], true, &[9]),
                ]
            } else {
                let cells = Cells::Triangles;
                [
                    grid(3, 2, [0.0, 0.0], [1.0, 1.0], -0.01, false, cells),
                    grid(2, 3, [-0.3, -0.2], [1.2, 1.3], 0.0, true, cells),
                ]
            };
            let mut random = Random(5);
            let x1: Vec<_> = one.x.iter().map(|x| x + Vec3::new(random.next(), random.next(), 0.0) * 0.01).collect();
            let lambda: Vec<_> = x1.iter().map(|_| Vec3::new(0.1, 0.2, -1.0) + random.vector(0.1)).collect();
            let columns = |prescribed: bool| {
                let mut c: Contact<3> = contact_of(&one, &two, prescribed, of);
                let mut scene = Scene::new(&mut c, [&x1, &two.x], &lambda, (3, 3));
                let k = scene.tangent(&ALL, true);
                let n = scene.unknowns().len();
                let (a, b) = (3 * one.x.len(), 3 * (one.x.len() + two.x.len()));
                k.chunks(n).flat_map(|row| [&row[..a], &row[b..]].concat()).collect::<Vec<_>>()
            };
            let (moves, rests) = (columns(false), columns(true));
            let largest = max_abs(moves.iter().copied());
            let error = max_abs(moves.iter().zip(&rests).map(|(a, b)| a - b));
            assert!(largest > 0.0 && error <= ROUNDING * largest, "{basis:?} {quadratic}: {error:e} of {largest:e}");
        }
    }
}

/// The integral of N_B over a flat surface of these nodes, by one of its own facets after the other.
fn shares(mesh: &Mesh) -> Vec<f64> {
    let surface =
        Surface::new("nonmortar", mesh.x.clone(), &mesh.facets, vec![[NO_EQUATION; 3]; mesh.x.len()]).unwrap();
    let mut shares = vec![0.0; mesh.x.len()];
    for facet in &surface.facets {
        let x = facet.as_slice().iter().map(|&k| mesh.x[k]).collect::<Vec<_>>();
        assert!(x.len() == 3, "of triangles alone");
        let area = 0.5 * (x[1] - x[0]).cross(&(x[2] - x[0])).norm();
        facet.as_slice().iter().for_each(|&k| shares[k] += area / 3.0);
    }
    shares
}

/// Temperatures linear on either side with a jump of q / h: every node gets q times its share, over meshes that do not match,
/// with both bases, at a gap, and at conductances that are nearly perfect.
#[test]
fn a_linear_temperature_passes_exactly() {
    for basis in BASES {
        for (h, gap) in [(3.0, 0.0), (1e9, 0.0), (0.01, 0.2)] {
            let one = grid(3, 2, [0.0, 0.0], [1.0, 1.0], gap, false, Cells::Triangles);
            let two = grid(4, 5, [0.0, 0.0], [1.0, 1.0], 0.0, true, Cells::Triangles);
            let of = Options { basis, weak_coverage: NO_WEAK_COVERAGE, ..options() };
            let mut c: Interface = interface(&one, &two, of);
            let q = 0.7;
            let along = |x: &Vec3| 20.0 + 3.0 * x.x - 2.0 * x.y;
            let t: Vec<f64> = one.x.iter().map(|x| along(x) + q / h).collect();
            let lambda = vec![Vec3::new(0.0, 0.0, -1.0); one.x.len()];
            let mut scene = Scene::new(&mut c, [&one.x, &two.x], &lambda, (3, 3));
            scene.t = [t, two.x.iter().map(along).collect()];
            let heat = scene.heat(&Conductance { constant: h, ..CONSTANT });
            // What rounding makes of temperatures of size 20 that conductances multiply.
            let bound = PATCH * (1.0 + 20.0 * h * 1e-3);
            for (mesh, of_side, sign) in [(&one, &heat.sides[0], 1.0), (&two, &heat.sides[1], -1.0)] {
                for (share, found) in shares(mesh).iter().zip(of_side) {
                    assert!((found - sign * q * share).abs() <= bound, "{basis:?} {h}: {found} {share}");
                }
            }
        }
    }
}

/// Heat crosses gaps where the surfaces are apart and forces look at nothing.
#[test]
fn gas_conducts_where_surfaces_are_apart() {
    let one = grid(3, 2, [0.0, 0.0], [1.0, 1.0], 5.0, false, Cells::Quads);
    let two = grid(2, 3, [-0.3, -0.2], [1.3, 1.4], 0.0, true, Cells::Quads);
    let mut c: Interface = interface(&one, &two, options());
    let lambda = vec![Vec3::zeros(); one.x.len()];
    let far: Vec<_> = one.x.iter().map(|x| x + Vec3::new(0.0, 0.0, 0.1)).collect();
    let before = c.residual(&far, &two.x, &lambda, None).unwrap();
    assert!(c.counters().evaluations_apart > 0);
    let mut scene = Scene::new(&mut c, [&one.x, &two.x], &lambda, (3, 3));
    scene.t = [vec![2.0; one.x.len()], vec![0.0; two.x.len()]];
    let gas = Conductance { constant: 0.0, gas: 0.6, gas_gap: 1.0, reach: 9.0, ..CONSTANT };
    let all: f64 = scene.heat(&gas).sides[0].iter().sum();
    assert!((all - 0.6 / 6.0 * 2.0).abs() <= ROUNDING, "{all}");
    let none = scene.heat(&Conductance { reach: 4.5, ..gas });
    assert!(none.sides.concat().iter().all(|q| *q == 0.0));
    scene.check(&gas, "apart");
    assert_eq!(c.residual(&far, &two.x, &lambda, None).unwrap(), before);
}

/// Rings carry 2 pi r of heat.
#[test]
fn an_axisymmetric_interface_passes_what_its_rings_have() {
    for basis in BASES {
        let [one, two] = [lines(3, 2, [1.0, 2.0], false), lines(5, 2, [1.0, 2.0], true)];
        let of = Options { basis, weak_coverage: NO_WEAK_COVERAGE, rule: &DEGREE_10, ..options() };
        let mut c = contact_of_lines::<3>(&one, &two, Measure::Axisymmetric, of);
        let lambda = vec![Vec3::new(0.0, -1.0, 0.0); one.x.len()];
        let mut scene = Scene::new(&mut c, [&one.x, &two.x], &lambda, (2, 2));
        scene.t = [vec![1.5; one.x.len()], vec![1.0; two.x.len()]];
        let heat = scene.heat(&CONSTANT);
        let area = std::f64::consts::PI * (4.0 - 1.0);
        assert!((heat.sides[0].iter().sum::<f64>() - 3.0 * 0.5 * area).abs() <= ROUNDING * 10.0);
    }
}

#[test]
fn parts_add_up_to_the_whole() {
    let one = grid(4, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Triangles);
    let two = grid(3, 4, [-0.1, -0.1], [1.1, 1.2], 0.0, true, Cells::Quads);
    for basis in BASES {
        let of = Options { basis, weak_coverage: NO_WEAK_COVERAGE, rule: &DEGREE_10, ..options() };
        let mut random = Random(9);
        let x1: Vec<_> = one.x.iter().map(|x| x + random.vector(0.004)).collect();
        let lambda: Vec<_> = x1.iter().map(|_| Vec3::new(0.1, 0.2, -1.0) + random.vector(0.1)).collect();
        let (n1, n2) = (one.x.len(), two.x.len());
        let n = 3 * (2 * n1 + n2) + n1 + n2;
        let equations = |first: usize, n: usize| (first..first + n).map(|e| e as i64).collect::<Vec<_>>();
        let [e1, e2] = [equations(n - n1 - n2, n1), equations(n - n2, n2)];
        let mut c: Interface = interface(&one, &two, of);
        let mut scene = Scene::new(&mut c, [&x1, &two.x], &lambda, (3, 3));
        let (t, whole, k) = (scene.t.clone(), scene.heat(&ALL).sides.concat(), scene.tangent(&ALL, true));
        let (mut heat, mut sum) = (vec![0.0; n1 + n2], vec![0.0; k.len()]);
        for half in [true, false] {
            let own = one.x.iter().map(|x| (x.x < 0.4) == half).collect();
            let mut p = part::<3>((&one, &two), of, (own, 2), &(0..two.facets.len()).collect::<Vec<_>>()).unwrap();
            let (y1, y2, l) = p.at(&x1, &two.x, &lambda);
            let here = [p.of(0, &t[0]), p.of(1, &t[1])];
            let t = Temperatures { sides: [&here[0], &here[1]], conductance: &ALL };
            let found = p.contact.heat([&y1, &y2], &l, t).unwrap();
            p.nodes[0].iter().zip(&found.sides[0]).for_each(|(&k, q)| heat[k] += q);
            p.nodes[1].iter().zip(&found.sides[1]).for_each(|(&k, q)| heat[n1 + k] += q);
            let mut sink = |i: i64, j: i64, v: f64| sum[(i as usize + n1 + n2 - n) * n + j as usize] += v;
            let here = [p.of(0, &e1), p.of(1, &e2)];
            p.contact.heat_tangent([&y1, &y2], &l, t, ([&here[0], &here[1]], true), &mut sink).unwrap();
        }
        for (found, whole) in [(heat, whole), (sum, k)] {
            let largest = max_abs(whole.iter().copied());
            let error = max_abs(found.iter().zip(&whole).map(|(a, b)| a - b));
            assert!(largest > 0.0 && error <= ROUNDING * largest, "{basis:?}: {error:e} of {largest:e}");
        }
    }
}

/// An analytic plane has the temperatures of its frame's points, as a meshed one those of its nodes.
#[test]
fn a_tool_in_closed_form_passes_what_a_meshed_one_does() {
    let one = grid(2, 3, [0.0, 0.0], [1.0, 1.0], 0.01, false, Cells::Quads);
    let two = grid(1, 1, [-0.5, -0.5], [1.5, 1.5], 0.0, true, Cells::Quads);
    let frame = vec![Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()];
    let lambda = vec![Vec3::zeros(); one.x.len()];
    let t1: Vec<f64> = one.x.iter().map(|x| 300.0 + 7.0 * x.x * x.y).collect();
    for (basis, slope) in BASES.into_iter().flat_map(|basis| [0.0, 5.0].map(|slope| (basis, slope))) {
        let of = |x: &Vec3| 290.0 + slope * (x.x - 0.5 * x.y);
        let nonmortar = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, one.x.len())).unwrap();
        let plane = Surface::analytic("mortar", AnalyticShape::Plane, frame.clone()).unwrap();
        let options = Options { basis, ..options() };
        let multipliers = numbered(3 * one.x.len(), one.x.len());
        let mut tool = Contact::<3>::create(nonmortar, plane, multipliers, options).unwrap();
        let mut meshed: Interface = interface(&one, &two, options);
        let heat = |c: &mut Contact<3>, x2: &[Vec3]| {
            let t2: Vec<f64> = x2.iter().map(of).collect();
            let t = Temperatures { sides: [&t1, &t2], conductance: &CONSTANT };
            c.heat([&one.x, x2], &lambda, t).unwrap().sides
        };
        let (of_tool, of_mesh) = (heat(&mut tool, &frame), heat(&mut meshed, &two.x));
        let scale = max_abs(of_mesh[0].iter().copied());
        let error = max_abs(of_tool[0].iter().zip(&of_mesh[0]).map(|(a, b)| a - b));
        let [total, expected] = [&of_tool[1], &of_mesh[1]].map(|q| q.iter().sum::<f64>());
        assert!(error <= PATCH * scale, "{basis:?} {slope}: {error:e} of {scale:e}");
        assert!((total - expected).abs() <= PATCH * expected.abs(), "{basis:?} {slope}: {total} for {expected}");
    }
}

#[test]
fn what_has_no_heat_is_refused() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let (lambda, t1) = (vec![Vec3::zeros(); one.x.len()], vec![0.0; one.x.len()]);
    let two = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, true, Cells::Quads);
    let mut c: Interface = interface(&one, &two, options());
    let t2 = vec![0.0; two.x.len()];
    let t = Temperatures { sides: [&t1, &t2], conductance: &CONSTANT };
    let x = [&one.x[..], &two.x[..]];
    assert!(c.heat(x, &lambda, t).is_ok());
    let short = Temperatures { sides: [&t1[1..], &t2], conductance: &CONSTANT };
    assert_eq!(c.heat(x, &lambda, short).unwrap_err().kind, Kind::InvalidSize);
    let bad = vec![f64::NAN; one.x.len()];
    let bad = Temperatures { sides: [&bad, &t2], conductance: &CONSTANT };
    assert_eq!(c.heat(x, &lambda, bad).unwrap_err().kind, Kind::NotFinite);
}
