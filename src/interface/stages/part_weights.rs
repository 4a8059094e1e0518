//! Stage 1b where points decide and facets have nodes that are no corners (docs/formulation 16.11): the points of a pair of parts, and the
//! dual weights where there is a multiplier at each node.

use crate::dual::{DualBasis, FacetSums};
use crate::error::Result;
use crate::features;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::lines::{Lines, line};
use crate::interface::data::options::Options;
use crate::interface::data::point_friction::PointFriction;
use crate::interface::data::points::{OfNodes, add_mass};
use crate::interface::data::surface::Surface;
use crate::line;
use crate::memory::Store;
use crate::mortar::{PairWeights, ParentWeights, PartPoint, Segment, SubWeights, each_part_point, rule_for};
use crate::quadrature::Rule;
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};
use crate::simd::rolled;

/// The surfaces, the rule, the positions of both sides, and the normals of the first one's planes.
#[derive(Clone, Copy)]
pub struct PartsAt<'a> {
    pub surfaces: (&'a Surface, &'a Surface),
    pub rule: &'static Rule,
    pub x: (&'a [Vec3], &'a [Vec3]),
    pub planes: &'a [Vec3],
}

/// int N_A N_B of the multipliers over a part, and int of N_A with the functions of all nodes of both facets.
#[derive(Clone, Default)]
pub struct PartWeights {
    pub own: PairWeights,
    pub all: SubWeights,
}

/// Shows `to` the points of part i and of mortar part j, or of an analytic surface.
fn each_point(
    PartsAt { surfaces: (one, two), rule, x, planes }: PartsAt,
    (i, j): (usize, usize),
    to: &mut dyn FnMut(&PartPoint) -> Result<()>,
) -> Result<()> {
    let Some(parents) = &one.parents else { return Ok(()) };
    let f = parents.parent(i);
    if two.analytic.is_some() {
        let (frame, surface) = (one.frame(i, x.0, planes)?, two.analytic_at(x.1)?);
        return parents
            .over_surface(i, (&frame, x.0), (&surface, rule), |pair, x| pair.each_point(x, to))
            .map_err(one.at(i));
    }
    let Some(opposite) = &two.parents else { return Ok(()) };
    if let Some(Lines { measure, .. }) = parents.lines {
        let g = opposite.parent(j);
        let (own, other) = (line(&parents.at(f, x.0)), line(&opposite.at(g, x.1)));
        let parts = (i - parents.parts(f).start, j - opposite.parts(g).start);
        return line::each_part_point([&own, &other], parts, (parents.space, measure), to);
    }
    let frame = one.frame(i, x.0, planes)?;
    let Some(segment) = Segment::new(&frame, &two.facet(j, x.1))? else { return Ok(()) };
    let sides = parents.sides(opposite, (i, j));
    let rule = rule_for(rule, [sides.0.0, sides.1.0]);
    each_part_point((&frame, &segment, rule), sides, parents.space, to)
}

/// Adds so many times the functions of some nodes.
#[inline(never)] // unrolled it is large
fn add(sums: &mut [f64], n: &[f64], by: f64) {
    sums.iter_mut().zip(n).for_each(|(sum, n)| *sum += by * n);
}

/// Adds those of part i and of mortar part j, as far as the field with these values at the multipliers is negative; keeps its points.
#[inline(never)]
pub fn weigh(
    at: PartsAt,
    pair: (usize, usize),
    field: &[f64; MAX_CORNERS],
    to: &mut PartWeights,
    mut keep: Option<&mut PointFriction>,
) -> Result<()> {
    each_point(at, pair, &mut |point| {
        let value: f64 = point.own.iter().zip(field).map(|(n, value)| n * value).sum();
        if value >= 0.0 {
            return Ok(());
        }
        for a in 0..rolled(MAX_CORNERS) {
            let n = point.weight * point.own[a];
            add(&mut to.own.ab[a], &point.own, n);
            add(&mut to.all.ab[a], &point.all[0], n);
            add(&mut to.all.ac[a], &point.all[1], n);
        }
        keep.as_mut().map_or(Ok(()), |keep| keep.keep_point(point))
    })
}

/// Everywhere negative.
pub const WHOLE: [f64; MAX_CORNERS] = [-1.0; MAX_CORNERS];

/// What part i sums up over its pairs, with these n_AA of all of them.
pub fn sums(
    PartsAt { surfaces: (one, _), x: (x1, _), planes, .. }: PartsAt,
    i: usize,
    mass: OfNodes,
) -> Result<FacetSums> {
    let mut sums = FacetSums { nodes: one.rows(i).len, mass, ..FacetSums::new(&one.frame(i, x1, planes)?) };
    if let (Some(parents), Some(Lines { measure, .. })) = (&one.parents, one.lines()) {
        let f = parents.parent(i);
        let element = line(&parents.at(f, x1)).area_element(i - parents.parts(f).start, *measure);
        sums.area = 2.0 * element.of[0]; // u runs from -1 to 1
    }
    Ok(sums)
}

/// Rows of a part by themselves.
const ROWS: [usize; MAX_CORNERS] = [0, 1, 2, 3];

/// Puts dual weights in place of the integrated ones of facets that have a multiplier at each of their nodes: each part has its own basis, that
/// of the functions of the multipliers over it.
pub fn dual_parts(surfaces: (&Surface, &Surface), options: &Options, active: &mut Active) -> Result<()> {
    features::POINTS.is_here();
    let (one, two) = surfaces;
    let (pairs, planes) = (std::mem::take(&mut active.pairs), std::mem::take(&mut active.normals));
    let (x1, x2, mut acts) = (std::mem::take(&mut active.x1), std::mem::take(&mut active.x2), Vec::new());
    active.parents.clear();
    let done = pairs.chunk_by(|p, q| p.one == q.one).try_for_each(|pairs| {
        let (i, mut mass) = (pairs[0].one, OfNodes::default());
        let at = PartsAt { surfaces, rule: options.rule, x: (&x1, &x2), planes: &planes };
        acts.clear();
        for pair in pairs {
            let mut of_pair = PartWeights::default();
            weigh(at, (i, pair.two), &WHOLE, &mut of_pair, None)?;
            add_mass(&mut mass, &of_pair.own);
            acts.store(of_pair.all)?;
        }
        let basis = DualBasis::of(&sums(at, i, mass)?).map_err(one.at(i))?;
        for (pair, of_pair) in pairs.iter().zip(&mut acts) {
            let mut weights = ParentWeights::default();
            weights.add(&ROWS, of_pair);
            let dual = basis.as_ref().map_or_else(ParentWeights::default, |basis| basis.parent_weights(&weights));
            for a in 0..rolled(MAX_CORNERS) {
                of_pair.ab[a][..MAX_PARENT_NODES].copy_from_slice(&dual.ab[a]);
                of_pair.ac[a][..MAX_PARENT_NODES].copy_from_slice(&dual.ac[a]);
            }
            let (f, g) = (one.host_facet(i), two.host_facet(pair.two));
            let rows = one.parents.as_ref().map_or(&[][..], |p| p.space.nodes(p.facets[f].parent, p.sub(i)));
            active.add_share((f, g), rows, of_pair)?;
        }
        Ok(())
    });
    active.order_parents();
    (active.pairs, active.normals, active.x1, active.x2) = (pairs, planes, x1, x2);
    done
}
