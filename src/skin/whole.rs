//! What a host hands over once: the skin of all bodies, cut at creases in the first configuration.

use crate::adjacency::{Lists, root};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::{NO_EQUATION, Surface, backs};
use crate::line::Measure;
use crate::memory::{self, Store, Stored};
use crate::mortar::NonmortarFrame;

/// Edges sharper than this part the skin into faces, in radians: 40 degrees.
const CREASE: f64 = 0.7;

/// What is wrong with a skin is told under this name.
const NAME: &str = "skin";

/// The skin of all bodies.
#[derive(Debug)]
pub struct Whole {
    /// Cut at creases: its nodes are the copies.
    pub surface: Surface,
    /// Per copy the node of the host that it is a copy of.
    pub originals: Vec<usize>,
    /// How many nodes the host has.
    pub nodes: usize,
    /// Per facet of the host the number of its body, from 0.
    pub bodies: Vec<usize>,
    /// The numbers that the host has for the bodies.
    pub body_keys: Vec<i64>,
    /// Multiplier equations per copy.
    pub multipliers: Vec<[i64; 3]>,
    /// Per facet of the host a number that the facets of a face, between creases, have in common.
    pub faces: Vec<usize>,
    /// Per facet of the host its area in the first configuration `[L^2]`.
    pub areas: Vec<f64>,
    /// Per copy the facets of the host around it.
    pub around: Lists<usize>,
    /// What lines are; `None`: the skin is in space.
    pub measure: Option<Measure>,
}

/// What a host gives.
#[derive(Debug)]
pub struct Given {
    /// Node positions of the first configuration.
    pub x: Vec<Vec3>,
    /// Node numbers of the facets, from 0.
    pub facets: Vec<Vec<i64>>,
    /// Displacement equations.
    pub equations: Vec<[i64; 3]>,
    /// Per facet the number of its body; `None`: what hangs together is one.
    pub bodies: Option<Vec<i64>>,
    /// The first multiplier equation.
    pub first: i64,
    /// What lines are.
    pub measure: Option<Measure>,
    /// Whether quadratic facets have multipliers at all of their nodes.
    pub all_nodes: bool,
}

impl Whole {
    /// Checks a skin, and cuts it.
    pub fn new(given: Given) -> Result<Whole> {
        let Given { x, facets, equations, bodies, first, measure, all_nodes } = given;
        let nodes = x.len();
        let build = |x: Vec<Vec3>, facets: &[Vec<i64>], equations| match measure {
            None => Surface::new(NAME, x, facets, equations),
            Some(measure) => Surface::of_lines(NAME, x, facets, equations, measure),
        };
        let uncut = build(x, &facets, equations)?;
        let (bodies, body_keys) = number_bodies(&uncut, bodies)?;
        let cut = uncut.split_creases(CREASE)?;
        let (mut at, mut anew) = (0, memory::with_room(facets.len())?);
        for nodes in &facets {
            let of_facet = &cut.facet_nodes[at..at + nodes.len()];
            anew.store(of_facet.iter().map(|&a| a as i64).stored()?)?;
            at += nodes.len();
        }
        let originals = cut.originals;
        let of_copies = |values: &[[i64; 3]]| originals.iter().map(|&a| values[a]).stored();
        let x = originals.iter().map(|&a| uncut.reference[a]).stored()?;
        let mut surface = build(x, &anew, of_copies(&uncut.equations)?)?;
        check_facets(&surface)?;
        let is_same = |f: usize, g: usize| bodies[surface.host_facet(f)] == bodies[surface.host_facet(g)];
        surface.backs = backs(&surface, &is_same)?;
        let (multipliers, around) = (number(&surface, first, all_nodes)?, facets_around(&surface)?);
        let (faces, mut areas) = (number_faces(&surface)?, memory::filled(0.0, surface.host_facets())?);
        for f in 0..surface.facets.len() {
            areas[surface.host_facet(f)] += 0.5 * surface.facet(f, &surface.reference).area_vector().norm();
        }
        Ok(Whole { surface, originals, nodes, bodies, body_keys, multipliers, faces, areas, around, measure })
    }

    /// Facets of the host.
    pub fn facets(&self) -> usize {
        self.areas.len()
    }

    /// Copies.
    pub fn copies(&self) -> usize {
        self.originals.len()
    }

    /// Components of a vector: of lines two.
    pub fn components(&self) -> usize {
        if self.measure.is_some() { 2 } else { 3 }
    }

    /// Refuses positions of the host's nodes that are no such.
    pub fn check(&self, x: &[Vec3]) -> Result<()> {
        if x.len() != self.nodes {
            return Err(Error::new(Kind::InvalidSize, text!("x has {} nodes; the skin has {}", x.len(), self.nodes)));
        }
        match x.iter().position(|x| !x.iter().all(|v| v.is_finite())) {
            None => Ok(()),
            Some(a) => Err(Error::new(Kind::NotFinite, text!("x of node {a} is not finite"))),
        }
    }

