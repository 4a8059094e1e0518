//! Derivatives by the positions of t_n against handles that are told other ones.

use super::check::{Found, compare};
use super::choice::Asked;
use super::handles::{Handles, Refused, TakesLaw, of, when};
use super::scene::{At, Scene};
use super::system::Direction;
use crate::support::mesh::{Create, Random};
use stickslip::geometry::Vec3;
use stickslip::interface::Contact;

/// `at` was committed last.
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
        when(Asked::Previous, handle.previous_tangent([&next.x1, &of(kept, &next.x2)], &next.lambda, &mut sink))?;
    }
    let moves = scene.mortar_moves();
    // Forces where there are equations, and rows.
    let grouped = |r: &[f64]| vec![r[..if moves { n } else { 3 * at.x1.len() }].to_vec(), r[n..].to_vec()];
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
