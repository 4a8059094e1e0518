//! Evaluations of a skin: those of named pairs, and derivatives that are exact.

use crate::bodies::*;
use crate::support::mesh::{Random, numbered};
use stickslip::geometry::Vec3;
use stickslip::interface::{Interface, NO_EQUATION, Surface};
use stickslip::skin::{Given, Skin};

/// Sums of a skin go over the same numbers in another order.
const ROUNDING: f64 = 1e-13;
/// Of central differences with steps of 1e-6, over the largest entry.
const DIFFERENCES: f64 = 1e-7;

/// Where a skin is evaluated: a bit away from the first configuration, with multipliers everywhere.
fn somewhere(skin: &Skin, mesh: &Mesh, scale: f64, seed: u64) -> (Vec<Vec3>, Vec<Vec3>) {
    let mut random = Random(seed);
    let in_plane = mesh.facets[0].len() == 2;
    let flat = |v: Vec3| if in_plane { Vec3::new(v.x, v.y, 0.0) } else { v };
    let x = mesh.x.iter().map(|x| x + flat(random.vector(scale))).collect();
    let has = |a: usize| skin.whole().multipliers[a] != [NO_EQUATION; 3];
    let lambda = (0..skin.whole().copies()).map(|a| if has(a) { flat(random.vector(5.0)) } else { Vec3::zeros() });
    (x, lambda.collect())
}

/// Forces and rows of a small block's lower face on a large block's upper one, as an interface that names them.
#[test]
fn a_skin_is_what_named_pairs_are() {
    for (triangles, mu) in [(false, 0.0), (false, 0.3), (true, 0.3)] {
        let mesh = stack(1e-3, triangles);
        let mut skin = skin(&mesh, options(mu));
        let face = |z: f64, first: usize, end: usize| {
            let on = |f: &&Vec<i64>| {
                f.iter().all(|&a| (mesh.x[a as usize].z - z).abs() < 1e-9 && (first..end).contains(&(a as usize)))
            };
            let facets: Vec<Vec<i64>> = mesh.facets.iter().filter(on).cloned().collect();
            let mut nodes: Vec<i64> = facets.concat();
            nodes.sort_unstable();
            nodes.dedup();
            let local = |a: &i64| nodes.binary_search(a).unwrap() as i64;
            let facets = facets.iter().map(|f| f.iter().map(local).collect()).collect::<Vec<Vec<i64>>>();
            (nodes, facets)
        };
        let large = brick([4, 4, 2], [0.0; 3], [1.0; 3], triangles).x.len();
        let (one, two) = (face(0.499, large, mesh.x.len()), face(0.5, 0, large));
        let surface = |side, (nodes, facets): &(Vec<i64>, Vec<Vec<i64>>)| {
            let x: Vec<_> = nodes.iter().map(|&a| mesh.x[a as usize]).collect();
            let equations = nodes.iter().map(|&a| [0, 1, 2].map(|i| 3 * a + i)).collect();
            Surface::new(side, x, facets, equations).unwrap()
        };
        let equations = numbered(10_000, one.0.len());
        let mut named =
            Interface::new(surface("nonmortar", &one), surface("mortar", &two), equations, options(mu)).unwrap();
        for seed in 1..4 {
            let (x, lambda) = somewhere(&skin, &mesh, 2e-3, seed);
            // The copy of a node that the lower face has.
            let whole = skin.whole();
            let own: Vec<usize> = one
                .0
                .iter()
                .map(|&node| {
                    let is_it = |a: &usize| {
                        whole.originals[*a] == node as usize
                            && whole.around.of(*a).iter().all(|&f| {
                                whole
                                    .surface
                                    .host_nodes(f)
                                    .iter()
                                    .all(|&b| (mesh.x[whole.originals[b]].z - 0.499).abs() < 1e-9)
                            })
                    };
                    (0..whole.copies()).find(is_it).unwrap()
                })
                .collect();
            let found = skin.residual(&x, &lambda).unwrap();
            let at = |nodes: &[i64]| nodes.iter().map(|&a| x[a as usize]).collect::<Vec<_>>();
            let of_own: Vec<_> = own.iter().map(|&a| lambda[a]).collect();
            let expected = named.residual(&at(&one.0), &at(&two.0), &of_own, None).unwrap();
            let scale = expected.nonmortar.iter().map(|f| f.amax()).fold(0.0, f64::max);
            assert!(scale > 0.01);
            let mut forces = vec![Vec3::zeros(); mesh.x.len()];
            one.0.iter().zip(&expected.nonmortar).for_each(|(&a, f)| forces[a as usize] += f);
            two.0.iter().zip(&expected.mortar).for_each(|(&a, f)| forces[a as usize] += f);
            let error = forces.iter().zip(&found.forces).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
            let rows = own.iter().zip(&expected.rows).map(|(&a, row)| (row - found.rows[a]).amax()).fold(0.0, f64::max);
            assert!(error <= ROUNDING * scale && rows <= ROUNDING * scale, "{error:e}, {rows:e} of {scale:e}");
        }
    }
}

