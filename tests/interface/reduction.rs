//! The reduced form of condensed systems: it has the same solution, its constraints are diagonal, and without friction it is
//! symmetric where the host is.

use super::condensed::{Dense, at, complete, of_parents, random_host, scene};
use super::weak::{self, WEAK};
use crate::support::mesh::*;
use nalgebra::{DMatrix, Rotation3};
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Friction, NO_WEAK_COVERAGE, Normals, Options, Piece, SplitRows, Weights, split_rows,
};
use stickslip::law::{Ellipse, Own, State};

/// The solution against that of the condensed system: the condition of the systems times rounding.
const SAME: f64 = 1e-10;
/// Entries that cancel, relative to the largest: sums of a few dozen terms.
const CANCELLED: f64 = 1e-12;

struct Reduced {
    /// E_L J E_R.
    matrix: DMatrix<f64>,
    constrained: DMatrix<f64>,
    diagonal: DMatrix<f64>,
}

fn reduced<const N: usize>(s: &mut weak::Scene<N>, host: &Dense, what: &str) -> Reduced {
    let n = host.r.len();
    let mut point = at(s);
    let (j, r) = point.condensed(host);
    let one = DMatrix::identity(n, n);
    let left = point.piece(n, Piece::ReductionRows) + &one;
    let right = point.piece(n, Piece::ReductionColumns) + &one;
    let constrained = point.piece(n, Piece::Constrained);
    let diagonal = point.piece(n, Piece::ConstraintDiagonal);
    let matrix = &left * &j * &right;
    let u = j.lu().solve(&r).unwrap();
    let v = matrix.clone().lu().solve(&(left * r)).unwrap();
    let off = (right * v - &u).amax() / u.amax();
    assert!(off <= SAME, "{what}: the solution is off by {off:e}");
    let twice = (&constrained * &constrained - &constrained).amax();
    assert!(twice <= CANCELLED, "{what}: Q is no projector, {twice:e}");
    Reduced { matrix, constrained, diagonal }
}

fn asymmetry(m: &DMatrix<f64>) -> f64 {
    (m - m.transpose()).amax() / m.amax()
}

/// A host with a symmetric matrix.
fn symmetric_host(n: usize) -> Dense {
    let host = random_host(n, 7);
    Dense::new(&host.j + host.j.transpose(), host.r)
}

/// What the reduced form is with weights and normals that do not move.
fn check<const N: usize>(s: &mut weak::Scene<N>, what: &str, symmetric: bool)
where
    Contact<N>: Create<N>,
{
    let host = symmetric_host(3 * (s.x1.len() + s.x2.len()));
    complete(s);
    let Reduced { matrix, constrained, diagonal } = reduced(s, &host, what);
    let rows = (&constrained * &matrix - &diagonal).amax() / diagonal.amax();
    // The gap that tied surfaces start with turns with them: further entries.
    assert!(rows <= CANCELLED || what.contains("Tied"), "{what}: a constraint has other entries, {rows:e}");
    if symmetric {
        let forces = DMatrix::identity(matrix.nrows(), matrix.nrows()) - &constrained;
        let off = asymmetry(&(&forces * &matrix * &forces));
        assert!(off <= CANCELLED, "{what}: not symmetric, {off:e}");
    }
}

fn states<const N: usize>(s: &mut weak::Scene<N>) -> Vec<State> {
    let responses = s.contact.responses(&s.x1, &s.x2, &s.lambda, None).unwrap();
    responses.iter().map(|r| r.state).collect()
}

