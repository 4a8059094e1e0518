//! How far a point (x, lambda) is from contact equilibrium: the largest violations over the nodes, each beside the scale
//! that it should be compared with. What the multiplier rows cannot say, for they go with augmentation and row scale.
//!
//! A gap of size g in a facet of size h is a strain g / h, and a traction E g / h. So with a modulus E a length counts
//! against h p / E, p the largest traction: a violation of a 1e-9th of that changes tractions by 1e-9 p. Without a
//! modulus it counts against h. Positions are rounded: what their last digits make of a gap does not count, nor what
//! that makes of a traction.
//!
//! Frozen weights may belong to a point no more that is in equilibrium with them: how far surfaces have slid or turned since they were made
//! is told beside it. Where a surface has turned by theta since weights of the reference were made, a pressure p goes on acting along its
//! first normal: p sin(theta) acts along the surface as it is now, a shear that no friction has allowed, and p (1 - cos(theta)) is missing.
//! Where points slip with weights of t_n it is so, too, of the turn since then: what friction has allowed is off by theta / mu of itself.
//! Both sides turning together makes no difference. Offsets of tied surfaces act along the first normals, whatever the weights.
//!
//! With normals of t_n a traction acts along those although the surface has turned: what the law would not allow of it if it had turned with
//! the surface is the lag. What weighted gaps do not see of the real ones: `overlap.rs`.

use super::largest::{Largest, Scales};
use super::overlap;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::data::extent::Scope;
use crate::interface::data::options::Weights;
use crate::interface::pairing::given::Given;
use crate::interface::pairing::nearest::look;
use crate::interface::pairing::work::Work;
use crate::interface::stages::carried::{carriers_sums, multiplier_share};
use crate::interface::stages::node::{is_left_out, node};
use crate::interface::stages::own::{At, layer_answer, special};
use crate::interface::stages::sums::NodeSums;
use crate::law::{Measure, NodeResponse, State, Violation};
use crate::memory;
use crate::normal;
use nalgebra::SVector;

/// How many roundings of the largest coordinate may meet in a gap or a slip: a difference of two sums over some nodes,
/// each of which was rounded when it was moved.
pub const ROUNDINGS: f64 = 8.0;

/// A node presses where its traction is more than this part of the largest one.
const PRESSES: f64 = 0.01;
/// And more than this part of the modulus: rounding.
const NOTHING: f64 = 1e-12;
/// What a slipping node's traction is wrong by is judged beside friction where that is more than this part of the traction, else beside all
/// of it: torques of shafts are friction's.
const FRICTION: f64 = 0.1;
/// Gaps up to this part of a facet touched: where points decide a node's is a mean over parts that are open.
const TOUCHING: f64 = 0.01;

/// The distance from equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Equilibrium {
    /// Of gaps `[L]`: penetration, opening under pressure; tied surfaces along the normal.
    pub gap: Largest,
    /// Of tractions [F/L^2]: see [`Violation::traction`].
    pub traction: Largest,
    /// Of slips `[L]`: where a node sticks; against or across the traction; tied surfaces along the surface.
    pub slip: Largest,
    /// No violation: how far apart along the surface a traction acts on the two sides, where weights are frozen `[L]`.
    pub slide: Largest,
    /// No violation: the angle by which the surface has turned where weights are of the reference, and since t_n where points slip,
    /// by the part that the traction there is of the largest one; over 1.
    pub turn: Largest,
    /// Of tractions, too, by the normals of now, where those of t_n are in use [F/L^2].
    pub lag: Largest,
    /// The same over all nodes: sums of the traction times the area, and of what it should be compared with `[F]`.
    pub lag_force: [f64; 2],
    /// No violation of weighted gaps: the real overlap at a point `[L]`.
    pub penetration: Largest,
    /// The same: how far apart the surfaces really are where a node presses `[L]`.
    pub apart: Largest,
}

impl Equilibrium {
    /// Takes what is worse of another interface; `node`: the number that its nodes have here. Sums add up.
    pub fn take_worse(&mut self, other: &Equilibrium, node: &dyn Fn(usize) -> usize) {
        for (own, of_other) in [
            (&mut self.gap, &other.gap),
            (&mut self.traction, &other.traction),
            (&mut self.slip, &other.slip),
            (&mut self.slide, &other.slide),
            (&mut self.turn, &other.turn),
            (&mut self.lag, &other.lag),
            (&mut self.penetration, &other.penetration),
            (&mut self.apart, &other.apart),
        ] {
            own.take_worse(of_other, node);
        }
        self.lag_force.iter_mut().zip(other.lag_force).for_each(|(own, of_other)| *own += of_other);
    }
}