/// Every entry of the tangent, in space and in the plane, with friction, of pieces that meet at an edge and of a body that meets
/// itself.
#[test]
fn the_tangent_is_the_derivative_of_the_residual() {
    let corner = together(&[
        brick([2, 2, 2], [0.0, 0.0, 0.0], [0.5, 0.5, 0.5], false),
        brick([3, 3, 1], [-0.3, -0.3, -0.3995], [1.2, 1.2, 0.4], false),
        brick([1, 2, 2], [0.4995, 0.05, -0.1], [0.4, 0.4, 0.8], false),
    ]);
    let slot = outline(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.501, 1.0], [0.5, 0.3], [0.499, 1.0], [0.0, 1.0]], 4);
    for (name, mesh, mu) in [("stack", stack(1e-3, true), 0.3), ("corner", corner, 0.2), ("slot", slot, 0.4)] {
        let mut skin = skin(&mesh, options(mu));
        assert!(skin.pieces() > 0, "{name}");
        let (x, lambda) = somewhere(&skin, &mesh, 1e-3, 7);
        let n = skin.make_plan(&x, false).unwrap();
        let mut values = vec![0.0; n];
        skin.plan_values(&x, &lambda, &mut values).unwrap();
        let mut entries = Vec::new();
        skin.plan_entries(&mut |row, column| {
            entries.push((row as usize, column as usize));
            Ok(())
        })
        .unwrap();
        assert_eq!(entries.len(), n);
        let whole = skin.whole();
        let (nodes, copies, per) = (whole.nodes, whole.copies(), whole.components());
        let equations: Vec<_> = whole.multipliers.clone();
        let unknowns = per * nodes + equations.as_flattened().iter().filter(|&&e| e != NO_EQUATION).count();
        let mut residual = |z: &[f64]| {
            let x: Vec<_> =
                (0..nodes).map(|a| Vec3::from_fn(|i, _| if i < per { z[per * a + i] } else { 0.0 })).collect();
            let value = |e: i64| if e == NO_EQUATION { 0.0 } else { z[e as usize] };
            let lambda: Vec<_> = equations.iter().map(|e| Vec3::new(value(e[0]), value(e[1]), value(e[2]))).collect();
            let found = skin.residual(&x, &lambda).unwrap();
            let mut out = vec![0.0; z.len()];
            (0..nodes).for_each(|a| (0..per).for_each(|i| out[per * a + i] = found.forces[a][i]));
            for (a, e) in equations.iter().enumerate() {
                (0..3).filter(|&i| e[i] != NO_EQUATION).for_each(|i| out[e[i] as usize] = found.rows[a][i]);
            }
            out
        };
        let mut z = vec![0.0; unknowns];
        (0..nodes).for_each(|a| (0..per).for_each(|i| z[per * a + i] = x[a][i]));
        for a in 0..copies {
            (0..3).filter(|&i| equations[a][i] != NO_EQUATION).for_each(|i| z[equations[a][i] as usize] = lambda[a][i]);
        }
        let scale = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let mut random = Random(3);
        for _ in 0..4 {
            let direction: Vec<f64> = (0..unknowns).map(|_| random.next() - 0.5).collect();
            let mut product = vec![0.0; unknowns];
            entries.iter().zip(&values).for_each(|(&(row, column), v)| product[row] += v * direction[column]);
            let h = 1e-6;
            let at = |t: f64| z.iter().zip(&direction).map(|(z, d)| z + t * d).collect::<Vec<_>>();
            let (high, low) = (residual(&at(h)), residual(&at(-h)));
            let error = (0..unknowns).map(|k| ((high[k] - low[k]) / (2.0 * h) - product[k]).abs()).fold(0.0, f64::max);
            assert!(error <= DIFFERENCES * scale, "{name}: {error:e} of {scale:e}");
        }
    }
}

