//! What nodes do with conserving weights (docs/formulation 21). With the mean gap g_A(x) = nu_A . g[n, x]_A / m_A over what is covered,
//! m_A, its gradient G_A, the mean places x_m and what moves in the step, u:
//!
//! - D_A = m_A(x_m) G_A(x_m) + q z,   q = (m_A(x_m) (g_A(x') - g_A(x_n)) - m_A G_A(x_m) . u) / z . z
//! - g_A(x') >= e_A,   e_A = min(0, g_A(x_n)),   forces lambda_N D_A
//! - friction: weights and normals of x_m, slip P_m g[n_m, u], forces n_m lambda_T
//!
//! z is u at the nodes that g_A depends on, less its rigid motion, so that it has no resultant and no moment.

use super::residual::Residual;
use super::sums::NodeSums;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::data::conserving::{Conserving, Dependence, NodeForce, NodeGap, Rigid};
use crate::interface::data::multiplier;
use crate::interface::pairing::given::Given;
use crate::law::NodeResponse;
use crate::memory::{self, Store};
use nalgebra::SVector;

/// Motions below this times a node's size leave q out: it would be a quotient of roundings, and q z is of the second order in them.
const STILL: f64 = 1e-6;

/// Points of a frame that shift by the same do so but for roundings of their places.
const TURNED: f64 = 1e-14;

/// The places half way between those of t_n and these.
pub fn mean_places(before: &[Vec3], now: &[Vec3], mean: &mut Vec<Vec3>) -> Result<()> {
    mean.clear();
    mean.store_all(before.iter().zip(now).map(|(a, b)| (a + b) * 0.5))
}

/// The mean gap at t_n, where anything was covered.
pub fn gap_before<const N: usize>(given: Given<N>, a: usize) -> Result<Option<f64>> {
    let (history, normal) = (given.history(), given.normal_of_step(a)?);
    let area = history.coverage[a];
    Ok(history.gap.get(a).filter(|_| area > 0.0).map(|gap| normal.dot(gap) / area))
}

/// By what an analytic mortar side has shifted in the step: nodes move against it.
fn frame_shift<const N: usize>(given: Given<N>, x2: &[Vec3]) -> Result<Vec3> {
    let (mortar, before) = (&given.setup.mortar, &given.history().x2);
    if mortar.analytic.is_none() {
        return Ok(Vec3::zeros());
    }
    let nodes = mortar.facets[0].as_slice();
    let shift = x2[nodes[0]] - before[nodes[0]];
    let size = nodes.iter().map(|&k| x2[k].norm() + before[k].norm()).fold(0.0, f64::max);
    if nodes.iter().any(|&k| (x2[k] - before[k] - shift).norm() > TURNED * size) {
        let text = "the analytic mortar side turns within a step: what it works with conserving weights (STICKSLIP_WEIGHTS_CONSERVING) is not built; mesh its surface, or take other weights";
        return Err(Error::new(Kind::Unsupported, text));
    }
    Ok(shift)
}

/// Puts in place what the nodes do, of their gaps at the end and half way.
pub fn settle<const N: usize>(given: Given<N>, (x1, x2): (&[Vec3], &[Vec3]), known: &mut Conserving) -> Result<()> {
    let (history, rigid) = (given.history(), Rigid::of(given.setup.surfaces()));
    let shift = frame_shift(given, x2)?;
    let n1 = x1.len();
    let moved = |node: usize| match node.checked_sub(n1) {
        None => (x1[node] - history.x1[node] - shift, (x1[node] + history.x1[node]) * 0.5),
        Some(c) => (x2[c] - history.x2[c] - shift, (x2[c] + history.x2[c]) * 0.5),
    };
    known.forces.truncate(n1);
    while known.forces.len() < n1 {
        known.forces.store(NodeForce::default())?;
    }
    let [now, mean] = &known.gaps;
    for (a, force) in known.forces.iter_mut().enumerate() {
        let before = gap_before(given, a)?;
        force.bound = before.map_or(0.0, |gap| gap.min(0.0));
        force.above = now[a].normal.dot(&now[a].gap) - force.bound * now[a].coverage;
        force.take(rigid, &mean[a], moved)?;
        let still = STILL * given.size(a);
        let change = before.filter(|_| now[a].coverage > 0.0).map(|gap| now[a].mean() - gap);
        force.change = change.unwrap_or(0.0);
        let first: f64 = force.force.iter().zip(&force.moved).map(|(g, u)| g.dot(u)).sum();
        force.size = force.along.iter().map(Vec3::norm_squared).sum();
        if force.size <= still * still || change.is_none() {
            (force.size, force.quotient) = (0.0, 0.0);
            continue;
        }
        force.quotient = (mean[a].coverage * force.change - first) / force.size;
        force.force.iter_mut().zip(&force.along).for_each(|(d, z)| *d += z * force.quotient);
    }
    Ok(())
}

