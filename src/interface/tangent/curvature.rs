//! How the gradients m_A Dg_A of the mean gaps change with the places, times lambda_A, and that of their products with what moves
//! (docs/formulation 21). What
//! weights have are differences of their derivatives, facet by facet with normals held; normals have it in closed form, but for those of
//! corners, which are differences, too.

use super::conserving_numbers::Curvature;
use super::gaps::{GapRoom, all};
use super::union::{UnionPair, Walk};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::conserving::{Conserving, NodeGap};
use crate::interface::data::surface::NO_EQUATION;
use crate::interface::pairing::given::Given;
use crate::interface::stages::again::again;
use crate::memory::{self, Store};
use crate::mortar::Segment;
use crate::shape::MAX_PARENT_NODES;

/// Step of the differences, over a node's size: its square, and the roundings of a derivative over it, are as small.
const STEP: f64 = 1e-5;

/// Where they are made.
#[derive(Debug, Default)]
struct Room<const N: usize> {
    near: Active,
    gaps: GapRoom<N>,
    segments: Vec<Segment>,
    pairs: Vec<UnionPair>,
}

impl Curvature {
    /// Of nodes with these lambda_N.
    pub fn of<const N: usize>(given: Given<N>, known: &Conserving, lambda: &[f64]) -> Result<Curvature> {
        let mut made = Curvature { blocks: memory::defaults(lambda.len())?, along: Vec::new() };
        for mean in &known.gaps[1] {
            made.along.store(memory::filled(Vec3::zeros(), mean.nodes.len())?)?;
        }
        if lambda.iter().all(|l| *l == 0.0) {
            return Ok(made);
        }
        let mut room = Room::default();
        room.near.begin(&known.mean.x1, &known.mean.x2)?;
        memory::recopy(&mut room.near.normals, &known.mean.normals)?;
        room.gaps.begin(given)?;
        let (mut walk, mut pairs) = (Walk::through(all(given, &known.mean), 0..usize::MAX), Vec::new());
        while let Some(f) = walk.next(&mut pairs)? {
            let nodes = given.setup.nonmortar.host_nodes(f);
            if nodes.iter().take(given.setup.nonmortar.multipliers(f)).any(|&a| lambda[a] != 0.0) {
                made.weights((given, known, lambda), (f, &pairs), &mut room)?;
            }
        }
        for f in 0..given.setup.nonmortar.host_facets() {
            made.corners((given, known, lambda), f)?;
        }
        for (a, mean) in known.gaps[1].iter().enumerate().filter(|(a, _)| lambda[*a] != 0.0) {
            made.normals((a, mean, lambda[a]), &known.forces[a].moved)?;
            made.areas((a, mean, lambda[a]), &known.forces[a].moved)?;
        }
        Ok(made)
    }

    /// Adds a block of D^2 g_A.
    fn add(&mut self, (a, lambda): (usize, f64), of: (&NodeGap, &[Vec3]), at: [usize; 2], block: Mat3) -> Result<()> {
        let place = |node: usize| of.0.nodes.iter().position(|on| on.node == node);
        if let [Some(row), Some(column)] = at.map(place) {
            self.along[a][column] += block.tr_mul(&of.1[row]);
        }
        self.blocks[a].store((at, block * lambda))
    }

    /// nu_A . D^2 g[n, x]_A over a facet.
    fn weights<const N: usize>(
        &mut self,
        (given, known, lambda): (Given<N>, &Conserving, &[f64]),
        (f, pairs): (usize, &[UnionPair]),
        Room { near, gaps, segments, pairs: found }: &mut Room<N>,
    ) -> Result<()> {
        let ((one, two), options) = (given.setup.surfaces(), &given.setup.options);
        let filter = given.step.pairing.filter.as_ref().expect("weights of now have one");
        let (own, n1, mean) = (one.host_nodes(f), one.len(), &known.gaps[1]);
        let multipliers = one.multipliers(f);
        let mut nodes: Vec<usize> = Vec::new();
        gaps.each(given, (&known.mean, pairs), &mut |k, (node, _), _, _| {
            if k == 0 { nodes.store(node) } else { Ok(()) }
        })?;
        let first = known.mean.pairs.partition_point(|pair| one.host_facet(pair.one) < f);
        let end = known.mean.pairs.partition_point(|pair| one.host_facet(pair.one) <= f);
        let of_facet = &known.mean.pairs[first..end];
        let step = STEP * given.size(own[0]);
        let components = if one.lines().is_some() { 2 } else { 3 };
        // [multiplier][row]: the columns of a node.
        let mut blocks = memory::filled(Mat3::zeros(), multipliers * nodes.len())?;
        for &node in &nodes {
            let (surface, at) = node.checked_sub(n1).map_or((one, node), |c| (two, c));
            let moves = own.iter().take(multipliers).any(|&a| {
                mean[a].nodes.iter().zip(&known.forces[a].moved).any(|(on, u)| on.node == node && *u != Vec3::zeros())
            });
            if !moves && surface.equations[at].iter().all(|&e| e == NO_EQUATION) {
                continue;
            }
            memory::refill(&mut blocks, Mat3::zeros(), multipliers * nodes.len())?;
            for j in 0..components {
                let place = |near: &mut Active, by: f64| {
                    let x = if node < n1 { &mut near.x1[at] } else { &mut near.x2[at] };
                    x[j] += by;
                };
                for sign in [1.0, -1.0] {
                    let before = if node < n1 { near.x1[at] } else { near.x2[at] };
                    place(near, sign * step);
                    again((one, two), (options, filter), of_facet, near, segments)?;
                    let mut walk = Walk::through(all(given, near), f..f + 1);
                    if walk.next(found)?.is_some() {
                        gaps.each(given, (&*near, &*found), &mut |k, (row, _), gap, area| {
                            if let Some(row) = nodes.iter().position(|known| *known == row) {
                                let of = &mean[own[k]];
                                let slope = (gap.tr_mul(&of.normal) - area * of.mean()) * (sign / (2.0 * step));
                                let mut column = blocks[k * nodes.len() + row].column_mut(j);
                                column += slope;
                            }
                            Ok(())
                        })?;
                    }
                    *(if node < n1 { &mut near.x1[at] } else { &mut near.x2[at] }) = before;
                }
            }
            for (k, &a) in own.iter().enumerate().take(multipliers).filter(|(_, a)| lambda[**a] != 0.0) {
                for (r, &row) in nodes.iter().enumerate() {
                    let of = (&mean[a], &known.forces[a].moved[..]);
                    self.add((a, lambda[a]), of, [row, node], blocks[k * nodes.len() + r])?;
                }
            }
        }
        Ok(())
    }