/// A stack whose nodes have these components of displacement alone.
fn partly_held(moves: [bool; 3]) -> (Mesh, Skin) {
    let mesh = stack(1e-3, false);
    let equation = |a: usize, i: usize| if moves[i] { (3 * a + i) as i64 } else { NO_EQUATION };
    let equations = (0..mesh.x.len()).map(|a| [0, 1, 2].map(|i| equation(a, i))).collect();
    let skin = Skin::new(Given { equations, ..given(&mesh, false) }, options(0.3)).unwrap();
    (mesh, skin)
}

/// A component that nothing can move on either side has a row that says it is 0, as other copies have that touch nothing: the matrix would
/// be singular.
#[test]
fn a_multiplier_that_pushes_on_nothing_is_zero() {
    for (moves, held) in [([true, false, true], 1), ([true, true, false], 2)] {
        let (mesh, mut skin) = partly_held(moves);
        let (x, lambda) = somewhere(&skin, &mesh, 2e-3, 1);
        let found = skin.residual(&x, &lambda).unwrap();
        let mut other = lambda.clone();
        other.iter_mut().for_each(|l| l[held] *= 2.0);
        let again = skin.residual(&x, &other).unwrap();
        assert_eq!(found.forces, again.forces, "component {held} presses on nothing");
        for (a, (row, twice)) in found.rows.iter().zip(&again.rows).enumerate() {
            assert_eq!(2.0 * row[held], twice[held], "copy {a}");
            assert!(row[held] * lambda[a][held] < 0.0 || lambda[a][held] == 0.0, "copy {a}: {row} for {}", lambda[a]);
        }
        skin.make_plan(&x, false).unwrap();
        let mut diagonal = vec![0; mesh.x.len() * 3 + 3 * skin.whole().copies()];
        skin.plan_entries(&mut |row, column| {
            diagonal[row as usize] += i32::from(row == column);
            Ok(())
        })
        .unwrap();
        for equations in &skin.whole().multipliers {
            assert_eq!(diagonal[equations[held] as usize], 1);
        }
    }
}

/// A copy whose normal is a prescribed direction has no multiplier: a normal in the directions that are left there would be none.
#[test]
fn a_copy_whose_normal_is_prescribed_has_no_multiplier() {
    let mesh = stack(1e-3, false);
    let mut skin = skin(&mesh, options(0.3));
    let (x, lambda) = somewhere(&skin, &mesh, 2e-3, 1);
    let touching = skin.residual(&x, &lambda).unwrap();
    assert!(touching.forces.iter().any(|f| f.norm() > 0.01));
    let vertical = |a: usize| (a, Vec3::z());
    skin.set_constraints((0..mesh.x.len()).map(vertical).collect()).unwrap();
    let found = skin.residual(&x, &lambda).unwrap();
    assert!(found.forces.iter().all(|f| *f == Vec3::zeros()));
    skin.set_constraints((0..mesh.x.len()).map(|a| (a, Vec3::y())).collect()).unwrap();
    let along = skin.residual(&x, &lambda).unwrap();
    assert!(along.forces.iter().any(|f| f.norm() > 0.01));
    skin.set_constraints(Vec::new()).unwrap();
    assert_eq!(skin.residual(&x, &lambda).unwrap().forces, touching.forces);
}
