//! Turns within one step: below the limit a further step at rest gives what many small steps give; above it the commit
//! refuses, whatever the shape, and nothing has moved.

use crate::support::host::Body;
use crate::support::mesh::*;
use crate::support::press::{Failure, Place, Press};
use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion};
use stickslip::error::Kind;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{
    Contact, Decision, Friction, Interface, MultiplierBasis, NO_EQUATION, Normals, Options, Stiffness, Surface,
    TURN_MAX, Weights,
};
use stickslip::law::{SlipMeasure, State};

/// Against many small steps, of the largest pressure: without friction a step at rest forgets the path but for areas of
/// t_n; where all stick it is exact but for the path's own rounding.
const FRICTIONLESS: f64 = 1e-4;
const STUCK: f64 = 1e-6;
/// The same where facets of two meshes lie on a curve: between their chords there are gaps, of which the normals of t_n
/// tell normal and tangential part wrongly. It goes with the square of the turn.
const STUCK_ON_A_CURVE: f64 = 5e-5;
/// At most what a degree costs in the step itself, of the largest pressure: without friction, where all stick.
const A_DEGREE: [f64; 2] = [0.12, 1e-3];
/// With the normals of now nothing but the rounding of Newton's method is left of a turn, of the largest pressure: the
/// stiffness times the rounding of positions of size 1, over a pressure of a hundredth.
const RIGID: f64 = 1e-9;
/// Turns in degrees.
const TURNS: [f64; 12] = [1.0, 2.0, 5.0, 10.0, 15.0, 19.0, 21.0, 30.0, 45.0, 80.0, 90.0, 180.0];
/// Into how many steps a turn is cut to compare with.
const MANY: usize = 24;
/// How much more than its body a soft surface turns where the contact bends it [degrees].
const STRAINED: f64 = 1.0;
/// Commits until normals and areas are those of the pressed surfaces.
const SETTLE: usize = 6;

/// What turns.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// An elastic ring, the non-mortar side, around a shaft that is too thick; both turn.
    ShaftInRing,
    /// An elastic block on a plate; both turn about an axis in the plane.
    BlockOnBlock,
    /// A part of an elastic ball in a cup of another mesh; both turn.
    BallInCup,
    /// As `BlockOnBlock`, on an analytic plane.
    OnPlane,
}

/// How thick the interference is: strains as of metal. The step at rest starts from a surface that the wrong normals
/// have pushed along itself, so what it leaves goes with the strain times the turn.
const DEPTH: f64 = 1e-4;

/// The layer's surface, the vector to its far side, the mortar surface; the axis of the turn runs through the origin.
fn scene(shape: Shape) -> (Mesh, Vec3, Mesh) {
    let flat = |n, m, half: f64, up| grid(n, m, [-half, -half], [half, half], 0.0, up, Cells::Quads);
    match shape {
        Shape::BlockOnBlock | Shape::OnPlane => {
            let (mut one, mut two) = (flat(4, 4, 0.5, false), flat(5, 3, 0.9, true));
            one.x.iter_mut().for_each(|x| x.z += 0.5 - DEPTH);
            two.x.iter_mut().for_each(|x| x.z += 0.5);
            (one, Vec3::z(), two)
        }
        Shape::ShaftInRing => {
            // Half a turn of each about y, radius 1.
            let bend = |mesh: &mut Mesh, radius: f64| {
                mesh.x.iter_mut().for_each(|x| *x = Vec3::new(radius * x.x.sin(), x.y, radius * x.x.cos()))
            };
            let (mut one, mut two) = (flat(8, 3, 0.8, false), flat(11, 2, 1.1, true));
            bend(&mut one, 1.0 - DEPTH);
            bend(&mut two, 1.0);
            (one, Vec3::z() * 0.5, two)
        }
        Shape::BallInCup => {
            let bend = |mesh: &mut Mesh, radius: f64| {
                mesh.x.iter_mut().for_each(|x| *x = Vec3::new(x.x, x.y, -1.0).normalize() * radius)
            };
            let (mut one, mut two) = (flat(4, 4, 0.4, false), flat(7, 6, 0.7, true));
            bend(&mut one, 1.0 + DEPTH);
            bend(&mut two, 1.0);
            (one, Vec3::z() * 0.5, two)
        }
    }
}

