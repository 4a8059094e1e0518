//! Copies of a node on a crease (docs/formulation.md 6.5), and what each of them does in a step. Settled by t_n.
//!
//! Copies share displacements. Where two of them touch different faces, as in a corner, two normals hold the node, and a third condition,
//! of sticking, would be one of the two again: the matrix is singular. So a copy acts without friction in a step in which another one may
//! be in contact, too; one that is alone in contact has friction as any other node.
//!
//! Where they have the same face opposite, dual gaps are the gap of the one point, in all copies: one condition, several multipliers.
//! A side that stands off that face stays open where another side lies on it. Where all stand off, the edge itself touches: one copy
//! carries the others, with the mean of their normals.

use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::history::History;
use crate::interface::data::setup::Setup;
use crate::interface::pairing::weak::Carrier;
use crate::memory::{self, Store, Stored};
use crate::normal::SMALLEST_SUM;

/// A copy that is farther open than so many facets at t_n is not taken to close within the step: where the sides of an edge lean over the
/// other surface by 40 degrees it is open by 0.4.
const FACETS: f64 = 0.2;
/// cos 20 degrees: a side lies on a face that it encloses no larger angle with. Of two sides that differ by the angle from which on the
/// driver splits, 40 degrees, not more than one does.
const LIES_ON: f64 = 0.939_692_620_785_908_4;
/// cos 45 degrees: faces that differ by no more are one face.
const ONE_FACE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// What the copies do.
#[derive(Debug, Default)]
pub struct Corners {
    /// Per node, whether it acts without friction for the sake of a copy; empty where none does.
    pub frictionless: Vec<bool>,
    /// Per node, whether it stays open, since a copy lies on what it would meet; empty where none does.
    pub open: Vec<bool>,
    /// Copies that carry others, in ascending order, each with its nu of the step.
    pub normals: Vec<(usize, Vec3)>,
}

impl Corners {
    /// Those of a step. Adds copies that others carry to `carriers`.
    pub fn settle<const N: usize>(
        (setup, h): (&Setup<N>, &History),
        coverable: &[bool],
        carriers: &mut Vec<Vec<Carrier>>,
    ) -> Result<Corners> {
        let mut corners = Corners::default();
        if setup.copies.is_empty() || !h.integrated {
            return Ok(corners);
        }
        let least = setup.options.coverage_min;
        let touches = |a: usize| coverable[a] && h.coverage[a] > least * h.areas[a] && setup.has_multiplier(a);
        if setup.options.tells_copies_apart() {
            let faces = opposite(setup, h)?;
            let of_side = |a: usize| faces[a].filter(|_| touches(a)).map(|face| Side { node: a, face });
            for group in setup.copies.chunk_by(|p, q| p[0] == q[0]).filter(|group| group[0][0] < group[0][1]) {
                let nodes = std::iter::once(group[0][0]).chain(group.iter().map(|p| p[1]));
                corners.tell_apart(&nodes.filter_map(of_side).stored()?, h, carriers)?;
            }
        }
        if setup.effects.law.slips {
            let mut frictionless = memory::filled(false, coverable.len())?;
            let stands_in = |b: usize| !corners.is_open(b) && carriers.get(b).is_none_or(Vec::is_empty);
            let surface = &setup.nonmortar;
            let near = |b: usize| height(h, b) <= FACETS * surface.size(h.areas[b], h.x1[b]);
            for &[a, b] in &setup.copies {
                frictionless[a] |= touches(b) && stands_in(b) && near(b);
            }
            corners.frictionless = frictionless;
        }
        Ok(corners)
    }

    /// Of the copies of one node that may touch.
    fn tell_apart(&mut self, sides: &[Side], h: &History, carriers: &mut Vec<Vec<Carrier>>) -> Result<()> {
        let lies = |side: &Side| side.face.dot(&h.normals[side.node]) >= LIES_ON;
        let mut edge: Vec<&Side> = Vec::new();
        for side in sides.iter().filter(|side| !lies(side)) {
            if sides.iter().any(|other| lies(other) && other.face.dot(&side.face) >= ONE_FACE) {
                if self.open.is_empty() {
                    self.open = memory::filled(false, h.x1.len())?;
                }
                self.open[side.node] = true;
            } else {
                edge.store(side)?;
            }
        }
        while let Some(first) = edge.pop() {
            let has_it_too = |side: &&Side| side.face.dot(&first.face) >= ONE_FACE;
            let others = edge.iter().copied().filter(has_it_too).stored()?;
            edge.retain(|side| !has_it_too(side));
            let sum = others.iter().fold(h.normals[first.node], |sum, side| sum + h.normals[side.node]);
            if !others.is_empty() && sum.norm() > SMALLEST_SUM {
                self.normals.store((first.node, sum.normalize()))?;
                others.iter().try_for_each(|side| hand_over(carriers, side.node, first.node, h.x1.len()))?;
            }
        }
        Ok(())
    }

    /// Whether a node stays open in the step.
    pub fn is_open(&self, a: usize) -> bool {
        self.open.get(a).is_some_and(|open| *open)
    }

    /// nu of the step of a node that carries copies.
    pub fn normal(&self, a: usize) -> Option<Vec3> {
        self.normals.iter().find(|(node, _)| *node == a).map(|(_, normal)| *normal)
    }
}

/// A copy that may touch, with the normal of the face opposite, as nu into the non-mortar body.
struct Side {
    node: usize,
    face: Vec3,
}

/// The gap of a covered node along nu at t_n `[L]`.
fn height(h: &History, a: usize) -> f64 {
    h.gap[a].dot(&h.normals[a]) / h.coverage[a]
}

/// Per node the normal of what the corners of its facets have opposite, the surface of the points x - g / m; none where too little is covered.
fn opposite<const N: usize>(setup: &Setup<N>, h: &History) -> Result<Vec<Option<Vec3>>> {
    let covered = |a: usize| h.coverage[a] > setup.options.coverage_min * h.areas[a];
    let unknown = Vec3::repeat(f64::NAN); // a corner with such a neighbour has no normal
    let point = |a: usize| if covered(a) { h.x1[a] - h.gap[a] / h.coverage[a] } else { unknown };
    let points = (0..h.x1.len()).map(point).stored()?;
    let sums = setup.nonmortar.sums_of_normals(&points)?;
    sums.into_iter().map(|sum| (sum.norm() > SMALLEST_SUM).then(|| -sum.normalize())).stored()
}

/// `from` and all that it carries are carried by `to`, or by who carries that.
fn hand_over(carriers: &mut Vec<Vec<Carrier>>, from: usize, to: usize, n: usize) -> Result<()> {
    if carriers.is_empty() {
        *carriers = memory::defaults(n)?;
    }
    let heirs = if carriers[to].is_empty() { memory::filled((to, 1.0), 1)? } else { memory::copied(&carriers[to])? };
    for a in 0..n {
        if let Some(k) = carriers[a].iter().position(|&(b, _)| b == from) {
            let (_, share) = carriers[a].swap_remove(k);
            for &(b, w) in &heirs {
                match carriers[a].iter_mut().find(|(c, _)| *c == b) {
                    Some(known) => known.1 += share * w,
                    None => carriers[a].store((b, share * w))?,
                }
            }
            carriers[a].sort_unstable_by_key(|&(b, _)| b);
        }
    }
    carriers[from] = heirs;
    Ok(())
}
