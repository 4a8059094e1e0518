//! What weights of now add to the tangent where points decide (docs/formulation 16.8), facet by facet: the derivatives of a facet's
//! forces and rows at fixed sigma_A and lambda_A, which are blocks of the facet's nodes, and those of sigma_A of its nodes at fixed
//! lambda_A, which the sums over nodes (`points.rs`) take in place of weights that are held.

use super::around::Around;
use super::emission::{Emitter, NodeBlock, Place, put_in_order};
use super::point_numbers::PointNumbers;
use super::point_offsets::RaisedFacet;
use crate::dual::{DualBasis, whole_area_derivative};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::options::Tangent;
use crate::interface::data::points::{Closed, PointFacet, Points};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::stages::facet::dual_basis;
use crate::interface::stages::points::line_pair;
use crate::line::{LineDerivatives, LineFacet, MAX_LINE_NODES, Measure};
use crate::memory::{self, Store};
use crate::mortar::{
    AreaDerivatives, ClosedPart, ForceDerivatives, MORTAR, MultiplierSpace, PAIR_NODES, ParentWeights, Raised,
    offset_motion, pair_motion_raised,
};
use crate::shape::MAX_CORNERS;

type OfCorners = [f64; MAX_CORNERS];

const NO_AREAS: AreaDerivatives = [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES];

/// Derivatives with respect to one component of one node, summed over a facet's pairs, lanes A or B.
#[derive(Clone, Copy, Debug, Default)]
struct Column {
    /// Dm_A.
    areas: OfCorners,
    /// Dgamma_A - sum_B Dm_AB h_B.
    gaps: OfCorners,
    /// Do_A - sum_B Dm_AB eta_B of the nodes' offsets (docs/formulation 15.2).
    offsets: OfCorners,
    /// D int sigma N_B over what is closed, and D sum_B m_AB lambda_B, at fixed values of nodes.
    forces: OfCorners,
    multipliers: OfCorners,
}

/// What a facet is at the positions.
struct Whole {
    basis: DualBasis,
    /// h_A, of gamma_A along e, the plane's normal out of the body.
    heights: OfCorners,
    /// eta_A of the nodes' offsets.
    eta: OfCorners,
    e: Vec3,
    /// De with respect to its nodes.
    turn: [Mat3; MAX_CORNERS],
    /// D|e| with respect to its nodes.
    area: [Vec3; MAX_CORNERS],
}

impl Whole {
    /// Dphi.
    fn dfade(&self, column: usize, j: usize, of: &Column) -> f64 {
        let area = self.area.get(column).map_or(0.0, |area| area[j]);
        self.basis.fade_derivative(&of.areas, (self.basis.coverage.share, area))
    }

    /// D(phi m_A).
    fn faded_areas(&self, column: usize, j: usize, of: &Column) -> OfCorners {
        let (dphi, basis) = (self.dfade(column, j, of), &self.basis);
        std::array::from_fn(|a| basis.coverage.fade * of.areas[a] + dphi * basis.areas[a])
    }
}

/// One facet's sums; its own nodes' columns first, then those of its mortar nodes.
#[derive(Debug, Default)]
pub struct Table {
    columns: Vec<[Column; 3]>,
    /// - int sigma N_C of each mortar node, phi times, and its derivatives without phi, by the columns.
    other: Vec<f64>,
    other_by: Vec<[f64; 3]>,
    overlaps: FacetOverlaps,
    order: Vec<(usize, Place)>,
    blocks: Vec<NodeBlock>,
}

/// d sigma_A / dx of each facet's share, by the facets' nodes A and columns.
#[derive(Debug, Default)]
pub struct Motions {
    first: Vec<usize>,
    slopes: Vec<Vec3>,
}

impl Motions {
    /// Those of node l of the k-th facet.
    pub fn slopes(&self, k: usize, l: usize, columns: usize) -> &[Vec3] {
        &self.slopes[self.first[k] + l * columns..][..columns]
    }
}