/// The distance of (x, lambda) from equilibrium. Nodes without any multiplier equation, and those whose
/// multiplier acts elsewhere, have no part in it.
pub fn equilibrium<const N: usize>(
    given: Given<N>,
    (x1, x2): (&[Vec3], &[Vec3]),
    lambda: &[SVector<f64, N>],
    (sums, carried, responses): (&[NodeSums], &[bool], &[NodeResponse<N>]),
    scope: Scope,
    (scales, work): (&Scales, &mut Work),
) -> Result<Equilibrium> {
    let turned = &mut work.room.vectors;
    let areas = &given.history().areas;
    let nodes = || (0..lambda.len()).filter(|&a| given.setup.has_multiplier(a) && given.setup.nodes.acts(a));
    // A sliver's multiplier is a point load: it counts by its force.
    let traction = |a: usize| lambda[a].norm() * (sums[a].coverage / areas[a]).min(1.0);
    let traction = nodes().map(traction).fold(scales.traction, f64::max);
    let position = x1.iter().chain(x2).map(|x| x.amax()).fold(0.0, f64::max);
    let rounding = ROUNDINGS * f64::EPSILON * position;
    let length_scale = |h: f64| match scales.modulus {
        0.0 => h,
        modulus => h * (traction / modulus),
    };
    let least = |size: &dyn Fn(usize) -> f64| {
        let least = nodes().map(size).fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 0.0 }
    };
    let none = Largest { value: 0.0, scale: length_scale(least(&|a| given.size(a))), node: None };
    let options = &given.setup.options;
    let may_slide = options.friction.law().opens && !matches!(options.weights, Weights::Current | Weights::Conserving);
    let rubs_at_points = given.setup.has_point_friction() && options.weights == Weights::Committed;
    let first_normals = given.setup.acts_along_first_normals();
    let may_turn = first_normals || rubs_at_points;
    // Of normals that the host gives it knows more.
    let may_lag = options.friction.law().opens
        && !first_normals
        && given.step.now.is_none()
        && given.setup.nodes.normals.is_none();
    if may_turn || may_lag {
        given.setup.nonmortar.add_normals(x1, turned)?;
    }
    let mut all = Equilibrium {
        gap: none,
        traction: Largest { scale: traction, ..none },
        slip: none,
        slide: Largest { scale: if may_slide { least(&|a| given.facet_size(a)) } else { 0.0 }, ..none },
        turn: Largest { scale: 1.0, ..none },
        lag: Largest { scale: traction, ..none },
        ..Equilibrium::default()
    };

    let shared =
        if carried.contains(&true) { carriers_sums(given, sums, carried, &given.normals()?)? } else { Vec::new() };
    let [mut states, mut of_layer] =
        [memory::filled(0.0, given.setup.states()[0])?, memory::filled(0.0, given.setup.states()[1])?];
    for a in nodes() {
        let sum = shared.binary_search_by_key(&a, |(b, _)| *b).map_or(&sums[a], |at| &shared[at].1);
        let h = given.size(a);
        let stiffness = if scales.modulus > 0.0 { scales.modulus } else { traction } / h;
        let share = (sum.coverage / areas[a]).min(1.0);
        let elastic = scales.modulus / h * rounding;
        let mut lag = 0.0;
        let measure = Measure {
            coverage: sum.coverage,
            coverage_previous: sum.coverage_previous,
            stiffness,
            rounding,
            traction_rounding: ROUNDINGS * f64::EPSILON * traction + elastic,
        };
        let v = if carried.get(a).is_some_and(|c| *c) {
            let own = given.carriers_of(a).iter();
            let theirs: SVector<f64, N> = own.map(|&(b, w)| multiplier_share(given, a) * lambda[b] * w).sum();
            Violation::uncovered((lambda[a] - theirs).norm(), &measure)
        } else if is_left_out(given, a, scope) || sum.coverage <= given.least_coverage(a) {
            Violation::uncovered(lambda[a].norm(), &measure)
        } else if given.setup.decides_at_points() {
            Violation::of_gap(responses[a].row.norm() / sum.coverage, &measure)
        } else {
            let measure = Measure { traction_rounding: measure.traction_rounding / share, ..measure };
            let mut node = node(given, a, lambda[a], sum)?;
            if let Some(layer) = &given.setup.layer {
                node = layer_answer((layer, given), a, (&node, sum), &mut of_layer).inner(&node);
            }
            if let Some(own) = &given.setup.own {
                node.special = special((own, given), a, (&node, sum), At::Multiplier, &mut states)?;
            }
            let violation = given.setup.effects.law.violation;
            let found = violation(&node, &measure);
            if N == 3
                && may_lag
                && let Some(now) = normal_of(turned, a)?
            {
                node.lambda = turned_back(&lambda[a], given.free_normal(a, now)?, node.normal);
                let v = violation(&node, &measure);
                lag = v.traction + stiffness * v.slip;
            }
            found
        };
        if may_lag {
            let nu = given.normal(a)?;
            // Without a law that knows directions all of the turn counts.
            if (N == 1 || given.setup.decides_at_points())
                && responses[a].state != State::Stick
                && let Some(now) = normal_of(turned, a)?
            {
                let turn = (given.free_normal(a, now)? - nu).norm();
                lag = (lambda[a].norm() * turn - measure.traction_rounding).max(0.0);
            }
            all.lag.offer(lag * share, traction, a);
            let (size, force) = (lambda[a].norm(), areas[a] * share);
            let friction = if N == 3 && responses[a].state == State::Slip { tangential(&lambda[a], &nu) } else { 0.0 };
            let counts = if friction > FRICTION * size { friction } else { size };
            (all.lag_force[0], all.lag_force[1]) = (all.lag_force[0] + force * lag, all.lag_force[1] + force * counts);
        }
        if ![v.gap, v.traction, v.slip].iter().all(|v| v.is_finite()) {
            let text = text!("the violation at non-mortar node {a} overflows: the inputs are out of range");
            return Err(Error::new(Kind::NotFinite, text));
        }
        all.gap.offer(v.gap, length_scale(h), a);
        all.traction.offer(v.traction, traction, a);
        all.slip.offer(v.slip, length_scale(h), a);
        if (may_slide || may_turn) && sum.coverage > given.least_coverage(a) && traction > 0.0 {
            let part = (lambda[a].norm() * share / traction).min(1.0);
            if may_slide {
                let (nu, facet) = (given.normal(a)?, given.facet_size(a));
                let slid = slid(&nu, sum);
                let part = if has_slid_open(&nu, sum, (slid, facet)) { 1.0 } else { part };
                all.slide.offer(slid * part, facet, a);
            }
            if may_turn
                && (!rubs_at_points || responses[a].state == State::Slip)
                && let Some(now) = normal_of(turned, a)?
            {
                all.turn.offer(normal::angle(&given.history().normals[a], &now) * part, 1.0, a);
            }
        }
    }
    if options.friction.law().opens && !scope.apart {
        look(given.setup.surfaces(), (x1, x2), work)?;
        let least = (PRESSES * traction).max(NOTHING * scales.modulus);
        let presses = |a: usize| {
            let acts = given.setup.has_multiplier(a) && given.setup.nodes.acts(a);
            // What a bond bears between surfaces that are apart does not press.
            let bears = given.setup.layer.is_some() && responses[a].state == State::Gap;
            acts && !bears && lambda[a].norm() * (sums[a].coverage / areas[a]).min(1.0) > least
        };
        // Weights of the reference do not know where the surfaces are.
        let knows = options.weights != Weights::Reference;
        // A node that another handle speaks for presses, too.
        let feels = |a: usize| knows && lambda[a].norm() > least;
        [all.penetration, all.apart] =
            overlap::largest(&given.setup.nonmortar, &work.room.seen, (&presses, &feels), rounding);
    }
    Ok(all)
}

