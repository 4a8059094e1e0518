//! What may be wrong with an interface, for a host whose Newton does not converge or whose solver finds a singular
//! matrix: the worst pairs, the states, and the nodes and directions in which multiplier rows (nearly) vanish.
//!
//! A row of the multipliers that has no entries makes the matrix singular. So of the three rows of a node the least
//! singular value over all their columns is taken, with its direction, relative to that of an ordinary row: entries
//! over displacements are of the order of M_A times the row scale, those over multipliers 1 / r_A, here times r_A M_A.
//! What couples several nodes (more multipliers than displacements to react) is not seen node by node.

use super::largest::Largest;
use crate::error::{Error, Kind, Result, Text};
use crate::geometry::{Facet, Plane, Vec3};
use crate::interface::data::options::{MultiplierBasis, Scheme, Weights};
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::NO_EQUATION;
use crate::interface::pairing::candidates::by_points;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::given::Given;
use crate::interface::stages::sums::NodeSums;
use crate::interface::tangent::by_equations::Sink;
use crate::law::State;
use crate::memory::{self, Store, Stored};
use crate::mortar::{NonmortarFrame, PairWeights, Segment, SubWeights};
use crate::quadrature::DEGREE_10;
use nalgebra::{SMatrix, SVector, SymmetricEigen};

/// Rows below this, relative to those of a node that is covered in full, are suspects: a node covered to a ten
/// thousandth has such rows, and a Newton matrix loses four digits by them.
pub const SUSPECT: f64 = 1e-4;
/// Covered over full area below which that is what makes a node's rows small.
const LITTLE: f64 = 1e-3;
/// Rows below this are rounding of rows that vanish: the root of what products of rows are known to.
const VANISHING: f64 = 1e-7;
/// A turn beyond this is told [rad]: so much of the pressure acts as a shear then, which is about what friction is known to.
const TURN_TOLD: f64 = 0.03;
/// Suspects that the text tells of.
const TOLD: usize = 3;

/// Why a node's row is small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Cause {
    /// None of those below.
    Other = 0,
    /// The node is hardly covered.
    Coverage = 1,
    /// No displacement in this direction, of either side, has an equation.
    Prescribed = 2,
    /// It sticks and has no slip history (`NewContact::KeepFriction`).
    New = 3,
}

/// A node and a direction in which the matrix may be singular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suspect {
    /// Non-mortar node.
    pub node: usize,
    /// Unit vector.
    pub direction: Vec3,
    /// Size of the row in this direction over that of an ordinary row [-].
    pub ratio: f64,
    /// Why.
    pub cause: Cause,
}

/// The pair that is worst in some respect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPair {
    /// In what it is the worst.
    pub value: f64,
    /// Non-mortar and mortar facet.
    pub facets: [usize; 2],
}

/// The diagnosis at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnosis {
    /// Of every node.
    pub states: Vec<State>,
    /// How many nodes there are at which no facet has a multiplier, as mid nodes: they are in gap, and not counted.
    pub without_multiplier: usize,
    /// The node that is covered least, of those that are covered, and its covered over full area [-].
    pub least_covered: Option<(usize, f64)>,
    /// Smallest overlap over the smaller facet's area [-].
    pub overlap: Option<WorstPair>,
    /// Largest distance of a node of either facet from that facet's plane over its longest edge [-].
    pub warp: Option<WorstPair>,
    /// Largest angle between the facets' planes `[rad]`.
    pub angle: Option<WorstPair>,
    /// Largest difference of a weight from that of the degree-10 rule, over the non-mortar facet's area [-].
    pub error: Option<WorstPair>,
    /// How far the surface has turned since weights of the reference were made: [`Equilibrium::turn`](super::equilibrium::Equilibrium).
    pub turn: Largest,
    /// Least ratio first.
    pub suspects: Vec<Suspect>,
}

impl Diagnosis {
    /// How many nodes are in this state.
    pub fn count(&self, state: State) -> usize {
        let without = if state == State::Gap { self.without_multiplier } else { 0 };
        self.states.iter().filter(|s| **s == state).count() - without
    }

