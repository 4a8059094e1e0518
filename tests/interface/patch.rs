//! The patch test of quadratic cells on each other and on linear ones: two boxes whose meshes do not match are pressed, and the
//! stress is constant (docs/formulation 12.2).

use crate::support::mesh::*;
use crate::support::parents::has_row;
use crate::support::solid::*;
use nalgebra::{DMatrix, DVector};
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Friction, MultiplierBasis, NO_EQUATION, Options, Surface};
use stickslip::mortar::MultiplierSpace;
use stickslip::shape::Parent;

/// Multipliers and displacements, over the largest.
const PATCH: f64 = 1e-10;
/// What multipliers are off by, at least, where facets are given with the functions of their parts.
const GUARD: f64 = 0.1;
/// A step below this is rounding of a matrix with a condition of 1e4.
const CONVERGED: f64 = 1e-12;
const YOUNG: f64 = 100.0;
const POISSON: f64 = 0.3;
const PRESSURE: f64 = 1.0;

/// The largest errors of multipliers and of displacements; `cut`: the sides' facets are given as their linear parts.
fn patch(pair @ [upper, lower]: [Cell; 2], options: Options, cut: bool) -> (f64, f64) {
    let material = (YOUNG, POISSON);
    let (one, two) = (Solid::new(upper, 2, 0.0, false, material), Solid::new(lower, 3, -1.0, true, material));
    let (n1, n2) = (3 * one.x.len(), 3 * two.x.len());
    let n = n1 + n2;
    // The same field in both bodies, with the lower end at rest.
    let strain = PRESSURE / YOUNG;
    let field = |x: &Vec3| Vec3::new(POISSON * x.x, POISSON * x.y, -(x.z + 1.0)) * strain;
    let parts = |mesh: Mesh| -> Mesh {
        let of = |f: &Vec<i64>| {
            let subs = Parent::of(f.len()).unwrap().subs.iter();
            subs.map(|s| s.nodes[..s.shape.n].iter().map(|&k| f[k]).collect()).collect::<Vec<Vec<i64>>>()
        };
        Mesh { facets: mesh.facets.iter().flat_map(of).collect(), x: mesh.x }
    };
    let side = |body: &Solid, first: usize, name| {
        let (mesh, nodes) = body.side();
        let mesh = if cut { parts(mesh) } else { mesh };
        let equations = nodes.iter().map(|&k| [0, 1, 2].map(|i| (first + 3 * k + i) as i64)).collect();
        let surface = Surface::new(name, mesh.x.clone(), &mesh.facets, equations).unwrap();
        (surface, mesh, nodes)
    };
    let (s1, mesh1, nodes1) = side(&one, 0, "nonmortar");
    let (s2, _, nodes2) = side(&two, n1, "mortar");
    let has = has_row(&mesh1, options.space);
    let multipliers = (0..nodes1.len()).map(|a| [if has[a] { (n + a) as i64 } else { NO_EQUATION }]).collect();
    let mut contact = Contact::<1>::frictionless(s1, s2, multipliers, options).unwrap();
    let (mut u, mut lambda) = (DVector::<f64>::zeros(n), contact.initial_multipliers().unwrap());
    let mut load = DVector::zeros(n);
    let held = forces_of(&one, field);
    for (k, _) in one.x.iter().enumerate().filter(|(_, x)| x.z == 1.0) {
        load[3 * k + 2] = held[3 * k + 2];
    }
    let total: f64 = load.iter().sum();
    assert!((total + PRESSURE).abs() < PATCH, "{total}");
    let x_of = |k: usize| if k < one.x.len() { one.x[k] } else { two.x[k - one.x.len()] };
    let fixed: Vec<usize> = (0..n / 3)
        .flat_map(|k| {
            let x = x_of(k);
            [(x.x == 0.0, 0), (x.y == 0.0, 1), (x.z == -1.0, 2)].into_iter().filter(|f| f.0).map(move |f| 3 * k + f.1)
        })
        .collect();
    let m = nodes1.len();
    for step in 0.. {
        assert!(step < 20, "no convergence: {pair:?}");
        let moved = |nodes: &[usize], x: &[Vec3], first: usize| -> Vec<Vec3> {
            nodes.iter().map(|&k| x[k] + u.fixed_rows::<3>(first + 3 * k)).collect()
        };
        let (x1, x2) = (moved(&nodes1, &one.x, 0), moved(&nodes2, &two.x, n1));
        let (mut k, mut r) = (DMatrix::zeros(n + m, n + m), DVector::zeros(n + m));
        k.view_mut((0, 0), (n1, n1)).copy_from(&one.stiffness);
        k.view_mut((n1, n1), (n2, n2)).copy_from(&two.stiffness);
        let force = k.view((0, 0), (n, n)) * &u - &load;
        r.rows_mut(0, n).copy_from(&force);
        let c = contact.residual(&x1, &x2, &lambda, None).unwrap();
        for (nodes, forces, first) in [(&nodes1, &c.nonmortar, 0), (&nodes2, &c.mortar, n1)] {
            for (&node, f) in nodes.iter().zip(forces) {
                let mut rows = r.fixed_rows_mut::<3>(first + 3 * node);
                rows += f;
            }
        }
        (0..m).for_each(|a| r[n + a] = c.rows[a][0]);
        contact
            .tangent(&x1, &x2, &lambda, None, &mut |i: i64, j: i64, v: f64| k[(i as usize, j as usize)] += v)
            .unwrap();
        for &i in fixed.iter() {
            k.row_mut(i).fill(0.0);
            (k[(i, i)], r[i]) = (1.0, u[i]);
        }
        for a in (0..m).filter(|&a| !has[a]) {
            (k[(n + a, n + a)], r[n + a]) = (1.0, 0.0);
        }
        let change = k.lu().solve(&r).unwrap();
        u -= change.rows(0, n);
        (0..m).for_each(|a| lambda[a][0] -= change[n + a]);
        if change.amax() < CONVERGED {
            break;
        }
    }
    // Forces are those of the first configuration, areas those of now.
    let expected = PRESSURE / (1.0 + POISSON * strain).powi(2);
    let sign = lambda[has.iter().position(|h| *h).unwrap()][0].signum();
    let off = (0..m).filter(|&a| has[a]).map(|a| (lambda[a][0] * sign - expected).abs()).fold(0.0, f64::max);
    let moved = (0..n / 3).map(|k| (u.fixed_rows::<3>(3 * k) - field(&x_of(k))).amax()).fold(0.0, f64::max);
    (off / expected, moved / strain)
}

