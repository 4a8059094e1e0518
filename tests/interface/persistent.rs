//! Weights of the last commit where overlaps count as closed (docs/formulation.md 4.9): what does so, the work of the contact, the tangent
//! against differences, history, what is refused.

use crate::support::lines::*;
use crate::support::max_abs;
use crate::support::mesh::*;
use nalgebra::SVector;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Decision, Friction, MultiplierBasis, Normals, Options, Stiffness, Weights};
use stickslip::law::{SlipMeasure, State};
use stickslip::line::Measure;

/// Differences: truncation and rounding of a step of 1e-6, as for all lines.
const DIFFERENCES: f64 = 1e-7;
/// Sums of some dozen products, over the largest.
const ROUNDING: f64 = 1e-13;
/// Far above rounding, far below the overlaps.
const APART: f64 = 1e-6;
const MEASURE: Measure = Measure::Thickness(0.45);

fn options(friction: Friction, basis: MultiplierBasis, weights: Weights) -> Options {
    let mu = if friction == Friction::None { 0.0 } else { 0.3 };
    Options { friction, mu, basis, weights, ..Options::paper(Stiffness::Modulus(30.0)) }
}

/// Bent lines that have slid and turned, committed there: some nodes overlap.
fn committed<const N: usize>(options: &Options) -> MovedLines<N>
where
    Contact<N>: Create<N>,
{
    let mut s = moved_lines::<N>(options, [2, 2], MEASURE, 11);
    s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
    s
}

fn each<const N: usize>(friction: Friction, mut check: impl FnMut(MovedLines<N>, MovedLines<N>, &str))
where
    Contact<N>: Create<N>,
{
    for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
        let of = |weights| committed::<N>(&options(friction, basis, weights));
        check(of(Weights::Persistent), of(Weights::Committed), &format!("{friction:?} {basis:?}"));
    }
}

/// Without tractions nothing is pressed out: no node is closed that overlaps as much as at the commit, and closer each of them is.
fn overlaps_count_as_closed<const N: usize>(friction: Friction)
where
    Contact<N>: Create<N>,
{
    each::<N>(friction, |mut s, mut other, what| {
        let none = vec![SVector::<f64, N>::zeros(); s.lambda.len()];
        let closed = |s: &mut MovedLines<N>, by: f64| {
            let nu = s.contact.history().normals[1];
            let x1: Vec<_> = s.x1.iter().map(|x| x - nu * by).collect();
            let all = s.contact.responses(&x1, &s.x2, &none, None).unwrap();
            all.iter().map(|r| (r.state != State::Gap, r.gap_normal < 0.0)).collect::<Vec<_>>()
        };
        // By so little apart: on the border a node is closed or open by its last digit.
        let (kept, parted) = (closed(&mut s, -APART), closed(&mut other, -APART));
        assert!(parted.iter().any(|(closed, _)| *closed), "{what}: nothing overlaps");
        for ((closed, overlaps), (would, _)) in kept.iter().zip(&parted) {
            assert!(!closed && overlaps == would, "{what}: gaps that are told are those of the surfaces");
        }
        let nearer = closed(&mut s, APART);
        assert!(nearer.iter().zip(&parted).all(|(now, was)| now.0 || !was.0), "{what}: an overlap that grows is one");
    });
}

#[test]
fn what_overlaps_at_a_commit_counts_as_closed() {
    overlaps_count_as_closed::<1>(Friction::None);
    overlaps_count_as_closed::<3>(Friction::Coulomb);
    overlaps_count_as_closed::<3>(Friction::Rough);
}

