//! What points know of their facets where either side has nodes that are no corners (docs/formulation 16.11), beside `points.rs`.
//! Parts of the host's facets are what decides, each in its own plane, with the functions of the multipliers over it; forces go to all
//! nodes of both facets.

use super::commit;
use super::part_weights::{PartWeights, PartsAt, WHOLE, sums, weigh};
use crate::dual::Coverage;
use crate::error::Result;
use crate::geometry::{Facet, Vec3};
use crate::interface::data::node_data::NodeData;
use crate::interface::data::options::Options;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::points::{OfNodes, PointFacet, PointPair, Points, Push, add_mass};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::settle;
use crate::interface::pairing::work::Work;
use crate::memory::Store;
use crate::mortar::{MultiplierSpace, NonmortarFrame, PairWeights};
use crate::points::{of_facet, of_line};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES, Shape};
use crate::simd::rolled;

/// What parts have from the step: the nodes' sizes, and whether each point remembers something.
type OfStep<'a> = (&'a dyn Fn(usize) -> f64, bool);

impl Points {
    /// Finds what the step knows of its parts: of those pairs that its weights are of.
    #[inline(never)]
    pub(super) fn settle_parts(
        &mut self,
        (one, two): (&Surface, &Surface),
        options: &Options,
        x: (&[Vec3], &[Vec3]),
        step: OfStep,
    ) -> Result<()> {
        let (mut work, mut of_facet) = (Work::default(), 0..0);
        let mut filter = settle::filter((one, two), options, x, &mut work.tree)?;
        let active = commit::pairs((one, two), options, &mut filter, &mut work, x)?;
        let at = PartsAt { surfaces: (one, two), rule: options.rule, x, planes: &active.normals };
        let mut share = (usize::MAX, None);
        for pairs in active.pairs.chunk_by(|p, q| p.one == q.one) {
            let f = one.host_facet(pairs[0].one);
            if f != share.0 && options.space == MultiplierSpace::Corner {
                let more = active.parents[of_facet.end..].iter().take_while(|pair| pair.one == f).count();
                of_facet = of_facet.end..of_facet.end + more;
                let mut weights = of_facet.clone().map(|place| active.integrated_parent(place));
                let basis = one.parent_basis(f, x.0, &mut weights)?;
                share = (f, Some(basis.map_or(Coverage::of(0.0), |basis| basis.coverage)));
            }
            self.settle_part(at, pairs, share.1, step)?;
        }
        Ok(())
    }

    /// `coverage`: that of the whole facet, where its multipliers are of the whole.
    fn settle_part(
        &mut self,
        at: PartsAt,
        pairs: &[PairRecord],
        coverage: Option<Coverage>,
        (size, keeps): OfStep,
    ) -> Result<()> {
        let ((one, two), i) = (at.surfaces, pairs[0].one);
        let (first, mut mass) = (self.pairs.len(), OfNodes::default());
        for of_one in pairs.chunk_by(|p, q| two.host_facet(p.two) == two.host_facet(q.two)) {
            let (mut weights, from) = (PartWeights::default(), self.parts.len());
            for pair in of_one {
                self.parts.store(pair.two)?;
                weigh(at, (i, pair.two), &WHOLE, &mut weights, keeps.then_some(&mut self.friction))?;
            }
            self.friction.end_pair()?;
            add_mass(&mut mass, &weights.own);
            let (g, parts) = (two.host_facet(of_one[0].two), [from, self.parts.len()]);
            self.pairs.store(PointPair { two: g, whole: weights.own, dual: PairWeights::default(), parts })?;
            self.acts.store(weights.all)?;
        }
        let rows = one.rows(i).as_slice();
        // A triangle's fourth point is its first one.
        let (mut nodes, mut sizes) = ([at.x.0[rows[0]]; MAX_CORNERS], [0.0; MAX_CORNERS]);
        for (k, &a) in rows.iter().enumerate() {
            (nodes[k], sizes[k]) = (at.x.0[a], size(a));
        }
        let stabilisation = match Shape::of(rows.len()) {
            Some(shape) => of_facet(&NonmortarFrame::new(&Facet { nodes, shape }).map_err(one.at(i))?, &sizes),
            None => of_line((nodes[1] - nodes[0]).norm(), [sizes[0], sizes[1]]),
        };
        let coverage = match coverage {
            Some(coverage) => coverage,
            None => sums(at, i, mass)?.coverage(),
        };
        self.store_facet((i, rows), first, at.planes[i], (coverage, mass, stabilisation))
    }

    /// The weights of the closed part of a part of a facet with one of its pairs.
    #[inline(never)]
    pub(super) fn close_part(
        at: PartsAt,
        (facet, sigma): (&PointFacet, &[f64; MAX_CORNERS]),
        (pair, parts): (&PointPair, &[usize]),
    ) -> Result<PartWeights> {
        let mut closed = PartWeights::default();
        let parts = &parts[pair.parts[0]..pair.parts[1]];
        parts.iter().try_for_each(|&j| weigh(at, (facet.one, j), sigma, &mut closed, None))?;
        Ok(closed)
    }

    /// What each pair is pushed with, of tractions without friction.
    #[inline(never)]
    pub(super) fn push_parts(&mut self) -> Result<()> {
        self.pushes.clear();
        for (at, facet) in self.facets.iter().enumerate() {
            let sigma = facet.of(&self.sigma);
            for place in facet.places() {
                let mut push = Push::default();
                if let Some(acts) = self.acts(at, place) {
                    for (push, n) in push.iter_mut().zip([&acts.ab, &acts.ac]) {
                        for b in 0..rolled(MAX_PARENT_NODES) {
                            let t: f64 = (0..rolled(MAX_CORNERS)).map(|a| n[a][b] * sigma[a]).sum();
                            push[b] = facet.normal * (facet.fade * t);
                        }
                    }
                }
                self.pushes.store(push)?;
            }
        }
        Ok(())
    }

    /// Adds the forces on all nodes of both sides.
    #[inline(never)]
    pub(super) fn add_pushes(
        &self,
        ((one, two), nodes): ((&Surface, &Surface), &NodeData),
        forces: (&mut [Vec3], &mut [Vec3]),
    ) {
        for facet in self.facets.iter().filter(|facet| facet.is_here(nodes)) {
            let own = one.host_nodes(one.host_facet(facet.one));
            for (place, push) in facet.places().zip(&self.pushes[facet.places()]) {
                own.iter().zip(&push[0]).for_each(|(&b, force)| forces.0[b] += force);
                let other = two.host_nodes(self.pairs[place].two);
                other.iter().zip(&push[1]).for_each(|(&c, force)| forces.1[c] -= force);
            }
        }
    }
}