/// Emits what facets have at fixed sigma_A and lambda_A, and gives the rest.
pub fn of_facets<const N: usize>(
    given: Given<N>,
    (numbers, active): (&PointNumbers, &Active),
    around: &Around,
    emitter: &mut Emitter<N>,
) -> Result<Motions> {
    let (mut motions, mut table) = (Motions::default(), Table::default());
    for (k, &f) in around.facets.iter().enumerate() {
        let n = given.setup.nonmortar.host_nodes(f).len();
        let columns = n + around.mortar(k).len();
        motions.first.store(motions.slopes.len())?;
        let slopes = motions.slopes.len();
        motions.slopes.store_all(std::iter::repeat_n(Vec3::zeros(), n * columns))?;
        let Ok(at) = numbers.points.facets.binary_search_by_key(&f, |facet| facet.one) else { continue };
        table.begin(n, around.mortar(k).len())?;
        let facet = &numbers.points.facets[at];
        let whole = match given.setup.has_parents() {
            true => table.add_lines(given, (numbers.points, active), (at, around.mortar(k)))?,
            false => table.add_facets(given, (numbers.points, active), (at, around.mortar(k)))?,
        };
        let Some(whole) = whole else { continue }; // it has faded out
        table.put_slopes(numbers, (facet, &whole), &mut motions.slopes[slopes..]);
        table.emit(given, numbers, (facet, &whole, at), around.mortar(k), emitter)?;
    }
    Ok(motions)
}

impl Points {
    /// sigma_A of a facet's nodes where any of it is closed.
    fn acting(&self, at: usize) -> OfCorners {
        if self.states[at] == Closed::Nothing { [0.0; MAX_CORNERS] } else { self.facets[at].of(&self.sigma) }
    }
}

impl Table {
    fn begin(&mut self, own: usize, mortar: usize) -> Result<()> {
        memory::refill(&mut self.columns, [Column::default(); 3], own + mortar)?;
        memory::refill(&mut self.other, 0.0, mortar)?;
        memory::refill(&mut self.other_by, [0.0; 3], mortar * (own + mortar))
    }

    /// Adds the pairs of a facet with three or four nodes; `None`: it has faded out.
    fn add_facets<const N: usize>(
        &mut self,
        given: Given<N>,
        (points, active): (&Points, &Active),
        (at, mortar): (usize, &[u32]),
    ) -> Result<Option<Whole>> {
        let ((one, two), facet, n) = (given.setup.surfaces(), &points.facets[at], self.columns.len());
        self.overlaps.of(given, active, facet.places())?;
        if given.setup.options.tangent == Tangent::FrozenNormals {
            self.overlaps.freeze_normals();
        }
        let (frame, rule) = (self.overlaps.frame(), given.setup.options.rule);
        let weights = &active.integrated[facet.places()];
        let (sums, basis) = dual_basis(one, facet.one, (frame, &self.overlaps.segments), weights)?;
        let Some(basis) = basis else { return Ok(None) };
        let (heights, sigma) = (basis.heights(&sums.gamma), points.acting(at));
        let lifted = RaisedFacet::of(given, points, facet, &basis);
        let (plane, fields) = (&frame.plane, [sigma, facet.of(&points.multipliers), [0.0; MAX_CORNERS]]);
        let mut forces = ForceDerivatives::default();
        for ((place, segment), weights) in facet.places().zip(&self.overlaps.segments).zip(weights) {
            let mut areas = AreaDerivatives::default();
            let raised = Raised { heights: &heights, areas: &mut areas };
            let gap = pair_motion_raised((frame, segment, rule), weights, &fields, &mut forces, raised);
            if matches!(points.states[at], Closed::Part(_)) {
                ClosedPart::new(frame, segment, &sigma).motion(&mut forces);
            }
            let mut offsets = NO_AREAS;
            if let Some(raised) = &lifted {
                let two = &two.offsets_of(two.host_nodes(points.pairs[place].two));
                offset_motion((frame, segment, rule), (&raised.above, two), &mut offsets);
            }
            let nodes = two.facets[points.pairs[place].two].as_slice();
            let column_of = |c: usize| mortar.iter().position(|known| *known as usize == c).map(|c| facet.n + c);
            for slot in (0..facet.n).chain(MORTAR..MORTAR + nodes.len()) {
                let column = if slot < MORTAR { Some(slot) } else { column_of(nodes[slot - MORTAR]) };
                let Some(column) = column else { continue };
                for j in 0..3 {
                    let to = &mut self.columns[column][j];
                    add(&mut to.areas, &areas[slot][j]);
                    add(&mut to.gaps, &gap.dgamma[slot][j]);
                    add(&mut to.offsets, &offsets[slot][j]);
                    add(&mut to.forces, &forces.one[slot][j][0]);
                    add(&mut to.multipliers, &forces.one[slot][j][1]);
                    for (l, &c) in nodes.iter().enumerate() {
                        if let Some(row) = column_of(c) {
                            self.other_by[(row - facet.n) * n + column][j] += forces.two[slot][j][0][l];
                        }
                    }
                }
            }
        }
        let tilt = |k: usize| (plane.t1 * plane.tilt[0][k] + plane.t2 * plane.tilt[1][k]) * plane.e.transpose();
        let (turn, area) = (std::array::from_fn(tilt), whole_area_derivative(frame));
        let eta = lifted.map_or([0.0; MAX_CORNERS], |raised| raised.eta);
        Ok(Some(Whole { basis, heights, eta, e: plane.e, turn, area }))
    }

