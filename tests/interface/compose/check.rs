//! What must hold of a combination that is accepted: tangents are derivatives, forces balance, a commit can be undone, a second step
//! follows, and a handle that is told what was committed goes on likewise.

use super::choice::{Asked, Choice};
use super::dependence::{by_parameters, by_previous_positions};
use super::handles::{Handles, Refused, TakesLaw, of, when};
use super::scene::{At, Scene};
use super::system::{Direction, Grouped, System};
use crate::support::differences::Point;
use crate::support::max_abs;
use crate::support::mesh::{Create, Random};
use nalgebra::SVector;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Temperatures};
use stickslip::law::Conductance;

/// Sums of some hundred forces over the sum of their sizes, rounding.
const BALANCE: f64 = 1e-9;
/// A residual after set_committed over the one that it follows: gaps of t_n are integrated once more.
const RESTARTED: f64 = 1e-9;
/// A derivative against central differences, over the largest of its kind.
pub const DIFFERENCES: f64 = 1e-6;
/// Steps of differences over the model's size, largest first: the best of them counts, for near a kink only small ones do.
const STEPS: [f64; 4] = [1e-6, 2e-7, 4e-8, 8e-9];
/// Where points decide, one of them may have its kink on one side of a state, which no node tells: the other side counts, too. The
/// steps below this are small enough for differences of one side.
const ONE_SIDED: f64 = 1e-7;
/// The error of differences of one side: rounding over such a step.
const OF_ONE_SIDE: f64 = 1e-5;
/// Steps whose differences, and those of their halves, are extrapolated to none: conserving forces divide by motions of a thousandth, and
/// their rounding needs a step at which curvature counts.
const LARGE: [f64; 3] = [3.2e-5, 1.6e-5, 6.4e-6];
/// Below this a kind of entries is noise of the others.
const NOTHING: f64 = 1e-9;
/// Entries in place against those of the pieces, over the largest: other orders of sums.
const IN_PLACE: f64 = 1e-9;

/// Entries of a plan against those one by one, over the largest: other orders of sums.
const PLAN: f64 = 1e-12;

/// A residual somewhere else, over the largest force or row: rounding of positions, over gaps of a thousandth of them.
const ELSEWHERE: f64 = 1e-9;

/// Parts together against one handle of the whole: other orders of sums.
const PARTS: f64 = 1e-9;

/// Numbers that make all parts of the law act.
const CONDUCTANCE: Conductance = Conductance {
    contact: 3.0,
    pressure: 4.0,
    exponent: 0.95,
    constant: 0.2,
    gas: 0.001,
    gas_gap: 1e-3,
    reach: 0.01,
    share: 0.4,
    time: 0.1,
};

/// How a combination that was accepted came out: what is wrong with it, if anything is; how many derivatives were compared.
#[derive(Default)]
pub struct Found {
    pub wrong: Option<String>,
    pub compared: usize,
    /// Nodes with a gap, that stick, that slip.
    pub states: [usize; 3],
}

impl Found {
    fn wrong(&mut self, what: String) {
        self.wrong.get_or_insert(what);
    }
}

/// Whether the header promises an exact tangent.
fn is_exact(c: &Choice) -> bool {
    let is_flat = c.is_analytic();
    !c.is_current() || c.is("tangent", "exact") || (c.is("tangent", "frozen_normals") && is_flat)
}

/// The largest difference between both over the largest of a group.
fn error(found: &[Vec<f64>], expected: &[Vec<f64>]) -> f64 {
    let of = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        let largest = max_abs(a.iter().chain(b).copied());
        if largest < NOTHING { 0.0 } else { max_abs(a.iter().zip(b).map(|(a, b)| a - b)) / largest }
    };
    found.iter().zip(expected).map(of).fold(0.0, f64::max)
}

/// A sum of two.
fn weighted(by: [f64; 2], of: [&Grouped; 2]) -> Grouped {
    let rows = of[0].iter().zip(of[1]);
    rows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| by[0] * a + by[1] * b).collect()).collect()
}

