//! Whatever was called before: an evaluation is a function of its arguments, of the committed history and of what was set.
//! Handles that have gone through random calls are compared, to the bit, with fresh ones that were given nothing but the
//! calls which define their state; and with fresh ones that were given their history.

use crate::support::mesh::*;
use nalgebra::SVector;
use stickslip::error::Result;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{
    Contact, Extent, Form, Friction, MultiplierBasis, NO_EQUATION, NO_WEAK_COVERAGE, NodeSums, Normals, Options,
    Scheme, Shortcuts, Surface, Weights,
};
use stickslip::law::Coefficient;

/// Sequences of calls, and calls of each.
const SEQUENCES: usize = 1500;
const CALLS: usize = 10;

/// Heights over the mortar side and slides: closed, nearly, half beside it, far above, beyond its border, below it.
const PLACES: [(f64, f64); 8] =
    [(0.0, 0.0), (-0.01, 0.02), (0.03, 0.3), (-0.004, 0.9), (3.0, 0.0), (2.5, 0.4), (0.0, 40.0), (-3.0, 0.0)];

/// Calls that define the state. Everything in them follows from the numbers.
#[derive(Clone, Copy, Debug)]
enum Change {
    Friction(u64),
    Augmentation(Option<u64>),
    Normals(Option<u64>),
    UseNormals(Normals),
    Constraints(u64),
    Previous(usize),
    Commit(usize, u64, bool),
    RollBack,
    Restart,
}

/// Calls that must leave no trace.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    Sums,
    Share,
    Responses(bool),
    Residual(bool),
    Tangent(bool),
    Pattern(bool),
    Superset,
    Report,
    Diagnose(bool),
    Start,
    Size,
    Export,
    Effects,
    Turn,
}

const LOOKS: [Look; 19] = [
    Look::Sums,
    Look::Share,
    Look::Responses(false),
    Look::Responses(true),
    Look::Residual(false),
    Look::Residual(true),
    Look::Tangent(false),
    Look::Tangent(true),
    Look::Pattern(false),
    Look::Pattern(true),
    Look::Superset,
    Look::Report,
    Look::Diagnose(false),
    Look::Diagnose(true),
    Look::Start,
    Look::Size,
    Look::Export,
    Look::Effects,
    Look::Turn,
];

/// What interfaces are made of.
struct Scene {
    one: Surface,
    two: Surface,
    options: Options,
}

fn draw(random: &mut Random, below: usize) -> usize {
    (((random.next() + 1.0) * 0.5 * below as f64) as usize).min(below - 1)
}