    /// The same of a line.
    fn add_lines<const N: usize>(
        &mut self,
        given: Given<N>,
        (points, active): (&Points, &Active),
        (at, mortar): (usize, &[u32]),
    ) -> Result<Option<Whole>> {
        let ((one, two), facet) = (given.setup.surfaces(), &points.facets[at]);
        let mut integrated = facet.places().map(|place| active.integrated_parent(place));
        let Some(basis) = one.parent_basis(facet.one, &active.x1, &mut integrated)? else { return Ok(None) };
        let (x, e) = ((&active.x1[..], &active.x2[..]), -facet.normal);
        let line = |place: usize| line_pair(given, x, (facet.one, points.pairs[place].two));
        let above = |own: &LineFacet, other: &LineFacet| other.x.map(|x| e.xy().dot(&(x - own.x[0])));
        let mut gamma = [0.0; MAX_CORNERS];
        for place in facet.places() {
            let (Some((own, other, _)), weights) = (line(place), active.integrated_parent(place)) else { continue };
            let d = above(&own, &other);
            for (gamma, row) in gamma.iter_mut().zip(&weights.ac).take(2) {
                *gamma -= row[0] * d[0] + row[1] * d[1];
            }
        }
        let heights = basis.heights(&gamma);
        let raised = RaisedFacet::of(given, points, facet, &basis);
        let eta = raised.as_ref().map_or([0.0; MAX_CORNERS], |raised| raised.eta);
        let mut whole = Whole { basis, heights, eta, e, turn: Default::default(), area: Default::default() };
        for place in facet.places() {
            let Some((own, other, measure)) = line(place) else { continue };
            let (t, along) = ((own.x[1] - own.x[0]).normalize(), own.x[1] - own.x[0]);
            let turn = Vec3::new(t.x, t.y, 0.0) * e.transpose() / along.norm();
            (whole.turn[0], whole.turn[1]) = (turn, -turn);
            for (area, of) in whole.area.iter_mut().zip(own.area_derivative(measure)).take(2) {
                *area = Vec3::new(of.x, of.y, 0.0);
            }
            let nodes = two.host_nodes(points.pairs[place].two);
            let weights = active.integrated_parent(place);
            let pair = (&own, &other, measure);
            self.add_line((points, at), pair, (weights, &whole, above(&own, &other)), (nodes, mortar));
            if let Some(raised) = &raised {
                self.add_line_offsets(pair, raised, two, (nodes, mortar));
            }
        }
        Ok(Some(whole))
    }