    /// Where the copies are.
    pub fn places(&self, x: &[Vec3]) -> Result<Vec<Vec3>> {
        self.originals.iter().map(|&a| x[a]).stored()
    }

    /// Whether any node of a facet has an equation.
    pub fn moves(&self, f: usize) -> bool {
        self.surface.host_nodes(f).iter().any(|&a| self.surface.equations[a].iter().any(|&e| e != NO_EQUATION))
    }
}

/// Refuses linear facets that have no area, are folded or are not convex, be they in no piece yet.
fn check_facets(surface: &Surface) -> Result<()> {
    if surface.parents.is_none() && surface.lines().is_none() {
        for f in 0..surface.facets.len() {
            NonmortarFrame::new(&surface.facet(f, &surface.reference)).map_err(surface.at(f))?;
        }
    }
    Ok(())
}

/// Numbers of the bodies, from 0, in the order of their first facets; and what the host calls them, if it does.
fn number_bodies(surface: &Surface, given: Option<Vec<i64>>) -> Result<(Vec<usize>, Vec<i64>)> {
    let (n, is_given) = (surface.host_facets(), given.is_some());
    let keys = match given {
        Some(given) if given.len() != n => {
            let text = text!("bodies has {} entries; the skin has {n} facets", given.len());
            return Err(Error::new(Kind::InvalidSize, text));
        }
        Some(given) => given,
        None => {
            let mut parent = (0..surface.len()).stored()?;
            for nodes in (0..n).map(|f| surface.host_nodes(f)) {
                let first = root(&mut parent, nodes[0]);
                for &node in &nodes[1..] {
                    let other = root(&mut parent, node);
                    parent[other] = first;
                }
            }
            (0..n).map(|f| root(&mut parent, surface.host_nodes(f)[0]) as i64).stored()?
        }
    };
    let order = memory::order(n, &|f, g| keys[f].cmp(&keys[g]))?;
    let firsts = order.chunk_by(|&f, &g| keys[f] == keys[g]).map(|same| (same[0], keys[same[0]])).stored()?;
    let mut in_order = firsts;
    memory::sort(&mut in_order)?;
    let mut bodies = memory::filled(0, n)?;
    for same in order.chunk_by(|&f, &g| keys[f] == keys[g]) {
        let number = in_order.partition_point(|first| first.0 < same[0]);
        same.iter().for_each(|&f| bodies[f] = number);
    }
    let called = |(k, first): (usize, &(usize, i64))| if is_given { first.1 } else { k as i64 };
    let keys = in_order.iter().enumerate().map(called).stored()?;
    Ok((bodies, keys))
}

/// Multiplier equations of all copies that a facet has a multiplier at, one after the other from `first`.
fn number(surface: &Surface, first: i64, all_nodes: bool) -> Result<Vec<[i64; 3]>> {
    let components = if surface.lines().is_some() { 2 } else { 3 };
    let mut has = memory::filled(false, surface.len())?;
    for nodes in (0..surface.host_facets()).map(|f| surface.host_nodes(f)) {
        let corners = if components == 2 { 2 } else { [3, 4][usize::from(!matches!(nodes.len(), 3 | 6))] };
        let rows = if all_nodes { nodes.len() } else { corners };
        nodes[..rows].iter().for_each(|&a| has[a] = true);
    }
    let needed = has.iter().filter(|has| **has).count() * components;
    if first < 0 || first.checked_add(needed as i64).is_none() {
        let text =
            text!("first_multiplier is {first} from 0 on; there are no numbers for the {needed} equations that follow");
        return Err(Error::new(Kind::InvalidValue, text));
    }
    let mut next = first;
    let mut number = |has: bool| {
        let mut equations = [NO_EQUATION; 3];
        for equation in equations.iter_mut().take(if has { components } else { 0 }) {
            *equation = next;
            next += 1;
        }
        equations
    };
    let numbered = has.into_iter().map(&mut number).stored()?;
    let taken = surface.equations.as_flattened().iter().find(|&&e| e >= first && e < next);
    match taken {
        None => Ok(numbered),
        Some(e) => {
            let text =
                text!("multipliers take the equations {first} to {}, and {e} is that of a displacement", next - 1);
            Err(Error::new(Kind::InvalidValue, text))
        }
    }
}

/// Per copy the facets of the host around it.
fn facets_around(surface: &Surface) -> Result<Lists<usize>> {
    Lists::around(surface.len(), surface.host_facets(), |f| surface.host_nodes(f))
}

/// Per facet of the host the smallest number of any facet of its face.
fn number_faces(surface: &Surface) -> Result<Vec<usize>> {
    let mut parent = (0..surface.host_facets()).stored()?;
    for edge in &surface.edges {
        let [f, g] = edge.facets.map(|f| surface.host_facet(f));
        let [f, g] = [root(&mut parent, f), root(&mut parent, g)];
        parent[f.max(g)] = f.min(g);
    }
    (0..surface.host_facets()).map(|f| root(&mut parent, f)).stored()
}
