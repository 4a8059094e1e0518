//! Weakly covered nodes that their neighbours carry.

use crate::support::differences::Point;
use crate::support::mesh::*;
use nalgebra::{DMatrix, DVector, Rotation3, SVector};
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Form, Friction, MultiplierBasis, NO_WEAK_COVERAGE, Options, RowScale, Stiffness, Weights,
};
use stickslip::law::SlipMeasure;

/// Relative to the largest entry of a block, as in `tests/interface/tangent.rs`.
const DIFFERENCES: f64 = 1e-7;
/// Rounding of sums of a few hundred terms, relative to the largest.
const ROUNDING: f64 = 1e-13;
/// The threshold of these tests.
pub const WEAK: f64 = 0.4;

/// A 3 x 2 grid of size 1 over a plate that ends at x = 0.45 at t_n, or at 0.75 after a step: the third column of nodes
/// (x = 2/3) is weak at t_n, the fourth (x = 1) newly covered. Tilted, so that gaps of both signs occur.
pub struct Scene<const N: usize> {
    pub contact: Contact<N>,
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub lambda: Vec<SVector<f64, N>>,
}

pub fn scene<const N: usize>(options: &Options, cells: Cells) -> Scene<N>
where
    Contact<N>: Create<N>,
{
    let mut random = Random(3);
    let frame = Rotation3::from_euler_angles(0.4, -0.9, 1.3);
    let one = grid(3, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, cells);
    let two = grid(2, 3, [-0.5, -0.2], [0.45, 1.3], 0.0, true, cells);
    let bend = |x: &Vec3| frame * Vec3::new(x.x, x.y, x.z + 0.01 * x.x * x.x);
    let x1: Vec<_> = one.x.iter().map(|x| bend(&(x + random.vector(1e-3)))).collect();
    let slide = Vec3::new(0.3, 0.02, 0.0);
    let x2: Vec<_> = two.x.iter().map(|x| bend(&(x + slide + random.vector(1e-3)))).collect();
    let [one, two] = [one, two].map(|m| Mesh { x: m.x.iter().map(bend).collect(), ..m });
    let contact = contact::<N>(&one, &two, false, *options);
    let vector = |_| frame * Vec3::new(0.3 * random.next(), 0.3 * random.next(), -0.5 + 0.7 * random.next());
    let lambda: Vec<_> = (0..x1.len()).map(vector).collect();
    let normals: Vec<_> = (0..x1.len()).map(|a| contact.normal(a).unwrap()).collect();
    let component = |a: usize| SVector::from_fn(|i, _| if N == 1 { normals[a].dot(&lambda[a]) } else { lambda[a][i] });
    let lambda = (0..x1.len()).map(component).collect();
    Scene { contact, x1, x2, lambda }
}

impl<const N: usize> Scene<N> {
    fn at(&mut self) -> Point<'_, N> {
        Point { contact: &mut self.contact, x1: &self.x1, x2: &self.x2, lambda: &self.lambda }
    }

    fn carried(&mut self) -> i64 {
        self.contact.responses(&self.x1, &self.x2, &self.lambda, None).unwrap();
        self.contact.counters().nodes.carried
    }
}

fn variants() -> impl Iterator<Item = Options> {
    let forms = [Form::Multiplier, Form::Augmented].into_iter();
    let forms = forms.flat_map(|form| [RowScale::Force, RowScale::None].map(|scale| (form, scale)));
    forms.flat_map(|(form, row_scale)| {
        [Weights::Current, Weights::Committed].into_iter().flat_map(move |weights| {
            [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper].map(|slip| Options {
                form,
                row_scale,
                weights,
                slip,
                weak_coverage: WEAK,
                ..options()
            })
        })
    })
}

#[test]
fn tangents_equal_differences() {
    for options in variants() {
        for cells in [Cells::Quads, Cells::Triangles] {
            let mut three = scene::<3>(&options, cells);
            // Frozen weights cover no new nodes.
            let least = if options.weights == Weights::Current { 4 } else { 2 };
            assert!(three.carried() >= least, "{}", three.carried());
            let error = three.at().difference_error(0.0);
            assert!(error <= DIFFERENCES, "{options:?}: off by {error:e}");
            let mut one = scene::<1>(&Options { friction: Friction::None, ..options }, cells);
            assert!(one.carried() >= least);
            let error = one.at().difference_error(0.0);
            assert!(error <= DIFFERENCES, "one multiplier, {options:?}: off by {error:e}");
        }
    }
}