struct Turning<const N: usize> {
    press: Press<N>,
    x2: Vec<Vec3>,
    axis: Vec3,
}

impl<const N: usize> Turning<N>
where
    Contact<N>: Create<N>,
{
    fn new(shape: Shape, options: Options) -> Turning<N> {
        let (one, far, two) = scene(shape);
        let mortar = if shape == Shape::OnPlane {
            let p = Vec3::z() * 0.5;
            Surface::analytic("mortar", AnalyticShape::Plane, vec![p, p + Vec3::z(), p + Vec3::x(), p + Vec3::y()])
        } else {
            Surface::new("mortar", two.x.clone(), &two.facets, vec![[NO_EQUATION; 3]; two.x.len()])
        };
        let mortar = mortar.unwrap();
        let x2 = mortar.reference.clone();
        let press = Press::new(Body::new(one, far, 100.0, 0.3), mortar, options);
        Turning { press, x2, axis: Vec3::y() }
    }

    fn place(&self, angle: f64) -> Place {
        let turn = Rotation3::new(self.axis * angle);
        let plate = Isometry3::from_parts(Translation3::identity(), UnitQuaternion::from_rotation_matrix(&turn));
        Place { plate, mortar: self.x2.iter().map(|x| turn * x).collect() }
    }

    /// Turned in so many steps, then as many as said at rest; pressures in the turned frame.
    fn turned(&mut self, angle: f64, steps: usize, at_rest: usize) -> Result<(Vec<f64>, Vec<State>), Failure> {
        for _ in 0..SETTLE {
            self.press.step(&self.place(0.0))?;
        }
        for k in 1..=steps {
            self.press.step(&self.place(angle * k as f64 / steps as f64))?;
        }
        let rest = self.place(angle);
        for _ in 0..at_rest {
            self.press.step(&rest)?;
        }
        let states = self.press.force(&rest).1;
        Ok((self.press.lambda.iter().map(|l| l.norm()).collect(), states))
    }
}

/// The largest error of a pressure, over the largest pressure.
fn error(found: &[f64], wanted: &[f64]) -> f64 {
    let most = wanted.iter().copied().fold(0.0, f64::max);
    found.iter().zip(wanted).map(|(a, b)| (a - b).abs() / most).fold(0.0, f64::max)
}

fn off<const N: usize>(shape: Shape, options: Options, degrees: f64) -> Option<f64>
where
    Contact<N>: Create<N>,
{
    // Hardly more than the corners of the ball's facets touch: one step at rest leaves 5e-3 of the turn.
    let at_rest = if shape == Shape::BallInCup { 2 } else { 1 };
    let angle = degrees.to_radians();
    let in_one = Turning::<N>::new(shape, options).turned(angle, 1, at_rest);
    match in_one {
        Err(Failure::Refused(error)) if error.kind == Kind::TurnedTooFar => {
            let text = error.message.split("turned by ").nth(1).and_then(|t| t.split(' ').next());
            let told: f64 = text.and_then(|t| t.parse().ok()).expect("the angle is told");
            assert!((told - degrees).abs() < STRAINED, "{}", error.message);
            assert!(error.message.contains("20.0 that are allowed"), "{}", error.message);
            None
        }
        // Newton's method need not get as far as a commit.
        Err(Failure::Refused(error)) => {
            assert!(angle > TURN_MAX, "{shape:?}: {degrees} degrees: {}", error.message);
            None
        }
        Err(Failure::NotConverged) => {
            assert!(degrees > 15.0, "{shape:?}: {degrees} degrees do not converge");
            None
        }
        Ok((found, states)) => {
            assert!(angle <= TURN_MAX, "{shape:?}: {degrees} degrees are accepted");
            let (wanted, same) = Turning::<N>::new(shape, options).turned(angle, MANY, at_rest).unwrap();
            assert!(states.iter().any(|s| *s != State::Gap) && states == same, "{shape:?} {degrees}: {states:?}");
            Some(error(&found, &wanted))
        }
    }
}

