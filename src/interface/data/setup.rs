//! What an interface is: its surfaces, its options, its equations, and what its host says of the nodes. The same for all
//! positions and all steps.

use super::crease;
use super::effects::Effects;
use super::frame::check_frame;
use super::node_data::{NodeData, Owner};
use super::numbering;
use super::offsets;
use super::options::{MortarSide, Options, Weights};
use super::parents::Parents;
use super::surface::{NO_EQUATION, Surface, frames};
use super::what;
use crate::error::{Error, Kind, Result};
use crate::interface::compose::{self, Feature, Features};
use crate::law::{Layer, Own};
use crate::memory::{self, Store};
use crate::mortar::MultiplierSpace;
use std::ops::Range;

/// What an interface is.
#[derive(Debug)]
pub struct Setup<const N: usize> {
    /// The choices.
    pub options: Options,
    /// What follows from them.
    pub effects: Effects<N>,
    /// The side that has the multipliers.
    pub nonmortar: Surface,
    /// The other side.
    pub mortar: Surface,
    /// Per non-mortar node and component, 0-based or [`NO_EQUATION`].
    pub multiplier_equations: Vec<[i64; N]>,
    /// What the host says of the non-mortar nodes.
    pub nodes: NodeData,
    /// The host's law in place of Coulomb's.
    pub own: Option<Own>,
    /// What lies between the surfaces.
    pub layer: Option<Layer>,
    /// Where points decide or weights are frozen, per node what its own size is to be multiplied by so that it is that of the facets
    /// around it, however many these are.
    pub size_factors: Vec<f64>,
    /// Pairs of non-mortar nodes with the same displacement equations: copies on a crease.
    pub copies: Vec<[usize; 2]>,
}

impl<const N: usize> Setup<N> {
    /// Checks what a host gives; `mu` of every node.
    pub fn new(
        (mut nonmortar, mut mortar): (Surface, Surface),
        multiplier_equations: Vec<[i64; N]>,
        options: Options,
        mu: Vec<f64>,
        effects: Effects<N>,
    ) -> Result<Setup<N>> {
        let holds = mortar.analytic.is_some() || nonmortar.has_mid_nodes() || mortar.has_mid_nodes();
        let options = if holds { options.with_held_points() } else { options };
        options.validate()?;
        if multiplier_equations.len() != nonmortar.len() {
            let text = text!(
                "{} nodes have multiplier equations; nonmortar has {}",
                multiplier_equations.len(),
                nonmortar.len()
            );
            return Err(Error::new(Kind::InvalidSize, text));
        }
        numbering::check(&multiplier_equations, [&nonmortar, &mortar])?;
        if options.mortar_side == MortarSide::Rigid
            && mortar.analytic.is_none()
            && let Some(k) = mortar.equations.iter().position(|e| e.iter().any(|&e| e != NO_EQUATION))
        {
            let text = text!("the mortar side is rigid, but its node {k} has an equation; give it none (-1)");
            return Err(Error::new(Kind::InvalidValue, text));
        }
        if nonmortar.analytic.is_some() {
            let text = "nonmortar is an analytic surface; only the mortar side can be one";
            return Err(Error::new(Kind::InvalidValue, text));
        }
        put_width([&mut nonmortar, &mut mortar])?;
        // Facets that are degenerate, folded or concave are refused, whether they meet a non-mortar facet or not.
        if mortar.analytic.is_none() {
            frames(&mortar, &mortar.reference)?;
        }
        check_frame(&nonmortar, &mortar)?;
        let of_surfaces = what::of_surfaces([&nonmortar, &mortar], options.space);
        compose::refuse(options.features().and(of_surfaces))?;
        put_parents([&mut nonmortar, &mut mortar], &multiplier_equations, options.space)?;
        let nodes = NodeData::new(&multiplier_equations, mu)?;
        let wanted = options.decides_at_points() || options.weights != Weights::Current;
        let size_factors = if wanted { size_factors(&nonmortar, options.space)? } else { Vec::new() };
        let copies = crease::copies(&nonmortar)?;
        Ok(Setup {
            options,
            effects,
            nonmortar,
            mortar,
            multiplier_equations,
            nodes,
            own: None,
            layer: None,
            size_factors,
            copies,
        })
    }

