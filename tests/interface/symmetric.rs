//! What a host can do that factors symmetric matrices alone (docs/host_symmetric.md): frozen weights make tangents symmetric where
//! no node slips, with the augmented form, and P^T K P takes the step of the condensed system.

use super::condensed::of_parents;
use super::weak::{Scene, WEAK};
use crate::support::differences::Point;
use crate::support::mesh::*;
use nalgebra::{DMatrix, DVector, Rotation3, SVector};
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Csr, Form, Friction, MultiplierBasis, NO_WEAK_COVERAGE, Options, Piece, RowScale, Weights,
};

/// K - K^T over the largest entry: rounding of products in another order.
const SYMMETRIC: f64 = 1e-15;
/// The same of P^T K P, sums of a few hundred products of numbers of size 20.
const PRODUCTS: f64 = 1e-14;
/// What is not symmetric is off by more than this.
const UNSYMMETRIC: f64 = 1e-4;
/// Steps of two factorisations of one system: its condition times rounding.
const SAME: f64 = 1e-10;
/// With this coefficient every closed node of these scenes sticks.
const STICKS: f64 = 1e3;

/// A 3 x 2 grid over a plate that ends in its second column of facets: nodes of the third column are weakly covered. Flat and
/// closed at t_n, so that tied surfaces are linear; moved and bent since then.
fn scene<const N: usize>(options: Options) -> Scene<N>
where
    Contact<N>: Create<N>,
{
    let frame = Rotation3::from_euler_angles(0.4, -0.9, 1.3);
    let mut random = Random(5);
    let in_frame = |m: Mesh| Mesh { x: m.x.iter().map(|x| frame * x).collect(), ..m };
    let one = in_frame(grid(3, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads));
    let two = in_frame(grid(2, 3, [-0.5, -0.2], [0.45, 1.3], 0.0, true, Cells::Quads));
    let x1: Vec<_> = one.x.iter().map(|x| x + random.vector(1e-2)).collect();
    let x2: Vec<_> = two.x.iter().map(|x| x + random.vector(1e-2)).collect();
    let mut contact = contact::<N>(&one, &two, false, options);
    let normals: Vec<_> = (0..x1.len()).map(|a| contact.normal(a).unwrap()).collect();
    contact.set_previous(&one.x, &two.x).unwrap();
    let mut multiplier = |a: usize| {
        let t = normals[a] * (-3.0 + 0.1 * random.next()) + random.vector(0.3);
        SVector::from_fn(|i, _| if N == 1 { normals[a].dot(&t) } else { t[i] })
    };
    let lambda = (0..x1.len()).map(&mut multiplier).collect();
    Scene { contact, x1, x2, lambda }
}

/// K - K^T over the largest entry.
fn asymmetry(k: &DMatrix<f64>) -> f64 {
    (k - k.transpose()).amax() / k.amax()
}

fn tangent_asymmetry<const N: usize>(s: &mut Scene<N>) -> f64 {
    let mut point = Point { contact: &mut s.contact, x1: &s.x1, x2: &s.x2, lambda: &s.lambda };
    let n = point.unknowns();
    asymmetry(&DMatrix::from_row_slice(n, n, &point.tangent()))
}

/// Some nodes open: their multipliers pull.
fn open_some<const N: usize>(s: &mut Scene<N>) {
    s.lambda.iter_mut().step_by(3).for_each(|l| *l *= -1.0);
}