/// The largest error of a pressure over the largest pressure; NaN where the turn does not converge.
fn in_the_step<const N: usize>(shape: Shape, options: Options, degrees: f64) -> f64
where
    Contact<N>: Create<N>,
{
    let angle = degrees.to_radians();
    let (wanted, _) = Turning::<N>::new(shape, options).turned(angle, MANY, 2).unwrap();
    let Ok((found, _)) = Turning::<N>::new(shape, options).turned(angle, 1, 0) else { return f64::NAN };
    error(&found, &wanted)
}

#[test]
fn a_turn_in_one_step_is_right_after_a_step_at_rest_or_refused() {
    let base = Options::paper(Stiffness::Modulus(100.0));
    for shape in [Shape::ShaftInRing, Shape::BlockOnBlock, Shape::BallInCup, Shape::OnPlane] {
        for degrees in TURNS {
            let smooth = off::<1>(shape, Options { friction: Friction::None, ..base }, degrees);
            let stuck = off::<3>(shape, Options { mu: 100.0, ..base }, degrees);
            println!("{shape:?}, {degrees} degrees: {smooth:?} without friction, {stuck:?} where all stick");
            assert!(smooth.is_none_or(|e| e < FRICTIONLESS), "{shape:?} {degrees}: {smooth:?}");
            let curved = matches!(shape, Shape::ShaftInRing | Shape::BallInCup);
            let bound = if curved { STUCK_ON_A_CURVE } else { STUCK };
            assert!(stuck.is_none_or(|e| e < bound), "{shape:?} {degrees}: {stuck:?}");
        }
    }
}

/// The table of docs/host_steps.md: how wrong the pressure is where such a step ends, before the next one.
#[test]
fn what_a_turn_costs_in_the_step_itself() {
    let base = Options::paper(Stiffness::Modulus(100.0));
    for shape in [Shape::ShaftInRing, Shape::BlockOnBlock, Shape::BallInCup] {
        for degrees in [1.0, 2.0, 5.0, 10.0, 15.0] {
            let smooth = in_the_step::<1>(shape, Options { friction: Friction::None, ..base }, degrees);
            let stuck = in_the_step::<3>(shape, Options { mu: 100.0, ..base }, degrees);
            println!("{shape:?}, {degrees} degrees: {smooth:.1e} without friction, {stuck:.1e} where all stick");
            assert!(smooth < A_DEGREE[0] * degrees && stuck < A_DEGREE[1] * degrees, "{shape:?} {degrees}");
        }
    }
}

/// With the normals of now everything may turn by any angle in one step: the pressures are those from before.
#[test]
fn a_turn_in_one_step_is_right_with_the_normals_of_now() {
    fn worst<const N: usize>(shape: Shape, options: Options, degrees: f64) -> f64
    where
        Contact<N>: Create<N>,
    {
        let (wanted, same) = Turning::<N>::new(shape, options).turned(0.0, 1, 0).unwrap();
        let (found, states) = Turning::<N>::new(shape, options).turned(degrees.to_radians(), 1, 0).unwrap();
        // Tractions on the cone stick or slip by their rounding.
        let closed = |states: &[State]| states.iter().map(|s| *s != State::Gap).collect::<Vec<_>>();
        assert_eq!(closed(&states), closed(&same), "{shape:?} {degrees}");
        error(&found, &wanted)
    }
    let base = Options { normals: Normals::Current, ..Options::paper(Stiffness::Modulus(100.0)) };
    for shape in [Shape::ShaftInRing, Shape::BlockOnBlock, Shape::BallInCup, Shape::OnPlane] {
        for degrees in [1.0, 5.0, 15.0, 30.0, 90.0, 150.0] {
            let smooth = worst::<1>(shape, Options { friction: Friction::None, ..base }, degrees);
            let stuck = worst::<3>(shape, Options { mu: 100.0, ..base }, degrees);
            let slipping = worst::<3>(shape, Options { mu: 0.01, ..base }, degrees);
            println!(
                "{shape:?}, {degrees} degrees: {smooth:.0e} without friction, {stuck:.0e} stuck, {slipping:.0e} with little"
            );
            assert!(smooth.max(stuck).max(slipping) < RIGID, "{shape:?} {degrees}: {smooth:e} {stuck:e} {slipping:e}");
        }
    }
}

