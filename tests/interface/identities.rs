//! What holds exactly (docs/formulation 7): balance of momentum, frame indifference, renumbering, offsets,
//! units, and the relation of the two forms.

use crate::support::mesh::*;
use nalgebra::Rotation3;
use stickslip::geometry::Vec3;
use stickslip::interface::{Form, Interface, NodeSums, Options, Residual, RowScale, Stiffness};
use stickslip::law::SlipMeasure;

/// 7.2 to 8.3: rounding, relative to the largest entry.
const ROUNDING: f64 = 1e-13;
/// 7.4: a rotated copy differs by the rounding of its coordinates.
const ROTATED: f64 = 1e-12;

const ROUGH: Roughness = Roughness { warp: 0.05, jitter: 0.08, slide: 0.02 };
const CELLS: [[Cells; 2]; 3] =
    [[Cells::Quads, Cells::Quads], [Cells::Triangles, Cells::Quads], [Cells::Triangles, Cells::Triangles]];

fn forms() -> [Options; 2] {
    [Form::Multiplier, Form::Augmented].map(|form| Options { form, ..options() })
}

impl Moved {
    fn residual(&mut self) -> Residual {
        self.interface.residual(&self.x1, &self.x2, &self.lambda, None).unwrap()
    }

    fn sums(&mut self) -> Vec<NodeSums> {
        self.interface.sums(&self.x1, &self.x2).unwrap()
    }

    /// The traction that the forces use.
    fn tractions(&mut self) -> Vec<Vec3> {
        if self.interface.options().form == Form::Multiplier {
            return self.lambda.clone();
        }
        let responses = self.interface.responses(&self.x1, &self.x2, &self.lambda, None).unwrap();
        responses.iter().map(|r| r.traction).collect()
    }
}

fn largest(v: &[Vec3]) -> f64 {
    v.iter().map(|v| v.amax()).fold(0.0, f64::max)
}

fn assert_close(a: &[Vec3], b: &[Vec3], tolerance: f64, what: &str) {
    let error = a.iter().zip(b).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
    let scale = largest(a).max(largest(b));
    assert!(error <= tolerance * scale, "{what}: {error:e} of {scale:e}");
}

fn assert_same(a: &Residual, b: &Residual, tolerance: f64, what: &str) {
    assert_close(&a.nonmortar, &b.nonmortar, tolerance, what);
    assert_close(&a.mortar, &b.mortar, tolerance, what);
    assert_close(&a.rows, &b.rows, tolerance, what);
}

/// The interface whose t_n is the image of `old`'s under `map`, with everything else equal.
fn image(old: &Interface, options: Options, map: impl Fn(&Vec3) -> Vec3) -> Interface {
    let (one, two) = old.surfaces();
    let facets = |s: &stickslip::interface::Surface| {
        s.facets.iter().map(|f| f.nodes[..f.len].iter().map(|&k| k as i64).collect()).collect::<Vec<Vec<i64>>>()
    };
    let mesh =
        |s: &stickslip::interface::Surface| Mesh { x: s.reference.iter().map(&map).collect(), facets: facets(s) };
    interface(&mesh(one), &mesh(two), options)
}

#[test]
fn forces_balance() {
    for options in forms() {
        for cells in CELLS {
            let mut scene = moved(&options, cells, ROUGH, 3);
            let r = scene.residual();
            let scale = largest(&r.nonmortar);
            let sum: Vec3 = r.nonmortar.iter().chain(&r.mortar).sum();
            assert!(sum.amax() <= ROUNDING * scale, "sum of forces {sum:?}");
        }
    }
}

/// 7.2: sum x x f = sum g x t exactly, which vanishes only where the gap is parallel to the traction.
#[test]
fn moments_equal_those_of_the_gaps() {
    for options in forms() {
        for cells in CELLS {
            let mut scene = moved(&options, cells, ROUGH, 3);
            let (r, sums, t) = (scene.residual(), scene.sums(), scene.tractions());
            let nodes = scene.x1.iter().zip(&r.nonmortar).chain(scene.x2.iter().zip(&r.mortar));
            let forces: Vec3 = nodes.map(|(x, f)| x.cross(f)).sum();
            let gaps: Vec3 = sums.iter().zip(&t).map(|(s, t)| s.gap_now.cross(t)).sum();
            assert!(gaps.amax() > 1e-6, "the identity is not tested where both sides vanish");
            assert!((forces - gaps).amax() <= ROUNDING * largest(&r.nonmortar), "{forces:?} {gaps:?}");
        }
    }
}