    /// The diagnosis in sentences; nodes and facets counted from `base`.
    ///
    /// # Errors
    /// [`Kind::OutOfMemory`].
    pub fn text(&self, base: usize) -> Result<Text> {
        let [gap, stick, slip] = [State::Gap, State::Stick, State::Slip].map(|s| self.count(s));
        let mut text = Text::EMPTY;
        text.append(format_args!("{gap} nodes in gap, {stick} in stick, {slip} in slip."))?;
        if let Some((node, fraction)) = self.least_covered {
            text.append(format_args!(" Least covered is node {}, to {fraction:.1e}.", node + base))?;
        }
        let worst = [
            ("Smallest overlap", &self.overlap, "of the smaller facet"),
            ("Largest warp", &self.warp, "of the longest edge"),
            ("Steepest angle", &self.angle, "rad"),
            ("Largest error of the weights", &self.error, "of the facet's area"),
        ];
        for (what, pair, unit) in worst {
            if let Some(WorstPair { value, facets: [one, two] }) = pair {
                let (one, two) = (one + base, two + base);
                text.append(format_args!(" {what}: {value:.1e} {unit}, facets {one} and {two}."))?;
            }
        }
        if let Largest { value, node: Some(node), .. } = self.turn
            && value > TURN_TOLD
        {
            text.append(format_args!(
                " The surface has turned by {value:.2} rad since its weights were made, at node {}: this part of the \
                 pressure, or of a tied surface's offset, acts along it. Weights of now turn with it, offsets of tied surfaces do not.",
                node + base
            ))?;
        }
        for Suspect { node, direction: d, ratio, cause } in self.suspects.iter().take(TOLD) {
            let why = match cause {
                Cause::Other => "its rows are weak",
                Cause::Coverage => "it is hardly covered",
                Cause::Prescribed => "no displacement there has an equation",
                Cause::New => "it sticks and has no slip history",
            };
            text.append(format_args!(
                " The matrix may be singular at node {} along ({:.3}, {:.3}, {:.3}), {ratio:.1e} of an ordinary row: \
                 {why}.",
                node + base,
                d.x,
                d.y,
                d.z
            ))?;
        }
        if self.suspects.len() > TOLD {
            text.append(format_args!(" So at {} more.", self.suspects.len() - TOLD))?;
        }
        Ok(text)
    }
}

/// Keeps the larger of two.
fn keep(worst: &mut Option<WorstPair>, value: f64, facets: [usize; 2]) {
    if worst.is_none_or(|w| value > w.value) {
        *worst = Some(WorstPair { value, facets });
    }
}

/// Largest distance of a node from the facet's plane over its longest edge.
fn warp(facet: &Facet) -> f64 {
    Plane::of(facet).map_or(0.0, |plane| {
        let height = |x: &Vec3| plane.e.dot(&(x - plane.reference - plane.origin)).abs();
        facet.points().iter().map(height).fold(0.0, f64::max) / facet.longest_edge()
    })
}

/// The entries of the multiplier rows: node, column, component, value.
#[derive(Debug)]
pub struct Rows {
    of: Owners,
    entries: Vec<(usize, i64, usize, f64)>,
    /// Whether every entry of the tangent is.
    finite: bool,
    /// Whether there was memory for all of them.
    refused: Option<Error>,
}

impl Rows {
    /// None yet, of these multiplier equations.
    pub fn new<const N: usize>(equations: &[[i64; N]]) -> Result<Rows> {
        Ok(Rows { of: Owners::new(equations)?, entries: Vec::new(), finite: true, refused: None })
    }
}

/// Node and component of every multiplier equation.
#[derive(Debug)]
struct Owners(Vec<(i64, (usize, usize))>);

impl Owners {
    fn new<const N: usize>(equations: &[[i64; N]]) -> Result<Owners> {
        let of_node = |(a, equations): (usize, &[i64; N])| equations.map(|e| (e, a));
        let all = equations.iter().enumerate().map(of_node);
        let all = all.flat_map(|node| node.into_iter().enumerate().map(|(i, (e, a))| (e, (a, i))));
        let mut all = all.filter(|(equation, _)| *equation != NO_EQUATION).stored()?;
        memory::sort(&mut all)?;
        Ok(Owners(all))
    }

    /// Of an equation that several have, the last one.
    fn get(&self, equation: i64) -> Option<(usize, usize)> {
        let end = self.0.partition_point(|(e, _)| *e <= equation);
        self.0[..end].last().filter(|(e, _)| *e == equation).map(|(_, owner)| *owner)
    }
}

