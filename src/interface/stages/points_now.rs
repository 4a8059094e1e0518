//! What points know of their facets with weights of now (docs/formulation 16.8), beside `points.rs`. What is covered of a facet and
//! where its plane lies are of the positions; the shape that K is made of, the nodes' sizes and rhat are data of the step.

use super::points::of_parent_weights;
use crate::dual::{Coverage, FacetSums};
use crate::error::Result;
use crate::geometry::Plane;
use crate::interface::data::active::Active;
use crate::interface::data::pairs::{PairRecord, ParentRecord, Weighted};
use crate::interface::data::points::{OfNodes, PointPair, Points, add_mass};
use crate::interface::pairing::given::Given;
use crate::memory::Store;
use crate::points::{of_facet, of_line};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};

impl Points {
    /// Finds what the pairs at the positions say of their facets.
    pub(super) fn settle_now<const N: usize>(&mut self, given: Given<N>, active: &Active) -> Result<()> {
        let surfaces = given.setup.surfaces();
        if !self.is_settled {
            surfaces.0.plane_normals(&given.history().x1, &mut self.planes)?;
            self.settle_factors(given)?;
            self.is_settled = true;
        }
        self.facets.clear();
        self.pairs.clear();
        let mut first = 0;
        match active.weighted(surfaces) {
            Weighted::Facets(pairs) => pairs.chunk_by(|p, q| p.one == q.one).try_for_each(|pairs| {
                first += pairs.len();
                self.facet_now(given, active, (first - pairs.len(), pairs))
            }),
            Weighted::Parents(pairs) => pairs.chunk_by(|p, q| p.one == q.one).try_for_each(|pairs| {
                first += pairs.len();
                self.line_now(given, active, (first - pairs.len(), pairs))
            }),
        }
    }

    fn facet_now<const N: usize>(
        &mut self,
        given: Given<N>,
        active: &Active,
        (first, pairs): (usize, &[PairRecord]),
    ) -> Result<()> {
        let (one, f) = (&given.setup.nonmortar, pairs[0].one);
        let frame = one.frame(f, &active.x1, &active.normals)?;
        let mut sums = FacetSums::new(&frame);
        for (pair, place) in pairs.iter().zip(first..) {
            let whole = *active.integrated(place);
            sums.add(&whole, &[0.0; MAX_CORNERS]);
            self.pairs.store(PointPair { two: pair.two, whole, dual: pair.weights, parts: [0; 2] })?;
        }
        let nodes = one.facets[f].as_slice();
        let sizes = std::array::from_fn(|k| nodes.get(k).map_or(0.0, |&a| given.size(a)));
        let stabilisation = of_facet(&one.frame(f, &given.history().x1, &self.planes)?, &sizes);
        self.store_facet((f, nodes), first, frame.plane.e, (sums.coverage(), sums.mass, stabilisation))
    }

    fn line_now<const N: usize>(
        &mut self,
        given: Given<N>,
        active: &Active,
        (first, pairs): (usize, &[ParentRecord]),
    ) -> Result<()> {
        let (one, f) = (&given.setup.nonmortar, pairs[0].one);
        let Some(parents) = &one.parents else { return Ok(()) };
        let mut mass = OfNodes::default();
        for (pair, place) in pairs.iter().zip(first..) {
            let (whole, dual) = (of_parent_weights(active.integrated_parent(place)), of_parent_weights(&pair.weights));
            add_mass(&mut mass, &whole);
            self.pairs.store(PointPair { two: pair.two, whole, dual, parts: [0; 2] })?;
        }
        let (nodes, x) = (one.host_nodes(f), &given.history().x1);
        let length = (x[nodes[1]] - x[nodes[0]]).norm();
        let area: f64 = parents.areas(f, &active.x1, parents.space)?.iter().take(MAX_PARENT_NODES).sum();
        let coverage = Coverage::of(mass.iter().flatten().sum::<f64>() / area);
        let stabilisation = of_line(length, [given.size(nodes[0]), given.size(nodes[1])]);
        let normal = Plane::of(&one.facet(parents.parts(f).start, &active.x1))?.e;
        self.store_facet((f, nodes), first, normal, (coverage, mass, stabilisation))
    }
}