impl Scene {
    fn new(random: &mut Random, friction: Friction) -> Scene {
        // At 0, so that coordinates of either sign of zero occur; above, so that t_0 is apart.
        let start = [0.0, 0.02, 4.0, 4.0][draw(random, 4)];
        let cells = |random: &mut Random| [Cells::Quads, Cells::Triangles][draw(random, 2)];
        let one = grid(3, 2, [0.0, 0.0], [1.5, 1.0], start, false, cells(random));
        let two = grid(2, 2, [-0.3, -0.2], [1.3, 1.3], 0.0, true, cells(random));
        let nonmortar = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, one.x.len())).unwrap();
        let first = 3 * one.x.len();
        let equations =
            if draw(random, 3) == 0 { vec![[NO_EQUATION; 3]; two.x.len()] } else { numbered(first, two.x.len()) };
        let mortar = if draw(random, 4) == 0 {
            let frame = [Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()];
            Surface::analytic("mortar", AnalyticShape::Plane, frame.to_vec()).unwrap()
        } else {
            Surface::new("mortar", two.x.clone(), &two.facets, equations).unwrap()
        };
        let mut flag = || draw(random, 8) > 0;
        let shortcuts = Shortcuts { frictionless: flag(), rigid: flag(), apart: flag(), uncovered: flag() };
        let mut options = Options { friction, shortcuts, ..options() };
        options.shear_limit = friction.law().limits_shear.then_some(0.02);
        options.mu = if friction.law().mu == Coefficient::Given { [0.0, 0.6][draw(random, 2)] } else { 0.0 };
        options.form = [Form::Multiplier, Form::Multiplier, Form::Augmented][draw(random, 3)];
        options.weights =
            [Weights::Current, Weights::Current, Weights::Current, Weights::Committed, Weights::Reference]
                [draw(random, 5)];
        options.weak_coverage = [NO_WEAK_COVERAGE, 0.5, 1.0][draw(random, 3)];
        const LINE: &[[f64; 2]] = &[[0.21132486540518713, 0.5], [0.7886751345948129, 0.5]];
        options.scheme = [Scheme::Segments, Scheme::Segments, Scheme::Hybrid(LINE)][draw(random, 3)];
        options.basis = [MultiplierBasis::Standard, MultiplierBasis::Standard, MultiplierBasis::Dual][draw(random, 3)];
        if options.weights == Weights::Current {
            options.normals = [Normals::Committed, Normals::Current][draw(random, 2)];
        }
        Scene { one: nonmortar, two: mortar, options }
    }

    fn create<const N: usize>(&self) -> Contact<N>
    where
        Contact<N>: Create<N>,
    {
        let n = self.one.len();
        Contact::create(self.one.clone(), self.two.clone(), numbered(1000, n), self.options).unwrap()
    }

    fn place(&self, k: usize) -> (Vec<Vec3>, Vec<Vec3>) {
        let ((z, slide), start) = (PLACES[k % PLACES.len()], self.one.reference[0].z);
        let at = |x: &Vec3| Vec3::new(x.x + slide, x.y + 0.5 * slide, x.z - start + z + 0.006 * x.x);
        // The same place with other signs of zero.
        let sign = if k < PLACES.len() { 1.0 } else { -1.0 };
        let two = |x: &Vec3| Vec3::new(x.x, x.y, if x.z == 0.0 { sign * x.z } else { x.z });
        (self.one.reference.iter().map(at).collect(), self.two.reference.iter().map(two).collect())
    }

    fn lambda<const N: usize>(&self, seed: u64) -> Vec<SVector<f64, N>> {
        let mut random = Random(seed);
        (0..self.one.len()).map(|_| SVector::from_fn(|_, _| random.next() - 0.4)).collect()
    }

    /// Such as several handles may add up to.
    fn total(&self, seed: u64) -> Vec<NodeSums> {
        let mut random = Random(seed);
        let mut node = || NodeSums {
            coverage: 0.1 * random.next().max(0.0),
            gap_now: random.vector(0.01),
            coverage_previous: 0.1 * random.next().max(0.0),
            gap_previous: random.vector(0.01),
            gap_committed: random.vector(0.01),
        };
        (0..self.one.len()).map(|_| node()).collect()
    }
}

trait Coulomb {
    fn friction(&mut self, mu: Vec<f64>) -> Result<()>;
}
impl Coulomb for Contact<3> {
    fn friction(&mut self, mu: Vec<f64>) -> Result<()> {
        self.set_friction(mu)
    }
}
impl Coulomb for Contact<1> {
    fn friction(&mut self, _: Vec<f64>) -> Result<()> {
        Ok(())
    }
}

/// Also where it is refused: then nothing has changed.
fn apply<const N: usize>(c: &mut Contact<N>, scene: &Scene, change: Change) -> bool
where
    Contact<N>: Coulomb,
{
    let n = scene.one.len();
    let done = match change {
        Change::Friction(seed) => {
            let mut random = Random(seed);
            c.friction((0..n).map(|_| random.next().max(0.0) * (seed % 2) as f64).collect())
        }
        Change::Augmentation(seed) => c.set_augmentation(seed.map(|seed| {
            let mut random = Random(seed);
            (0..n).map(|_| 20.0 + random.next()).collect()
        })),
        // Also such as look away, where surfaces that are apart are none.
        Change::Normals(seed) => c.set_normals(seed.map(|seed| {
            let mut random = Random(seed);
            let up = if seed.is_multiple_of(3) { -Vec3::z() } else { Vec3::z() };
            (0..n).map(|_| (up + random.vector(0.1)).normalize()).collect()
        })),
        Change::UseNormals(normals) => c.use_normals(normals),
        Change::Constraints(seed) => {
            let mut random = Random(seed);
            let list: Vec<_> = (0..seed % 4).map(|k| (k as usize, random.vector(1.0))).collect();
            c.set_constraints(&list)
        }
        Change::Previous(k) => {
            let (x1, x2) = scene.place(k);
            c.set_previous(&x1, &x2)
        }
        Change::Commit(k, seed, with_sums) => {
            let ((x1, x2), total) = (scene.place(k), scene.total(seed));
            c.commit(&x1, &x2, &scene.lambda(seed), with_sums.then_some(&total[..]))
        }
        Change::RollBack => c.roll_back(),
        Change::Restart => c.export_history().and_then(|(integers, reals)| c.import_history(&integers, &reals)),
    };
    done.is_ok()
}