#[test]
fn tangents_with_frozen_weights_are_symmetric_where_no_node_slips() {
    for weights in [Weights::Committed, Weights::Reference] {
        let base = Options { weights, row_scale: RowScale::None, mu: 0.0, ..options() };
        let augmented = Options { form: Form::Augmented, ..base };
        let mut s = scene::<1>(Options { friction: Friction::None, ..augmented });
        open_some(&mut s);
        let off = tangent_asymmetry(&mut s);
        assert!(off <= SYMMETRIC, "frictionless {weights:?}: {off:e}");
        for (friction, mu) in [(Friction::Rough, 0.0), (Friction::Coulomb, STICKS)] {
            let mut s = scene::<3>(Options { friction, mu, ..augmented });
            open_some(&mut s);
            let off = tangent_asymmetry(&mut s);
            assert!(off <= SYMMETRIC, "{friction:?}: {off:e}");
        }
        for form in [Form::Augmented, Form::Multiplier] {
            let off = tangent_asymmetry(&mut scene::<3>(Options { form, friction: Friction::Tied, ..base }));
            assert!(off <= SYMMETRIC, "tied, {form:?}: {off:e}");
        }
        // What spoils it: slip, open nodes in the multiplier form, rows in the unit of a force, carried nodes' rows, weights
        // of now.
        let slips = Options { friction: Friction::Coulomb, mu: 0.1, ..augmented };
        let forces = Options { row_scale: RowScale::Force, friction: Friction::Tied, ..base };
        let open = Options { friction: Friction::Rough, ..base };
        let carried = Options { weak_coverage: WEAK, friction: Friction::Tied, ..base };
        let current = Options { weights: Weights::Current, friction: Friction::Rough, ..augmented };
        for options in [slips, forces, open, carried, current] {
            let mut s = scene::<3>(options);
            open_some(&mut s);
            let off = tangent_asymmetry(&mut s);
            assert!(off >= UNSYMMETRIC, "{options:?}: {off:e}");
        }
    }
}

/// A symmetric positive definite matrix, and the residual of the host's own forces.
fn host(n: usize) -> (DMatrix<f64>, DVector<f64>) {
    let mut random = Random(9);
    let a = DMatrix::from_fn(n, n, |_, _| 0.2 * random.next());
    (&a * a.transpose() + DMatrix::identity(n, n), DVector::from_fn(n, |_, _| random.next()))
}

/// The step from the condensed matrix as it is, and from P^T K P + Q, as docs/host_symmetric.md says. How many nodes are covered and open.
fn steps_agree<const N: usize>(s: &mut Scene<N>, what: &str) -> usize {
    let (n1, n) = (s.x1.len(), 3 * (s.x1.len() + s.x2.len()));
    let (k, own) = host(n);
    let host1: Vec<Vec3> = (0..n1).map(|a| own.fixed_rows::<3>(3 * a).into()).collect();
    let x = (&s.x1[..], &s.x2[..]);
    let (rows, gains) = s.contact.condensed_residual(x.0, x.1, &s.lambda, &host1).unwrap();
    let mut r = own;
    for (i, v) in rows.iter().flat_map(|v| v.iter()).enumerate() {
        r[i] = *v;
    }
    for (i, v) in gains.iter().flat_map(|v| v.iter()).enumerate() {
        r[3 * n1 + i] += v;
    }
    let offsets: Vec<i64> = (0..=n).map(|i| (i * n) as i64).collect();
    let columns: Vec<i64> = (0..n * n).map(|e| (e % n) as i64).collect();
    let value = |e: usize| k[(e / n, e % n)];
    let places: Vec<_> =
        s.contact.condense(x, &s.lambda, Csr::new(0, &offsets, &columns), &value).unwrap().places().collect();
    let mut condensed = k.clone();
    places.iter().for_each(|&(e, v)| condensed[(e / n, e % n)] = v);
    assert!(asymmetry(&condensed) >= UNSYMMETRIC, "{what}: nothing to be done");
    let expected = -condensed.lu().solve(&r).unwrap();

    let mut piece = |piece| {
        let mut m = DMatrix::zeros(n, n);
        let mut add = |i: i64, j: i64, v: f64| m[(i as usize, j as usize)] += v;
        s.contact.condensed_tangent(x, &s.lambda, piece, &mut add).unwrap();
        m
    };
    assert_eq!(piece(Piece::Forces).amax(), 0.0, "{what}: frozen weights");
    let one = DMatrix::identity(n, n);
    let (left, right) = (&one + piece(Piece::ReductionRows), &one + piece(Piece::ReductionColumns));
    let (q, d, l) = (piece(Piece::Constrained), piece(Piece::ConstraintDiagonal), piece(Piece::Elimination));
    let (p, r) = (&right * (&one - &q), left * r);
    // v meets the constraints by the nodes that have them.
    let (mut v, mut constrained, mut open) = (DVector::zeros(n), 0, 0);
    for a in 0..n1 {
        let block = |m: &DMatrix<f64>| -> nalgebra::Matrix3<f64> { m.fixed_view::<3, 3>(3 * a, 3 * a).into() };
        let (q, d) = (block(&q), block(&d));
        if q.trace() > 0.5 {
            let scale = d.trace() / q.trace();
            v.fixed_rows_mut::<3>(3 * a).copy_from(&(q * r.fixed_rows::<3>(3 * a) / -scale));
            constrained += 1;
        } else if l.columns(3 * a, 3).rows(3 * n1, n - 3 * n1).amax() > 0.0 {
            open += 1;
        }
    }
    assert!(constrained >= 3, "{what}: {constrained} nodes");
    let matrix = p.transpose() * &k * &p + &q;
    assert!(asymmetry(&matrix) <= PRODUCTS, "{what}: {:e}", asymmetry(&matrix));
    let right_side = -(&one - &q) * &r - p.transpose() * (&k * (&right * &v));
    let w = matrix.cholesky().unwrap_or_else(|| panic!("{what}: not positive definite")).solve(&right_side);
    let step = p * w + right * v;
    let off = (&step - &expected).amax() / expected.amax();
    assert!(off <= SAME, "{what}: {off:e}");
    open
}

