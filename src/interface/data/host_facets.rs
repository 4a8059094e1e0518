//! What a surface knows of the facets of its host: their numbers, their nodes, and where their multipliers stand. Of a surface of
//! linear facets they are the facets that its geometry is made of.

use super::facet_nodes::FacetNodes;
use super::pairs::ParentRecord;
use super::surface::Surface;
use crate::dual::DualBasis;
use crate::error::{Error, Result};
use crate::geometry::{Mat3, Vec3};
use crate::memory::Stored;
use crate::mortar::{ParentFacet, ParentWeights};
use crate::normal::corner_normal_derivatives;
use crate::shape::MAX_PARENT_NODES;

/// Derivatives of the normal of a facet of the host at one of its nodes, by those of its nodes that it depends on.
#[derive(Clone, Copy, Debug, Default)]
pub struct NormalDerivatives {
    of: [(usize, Mat3); MAX_PARENT_NODES],
    len: usize,
}

impl NormalDerivatives {
    /// Each with the node's place in the facet.
    pub fn as_slice(&self) -> &[(usize, Mat3)] {
        &self.of[..self.len]
    }
}

impl Surface {
    /// The facets of the host: how many there are.
    pub fn host_facets(&self) -> usize {
        self.parents.as_ref().map_or(self.facets.len(), |p| p.facets.len())
    }

    /// The nodes of one of them.
    pub fn host_nodes(&self, f: usize) -> &[usize] {
        match &self.parents {
            None => self.facets[f].as_slice(),
            Some(parents) => parents.facets[f].as_slice(),
        }
    }

    /// The one that facet `f` is, or is part of.
    pub fn host_facet(&self, f: usize) -> usize {
        self.parents.as_ref().map_or(f, |p| p.parent(f))
    }

    /// The nodes that have the multipliers over facet `f`.
    pub fn rows(&self, f: usize) -> &FacetNodes {
        self.parents.as_ref().map_or(&self.facets[f], |p| p.rows(f))
    }

    /// How many multipliers a facet of the host has: at the first so many of its nodes.
    pub fn multipliers(&self, f: usize) -> usize {
        self.parents.as_ref().map_or_else(|| self.facets[f].len, |p| p.multipliers(f))
    }

    /// Whether facet `f` has no pairs, whatever lies over it.
    #[inline]
    pub fn is_idle(&self, f: usize) -> bool {
        self.idle.get(f).is_some_and(|idle| *idle)
    }

    /// Leaves the facets of the host idle at whose nodes nothing `acts`.
    pub fn set_idle(&mut self, acts: impl Fn(usize) -> bool) -> Result<()> {
        let is_idle = |f: usize| !self.host_nodes(self.host_facet(f)).iter().any(|&a| acts(a));
        let idle = (0..self.facets.len()).map(is_idle).stored()?;
        self.idle = if idle.contains(&true) { idle } else { Vec::new() };
        Ok(())
    }

    /// Whether any facet has a multiplier at this node.
    pub fn has_row(&self, node: usize) -> bool {
        self.parents.as_ref().is_none_or(|p| p.has_row[node])
    }

    /// How many nodes there are at which no facet has a multiplier.
    pub fn nodes_without_row(&self) -> usize {
        self.parents.as_ref().map_or(0, |p| p.has_row.iter().filter(|has| !**has).count())
    }

    /// The dual basis of facet f of the host, which has parents, with these weights of all of its pairs, if it has not faded out.
    #[inline(never)] // it is met several times
    pub fn parent_basis(
        &self,
        f: usize,
        x: &[Vec3],
        weights: &mut dyn Iterator<Item = &ParentWeights>,
    ) -> Result<Option<DualBasis>> {
        let parents = self.parents.as_ref().expect("asked of surfaces with parents");
        let area = match parents.lines {
            None => parents.parts(f).map(|part| 0.5 * self.facet(part, x).area_vector().norm()).sum(),
            Some(_) => parents.areas(f, x, parents.space)?.iter().sum(),
        };
        let named = |e: Error| Error::new(e.kind, text!("{} facet {f}: {}", self.side, e.message));
        DualBasis::of_parent(parents.facets[f].parent, area, weights).map_err(named)
    }

    /// `rows` times the derivatives of the unit normal of facet f of the host at its k-th node.
    pub fn normal_derivatives(&self, (f, k): (usize, usize), x: &[Vec3], rows: &Mat3) -> NormalDerivatives {
        let mut d = self.normal_columns((f, k));
        match &self.parents {
            None => d.of[..d.len].copy_from_slice(&corner_normal_derivatives(&self.facet(f, x), k, rows)),
            Some(parents) => {
                let of_nodes = parents.at(f, x).normal_derivatives(k, rows);
                d.of.iter_mut().zip(of_nodes).for_each(|(d, of)| d.1 = of);
            }
        }
        d
    }

    /// The same without numbers: which nodes there are.
    pub fn normal_columns(&self, (f, k): (usize, usize)) -> NormalDerivatives {
        let (n, mut d) = (self.host_nodes(f).len(), NormalDerivatives::default());
        let corner = |step: usize| (k + step) % n;
        d.len = if self.parents.is_some() { n } else { 3 };
        for (l, of) in d.of.iter_mut().enumerate() {
            of.0 = if self.parents.is_some() { l } else { corner([0, 1, n - 1][l % 3]) };
        }
        d
    }

    /// The first facet at or after which another facet of the host begins.
    pub fn begin_of_host(&self, f: usize) -> usize {
        self.parents.as_ref().map_or(f, |p| p.of.get(f).map_or(f, |&host| p.first[host as usize]))
    }

    /// Names facet `f` in a refusal.
    pub fn at(&self, f: usize) -> impl FnOnce(Error) -> Error + use<'_> {
        move |e| {
            let name = text!("{} facet {}", self.side, self.host_facet(f));
            let of_part = self.parents.as_ref().filter(|p| p.parts(p.parent(f)).len() > 1);
            Error::new(
                e.kind,
                match of_part {
                    None => text!("{name}: {}", e.message),
                    Some(_) => {
                        text!("{name}, the part between its nodes {:?}: {}", self.facets[f].as_slice(), e.message)
                    }
                },
            )
        }
    }
}

/// The two facets of a pair of parents at these positions.
pub fn parents_at(
    (one, two): (&Surface, &Surface),
    pair: &ParentRecord,
    (x1, x2): (&[Vec3], &[Vec3]),
) -> (ParentFacet, ParentFacet) {
    let at = |surface: &Surface, f: usize, x: &[Vec3]| {
        surface.parents.as_ref().expect("pairs of parents have parents on both sides").at(f, x)
    };
    (at(one, pair.one, x1), at(two, pair.two, x2))
}