/// All that the call gives, to the bit; or why it is refused.
fn look<const N: usize>(c: &mut Contact<N>, scene: &Scene, look: Look, place: usize, seed: u64) -> Result<Vec<u64>> {
    let ((x1, x2), lambda, total) = (scene.place(place), scene.lambda::<N>(seed), scene.total(seed));
    let sums = |given: bool| given.then_some(&total[..]);
    let mut all = Vec::new();
    let mut entry = |i: i64, j: i64, v: f64| all.extend([i as u64, j as u64, v.to_bits()]);
    match look {
        Look::Sums | Look::Share => {
            let sums = if look == Look::Sums { c.sums(&x1, &x2)? } else { c.share_of_sums(&x1, &x2)? };
            for s in sums {
                all.extend([s.coverage, s.coverage_previous].map(f64::to_bits));
                let gaps = [s.gap_now, s.gap_previous, s.gap_committed];
                all.extend(gaps.iter().flatten().map(|v| v.to_bits()));
            }
        }
        Look::Responses(given) => {
            for (a, r) in c.responses(&x1, &x2, &lambda, sums(given))?.iter().enumerate() {
                all.push(r.state as u64);
                let numbers = r.row.iter().chain(&r.traction).chain(&r.slip).chain(&r.drow_dnow).copied();
                let set = [r.gap_normal, c.augmentation(a), c.row_scale(a)];
                let nu = c.normal(a)?;
                all.extend(numbers.chain(set).chain([nu.x, nu.y, nu.z]).map(f64::to_bits));
            }
        }
        Look::Residual(given) => {
            let r = c.residual(&x1, &x2, &lambda, sums(given))?;
            let forces = r.nonmortar.iter().chain(&r.mortar).flatten();
            all.extend(forces.chain(r.rows.iter().flatten()).map(|v| v.to_bits()));
        }
        Look::Tangent(given) => c.tangent(&x1, &x2, &lambda, sums(given), &mut entry)?,
        Look::Pattern(given) => {
            let extent = if given { Extent::Part } else { Extent::Whole };
            c.pattern(&x1, &x2, extent, &mut entry)?;
        }
        Look::Superset => c.superset_pattern(&x1, &x2, &mut entry)?,
        Look::Report => all.extend(format!("{:?}", c.report(&x1, &x2)?).bytes().map(u64::from)),
        Look::Diagnose(given) => {
            let diagnosis = c.diagnose(&x1, &x2, &lambda, sums(given))?;
            all.extend(format!("{diagnosis:?}").bytes().map(u64::from));
        }
        Look::Start => all.extend(c.initial_multipliers()?.iter().flatten().map(|v| v.to_bits())),
        Look::Size => all.extend(<[usize; 2]>::from(c.history_size()?).map(|n| n as u64)),
        Look::Export => {
            let (integers, reals) = c.export_history()?;
            all.extend(integers.iter().map(|i| *i as u64).chain(reals.iter().map(|v| v.to_bits())));
        }
        Look::Turn => all.extend(c.turn_multipliers(&x1, &lambda)?.iter().flatten().map(|v| v.to_bits())),
        Look::Effects => all.extend(c.effects().unwrap().bytes().map(u64::from)),
    }
    Ok(all)
}

