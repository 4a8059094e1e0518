//! nu of now (docs/formulation.md 11): the averaged normals of the non-mortar surface where it is, in place of those of t_n.

use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::options::Normals;
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::are_same;
use crate::interface::pairing::given::{NormalsAt, Step};
use crate::memory::{self, Stored};
use crate::normal::nodal_normal;

/// Puts nu at `x1` in place for the evaluation that follows; nothing where the normals are those of t_n.
pub fn follow<const N: usize>(setup: &Setup<N>, step: &mut Step, x1: &[Vec3]) -> Result<()> {
    if !setup.options.follows_normals() || step.normals == Normals::Committed {
        step.now = None;
        return Ok(());
    }
    if step.now.as_ref().is_some_and(|now| are_same(&now.x1, x1)) {
        return Ok(());
    }
    step.now = None; // also where they are refused
    step.now = Some(at(setup, step, x1)?);
    Ok(())
}

/// nu at `x1`, whichever normals evaluations use.
pub fn at<const N: usize>(setup: &Setup<N>, step: &Step, x1: &[Vec3]) -> Result<NormalsAt> {
    let sums = setup.nonmortar.sums_of_normals(x1)?;
    let kept = |a: usize| step.pairing.keeps_normal.get(a).is_some_and(|kept| *kept);
    let of = |a: usize| if kept(a) { Ok(step.history.normals[a]) } else { nodal_normal(sums[a], a) };
    let nu = (0..sums.len()).map(of).stored_if_ok()?;
    Ok(NormalsAt { x1: memory::copied(x1)?, sums, nu })
}