#[test]
fn rotated_scene_has_rotated_residual() {
    let q = Rotation3::from_euler_angles(0.7, -1.1, 2.3);
    for options in forms() {
        for cells in CELLS {
            let mut scene = moved(&options, cells, ROUGH, 5);
            let turn = |v: &[Vec3]| v.iter().map(|v| q * v).collect::<Vec<_>>();
            let mut turned = Moved {
                interface: image(&scene.interface, options, |x| q * x),
                x1: turn(&scene.x1),
                x2: turn(&scene.x2),
                lambda: turn(&scene.lambda),
            };
            let r = scene.residual();
            let expected = Residual { nonmortar: turn(&r.nonmortar), mortar: turn(&r.mortar), rows: turn(&r.rows) };
            assert_same(&turned.residual(), &expected, ROTATED, "rotation");
        }
    }
}

/// I6: a rigid motion within the step is no slip in the objective measure; the paper's measure sees one.
#[test]
fn rigid_motion_within_a_step_is_no_slip() {
    let slip_of = |slip: SlipMeasure, angle: f64| {
        let options = Options { slip, ..options() };
        let mut scene = moved(&options, CELLS[0], ROUGH, 5);
        let q = Rotation3::from_euler_angles(angle, -angle, 2.0 * angle);
        let shift = Vec3::new(1.0, -2.0, 0.5) * angle;
        let (one, two) = scene.interface.surfaces();
        let x1: Vec<_> = one.reference.iter().map(|x| q * x + shift).collect();
        let x2: Vec<_> = two.reference.iter().map(|x| q * x + shift).collect();
        let r = scene.interface.responses(&x1, &x2, &scene.lambda, None).unwrap();
        r.iter().map(|r| r.slip.amax()).fold(0.0, f64::max)
    };
    for angle in [0.0, 1e-3, 0.3, 2.0] {
        // Of an area 0.25 times a length 1.
        assert!(slip_of(SlipMeasure::Objective, angle) <= 1e-15, "angle {angle}");
    }
    assert_eq!(slip_of(SlipMeasure::Objective, 0.0), 0.0);
    assert!(slip_of(SlipMeasure::Paper, 0.0) > 1e-6);
}

#[test]
fn renumbering_permutes_the_result() {
    for options in forms() {
        let mut scene = moved(&options, CELLS[1], ROUGH, 9);
        let (one, two) = scene.interface.surfaces();
        let (n1, n2) = (one.len(), two.len());
        // new[k] = old[perm(k)]; facets in another order and begun at another node.
        let perm = |k: usize, n: usize| (k * 5 + 3) % n;
        let inverse = |old: usize, n: usize| (0..n).find(|&k| perm(k, n) == old).unwrap() as i64;
        let mesh = |s: &stickslip::interface::Surface, n: usize| Mesh {
            x: (0..n).map(|k| s.reference[perm(k, n)]).collect(),
            facets: s
                .facets
                .iter()
                .rev()
                .enumerate()
                .map(|(f, nodes)| (0..nodes.len).map(|k| inverse(nodes.nodes[(k + f) % nodes.len], n)).collect())
                .collect(),
        };
        let permuted = |v: &[Vec3]| (0..v.len()).map(|k| v[perm(k, v.len())]).collect::<Vec<_>>();
        let mut other = Moved {
            interface: interface(&mesh(one, n1), &mesh(two, n2), options),
            x1: permuted(&scene.x1),
            x2: permuted(&scene.x2),
            lambda: permuted(&scene.lambda),
        };
        let r = scene.residual();
        let expected =
            Residual { nonmortar: permuted(&r.nonmortar), mortar: permuted(&r.mortar), rows: permuted(&r.rows) };
        // A warped quad begun elsewhere is triangulated from the same mean vertex: rounding only.
        assert_same(&other.residual(), &expected, ROTATED, "renumbering");
    }
}