#[test]
fn constrained_directions_are_carried_and_differentiated_too() {
    for form in [Form::Multiplier, Form::Augmented] {
        let mut scene = scene::<3>(&Options { form, weak_coverage: WEAK, ..options() }, Cells::Quads);
        let in_plane = Rotation3::from_euler_angles(0.4, -0.9, 1.3) * Vec3::y();
        let directions: Vec<_> = (0..scene.x1.len()).step_by(2).map(|a| (a, in_plane)).collect();
        scene.contact.set_constraints(&directions).unwrap();
        let error = scene.at().difference_error(0.0);
        assert!(error <= DIFFERENCES, "{form:?}: off by {error:e}");
    }
}

/// docs/formulation 7.2: forces cancel, and their moments are those of the gaps.
#[test]
fn forces_balance_and_moments_are_those_of_the_gaps() {
    for form in [Form::Multiplier, Form::Augmented] {
        let mut s = scene::<3>(&Options { form, weak_coverage: WEAK, ..options() }, Cells::Quads);
        assert!(s.carried() >= 4);
        let r = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let responses = s.contact.responses(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let sums = s.contact.sums(&s.x1, &s.x2).unwrap();
        let traction = |a: usize| if form == Form::Augmented { responses[a].traction } else { s.lambda[a] };
        let scale: f64 = r.nonmortar.iter().map(|f| f.norm()).sum();
        let force: Vec3 = r.nonmortar.iter().chain(&r.mortar).sum();
        assert!(force.norm() <= ROUNDING * scale, "{form:?}: {force}");
        let moment: Vec3 =
            s.x1.iter().chain(&s.x2).zip(r.nonmortar.iter().chain(&r.mortar)).map(|(x, f)| x.cross(f)).sum();
        let gaps: Vec3 = (0..s.x1.len()).map(|a| sums[a].gap_now.cross(&traction(a))).sum();
        assert!((moment - gaps).norm() <= ROUNDING * scale, "{form:?}: {moment} {gaps}");
    }
}

/// The patch test: a uniform traction is a solution, whoever carries whom, with the forces of the area covered.
#[test]
fn a_uniform_traction_stays_exact() {
    for form in [Form::Multiplier, Form::Augmented] {
        let one = grid(3, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
        let two = grid(2, 3, [-0.5, -0.2], [0.45, 1.3], 0.0, true, Cells::Quads);
        let options = Options { form, mu: 0.0, weak_coverage: WEAK, ..options() };
        let mut contact = contact::<3>(&one, &two, false, options);
        let moved: Vec<_> = two.x.iter().map(|x| x + Vec3::new(0.3, 0.0, 0.0)).collect();
        let lambda = vec![Vec3::new(0.0, 0.0, -1.0); one.x.len()];
        let r = contact.residual(&one.x, &moved, &lambda, None).unwrap();
        assert!(contact.counters().nodes.carried >= 4);
        assert!(r.rows.iter().all(|row| row.norm() <= ROUNDING), "{:?}", r.rows);
        for (f, sum) in r.nonmortar.iter().zip(contact.sums(&one.x, &moved).unwrap()) {
            assert!((f - Vec3::new(0.0, 0.0, -sum.coverage)).norm() <= ROUNDING);
        }
    }
}

/// Foundation of the strip below [F/L^3].
const SPRINGS: f64 = 100.0;
/// How far the strip's base is pressed down at its end [L]; the other end is not.
const PRESSED: f64 = 0.02;

/// A strip of three facets, on springs of its own, pressed on a plate from whose end x = 1 it hangs over by `over` of a
/// facet; at the last commit it was `before`. Newton's method; reaction of the plate, largest pressure.
fn strip_on_springs(weak_coverage: f64, modulus: f64, before: f64, over: f64) -> (f64, f64) {
    let n = 3;
    let h = 1.0 / n as f64;
    let at = |over: f64| grid(n, 1, [h * over, 0.0], [1.0 + h * over, 1.0], 0.0, false, Cells::Quads);
    let plate = grid(1, 1, [-1.0, -1.0], [1.0, 2.0], 0.0, true, Cells::Quads);
    let options = Options { friction: Friction::None, weak_coverage, ..Options::paper(Stiffness::Modulus(modulus)) };
    let mut contact = contact::<1>(&at(before), &plate, true, options);
    let start = at(over).x;
    let (nodes, equations) = (start.len(), 3 * (start.len() + plate.x.len()));
    let areas = contact.history().areas.clone();
    let base: Vec<f64> = start.iter().map(|x| -PRESSED * (x.x - h * over)).collect();
    let mut unknowns = DVector::<f64>::zeros(2 * nodes);
    // Heights of the nodes, then multipliers; 30 iterations are far more than it takes.
    for _ in 0..30 {
        let x1: Vec<_> = start.iter().enumerate().map(|(a, x)| x + Vec3::z() * unknowns[a]).collect();
        let lambda: Vec<_> = (0..nodes).map(|a| SVector::from([unknowns[nodes + a]])).collect();
        let r = contact.residual(&x1, &plate.x, &lambda, None).unwrap();
        let mut k = DMatrix::<f64>::zeros(2 * nodes, 2 * nodes);
        let index = |e: i64| match e as usize {
            e if e >= equations => Some(nodes + e - equations),
            e if e % 3 == 2 => Some(e / 3),
            _ => None,
        };
        let mut sink = |i: i64, j: i64, v: f64| {
            if let (Some(i), Some(j)) = (index(i), index(j)) {
                k[(i, j)] += v;
            }
        };
        contact.tangent(&x1, &plate.x, &lambda, None, &mut sink).unwrap();
        let mut residual = DVector::<f64>::zeros(2 * nodes);
        for a in 0..nodes {
            residual[a] = r.nonmortar[a].z + SPRINGS * areas[a] * (unknowns[a] - base[a]);
            residual[nodes + a] = r.rows[a][0];
            k[(a, a)] += SPRINGS * areas[a];
        }
        if residual.amax() <= 1e-12 * SPRINGS * PRESSED {
            let reaction: Vec3 = r.mortar.iter().sum();
            return (reaction.z.abs(), lambda.iter().map(|l| l[0].abs()).fold(0.0, f64::max));
        }
        unknowns -= k.lu().solve(&residual).unwrap();
    }
    panic!("not converged at {over}");
}

/// The last column of nodes hangs over by nearly a facet: a multiplier of its own holds the sliver's end up against
/// the springs, with a traction that grows as the sliver goes. Carried, it is a pressure among others, and the force
/// goes on evenly when the sliver is gone.
#[test]
fn the_traction_of_a_sliver_stays_that_of_its_neighbours() {
    /// Of the force, between slivers of a facet's hundredth and less: twice that.
    const SMOOTH: f64 = 0.02;
    let (before, ends) = (0.6, [1.0 - 1e-2, 1.0 - 1e-3, 1.0 + 1e-3]);
    let [far, near, gone] = ends.map(|over| strip_on_springs(0.5, SPRINGS, before, over));
    println!("carried: {far:?} {near:?} {gone:?}");
    assert!((far.0 - near.0).abs() <= SMOOTH * gone.0 && (near.0 - gone.0).abs() <= SMOOTH * gone.0);
    assert!(near.1 <= 3.0 * SPRINGS * PRESSED, "{}", near.1);
    let [far, near, gone] = ends.map(|over| strip_on_springs(0.0, SPRINGS, before, over));
    println!("with multipliers of their own: {far:?} {near:?} {gone:?}");
    assert!(near.1 > 5.0 * far.1 && far.1 > 1e3 * SPRINGS * PRESSED, "tractions of {} and {}", far.1, near.1);
}

#[test]
fn the_answer_does_not_depend_on_the_augmentation() {
    /// Newton's tolerance, 1e-12, over the least singular value of so small a matrix.
    const SAME: f64 = 1e-9;
    let [one, other] = [0.1, 100.0].map(|factor| strip_on_springs(0.5, factor * SPRINGS, 0.6, 0.8));
    assert!((one.0 / other.0 - 1.0).abs() <= SAME && (one.1 / other.1 - 1.0).abs() <= SAME, "{one:?} {other:?}");
}

#[test]
fn fully_covered_surfaces_have_the_same_answer_to_the_last_bit() {
    let answer = |weak_coverage: f64| {
        let mut scene = moved(&Options { weak_coverage, ..options() }, [Cells::Quads, Cells::Quads], FLAT, 7);
        let r = scene.interface.residual(&scene.x1, &scene.x2, &scene.lambda, None).unwrap();
        (r, scene.interface.counters().nodes.carried)
    };
    assert_eq!(answer(0.0), answer(0.5));
}

#[test]
fn sums_of_several_handles_are_refused() {
    let mut s = scene::<3>(&Options { weak_coverage: WEAK, ..options() }, Cells::Quads);
    let sums = s.contact.sums(&s.x1, &s.x2).unwrap();
    let error = s.contact.residual(&s.x1, &s.x2, &s.lambda, Some(&sums)).unwrap_err();
    assert_eq!(error.kind, Kind::Unsupported);
    assert!(error.message.contains("weak_coverage"), "{error}");
}

/// Carriers belong to the history: a rollback and an import bring them back.
#[test]
fn carriers_roll_back_and_are_imported_with_the_history() {
    let options = Options { weak_coverage: WEAK, ..options() };
    let mut s = scene::<3>(&options, Cells::Quads);
    let before = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
    let (integers, reals) = s.contact.export_history().unwrap();
    s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
    assert_ne!(s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap(), before);
    s.contact.roll_back().unwrap();
    assert_eq!(s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap(), before);
    let mut other = scene::<3>(&options, Cells::Quads);
    other.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
    other.contact.import_history(&integers, &reals).unwrap();
    assert_eq!(other.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap(), before);
}

#[test]
fn the_effects_say_so_where_it_is_asked_for() {
    let sentence = "Nodes covered less than 0.4 of their best covered neighbour: carried by it (asked for).";
    let text =
        |weak_coverage| scene::<3>(&Options { weak_coverage, ..options() }, Cells::Quads).contact.effects().unwrap();
    assert!(text(WEAK).ends_with(sentence), "{}", text(WEAK));
    assert!(!text(0.0).contains("carried"));
}

/// With the largest threshold too: on facets that are no parallelograms the fractions differ by the rule's error.
#[test]
fn nodes_covered_as_a_whole_are_not_weak() {
    let mut random = Random(5);
    for cells in [Cells::Quads, Cells::Triangles] {
        let mut one = grid(4, 4, [0.0, 0.0], [1.0, 1.0], 0.0, false, cells);
        let two = grid(5, 3, [-0.5, -0.5], [1.5, 1.5], 0.0, true, Cells::Quads);
        one.x.iter_mut().for_each(|x| *x += Vec3::new(0.04 * random.next(), 0.04 * random.next(), 0.0));
        let options = Options { weak_coverage: 1.0, ..options() };
        let mut contact = contact::<3>(&one, &two, false, options);
        contact.responses(&one.x, &two.x, &vec![SVector::zeros(); one.x.len()], None).unwrap();
        assert_eq!(contact.counters().nodes.carried, 0);
    }
}

/// What a commit that changes carriers makes of the residual at the committed point: in the multiplier form no force, and
/// no row but those of carried nodes and of carriers. A carried node's row is M_A times what its multiplier differs from
/// its carriers' by.
#[test]
fn a_commit_changes_the_rows_of_carried_nodes_and_carriers_alone() {
    for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
        let committed = |weak_coverage| {
            let mut s = scene::<3>(&Options { basis, weak_coverage, ..options() }, Cells::Quads);
            s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
            let r = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
            (s, r)
        };
        let ((s, carrying), (_, own)) = (committed(WEAK), committed(NO_WEAK_COVERAGE));
        assert_eq!((&carrying.nonmortar, &carrying.mortar), (&own.nonmortar, &own.mortar), "{basis:?}");
        let carriers: Vec<_> = s.contact.carriers().collect();
        let covered = s.contact.history().coverage.clone();
        let concerned = |a: usize| carriers.iter().any(|&(c, b, _)| c == a || b == a);
        let mut changed = 0;
        for a in 0..s.x1.len() {
            let told: Vec<_> = carriers.iter().filter(|c| c.0 == a).collect();
            if !concerned(a) {
                assert_eq!(carrying.rows[a], own.rows[a], "{basis:?}: node {a}");
            } else if !told.is_empty() && covered[a] > 0.0 {
                let mean: Vec3 = told.iter().map(|c| s.lambda[c.1] * c.2).sum();
                let expected = (mean - s.lambda[a]) * s.contact.row_scale(a) / s.contact.augmentation(a);
                assert!((carrying.rows[a] - expected).amax() <= ROUNDING * expected.amax(), "{basis:?}: node {a}");
                changed += 1;
            }
        }
        assert!(changed > 0, "{basis:?}");
    }
}
