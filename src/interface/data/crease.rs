//! Nodes on creases of a surface, listed once for each side (docs/formulation 6.5): where the facets around a node look in
//! too many directions their averaged normal means nothing, at an opposing pair it does not even exist.
//!
//! Each copy belongs to one fan of facets that look nearly the same way and has its own normal, gap and multiplier; all
//! copies of a node have its displacement equations. Node numbers and facets stay otherwise as they are.
//!
//! Copies that both stick are six conditions on three displacements, and a surface that sticks on both sides of a
//! crease has a singular tangent: the copies of a split node are to act without friction.

use super::surface::{NO_EQUATION, Surface};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::memory::{self, Store, Stored};
use crate::normal::corner_normal;
use crate::shape::MAX_PARENT_NODES;

/// A surface's facets with nodes of their own on each side of a crease.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// The nodes of the facets, facet after facet, as they were given.
    pub facet_nodes: Vec<usize>,
    /// For each node the one that it is a copy of: itself for the first copy; further copies come behind all nodes, in
    /// the order of what they copy.
    pub originals: Vec<usize>,
}

/// A facet at a node: its number and the normal of its corner there.
#[derive(Clone, Copy)]
struct Corner {
    facet: usize,
    normal: Vec3,
}

/// Two corners of a fan whose facets share an edge at the node.
#[derive(Clone, Copy)]
struct Joint {
    corners: [usize; 2],
    cosine: f64,
}

impl Surface {
    /// Splits nodes until no two corner normals around one of them differ by more than `angle` `[rad]`, in the first
    /// configuration. A fan is cut where its facets meet at more than that, and then, while it spans more, at its
    /// sharpest edge; a node whose facets all look within `angle` stays whole.
    ///
    /// # Errors
    /// [`Kind::InvalidValue`] for an angle that is not between 0 and pi, and for an analytic surface.
    pub fn split_creases(&self, angle: f64) -> Result<Split> {
        if !(angle > 0.0 && angle < std::f64::consts::PI) {
            let text = text!("angle is {angle}; it must be above 0 and below pi (radians)");
            return Err(Error::new(Kind::InvalidValue, text));
        }
        if self.analytic.is_some() {
            return Err(Error::new(Kind::InvalidValue, "an analytic surface has no facets and no creases"));
        }
        let least = angle.cos();
        let mut corners = memory::defaults::<Vec<_>>(self.len())?;
        for f in 0..self.host_facets() {
            for (k, &node) in self.host_nodes(f).iter().enumerate() {
                let normal = match &self.parents {
                    None => corner_normal(&self.facet(f, &self.reference), k),
                    Some(parents) => parents.at(f, &self.reference).normal(k),
                };
                corners[node].store(Corner { facet: f, normal })?;
            }
        }
        let mut edges = memory::defaults::<Vec<_>>(self.len())?;
        for edge in &self.edges {
            // Not those between parts of one facet.
            let facets = edge.facets.map(|f| self.host_facet(f));
            let ends = if edge.nodes[0] == edge.nodes[1] { 1 } else { 2 }; // of a line's node they are the same
            for node in edge.nodes.into_iter().take(ends).filter(|_| facets[0] != facets[1]) {
                edges[node].store(facets)?;
            }
        }
        let own = |f: usize| {
            let mut nodes = [0; MAX_PARENT_NODES];
            self.host_nodes(f).iter().zip(&mut nodes).for_each(|(&from, to)| *to = from);
            nodes
        };
        let mut numbers: Vec<_> = (0..self.host_facets()).map(own).stored()?;
        let mut originals: Vec<_> = (0..self.len()).stored()?;
        for node in 0..self.len() {
            for copy in fans(&corners[node], &edges[node], least)?.iter().skip(1) {
                for &corner in copy {
                    let facet = corners[node][corner].facet;
                    let at = self.host_nodes(facet).iter().position(|&k| k == node);
                    numbers[facet][at.expect("the corner's facet has the node")] = originals.len();
                }
                originals.store(node)?;
            }
        }
        let mut facet_nodes = Vec::new();
        for (f, nodes) in numbers.iter().enumerate() {
            facet_nodes.store_all(nodes.iter().copied().take(self.host_nodes(f).len()))?;
        }
        Ok(Split { facet_nodes, originals })
    }
}