/// Coordinates on a grid of 2^-20, so that an offset of 2^20 is exact.
#[test]
fn exact_offset_changes_no_bit() {
    let grid = f64::from(1 << 20);
    let snap = |x: &Vec3| x.map(|v| (v * grid).round() / grid);
    for options in forms() {
        for cells in CELLS {
            let scene = moved(&options, cells, ROUGH, 11);
            let at = |offset: Vec3| {
                let place = |v: &[Vec3]| v.iter().map(|x| snap(x) + offset).collect::<Vec<_>>();
                let mut other = Moved {
                    interface: image(&scene.interface, options, |x| snap(x) + offset),
                    x1: place(&scene.x1),
                    x2: place(&scene.x2),
                    lambda: scene.lambda.clone(),
                };
                other.residual()
            };
            assert_eq!(at(Vec3::zeros()), at(Vec3::new(grid, -grid, 2.0 * grid)));
        }
    }
}

/// 7.5: length L -> aL, stress S -> bS, r -> r b / a^3 with powers of two: forces a^2 b, rows a^3.
#[test]
fn units_by_powers_of_two_change_no_bit() {
    for (a, b) in [(2f64.powi(10), 1.0), (2f64.powi(-20), 2f64.powi(30)), (2f64.powi(20), 2f64.powi(-7))] {
        for form in [Form::Multiplier, Form::Augmented] {
            for cells in CELLS {
                let base = Options { form, row_scale: RowScale::None, ..options() };
                let Stiffness::Augmentation(r) = base.stiffness else { unreachable!() };
                let scaled = Options { stiffness: Stiffness::Augmentation(r * b / a), ..base };
                let mut scene = moved(&base, cells, ROUGH, 13);
                let times = |v: &[Vec3], s: f64| v.iter().map(|v| v * s).collect::<Vec<_>>();
                let mut other = Moved {
                    interface: image(&scene.interface, scaled, |x| x * a),
                    x1: times(&scene.x1, a),
                    x2: times(&scene.x2, a),
                    lambda: times(&scene.lambda, b),
                };
                let (r, s) = (scene.residual(), other.residual());
                assert_eq!(s.nonmortar, times(&r.nonmortar, a * a * b));
                assert_eq!(s.mortar, times(&r.mortar, a * a * b));
                assert_eq!(s.rows, times(&r.rows, a * a * a));
            }
        }
    }
}

/// R_aug = R_mult + n^T r c (docs/formulation 5.2): the forms have the same solutions.
#[test]
fn forms_differ_by_the_rows() {
    for cells in CELLS {
        let unscaled = |form| Options { form, row_scale: RowScale::None, ..options() };
        let multiplier = moved(&unscaled(Form::Multiplier), cells, ROUGH, 3).residual();
        let mut scene = moved(&unscaled(Form::Augmented), cells, ROUGH, 3);
        let augmented = scene.residual();
        assert_eq!(multiplier.rows, augmented.rows);
        let correction: Vec<_> =
            multiplier.rows.iter().enumerate().map(|(a, c)| c * scene.interface.augmentation(a)).collect();
        let mut shifted = moved(&unscaled(Form::Multiplier), cells, ROUGH, 3);
        shifted.lambda.iter_mut().zip(&correction).for_each(|(l, c)| *l += c);
        let shifted = shifted.residual();
        assert_close(&shifted.nonmortar, &augmented.nonmortar, ROUNDING, "non-mortar forces");
        assert_close(&shifted.mortar, &augmented.mortar, ROUNDING, "mortar forces");
    }
}

/// mu = 0: no tangential force, and the result does not depend on where the step began.
#[test]
fn without_friction_history_does_not_matter() {
    let options = Options { mu: 0.0, ..options() };
    let mut scene = moved(&options, CELLS[0], FLAT, 3);
    let before = scene.residual();
    let (x1, x2): (Vec<_>, Vec<_>) = {
        let (one, two) = scene.interface.surfaces();
        let in_plane = Rotation3::from_euler_angles(0.4, -0.9, 1.3) * Vec3::new(0.07, -0.03, 0.0);
        (one.reference.iter().map(|x| x + in_plane).collect(), two.reference.clone())
    };
    scene.interface.set_previous(&x1, &x2).unwrap();
    assert_same(&scene.residual(), &before, ROTATED, "another t_n");
    let responses = scene.interface.responses(&scene.x1, &scene.x2, &scene.lambda, None).unwrap();
    for (a, r) in responses.iter().enumerate() {
        let nu = scene.interface.normal(a).unwrap();
        assert!((r.traction - nu * nu.dot(&r.traction)).amax() <= 1e-15);
    }
}
