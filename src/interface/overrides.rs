//! What a host sets per node in place of what the library finds: friction, augmentation, normals, constrained
//! directions, and which nodes are its own. None of it belongs to the history. Every one of them ends with
//! [`Contact::forget`]: what the last evaluation has left must not outlive what it was found with.

use super::{Contact, Friction, NO_EQUATION, effects};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::memory::{self, Stored};

impl Contact<3> {
    /// Friction coefficient per node.
    pub fn set_friction(&mut self, mu: Vec<f64>) -> Result<()> {
        if self.options.friction != Friction::Coulomb {
            let text = "mu belongs to Coulomb friction; this interface has another law";
            return Err(Error::new(Kind::InvalidValue, text));
        }
        self.check_length("mu", mu.len(), self.nonmortar.len())?;
        if let Some(k) = mu.iter().position(|m| !(*m >= 0.0 && m.is_finite())) {
            let text = text!("mu of node {k} is {}; it must be finite and not negative", mu[k]);
            return Err(Error::new(Kind::InvalidValue, text));
        }
        self.mu = mu;
        self.kernels = effects::choose_three(&self.options, &self.mortar, &self.mu);
        self.forget();
        Ok(())
    }
}

impl<const N: usize> Contact<N> {
    /// Augmentation r_A [F/L^5] per node; `None` returns to the options'.
    pub fn set_augmentation(&mut self, r: Option<Vec<f64>>) -> Result<()> {
        if let Some(r) = &r {
            self.check_length("augmentation", r.len(), self.nonmortar.len())?;
            if let Some(k) = r.iter().position(|r| !(*r > 0.0 && r.is_finite())) {
                let text = text!("augmentation of node {k} is {}; it must be finite and positive", r[k]);
                return Err(Error::new(Kind::InvalidValue, text));
            }
        }
        self.augmentations = r;
        self.forget();
        Ok(())
    }

    /// Unit normals into the non-mortar body; `None` returns to the averaged ones.
    pub fn set_normals(&mut self, normals: Option<Vec<Vec3>>) -> Result<()> {
        // Far above the rounding of a normalisation, far below any angle that matters.
        const UNIT: f64 = 1e-10;
        if let Some(n) = &normals {
            self.check_length("normals", n.len(), self.nonmortar.len())?;
            if let Some(k) = n.iter().position(|n| !((n.norm() - 1.0).abs() <= UNIT)) {
                let text = text!("normal of node {k} has length {}; it must be a unit vector", n[k].norm());
                return Err(Error::new(Kind::InvalidValue, text));
            }
        }
        self.normals = normals;
        self.forget();
        Ok(())
    }

    /// Directions in which nodes are prescribed on both sides (or against a rigid mortar side): the
    /// multiplier has no component there and the normal none either. Replaces all earlier ones.
    ///
    /// At a Dirichlet edge over a deformable mortar side do not declare it: the patch test needs that
    /// component.
    pub fn set_constraints(&mut self, directions: &[(usize, Vec3)]) -> Result<()> {
        // A second direction of a node closer than this to the first adds nothing but rounding.
        const INDEPENDENT: f64 = 1e-8;
        let mut free: Vec<_> = self.multiplier_equations.iter().map(free_of_equations).stored()?;
        let mut declared = memory::filled(Mat3::identity(), self.nonmortar.len())?;
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
        let old = std::mem::replace(&mut self.free, free);
        if let Err(e) = (0..self.nonmortar.len()).try_for_each(|a| self.normal(a).map(|_| ())) {
            self.free = old;
            return Err(e);
        }
        self.forget();
        Ok(())
    }

    /// Which nodes add their own block here; a parallel host lets exactly one handle do it.
    pub fn set_owned(&mut self, owned: Vec<bool>) -> Result<()> {
        self.check_length("owned", owned.len(), self.nonmortar.len())?;
        self.owned = owned;
        self.forget();
        Ok(())
    }

    /// Drops what the last evaluation has left for the next one at the same positions.
    fn forget(&mut self) {
        self.integration = None;
    }
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
