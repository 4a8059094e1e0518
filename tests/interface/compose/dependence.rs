//! Derivatives by what is no unknown against handles that are told other positions of t_n, other offsets and other friction.

use super::check::{Found, compare};
use super::choice::Asked;
use super::handles::{Handles, Refused, TakesLaw, of, offsets, when};
use super::scene::{At, Scene};
use super::system::Direction;
use crate::support::mesh::{Create, Random};
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Wanted};

/// By positions. `at` was committed last.
pub fn by_previous_positions<const N: usize>(
    scene: &Scene,
    handles: &mut Handles<N>,
    at: &At<N>,
    found: &mut Found,
) -> Result<(), Refused>
where
    Contact<N>: Create<N> + TakesLaw,
{
    let (next, n) = (scene.at::<N>(1), 3 * (at.x1.len() + at.x2.len()));
    let direction = Direction::random(scene, &mut Random(37), false);
    let v = direction.numbers(scene, at);
    let mut exact = vec![0.0; n + N * at.x1.len()];
    for (handle, kept) in handles.all.iter_mut().zip(&handles.mortar) {
        let mut sink = |i: i64, j: i64, value: f64| exact[i as usize] += value * v[j as usize];
        when(Asked::Derivatives, handle.previous_tangent([&next.x1, &of(kept, &next.x2)], &next.lambda, &mut sink))?;
    }
    // Forces where there are equations, and rows.
    let forces = if scene.mortar_moves() { n } else { 3 * at.x1.len() };
    let grouped = |r: &[f64]| vec![r[..forces].to_vec(), r[n..].to_vec()];
    let mut others = Handles::<N>::new(scene)?;
    compare(found, "by positions of t_n", &grouped(&exact), |h| {
        let before = direction.moved(scene, at, h);
        for ((to, from), kept) in others.all.iter_mut().zip(&handles.all).zip(&handles.mortar) {
            let mut slip = from.history().slip.clone(); // none is kept without friction
            slip.resize(at.x1.len(), Vec3::zeros());
            when(Asked::SetCommitted, to.set_committed(&before.x1, &of(kept, &before.x2), &slip, 1))?;
        }
        let states = when(Asked::Residual, others.answers(&next))?;
        let r = when(Asked::Residual, others.residual(&next))?;
        Ok((grouped(&r), states.iter().map(|r| r.state as u8).collect()))
    })
}

/// By offsets of the sides that may have some, and by friction where it is given. `at` was committed last.
pub fn by_parameters<const N: usize>(
    scene: &Scene,
    handles: &mut Handles<N>,
    at: &At<N>,
    found: &mut Found,
) -> Result<(), Refused>
where
    Contact<N>: Create<N> + TakesLaw,
{
    let (c, next, n1, n2) = (&scene.choice, scene.at::<N>(1), at.x1.len(), at.x2.len());
    let mut random = Random(41);
    let mut some = |is_there: bool, n: usize| (0..n).map(|_| if is_there { random.next() } else { 0.0 }).collect();
    let has_mu = scene.options().mu > 0.0;
    let (v1, v2, v_mu): (Vec<f64>, Vec<f64>, Vec<f64>) = (some(true, n1), some(!c.is_analytic(), n2), some(has_mu, n1));
    let wanted = Wanted { previous: false, parameters: true };
    let mut exact = vec![0.0; N * n1];
    for (handle, kept) in handles.all.iter_mut().zip(&handles.mortar) {
        let layout = handle.layout();
        let mut along = vec![0.0; layout.arguments()];
        along[layout.offsets(0)].copy_from_slice(&v1);
        along[layout.offsets(1)].copy_from_slice(&kept.iter().map(|&k| v2[k]).collect::<Vec<_>>());
        along[layout.friction()].copy_from_slice(&v_mu);
        let x2 = of(kept, &next.x2);
        let change = handle.sensitivity([&next.x1, &x2], &next.lambda, &along, (wanted, [false; 2]));
        let change = when(Asked::Derivatives, change)?;
        exact.iter_mut().zip(&change[layout.rows()]).for_each(|(sum, change)| *sum += change);
    }
    let mut others = Handles::<N>::new(scene)?;
    compare(found, "by parameters", &[exact], |h| {
        for ((to, from), kept) in others.all.iter_mut().zip(&handles.all).zip(&handles.mortar) {
            let [one, two] = offsets(c, n1, kept);
            let by = |o: Option<Vec<f64>>, v: Vec<f64>| {
                let o = o.unwrap_or_else(|| vec![0.0; v.len()]);
                Some(o.iter().zip(&v).map(|(o, v)| o + h * v).collect())
            };
            let two = if c.is_analytic() { None } else { by(two, kept.iter().map(|&k| v2[k]).collect()) };
            when(Asked::Offsets, to.set_offsets([by(one, v1.clone()), two]))?;
            if has_mu {
                let mu = scene.options().mu;
                when(Asked::Law, to.take_friction(v_mu.iter().map(|v| mu + h * v).collect()))?;
            }
            let mut slip = from.history().slip.clone();
            slip.resize(n1, Vec3::zeros());
            when(Asked::SetCommitted, to.set_committed(&at.x1, &of(kept, &at.x2), &slip, 1))?;
        }
        let states = when(Asked::Residual, others.answers(&next))?;
        let r = when(Asked::Residual, others.residual(&next))?;
        Ok((vec![r[3 * (n1 + n2)..].to_vec()], states.iter().map(|r| r.state as u8).collect()))
    })
}
