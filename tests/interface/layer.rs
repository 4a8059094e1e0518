//! What lies between the surfaces (docs/formulation 20): tangents against differences, what each part of it does, what is remembered.

use super::weak;
use crate::support::differences::Point;
use crate::support::lines::moved_lines;
use crate::support::mesh::*;
use crate::support::parents::moved_parents;
use nalgebra::{DMatrix, DVector, SVector};
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Form, Interface, MultiplierBasis, NO_WEAK_COVERAGE, Normals, Options, Scales, Weights,
};
use stickslip::law::{Bond, Layer, Overclosure, Own, SlipMeasure, Squeeze, State};
use stickslip::line::Measure;
use stickslip::mortar::MultiplierSpace;
use stickslip::quadrature::{DEGREE_5, DEGREE_10};

/// The tangent against differences, relative to the largest entry of a block.
const DIFFERENCES: f64 = 1e-7;
const BASES: [MultiplierBasis; 2] = [MultiplierBasis::Standard, MultiplierBasis::Dual];
const FORMS: [Form; 2] = [Form::Multiplier, Form::Augmented];
const BOND: Bond = Bond { stiffness: 11.0, strength: 0.2, toughness: 0.05, shear: 0.7 };

fn table(points: &[(f64, f64)]) -> Overclosure {
    let points: Vec<_> = points.iter().map(|&(overclosure, pressure)| Squeeze { overclosure, pressure }).collect();
    Overclosure::new(&points).unwrap()
}

fn overclosure() -> Option<Overclosure> {
    Some(table(&[(-0.02, 0.0), (0.02, 0.25), (0.06, 1.1)]))
}

pub fn worn() -> Layer {
    Layer { wear: Some(0.1), ..Layer::default() }
}

/// Each alone, and all of them.
fn layers() -> [Layer; 4] {
    [
        Layer { overclosure: overclosure(), ..Layer::default() },
        worn(),
        Layer { bond: Some(BOND), ..Layer::default() },
        Layer { overclosure: overclosure(), wear: Some(0.1), bond: Some(BOND) },
    ]
}

fn error<const N: usize>(contact: &mut Contact<N>, x: (&[Vec3], &[Vec3]), lambda: &[SVector<f64, N>]) -> f64 {
    Point { contact, x1: x.0, x2: x.1, lambda }.difference_error(0.0)
}