/// What turns, and by how much it counts, without any equilibrium.
#[test]
fn a_commit_refuses_every_turn_beyond_the_limit() {
    for shape in [Shape::ShaftInRing, Shape::BlockOnBlock, Shape::BallInCup, Shape::OnPlane] {
        let base = Options { mu: 0.3, ..Options::paper(Stiffness::Modulus(100.0)) };
        for (one, two) in [(true, true), (true, false), (false, true)] {
            for degrees in TURNS {
                let mut t = Turning::<3>::new(shape, base);
                let [rest, turned] = [0.0, degrees.to_radians()].map(|angle| t.place(angle));
                let x1 = t.press.positions(if one { &turned } else { &rest });
                let x2 = if two { &turned.mortar } else { &rest.mortar };
                let lambda = vec![Vec3::zeros(); x1.len()];
                let before = t.press.contact.history().clone();
                match t.press.contact.commit(&x1, x2, &lambda, None) {
                    Ok(()) => assert!(degrees <= 20.0, "{shape:?}, {degrees} degrees are accepted"),
                    Err(error) if error.kind == Kind::TurnedTooFar => {
                        assert!(degrees > 20.0, "{shape:?}, {degrees} degrees: {}", error.message);
                        assert!(*t.press.contact.history() == before);
                    }
                    // Deep in each other, or folded in projection: refused before.
                    Err(error) => assert!(error.kind != Kind::InvalidValue || degrees > 20.0, "{}", error.message),
                }
            }
        }
    }
}

/// Tied surfaces and those that are apart may turn; with weights of the reference the whole turn counts; `turn_max`.
#[test]
fn what_asks_for_no_normals_may_turn() {
    let base = Options::paper(Stiffness::Modulus(100.0));
    let quarter = 90_f64.to_radians();
    let commit = |options: Options, lift: f64, turns: &[f64]| {
        let mut t = Turning::<3>::new(Shape::BlockOnBlock, options);
        let place = |angle: f64| t.place(angle);
        let places: Vec<_> = turns.iter().map(|a| place(*a)).collect();
        let lambda = vec![Vec3::zeros(); t.press.lambda.len()];
        // Away from each other along the axis of the turn.
        let up = Vec3::y() * lift;
        let first: Vec<_> = t.press.positions(&t.place(0.0)).iter().map(|x| x + up).collect();
        t.press.contact.set_previous(&first, &t.x2)?;
        places.iter().try_for_each(|p| {
            let x1: Vec<_> = t.press.positions(p).iter().map(|x| x + up).collect();
            t.press.contact.commit(&x1, &p.mortar, &lambda, None)
        })
    };
    let kind = |r: Result<(), stickslip::error::Error>| r.map_err(|e| e.kind);
    assert_eq!(kind(commit(Options { friction: Friction::Tied, ..base }, 0.0, &[quarter])), Ok(()));
    assert_eq!(kind(commit(base, 0.0, &[quarter])), Err(Kind::TurnedTooFar));
    assert_eq!(kind(commit(base, 3.0, &[quarter])), Ok(()), "apart before and after");
    assert_eq!(kind(commit(Options { turn_max: 0.1, ..base }, 0.0, &[0.2])), Err(Kind::TurnedTooFar));
    assert_eq!(kind(commit(Options { turn_max: 0.3, ..base }, 0.0, &[0.2, 0.4])), Ok(()), "each step for itself");
    let small = Options { weights: Weights::Reference, turn_max: 0.3, ..base };
    let error = commit(small, 0.0, &[0.2, 0.4]).unwrap_err();
    assert_eq!(error.kind, Kind::TurnedTooFar);
    assert!(error.message.contains("since the first configuration"), "{}", error.message);
    // No step is short enough for that, which the refusal had as its remedy.
    let remedy = "take STICKSLIP_WEIGHTS_CURRENT, or a larger method.turn_max";
    assert!(error.message.contains(remedy) && !error.message.contains("take smaller steps"), "{}", error.message);
    let error = commit(base, 0.0, &[quarter]).unwrap_err();
    assert!(error.message.ends_with("take smaller steps"), "{}", error.message);
    for turn_max in [0.0, -0.1, 3.2, f64::NAN] {
        assert_eq!(Options { turn_max, ..base }.validate().unwrap_err().kind, Kind::InvalidValue);
    }
}

