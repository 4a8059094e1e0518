//! Stages 2 and 3 where points decide (docs/formulation 16); what they know of their facets with weights that are frozen (of now:
//! `points_now.rs`):
//!
//! sigma_A = lambda_A + rhat_A gh_A, gh_A = nu_A . g_A / D_A with dual weights;   t(x) = min(0, sum_A N_A(x) sigma_A)
//! f_B = int N_B t nu_e,   f_C = -int N_C t nu_e,   rhat_A c_A = int N_A t - sum_B (m_AB + (rhat_A / rhat^0_A) K_AB) lambda_B
//!
//! Facets whose nodes all have sigma < 0 are closed, those without any are open: their integrals are sums over weights that are
//! there. Only the others are visited point by point.

use super::own::OwnAnswers;
use super::part_weights::PartsAt;
use super::residual::Residual;
use super::sums::NodeSums;
use crate::dual::{Coverage, FacetSums};
use crate::error::Result;
use crate::geometry::{Plane, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::lines::{Lines, line};
use crate::interface::data::options::Decision;
use crate::interface::data::pairs::{PairRecord, ParentRecord, Weighted};
use crate::interface::data::parents::Parents;
use crate::interface::data::points::{Closed, OfNodes, PointFacet, PointPair, Points, add_mass};
use crate::interface::pairing::given::Given;
use crate::law::{NodeResponse, State};
use crate::line::{self, LineFacet, LineWeights, Measure};
use crate::memory::{self, Store};
use crate::mortar::{
    ClosedPart, MultiplierSpace, OverlapPoint, PairWeights, ParentWeights, Segment, each_point, each_surface_point,
};
use crate::points::{STIFFNESS, of_facet, of_line};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};
use nalgebra::SVector;

/// The sides' facets where both are of lines.
fn lines<const N: usize>(given: Given<'_, N>) -> Option<(&Parents, &Parents, &Lines)> {
    let (one, two) = given.setup.surfaces();
    Some((one.parents.as_ref()?, two.parents.as_ref()?, one.lines()?))
}

/// The lines of a pair at these positions.
pub fn line_pair<const N: usize>(
    given: Given<N>,
    x: (&[Vec3], &[Vec3]),
    (f, g): (usize, usize),
) -> Option<(LineFacet, LineFacet, Measure)> {
    let (one, two, lines) = lines(given)?;
    Some((line(&one.at(f, x.0)), line(&two.at(g, x.1)), lines.measure))
}

fn of_line_weights(weights: &LineWeights) -> PairWeights {
    let mut n = PairWeights::default();
    for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        (n.ab[a][b], n.ac[a][b]) = (weights.ab[a][b], weights.ac[a][b]);
    }
    n
}

/// Those of a line with two nodes and of another one, or of the points of a frame.
pub(super) fn of_parent_weights(weights: &ParentWeights) -> PairWeights {
    let first =
        |of: &[[f64; MAX_PARENT_NODES]; MAX_PARENT_NODES]| std::array::from_fn(|a| std::array::from_fn(|k| of[a][k]));
    PairWeights { ab: first(&weights.ab), ac: first(&weights.ac) }
}

fn scaled(weights: &PairWeights, by: f64) -> PairWeights {
    PairWeights { ab: weights.ab.map(|row| row.map(|n| by * n)), ac: weights.ac.map(|row| row.map(|n| by * n)) }
}

/// sum_A n_A. sigma_A.
#[inline]
fn times(n: &OfNodes, sigma: &[f64; MAX_CORNERS]) -> [f64; MAX_CORNERS] {
    let mut sum = [0.0; MAX_CORNERS];
    for a in 0..MAX_CORNERS {
        for k in 0..MAX_CORNERS {
            sum[k] += n[a][k] * sigma[a];
        }
    }
    sum
}

/// rhat^0_A = 0.9 E* / h_A [F/L^3].
fn stabilising<const N: usize>(given: Given<N>, a: usize) -> f64 {
    match given.setup.options.decision {
        Decision::Points(modulus) => STIFFNESS * modulus / given.size(a),
        Decision::Nodes => 0.0,
    }
}