#[test]
fn tangents_equal_differences() {
    let mut seen = [0; 3];
    for (what, rough, cells) in rough_scenes(0.05) {
        let rule = if cells[1] == Cells::Quads { &DEGREE_10 } else { &DEGREE_5 };
        for (form, basis) in FORMS.into_iter().flat_map(|form| BASES.map(|basis| (form, basis))) {
            for (weights, slip) in [
                (Weights::Current, SlipMeasure::Objective),
                (Weights::Current, SlipMeasure::Increment),
                (Weights::Committed, SlipMeasure::Objective),
            ] {
                for (weak_coverage, own) in
                    [(NO_WEAK_COVERAGE, None), (0.2, Some(Own::Weakening { after: 0.2, slip: 0.15 }))]
                {
                    for layer in layers() {
                        let of = Options { form, basis, weights, slip, weak_coverage, rule, mu: 0.7, ..options() };
                        let mut t = moved(&of, cells, rough, 3);
                        t.interface.set_law(own).unwrap();
                        let what = format!("{what} {form:?} {basis:?} {layer:?} {weights:?} {slip:?} {weak_coverage}");
                        t.interface.set_layer(Some(layer)).unwrap();
                        let error = error(&mut t.interface, (&t.x1, &t.x2), &t.lambda);
                        assert!(error <= DIFFERENCES, "{what}: {error:e}");
                        seen.iter_mut().zip(t.states()).for_each(|(all, here)| *all += here);
                    }
                }
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 50), "{seen:?}");
}

/// In the second step what is remembered counts, and turns with the surface.
#[test]
fn tangents_of_a_second_step_and_with_normals_of_now_equal_differences() {
    for (form, basis) in FORMS.into_iter().flat_map(|form| BASES.map(|basis| (form, basis))) {
        for layer in layers() {
            let what = format!("{form:?} {basis:?} {layer:?}");
            let of = Options { form, basis, weak_coverage: weak::WEAK, mu: 0.7, rule: &DEGREE_10, ..options() };
            let mut s = weak::scene::<3>(&of, Cells::Quads);
            s.contact.set_layer(Some(layer)).unwrap();
            let off = error(&mut s.contact, (&s.x1, &s.x2), &s.lambda);
            assert!(off <= DIFFERENCES, "carried, {what}: {off:e}");
            assert!(s.contact.counters().nodes.carried > 0);
        }
        for (layer, slip) in layers().into_iter().flat_map(|layer| [(layer, SlipMeasure::Objective)]) {
            let what = format!("{form:?} {basis:?} {layer:?} {slip:?}");
            let normals = Normals::Current;
            let of = Options {
                form,
                basis,
                normals,
                slip,
                weak_coverage: NO_WEAK_COVERAGE,
                rule: &DEGREE_5,
                mu: 0.7,
                ..options()
            };
            let rough = Roughness { warp: 0.12, jitter: 0.08, slide: 0.02 };
            let mut t = moved(&of, [Cells::Triangles; 2], rough, 3);
            t.interface.set_layer(Some(layer)).unwrap();
            let off = error(&mut t.interface, (&t.x1, &t.x2), &t.lambda);
            assert!(off <= DIFFERENCES, "normals of now, {what}: {off:e}");
            t.interface.commit(&t.x1, &t.x2, &t.lambda, None).unwrap();
            let turn = nalgebra::Rotation3::from_euler_angles(0.02, -0.03, 0.01);
            let x1: Vec<_> = t.x1.iter().map(|x| turn * x * 1.01).collect();
            let off = error(&mut t.interface, (&x1, &t.x2), &t.lambda);
            assert!(off <= DIFFERENCES, "normals of now, second step, {what}: {off:e}");
        }
    }
}

#[test]
fn tangents_of_quadratic_facets_and_of_lines_equal_differences() {
    for (space, basis) in
        [(MultiplierSpace::Sub, MultiplierBasis::Standard), (MultiplierSpace::Corner, MultiplierBasis::Dual)]
    {
        for layer in layers() {
            let what = format!("{space:?} {basis:?} {layer:?}");
            let weak_coverage = if basis == MultiplierBasis::Dual { 0.4 } else { NO_WEAK_COVERAGE };
            let of = Options { space, basis, rule: &DEGREE_10, weak_coverage, mu: 0.7, ..options() };
            let mut s = moved_parents::<3>(&of, [&[8], &[9]], FLAT, 0.0, false, 3);
            s.contact.set_layer(Some(layer)).unwrap();
            let off = error::<3>(&mut s.contact, (&s.x1, &s.x2), &s.lambda);
            assert!(off <= DIFFERENCES, "{what}: {off:e}");
        }
        for measure in [Measure::Thickness(0.7), Measure::Axisymmetric] {
            for layer in layers() {
                let what = format!("{space:?} {basis:?} {layer:?}");
                let of = Options { space, basis, rule: &DEGREE_10, mu: 0.7, ..options() };
                let mut s = moved_lines::<3>(&of, [3, 2], measure, 5);
                s.contact.set_layer(Some(layer)).unwrap();
                let off = s.difference_error();
                assert!(off <= DIFFERENCES, "lines, {measure:?} {what}: {off:e}");
            }
        }
    }
}

#[test]
fn one_multiplier_a_node_has_the_overclosure_alone() {
    for (form, basis) in FORMS.into_iter().flat_map(|form| BASES.map(|basis| (form, basis))) {
        let of = Options { form, basis, weak_coverage: weak::WEAK, rule: &DEGREE_10, ..options() };
        let mut s = weak::scene::<1>(&of, Cells::Quads);
        s.contact.set_layer(Some(Layer { overclosure: overclosure(), ..Layer::default() })).unwrap();
        let off = error(&mut s.contact, (&s.x1, &s.x2), &s.lambda);
        assert!(off <= DIFFERENCES, "{form:?} {basis:?}: {off:e}");
        assert_eq!(s.contact.set_layer(Some(worn())).unwrap_err().kind, Kind::InvalidValue);
    }
}

/// A non-mortar face of nodes on springs over a flat, wide mortar face at rest.
pub struct Springs {
    pub contact: Interface,
    pub x2: Vec<Vec3>,
    /// Where the springs are held, and how stiff they are an area.
    pub held: Vec<Vec3>,
    pub stiffness: Vec3,
    pub x1: Vec<Vec3>,
    pub lambda: Vec<Vec3>,
}

/// Of lengths and tractions near 1: a step as short as that is Newton's last but one.
const CONVERGED: f64 = 1e-10;

impl Springs {
    pub fn new(x1: &Mesh, stiffness: Vec3, options: Options, layer: Layer) -> Springs {
        let x2 = grid(1, 1, [-9.0, -9.0], [9.0, 9.0], 0.0, true, Cells::Quads);
        let mut contact = interface(x1, &x2, options);
        contact.set_layer(Some(layer)).unwrap();
        let lambda = vec![Vec3::zeros(); x1.x.len()];
        Springs { contact, x2: x2.x, held: x1.x.clone(), stiffness, x1: x1.x.clone(), lambda }
    }

    /// Newton's method; every spring acts on the whole area of its node. Gives the steps.
    pub fn solve(&mut self) -> usize {
        let n1 = self.x1.len();
        let (n2, areas) = (self.x2.len(), self.contact.history().areas.clone());
        let place = |k: i64| {
            let k = k as usize;
            if k < 3 * n1 { Some(k) } else { k.checked_sub(3 * n2).filter(|k| *k >= 3 * n1) }
        };
        for step in 1..60 {
            let r = self.contact.residual(&self.x1, &self.x2, &self.lambda, None).unwrap();
            let mut b = DVector::zeros(6 * n1);
            let mut k = DMatrix::zeros(6 * n1, 6 * n1);
            for a in 0..n1 {
                for i in 0..3 {
                    let c = self.stiffness[i] * areas[a];
                    b[3 * a + i] = r.nonmortar[a][i] + c * (self.x1[a][i] - self.held[a][i]);
                    b[3 * (n1 + a) + i] = r.rows[a][i];
                    k[(3 * a + i, 3 * a + i)] += c;
                }
            }
            let mut add = |i: i64, j: i64, v: f64| {
                if let (Some(i), Some(j)) = (place(i), place(j)) {
                    k[(i, j)] += v;
                }
            };
            self.contact.tangent(&self.x1, &self.x2, &self.lambda, None, &mut add).unwrap();
            let d = k.lu().solve(&b).unwrap();
            for a in 0..n1 {
                for i in 0..3 {
                    self.x1[a][i] -= d[3 * a + i];
                    self.lambda[a][i] -= d[3 * (n1 + a) + i];
                }
            }
            if d.amax() <= CONVERGED {
                return step;
            }
        }
        panic!("not converged at {:?} {:?}", self.held[0], self.x1[0]);
    }

    pub fn commit(&mut self) {
        self.contact.commit(&self.x1, &self.x2, &self.lambda, None).unwrap();
    }

    /// Worn depths of all nodes.
    fn worn(&self) -> Vec<f64> {
        (0..self.x1.len()).map(|a| self.contact.layer_state(a).worn).collect()
    }
}

pub fn face(z: f64) -> Mesh {
    grid(2, 2, [0.0, 0.0], [1.0, 1.0], z, false, Cells::Quads)
}

pub fn with(basis: MultiplierBasis, mu: f64) -> Options {
    Options {
        basis,
        mu,
        weak_coverage: NO_WEAK_COVERAGE,
        ..Options::paper(stickslip::interface::Stiffness::Augmentation(15.0))
    }
}

/// Overclosure over a bed of springs is a spring in line with another one, at any place of the table, whatever the augmentation is.
#[test]
fn a_soft_layer_takes_the_pressure_of_its_table() {
    for basis in BASES {
        for points in [&[(-0.1, 0.0), (0.1, 2.0), (0.2, 10.0)][..], &[(0.0, 0.0), (0.05, 4.0), (0.3, 6.0)]] {
            for depth in [-0.2, 0.02, 0.3, 0.9] {
                let layer = Layer { overclosure: Some(table(points)), ..Layer::default() };
                let mut s = Springs::new(&face(0.0), Vec3::repeat(8.0), with(basis, 0.3), layer);
                s.held.iter_mut().for_each(|x| x.z = -depth);
                s.x1.iter_mut().for_each(|x| x.z = -depth);
                let steps = s.solve();
                assert!(steps <= 8, "{basis:?} {depth}: {steps}");
                for (x, lambda) in s.x1.iter().zip(&s.lambda) {
                    let (p, of) = (-lambda.z, table(points));
                    assert!((8.0 * (x.z + depth) - p).abs() <= 1e-11, "{basis:?} {depth} {p}");
                    if p == 0.0 {
                        assert!(-x.z <= of.first() + CONVERGED);
                    } else {
                        assert!((of.at(p).0 + x.z).abs() <= 1e-11 && p > 0.0, "{basis:?} {depth}: {p}");
                    }
                }
                let e = s.contact.equilibrium(&s.x1, &s.x2, &s.lambda, None, &Scales::default()).unwrap();
                assert!(e.gap.value <= 1e-11 && e.traction.value <= 1e-11, "{basis:?} {depth}: {e:?}");
            }
        }
    }
}

/// Sums of a dozen products.
const ROUNDING: f64 = 1e-12;

/// A block under a pressure p that slides by s: the depth k p s, in one step as in ten.
#[test]
fn a_block_that_slides_under_a_pressure_is_worn_by_their_product() {
    let (k, p, mu, slide) = (0.05, 2.0, 0.3, 0.8);
    for basis in BASES {
        for slip in [SlipMeasure::Objective, SlipMeasure::Increment] {
            let all = [1, 10].map(|steps| {
                let layer = Layer { wear: Some(k), ..Layer::default() };
                let mut s = Springs::new(&face(0.0), Vec3::zeros(), Options { slip, ..with(basis, mu) }, layer);
                let mut dissipation = 0.0;
                for step in 1..=steps {
                    let way = slide * f64::from(step) / f64::from(steps);
                    s.x1 = s.held.iter().map(|x| x + Vec3::new(way, 0.0, -k * p * way)).collect();
                    s.lambda.fill(Vec3::new(mu * p, 0.0, -p));
                    let r = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
                    assert!(r.rows.iter().all(|row| row.amax() <= ROUNDING), "{basis:?}: {:?}", r.rows);
                    dissipation += (0..s.x1.len()).map(|a| s.contact.dissipation(a)).sum::<f64>();
                    s.commit();
                }
                let volume: f64 = (0..s.x1.len()).map(|a| s.contact.layer_state(a).volume).sum();
                assert!(
                    (volume - k * dissipation / mu).abs() <= ROUNDING && (volume - k * p * slide).abs() <= ROUNDING
                );
                s.worn()
            });
            for (one, ten) in all[0].iter().zip(&all[1]) {
                assert!((one - k * p * slide).abs() <= ROUNDING && (one - ten).abs() <= ROUNDING, "{one} {ten}");
            }
        }
    }
}

/// Columns of unequal heights under a common force: pressures level, each step by 1 / (1 + c k ds), which is exp(-c k s) to first order.
#[test]
fn columns_level_out() {
    let (c, k, mean, slide) = (4.0, 0.05, 3.0, 5.0);
    // Each a facet of its own, four nodes.
    let heights = |a: usize| 0.2 * (1.7 * (a / 4) as f64).sin();
    let column = |n: usize| {
        let x = 1.5 * n as f64;
        grid(1, 1, [x, 0.0], [x + 1.0, 1.0], heights(4 * n), false, Cells::Quads)
    };
    let columns = together(&[0, 1, 2].map(column));
    let run = |steps: u32| {
        let layer = Layer { wear: Some(k), ..Layer::default() };
        let mut s = Springs::new(&columns, Vec3::new(50.0, 50.0, c), with(MultiplierBasis::Dual, 0.0), layer);
        let areas = s.contact.history().areas.clone();
        let total: f64 = areas.iter().sum();
        let mean_of = |v: &dyn Fn(usize) -> f64| (0..areas.len()).map(|a| areas[a] * v(a)).sum::<f64>() / total;
        let (mut worn, mut factor) = (s.worn(), f64::NAN);
        let ds = slide / f64::from(steps);
        let mut apart: Vec<f64> = Vec::new();
        for step in 0..=steps {
            // The first step presses alone.
            let slip = if step == 0 { 0.0 } else { ds };
            let share = 1.0 + c * k * slip;
            let plate = -mean * share / c - mean_of(&|a| worn[a] + heights(a));
            s.held.iter_mut().enumerate().for_each(|(a, x)| {
                x.x += slip;
                x.z = plate + heights(a);
            });
            s.solve();
            let p: Vec<f64> = s.lambda.iter().map(|lambda| -lambda.z).collect();
            assert!((mean_of(&|a| p[a]) - mean).abs() <= 1e-10);
            let now: Vec<f64> = p.iter().map(|p| p - mean).collect();
            for (now, before) in now.iter().zip(&apart) {
                assert!((now * share - before).abs() <= 1e-10, "{now} {before}");
            }
            factor = now[4];
            apart = now;
            s.commit();
            worn = s.worn();
        }
        factor / (-c * (heights(4) - mean_of(&heights)))
    };
    let exact = (-c * k * slide).exp();
    let [coarse, fine] = [20, 40].map(|steps| run(steps) / exact - 1.0);
    assert!(fine > 0.0 && fine < 0.02 && (coarse / fine - 2.0).abs() < 0.1, "{coarse} {fine}");
}

/// A cylinder that slides along its axis on a plane is worn flat: a = (3 R k F s / 2)^(1/3), F a length.
#[test]
fn a_cylinder_is_worn_flat() {
    const PART: f64 = 0.01;
    let (radius, k, force, slide, stiffness) = (10.0, 1e-2, 3.0, 2.0, 2e5);
    let mut mesh = grid(48, 1, [-1.5, 0.0], [1.5, 1.0], 0.0, false, Cells::Quads);
    mesh.x.iter_mut().for_each(|x| x.z = x.x * x.x / (2.0 * radius));
    let layer = Layer { wear: Some(k), ..Layer::default() };
    let mut s =
        Springs::new(&mesh, Vec3::new(stiffness, stiffness, stiffness), with(MultiplierBasis::Dual, 0.0), layer);
    let mut depth = 0.0;
    let steps = 8;
    for step in 1..=steps {
        let slip = slide / f64::from(steps);
        let try_at = |s: &mut Springs, depth: f64| {
            s.held.iter_mut().zip(&mesh.x).for_each(|(held, x)| {
                *held = Vec3::new(x.x, x.y + slip * f64::from(step), x.z - depth);
            });
            s.solve();
            s.lambda.iter().zip(&s.contact.history().areas).map(|(l, area)| l.norm() * area).sum::<f64>() - force
        };
        let (mut a, mut b) = (depth, depth + 1e-3);
        let (mut fa, mut fb) = (try_at(&mut s, a), try_at(&mut s, b));
        for _ in 0..30 {
            if fb.abs() <= 1e-9 {
                break;
            }
            let c = b - fb * (b - a) / (fb - fa);
            (a, fa) = (b, fb);
            b = c;
            fb = try_at(&mut s, b);
        }
        assert!(fb.abs() <= 1e-9, "step {step}: {fb}");
        depth = b;
        s.commit();
    }
    let volume: f64 = (0..mesh.x.len()).map(|a| s.contact.layer_state(a).volume).sum();
    // The force is one along the normals, with areas of the step's start.
    assert!((volume / (k * force * slide) - 1.0).abs() <= 1e-6, "{volume}");
    let deepest = s.worn().into_iter().fold(0.0_f64, f64::max);
    let (a, exact) = ((2.0 * radius * deepest).sqrt(), (1.5 * radius * k * force * slide).cbrt());
    assert!((a / exact - 1.0).abs() <= PART, "{a} {exact}");
}

fn glued(basis: MultiplierBasis, mu: f64) -> Springs {
    let layer = Layer { bond: Some(BOND), ..Layer::default() };
    Springs::new(&face(0.0), Vec3::new(9.0, 9.0, 9.0), with(basis, mu), layer)
}

/// Pulled by springs that are stiffer than the bond softens: its traction at each opening, through cycles, and nothing in the end.
#[test]
fn a_bond_bears_what_its_law_says_and_does_not_heal() {
    for basis in BASES {
        let (mut s, mut kappa) = (glued(basis, 0.3), 0.0_f64);
        let mut damage = 0.0;
        for (pull, aside) in [
            (0.01, 0.0),
            (0.05, 0.02),
            (0.15, 0.1),
            (0.02, 0.01),
            (-0.05, 0.0),
            (0.15, 0.1),
            (0.3, 0.2),
            (0.0, 0.0),
            (0.3, 0.2),
            (0.9, 0.6),
            (0.1, 0.1),
        ] {
            let way = Vec3::new(aside, 0.0, pull);
            s.held = face(0.0).x.iter().map(|x| x + way).collect();
            s.solve();
            for (a, x) in face(0.0).x.iter().enumerate() {
                let (at, lambda) = (s.x1[a] - x, s.lambda[a]);
                let effective = at.z.max(0.0).hypot(BOND.shear * at.x);
                let (d, _) = BOND.damage(kappa.max(effective));
                assert!(((at - way) * 9.0 + lambda).amax() <= 1e-10, "{basis:?} {way}");
                if pull >= 0.0 {
                    let t = Vec3::new(BOND.shear * BOND.shear * at.x, 0.0, at.z) * (BOND.stiffness * (1.0 - d));
                    assert!((t - lambda).amax() <= 1e-10, "{basis:?} {way} {t} {lambda}");
                } else {
                    assert!(lambda.z < 0.0 && at.z.abs() <= 1e-12);
                }
            }
            let at = s.x1[4] - face(0.0).x[4];
            kappa = kappa.max(at.z.max(0.0).hypot(BOND.shear * at.x));
            s.commit();
            let now = s.contact.layer_state(4);
            assert!(now.damage >= damage && (now.damage - BOND.damage(kappa).0).abs() <= 1e-10, "{now:?}");
            damage = now.damage;
        }
        assert!(damage == 1.0 && (s.contact.layer_state(0).lost - BOND.toughness).abs() <= ROUNDING);
    }
}

/// Where nothing is left of it the residual, the tangent and the states are those without, in every bit, closed and open.
#[test]
fn a_bond_that_is_parted_is_not_there() {
    for basis in BASES {
        let mut s = glued(basis, 0.3);
        for pull in [0.9, 0.0] {
            s.held = face(0.0).x.iter().map(|x| x + Vec3::z() * pull).collect();
            s.solve();
            s.commit();
        }
        let mut bare = Springs::new(&face(0.0), Vec3::repeat(9.0), with(basis, 0.3), worn());
        bare.contact.set_layer(None).unwrap();
        bare.contact.set_previous(&s.x1, &s.x2).unwrap();
        for (z, shear) in [(-0.01, 0.1), (-0.01, 3.0), (0.02, 0.1)] {
            let x1: Vec<_> = s.x1.iter().map(|x| x + Vec3::new(0.02, 0.01, z)).collect();
            let lambda: Vec<_> = x1.iter().map(|x| Vec3::new(shear, 0.0, -1.0 - x.x)).collect();
            let of = |contact: &mut Interface| {
                let r = contact.residual(&x1, &s.x2, &lambda, None).unwrap();
                let mut entries = Vec::new();
                let mut sink = |i: i64, j: i64, v: f64| entries.push((i, j, v));
                contact.tangent(&x1, &s.x2, &lambda, None, &mut sink).unwrap();
                (r, entries)
            };
            assert!(of(&mut s.contact) == of(&mut bare.contact), "{basis:?} {z}");
        }
    }
}

/// A history that goes out and in has all that layers remember, to the bit; an undone commit too.
#[test]
fn what_is_remembered_travels_and_goes_back() {
    for basis in BASES {
        let layer = || Layer { overclosure: overclosure(), wear: Some(0.02), bond: Some(BOND) };
        let of = with(basis, 0.3);
        let mut s = Springs::new(&face(0.0), Vec3::repeat(9.0), of, layer());
        s.contact.set_law(Some(Own::Weakening { after: 0.1, slip: 0.3 })).unwrap();
        let step = |s: &mut Springs, pull: f64, aside: f64| {
            s.held = face(0.0).x.iter().map(|x| x + Vec3::new(aside, 0.5 * aside, pull)).collect();
            s.solve();
        };
        step(&mut s, -0.1, 0.2);
        s.commit();
        step(&mut s, 0.1, 0.3);
        s.commit();
        let states = s.contact.law_states().to_vec();
        assert_eq!(states.len(), 9 * (1 + 2 + 4));
        let (integers, reals) = s.contact.export_history().unwrap();
        let mut other = Springs::new(&face(0.0), Vec3::repeat(9.0), of, layer());
        other.contact.set_law(Some(Own::Weakening { after: 0.1, slip: 0.3 })).unwrap();
        other.contact.import_history(&integers, &reals).unwrap();
        assert_eq!(other.contact.law_states(), states);
        (other.x1, other.lambda) = (s.x1.clone(), s.lambda.clone());
        step(&mut s, -0.2, 0.5);
        step(&mut other, -0.2, 0.5);
        assert!(s.x1 == other.x1 && s.lambda == other.lambda, "{basis:?}");
        s.commit();
        assert!(s.contact.law_states() != states);
        s.contact.roll_back().unwrap();
        assert_eq!(s.contact.law_states(), states);
        // The law of friction goes, and what lies between the surfaces keeps what it knows.
        s.contact.set_law(None).unwrap();
        let of_layer = states.chunks(7).flat_map(|of| &of[1..]);
        assert!(s.contact.law_states().iter().eq(of_layer));
    }
}

/// It is no law of friction: without one of its parts nothing is there, and with a hard layer that is thin nothing changes much.
#[test]
fn an_interface_without_a_layer_remembers_nothing_of_it() {
    let mut s = Springs::new(&face(0.0), Vec3::repeat(9.0), with(MultiplierBasis::Dual, 0.3), worn());
    assert_eq!(s.contact.law_states().len(), 18);
    s.contact.set_layer(None).unwrap();
    assert!(s.contact.law_states().is_empty() && s.contact.surfaces().0.layer == [0.0; 2]);
    s.held.iter_mut().for_each(|x| x.z = -0.1);
    s.solve();
    let r = s.contact.responses(&s.x1, &s.x2, &s.lambda, None).unwrap();
    assert!(r.iter().all(|r| r.state == State::Stick));
}
