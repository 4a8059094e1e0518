//! nu of now (docs/formulation 11): the averaged normals of the non-mortar surface where it is, in place of those of t_n.

use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::options::Normals;
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::are_same;
use crate::interface::pairing::given::{NormalsAt, Step};
use crate::memory::{self, Store};
use crate::normal::nodal_normal;

/// Puts nu at `x1` in place for the evaluation that follows; nothing where the normals are those of t_n.
pub fn follow<const N: usize>(setup: &Setup<N>, step: &mut Step, x1: &[Vec3]) -> Result<()> {
    let committed = step.normals == Normals::Committed && !setup.options.conserves();
    if !setup.options.follows_normals() || committed {
        step.forget_normals();
        return Ok(());
    }
    if step.now.as_ref().is_some_and(|now| are_same(&now.x1, x1)) {
        return Ok(());
    }
    // Also where they are refused.
    let mut now = step.now.take().unwrap_or_else(|| std::mem::take(&mut step.room));
    match find(setup, step, x1, &mut now) {
        Ok(()) => step.now = Some(now),
        Err(error) => {
            step.room = now;
            return Err(error);
        }
    }
    Ok(())
}

/// nu at `x1`, whichever normals evaluations use.
pub fn at<const N: usize>(setup: &Setup<N>, step: &Step, x1: &[Vec3]) -> Result<NormalsAt> {
    let mut now = NormalsAt::default();
    find(setup, step, x1, &mut now)?;
    Ok(now)
}

fn find<const N: usize>(setup: &Setup<N>, step: &Step, x1: &[Vec3], now: &mut NormalsAt) -> Result<()> {
    setup.nonmortar.add_normals(x1, &mut now.sums)?;
    memory::recopy(&mut now.x1, x1)?;
    now.nu.clear();
    memory::grow(&mut now.nu, now.sums.len())?;
    for (a, sum) in now.sums.iter().enumerate() {
        let kept = step.pairing.keeps_normal.get(a).is_some_and(|kept| *kept);
        now.nu.store(if kept { step.committed_normal(a) } else { nodal_normal(*sum, a)? })?;
    }
    Ok(())
}