/// nu of now, where the normals around the node have a mean.
fn normal_of(sums: &[Vec3], a: usize) -> Result<Option<Vec3>> {
    memory::if_accepted(normal::nodal_normal(sums[a], a))
}

/// What of a traction lies along the surface.
fn tangential<const N: usize>(lambda: &SVector<f64, N>, nu: &Vec3) -> f64 {
    let lambda = Vec3::from_fn(|k, _| lambda[k]);
    (lambda - nu * nu.dot(&lambda)).norm()
}

/// A traction as it is seen along `nu` where it acts at a node whose normal is `now`.
fn turned_back<const N: usize>(lambda: &SVector<f64, N>, now: Vec3, nu: Vec3) -> SVector<f64, N> {
    let back = normal::turned(Vec3::from_fn(|k, _| lambda[k]), now, nu);
    SVector::from_fn(|k, _| back[k])
}

/// Whether a node that touched at t_n has opened by less than it has slid: where surfaces are curved, frozen weights measure such a gap as
/// that of a chord, and what has opened may overlap.
#[inline(never)]
fn has_slid_open(normal: &Vec3, sum: &NodeSums, (slid, facet): (f64, f64)) -> bool {
    let (now, before) = (normal.dot(&sum.gap_now) / sum.coverage, normal.dot(&sum.gap_committed) / sum.coverage);
    now > 0.0 && now < slid && before.abs() <= TOUCHING * facet
}

/// How far apart along the surface a node's traction acts on the two sides `[L]`. Weights of now keep both forces on one line;
/// frozen ones leave the mortar side's where they were made, so that this is how far the node has slid since then.
#[inline(never)]
fn slid(normal: &Vec3, sum: &NodeSums) -> f64 {
    let apart = sum.gap_now / sum.coverage;
    (apart - normal.dot(&apart) * normal).norm()
}
