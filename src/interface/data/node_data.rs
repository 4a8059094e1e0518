//! What a host says of the non-mortar nodes in place of what the library finds: friction, augmentation, normals,
//! constrained directions, and where a node's multiplier acts. None of it belongs to the history.

use super::surface::NO_EQUATION;
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::memory::{self, Stored};

/// Where the multiplier of a node acts; a parallel host says it of every node that several handles have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// Here, with the node's own block.
    Here,
    /// Here, where the facets of the handle are; another one adds the node's own block. The sums of all make its gap.
    Shared,
    /// In another handle, which has all facets around the node: it has no traction and no row here. The node may carry others.
    Elsewhere,
}

/// What a host says of the nodes.
#[derive(Debug)]
pub struct NodeData {
    /// Where their multipliers act.
    pub owners: Vec<Owner>,
    /// Coulomb's coefficient; infinite where the surfaces are rough.
    pub mu: Vec<f64>,
    /// r_A [F/L^5]; `None`: the options'.
    pub augmentations: Option<Vec<f64>>,
    /// Unit normals into the non-mortar body; `None`: the averaged ones.
    pub normals: Option<Vec<Vec3>>,
    /// Projectors on the free directions.
    pub free: Vec<Mat3>,
}

impl NodeData {
    /// With these coefficients and nothing else said; the free directions are those that have equations.
    pub fn new<const N: usize>(multiplier_equations: &[[i64; N]], mu: Vec<f64>) -> Result<NodeData> {
        let owners = memory::filled(Owner::Here, mu.len())?;
        let free = free_directions(multiplier_equations, &[])?;
        Ok(NodeData { owners, mu, augmentations: None, normals: None, free })
    }

    /// Sets the coefficients.
    pub fn set_mu(&mut self, mu: Vec<f64>) -> Result<()> {
        check_length("mu", mu.len(), self.mu.len())?;
        if let Some(k) = mu.iter().position(|m| !(*m >= 0.0 && m.is_finite())) {
            let text = text!("mu of node {k} is {}; it must be finite and not negative", mu[k]);
            return Err(Error::new(Kind::InvalidValue, text));
        }
        self.mu = mu;
        Ok(())
    }

    /// Sets the augmentations.
    pub fn set_augmentations(&mut self, r: Option<Vec<f64>>) -> Result<()> {
        if let Some(r) = &r {
            check_length("augmentation", r.len(), self.mu.len())?;
            if let Some(k) = r.iter().position(|r| !(*r > 0.0 && r.is_finite())) {
                let text = text!("augmentation of node {k} is {}; it must be finite and positive", r[k]);
                return Err(Error::new(Kind::InvalidValue, text));
            }
        }
        self.augmentations = r;
        Ok(())
    }

    /// Sets the normals.
    pub fn set_normals(&mut self, normals: Option<Vec<Vec3>>) -> Result<()> {
        // Far above the rounding of a normalisation, far below any angle that matters.
        const UNIT: f64 = 1e-10;
        if let Some(n) = &normals {
            check_length("normals", n.len(), self.mu.len())?;
            if let Some(k) = n.iter().position(|n| !((n.norm() - 1.0).abs() <= UNIT)) {
                let text = text!("normal of node {k} has length {}; it must be a unit vector", n[k].norm());
                return Err(Error::new(Kind::InvalidValue, text));
            }
        }
        self.normals = normals;
        Ok(())
    }

    /// Sets where multipliers act.
    pub fn set_owners(&mut self, owners: Vec<Owner>) -> Result<()> {
        check_length("owned", owners.len(), self.mu.len())?;
        self.owners = owners;
        Ok(())
    }

    /// Whether node A adds its own block here.
    pub fn is_own(&self, a: usize) -> bool {
        self.owners[a] == Owner::Here
    }

    /// Whether node A has a traction and rows here.
    pub fn acts(&self, a: usize) -> bool {
        self.owners[a] != Owner::Elsewhere
    }
}

/// Refuses an array of another number of nodes.
pub fn check_length(name: &str, found: usize, needed: usize) -> Result<()> {
    if found == needed {
        return Ok(());
    }
    Err(Error::new(Kind::InvalidSize, text!("{name} has {found} nodes; the surface has {needed}")))
}

/// Projectors on the directions that are left to each node by its equations and by `directions`, in which it is
/// prescribed on both sides.
pub fn free_directions<const N: usize>(
    multiplier_equations: &[[i64; N]],
    directions: &[(usize, Vec3)],
) -> Result<Vec<Mat3>> {
    // A second direction of a node closer than this to the first adds nothing but rounding.
    const INDEPENDENT: f64 = 1e-8;
    let mut free: Vec<_> = multiplier_equations.iter().map(free_of_equations).stored()?;
    let mut declared = memory::filled(Mat3::identity(), free.len())?;
    for (k, (node, d)) in directions.iter().enumerate() {
        if *node >= free.len() {
            let text = text!("constraint {k} names node {node}; nodes 0 to {} exist", free.len() - 1);
            return Err(Error::new(Kind::IndexOutOfRange, text));
        }
        let norm = d.norm();
        if !(norm > 0.0 && norm.is_finite()) {
            let text = text!("direction of constraint {k} has length {norm}; it must be finite and not zero");
            return Err(Error::new(Kind::InvalidValue, text));
        }
        let rest = declared[*node] * (d / norm);
        if rest.norm() <= INDEPENDENT {
            let text = text!("constraint {k} repeats a direction of node {node}");
            return Err(Error::new(Kind::InvalidValue, text));
        }
        remove(&mut declared[*node], rest.normalize());
        let rest = free[*node] * (d / norm);
        if rest.norm() > INDEPENDENT {
            remove(&mut free[*node], rest.normalize());
        }
    }
    Ok(free)
}

/// Projector on the axes in which a node has a multiplier; on all of space where it has none at all, so that it
/// keeps its normal. A removed component is a constrained direction, whether the host declares it or not:
/// otherwise the rows that are left would depend on the augmentation.
fn free_of_equations<const N: usize>(equations: &[i64; N]) -> Mat3 {
    if N < 3 || equations.iter().all(|&e| e == NO_EQUATION) {
        return Mat3::identity(); // a multiplier along the normal belongs to no axis
    }
    Mat3::from_diagonal(&Vec3::from_fn(|i, _| if equations[i] == NO_EQUATION { 0.0 } else { 1.0 }))
}

/// Takes a unit direction within a projector's range out of it.
fn remove(projector: &mut Mat3, unit: Vec3) {
    *projector -= unit * unit.transpose();
}
