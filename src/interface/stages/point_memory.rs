//! What the points of a step remember as it begins, where weights are made anew at a commit (docs/formulation 16.9): the tractions of the
//! points of the step before, carried to other points of the same facets,
//!
//! t(x) = t_q + sum_A Theta_A (N_A(x) - N_A(x_q)),   q the point next to x, Theta the facet's own field that is nearest to t
//! z(x) = S P' (t(x) - sum_A N_A T'_A lambda_A)
//!
//! with P', T' of the new planes and normals, and S the turn of the facet about its normal. At the same points t(x) is t_q in every bit; a
//! traction that is of the field sum_A N_A Theta_A is carried exactly to any points.

use super::point_friction::in_plane;
use crate::dual::Mass;
use crate::error::{Error, Kind, Result};
use crate::geometry::{Spin, Vec3};
use crate::interface::data::multiplier;
use crate::interface::data::point_friction::REALS_PER_POINT;
use crate::interface::data::points::{PointFacet, Points};
use crate::interface::pairing::given::Given;
use crate::law::Projected;
use crate::memory::{self, Store};
use crate::mortar::OverlapPoint;
use crate::shape::MAX_CORNERS;
use nalgebra::SVector;

/// The tractions of a facet's points in the step before.
struct Tractions<'a> {
    points: &'a [OverlapPoint],
    answers: &'a [Projected],
    /// Theta, by the facet's nodes; 0 where its points do not determine one.
    field: [Vec3; MAX_CORNERS],
}

impl<'a> Tractions<'a> {
    /// Of a facet of that step; `None`: it had no points.
    fn of(old: &PointFacet, before: &'a Points) -> Option<Tractions<'a>> {
        let (points, answers) = before.friction.answered(old.places());
        let (mut mass, mut force) = ([[0.0; MAX_CORNERS]; MAX_CORNERS], [[0.0; MAX_CORNERS]; 3]);
        for (point, answer) in points.iter().zip(answers) {
            for a in 0..MAX_CORNERS {
                let share = point.weight * point.own[a];
                (0..MAX_CORNERS).for_each(|b| mass[a][b] += share * point.own[b]);
                (0..3).for_each(|i| force[i][a] += share * answer.traction[i]);
            }
        }
        let mut field = [Vec3::zeros(); MAX_CORNERS];
        // A sliver determines no field: its points are carried as they are.
        if let Ok(mass) = Mass::new(old.n, &mass) {
            let solved = force.map(|f| mass.solve(&f));
            field = std::array::from_fn(|a| Vec3::from_fn(|i, _| solved[i][a]));
        }
        (!points.is_empty()).then_some(Tractions { points, answers, field })
    }

    /// At the point where the facet's functions are these. `guess`: which of the points it may be.
    fn at(&self, own: &[f64; MAX_CORNERS], guess: usize) -> Vec3 {
        let apart = |q: usize| -> f64 { self.points[q].own.iter().zip(own).map(|(m, n)| (n - m) * (n - m)).sum() };
        let mut next = (guess.min(self.points.len() - 1), f64::INFINITY);
        next.1 = apart(next.0);
        if next.1 > 0.0 {
            for q in 0..self.points.len() {
                let distance = apart(q);
                if distance < next.1 {
                    next = (q, distance);
                }
            }
        }
        let (point, answer) = (&self.points[next.0], &self.answers[next.0]);
        let moved = self.field.iter().zip(own.iter().zip(&point.own)).map(|(theta, (n, m))| theta * (n - m));
        moved.fold(answer.traction, |t, d| t + d)
    }
}

impl Points {
    /// The facet with this number; `None`: it has no pairs.
    fn facet(&self, one: usize) -> Option<&PointFacet> {
        self.facets.binary_search_by_key(&one, |facet| facet.one).ok().map(|k| &self.facets[k])
    }

    /// z of the points of a step that begins with these multipliers after the step `before`, at whose start the non-mortar nodes were at
    /// `x1`. These points become those of the new step.
    pub fn remember<const N: usize>(
        &mut self,
        given: Given<N>,
        lambda: &[SVector<f64, N>],
        (before, x1): (&Points, &[Vec3]),
    ) -> Result<Vec<f64>> {
        let (one, now) = (&given.setup.nonmortar, &given.history().x1);
        let mut z = memory::with_room(REALS_PER_POINT * self.count(given)?)?;
        let mut along = memory::with_room(lambda.len())?;
        for (a, lambda) in lambda.iter().enumerate() {
            let (normal, free) = (given.normal(a)?, given.setup.nodes.free[a]);
            along.store((free - normal * normal.transpose()) * multiplier::traction(lambda, normal))?;
        }
        for facet in &self.facets {
            let facet_before = before.facet(facet.one);
            let old = facet_before.and_then(|of| Tractions::of(of, before));
            let mut places = [[Vec3::zeros(); MAX_CORNERS]; 2];
            let nodes = one.facets[facet.one].as_slice();
            for (k, &a) in nodes.iter().enumerate() {
                (places[0][k], places[1][k]) = (x1[a], now[a]);
            }
            let [old_places, new_places] = [&places[0][..nodes.len()], &places[1][..nodes.len()]];
            let turned_from = facet_before.map_or(facet.normal, |of| of.normal);
            let spin = Spin::of(old_places, turned_from, new_places, facet.normal);
            let points = facet.places().flat_map(|place| self.friction.of_pair(place));
            for (k, point) in points.map(|q| &self.friction.points[q]).enumerate() {
                let traction = old.as_ref().map_or_else(Vec3::zeros, |old| old.at(&point.own, k));
                let field: Vec3 = facet.nodes().iter().zip(&point.own).map(|(&a, n)| along[a] * *n).sum();
                let left = spin.turn(in_plane(traction - field, facet.normal));
                z.store_all(left.iter().copied())?;
            }
        }
        Ok(z)
    }