impl Points {
    /// Finds what the step knows of its facets, once a step.
    pub(super) fn settle<const N: usize>(&mut self, given: Given<N>) -> Result<()> {
        if self.is_settled {
            return Ok(());
        }
        let (surfaces, x) = (given.setup.surfaces(), given.weighted_at());
        surfaces.0.plane_normals(x.0, &mut self.planes)?;
        self.facets.clear();
        self.pairs.clear();
        self.friction.clear();
        self.parts.clear();
        self.acts.clear();
        self.has_parts = surfaces.0.has_mid_nodes() || surfaces.1.has_mid_nodes();
        match given.history().weighted(surfaces) {
            Weighted::Facets(pairs) => {
                pairs.chunk_by(|p, q| p.one == q.one).try_for_each(|pairs| self.settle_facet(given, pairs))?;
            }
            Weighted::Parents(_) if self.has_parts => {
                let step: (&dyn Fn(usize) -> f64, bool) = (&|a| given.size(a), given.setup.has_point_friction());
                self.settle_parts(surfaces, &given.setup.options, x, step)?;
            }
            Weighted::Parents(pairs) => {
                pairs.chunk_by(|p, q| p.one == q.one).try_for_each(|pairs| self.settle_line(given, pairs))?;
            }
        }
        self.settle_factors(given)?;
        self.is_settled = true;
        Ok(())
    }

    /// rhat_A / rhat^0_A.
    #[inline(never)]
    pub(super) fn settle_factors<const N: usize>(&mut self, given: Given<N>) -> Result<()> {
        let factor = |a: usize| given.rhat(a) / stabilising(given, a);
        self.factors.clear();
        self.factors.store_all((0..given.nodes()).map(factor))?;
        self.rhat.clear();
        self.rhat.store_all((0..given.nodes()).map(|a| given.rhat(a)))
    }

    fn settle_facet<const N: usize>(&mut self, given: Given<N>, pairs: &[PairRecord]) -> Result<()> {
        let ((one, two), x, first) = (given.setup.surfaces(), given.weighted_at(), self.pairs.len());
        let f = pairs[0].one;
        let frame = one.frame(f, x.0, &self.planes)?;
        let mut sums = FacetSums::new(&frame);
        let rule = given.setup.options.rule;
        for pair in pairs {
            let whole = if two.analytic.is_some() {
                self.whole_over_surface(|to| each_surface_point(&frame, &two.analytic_at(x.1)?, rule, to))
                    .map_err(one.at(f))?
            } else {
                let segment = Segment::new(&frame, &two.facet(pair.two, x.1))?;
                if given.setup.has_point_friction() {
                    self.friction.keep(|to| segment.as_ref().map_or(Ok(()), |s| each_point(&frame, s, rule, to)))?;
                }
                let integrate = |s: &Segment| PairWeights::integrate(&frame, s, rule);
                segment.as_ref().map_or_else(PairWeights::default, integrate)
            };
            sums.add(&whole, &[0.0; MAX_CORNERS]);
            self.pairs.store(PointPair { two: pair.two, whole, dual: pair.weights, parts: [0; 2] })?;
        }
        let nodes = one.facets[f].as_slice();
        let sizes = std::array::from_fn(|k| nodes.get(k).map_or(0.0, |&a| given.size(a)));
        let stabilisation = of_facet(&frame, &sizes);
        self.store_facet((f, nodes), first, frame.plane.e, (sums.coverage(), sums.mass, stabilisation))
    }

    fn settle_line<const N: usize>(&mut self, given: Given<N>, pairs: &[ParentRecord]) -> Result<()> {
        let ((one, two), x, first, f) = (given.setup.surfaces(), given.weighted_at(), self.pairs.len(), pairs[0].one);
        let Some(parents) = &one.parents else { return Ok(()) };
        let mut mass = OfNodes::default();
        for pair in pairs {
            let whole = if two.analytic.is_some() {
                let (part, rule) = (parents.parts(f).start, given.setup.options.rule);
                let (frame, surface) = (one.frame(part, x.0, &self.planes)?, two.analytic_at(x.1)?);
                self.whole_over_surface(|to| {
                    parents.over_surface(part, (&frame, x.0), (&surface, rule), |pair, x| {
                        pair.each_point(x, &mut |point| to(point.overlap_point()))
                    })
                })
                .map_err(one.at(part))?
            } else {
                let Some((own, other, measure)) = line_pair(given, x, (f, pair.two)) else { continue };
                if given.setup.has_point_friction() {
                    self.friction.keep(|to| line::each_point(&own, &other, measure, to))?;
                }
                of_line_weights(&LineWeights::new(&own, &other, MultiplierSpace::Corner, measure))
            };
            add_mass(&mut mass, &whole);
            let dual = of_parent_weights(&pair.weights);
            self.pairs.store(PointPair { two: pair.two, whole, dual, parts: [0; 2] })?;
        }
        let area: f64 = parents.areas(f, x.0, parents.space)?.iter().take(MAX_PARENT_NODES).sum();
        let covered = mass.iter().flatten().sum::<f64>();
        let nodes = one.host_nodes(f);
        let length = (x.0[nodes[1]] - x.0[nodes[0]]).norm();
        let stabilisation = of_line(length, [given.size(nodes[0]), given.size(nodes[1])]);
        let normal = Plane::of(&one.facet(parents.parts(f).start, x.0))?.e;
        self.store_facet((f, nodes), first, normal, (Coverage::of(covered / area), mass, stabilisation))
    }