/// Compares what `value` does along a direction with its derivative; states that change are kinks. Whether it was compared.
pub fn compare<E>(
    found: &mut Found,
    what: &str,
    exact: &[Vec<f64>],
    mut value: impl FnMut(f64) -> Result<(Grouped, Vec<u8>), E>,
) -> Result<(), E> {
    let (here, states) = value(0.0)?;
    let (mut best, mut same) = (f64::INFINITY, true);
    for h in STEPS {
        let ((plus, s1), (minus, s2)) = (value(h)?, value(-h)?);
        best = error(&weighted([0.5 / h, -0.5 / h], [&plus, &minus]), exact).min(best);
        same = s1 == states && s2 == states;
        if h < ONE_SIDED && best > DIFFERENCES {
            let sides = [[&plus, &here], [&here, &minus]].map(|of| error(&weighted([1.0 / h, -1.0 / h], of), exact));
            best = if sides[0].min(sides[1]) <= OF_ONE_SIDE { 0.0 } else { best };
        }
        if best <= DIFFERENCES {
            break;
        }
    }
    if best > DIFFERENCES && same {
        let central = |h: f64, value: &mut dyn FnMut(f64) -> Result<(Grouped, Vec<u8>), E>| {
            Ok::<_, E>(weighted([0.5 / h, -0.5 / h], [&value(h)?.0, &value(-h)?.0]))
        };
        for h in LARGE {
            let (large, half) = (central(h, &mut value)?, central(0.5 * h, &mut value)?);
            best = error(&weighted([4.0 / 3.0, -1.0 / 3.0], [&half, &large]), exact).min(best);
        }
    }
    if best <= DIFFERENCES || same {
        found.compared += 1;
    }
    if best > DIFFERENCES && same {
        found.wrong(format!("{what}: differences say {best:.1e}"));
    }
    Ok(())
}

/// Tries a combination: a refusal, or what was found.
pub fn tried(choice: Choice) -> Result<Found, Refused> {
    if choice.is_smooth() { run::<1>(choice) } else { run::<3>(choice) }
}

fn run<const N: usize>(choice: Choice) -> Result<Found, Refused>
where
    Contact<N>: Create<N> + TakesLaw,
{
    let (scene, mut found) = (Scene::new(choice), Found::default());
    let mut handles = Handles::<N>::new(&scene)?;
    let undivided = Scene::new(choice.set("ranks", "one"));
    let mut whole = if choice.is("ranks", "parts") { Some(Handles::<N>::new(&undivided)?) } else { None };
    for step in 0..2 {
        let at = scene.at::<N>(step);
        let before = when(Asked::Residual, handles.residual(&at))?;
        balance(&scene, &at, &before, &mut found);
        if let Some(whole) = &mut whole {
            let of_whole = when(Asked::Residual, whole.residual(&at))?;
            equal(&at, (&before, &of_whole), (PARTS, "of parts"), &mut found);
            when(Asked::Residual, whole.commit(&at))?;
        }
        if step == 0 {
            elsewhere(&scene, &at, &before, &mut found)?;
        }
        let answers = when(Asked::Residual, handles.answers(&at))?;
        answers
            .iter()
            .zip(&scene.has_row)
            .filter(|(_, has)| **has)
            .for_each(|(r, _)| found.states[r.state as usize] += 1);
        let mut system = System::new(&scene, &mut handles, &at)?;
        tangents(&mut system, &mut found, step)?;
        if choice.is("ranks", "one") && !choice.is_condensed() {
            let point = Point { contact: &mut handles.all[0], x1: &at.x1, x2: &at.x2, lambda: &at.lambda };
            let off = point.plan_error();
            if !(off <= PLAN) {
                found.wrong(format!("step {step}: entries of a plan are off by {off:.1e}"));
            }
        }
        if !choice.is("heat", "no") {
            heat(&scene, &mut handles, &at, &mut found)?;
        }
        // Newton's last evaluation is the one that is committed, whatever was asked in between.
        when(Asked::Residual, handles.commit(&at))?;
        if step > 0 {
            break;
        }
        when(Asked::Residual, handles.roll_back())?;
        if when(Asked::Residual, handles.residual(&at))? != before {
            found.wrong("after a commit and its rollback the residual has other bits".to_owned());
        }
        when(Asked::Residual, handles.commit(&at))?;
        match choice.of("derivatives") {
            "previous" => by_previous_positions(&scene, &mut handles, &at, &mut found)?,
            "parameters" => by_parameters(&scene, &mut handles, &at, &mut found)?,
            _ => {}
        }
        if choice.is("restart", "committed") {
            restart(&scene, &mut handles, &at, &mut found)?;
        }
    }
    Ok(found)
}