    /// Adds one pair of lines, the mortar one's nodes at heights `d` above the other.
    fn add_line(
        &mut self,
        (points, at): (&Points, usize),
        (own, other, measure): (&LineFacet, &LineFacet, Measure),
        (weights, Whole { heights: h, e, .. }, d): (&ParentWeights, &Whole, [f64; MAX_LINE_NODES]),
        (nodes, mortar): (&[usize], &[u32]),
    ) {
        let (facet, sigma, n) = (&points.facets[at], points.acting(at), self.columns.len());
        let lambda = facet.of(&points.multipliers);
        let all = LineDerivatives::new(own, other, MultiplierSpace::Corner, measure);
        let closed = match points.states[at] {
            Closed::Part(_) => LineDerivatives::closed_part(own, other, measure, [sigma[0], sigma[1]]),
            _ => all,
        };
        let column_of = |c: usize| mortar.iter().position(|known| *known as usize == c).map(|c| facet.n + c);
        for (slot, j) in (0..4).flat_map(|slot| (0..2).map(move |j| (slot, j))) {
            let column = if slot < 2 { Some(slot) } else { column_of(nodes[slot - 2]) };
            let Some(column) = column else { continue };
            let of = 2 * if slot < 2 { slot } else { MAX_LINE_NODES + slot - 2 } + j;
            let to = &mut self.columns[column][j];
            for a in 0..2 {
                let (ab, ac) = ([all.ab[a][0][of], all.ab[a][1][of]], [all.ac[a][0][of], all.ac[a][1][of]]);
                let weight = if slot < 2 { weights.ab[a][slot] } else { -weights.ac[a][slot - 2] };
                to.areas[a] += ab[0] + ab[1];
                to.gaps[a] += e[j] * weight - (ab[0] * h[0] + ab[1] * h[1]) - (ac[0] * d[0] + ac[1] * d[1]);
                to.multipliers[a] += ab[0] * lambda[0] + ab[1] * lambda[1];
                to.forces[a] += closed.ab[0][a][of] * sigma[0] + closed.ab[1][a][of] * sigma[1];
                if let Some(row) = column_of(nodes[a]) {
                    let force = closed.ac[0][a][of] * sigma[0] + closed.ac[1][a][of] * sigma[1];
                    self.other_by[(row - facet.n) * n + column][j] -= force;
                }
            }
        }
    }

    /// Adds what offsets of the nodes have of a pair of lines.
    fn add_line_offsets(
        &mut self,
        (own, other, measure): (&LineFacet, &LineFacet, Measure),
        raised: &RaisedFacet,
        two: &Surface,
        (nodes, mortar): (&[usize], &[u32]),
    ) {
        let all = LineDerivatives::new(own, other, MultiplierSpace::Corner, measure);
        let (h, d) = (&raised.above, two.offsets_of(nodes));
        for (slot, j) in (0..4).flat_map(|slot| (0..2).map(move |j| (slot, j))) {
            let column_of = |c: usize| mortar.iter().position(|known| *known as usize == c).map(|c| 2 + c);
            let Some(column) = (if slot < 2 { Some(slot) } else { column_of(nodes[slot - 2]) }) else { continue };
            let of = 2 * if slot < 2 { slot } else { MAX_LINE_NODES + slot - 2 } + j;
            for a in 0..2 {
                let (ab, ac) = (&all.ab[a], &all.ac[a]);
                self.columns[column][j].offsets[a] +=
                    ab[0][of] * h[0] + ab[1][of] * h[1] + ac[0][of] * d[0] + ac[1][of] * d[1];
            }
        }
    }

    /// The share of d sigma_A / dx: rhat_A / D_A (nu_A . D(phi m_A h_A e) + D(phi m_A eta_A) - gh_A D(phi m_A)).
    fn put_slopes(
        &self,
        PointNumbers { points, sums, normals, .. }: &PointNumbers,
        (facet, whole): (&PointFacet, &Whole),
        slopes: &mut [Vec3],
    ) {
        let (n, basis) = (self.columns.len(), &whole.basis);
        let covered = basis.diagonal();
        for (column, j) in (0..n).flat_map(|column| (0..3).map(move |j| (column, j))) {
            let of = &self.columns[column][j];
            let (areas, gaps) = (whole.faded_areas(column, j, of), basis.dual(&of.gaps));
            let offsets = basis.dual(&of.offsets);
            let turn =
                whole.turn.get(column).filter(|_| column < facet.n).map_or(Vec3::zeros(), |t| t.column(j).into());
            for (l, &a) in facet.nodes().iter().enumerate().filter(|(_, a)| points.is_covered[**a]) {
                let (nu, rhat) = (normals[a], points.rhat[a]);
                let gap = whole.e * (gaps[l] + areas[l] * whole.heights[l]) + turn * (covered[l] * whole.heights[l]);
                let height = nu.dot(&sums[a].gap_now) / sums[a].coverage;
                let offset = offsets[l] + areas[l] * whole.eta[l];
                slopes[l * n + column][j] += rhat / sums[a].coverage * (nu.dot(&gap) + offset - height * areas[l]);
            }
        }
    }