fn any_change(random: &mut Random) -> Change {
    let seed = draw(random, 1000) as u64;
    let place = draw(random, 2 * PLACES.len());
    match draw(random, 13) {
        0 => Change::Friction(seed),
        1 => Change::Augmentation((seed > 300).then_some(seed)),
        2 | 3 => Change::Normals((seed > 300).then_some(seed)),
        4 => Change::Constraints(seed),
        5 => Change::Previous(place),
        6 => Change::RollBack,
        7 => Change::Restart,
        8 => Change::UseNormals([Normals::Committed, Normals::Current][draw(random, 2)]),
        _ => Change::Commit(place, seed, seed.is_multiple_of(4)),
    }
}

/// Which normals the host has asked for since the step began.
fn in_step(changes: &[Change]) -> impl Iterator<Item = &Change> {
    let begins =
        |c: &Change| matches!(c, Change::Previous(_) | Change::Commit(..) | Change::RollBack | Change::Restart);
    let first = changes.iter().rposition(begins).map_or(0, |k| k + 1);
    changes[first..].iter().filter(|c| matches!(c, Change::UseNormals(_)))
}

/// Sequences of random calls; how many looks succeeded, and at how many of them nothing was looked at (apart).
fn run<const N: usize>(random: &mut Random, friction: Friction, seen: &mut [usize; 3])
where
    Contact<N>: Create<N> + Coulomb,
{
    let scene = Scene::new(random, friction);
    let mut used: Contact<N> = scene.create();
    let mut changes = Vec::new();
    // Few places, so that calls meet what others have left.
    let places = [(); 2].map(|()| draw(random, 2 * PLACES.len()));
    for _ in 0..CALLS {
        if draw(random, 3) == 0 {
            let change = any_change(random);
            if apply(&mut used, &scene, change) {
                changes.push(change);
            }
        }
        let (kind, place, seed) = (LOOKS[draw(random, LOOKS.len())], places[draw(random, 2)], draw(random, 3) as u64);
        let found = look(&mut used, &scene, kind, place, seed);
        let mut fresh: Contact<N> = scene.create();
        for &change in &changes {
            assert!(apply(&mut fresh, &scene, change), "{change:?} of {changes:?}");
        }
        let mut restarted: Contact<N> = scene.create();
        let expected = look(&mut fresh, &scene, kind, place, seed);
        let told = || format!("{kind:?} at {place} after {changes:?}, {:?}", scene.options);
        assert!(found == expected, "{}:\n{found:?}\n{expected:?}", told());
        // What was set, last of all things; a history that cannot be made up for cannot be exported either.
        if let Ok((integers, reals)) = fresh.export_history() {
            let sets = |c: &&Change| {
                !matches!(c, Change::Previous(_) | Change::Commit(..) | Change::RollBack | Change::Restart)
            };
            for &change in changes.iter().filter(sets) {
                apply(&mut restarted, &scene, change);
            }
            restarted.import_history(&integers, &reals).unwrap();
            // Which normals are in use belongs to the step and not to its history.
            for &change in in_step(&changes) {
                apply(&mut restarted, &scene, change);
            }
            assert!(look(&mut restarted, &scene, kind, place, seed) == expected, "restarted, {}", told());
        }
        seen[0] += usize::from(found.is_ok());
        seen[1] += usize::from(fresh.counters().evaluations_apart > 0);
        seen[2] += usize::from(fresh.counters().commits_apart > 0);
    }
}

#[test]
fn an_evaluation_knows_nothing_of_the_calls_before_it() {
    let (mut random, mut seen) = (Random(14), [0; 3]);
    for _ in 0..SEQUENCES {
        match draw(&mut random, 7) {
            0 | 1 => run::<1>(&mut random, Friction::None, &mut seen),
            2 => run::<3>(&mut random, Friction::Rough, &mut seen),
            3 => run::<3>(&mut random, Friction::Tied, &mut seen),
            4 => run::<3>(&mut random, Friction::Tresca, &mut seen),
            _ => run::<3>(&mut random, Friction::Coulomb, &mut seen),
        }
    }
    // A law that is hardly ever tested holds easily.
    let looks = SEQUENCES * CALLS;
    assert!(2 * seen[0] > looks && 30 * seen[1] > looks && 15 * seen[2] > looks, "{seen:?} of {looks}");
}