/// The forces work sum lambda . (g' - g) over a step, with the gaps that the law is asked about: what dynamics rest on.
fn work_is_that_of_the_gaps<const N: usize>(friction: Friction)
where
    Contact<N>: Create<N>,
{
    for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
        let mut s = committed::<N>(&options(friction, basis, Weights::Persistent));
        let turn = nalgebra::Rotation3::from_euler_angles(0.0, 0.0, 0.05);
        let x1: Vec<_> = s.x1.iter().map(|x| turn * x + Vec3::new(0.05, -0.02, 0.0)).collect();
        let r = s.contact.residual(&x1, &s.x2, &s.lambda, None).unwrap();
        let work: f64 = r.nonmortar.iter().zip(x1.iter().zip(&s.x1)).map(|(f, (to, from))| f.dot(&(to - from))).sum();
        let sums = s.contact.sums(&x1, &s.x2).unwrap();
        let normals = s.contact.history().normals.clone();
        let terms: Vec<f64> = (0..sums.len())
            .map(|a| {
                let l = &s.lambda[a];
                let lambda = if N == 1 { normals[a] * l[0] } else { Vec3::from_fn(|i, _| l[i]) };
                lambda.dot(&(sums[a].gap_now - sums[a].gap_committed))
            })
            .collect();
        let largest = max_abs(terms.iter().copied());
        assert!(largest > 1e-3 && (work - terms.iter().sum::<f64>()).abs() <= ROUNDING * largest, "{work} {terms:?}");
    }
}

#[test]
fn the_forces_work_what_the_gaps_change_by() {
    work_is_that_of_the_gaps::<1>(Friction::None);
    work_is_that_of_the_gaps::<3>(Friction::Coulomb);
}

#[test]
fn the_tangent_is_the_derivative_where_overlaps_are_kept() {
    each::<1>(Friction::None, |mut s, _, what| {
        let error = s.difference_error();
        assert!(error <= DIFFERENCES, "{what}: {error:e}");
    });
    each::<3>(Friction::Coulomb, |mut s, _, what| {
        let error = s.difference_error();
        assert!(error <= DIFFERENCES, "{what}: {error:e}");
    });
}

/// A restart without friction, whose history has no gaps with other weights.
#[test]
fn a_history_keeps_the_overlaps() {
    let of = options(Friction::None, MultiplierBasis::Standard, Weights::Persistent);
    let (mut s, mut fresh) = (committed::<1>(&of), moved_lines::<1>(&of, [2, 2], MEASURE, 11));
    let (integers, reals) = s.contact.export_history().unwrap();
    fresh.contact.import_history(&integers, &reals).unwrap();
    let z = s.unknowns();
    assert_eq!(s.residual(&z), fresh.residual(&z));
    let mut other = committed::<1>(&Options { weights: Weights::Committed, ..of });
    let error = other.contact.import_history(&integers, &reals).unwrap_err();
    assert!(error.message.contains("whose overlaps count as closed"), "{}", error.message);
    // A rollback returns to those of the commit before.
    let before = s.residual(&z);
    let x1: Vec<_> = s.x1.iter().map(|x| x + Vec3::new(0.01, -0.01, 0.0)).collect();
    s.contact.commit(&x1, &s.x2, &s.lambda, None).unwrap();
    assert_ne!(s.residual(&z), before);
    s.contact.roll_back().unwrap();
    assert_eq!(s.residual(&z), before);
}

#[test]
fn what_keeping_overlaps_does_not_go_with_is_refused() {
    let of = options(Friction::Coulomb, MultiplierBasis::Dual, Weights::Persistent);
    for (options, named) in [
        (Options { slip: SlipMeasure::Paper, ..of }, "STICKSLIP_SLIP_PAPER"),
        (Options { normals: Normals::Current, ..of }, "normals of now"),
        (
            Options {
                decision: Decision::Points(30.0),
                ..options(Friction::None, MultiplierBasis::Dual, Weights::Persistent)
            },
            "STICKSLIP_WEIGHTS_PERSISTENT",
        ),
    ] {
        let error = options.validate().unwrap_err();
        assert!(error.message.contains(named), "{}", error.message);
    }
    let mut s = committed::<3>(&of);
    let offsets = vec![0.1; s.x1.len()];
    let error = s.contact.set_offsets([Some(offsets), None]).unwrap_err();
    assert!(error.message.contains("STICKSLIP_WEIGHTS_PERSISTENT"), "{}", error.message);
    s.contact.set_offsets([Some(vec![0.0; s.x1.len()]), None]).unwrap();
}
