//! Condensed systems of parts (docs/host_parallel.md, "Parts that own nodes"): multipliers are eliminated where they act, and residuals and
//! pieces of the parts add up to those of the whole.

use super::parts::{RINGS, RINGS_OF_CARRIERS, ROUNDING, Recipe, Scene, over, recipes};
use super::plan::entries;
use crate::support::mesh::*;
use nalgebra::{DMatrix, SVector};
use proptest::prelude::*;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Extent, Form, Friction, MultiplierBasis, Options, Owner, Piece, PlanPairs, PlanSystem,
};

const PIECES: [Piece; 8] = [
    Piece::Forces,
    Piece::Elimination,
    Piece::Constraints,
    Piece::Scales,
    Piece::ReductionRows,
    Piece::ReductionColumns,
    Piece::Constrained,
    Piece::ConstraintDiagonal,
];

/// Where a handle is: positions and multipliers.
type At<'a, const N: usize> = (&'a [Vec3], &'a [Vec3], &'a [SVector<f64, N>]);

/// Adds a piece to a matrix.
fn add_piece<const N: usize>(contact: &mut Contact<N>, (x1, x2, lambda): At<N>, piece: Piece, to: &mut DMatrix<f64>) {
    let mut add = |i: i64, j: i64, v: f64| to[(i as usize, j as usize)] += v;
    contact.condensed_tangent((x1, x2), lambda, piece, &mut add).unwrap();
}

/// Adds forces and constraints by the values of a plan.
fn add_planned<const N: usize>(contact: &mut Contact<N>, (x1, x2, lambda): At<N>, to: [&mut DMatrix<f64>; 2]) {
    contact.make_condensed_plan((x1, x2), PlanPairs::Active(Extent::Whole)).unwrap();
    let systems = [PlanSystem::Forces, PlanSystem::Constraints];
    let places = systems.map(|system| entries(contact.plan(system).unwrap()));
    let [mut forces, mut constraints] = [0, 1].map(|k| vec![f64::NAN; places[k].len()]);
    contact.condensed_values((x1, x2), lambda, [&mut forces, &mut constraints]).unwrap();
    for ((to, places), values) in to.into_iter().zip(&places).zip([forces, constraints]) {
        places.iter().zip(values).for_each(|(&(i, j), v)| to[(i as usize, j as usize)] += v);
    }
}

/// The largest error of a sum over the largest of the whole.
fn relative(found: &DMatrix<f64>, right: &DMatrix<f64>) -> f64 {
    let error = (found - right).amax();
    if error == 0.0 { 0.0 } else { error / right.amax() }
}