#[test]
fn constraints_are_diagonal_and_without_friction_the_rest_is_symmetric() {
    let (mut seen, mut orthotropic) = ([false; 3], [false; 3]);
    for weak_coverage in [NO_WEAK_COVERAGE, WEAK] {
        for friction in [Friction::Coulomb, Friction::Rough, Friction::Tied, Friction::Tresca] {
            let options = Options { weights: Weights::Committed, weak_coverage, ..options() };
            let what = format!("{friction:?} {weak_coverage}");
            let symmetric = matches!(friction, Friction::Rough | Friction::Tied);
            let mut s = scene::<3>(under(friction, 0.4, options));
            check(&mut s, &what, symmetric);
            states(&mut s).iter().for_each(|state| seen[*state as usize] = true);
            let in_plane = Rotation3::from_euler_angles(0.4, -0.9, 1.3) * Vec3::y();
            let directions: Vec<_> = (0..s.x1.len()).step_by(2).map(|a| (a, in_plane)).collect();
            s.contact.set_constraints(&directions).unwrap();
            check(&mut s, &format!("{what}, directions taken away"), symmetric);
        }
        for (mu, across) in [(0.4, 0.05), (0.4, 3.0), (40.0, 30.0)] {
            let options = Options { weights: Weights::Committed, weak_coverage, mu, ..options() };
            let mut s = scene::<3>(options);
            let ellipse = Ellipse { direction: Vec3::new(2.0, -1.0, 0.7), across };
            s.contact.set_law(Some(Own::Orthotropic(ellipse))).unwrap();
            check(&mut s, &format!("orthotropic, {mu} {across} {weak_coverage}"), false);
            states(&mut s).iter().for_each(|state| orthotropic[*state as usize] = true);
        }
        let options = Options { weights: Weights::Committed, weak_coverage, mu: 0.0, ..options() };
        check(&mut scene::<3>(options), &format!("mu = 0, {weak_coverage}"), true);
        let options = Options { friction: Friction::None, ..options };
        check(&mut scene::<1>(options), &format!("one multiplier, {weak_coverage}"), true);
    }
    assert!(seen.iter().chain(&orthotropic).all(|s| *s), "gap, stick, slip: {seen:?} {orthotropic:?}");
}

/// Whatever weights and normals do, the solution is the same.
#[test]
fn has_the_solution_of_the_condensed_system() {
    for (normals, weak_coverage) in
        [Normals::Committed, Normals::Current].into_iter().flat_map(|n| [NO_WEAK_COVERAGE, WEAK].map(|w| (n, w)))
    {
        for friction in [Friction::Coulomb, Friction::Rough, Friction::Tied, Friction::Tresca] {
            let mut s = scene::<3>(under(friction, 0.4, Options { normals, weak_coverage, ..options() }));
            complete(&mut s);
            let host = random_host(3 * (s.x1.len() + s.x2.len()), 3);
            reduced(&mut s, &host, &format!("{friction:?} {normals:?} {weak_coverage}"));
        }
    }
}

#[test]
fn quadratic_facets_too() {
    for kinds in [[&[8][..], &[6][..]], [&[9, 8, 6, 6], &[8, 6, 9, 9, 8]], [&[6], &[4]], [&[4], &[9]]] {
        for weak_coverage in [NO_WEAK_COVERAGE, WEAK] {
            for friction in [Friction::Coulomb, Friction::Tied] {
                let options = Options { weights: Weights::Committed, weak_coverage, ..options() };
                let mut s = of_parents::<3>(under(friction, 0.4, options), false, kinds);
                check(&mut s, &format!("{kinds:?} {friction:?} {weak_coverage}"), friction == Friction::Tied);
            }
            let options = Options { friction: Friction::None, mu: 0.0, weak_coverage, ..options() };
            let options = Options { weights: Weights::Committed, ..options };
            check(&mut of_parents::<1>(options, false, kinds), &format!("{kinds:?} one multiplier"), true);
        }
    }
}

/// A row that is all constraint but for its rounding is not divided by what is left of its forces.
#[test]
fn slip_across_its_direction_near_the_cone_is_a_constraint() {
    let (nu, t, s) = (Vec3::z(), Vec3::x(), Vec3::y());
    for (beta, directions) in [(0.5, 1.0), (1.0 - 1e-9, 2.0), (1.0, 2.0)] {
        let n = nu * nu.transpose() - t * nu.transpose() * 0.3 + s * s.transpose() * beta;
        let SplitRows { constrained, rows } = split_rows(State::Slip, &nu, &n, &(s * s.transpose() * beta));
        assert!((constrained.trace() - directions).abs() <= CANCELLED && rows.amax() <= 2.0, "{beta}: {rows}");
    }
}