/// Forces of both sides add up to nothing; of axisymmetric models those along the axis.
fn balance<const N: usize>(scene: &Scene, at: &At<N>, r: &[f64], found: &mut Found) {
    let n = 3 * (at.x1.len() + at.x2.len());
    let sum = r[..n].chunks_exact(3).fold(Vec3::zeros(), |sum, f| sum + Vec3::from_column_slice(f));
    let size: f64 = r[..n].iter().map(|f| f.abs()).sum();
    let off = if scene.choice.is_axisymmetric() { sum.y.abs() } else { sum.amax() };
    if !(off <= BALANCE * size.max(NOTHING)) {
        found.wrong(format!("forces of both sides add up to {off:.1e} of {size:.1e}"));
    }
}

/// Where everything is turned and shifted, forces and rows are turned.
fn elsewhere<const N: usize>(scene: &Scene, at: &At<N>, before: &[f64], found: &mut Found) -> Result<(), Refused>
where
    Contact<N>: Create<N> + TakesLaw,
{
    let (scene, turn, by) = scene.elsewhere();
    let moved = |x: &[Vec3]| x.iter().map(|x| turn * x + by).collect();
    let turned = |v: &[f64]| match v.len() {
        3 => (turn * Vec3::from_column_slice(v)).as_slice().to_vec(),
        _ => v.to_vec(),
    };
    let of_node = |lambda: &SVector<f64, N>| SVector::from_column_slice(&turned(lambda.as_slice()));
    let at = At { x1: moved(&at.x1), x2: moved(&at.x2), lambda: at.lambda.iter().map(of_node).collect() };
    let r = when(Asked::Residual, Handles::<N>::new(&scene)?.residual(&at))?;
    let (forces, rows) = before.split_at(3 * (at.x1.len() + at.x2.len()));
    let before: Vec<f64> = forces.chunks_exact(3).chain(rows.chunks_exact(N)).flat_map(turned).collect();
    equal(&at, (&r, &before), (ELSEWHERE, "where everything is moved"), found);
    Ok(())
}

/// Forces and rows, each over the largest.
fn equal<const N: usize>(at: &At<N>, (r, expected): (&[f64], &[f64]), (bound, which): (f64, &str), found: &mut Found) {
    let rows = 3 * (at.x1.len() + at.x2.len());
    for (what, range) in [("forces", 0..rows), ("rows", rows..r.len())] {
        let (r, expected) = (&r[range.clone()], &expected[range]);
        let off = max_abs(r.iter().zip(expected).map(|(a, b)| a - b)) / max_abs(expected.iter().copied()).max(NOTHING);
        if !(off <= bound) {
            found.wrong(format!("{what} are off by {off:.1e} {which}"));
        }
    }
}

fn tangents<const N: usize>(system: &mut System<N>, found: &mut Found, step: usize) -> Result<(), Refused>
where
    Contact<N>: Create<N> + TakesLaw,
{
    let choice = system.scene.choice;
    let mut random = Random(29);
    let kinds = if choice.is_condensed() { 1 } else { 2 };
    for kind in 0..kinds {
        let direction = Direction::random(system.scene, &mut random, kind == 1);
        let exact = system.derivative(&direction)?;
        if !is_exact(&choice) {
            continue;
        }
        let what = format!("step {step}: the tangent by {}", ["positions", "multipliers"][kind]);
        compare(found, &what, &exact, |h| system.value(&direction, h))?;
    }
    if choice.is("system", "inplace") {
        let (off, largest) = system.in_place()?;
        if !(off <= IN_PLACE * largest) {
            found.wrong(format!("step {step}: in place off by {off:.1e} of {largest:.1e}"));
        }
    }
    Ok(())
}

