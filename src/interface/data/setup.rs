//! What an interface is: its surfaces, its options, its equations, and what its host says of the nodes. The same for all
//! positions and all steps.

use super::effects::Effects;
use super::frame::check_frame;
use super::node_data::NodeData;
use super::numbering;
use super::options::{MortarSide, Options};
use super::surface::{NO_EQUATION, Surface, frames};
use crate::error::{Error, Kind, Result};

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
}

impl<const N: usize> Setup<N> {
    /// Checks what a host gives; `mu` of every node.
    pub fn new(
        (nonmortar, mortar): (Surface, Surface),
        multiplier_equations: Vec<[i64; N]>,
        options: Options,
        mu: Vec<f64>,
        effects: Effects<N>,
    ) -> Result<Setup<N>> {
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
            && let Some(k) = mortar.equations.iter().position(|e| e.iter().any(|&e| e != NO_EQUATION))
        {
            let text = text!("the mortar side is rigid, but its node {k} has an equation; give it none (-1)");
            return Err(Error::new(Kind::InvalidValue, text));
        }
        if nonmortar.analytic.is_some() {
            let text = "nonmortar is an analytic surface; only the mortar side can be one";
            return Err(Error::new(Kind::InvalidValue, text));
        }
        // Facets that are degenerate, folded or concave are refused, whether they meet a non-mortar facet or not.
        if mortar.analytic.is_none() {
            frames(&mortar, &mortar.reference)?;
        }
        check_frame(&nonmortar, &mortar)?;
        let nodes = NodeData::new(&multiplier_equations, mu)?;
        Ok(Setup { options, effects, nonmortar, mortar, multiplier_equations, nodes })
    }

    /// The non-mortar and the mortar surface.
    pub fn surfaces(&self) -> (&Surface, &Surface) {
        (&self.nonmortar, &self.mortar)
    }

    /// Whether a node has a multiplier at all.
    pub fn has_multiplier(&self, a: usize) -> bool {
        self.multiplier_equations[a].iter().any(|&e| e != NO_EQUATION)
    }
}
