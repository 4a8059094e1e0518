//! An interface cut into parts, each with a handle of its own: a part owns nodes and holds the facets around them.
#![allow(dead_code)]

use super::mesh::{Create, Mesh};
use super::parents::has_row;
use nalgebra::SVector;
use stickslip::error::Result;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, NO_EQUATION, Options, Owner, Surface};

/// A part of an interface.
pub struct Part<const N: usize> {
    pub contact: Contact<N>,
    /// The whole's numbers of its nodes, non-mortar and mortar.
    pub nodes: [Vec<usize>; 2],
    /// Of its non-mortar nodes, which are its own.
    pub own: Vec<bool>,
}

impl<const N: usize> Part<N> {
    /// What the part has of the whole's values on one side.
    pub fn of<T: Copy>(&self, side: usize, whole: &[T]) -> Vec<T> {
        self.nodes[side].iter().map(|&k| whole[k]).collect()
    }

    /// Its positions and multipliers.
    pub fn at(
        &self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
    ) -> (Vec<Vec3>, Vec<Vec3>, Vec<SVector<f64, N>>) {
        (self.of(0, x1), self.of(1, x2), self.of(0, lambda))
    }
}

/// Facets that have any of these nodes, then those that share a node with any of them, and so on: so many rings.
pub fn rings(mesh: &Mesh, mut nodes: Vec<bool>, rings: usize) -> Vec<usize> {
    let mut kept = vec![false; mesh.facets.len()];
    for _ in 0..rings {
        let met = nodes.clone();
        for (f, facet) in mesh.facets.iter().enumerate() {
            if facet.iter().any(|&k| met[k as usize]) {
                kept[f] = true;
                facet.iter().for_each(|&k| nodes[k as usize] = true);
            }
        }
    }
    (0..kept.len()).filter(|&f| kept[f]).collect()
}

/// These facets of a mesh as one of their own, with the numbers of its nodes in the whole.
pub fn submesh(mesh: &Mesh, facets: &[usize]) -> (Mesh, Vec<usize>) {
    let mut nodes: Vec<usize> = facets.iter().flat_map(|&f| mesh.facets[f].iter().map(|&k| k as usize)).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let here = |k: &i64| nodes.binary_search(&(*k as usize)).unwrap() as i64;
    let facets = facets.iter().map(|&f| mesh.facets[f].iter().map(here).collect()).collect();
    (Mesh { x: nodes.iter().map(|&k| mesh.x[k]).collect(), facets }, nodes)
}

/// The part that owns these nodes, with so many rings of non-mortar facets around them and these mortar facets. Equations as
/// those of the whole in `mesh::contact`.
pub fn part<const N: usize>(
    (one, two): (&Mesh, &Mesh),
    options: Options,
    (own, around): (Vec<bool>, usize),
    opposite: &[usize],
) -> Result<Part<N>>
where
    Contact<N>: Create<N>,
{
    let (n1, n2) = (one.x.len(), two.x.len());
    let (mesh1, nodes1) = submesh(one, &rings(one, own.clone(), around));
    let (mesh2, nodes2) = submesh(two, opposite);
    let displacements =
        |first: usize, nodes: &[usize]| nodes.iter().map(|k| [0, 1, 2].map(|i| (first + 3 * k + i) as i64)).collect();
    let has_row = has_row(one, options.space);
    let multiplier = |k: usize, i: usize| if has_row[k] { (3 * (n1 + n2) + N * k + i) as i64 } else { NO_EQUATION };
    let multipliers = nodes1.iter().map(|&k| std::array::from_fn(|i| multiplier(k, i))).collect();
    let nonmortar = Surface::new("nonmortar", mesh1.x, &mesh1.facets, displacements(0, &nodes1))?;
    let mortar = Surface::new("mortar", mesh2.x, &mesh2.facets, displacements(3 * n1, &nodes2))?;
    let mut contact = Contact::create(nonmortar, mortar, multipliers, options)?;
    let own: Vec<bool> = nodes1.iter().map(|&k| own[k]).collect();
    contact.set_owners(own.iter().map(|own| if *own { Owner::Here } else { Owner::Elsewhere }).collect())?;
    Ok(Part { contact, nodes: [nodes1, nodes2], own })
}
