//! Where the mortar surface ends inside the non-mortar one, lies deep below it, or is much larger: cases in
//! which a neighbour that would cancel an error is missing.

use crate::support::max_abs;
use crate::support::mesh::*;
use nalgebra::Rotation3;
use stickslip::geometry::Vec3;
use stickslip::interface::{Interface, NO_EQUATION, Options, RowScale, Stiffness, Surface};
use stickslip::law::State;

/// Central differences at 1e-6 in the direction of a smooth motion; kinks at the boundary's ends cost 1e-5.
const DIFFERENCES: f64 = 1e-4;

fn closed_box(low: [f64; 3], high: [f64; 3]) -> Mesh {
    let corner = |k: usize, i: usize| if k >> i & 1 == 0 { low[i] } else { high[i] };
    let facets = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh {
        x: (0..8).map(|k| Vec3::new(corner(k, 0), corner(k, 1), corner(k, 2))).collect(),
        facets: facets.iter().map(|f| f.iter().map(|&k| k as i64).collect()).collect(),
    }
}

/// A mortar boundary that follows interior non-mortar mesh lines, in general position: the assembled
/// residual is smooth along a rigid shift of the mortar side, and its derivative must be the tangent's.
#[test]
fn mortar_boundary_on_nonmortar_mesh_lines_is_differentiated() {
    let mut random = Random(5);
    for m in [1, 2] {
        for _ in 0..40 {
            let angles = random.vector(3.0);
            let q = Rotation3::from_euler_angles(angles.x, angles.y, angles.z);
            let turned = |mut mesh: Mesh| {
                mesh.x.iter_mut().for_each(|x| *x = q * *x);
                mesh
            };
            let one = turned(grid(4, 4, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads));
            let two = turned(grid(m, m, [0.25, 0.25], [0.75, 0.75], 0.0, true, Cells::Quads));
            let mut i = interface(&one, &two, options());
            let lambda: Vec<_> = one.x.iter().map(|_| q * Vec3::new(0.1, 0.2, -1.0)).collect();
            // A turn in the plane about a generic point.
            let axis = q * Vec3::z();
            let centre = q * Vec3::new(0.4, 0.55, 0.0);
            let speed: Vec<_> = two.x.iter().map(|x| axis.cross(&(x - centre))).collect();
            let forces = |i: &mut Interface, h: f64| {
                let x2: Vec<_> = two.x.iter().zip(&speed).map(|(x, v)| x + v * h).collect();
                let r = i.residual(&one.x, &x2, &lambda, None).unwrap();
                r.nonmortar.iter().flat_map(|f| [f.x, f.y, f.z]).collect::<Vec<f64>>()
            };
            let h = 1e-6;
            let (plus, minus) = (forces(&mut i, h), forces(&mut i, -h));
            let mut exact = vec![0.0; plus.len()];
            let (first, n1) = (3 * one.x.len() as i64, plus.len() as i64);
            i.tangent(&one.x, &two.x, &lambda, None, &mut |row: i64, column: i64, v: f64| {
                if row < n1 && (first..first + 3 * two.x.len() as i64).contains(&column) {
                    let c = (column - first) as usize;
                    exact[row as usize] += v * speed[c / 3][c % 3];
                }
            })
            .unwrap();
            let scale = max_abs(exact.iter().copied());
            let error = max_abs((0..plus.len()).map(|k| (plus[k] - minus[k]) / (2.0 * h) - exact[k]));
            assert!(error <= DIFFERENCES * scale, "{m} x {m}: off by {:e}", error / scale);
        }
    }
}

/// A closed block that stands on a closed plate touches it with its bottom alone.
#[test]
fn back_faces_are_no_contact() {
    let block = closed_box([0.0; 3], [1.0; 3]);
    let plate = closed_box([-1.0, -1.0, -0.2], [2.0, 2.0, 0.0]);
    let mut i = interface(&block, &plate, Options::paper(Stiffness::Modulus(1000.0)));
    let lambda = i.initial_multipliers().unwrap();
    let responses = i.responses(&block.x, &plate.x, &lambda, None).unwrap();
    for (a, x) in block.x.iter().enumerate() {
        assert_eq!(responses[a].state != State::Gap, x.z == 0.0, "node at {x:?}");
    }
}

