//! A tri3 or quad4 facet: its nodes in space, which are the corners of its cell, and its kind.

use super::vector::Vec3;
use crate::error::{Error, Kind, Result};
use crate::shape::{MAX_CORNERS, Shape};

/// A facet. Nodes beyond the kind's number repeat the first one and have no weight anywhere.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    /// Node positions, right-hand order seen from outside the body.
    pub nodes: [Vec3; MAX_CORNERS],
    /// The facet's kind.
    pub shape: &'static Shape,
}

impl Facet {
    /// The facet through 3 or 4 finite points.
    pub fn new(nodes: &[Vec3]) -> Result<Facet> {
        let shape = Shape::of(nodes.len()).ok_or_else(|| {
            Error::new(Kind::InvalidSize, text!("a facet has {} nodes; 3 or 4 are allowed", nodes.len()))
        })?;
        let mut padded = [nodes[0]; MAX_CORNERS];
        padded[..nodes.len()].copy_from_slice(nodes);
        Ok(Facet { nodes: padded, shape })
    }

    /// Number of nodes.
    #[inline]
    pub fn len(&self) -> usize {
        self.shape.n
    }

    /// The node positions in use.
    #[inline]
    pub fn points(&self) -> &[Vec3] {
        &self.nodes[..self.shape.n]
    }

    /// The longest distance between two consecutive nodes `[L]`.
    pub fn longest_edge(&self) -> f64 {
        let squared = |k: usize| (self.nodes[self.shape.next[k]] - self.nodes[k]).norm_squared();
        (0..self.len()).map(squared).fold(0.0, f64::max).sqrt()
    }

    /// Twice the area vector at the centre: (x2-x1) x (x3-x1) for tri3, (x3-x1) x (x4-x2) for quad4.
    /// Its direction is the facet's outward normal.
    #[inline]
    pub fn area_vector(&self) -> Vec3 {
        let [w1, w2] = self.spanning_vectors();
        w1.cross(&w2)
    }

    /// The two vectors whose cross product is [`Facet::area_vector`].
    #[inline]
    pub fn spanning_vectors(&self) -> [Vec3; 2] {
        let s = self.spanning_signs();
        let mut w = [Vec3::zeros(); 2];
        for j in 0..2 {
            // Differences of nodes: exact under a common offset.
            let (plus, minus) = s[j];
            w[j] = self.nodes[plus] - self.nodes[minus];
        }
        w
    }

    /// Which nodes the spanning vectors run between: (to, from).
    #[inline]
    pub fn spanning_signs(&self) -> [(usize, usize); 2] {
        if self.len() == 3 { [(1, 0), (2, 0)] } else { [(2, 0), (3, 1)] }
    }
}