impl NodeForce {
    /// Takes the gradient half way, the motion of the nodes that it is of, and what is left of that beside its rigid part.
    fn take(&mut self, rigid: Rigid, mean: &NodeGap, moved: impl Fn(usize) -> (Vec3, Vec3)) -> Result<()> {
        let NodeForce { force, along, moved: motion, arms, .. } = self;
        [&mut *force, &mut *along, &mut *motion, &mut *arms].into_iter().for_each(Vec::clear);
        for on in &mean.nodes {
            let (u, x) = moved(on.node);
            force.store(mean.slope(on, mean.mean()))?;
            motion.store(u)?;
            arms.store(x)?;
        }
        let count = arms.len().max(1) as f64;
        let centre = arms.iter().sum::<Vec3>() / count;
        arms.iter_mut().for_each(|x| *x -= centre);
        self.inverse = rigid.inverse_inertia(arms.iter().copied());
        self.spin = self.inverse * arms.iter().zip(&*motion).map(|(r, u)| r.cross(u)).sum::<Vec3>();
        let shift = rigid.translations() * motion.iter().sum::<Vec3>() / count;
        let rest = |(u, r): (&Vec3, &Vec3)| u - shift - self.spin.cross(r);
        along.store_all(motion.iter().zip(&*arms).map(rest))
    }
}

/// What the law is asked with: gaps above the bound along nu_m, and what slips with the weights of x_m. A node that is not covered half way
/// has no force, and is open.
pub fn sums(known: &Conserving, sums: &mut Vec<NodeSums>) -> Result<()> {
    let [now, mean] = &known.gaps;
    sums.clear();
    memory::grow(sums, mean.len())?;
    for ((now, mean), force) in now.iter().zip(mean).zip(&known.forces) {
        let slip = mean.nodes.iter().zip(&force.moved).map(|(on, u)| u * on.weight).sum();
        let coverage = if mean.coverage > 0.0 { now.coverage.min(mean.coverage) } else { 0.0 };
        sums.store(NodeSums {
            coverage,
            gap_now: mean.normal * force.above,
            coverage_previous: if coverage > 0.0 { mean.coverage } else { 0.0 },
            gap_previous: slip,
            gap_committed: Vec3::zeros(),
        })?;
    }
    Ok(())
}

/// What is told is where the surfaces are.
pub fn tell<const N: usize>(known: &Conserving, responses: &mut [NodeResponse<N>]) {
    let of = known.gaps[0].iter().zip(&known.forces);
    responses.iter_mut().zip(of).for_each(|(to, (now, force))| to.gap_normal += force.bound * now.coverage);
}

/// Forces and rows at the law's answers, in place of what was in `r`.
pub fn residual<const N: usize>(
    given: Given<N>,
    known: &Conserving,
    lambda: &[SVector<f64, N>],
    responses: &[NodeResponse<N>],
    r: &mut Residual<N>,
) -> Result<()> {
    r.clear(given.setup.surfaces())?;
    let [_, mean] = &known.gaps;
    for (a, (mean, force)) in mean.iter().zip(&known.forces).enumerate().filter(|(a, _)| given.setup.nodes.acts(*a)) {
        let (normal, tangential) = parts(&lambda[a], mean.normal);
        // A surface in closed form has what is left of the sum, point by point as its weights are.
        let opposite = given.setup.mortar.analytic.map(|_| {
            let of_frame = |on: &&Dependence| on.node >= r.nonmortar.len();
            let sum: f64 = mean.nodes.iter().filter(of_frame).map(|on| on.weight).sum();
            -force.force.iter().sum::<Vec3>() / if sum == 0.0 { 1.0 } else { sum }
        });
        for (on, d) in mean.nodes.iter().zip(&force.force) {
            let d = opposite.filter(|_| on.node >= r.nonmortar.len()).map_or(*d, |sum| sum * on.weight);
            let f = d * normal + tangential * on.weight;
            match on.node.checked_sub(r.nonmortar.len()) {
                None => r.nonmortar[on.node] += f,
                Some(c) => r.mortar[c] += f,
            }
        }
    }
    r.take_rows(given, responses);
    Ok(())
}

/// lambda_N, and lambda_T.
pub fn parts<const N: usize>(lambda: &SVector<f64, N>, normal: Vec3) -> (f64, Vec3) {
    let traction = multiplier::traction(lambda, normal);
    let along = if N == 1 { lambda[0] } else { normal.dot(&traction) };
    (along, if N == 1 { Vec3::zeros() } else { traction - normal * along })
}