#[test]
fn of_layers_the_nearest_is_met_whatever_the_host_says_how_far() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let mut two = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], 0.0, true, Cells::Quads);
    let lower = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], -0.5, true, Cells::Quads);
    two.facets.push(lower.facets[0].iter().map(|k| k + 4).collect());
    two.x.extend(&lower.x);
    let create = |search_distance| {
        let nonmortar = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, 9)).unwrap();
        let mortar = Surface::new("mortar", two.x.clone(), &two.facets, numbered(27, 8)).unwrap();
        Interface::new(nonmortar, mortar, numbered(51, 9), Options { search_distance, ..options() })
    };
    let [all, near] = [None, Some(0.2)].map(|distance| create(distance).unwrap());
    assert_eq!(all.history(), near.history());
}

/// However long the fall, what lies below is found: the surfaces' own extent is the limit.
#[test]
fn a_fall_within_one_step_ends_on_the_plate_in_any_orientation() {
    for angle in [0.0, 0.7] {
        let q = Rotation3::from_euler_angles(angle, 0.3 * angle, 0.0);
        let turned = |m: Mesh| Mesh { x: m.x.iter().map(|x| q * x).collect(), facets: m.facets };
        let pin = turned(grid(1, 1, [0.0, 0.0], [0.1, 0.1], 0.5, false, Cells::Quads));
        let plate = turned(grid(3, 3, [-1.0, -1.0], [1.0, 1.0], 0.0, true, Cells::Quads));
        let mut i = interface(&pin, &plate, options());
        let fallen: Vec<_> = pin.x.iter().map(|x| x - q * Vec3::z() * 0.51).collect();
        let responses = i.responses(&fallen, &plate.x, &[Vec3::zeros(); 4], None).unwrap();
        assert!(responses.iter().all(|r| r.state != State::Gap));
    }
}

/// The search asks for what is over a facet, not for what shares its bounding box.
#[test]
fn search_is_as_selective_on_a_slope_as_on_the_flat() {
    let tested = |angle: f64| {
        let q = Rotation3::from_euler_angles(angle, 0.5 * angle, 0.0);
        let turned = |m: Mesh| Mesh { x: m.x.iter().map(|x| q * x).collect(), facets: m.facets };
        let one = turned(grid(20, 20, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads));
        let two = turned(grid(25, 25, [-0.1, -0.1], [1.1, 1.1], 0.0, true, Cells::Quads));
        interface(&one, &two, options()).counters().pairs_tested
    };
    let (flat, slope) = (tested(0.0), tested(0.8));
    assert!(slope <= 4 * flat, "{slope} pairs tested on the slope, {flat} on the flat");
}

/// A small facet over a huge one knows nothing of its size.
#[test]
fn coverage_is_exact_at_any_size_ratio() {
    let one = grid(1, 1, [0.13, 0.21], [1.13, 1.21], 0.0, false, Cells::Quads);
    for size in [1e3, 1e6, 1e9] {
        let two = grid(1, 1, [-size, -size], [size, size], 0.0, true, Cells::Quads);
        let i = interface(&one, &two, options());
        for coverage in &i.history().coverage {
            assert!((coverage - 0.25).abs() <= 1e-15, "{coverage} at size {size:e}");
        }
    }
}

/// A multiplier component without an equation is a constrained direction, declared or not: otherwise the
/// rows that are left would depend on the augmentation.
#[test]
fn a_removed_component_is_a_constrained_direction() {
    let nu = Vec3::new(0.0, 0.2, 0.98).normalize();
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], 0.0, true, Cells::Quads);
    let equations = |n: usize| (0..n as i64).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect::<Vec<_>>();
    let nonmortar = Surface::new("nonmortar", one.x.clone(), &one.facets, equations(4)).unwrap();
    let mortar = Surface::new("mortar", two.x.clone(), &two.facets, equations(4)).unwrap();
    let multipliers = (12..16).map(|k| [2 * k, NO_EQUATION, 2 * k + 1]).collect();
    let options = Options { row_scale: RowScale::None, ..options() };
    let mut i = Interface::new(nonmortar, mortar, multipliers, options).unwrap();
    i.set_normals(Some(vec![nu; 4])).unwrap();
    for a in 0..4 {
        assert_eq!(i.normal(a).unwrap().y, 0.0);
    }
    let r = i.residual(&one.x, &two.x, &[Vec3::new(0.0, 0.0, -1.0); 4], None).unwrap();
    assert!(r.rows.iter().all(|row| row.amax() <= 1e-15), "a closed node in equilibrium has a zero row");
}