/// A plate that spins on another about their normal, with and without friction: the moment of friction of one step is cos(theta / 2) of
/// what it must be, so that a step with more than the limit is refused, with every kind of weights and of decision, and nothing has moved.
#[test]
fn friction_refuses_a_spin_beyond_the_limit() {
    let dual = Options { basis: MultiplierBasis::Dual, ..Options::paper(Stiffness::Modulus(100.0)) };
    let base = Options { mu: 0.3, ..Options::paper(Stiffness::Modulus(100.0)) };
    let points = Options { decision: Decision::Points(100.0), weights: Weights::Committed, mu: 0.3, ..dual };
    let all = [
        base,
        Options { mu: 0.3, ..dual },
        Options { normals: Normals::Current, ..base },
        Options { weights: Weights::Committed, ..base },
        Options { slip: SlipMeasure::Increment, ..base },
        points,
        Options { mu: 0.0, ..base },
        Options { friction: Friction::Tied, ..Options::paper(Stiffness::Modulus(100.0)) },
    ];
    for (k, options) in all.into_iter().enumerate() {
        for degrees in [5.0, 19.0, 21.0, 60.0, 120.0, 179.0] {
            let upper = grid(3, 3, [-0.5, -0.5], [0.5, 0.5], 0.0, false, Cells::Quads);
            let lower = grid(2, 2, [-0.9, -0.9], [0.9, 0.9], 0.0, true, Cells::Quads);
            let (n1, n2) = (upper.x.len(), lower.x.len());
            let one = Surface::new("nonmortar", upper.x.clone(), &upper.facets, numbered(0, n1)).unwrap();
            let two = Surface::new("mortar", lower.x.clone(), &lower.facets, numbered(3 * n1, n2)).unwrap();
            let mut contact: Interface = Contact::new(one, two, numbered(3 * (n1 + n2), n1), options).unwrap();
            let lambda = vec![-Vec3::z(); n1];
            contact.commit(&upper.x, &lower.x, &lambda, None).unwrap();
            let spin = Rotation3::from_axis_angle(&Vec3::z_axis(), f64::to_radians(degrees));
            let x1: Vec<Vec3> = upper.x.iter().map(|x| spin * x).collect();
            let before = contact.history().clone();
            let is_refused = k < 6 && degrees > 20.0;
            match contact.commit(&x1, &lower.x, &lambda, None) {
                Ok(()) => assert!(!is_refused, "{k}: {degrees} degrees are accepted"),
                Err(error) => {
                    assert!(is_refused && error.kind == Kind::TurnedTooFar, "{k}, {degrees} degrees: {error}");
                    assert!(error.message.contains("about its normal and against the mortar side"), "{error}");
                    assert!(error.message.contains(&format!("{degrees:.1} degrees")), "{k}, {degrees}: {error}");
                    assert!(*contact.history() == before);
                }
            }
            // Both together may turn as they like.
            let x2: Vec<Vec3> = lower.x.iter().map(|x| spin * x).collect();
            contact.commit(&x1, &x2, &lambda, None).unwrap_or_else(|error| panic!("{k}, {degrees} degrees: {error}"));
        }
    }
}