    /// Emits the rows of the facet's nodes, of its mortar nodes and of its multipliers.
    fn emit<const N: usize>(
        &mut self,
        given: Given<N>,
        PointNumbers { points, .. }: &PointNumbers,
        (facet, whole, at): (&PointFacet, &Whole, usize),
        mortar: &[u32],
        emitter: &mut Emitter<N>,
    ) -> Result<()> {
        let (one, n, phi) = (&given.setup.nonmortar, self.columns.len(), whole.basis.coverage.fade);
        let place = |k: usize| match k < facet.n {
            true => Place::Displacement(facet.nodes[k]),
            false => Place::Displacement(one.len() + mortar[k - facet.n] as usize),
        };
        let Table { columns, other, other_by, order, blocks, .. } = self;
        order.clear();
        order.store_all((0..n).map(|k| (k, place(k))))?;
        put_in_order(order, &|place| emitter.taker.order(place));
        let (sigma, forces) = (points.acting(at), points.forces[at]);
        for pair in facet.places() {
            let Some(closed) = points.closed(at, pair) else { break };
            for (l, c) in given.setup.mortar.host_nodes(points.pairs[pair].two).iter().enumerate() {
                if let Some(row) = mortar.iter().position(|known| *known as usize == *c) {
                    other[row] -= (0..MAX_CORNERS).map(|a| closed.ac[a][l] * sigma[a]).sum::<f64>();
                }
            }
        }
        for row in (0..n).filter(|_| facet.is_here(&given.setup.nodes)) {
            let force = if row < facet.n { forces[row] } else { other[row - facet.n] };
            let by = |column: usize, j: usize| match row < facet.n {
                true => columns[column][j].forces[row],
                false => other_by[(row - facet.n) * n + column][j],
            };
            let block = |column: usize| {
                std::array::from_fn(|j| {
                    let along = phi * by(column, j) + whole.dfade(column, j, &columns[column][j]) / phi * force;
                    let turn = if column < facet.n { whole.turn[column].column(j) * -force } else { Vec3::zeros() };
                    let v = facet.normal * along + turn;
                    [v.x, v.y, v.z, 0.0]
                })
            };
            blocks.clear();
            blocks.store_all((0..n).map(block))?;
            emitter.taker.row(place(row), order, blocks);
        }
        let lambda = facet.of(&points.multipliers);
        let times = |m: &[OfCorners; MAX_CORNERS], k: usize| (0..MAX_CORNERS).map(|l| m[k][l] * lambda[l]).sum::<f64>();
        let covered: f64 = facet.mass.as_flattened().iter().sum();
        for (k, &b) in facet.nodes().iter().enumerate().filter(|(_, b)| one.has_row(**b) && points.is_covered[**b]) {
            let scale = given.row_scale(b) / given.rhat(b);
            let (smooth, mass) = (points.factors[b] * times(&facet.stabilisation, k) / covered, times(&facet.mass, k));
            let block = |column: usize| {
                std::array::from_fn(|j| {
                    let of = &columns[column][j];
                    let dphi = whole.dfade(column, j, of) / phi;
                    let areas: f64 = whole.faded_areas(column, j, of).iter().sum();
                    let left = phi * of.multipliers[k] + dphi * mass + smooth * areas;
                    [scale * (phi * of.forces[k] + dphi * forces[k] - left), 0.0, 0.0, 0.0]
                })
            };
            blocks.clear();
            blocks.store_all((0..n).map(block))?;
            emitter.taker.row(Place::Multiplier(b), order, blocks);
        }
        Ok(())
    }
}

fn add(sum: &mut OfCorners, of: &OfCorners) {
    sum.iter_mut().zip(of).for_each(|(sum, v)| *sum += v);
}