/// Matching meshes, turned in space, with noise or a tiny turn from rounding to 1e-3: the assembled tangent moves
/// with the geometry and not by a claim that an edge loses or wins.
#[test]
fn nearly_matching_meshes_have_nearly_the_same_tangent() {
    // The tangent's own change per unit of noise, of order h^-1 times a few, and rounding.
    let allowed = |noise: f64| 100.0 * noise + 1e-12;
    let mut random = Random(11);
    for round in 0..20 {
        let angles = random.vector(3.0);
        let q = Rotation3::from_euler_angles(angles.x, angles.y, angles.z);
        let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
        let two = grid(4, 4, [-0.5, -0.5], [1.5, 1.5], 0.0, true, Cells::Quads);
        let lambda: Vec<_> = one.x.iter().map(|_| q * Vec3::new(0.1, 0.2, -1.0)).collect();
        let seed = 100 + round;
        let tangent = |noise: f64, turn: f64| {
            let mut random = Random(seed);
            let about = Vec3::new(0.37, 0.59, 0.0);
            let z = Rotation3::from_euler_angles(0.0, 0.0, turn);
            let x1: Vec<_> = one.x.iter().map(|x| q * x).collect();
            let x2: Vec<_> = two.x.iter().map(|x| q * (z * (x - about) + about + random.vector(noise))).collect();
            let mesh = |x: &[Vec3], m: &Mesh| Mesh { x: x.to_vec(), facets: m.facets.clone() };
            let mut i = interface(&mesh(&x1, &one), &mesh(&x2, &two), options());
            let n = 3 * (2 * one.x.len() + two.x.len());
            let mut k = vec![0.0; n * n];
            i.tangent(&x1, &x2, &lambda, None, &mut |r: i64, c: i64, v: f64| k[r as usize * n + c as usize] += v)
                .unwrap();
            k
        };
        let exact = tangent(0.0, 0.0);
        let scale = max_abs(exact.iter().copied());
        for exponent in 3..=17 {
            let size = 10f64.powi(-exponent);
            for (noise, turn) in [(size, 0.0), (0.0, size)] {
                let other = tangent(noise, turn);
                let error = max_abs(exact.iter().zip(&other).map(|(a, b)| a - b)) / scale;
                assert!(error <= allowed(size), "noise {noise:e}, turn {turn:e}: {error:e}");
            }
        }
    }
}

/// A mortar boundary that follows non-mortar mesh lines, over a gap or on ridges, where noise turns the planes on either
/// side of a line: both of them claimed the boundary, or none, and the tangent was off by as much as itself.
#[test]
fn noise_does_not_change_who_claims_a_mortar_boundary() {
    // The tangent's own change per unit of noise on facets of a quarter, h^-2 times a few, and rounding.
    let allowed = |noise: f64| 500.0 * noise + 1e-12;
    let mut random = Random(29);
    for (ridge, gap) in [(0.0, 0.0), (0.0, 0.1), (0.07, 0.0), (0.07, 1e-3)] {
        for seed in 0..4 {
            let angles = random.vector(3.0);
            let q = Rotation3::from_euler_angles(angles.x, angles.y, angles.z);
            let placed = |mut mesh: Mesh, z: f64| {
                mesh.x.iter_mut().for_each(|x| *x = q * Vec3::new(x.x, x.y, z + ridge * ((4.0 * x.x).round() % 2.0)));
                mesh
            };
            let one = placed(grid(4, 4, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads), gap);
            let two = placed(grid(2, 2, [0.25, 0.25], [0.75, 0.75], 0.0, true, Cells::Quads), 0.0);
            let lambda: Vec<_> = one.x.iter().map(|_| q * Vec3::new(0.1, 0.0, -1.0)).collect();
            let tangent = |noise: f64| {
                let mut random = Random(100 + seed);
                let mut moved = |mesh: &Mesh| Mesh {
                    x: mesh.x.iter().map(|x| x + random.vector(noise)).collect(),
                    facets: mesh.facets.clone(),
                };
                let (one, two) = (moved(&one), moved(&two));
                let n = 3 * (2 * one.x.len() + two.x.len());
                let mut k = vec![0.0; n * n];
                let mut add = |r: i64, c: i64, v: f64| k[r as usize * n + c as usize] += v;
                interface(&one, &two, options()).tangent(&one.x, &two.x, &lambda, None, &mut add).unwrap();
                k
            };
            let clean = tangent(0.0);
            let scale = max_abs(clean.iter().copied());
            for noise in [1e-16, 1e-15, 1e-14, 1e-13, 1e-12] {
                let error = max_abs(clean.iter().zip(&tangent(noise)).map(|(a, b)| a - b)) / scale;
                assert!(error <= allowed(noise), "ridge {ridge}, gap {gap}, noise {noise:e}: {error:e}");
            }
        }
    }
}
