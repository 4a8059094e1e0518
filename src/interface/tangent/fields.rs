//! Fields whose integrals with N_A are gaps of a facet of the host (docs/formulation 12.4, 15.2): positions of the nodes, or their
//! offsets.

use super::parent_table::ParentTable;
use crate::geometry::Vec3;
use crate::interface::data::surface::Surface;
use crate::mortar::{MORTAR, SubMotion};
use crate::shape::MAX_PARENT_NODES;

/// What weights are multiplied with in a gap.
#[derive(Clone, Copy)]
pub enum Fields<'a> {
    /// Positions of the nodes, from `base`; those of the mortar nodes are as they are.
    Positions { one: &'a [Vec3; MAX_PARENT_NODES], base: Vec3 },
    /// Offsets, in the first component; of mortar nodes those of the surface.
    Offsets { one: &'a [Vec3; MAX_PARENT_NODES], two: &'a Surface },
}

impl Fields<'_> {
    /// Of the non-mortar nodes.
    pub fn one(&self) -> &[Vec3; MAX_PARENT_NODES] {
        match self {
            Fields::Positions { one, .. } | Fields::Offsets { one, .. } => one,
        }
    }

    /// Of the nodes of mortar facet g, whose positions are these.
    pub fn two(&self, g: usize, x: &[Vec3; MAX_PARENT_NODES]) -> [Vec3; MAX_PARENT_NODES] {
        match self {
            Fields::Positions { base, .. } => x.map(|x| x - base),
            Fields::Offsets { two, .. } => {
                let Some(parents) = &two.parents else { return [Vec3::zeros(); MAX_PARENT_NODES] };
                let mut h = [Vec3::zeros(); MAX_PARENT_NODES];
                let nodes = parents.facets[g].as_slice();
                nodes.iter().zip(&mut h).for_each(|(&c, h)| h.x = -two.offset(c));
                h
            }
        }
    }

    /// Adds what a pair of parts has to the table.
    pub fn add(
        &self,
        table: &mut ParentTable,
        d: &SubMotion,
        (slots, two): (&[Option<usize>; 2 * MORTAR], &[Option<usize>]),
        rows: &[usize],
    ) {
        match self {
            Fields::Positions { .. } => table.add_motion(d, slots, two, rows),
            Fields::Offsets { .. } => table.add_offsets((d, 1.0), slots, rows),
        }
    }
}