    /// The non-mortar and the mortar surface.
    pub fn surfaces(&self) -> (&Surface, &Surface) {
        (&self.nonmortar, &self.mortar)
    }

    /// What it has that does not go with everything.
    #[inline(never)]
    pub fn features(&self) -> Features {
        self.options.features().and(what::of_surfaces([&self.nonmortar, &self.mortar], self.options.space)).and(
            Features::which(&[
                (Feature::OwnLaw, self.own.is_some()),
                (Feature::Layer, self.layer.is_some()),
                (Feature::LayerSlips, self.layer.as_ref().is_some_and(Layer::slips)),
                (Feature::Orthotropic, matches!(self.own, Some(Own::Orthotropic(_)))),
                (Feature::HostNormals, self.nodes.normals.is_some()),
                (Feature::Offsets, offsets::are_there(self.surfaces())),
                (Feature::MortarOffsets, !self.mortar.offsets.is_empty()),
                (Feature::Elsewhere, self.nodes.owners.contains(&Owner::Elsewhere)),
                (Feature::Shared, self.nodes.owners.contains(&Owner::Shared)),
            ]),
        )
    }

    /// Refuses those of the list that are there, where they do not go with what it has.
    #[inline(never)]
    pub fn refuse(&self, list: &[(Feature, bool)]) -> Result<()> {
        compose::refuse(self.features().and(Features::which(list)))
    }

    /// Whether either side has quadratic facets: gaps and forces are those of parents then.
    pub fn has_parents(&self) -> bool {
        self.nonmortar.parents.is_some()
    }

    /// Whether points decide.
    #[inline]
    pub fn decides_at_points(&self) -> bool {
        self.options.decides_at_points()
    }

    /// Whether answers depend on covered areas.
    pub fn reads_areas(&self) -> bool {
        self.layer.is_some() || self.options.conserves()
    }

    /// Whether all blocks of a tangent are of nodes, none of facets: where points decide, and with conserving weights.
    #[inline]
    pub fn has_blocks_of_nodes(&self) -> bool {
        self.options.decides_at_points() || self.options.conserves()
    }

    /// Whether they do with friction: with three multipliers a node, and only there.
    #[inline]
    pub fn has_point_friction(&self) -> bool {
        N == 3 && self.options.decides_at_points()
    }

    /// Whether anything acts along the normals of the first configuration however far surfaces turn: the pressure with weights of the
    /// reference, and offsets of tied surfaces.
    pub fn acts_along_first_normals(&self) -> bool {
        let options = &self.options;
        options.effective_weights() == Weights::Reference
            && (options.friction.law().opens || offsets::are_there(self.surfaces()))
    }

    /// Whether the frame of an analytic surface has equations.
    pub fn frame_moves(&self) -> bool {
        what::frame_moves(&self.mortar)
    }

    /// Whether the mortar side has rows and columns: its nodes, or the points of its frame.
    pub fn mortar_moves(&self) -> bool {
        self.effects.moves() || self.frame_moves()
    }

    /// Numbers that the law, and what lies between the surfaces, remember of a node.
    pub fn states(&self) -> [usize; 2] {
        [self.own.map_or(0, |own| own.states()), self.layer.as_ref().map_or(0, Layer::states)]
    }

    /// Where those of the law stand of node A.
    pub fn law_states(&self, a: usize) -> Range<usize> {
        let [own, layer] = self.states();
        let first = (own + layer) * a;
        first..first + own
    }

    /// Where those of what lies between the surfaces stand: after them.
    pub fn layer_states(&self, a: usize) -> Range<usize> {
        let [own, layer] = self.states();
        let first = (own + layer) * a + own;
        first..first + layer
    }

    /// What nodes remember that remember so many numbers of a law, and of what lies between the surfaces: of either what `known` has
    /// with these numbers, or zeros.
    pub fn states_of(&self, known: [Option<&[f64]>; 2], new: [usize; 2]) -> Result<Vec<f64>> {
        let mut states = memory::with_room(self.nonmortar.len() * (new[0] + new[1]))?;
        for a in 0..self.nonmortar.len() {
            for (k, (known, of)) in known.iter().zip([self.law_states(a), self.layer_states(a)]).enumerate() {
                match known {
                    Some(known) => states.store_all(known[of].iter().copied())?,
                    None => states.store_all((0..new[k]).map(|_| 0.0))?,
                }
            }
        }
        Ok(states)
    }