/// Temperatures as functions of their node, so that parts have those of the whole.
fn heat<const N: usize>(scene: &Scene, handles: &mut Handles<N>, at: &At<N>, found: &mut Found) -> Result<(), Refused>
where
    Contact<N>: Create<N> + TakesLaw,
{
    let (n1, n2) = (at.x1.len(), at.x2.len());
    let (first, n) = (3 * (n1 + n2) + N * n1, 3 * (n1 + n2) + N * n1 + n1 + n2);
    let t0: Vec<f64> = (0..n1 + n2).map(|k| if k < n1 { 22.0 } else { 2.5 } + (1.7 * k as f64).sin()).collect();
    let mut random = Random(31);
    let with_motion = scene.choice.is("heat", "all");
    for kind in 0..if with_motion { 3 } else { 1 } {
        let direction =
            if kind == 0 { Direction::still(scene) } else { Direction::random(scene, &mut random, kind == 2) };
        let dt: Vec<f64> = t0.iter().map(|_| if kind == 0 { random.next() } else { 0.0 }).collect();
        let mut v = direction.numbers(scene, at);
        v.extend(&dt);
        let mut exact = vec![0.0; n];
        for (handle, kept) in handles.all.iter_mut().zip(&handles.mortar) {
            let t = [t0[..n1].to_vec(), kept.iter().map(|k| t0[n1 + k]).collect()];
            let t = Temperatures { sides: [&t[0], &t[1]], conductance: &CONDUCTANCE };
            let e1: Vec<i64> = (0..n1).map(|k| (first + k) as i64).collect();
            let e2: Vec<i64> = kept.iter().map(|k| (first + n1 + k) as i64).collect();
            let mut sink = |i: i64, j: i64, value: f64| exact[i as usize] += value * v[j as usize];
            let asked = if with_motion { Asked::HeatTangent } else { Asked::Heat };
            let flow = handle.heat([&at.x1, &of(kept, &at.x2)], &at.lambda, t);
            when(Asked::Heat, flow)?;
            let x2 = of(kept, &at.x2);
            when(asked, handle.heat_tangent([&at.x1, &x2], &at.lambda, t, ([&e1, &e2], with_motion), &mut sink))?;
        }
        if !is_exact(&scene.choice) {
            continue;
        }
        let what = format!("heat by {}", ["temperatures", "positions", "multipliers"][kind]);
        let exact = [exact[first..].to_vec()];
        compare(found, &what, &exact, |h| {
            let there = direction.moved(scene, at, h);
            let mut heat = vec![0.0; n1 + n2];
            for (handle, kept) in handles.all.iter_mut().zip(&handles.mortar) {
                let t = |k: usize| t0[k] + h * dt[k];
                let t: [Vec<f64>; 2] = [(0..n1).map(t).collect(), kept.iter().map(|k| t(n1 + k)).collect()];
                let t = Temperatures { sides: [&t[0], &t[1]], conductance: &CONDUCTANCE };
                let of = when(Asked::Heat, handle.heat([&there.x1, &of(kept, &there.x2)], &there.lambda, t))?;
                of.sides[0].iter().enumerate().for_each(|(k, q)| heat[k] += q);
                kept.iter().zip(&of.sides[1]).for_each(|(k, q)| heat[n1 + k] += q);
            }
            let states = when(Asked::Residual, handles.answers(&there))?;
            Ok::<_, Refused>((vec![heat], states.iter().map(|r| r.state as u8).collect()))
        })?;
    }
    Ok(())
}

/// Handles that are told what was committed have the residual of those that committed it.
fn restart<const N: usize>(
    scene: &Scene,
    handles: &mut Handles<N>,
    at: &At<N>,
    found: &mut Found,
) -> Result<(), Refused>
where
    Contact<N>: Create<N> + TakesLaw,
{
    let mut others = Handles::<N>::new(scene)?;
    for ((to, from), kept) in others.all.iter_mut().zip(&handles.all).zip(&handles.mortar) {
        let mut slip = from.history().slip.clone(); // none is kept without friction
        slip.resize(at.x1.len(), Vec3::zeros());
        when(Asked::SetCommitted, to.set_committed(&at.x1, &of(kept, &at.x2), &slip, 1))?;
        when(Asked::SetCommitted, to.set_law_states(from.law_states()))?;
    }
    let next = scene.at::<N>(1);
    let (one, two) = (when(Asked::Residual, handles.residual(&next))?, when(Asked::Residual, others.residual(&next))?);
    let off = max_abs(one.iter().zip(&two).map(|(a, b)| a - b)) / max_abs(one.iter().copied()).max(NOTHING);
    if !(off <= RESTARTED) {
        found.wrong(format!("after set_committed the residual is off by {off:.1e}"));
    }
    Ok(())
}