    /// The weights of a facet over an analytic surface, and its points, which are kept: those of its closed part are sums over them.
    fn whole_over_surface(
        &mut self,
        each: impl FnOnce(&mut dyn FnMut(OverlapPoint) -> Result<()>) -> Result<()>,
    ) -> Result<PairWeights> {
        let first = self.friction.points.len();
        self.friction.keep(each)?;
        Ok(PairWeights::negative(&self.friction.points[first..], &[-1.0; MAX_CORNERS]))
    }

    /// `outward`: out of the non-mortar body; `stabilisation`: over the covered area.
    pub(super) fn store_facet(
        &mut self,
        (one, own): (usize, &[usize]),
        first: usize,
        outward: Vec3,
        (coverage, mass, stabilisation): (Coverage, OfNodes, OfNodes),
    ) -> Result<()> {
        let mut nodes = [own[0]; MAX_CORNERS];
        nodes[..own.len()].copy_from_slice(own);
        let fade = coverage.fade;
        self.pairs[first..].iter_mut().for_each(|pair| pair.whole = scaled(&pair.whole, fade));
        self.friction.fade(first, fade);
        let covered = fade * mass.iter().flatten().sum::<f64>();
        self.facets.store(PointFacet {
            one,
            pairs: [first, self.pairs.len()],
            nodes,
            n: own.len(),
            normal: -outward,
            fade,
            mass: mass.map(|row| row.map(|m| fade * m)),
            stabilisation: stabilisation.map(|row| row.map(|k| covered * k)),
        })
    }

    /// What each facet is at the nodes' sigma, with the weights of the closed parts of those that are cut. `active`: with weights of
    /// now, whose points move, a closed part is a region of its own (docs/formulation 16.8).
    fn close<const N: usize>(&mut self, given: Given<N>, active: Option<&Active>) -> Result<()> {
        let Points { facets, pairs, planes, sigma, states, closed, friction, parts, closed_acts, .. } = self;
        let (x, planes) = match active {
            Some(active) => ((&active.x1[..], &active.x2[..]), &active.normals),
            None => (given.weighted_at(), &*planes),
        };
        states.clear();
        closed.clear();
        closed_acts.clear();
        memory::grow(states, facets.len())?;
        for facet in &*facets {
            let sigma = facet.of(sigma);
            let negative = sigma[..facet.n].iter().filter(|s| **s < 0.0).count();
            states.store(match negative {
                0 => Closed::Nothing,
                n if n == facet.n => Closed::All,
                _ => Closed::Part(closed.len()),
            })?;
            if negative == 0 || negative == facet.n {
                continue;
            }
            let of_pairs = &pairs[facet.places()];
            if self.has_parts {
                let (surfaces, rule) = (given.setup.surfaces(), given.setup.options.rule);
                for pair in of_pairs {
                    let at = PartsAt { surfaces, rule, x, planes };
                    let weights = Points::close_part(at, (facet, &sigma), (pair, parts))?;
                    closed.store(scaled(&weights.own, facet.fade))?;
                    closed_acts.store(weights.all)?;
                }
                continue;
            }
            if given.setup.mortar.analytic.is_some() {
                for place in facet.places() {
                    closed.store(PairWeights::negative(&friction.points[friction.of_pair(place)], &sigma))?;
                }
                continue;
            }
            if given.setup.has_parents() {
                for pair in of_pairs {
                    let close = |(own, other, measure): (LineFacet, LineFacet, Measure)| {
                        let (pair, field) = ((&own, &other, measure), [sigma[0], sigma[1]]);
                        let weights = match active {
                            Some(_) => LineWeights::closed_part(pair.0, pair.1, pair.2, field),
                            None => LineWeights::closed(pair.0, pair.1, pair.2, field),
                        };
                        scaled(&of_line_weights(&weights), facet.fade)
                    };
                    let found = line_pair(given, x, (facet.one, pair.two)).map_or_else(PairWeights::default, close);
                    closed.store(found)?;
                }
                continue;
            }
            let rule = given.setup.options.rule;
            let frame = given.setup.nonmortar.frame(facet.one, x.0, planes)?;
            for pair in of_pairs {
                let close = |s: Segment| {
                    let weights = match active {
                        Some(_) => ClosedPart::new(&frame, &s, &sigma).weights(),
                        None => PairWeights::closed(&frame, &s, rule, &sigma),
                    };
                    scaled(&weights, facet.fade)
                };
                let segment = Segment::new(&frame, &given.setup.mortar.facet(pair.two, x.1))?;
                closed.store(segment.map_or_else(PairWeights::default, close))?;
            }
        }
        Ok(())
    }