    /// Whether a node has a multiplier at all.
    pub fn has_multiplier(&self, a: usize) -> bool {
        self.multiplier_equations[a].iter().any(|&e| e != NO_EQUATION)
    }
}

/// A node on an edge has fewer facets, and less area, than one within. A quarter of each square, a sixth of twice each triangle's area and
/// a half of each line are a node's; with multipliers at all nodes of quadratic facets those of their parts.
fn size_factors(nonmortar: &Surface, space: MultiplierSpace) -> Result<Vec<f64>> {
    let (has_lines, sub) = (nonmortar.lines().is_some(), space == MultiplierSpace::Sub);
    let mut shares = memory::filled(0.0_f64, nonmortar.len())?;
    let mut add = |nodes: &[usize]| {
        let share = [0.5, 1.0 / 6.0, 0.25][nodes.len() - 2];
        nodes.iter().for_each(|&a| shares[a] += share);
    };
    if sub && !has_lines {
        nonmortar.facets.iter().for_each(|facet| add(facet.as_slice()));
    } else {
        for nodes in (0..nonmortar.host_facets()).map(|f| nonmortar.host_nodes(f)) {
            match (nodes, has_lines) {
                (&[first, last, middle], true) if sub => {
                    [[first, middle], [middle, last]].iter().for_each(|ends| add(ends))
                }
                (_, true) => add(&nodes[..2]),
                _ => add(&nodes[..if matches!(nodes.len(), 3 | 6) { 3 } else { 4 }]),
            }
        }
    }
    shares.iter_mut().filter(|share| **share > 0.0).for_each(|share| {
        *share = if has_lines { 1.0 / *share } else { 1.0 / share.sqrt() };
    });
    Ok(shares)
}

/// Gives lines of both sides the same width: the shortest of their parts' lengths, so that no edge is longer than the line that it
/// belongs to.
fn put_width([one, two]: [&mut Surface; 2]) -> Result<()> {
    if let Some(shape) = two.analytic {
        let text = match (one.lines().is_some(), shape.is_in_plane()) {
            (true, false) => text!("mortar is {shape} in space, nonmortar has lines: one side is of another model"),
            (false, true) => {
                text!("mortar is {shape} in a plane, nonmortar lies in space: one side is of another model")
            }
            _ => return Ok(()),
        };
        return Err(Error::new(Kind::InvalidValue, text));
    }
    let [of_one, of_two] = [one, two].map(|side| side.parents.as_mut().and_then(|parents| parents.lines.as_mut()));
    match (of_one, of_two) {
        (None, None) => Ok(()),
        (Some(of_one), Some(of_two)) if of_one.measure == of_two.measure => {
            let width = of_one.width.min(of_two.width);
            (of_one.width, of_two.width) = (width, width);
            Ok(())
        }
        _ => Err(Error::new(
            Kind::InvalidValue,
            "one side is of another model than the other one, or has another thickness",
        )),
    }
}

/// Where either side has quadratic facets, gives both sides parents and puts the multipliers where the options say.
fn put_parents<const N: usize>(
    sides: [&mut Surface; 2],
    multiplier_equations: &[[i64; N]],
    space: MultiplierSpace,
) -> Result<()> {
    if sides.iter().all(|side| side.parents.is_none()) {
        return Ok(());
    }
    let [nonmortar, mortar] = sides;
    let kind = if nonmortar.lines().is_some() { "lines" } else { "quadratic facets" };
    for side in [&mut *nonmortar, &mut *mortar] {
        if side.parents.is_none() {
            side.parents = Some(Parents::of_linear(&side.facets)?);
        }
    }
    let Some(parents) = &mut nonmortar.parents else { return Ok(()) };
    parents.put(space)?;
    let has_row = &parents.has_row;
    let numbered = |a: &usize| !has_row[*a] && multiplier_equations[*a].iter().any(|&e| e != NO_EQUATION);
    match (0..has_row.len()).find(numbered) {
        None => Ok(()),
        Some(a) => {
            let text = text!(
                "non-mortar node {a} has a multiplier's equation, but multipliers of {kind} stand at their corners; give it none (-1), or take STICKSLIP_SPACE_SUB"
            );
            Err(Error::new(Kind::InvalidValue, text))
        }
    }
}