/// Compares the step `k`, and commits it; `None` where the whole is refused.
fn compare<const N: usize>(scene: &mut Scene<N>, k: usize, random: &mut Random) -> Option<Result<(), TestCaseError>> {
    let ([x1, x2], lambda) = scene.steps[k].clone();
    let (n1, n2) = (x1.len(), x2.len());
    let n = 3 * (n1 + n2) + N * n1;
    let host: Vec<Vec3> = (0..n1).map(|_| random.vector(1.0)).collect();
    let at = (&x1[..], &x2[..], &lambda[..]);
    let (right, gains) = scene.whole.condensed_residual(&x1, &x2, &lambda, &host).ok()?;
    let multipliers = scene.whole.condensed_multipliers(&x1, &x2, &host).unwrap();
    let mut sum = [vec![Vec3::zeros(); n1], vec![Vec3::zeros(); n2]];
    let mut found = vec![SVector::<f64, N>::zeros(); n1];
    for part in &mut scene.parts {
        let ((x1, x2, lambda), host) = (part.at(&x1, &x2, &lambda), part.of(0, &host));
        let (rows, gains) = part.contact.condensed_residual(&x1, &x2, &lambda, &host).unwrap();
        part.nodes[0].iter().zip(&rows).for_each(|(&a, f)| sum[0][a] += f);
        part.nodes[1].iter().zip(&gains).for_each(|(&c, f)| sum[1][c] += f);
        let of_part = part.contact.condensed_multipliers(&x1, &x2, &host).unwrap();
        let own = (0..part.own.len()).filter(|&k| part.own[k]);
        own.for_each(|k| found[part.nodes[0][k]] = of_part[k]);
    }
    let check = || {
        let errors = [over(&sum[0], &right), over(&sum[1], &gains), over(&found, &multipliers)];
        prop_assert!(errors.iter().all(|e| *e <= ROUNDING), "step {k}: rows, gains, multipliers {errors:?}");
        Ok(())
    };
    if let Err(error) = check() {
        return Some(Err(error));
    }
    let mut planned = [DMatrix::zeros(n, n), DMatrix::zeros(n, n)];
    for piece in PIECES {
        let (mut right, mut sum) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        add_piece(&mut scene.whole, at, piece, &mut right);
        for part in &mut scene.parts {
            let (x1, x2, lambda) = part.at(&x1, &x2, &lambda);
            add_piece(&mut part.contact, (&x1, &x2, &lambda), piece, &mut sum);
            if piece == Piece::Forces {
                let [forces, constraints] = &mut planned;
                add_planned(&mut part.contact, (&x1, &x2, &lambda), [forces, constraints]);
            }
        }
        let planned = match piece {
            Piece::Forces => relative(&planned[0], &right),
            Piece::Constraints => relative(&planned[1], &right),
            _ => 0.0,
        };
        let error = relative(&sum, &right).max(planned);
        if !(error <= ROUNDING) {
            return Some(Err(TestCaseError::fail(format!("step {k}: {piece:?} off by {error:e}"))));
        }
    }
    scene.whole.commit(&x1, &x2, &lambda, None).ok()?;
    for part in &mut scene.parts {
        let (x1, x2, lambda) = part.at(&x1, &x2, &lambda);
        part.contact.commit(&x1, &x2, &lambda, None).unwrap();
    }
    Some(Ok(()))
}

fn agree<const N: usize>(recipe: &Recipe, options: Options) -> Result<(), TestCaseError>
where
    Contact<N>: Create<N>,
{
    let carries = options.effective_weak_coverage() > 0.0;
    let around = if carries { RINGS_OF_CARRIERS } else { RINGS } + recipe.depth.ceil() as usize;
    let scene = recipe.scene::<N>(options, around);
    prop_assume!(scene.is_some());
    let (mut scene, mut random) = (scene.unwrap(), Random(recipe.seed ^ 7));
    for k in 0..scene.steps.len() {
        let found = compare(&mut scene, k, &mut random);
        prop_assume!(k > 0 || found.is_some());
        found.unwrap_or(Ok(()))?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(crate::support::random::cases(60))]

    #[test]
    fn condensed_parts_add_up_to_the_whole(recipe in recipes(), law in 0..5usize) {
        let law = [Friction::Coulomb, Friction::None, Friction::Tied, Friction::Rough, Friction::Tresca][law];
        let (form, basis) = (Form::Multiplier, MultiplierBasis::Dual);
        let options = under(law, recipe.mu, Options { form, basis, ..recipe.options() });
        match law {
            Friction::None => agree::<1>(&recipe, options)?,
            _ => agree::<3>(&recipe, options)?,
        }
    }
}

/// Shared nodes have sums that one handle does not know; quadratic facets have nodes that several multipliers act on.
#[test]
fn what_parts_cannot_condense_is_refused() {
    let options = Options { basis: MultiplierBasis::Dual, ..options() };
    let one = grid(3, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(4, 4, [-0.5, -0.5], [1.5, 1.5], -1e-3, true, Cells::Quads);
    let mut contact = interface(&one, &two, options);
    let host = vec![Vec3::zeros(); one.x.len()];
    let mut owners = vec![Owner::Here; one.x.len()];
    owners[2] = Owner::Shared;
    contact.set_owners(owners.clone()).unwrap();
    let refused = contact.condensed_multipliers(&one.x, &two.x, &host).unwrap_err();
    assert!(refused.kind == Kind::Unsupported && refused.message.contains("nodes that handles share"), "{refused}");
    owners[2] = Owner::Elsewhere;
    contact.set_owners(owners).unwrap();
    assert!(contact.condensed_multipliers(&one.x, &two.x, &host).is_ok());
}