fn options(space: MultiplierSpace, basis: MultiplierBasis) -> Options {
    let of = crate::support::mesh::options();
    Options { space, basis, friction: Friction::None, mu: 0.0, ..of }
}

#[test]
fn quadratic_cells_pass_the_patch_test_on_each_other_and_on_linear_ones() {
    use MultiplierBasis::{Dual, Standard};
    use MultiplierSpace::{Corner, Sub};
    let mut worst = [0.0_f64; 2];
    for pair in CELLS.into_iter().flat_map(|one| CELLS.map(|two| [one, two])) {
        if pair.iter().all(|cell| !cell.is_quadratic()) {
            continue;
        }
        for (space, basis) in [(Corner, Standard), (Corner, Dual), (Sub, Standard)] {
            if space == Sub && !pair[0].is_quadratic() {
                continue;
            }
            let (off, moved) = patch(pair, options(space, basis), false);
            assert!(off <= PATCH && moved <= PATCH, "{pair:?} {space:?} {basis:?}: {off:e} {moved:e}");
            worst = [worst[0].max(off), worst[1].max(moved)];
        }
    }
    println!("patch: multipliers {:.1e}, displacements {:.1e}", worst[0], worst[1]);
}

/// The functions of the parts in place of the cells' own fail it.
#[test]
fn linear_parts_of_quadratic_cells_fail_the_patch_test() {
    for cell in [Cell::Tet10, Cell::Hex20, Cell::Hex27] {
        let (off, _) = patch([cell, cell], options(MultiplierSpace::Corner, MultiplierBasis::Standard), true);
        println!("{cell:?} by linear parts: multipliers off by {off:.2}");
        assert!(off > GUARD, "{cell:?}: {off:e}");
    }
}