impl Sink for Rows {
    fn add(&mut self, row: i64, column: i64, value: f64) {
        self.finite &= value.is_finite();
        if let Some((node, component)) = self.of.get(row)
            && let Err(error) = self.entries.store((node, column, component, value))
        {
            self.refused.get_or_insert(error);
        }
    }
}

/// The diagnosis of `states` and `suspects` at (x1, x2), whose weights are those of `pairs`.
pub fn diagnosis<const N: usize>(
    given: Given<N>,
    pairs: &[PairRecord],
    (x1, x2): (&[Vec3], &[Vec3]),
    sums: &[NodeSums],
    states: Vec<State>,
    suspects: Vec<Suspect>,
) -> Diagnosis {
    let fraction = |a: usize| sums[a].coverage / given.history().areas[a];
    let covered = (0..states.len()).filter(|&a| fraction(a) > given.setup.options.coverage_min);
    let least_covered = covered.min_by(|&a, &b| fraction(a).total_cmp(&fraction(b))).map(|a| (a, fraction(a)));
    let without_multiplier = given.setup.nonmortar.nodes_without_row();
    let mut diagnosis = Diagnosis {
        states,
        without_multiplier,
        least_covered,
        overlap: None,
        warp: None,
        angle: None,
        error: None,
        turn: Largest::default(),
        suspects,
    };
    worst_pairs(given, pairs, (x1, x2), &mut diagnosis);
    diagnosis
}

fn worst_pairs<const N: usize>(given: Given<N>, pairs: &[PairRecord], (x1, x2): (&[Vec3], &[Vec3]), d: &mut Diagnosis) {
    let ((nonmortar, mortar), options) = (given.setup.surfaces(), &given.setup.options);
    if mortar.analytic.is_some() {
        return;
    }
    // Where the weights are of.
    let (x1, x2) = match given.setup.options.effective_weights() {
        Weights::Current | Weights::Conserving => (x1, x2),
        Weights::Committed | Weights::Reference => given.weighted_at(),
    };
    let mut smallest = None;
    for pair in pairs {
        let (one, two) = (nonmortar.facet(pair.one, x1), mortar.facet(pair.two, x2));
        let facets = [nonmortar.host_facet(pair.one), mortar.host_facet(pair.two)];
        let Ok(frame) = NonmortarFrame::new(&one) else { continue };
        let Ok(Some(segment)) = Segment::new(&frame, &two) else { continue };
        if segment.area == 0.0 {
            continue; // it only touches
        }
        let whole = 0.5 * frame.projection.area2;
        keep(&mut smallest, -segment.area / whole.min(0.5 * segment.mortar.area2), facets);
        keep(&mut d.warp, warp(&one).max(warp(&two)), facets);
        if let Ok(plane) = Plane::of(&two) {
            keep(&mut d.angle, frame.plane.e.cross(&plane.e).norm().atan2(-frame.plane.e.dot(&plane.e)), facets);
        }
        if let (Some(p), Some(q)) = (&nonmortar.parents, &mortar.parents) {
            let by = |rule| p.share(q, (pair.one, pair.two), (&frame, &segment, rule), (x1, x2));
            let (own, fine) = (by(options.rule), by(&DEGREE_10));
            let all = |w: &SubWeights| w.ab.into_iter().chain(w.ac).flatten();
            let apart = all(&own).zip(all(&fine)).map(|(n, m)| (n - m).abs()).fold(0.0, f64::max);
            keep(&mut d.error, apart / whole, facets);
            continue;
        }
        let fine = PairWeights::integrate(&frame, &segment, &DEGREE_10);
        // With dual multipliers the weights that act are not those of the pair alone.
        let own = match given.setup.options.basis {
            MultiplierBasis::Standard => pair.weights,
            MultiplierBasis::Dual => match integrated(given, (pair.one, &frame), &segment, &two) {
                Some(weights) => weights,
                None => continue,
            },
        };
        let (n, m) = (own.ab.iter().chain(&own.ac), fine.ab.iter().chain(&fine.ac));
        let apart = n.flatten().zip(m.flatten()).map(|(n, m)| (n - m).abs()).fold(0.0, f64::max);
        keep(&mut d.error, apart / whole, facets);
    }
    d.overlap = smallest.map(|w: WorstPair| WorstPair { value: -w.value, ..w });
}