#[test]
fn a_symmetric_positive_definite_system_takes_the_condensed_step() {
    for (weights, weak_coverage) in [Weights::Committed, Weights::Reference]
        .into_iter()
        .flat_map(|weights| [NO_WEAK_COVERAGE, WEAK].map(|weak_coverage| (weights, weak_coverage)))
    {
        let base = Options { weights, weak_coverage, basis: MultiplierBasis::Dual, mu: 0.0, ..options() };
        let laws = [(Friction::Tied, 0.0), (Friction::Rough, 0.0), (Friction::Coulomb, STICKS)];
        let what = |law: &str, open: bool| format!("{law} {weights:?} {weak_coverage} {open}");
        for open in [false, true] {
            for (friction, mu) in laws {
                let mut s = scene::<3>(Options { friction, mu, ..base });
                if open {
                    open_some(&mut s);
                }
                let found = steps_agree(&mut s, &what(&format!("{friction:?}"), open));
                assert_eq!(found > 0, open && friction != Friction::Tied);
                assert_eq!(s.contact.carriers().count() > 0, weak_coverage == WEAK);
            }
            let mut s = scene::<1>(Options { friction: Friction::None, ..base });
            if open {
                open_some(&mut s);
            }
            assert_eq!(steps_agree(&mut s, &what("one multiplier", open)) > 0, open);
        }
    }
}

/// Multipliers at the corners of quadratic facets: a node in the middle of an edge has none, and moves with the corners.
#[test]
fn with_quadratic_facets_too() {
    for kinds in [[&[8][..], &[6][..]], [&[9, 8, 6, 6], &[8, 6, 9, 9, 8]], [&[6], &[4]], [&[4], &[9]]] {
        for weak_coverage in [NO_WEAK_COVERAGE, WEAK] {
            for (friction, mu) in [(Friction::Rough, 0.0), (Friction::Coulomb, STICKS)] {
                let options = Options { friction, mu, weights: Weights::Committed, weak_coverage, ..options() };
                steps_agree(&mut of_parents::<3>(options, false, kinds), &format!("{kinds:?} {friction:?}"));
            }
            let options = Options { friction: Friction::None, mu: 0.0, weak_coverage, ..options() };
            let options = Options { weights: Weights::Committed, ..options };
            let mut s = of_parents::<1>(options, false, kinds);
            s.lambda.iter_mut().for_each(|l| *l = -*l); // most of them press
            steps_agree(&mut s, &format!("{kinds:?} one multiplier"));
        }
    }
}