/// Pairs of nodes that have displacement equations in common, both ways round.
pub fn copies(surface: &Surface) -> Result<Vec<[usize; 2]>> {
    let equation = |a: usize| surface.equations[a].iter().copied().find(|&e| e != NO_EQUATION);
    let mut numbered = (0..surface.len()).filter_map(|a| equation(a).map(|e| (e, a))).stored()?;
    memory::sort(&mut numbered)?;
    let mut pairs = Vec::new();
    for of_node in numbered.chunk_by(|p, q| p.0 == q.0) {
        for &(_, a) in of_node {
            pairs.store_all(of_node.iter().filter(|(_, b)| *b != a).map(|&(_, b)| [a, b]))?;
        }
    }
    Ok(pairs)
}

/// The fans of a node's corners, each by the corners' places, the one with the first facet first.
fn fans(corners: &[Corner], edges: &[[usize; 2]], least: f64) -> Result<Vec<Vec<usize>>> {
    let cosine = |i: usize, j: usize| corners[i].normal.dot(&corners[j].normal);
    let narrow = |fan: &[usize]| fan.iter().all(|&i| fan.iter().all(|&j| i == j || cosine(i, j) >= least));
    let place = |facet: usize| corners.binary_search_by_key(&facet, |c| c.facet).expect("an edge's facets are here");
    let joint = |facets: &[usize; 2]| {
        let [i, j] = facets.map(place);
        Joint { corners: [i, j], cosine: cosine(i, j) }
    };
    let joints: Vec<_> = edges.iter().map(joint).filter(|j| j.cosine >= least).stored()?;
    let mut narrow_ones = Vec::new();
    let mut rest = memory::with_room(1)?;
    rest.store(((0..corners.len()).stored()?, joints))?;
    let mut whole = true;
    while let Some((fan, mut joints)) = rest.pop() {
        if narrow(&fan) {
            narrow_ones.store(fan)?;
            continue;
        }
        if !whole {
            // The first one of equals, so that the answer is one.
            let sharpest = (0..joints.len()).reduce(|a, b| if joints[b].cosine < joints[a].cosine { b } else { a });
            joints.remove(sharpest.expect("a fan of more than one corner is held together by joints"));
        }
        whole = false;
        for part in parts(&fan, &joints)? {
            let inside = |j: &Joint| part.contains(&j.corners[0]);
            let kept = joints.iter().copied().filter(inside).stored()?;
            rest.store((part, kept))?;
        }
    }
    let order = memory::order(narrow_ones.len(), &|i, j| narrow_ones[i].cmp(&narrow_ones[j]))?;
    order.into_iter().map(|k| std::mem::take(&mut narrow_ones[k])).stored()
}

/// The parts of a fan that joints hold together, each sorted.
fn parts(fan: &[usize], joints: &[Joint]) -> Result<Vec<Vec<usize>>> {
    let mut left = memory::copied(fan)?;
    let mut parts = Vec::new();
    while let Some(first) = left.pop() {
        let mut part = memory::filled(first, 1)?;
        let mut at = 0;
        while at < part.len() {
            for joint in joints {
                for (from, to) in [(joint.corners[0], joint.corners[1]), (joint.corners[1], joint.corners[0])] {
                    if from == part[at]
                        && let Some(k) = left.iter().position(|&c| c == to)
                    {
                        part.store(left.swap_remove(k))?;
                    }
                }
            }
            at += 1;
        }
        memory::sort(&mut part)?;
        parts.store(part)?;
    }
    Ok(parts)
}