    /// Refuses a history that remembers something else than these points, or whose pairs have none.
    pub fn check_memory<const N: usize>(&mut self, given: Given<N>) -> Result<()> {
        let no_points = |e: Error| match e.kind {
            Kind::OutOfMemory => e,
            _ => Error::new(Kind::HistoryMismatch, text!("the history's pairs have no points: {}", e.message)),
        };
        let (known, needed) = (given.history().states.len(), REALS_PER_POINT * self.count(given).map_err(no_points)?);
        if known == needed {
            return Ok(());
        }
        let text = text!(
            "the history remembers {known} numbers of points; the points of its {} pairs have {needed}",
            given.history().weighted(given.setup.surfaces()).len()
        );
        Err(Error::new(Kind::HistoryMismatch, text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::data::point_friction::PointFriction;

    /// Rounding of a solution with a matrix of condition 100.
    const ROUNDING: f64 = 1e-13;

    fn point(s: f64, t: f64) -> OverlapPoint {
        let own = [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
        OverlapPoint { weight: 0.02 + 0.01 * s, own, ..OverlapPoint::default() }
    }

    fn facet() -> PointFacet {
        let (nodes, none) = ([0, 1, 2, 3], [[0.0; MAX_CORNERS]; MAX_CORNERS]);
        let (mass, stabilisation, normal) = (none, none, Vec3::z());
        PointFacet { one: 5, pairs: [0, 1], nodes, n: 4, normal, fade: 1.0, mass, stabilisation }
    }

    /// Points along rows of a part of a facet, with these tractions.
    fn points(tractions: &dyn Fn(f64, f64) -> Vec3, ends: [f64; 2]) -> Points {
        let mut friction = PointFriction::default();
        for (i, j) in (0..4).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let (s, t) = (ends[0] + (ends[1] - ends[0]) * (0.1 + 0.25 * i as f64), 0.2 + 0.3 * j as f64);
            friction.points.push(point(s, t));
            friction.answers.push(Projected { traction: tractions(s, t), ..Projected::gap() });
        }
        friction.ends = vec![friction.points.len()];
        Points { facets: vec![facet()], friction, ..Points::default() }
    }

    #[test]
    fn what_is_of_the_facets_field_is_carried_exactly_and_points_at_rest_keep_their_bits() {
        let field = |s: f64, t: f64| Vec3::new(1.0 - 2.0 * s + s * t, 0.3 * t, -1.0 + s);
        let kinked = |s: f64, t: f64| field(s, t) + Vec3::new((s - 0.4).max(0.0), 0.0, 0.0);
        let whole = points(&field, [0.0, 1.0]);
        let carried = Tractions::of(&facet(), &whole).unwrap();
        for (s, t) in [(0.0, 0.0), (0.5, 0.9), (0.83, 0.41), (1.0, 1.0)] {
            assert!((carried.at(&point(s, t).own, 3) - field(s, t)).amax() <= ROUNDING, "{s} {t}");
        }
        let kinks = points(&kinked, [0.0, 1.0]);
        let carried = Tractions::of(&facet(), &kinks).unwrap();
        for (k, (point, answer)) in kinks.friction.points.iter().zip(&kinks.friction.answers).enumerate() {
            assert_eq!(carried.at(&point.own, k), answer.traction);
            assert_eq!(carried.at(&point.own, 0), answer.traction, "it is found, too, where it is not guessed");
        }
        assert!(whole.facet(5).is_some() && whole.facet(6).is_none(), "facet 6 has no points");
    }

    /// Three columns of points of a strip whose width is rounding determine no field: the next point's traction is taken.
    #[test]
    fn a_sliver_is_carried_as_it_is() {
        let narrow = points(&|s, t| Vec3::new(s, t, 1.0), [0.5, 0.5]);
        let carried = Tractions::of(&facet(), &narrow).unwrap();
        assert_eq!(carried.at(&point(0.9, 0.2).own, 0), Vec3::new(0.5, 0.2, 1.0));
    }
}