    /// g . (d nu / d sum) D^2 sum over a facet.
    fn corners<const N: usize>(
        &mut self,
        (given, known, lambda): (Given<N>, &Conserving, &[f64]),
        f: usize,
    ) -> Result<()> {
        let one = &given.setup.nonmortar;
        let nodes = one.host_nodes(f);
        let acting = |a: usize| lambda[a] != 0.0 && known.gaps[1][a].turn != Mat3::zeros();
        if !nodes.iter().take(one.multipliers(f)).any(|&a| acting(a)) {
            return Ok(());
        }
        let mut x = memory::copied(&known.mean.x1)?;
        for (k, &a) in nodes.iter().enumerate().take(one.multipliers(f)).filter(|(_, a)| acting(**a)) {
            let mean = &known.gaps[1][a];
            let mut rows = Mat3::zeros();
            rows.set_row(0, &mean.turn.tr_mul(&mean.gap).transpose());
            let step = STEP * given.size(a);
            for &node in nodes {
                let mut blocks = [Mat3::zeros(); MAX_PARENT_NODES];
                for (j, sign) in (0..3).flat_map(|j| [(j, 1.0), (j, -1.0)]) {
                    let before = x[node];
                    x[node][j] += sign * step;
                    for (l, d) in one.normal_derivatives((f, k), &x, &rows).as_slice() {
                        let mut column = blocks[*l].column_mut(j);
                        column += d.row(0).transpose() * (sign / (2.0 * step));
                    }
                    x[node] = before;
                }
                for (&row, block) in nodes.iter().zip(&blocks) {
                    self.add((a, lambda[a]), (mean, &known.forces[a].moved), [row, node], *block)?;
                }
            }
        }
        Ok(())
    }

    /// How the gap turns that what is covered counts with.
    fn areas(&mut self, (a, mean, lambda): (usize, &NodeGap, f64), moved: &[Vec3]) -> Result<()> {
        for on in mean.nodes.iter().filter(|on| on.area != Vec3::zeros()) {
            for by in &mean.nodes {
                let block = on.area * (mean.slope(by, mean.mean()) / -mean.coverage).transpose();
                self.add((a, lambda), (mean, moved), [on.node, by.node], block)?;
            }
        }
        Ok(())
    }

    /// Dnu . Dg + Dg . Dnu + g . (d^2 nu / d sum^2) Dsum Dsum.
    fn normals(&mut self, (a, mean, lambda): (usize, &NodeGap, f64), moved: &[Vec3]) -> Result<()> {
        if mean.turn == Mat3::zeros() {
            return Ok(());
        }
        let norm = mean.sum.norm();
        let along = mean.sum / norm;
        let free = mean.turn * -norm; // the free directions across nu
        let across = free * mean.gap;
        for on in &mean.nodes {
            for by in &mean.nodes {
                let (turned, turned_by) = (mean.turned(on), mean.turned(by));
                let mut block = turned.tr_mul(&by.gap) + on.gap.tr_mul(&turned_by);
                let (s, t) = (on.sum.tr_mul(&along), by.sum.tr_mul(&along));
                let (s_across, t_across) = (on.sum.tr_mul(&across), by.sum.tr_mul(&across));
                let both = (free * on.sum).tr_mul(&(free * by.sum)) * along.dot(&mean.gap);
                block += (s_across * t.transpose() + s * t_across.transpose() + both) / (norm * norm);
                if block != Mat3::zeros() {
                    self.add((a, lambda), (mean, moved), [on.node, by.node], block)?;
                }
            }
        }
        Ok(())
    }
}