/// The weights of a pair as they are integrated; `None` where it is not known whether that is by points: a history of
/// frozen weights does not say so.
fn integrated<const N: usize>(
    given: Given<N>,
    (f, frame): (usize, &NonmortarFrame),
    overlap: &Segment,
    two: &Facet,
) -> Option<PairWeights> {
    let options = &given.setup.options;
    let current = options.effective_weights() == Weights::Current;
    let line = match (options.scheme, &given.step.pairing.filter) {
        (Scheme::Segments, _) => None,
        (Scheme::Elements(line), _) => Some(line),
        (Scheme::Hybrid(_), Some(Filter::Facets(filter))) if current => by_points(options, filter, f),
        (Scheme::Hybrid(_), _) => return None,
    };
    let Some(line) = line else { return Some(PairWeights::integrate(frame, overlap, options.rule)) };
    let points = Segment::of_points(frame, two, line).ok()??;
    Some(PairWeights::integrate(frame, &points, options.rule))
}

/// The nodes and directions in which multiplier rows (nearly) vanish.
pub fn suspects<const N: usize>(
    given: Given<N>,
    rows: Rows,
    sums: &[NodeSums],
    states: &[State],
) -> Result<Vec<Suspect>> {
    let (equations, areas) = (&given.setup.multiplier_equations, &given.history().areas);
    let Rows { of, entries, finite, refused } = rows;
    refused.map_or(Ok(()), Err)?;
    if !finite {
        return Err(overflow());
    }
    let place = |&(node, column, component, _): &(usize, i64, usize, f64)| (node, column, component);
    let entries = memory::sorted(&entries, |p, q| place(p).cmp(&place(q)))?;
    let mut suspects = Vec::new();
    for of_node in entries.chunk_by(|p, q| p.0 == q.0) {
        let a = of_node[0].0;
        let ordinary = given.row_scale(a) * areas[a];
        // The rows' products with each other. A component without an equation is no suspect.
        let mut gram = SMatrix::<f64, N, N>::zeros();
        for i in (0..N).filter(|&i| equations[a][i] == NO_EQUATION) {
            gram[(i, i)] = 1.0;
        }
        for of_column in of_node.chunk_by(|p, q| p.1 == q.1) {
            let is_multiplier = of.get(of_column[0].1).is_some();
            let unit = if is_multiplier { given.augmentation(a) * areas[a] } else { 1.0 };
            let mut v = SVector::<f64, N>::zeros();
            of_column.iter().for_each(|&(_, _, i, value)| v[i] += value * unit / ordinary);
            gram += v * v.transpose();
        }
        if !gram.iter().all(|v| v.is_finite()) {
            return Err(overflow());
        }
        let fraction = sums[a].coverage / areas[a];
        let new = sums[a].coverage_previous <= given.least_coverage(a);
        for (value, direction) in least(given, a, &gram)?.into_iter().take(N) {
            let ratio = value.max(0.0).sqrt();
            if ratio >= SUSPECT {
                continue;
            }
            let cause = match states[a] {
                _ if fraction < LITTLE => Cause::Coverage,
                State::Stick if new => Cause::New,
                _ if ratio < VANISHING => Cause::Prescribed,
                _ => Cause::Other,
            };
            suspects.store(Suspect { node: a, direction, ratio, cause })?;
        }
    }
    memory::sorted(&suspects, |p: &Suspect, q| p.ratio.total_cmp(&q.ratio).then(p.node.cmp(&q.node)))
}

/// Eigenvalues of the products of a node's rows, and their directions in space; the first N are in use.
fn least<const N: usize>(given: Given<N>, a: usize, gram: &SMatrix<f64, N, N>) -> Result<[(f64, Vec3); 3]> {
    if N == 1 {
        return Ok([(gram[(0, 0)], given.normal(a)?); 3]);
    }
    let all = SymmetricEigen::new(nalgebra::Matrix3::from_fn(|i, j| gram[(i, j)]));
    // Of two opposite directions the one whose largest component is positive.
    let signed = |v: Vec3| if v[v.icamax()] < 0.0 { -v } else { v };
    Ok([0, 1, 2].map(|k| (all.eigenvalues[k], signed(all.eigenvectors.column(k).into()))))
}

fn overflow() -> Error {
    Error::new(Kind::NotFinite, "the tangent's rows overflow: the inputs are out of range")
}