    /// Stage 2: puts the answers of points in place of the law's at every covered node. `active`: the pairs at the positions, with
    /// weights of now.
    pub fn respond<const N: usize>(
        &mut self,
        (given, active): (Given<N>, Option<&Active>),
        lambda: &[SVector<f64, N>],
        (sums, own): (&[NodeSums], &OwnAnswers),
        responses: &mut [NodeResponse<N>],
    ) -> Result<()> {
        match active {
            Some(active) => self.settle_now(given, active)?,
            None => self.settle(given)?,
        }
        self.give_way(given, own)?;
        self.multipliers.clear();
        self.multipliers.store_all(lambda.iter().map(|lambda| lambda[0]))?;
        memory::refill(&mut self.is_covered, false, lambda.len())?;
        for of_nodes in [&mut self.sigma, &mut self.rows, &mut self.shares, &mut self.tractions] {
            memory::refill(of_nodes, 0.0, lambda.len())?;
        }
        for (a, sum) in sums.iter().enumerate().filter(|(a, sum)| sum.coverage > given.least_coverage(*a)) {
            let (normal, response) = (given.normal(a)?, &mut responses[a]);
            let gap = normal.dot(&sum.gap_now) / sum.coverage;
            self.is_covered[a] = true;
            self.sigma[a] = lambda[a][0] + self.rhat[a] * (gap + self.yields(a)[0]);
            (response.state, response.traction) = (State::Gap, Vec3::zeros());
            response.sigma = normal * self.sigma[a];
        }
        self.close(given, active)?;
        self.sum_up(lambda)?;
        if self.has_parts {
            self.push_parts()?;
        }
        for (a, response) in responses.iter_mut().enumerate().filter(|(a, _)| self.is_covered[*a]) {
            response.row = SVector::from_element(self.rows[a] / given.rhat(a));
            self.tractions[a] /= sums[a].coverage;
            self.shares[a] /= sums[a].coverage;
            if self.shares[a] > 0.0 {
                response.state = State::Slip;
                response.traction = given.normal(a)? * self.tractions[a];
            }
        }
        Ok(())
    }

    /// What facets add to their nodes' rows, tractions and shares.
    fn sum_up<const N: usize>(&mut self, lambda: &[SVector<f64, N>]) -> Result<()> {
        let Points { facets, states, closed, sigma, factors, is_covered, rows, tractions, shares, forces, .. } = self;
        forces.clear();
        memory::grow(forces, facets.len())?;
        for (facet, state) in facets.iter().zip(&*states) {
            let (multipliers, mut room) = (facet.of_multipliers(lambda), OfNodes::default());
            let is_open = *state == Closed::Nothing;
            let closed = state.mass(facet, closed, &mut room);
            let own = if is_open { [0.0; MAX_CORNERS] } else { times(closed, &facet.of(sigma)) };
            for (k, &a) in facet.nodes().iter().enumerate().filter(|(_, a)| is_covered[**a]) {
                let factor = factors[a];
                let left =
                    (0..MAX_CORNERS).map(|l| (facet.mass[k][l] + factor * facet.stabilisation[k][l]) * multipliers[l]);
                rows[a] -= left.sum::<f64>();
                if !is_open {
                    rows[a] += own[k];
                    tractions[a] += own[k];
                    shares[a] += closed[k].iter().sum::<f64>();
                }
            }
            forces.store(own)?;
        }
        Ok(())
    }

    /// Stage 3: forces and rows.
    pub fn residual<const N: usize>(
        &self,
        given: Given<N>,
        responses: &[NodeResponse<N>],
        r: &mut Residual<N>,
    ) -> Result<()> {
        let two = &given.setup.mortar;
        r.clear(given.setup.surfaces())?;
        if self.has_parts {
            let of = (given.setup.surfaces(), &given.setup.nodes);
            self.add_pushes(of, (&mut r.nonmortar, &mut r.mortar));
            r.take_rows(given, responses);
            return Ok(());
        }
        for (at, facet) in self.facets.iter().enumerate() {
            if self.states[at] == Closed::Nothing || !facet.is_here(&given.setup.nodes) {
                continue;
            }
            let sigma = facet.of(&self.sigma);
            facet.nodes().iter().zip(self.forces[at]).for_each(|(&a, t)| r.nonmortar[a] += facet.normal * t);
            for place in facet.places() {
                let Some(closed) = self.closed(at, place) else { break };
                let other = two.host_nodes(self.pairs[place].two).iter().zip(times(&closed.ac, &sigma));
                other.for_each(|(&c, t)| r.mortar[c] -= facet.normal * t);
            }
        }
        r.take_rows(given, responses);
        Ok(())
    }
}
